//! One fit of 300 impacts with three parameters. Target: 5 ms.

#[path = "../examples/emoc_data/mod.rs"]
mod emoc_data;

use criterion::{Criterion, criterion_group, criterion_main};
use fitting::{Method, Parameter, Problem, Settings, fit};
use std::hint::black_box;

fn fit_300_impacts(c: &mut Criterion) {
    let data = emoc_data::impacts([0.7, 3.0, 0.2], 0.05);
    let problem = Problem {
        parameters: ["mu0", "alpha0", "alpha1"].map(|name| Parameter::positive(name, 1.0, (0.01, 100.0))).to_vec(),
        count: data.len(),
        residuals: &|p, r| emoc_data::residuals(&data, p, r),
        jacobian: Some(&|p, j| emoc_data::jacobian(&data, p, j)),
    };
    for (name, method, starts) in [
        ("emoc_300/both_8_starts", Method::Both, 8),
        ("emoc_300/levenberg_marquardt_8_starts", Method::LevenbergMarquardt, 8),
        ("emoc_300/levenberg_marquardt_1_start", Method::LevenbergMarquardt, 1),
        ("emoc_300/simplex_1_start", Method::Simplex, 1),
    ] {
        let settings = Settings { method, starts, ..Settings::default() };
        c.bench_function(name, |b| b.iter(|| fit(black_box(&problem), &settings)));
    }
}

criterion_group!(benches, fit_300_impacts);
criterion_main!(benches);
