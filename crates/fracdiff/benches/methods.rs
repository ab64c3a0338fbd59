//! Time of every method on the linear analogue of the infinite beam, to about 1e-6 (or its floor), and time of the parts whose
//! cost grows with the length of the past.

use criterion::{Criterion, criterion_group, criterion_main};
use fracdiff::{Collocation, Convolution, Method, test_problems};
use std::hint::black_box;

fn methods(c: &mut Criterion) {
    let problem = test_problems::linear_beam().volterra;
    for method in &test_problems::every_method(500) {
        c.bench_function(&format!("linear-beam/{}", method.name()), |b| {
            b.iter(|| black_box(problem.solve(black_box(method), 2.0)))
        });
    }
}

fn long_past(c: &mut Criterion) {
    let problem = test_problems::relaxation().volterra;
    for steps in [1 << 12, 1 << 14, 1 << 16] {
        c.bench_function(&format!("relaxation/trapezoidal/{steps}"), |b| {
            b.iter(|| black_box(problem.solve(&Method::Trapezoidal(Convolution { steps }), 1.0)))
        });
    }
    let tight = Method::Collocation(Collocation { longest_panel: Some(0.1), ..Default::default() });
    c.bench_function("relaxation/collocation/100 panels", |b| b.iter(|| black_box(problem.solve(&tight, 10.0))));
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = methods, long_past
}
criterion_main!(benches);
