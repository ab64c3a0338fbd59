//! One striker and a moving structure: nested bisections compared with the quadratic program of several contacts, and with the
//! closed form for a structure at rest.
#![cfg(feature = "qp")]

use crate::common::Random;
use emoc::{Coefficients, Contact, Friction, Mode, MovingImpact, Outcome, Problem, Solver};

fn problem(impact: &MovingImpact) -> Problem {
    let modes = impact.phi.iter().zip(impact.rates).map(|(&phi, &rate)| Mode { rate, shape: vec![phi] });
    Problem {
        contacts: vec![Contact { friction: Friction::None, coefficients: impact.coefficients }],
        inverse_inertia_per_kg: vec![1.0 / impact.mass_kg],
        velocity_m_s: vec![impact.velocity_m_s],
        modes: modes.collect(),
    }
}

fn energy(mass_kg: f64, velocity: f64, rates: impl Iterator<Item = f64>) -> f64 {
    0.5 * (mass_kg * velocity * velocity + rates.map(|rate| rate * rate).sum::<f64>())
}

/// Random impacts; `ringing` scales the modal speeds.
fn each_random(seed: u64, count: usize, ringing: f64, mut check: impl FnMut(&MovingImpact)) {
    let mut random = Random(seed);
    for _ in 0..count {
        let n = 1 + random.below(12);
        let phi: Vec<f64> = (0..n).map(|_| random.range(-2.0, 2.0)).collect();
        let rates: Vec<f64> = (0..n).map(|_| ringing * random.range(-1.0, 1.0)).collect();
        let mass_kg = random.log_range(1e-3, 1e2);
        let coefficients = random.coefficients();
        check(&MovingImpact { mass_kg, velocity_m_s: random.range(-2.0, 0.5), coefficients, phi: &phi, rates: &rates });
    }
}

#[test]
fn bisection_agrees_with_the_quadratic_program() {
    let (mut solved, mut relaxed, mut nothing) = (0, 0, 0);
    for (seed, ringing) in [(1, 0.01), (2, 0.1), (3, 1.0)] {
        each_random(seed, 700, ringing, |impact| {
            let (found, known) = (impact.rebound().unwrap(), Solver::new().solve(&problem(impact)).unwrap());
            let speed = impact.velocity_m_s.abs() + ringing;
            let miss = (found.velocity_m_s - known.velocity_m_s[0]).abs() / speed;
            match known.outcome {
                Outcome::NoImpact => {
                    nothing += 1;
                    assert_eq!((found.impulse_n_s, found.velocity_m_s), (0.0, impact.velocity_m_s));
                }
                Outcome::Solved => {
                    solved += 1;
                    assert_eq!(found.share, 1.0, "{impact:?} {known:?}");
                    assert!(miss < 1e-7, "{miss} {impact:?} {found:?} {known:?}");
                    let rates = (0..impact.phi.len()).map(|k| impact.modal_rate(&found, k));
                    let after = energy(impact.mass_kg, found.velocity_m_s, rates);
                    let theirs = energy(impact.mass_kg, known.velocity_m_s[0], known.modal_rate.iter().copied());
                    assert!((after - theirs).abs() < 1e-8 * (theirs + impact.mass_kg * speed * speed), "{impact:?}");
                }
                Outcome::Relaxed { share } => {
                    relaxed += 1;
                    assert!((found.share - share).abs() < 1e-5, "{share} {impact:?} {found:?}");
                    assert!(miss < 1e-4 * (1.0 + 1.0 / impact.mass_kg), "{miss} {impact:?} {found:?} {known:?}");
                }
                _ => unreachable!(),
            }
        });
    }
    assert!(solved > 1000 && relaxed > 50 && nothing > 100, "{solved} {relaxed} {nothing}");
}

/// Only what a light striker exchanges with a heavy structure counts, however much energy the structure has.
#[test]
fn a_light_striker_meets_a_structure_that_moves() {
    let mut random = Random(6);
    let mut relaxed = 0;
    for case in 0..1000 {
        let n = 1 + random.below(6);
        let phi: Vec<f64> = (0..n).map(|_| random.range(-2.0, 2.0)).collect();
        let rates: Vec<f64> = (0..n).map(|_| random.range(-1.0, 1.0)).collect();
        let mass_kg = random.log_range(1e-16, 1e-3);
        let coefficients = random.coefficients();
        let impact =
            MovingImpact { mass_kg, velocity_m_s: random.range(-1.0, 0.3), coefficients, phi: &phi, rates: &rates };
        let (found, known) = (impact.rebound().unwrap(), Solver::new().solve(&problem(&impact)).unwrap());
        assert!(known.energy_change_j <= 1e-8 * mass_kg, "{case} {impact:?} {known:?}");
        let share = match known.outcome {
            Outcome::Relaxed { share } => share,
            _ => 1.0,
        };
        relaxed += usize::from(share < 1.0);
        assert!((found.share - share).abs() < 1e-5, "{case} {impact:?} {found:?} {known:?}");
        let miss = (found.velocity_m_s - known.velocity_m_s[0]).abs();
        assert!(miss < if share < 1.0 { 1e-3 } else { 1e-8 }, "{case} {miss} {impact:?} {found:?} {known:?}");
    }
    assert!(relaxed > 20, "{relaxed}");
}

