//! One impact on the beam of thesis chapter 3: with the structure's tables at hand, and built anew.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{GOLDEN, ball, hertz, pinned, settings};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use vibroimpact_sim::modal::{Settings, Solver};

/// Tolerances that leave an error of 1e-6 and of 1e-9 in the restitution at N = 40, and their names.
const ACCURACIES: [(f64, &str); 2] = [(5e-7, "1e-6"), (7e-10, "1e-9")];

fn impacts(criterion: &mut Criterion) {
    for (modes, damping) in [(25, 0.0), (40, 0.02), (100, 0.02), (200, 0.02)] {
        let structure = pinned(modes, damping, GOLDEN);
        for (tolerance, name) in ACCURACIES {
            let settings = Settings { estimate_uncertainty: false, ..settings(tolerance) };
            let mut solver = Solver::new(&structure).unwrap();
            criterion.bench_function(&format!("impact/N={modes}/{name}/tables reused"), |bencher| {
                bencher.iter(|| solver.solve(black_box(&ball()), &hertz(), None, &settings).unwrap().restitution)
            });
            criterion.bench_function(&format!("impact/N={modes}/{name}/anew"), |bencher| {
                bencher.iter(|| {
                    let mut solver = Solver::new(black_box(&structure)).unwrap();
                    solver.solve(&ball(), &hertz(), None, &settings).unwrap().restitution
                })
            });
        }
    }
}

criterion_group!(benches, impacts);
criterion_main!(benches);
