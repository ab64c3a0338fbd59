//! Several contacts at once: energy never grows and no contact closes, for any parameters.
#![cfg(feature = "qp")]

use crate::common::Random;
use crate::common::enumeration::minimise;
use emoc::{Coefficients, Contact, Friction, Mode, Outcome, Problem, Solution, SolveError, Solver};

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

/// Asserts the properties that hold for any input: energy, interpenetration, friction cones, momentum.
fn assert_physical(problem: &Problem, solution: &Solution) {
    // Wedged bodies are pressed by impulses that cancel each other, and rounding grows with those.
    let pressing = solution.impulse_n_s.iter().fold(0.0_f64, |m, p| m.max(p.abs()));
    let rounding = 1e-8 + 1e-10 * pressing;
    let modes: f64 = problem.modes.iter().map(|mode| mode.rate * mode.rate).sum();
    assert!(solution.energy_change_j <= rounding * (1.0 + modes), "{solution:?}");
    let d = problem.coordinates();
    for (&i, contact) in problem.normals().iter().zip(&problem.contacts) {
        assert!(solution.opening_m_s[i] >= -rounding, "{solution:?}");
        let p = solution.impulse_n_s[i];
        let tangents = &solution.impulse_n_s[i + 1..i + contact.friction.coordinates()];
        let tangent = tangents.iter().map(|t| t * t).sum::<f64>().sqrt();
        let size = rounding * (1.0 + p.abs());
        assert!(p >= -size && tangent <= contact.friction.coefficient() * p + size, "{solution:?}");
    }
    for i in 0..d {
        let w = &problem.inverse_inertia_per_kg[i * d..(i + 1) * d];
        let change: f64 = w.iter().zip(&solution.impulse_n_s).map(|(w, p)| w * p).sum();
        assert!((solution.velocity_m_s[i] - problem.velocity_m_s[i] - change).abs() < 1e-9 * (1.0 + change.abs()));
    }
}

#[test]
fn energy_never_grows_and_nothing_interpenetrates() {
    let mut random = Random(12);
    let mut solver = Solver::new();
    let mut counts = [0, 0, 0];
    for _ in 0..800 {
        let problem = random_problem(&mut random);
        let solution = solver.solve(&problem).unwrap();
        counts[match solution.outcome {
            Outcome::NoImpact => 0,
            Outcome::Solved => 1,
            _ => 2,
        }] += 1;
        if solution.outcome != Outcome::NoImpact {
            assert_physical(&problem, &solution);
            assert_physical(&problem, &solver.least_energy(&problem).unwrap());
        }
    }
    // Each of the three outcomes occurs.
    assert!(counts.iter().all(|count| *count > 20), "{counts:?}");
}

/// Demands that are reported as met are met.
#[test]
fn the_outward_constraints_hold_where_the_outcome_says_so() {
    let mut random = Random(13);
    let mut solver = Solver::new();
    for _ in 0..500 {
        let problem = random_problem(&mut random);
        let solution = solver.solve(&problem).unwrap();
        if solution.outcome != Outcome::Solved {
            continue;
        }
        let normals = problem.normals();
        for (&i, contact) in normals.iter().zip(&problem.contacts) {
            let rates = |mode: &Mode| mode.shape[i] * mode.rate;
            let closing = problem.modes.iter().map(rates).sum::<f64>() - problem.velocity_m_s[i];
            if closing <= 0.0 {
                continue;
            }
            let Coefficients { ebar, beta0, beta1 } = contact.coefficients;
            assert!(solution.opening_m_s[i] >= ebar * closing - 1e-8);
            let buzz: f64 =
                problem.modes.iter().zip(&solution.modal_rate).map(|(m, rate)| (m.shape[i] * rate).abs()).sum();
            assert!(solution.velocity_m_s[i] - beta0 * buzz >= beta1 * ebar * closing - 1e-8 * (1.0 + buzz));
            for (mode, rate) in problem.modes.iter().zip(&solution.modal_rate) {
                let reach: f64 = normals
                    .iter()
                    .zip(&problem.contacts)
                    .map(|(&j, other)| {
                        let tangents = &mode.shape[j + 1..j + other.friction.coordinates()];
                        let tangent = tangents.iter().map(|s| s * s).sum::<f64>().sqrt();
                        (mode.shape[j].abs() + other.friction.coefficient() * tangent) * solution.impulse_n_s[j]
                    })
                    .sum();
                assert!((rate - mode.rate).abs() <= reach + 1e-8 * (1.0 + reach));
            }
        }
    }
}