#[test]
fn a_structure_at_rest_gives_the_closed_form() {
    each_random(4, 3000, 0.0, |impact| {
        let found = impact.rebound().unwrap();
        if impact.velocity_m_s >= 0.0 {
            return assert_eq!(found.velocity_m_s, impact.velocity_m_s);
        }
        let z = impact.mass_kg * impact.phi.iter().map(|phi| phi * phi).sum::<f64>();
        let closed = impact.coefficients.rebound(z).unwrap();
        let restitution = -found.velocity_m_s / impact.velocity_m_s;
        assert!((restitution - closed.restitution).abs() < 1e-12, "{impact:?} {restitution} {closed:?}");
    });
}

/// Properties of the law: the bodies separate, energy does not grow, no mode changes by more than the impulse can cause.
#[test]
fn the_properties_hold() {
    each_random(5, 3000, 2.0, |impact| {
        let found = impact.rebound().unwrap();
        let rates: Vec<f64> = (0..impact.phi.len()).map(|k| impact.modal_rate(&found, k)).collect();
        let opening = found.velocity_m_s - impact.phi.iter().zip(&rates).map(|(phi, a)| phi * a).sum::<f64>();
        assert!(opening >= -1e-12, "{impact:?} {found:?} {opening}");
        let before = energy(impact.mass_kg, impact.velocity_m_s, impact.rates.iter().copied());
        assert!(energy(impact.mass_kg, found.velocity_m_s, rates.iter().copied()) <= before * (1.0 + 1e-9));
        for ((phi, before), after) in impact.phi.iter().zip(impact.rates).zip(&rates) {
            assert!((after - before).abs() <= phi.abs() * found.impulse_n_s + 1e-14, "{impact:?} {found:?}");
        }
        assert!((0.0..=1.0).contains(&found.share) && found.impulse_n_s >= 0.0);
    });
}

#[test]
fn limits_and_errors() {
    let coefficients = Coefficients { ebar: 0.9, beta0: 0.2, beta1: 0.1 };
    let sound = MovingImpact { mass_kg: 1.0, velocity_m_s: -1.0, coefficients, phi: &[1.0], rates: &[0.0] };
    let field = |impact: MovingImpact| impact.rebound().unwrap_err().field;
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e61] {
        assert_eq!(field(MovingImpact { velocity_m_s: bad, ..sound }), "velocity_m_s");
        assert_eq!(field(MovingImpact { mass_kg: bad, ..sound }), "mass_kg");
        assert_eq!(field(MovingImpact { phi: &[bad], ..sound }), "phi[0]");
        assert_eq!(field(MovingImpact { rates: &[bad], ..sound }), "rates[0]");
        assert_eq!(field(MovingImpact { coefficients: Coefficients { beta0: bad, ..coefficients }, ..sound }), "beta0");
    }
    assert_eq!(field(MovingImpact { mass_kg: 0.0, ..sound }), "mass_kg");
    assert_eq!(field(MovingImpact { rates: &[], ..sound }), "rates.len()");
    // A rigid structure.
    let rigid = MovingImpact { phi: &[], rates: &[], ..sound }.rebound().unwrap();
    assert!((rigid.velocity_m_s - 0.9).abs() < 1e-15);
    for mass_kg in [1e-60, 1.0, 1e60] {
        for phi in [0.0, 1e-60, 1.0, 1e60] {
            for rate in [-1e60, -1.0, 0.0, 1e-60, 1e60] {
                for velocity_m_s in [-1e60, -1.0, 0.0] {
                    let found = MovingImpact { mass_kg, velocity_m_s, phi: &[phi, 1.0], rates: &[rate, 0.0], ..sound };
                    let found = found.rebound().unwrap();
                    assert!(found.velocity_m_s.is_finite() && found.impulse_n_s >= 0.0, "{found:?}");
                }
            }
        }
    }
}
