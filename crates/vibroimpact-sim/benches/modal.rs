//! One impact on the beam of thesis chapter 3, with cached tables and with new ones, and its derivatives.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{GOLDEN, ball, hertz, near_pinned, pinned, settings, ten_parameters};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use vibroimpact_sim::modal::{Settings, Solver, Start};

/// Tolerances that give errors of 1e-6 and 1e-9 in the restitution at N = 40, and their names.
const ACCURACIES: [(f64, &str); 2] = [(5e-7, "1e-6"), (7e-10, "1e-9")];

fn impacts(criterion: &mut Criterion) {
    for (modes, damping) in [(25, 0.0), (40, 0.02), (100, 0.02), (200, 0.02)] {
        let structure = pinned(modes, damping, GOLDEN);
        for (tolerance, name) in ACCURACIES {
            let settings = Settings { estimate_uncertainty: false, ..settings(tolerance) };
            let solver = Solver::new(&structure).unwrap();
            criterion.bench_function(&format!("impact/N={modes}/{name}/tables reused"), |bencher| {
                bencher.iter(|| solver.solve(black_box(&ball()), &hertz(), None, &settings).unwrap().restitution)
            });
            criterion.bench_function(&format!("impact/N={modes}/{name}/anew"), |bencher| {
                bencher.iter(|| {
                    let solver = Solver::new(black_box(&structure)).unwrap();
                    solver.solve(&ball(), &hertz(), None, &settings).unwrap().restitution
                })
            });
        }
    }
}

/// Ten parameters, each of which changes frequencies, dampings or shapes, compared with the impact with its uncertainty.
fn derivatives(criterion: &mut Criterion) {
    for modes in [5, 40, 200] {
        let structure = pinned(modes, 0.02, GOLDEN);
        let (law, striker, start) = (hertz(), ball(), Start::at_rest(modes));
        let near = near_pinned(modes);
        let parameters = ten_parameters(&near, &striker, &law, &start);
        let settings = Settings::default();
        criterion.bench_function(&format!("impact/N={modes}/with its uncertainty, anew"), |bencher| {
            bencher.iter(|| {
                let solver = Solver::new(black_box(&structure)).unwrap();
                solver.solve(&striker, &law, None, &settings).unwrap().restitution_uncertainty
            })
        });
        criterion.bench_function(&format!("derivatives/N={modes}/ten parameters, anew"), |bencher| {
            bencher.iter(|| {
                let solver = Solver::new(black_box(&structure)).unwrap();
                solver.differentiate(&striker, &law, None, &settings, &parameters).unwrap().nearest_graze
            })
        });
    }
}

criterion_group!(benches, impacts, derivatives);
criterion_main!(benches);
