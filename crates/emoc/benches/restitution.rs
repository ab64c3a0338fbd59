//! Time of a restitution by the closed form (target: 20 ns per call), and by the quadratic programs.

use criterion::{Criterion, criterion_group, criterion_main};
use emoc::{Coefficients, Contact, Friction, Impact, Mode, Parameters, Problem, SingleImpact, Site, Solver};
use std::hint::black_box;

fn closed_form(c: &mut Criterion) {
    let phi: Vec<f64> = (1..=50).map(|k| 1.4 * (0.4 * f64::from(k)).sin()).collect();
    let impact = Impact::new(0.2, &Site::new(&phi).unwrap()).unwrap();
    let parameters = Parameters { mu0: 0.7, alpha0: 3.0, alpha1: 0.2, notional_restitution: 1.0 };
    let coefficients = Coefficients { ebar: 0.9, beta0: 0.3, beta1: 0.1 };
    c.bench_function("closed_form/coefficients", |b| {
        b.iter(|| black_box(&coefficients).rebound(black_box(2.5)).map(|rebound| rebound.restitution));
    });
    c.bench_function("closed_form/parameters", |b| {
        b.iter(|| black_box(&parameters).rebound(black_box(&impact)).map(|rebound| rebound.restitution));
    });
    c.bench_function("closed_form/parameters_with_gradient", |b| {
        b.iter(|| black_box(&parameters).rebound_with_gradient(black_box(&impact)));
    });
    let single = |n: usize| SingleImpact { mass_kg: 0.2, phi: &phi[..n], coefficients };
    for n in [5, 50] {
        c.bench_function(&format!("p1/{n}_modes"), |b| b.iter(|| black_box(single(n)).solve_full()));
    }
    c.bench_function("reduced", |b| b.iter(|| black_box(single(50)).solve_reduced()));
}

/// Two strikers with friction on a vibrating structure, alone and as one impact of a sequence.
fn contact_problem(c: &mut Criterion) {
    for n in [5, 50] {
        let contact = Contact {
            friction: Friction::Planar { coefficient: 0.3 },
            coefficients: Coefficients { ebar: 0.9, beta0: 0.3, beta1: 0.1 },
        };
        let mut inverse_inertia_per_kg = vec![0.0; 16];
        for i in 0..4 {
            inverse_inertia_per_kg[5 * i] = 5.0;
        }
        let modes = (1..=n)
            .map(|k| {
                let k = f64::from(k);
                let shape = vec![1.4 * (0.4 * k).sin(), 0.0, 1.4 * (1.1 * k).sin(), 0.0];
                Mode { rate: 0.02 * (1.7 * k).cos(), shape }
            })
            .collect();
        let problem = Problem {
            contacts: vec![contact; 2],
            inverse_inertia_per_kg,
            velocity_m_s: vec![-1.0, 0.4, -0.7, -0.2],
            modes,
        };
        c.bench_function(&format!("contacts/2_with_{n}_modes/cold"), |b| {
            b.iter(|| Solver::new().solve(black_box(&problem)));
        });
        let mut solver = Solver::new();
        let mut moving = problem.clone();
        let mut step = 0.0_f64;
        c.bench_function(&format!("contacts/2_with_{n}_modes/sequence"), |b| {
            b.iter(|| {
                step += 0.01;
                moving.velocity_m_s[0] = -1.0 + 0.05 * step.sin();
                solver.solve(black_box(&moving))
            });
        });
    }
}

criterion_group!(benches, closed_form, contact_problem);
criterion_main!(benches);
