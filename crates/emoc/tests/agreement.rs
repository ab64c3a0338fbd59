//! The forms of the model agree: closed form, P_1, the reduced form, and the 2^N form of P_0.
#![cfg(feature = "qp")]

mod common;

use common::Random;
use emoc::{Coefficients, SingleImpact};

fn errors(impact: &SingleImpact) -> (f64, f64) {
    let z = impact.mass_kg * impact.phi.iter().map(|p| p * p).sum::<f64>();
    let closed = impact.coefficients.rebound(z).unwrap();
    let full = impact.solve_full();
    let reduced = impact.solve_reduced();
    let f = match &full { Ok(s) => (s.restitution - closed.restitution).abs(), Err(e) => {println!("full {e} z {z}"); 9.0} };
    let r = match &reduced { Ok(s) => (s.restitution - closed.restitution).abs(), Err(e) => {println!("red {e} z {z}"); 9.0} };
    (f, r)
}

#[test]
fn probe() {
    let mut random = Random(1);
    let mut worst = (0.0_f64, 0.0_f64);
    let t = std::time::Instant::now();
    for _ in 0..3000 {
        let n = 1 + random.below(50);
        let phi: Vec<f64> = (0..n).map(|_| random.range(-2.0, 2.0)).collect();
        let c = random.coefficients();
        let m = random.log_range(1e-4, 1e2);
        let i = SingleImpact { mass_kg: m, phi: &phi, coefficients: c };
        let (f, r) = errors(&i);
        if f > 1e-7 || r > 1e-7 { println!("{f:e} {r:e} m {m} n {n} {c:?}"); }
        worst = (worst.0.max(f), worst.1.max(r));
    }
    println!("worst {worst:?} {:?}", t.elapsed());
    for z in [0.0, 1e-300, 1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12] {
        for c in [(1.0, 0.0, 0.0), (1.0, 0.5, 0.5), (0.0, 0.5, 0.5), (1.0, 0.0, 1.0), (1.0, 1.0, 0.0), (0.5, 1e3, 0.2)] {
            for phi in [vec![1.0], vec![0.0, 1.0, 0.0], vec![1.0, 1e-9, 1e-3], vec![0.7; 50]] {
                let s: f64 = phi.iter().map(|p| p * p).sum();
                let coefficients = Coefficients { ebar: c.0, beta0: c.1, beta1: c.2 };
                if z == 0.0 {
                    let i = SingleImpact { mass_kg: 1.0, phi: &vec![0.0; phi.len()], coefficients };
                    println!("{z} {c:?} {:?}", errors(&i));
                } else {
                    let i = SingleImpact { mass_kg: z / s, phi: &phi, coefficients };
                    let (f, r) = errors(&i);
                    if f > 1e-8 || r > 1e-8 { println!("{z:e} {c:?} n {} {f:e} {r:e}", phi.len()); }
                }
            }
        }
    }
}