/// Two strikers on a vibrating structure, compared with an enumeration of all signs and active sets.
#[test]
fn a_vibrating_structure_agrees_with_enumeration() {
    let mut random = Random(16);
    let mut solver = Solver::new();
    let mut compared = 0;
    for _ in 0..400 {
        let coefficients = [random.coefficients(), random.coefficients()];
        let masses = [random.range(0.1, 2.0), random.range(0.1, 2.0)];
        let speeds = [random.range(-1.0, 0.2), random.range(-1.0, 0.2)];
        let shapes: Vec<[f64; 2]> = (0..2).map(|_| [random.range(-1.0, 1.0), random.range(-1.0, 1.0)]).collect();
        let rates = [random.range(-0.3, 0.3), random.range(-0.3, 0.3)];
        let problem = Problem {
            contacts: coefficients.map(frictionless).to_vec(),
            inverse_inertia_per_kg: vec![1.0 / masses[0], 0.0, 0.0, 1.0 / masses[1]],
            velocity_m_s: speeds.to_vec(),
            modes: (0..2).map(|k| Mode { rate: rates[k], shape: shapes[k].to_vec() }).collect(),
        };
        let solution = solver.solve(&problem).unwrap();
        if solution.outcome != Outcome::Solved {
            continue;
        }
        // Variables are the strikers' velocities and the modal speeds.
        let mut rows = Vec::new();
        for i in 0..2 {
            let own = |j: usize| if i == j { 1.0 } else { 0.0 };
            let closing = shapes[0][i] * rates[0] + shapes[1][i] * rates[1] - speeds[i];
            let Coefficients { ebar, beta0, beta1 } = coefficients[i];
            rows.push((vec![own(0), own(1), 0.0, 0.0], speeds[i])); // p >= 0
            rows.push((vec![own(0), own(1), -shapes[0][i], -shapes[1][i]], ebar * closing.max(0.0)));
            for signs in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
                if closing > 0.0 {
                    let buzz = |k: usize| -beta0 * signs[k] * shapes[k][i];
                    rows.push((vec![own(0), own(1), buzz(0), buzz(1)], beta1 * ebar * closing));
                }
            }
        }
        for k in 0..2 {
            let reach = [shapes[k][0].abs() * masses[0], shapes[k][1].abs() * masses[1]];
            for sign in [1.0, -1.0] {
                let modal = |l: usize| if k == l { sign } else { 0.0 };
                let bound = reach[0] * speeds[0] + reach[1] * speeds[1] + sign * rates[k];
                rows.push((vec![reach[0], reach[1], modal(0), modal(1)], bound));
            }
        }
        let oracle = minimise(&[masses[0], masses[1], 1.0, 1.0], &rows).unwrap();
        let found = [&solution.velocity_m_s[..], &solution.modal_rate[..]].concat();
        for (a, b) in found.iter().zip(&oracle) {
            assert!((a - b).abs() < 1e-6, "{problem:?}\n{found:?}\n{oracle:?}");
        }
        compared += 1;
    }
    assert!(compared > 200, "{compared}");
}

#[test]
fn two_strikers_on_separate_structures_are_two_single_impacts() {
    let c = [Coefficients { ebar: 0.9, beta0: 0.3, beta1: 0.1 }, Coefficients { ebar: 0.7, beta0: 0.1, beta1: 0.6 }];
    let problem = Problem {
        contacts: c.map(frictionless).to_vec(),
        inverse_inertia_per_kg: vec![1.0 / 0.3, 0.0, 0.0, 1.0 / 2.0],
        velocity_m_s: vec![-1.0, -3.0],
        modes: vec![
            Mode { rate: 0.0, shape: vec![1.1, 0.0] },
            Mode { rate: 0.0, shape: vec![0.0, 0.8] },
            Mode { rate: 0.0, shape: vec![0.4, 0.0] },
        ],
    };
    let solution = Solver::new().solve(&problem).unwrap();
    let first = c[0].rebound(0.3 * (1.21 + 0.16)).unwrap().restitution;
    let second = c[1].rebound(2.0 * 0.64).unwrap().restitution;
    assert!((solution.velocity_m_s[0] - first).abs() < 1e-10);
    assert!((solution.velocity_m_s[1] - 3.0 * second).abs() < 1e-10);
}

