//! Several contacts at once: energy never grows, no contact closes, whatever the parameters.
#![cfg(feature = "qp")]

mod common;

use common::Random;
use emoc::{Coefficients, Contact, Friction, Mode, Outcome, Problem, SolveError, Solver};

const ELASTIC: Coefficients<f64> = Coefficients { ebar: 1.0, beta0: 0.0, beta1: 0.0 };

fn frictionless(coefficients: Coefficients<f64>) -> Contact {
    Contact { friction: Friction::None, coefficients }
}

/// One striker of mass `m` at 1 m/s on a structure with mode shapes `phi` at rest.
fn single(mass_kg: f64, phi: &[f64], coefficients: Coefficients<f64>) -> Problem {
    Problem {
        contacts: vec![frictionless(coefficients)],
        inverse_inertia_per_kg: vec![1.0 / mass_kg],
        velocity_m_s: vec![-1.0],
        modes: phi.iter().map(|&shape| Mode { rate: 0.0, shape: vec![shape] }).collect(),
    }
}

/// Bodies with random mass matrix and Jacobian, random friction, and a structure that vibrates.
fn random_problem(random: &mut Random) -> Problem {
    let contacts: Vec<Contact> = (0..1 + random.below(4))
        .map(|_| Contact {
            friction: match random.below(3) {
                0 => Friction::None,
                1 => Friction::Planar { coefficient: random.range(0.0, 1.5) },
                _ => Friction::Spatial { coefficient: random.range(0.0, 1.5), facets: 3 + random.below(8) },
            },
            coefficients: random.coefficients(),
        })
        .collect();
    let d: usize = contacts.iter().map(|contact| contact.friction.coordinates()).sum();
    let n = 1 + random.below(8);
    let factor: Vec<f64> = (0..n * n).map(|_| random.range(-1.0, 1.0)).collect();
    let mut mass = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            mass[i * n + j] = (0..n).map(|k| factor[i * n + k] * factor[j * n + k]).sum();
        }
        mass[i * n + i] += 0.2;
    }
    let jacobian: Vec<f64> = (0..d * n).map(|_| random.range(-1.0, 1.0)).collect();
    let velocity: Vec<f64> = (0..n).map(|_| random.range(-1.0, 1.0)).collect();
    let vibration = if random.below(2) == 0 { 0.0 } else { 1.0 };
    let modes = (0..random.below(9))
        .map(|_| Mode {
            rate: vibration * random.range(-1.0, 1.0),
            shape: (0..d).map(|_| random.range(-2.0, 2.0)).collect(),
        })
        .collect();
    Problem::from_bodies(contacts, &mass, &jacobian, &velocity, modes).unwrap()
}

#[test]
fn one_striker_on_a_structure_at_rest_is_the_closed_form() {
    let mut random = Random(11);
    let mut solver = Solver::new();
    for _ in 0..300 {
        let n = 1 + random.below(12);
        let phi: Vec<f64> = (0..n).map(|_| random.range(-2.0, 2.0)).collect();
        let mass_kg = random.log_range(1e-3, 1e2);
        let coefficients = random.coefficients();
        let z = mass_kg * phi.iter().map(|p| p * p).sum::<f64>();
        let closed = coefficients.rebound(z).unwrap();
        let general = solver.solve(&single(mass_kg, &phi, coefficients)).unwrap();
        assert_eq!(general.outcome, Outcome::Solved);
        assert!((general.velocity_m_s[0] - closed.restitution).abs() < 1e-10, "{general:?} {closed:?}");
    }
}

#[test]
fn energy_never_grows_and_nothing_interpenetrates() {
    let mut random = Random(12);
    let mut solver = Solver::new();
    let mut relaxed = 0;
    for case in 0..600 {
        let problem = random_problem(&mut random);
        let solution = match solver.solve(&problem) { Ok(s) => s, Err(e) => { println!("{case} {e} {problem:?}"); continue } };
        relaxed += usize::from(matches!(solution.outcome, Outcome::Relaxed { .. }));
        let modes: f64 = problem.modes.iter().map(|mode| mode.rate * mode.rate).sum();
        assert!(solution.energy_change_j <= 1e-8 * (1.0 + modes), "{case}: {solution:?}");
        for (&i, contact) in problem.normals().iter().zip(&problem.contacts) {
            assert!(solution.opening_m_s[i] >= -1e-8, "{case}: {solution:?}");
            let p = solution.impulse_n_s[i];
            let tangent: f64 = (1..contact.friction.coordinates()).map(|k| solution.impulse_n_s[i + k].powi(2)).sum();
            assert!(p >= -1e-8 && tangent.sqrt() <= contact.friction.coefficient() * p + 1e-8, "{case}: {solution:?}");
        }
    }
    println!("relaxed {relaxed}");
}
