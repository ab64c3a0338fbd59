//! Impacts on an infinite beam with several separations, with one, and with a rebound, and the first turning point.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use vibroimpact_sim::infinite::{Settings, Structure, solve, turning_point};

fn impacts(criterion: &mut Criterion) {
    let once = Settings { estimate_uncertainty: false, ..Settings::default() };
    for s in [1.0, 15.0, 1e3] {
        criterion.bench_function(&format!("infinite/S={s}/once"), |bencher| {
            bencher.iter(|| solve(Structure::Beam, black_box(s), &once).unwrap().separations())
        });
        criterion.bench_function(&format!("infinite/S={s}/with error estimate"), |bencher| {
            bencher.iter(|| solve(Structure::Beam, black_box(s), &Settings::default()).unwrap().relative_uncertainty)
        });
    }
    criterion
        .bench_function("infinite/turning point 1", |bencher| bencher.iter(|| turning_point(black_box(1)).unwrap().s));
}

criterion_group!(benches, impacts);
criterion_main!(benches);
