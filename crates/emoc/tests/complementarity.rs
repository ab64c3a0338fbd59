//! Lemke's method compared with the definition, and the baseline compared with known impacts.
#![cfg(feature = "alloc")]

use crate::common::Random;
use emoc::lcp::{Lcp, newton_impact, solve};
use emoc::{Coefficients, Contact, Friction, Mode, Outcome, Problem, newton_restitution};

fn contact(ebar: f64) -> Contact {
    Contact { friction: Friction::None, coefficients: Coefficients { ebar, beta0: 0.0, beta1: 0.0 } }
}

#[test]
fn random_problems_are_solved_to_the_definition() {
    let mut random = Random(6);
    for _ in 0..2000 {
        let n = 1 + random.below(8);
        let rank = 1 + random.below(n);
        let factor: Vec<f64> = (0..n * rank).map(|_| random.range(-1.0, 1.0)).collect();
        let mut m = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                m[i * n + j] = (0..rank).map(|k| factor[i * rank + k] * factor[j * rank + k]).sum();
            }
        }
        // q = -M x + y with x >= 0, y > 0 has a solution even if M is singular.
        let x: Vec<f64> = (0..n).map(|_| random.range(-1.0, 1.0).max(0.0)).collect();
        let q: Vec<f64> =
            (0..n).map(|i| random.range(0.01, 1.0) - (0..n).map(|j| m[i * n + j] * x[j]).sum::<f64>()).collect();
        let Lcp::Solved(z) = solve(&m, &q).unwrap() else { panic!("{m:?} {q:?}") };
        for i in 0..n {
            let w = q[i] + (0..n).map(|j| m[i * n + j] * z[j]).sum::<f64>();
            assert!(z[i] >= 0.0 && w >= -1e-9 && (w * z[i]).abs() < 1e-8, "{m:?} {q:?} {z:?}");
        }
    }
}

#[test]
fn a_problem_without_solution_ends_on_a_ray() {
    assert_eq!(solve(&[0.0], &[-1.0]).unwrap(), Lcp::Ray);
    assert_eq!(solve(&[1.0, -1.0, -1.0, 1.0], &[-1.0, -1.0]).unwrap(), Lcp::Ray);
    assert_eq!(solve(&[], &[]).unwrap(), Lcp::Solved(vec![]));
    assert!(solve(&[1.0], &[f64::NAN]).is_err() && solve(&[1.0, 2.0], &[1.0]).is_err());
}

/// `M` of a light and a heavy body, or of any other units, is `D M D` of one with entries near 1, and its solution `D^-1 z`.
#[test]
fn light_and_heavy_bodies_are_no_ray() {
    for smallest in [1e-10, 1e-12, 1e-20, 1e-100, 1e-190] {
        let near = |z: f64, exact: f64| assert!((z / exact - 1.0).abs() < 1e-14, "{smallest} {z}");
        let Lcp::Solved(z) = solve(&[1.0, 0.0, 0.0, smallest], &[-1.0, -2.0]).unwrap() else { panic!("{smallest}") };
        near(z[0], 1.0);
        near(z[1], 2.0 / smallest);
        let d = [1.0, f64::sqrt(smallest)];
        let m: Vec<f64> = [2.0, 1.0, 1.0, 2.0].iter().enumerate().map(|(k, m)| d[k / 2] * m * d[k % 2]).collect();
        let Lcp::Solved(z) = solve(&m, &[-5.0 * d[0], -6.0 * d[1]]).unwrap() else { panic!("{smallest}") };
        near(z[0], 4.0 / 3.0);
        near(z[1], 7.0 / 3.0 / d[1]);
    }
    let Lcp::Solved(z) = solve(&[1.0, 0.0, 0.0, 1.0], &[-1.0, -1e30]).unwrap() else { panic!() };
    assert!((z[0] - 1.0).abs() < 1e-14 && (z[1] / 1e30 - 1.0).abs() < 1e-14, "{z:?}");
    let refused = solve(&[1e-300], &[-1e100]).unwrap_err().to_string();
    assert_eq!(refused, "q[0] = -1e+100 is not allowed; it must be small enough that the solution is a finite number");
}

#[test]
fn one_striker_rebounds_by_the_formula() {
    let mut random = Random(7);
    for _ in 0..500 {
        let (mass, e) = (random.log_range(1e-3, 1e3), random.range(0.0, 1.0));
        let phi: Vec<f64> = (0..random.below(9)).map(|_| random.range(-1.0, 1.0)).collect();
        let problem = Problem {
            contacts: vec![contact(e)],
            inverse_inertia_per_kg: vec![1.0 / mass],
            velocity_m_s: vec![-2.0],
            modes: phi.iter().map(|&shape| Mode { rate: 0.0, shape: vec![shape] }).collect(),
        };
        let z = mass * phi.iter().map(|p| p * p).sum::<f64>();
        let solution = newton_impact(&problem).unwrap().unwrap();
        assert!((solution.velocity_m_s[0] / 2.0 - newton_restitution(e, z).unwrap()).abs() < 1e-12);
        assert!((solution.opening_m_s[0] - 2.0 * e).abs() < 1e-10);
        assert!(solution.energy_change_j <= 1e-12);
    }
}

#[test]
fn contacts_that_open_are_left_alone() {
    let problem = Problem {
        contacts: vec![contact(1.0)],
        inverse_inertia_per_kg: vec![1.0],
        velocity_m_s: vec![1.0],
        modes: vec![],
    };
    let solution = newton_impact(&problem).unwrap().unwrap();
    assert_eq!((solution.outcome, solution.velocity_m_s[0]), (Outcome::NoImpact, 1.0));
}