#[test]
fn units_do_not_matter() {
    let mut random = Random(14);
    for _ in 0..100 {
        let problem = random_problem(&mut random);
        let (speed, mass) = (random.log_range(1e-6, 1e6), random.log_range(1e-6, 1e6));
        let scaled = Problem {
            contacts: problem.contacts.clone(),
            inverse_inertia_per_kg: problem.inverse_inertia_per_kg.iter().map(|w| w / mass).collect(),
            velocity_m_s: problem.velocity_m_s.iter().map(|v| v * speed).collect(),
            modes: problem
                .modes
                .iter()
                .map(|mode| Mode {
                    rate: mode.rate * speed * mass.sqrt(),
                    shape: mode.shape.iter().map(|s| s / mass.sqrt()).collect(),
                })
                .collect(),
        };
        let (a, b) = (Solver::new().solve(&problem).unwrap(), Solver::new().solve(&scaled).unwrap());
        if a.outcome == Outcome::Solved && b.outcome == Outcome::Solved {
            for (a, b) in a.velocity_m_s.iter().zip(&b.velocity_m_s) {
                assert!((a - b / speed).abs() < 1e-6, "{a} {b} {speed} {mass}");
            }
        }
    }
}

#[test]
fn a_sequence_gives_what_single_solutions_give() {
    let mut random = Random(15);
    let start = loop {
        let problem = random_problem(&mut random);
        if problem.modes.len() > 4 && Solver::new().solve(&problem).unwrap().outcome == Outcome::Solved {
            break problem;
        }
    };
    let mut kept = Solver::new();
    for step in 0..50 {
        let mut problem = start.clone();
        for v in &mut problem.velocity_m_s {
            *v *= 1.0 + 0.002 * f64::from(step);
        }
        for mode in &mut problem.modes {
            mode.rate *= 1.0 - 0.004 * f64::from(step);
        }
        let (warm, cold) = (kept.solve(&problem).unwrap(), Solver::new().solve(&problem).unwrap());
        assert_eq!(warm.outcome, cold.outcome);
        for (a, b) in warm.velocity_m_s.iter().zip(&cold.velocity_m_s) {
            assert!((a - b).abs() < 1e-8, "{step}: {a} {b}");
        }
    }
}

#[test]
fn wedged_bodies_rest() {
    // One body between two walls: not both contacts can open.
    let problem = |ebar| Problem {
        contacts: vec![frictionless(Coefficients { ebar, beta0: 0.0, beta1: 0.0 }); 2],
        inverse_inertia_per_kg: vec![1.0, -1.0, -1.0, 1.0],
        velocity_m_s: vec![-1.0, 1.0],
        modes: vec![],
    };
    let mut solver = Solver::new();
    let stuck = solver.solve(&problem(1.0)).unwrap();
    assert!(matches!(stuck.outcome, Outcome::Relaxed { share } if share < 1e-5), "{stuck:?}");
    assert!(stuck.velocity_m_s.iter().all(|v| v.abs() < 1e-5) && stuck.energy_change_j < -0.49);
    let plastic = solver.solve(&problem(0.0)).unwrap();
    assert!(plastic.velocity_m_s.iter().all(|v| v.abs() < 1e-8), "{plastic:?}");
    // The complementarity problem is infeasible.
    assert_eq!(emoc::lcp::newton_impact(&problem(1.0)).unwrap(), None);
}

#[test]
fn a_ball_on_a_table_with_friction_stops_sliding_within_its_cone() {
    // A point mass of 1 kg falls at 1 m/s and slides at 0.3 m/s.
    let problem = |friction| Problem {
        contacts: vec![Contact { friction, coefficients: Coefficients { ebar: 0.5, beta0: 0.0, beta1: 0.0 } }],
        inverse_inertia_per_kg: vec![1.0, 0.0, 0.0, 1.0],
        velocity_m_s: vec![-1.0, 0.3],
        modes: vec![],
    };
    for (coefficient, left) in [(1.0, 0.0), (0.1, 0.3 - 0.1 * 1.5)] {
        let solution = Solver::new().solve(&problem(Friction::Planar { coefficient })).unwrap();
        assert!((solution.velocity_m_s[0] - 0.5).abs() < 1e-10, "{solution:?}");
        assert!((solution.velocity_m_s[1] - left).abs() < 1e-10, "{solution:?}");
    }
}

#[test]
fn nothing_happens_where_no_contact_closes() {
    let mut problem = single(1.0, &[1.0, 0.5], ELASTIC);
    problem.velocity_m_s = vec![0.2];
    let solution = Solver::new().solve(&problem).unwrap();
    assert_eq!((solution.outcome, solution.velocity_m_s[0]), (Outcome::NoImpact, 0.2));
    // The same without contacts or bodies.
    let empty = Problem { contacts: vec![], inverse_inertia_per_kg: vec![], velocity_m_s: vec![], modes: vec![] };
    assert_eq!(Solver::new().solve(&empty).unwrap().outcome, Outcome::NoImpact);
}

#[test]
fn bad_input_names_field_value_and_what_is_allowed() {
    let good = || single(1.0, &[1.0, 0.5], ELASTIC);
    let field = |change: &dyn Fn(&mut Problem)| {
        let mut problem = good();
        change(&mut problem);
        match Solver::new().solve(&problem) {
            Err(SolveError::Invalid(error)) => error.field,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(field(&|p| p.velocity_m_s[0] = f64::NAN), "velocity_m_s[0]");
    assert_eq!(field(&|p| p.velocity_m_s.push(0.0)), "velocity_m_s");
    assert_eq!(field(&|p| p.inverse_inertia_per_kg[0] = -1.0), "inverse_inertia_per_kg[0]");
    assert_eq!(field(&|p| p.inverse_inertia_per_kg[0] = f64::INFINITY), "inverse_inertia_per_kg[0]");
    assert_eq!(field(&|p| p.modes[1].shape.clear()), "modes[1].shape");
    assert_eq!(field(&|p| p.modes[0].rate = f64::NAN), "modes[0].rate");
    assert_eq!(field(&|p| p.contacts[0].coefficients.ebar = 1.1), "contacts[0].coefficients.ebar");
    assert_eq!(
        field(&|p| p.contacts[0].friction = Friction::Planar { coefficient: -1.0 }),
        "contacts[0].friction.coefficient"
    );
    let pyramid = Friction::Spatial { coefficient: 0.1, facets: 2 };
    assert_eq!(field(&|p| p.contacts[0].friction = pyramid), "contacts[0].friction.facets");
    // An immovable body that moves.
    assert_eq!(field(&|p| p.inverse_inertia_per_kg[0] = 0.0), "velocity_m_s[0]");
    let bodies = |mass: &[f64]| Problem::from_bodies(good().contacts, mass, &[1.0], &[-1.0], vec![]);
    assert_eq!(bodies(&[0.0]).unwrap_err().field, "mass_matrix");
    assert_eq!(bodies(&[1.0, 2.0]).unwrap_err().field, "mass_matrix");
    assert!(bodies(&[2.0]).is_ok());
}

#[test]
fn extreme_magnitudes_end_in_a_solution_or_an_error() {
    for mass in [1e-90, 1e-12, 1.0, 1e12, 1e90] {
        for shape in [0.0, 1e-90, 1e-12, 1.0, 1e12, 1e40] {
            for speed in [1e-90, 1.0, 1e90] {
                for rate in [0.0, 1e-90, 1.0, 1e90] {
                    let mut problem = single(mass, &[shape, shape], ELASTIC);
                    problem.velocity_m_s = vec![-speed];
                    problem.modes[0].rate = rate;
                    if let Ok(solution) = Solver::new().solve(&problem) {
                        assert!(solution.velocity_m_s[0].is_finite(), "{problem:?} {solution:?}");
                        assert!(!solution.energy_change_j.is_nan(), "{problem:?} {solution:?}");
                    }
                }
            }
        }
    }
}
