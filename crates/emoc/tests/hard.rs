//! Cases that are difficult for codes of the net restitution, each with its expected result.
#![cfg(feature = "qp")]

use emoc::{Coefficients, Contact, Friction, Mode, Outcome, Problem, SingleImpact, SolveError, Solver};

const fn coefficients(ebar: f64, beta0: f64, beta1: f64) -> Coefficients<f64> {
    Coefficients { ebar, beta0, beta1 }
}

/// One striker at 1 m/s on modes at rest.
fn single(mass_kg: f64, phi: &[f64], coefficients: Coefficients<f64>) -> Problem {
    Problem {
        contacts: vec![Contact { friction: Friction::None, coefficients }],
        inverse_inertia_per_kg: vec![1.0 / mass_kg],
        velocity_m_s: vec![-1.0],
        modes: phi.iter().map(|&shape| Mode { rate: 0.0, shape: vec![shape] }).collect(),
    }
}

/// The closed form, the quadratic programs and the general solver at the ends of every range: `(Z, ebar, beta0, beta1)` and the
/// restitution.
#[test]
fn ends_of_the_ranges() {
    let table = [
        // Z = 0: nothing vibrates, for any outward inequality.
        (0.0, 1.0, 0.0, 0.0, 1.0),
        (0.0, 0.7, 0.5, 0.3, 0.7),
        // Z = 1e12: only the rebound that the outward inequality demands remains.
        (1e12, 1.0, 0.0, 0.0, 1e-12),
        (1e12, 0.9, 0.5, 0.0, 0.3),
        (1e12, 0.9, 0.0, 0.25, 0.225),
        // beta1 = 1: the striker alone must have the whole rebound.
        (3.0, 0.8, 0.0, 1.0, 0.8),
        (3.0, 0.8, 2.0, 1.0, 0.8),
        (1e12, 0.8, 0.3, 1.0, 0.8),
        // ebar = 0: nothing is demanded.
        (3.0, 0.0, 0.4, 0.6, 0.0),
        (0.0, 0.0, 0.0, 1.0, 0.0),
        (1e12, 0.0, 1.0, 1.0, 0.0),
        // At the kink both terms are equal: 1/(1+Z) = (beta0+beta1)/(1+beta0).
        (1.0, 1.0, 0.0, 0.5, 0.5),
        (3.0, 1.0, 1.0 / 3.0, 0.0, 0.25),
        // An unbounded outward weight.
        (3.0, 0.6, 1e12, 0.0, 0.6 * (1.0 - 1.0 / (1.0 + 1e12))),
    ];
    let mut solver = Solver::new();
    for (z, ebar, beta0, beta1, expected) in table {
        let coefficients = coefficients(ebar, beta0, beta1);
        let rebound = coefficients.rebound(z).unwrap();
        assert!((rebound.restitution - expected).abs() <= 1e-15 * expected.max(1e-12) + 1e-24, "{z} {rebound:?}");
        assert!((rebound.restitution + rebound.recoil - ebar).abs() <= 1e-15);
        let energy = rebound.restitution.powi(2) + rebound.modal_energy_fraction(z);
        assert!(energy <= 1.0 + 1e-15, "{z} {rebound:?}: energy {energy}");

        let phi = [(0.36 * z).sqrt(), -(0.64 * z).sqrt()];
        let impact = SingleImpact { mass_kg: 1.0, phi: &phi, coefficients };
        for found in [impact.solve_reduced(), impact.solve_full()] {
            // Degenerate vertices (beta1 = 1) have fewer digits; extreme cases may fail, but never give a wrong result.
            match found {
                Ok(found) => assert!((found.restitution - expected).abs() < 1e-6, "{z} {coefficients:?} {found:?}"),
                Err(SolveError::Stopped(_)) => assert!(z > 1e6 || beta0 > 1e6, "{z} {coefficients:?}"),
                Err(error) => panic!("{z} {coefficients:?}: {error}"),
            }
        }
        match solver.solve(&single(1.0, &phi, coefficients)) {
            Ok(solution) if solution.outcome == Outcome::Solved => {
                assert!((solution.velocity_m_s[0] - expected).abs() < 1e-6, "{z} {coefficients:?} {solution:?}");
            }
            Ok(solution) => {
                // Demands that are lowered together are reported, without gain of energy.
                assert!(z > 1e6 || beta0 > 1e6, "{z} {coefficients:?} {solution:?}");
                assert!(solution.energy_change_j <= 1e-8, "{solution:?}");
            }
            Err(SolveError::Stopped(_)) => assert!(z > 1e6 || beta0 > 1e6, "{z} {coefficients:?}"),
            Err(error) => panic!("{z} {coefficients:?}: {error}"),
        }
    }
}

/// Modes with a node at the contact, none at all, and a hundred equal ones.
#[test]
fn modes_with_zero_shape() {
    let c = coefficients(0.9, 0.3, 0.1);
    let mut solver = Solver::new();
    let expected = c.rebound(2.0).unwrap().restitution;
    for phi in [vec![2f64.sqrt()], vec![2f64.sqrt(), 0.0, 0.0], vec![0.02f64.sqrt(); 100]] {
        let solution = solver.solve(&single(1.0, &phi, c)).unwrap();
        assert_eq!(solution.outcome, Outcome::Solved);
        assert!((solution.velocity_m_s[0] - expected).abs() < 1e-9, "{} modes", phi.len());
        let full = SingleImpact { mass_kg: 1.0, phi: &phi, coefficients: c }.solve_full().unwrap();
        assert!((full.restitution - expected).abs() < 1e-9, "{} modes", phi.len());
        for (rate, phi) in solution.modal_rate.iter().zip(&phi) {
            assert!(*phi != 0.0 || *rate == 0.0, "a mode with a node at the contact moves");
        }
    }
    for phi in [vec![], vec![0.0], vec![0.0; 5]] {
        let solution = solver.solve(&single(1.0, &phi, c)).unwrap();
        assert!((solution.velocity_m_s[0] - 0.9).abs() < 1e-12, "{phi:?} {solution:?}");
    }
}

/// Programs whose optimum is not unique, or that are infeasible as stated.
#[test]
fn degenerate_and_infeasible_programs() {
    let mut solver = Solver::new();
    let c = coefficients(0.8, 0.2, 0.1);
    // The same contact twice or five times: impulses are not unique, velocities are.
    let once = solver.solve(&single(1.0, &[1.2, -0.4], c)).unwrap();
    for copies in [2, 5] {
        let contact = Contact { friction: Friction::None, coefficients: c };
        let problem = Problem {
            contacts: vec![contact; copies],
            inverse_inertia_per_kg: vec![1.0; copies * copies],
            velocity_m_s: vec![-1.0; copies],
            modes: [1.2, -0.4].iter().map(|&phi| Mode { rate: 0.0, shape: vec![phi; copies] }).collect(),
        };
        let solution = solver.solve(&problem).unwrap();
        assert_eq!(solution.outcome, Outcome::Solved);
        for velocity in &solution.velocity_m_s {
            assert!((velocity - once.velocity_m_s[0]).abs() < 1e-7, "{copies}: {solution:?}");
        }
        let whole: f64 = solution.impulse_n_s.iter().sum();
        assert!((whole - once.impulse_n_s[0]).abs() < 1e-7, "{copies}: {solution:?}");
    }
    // A body between two walls that both close: the rebound from each would press it into the other. No velocity satisfies both
    // demands, which are lowered until one does.
    let elastic = Contact { friction: Friction::None, coefficients: coefficients(1.0, 0.0, 0.0) };
    let mode = Mode { rate: 1.0, shape: vec![1.0, 1.0] };
    let wedged = Problem {
        contacts: vec![elastic; 2],
        inverse_inertia_per_kg: vec![1.0, -1.0, -1.0, 1.0],
        velocity_m_s: vec![0.0, 0.0],
        modes: vec![mode],
    };
    let solution = solver.solve(&wedged).unwrap();
    assert!(solution.opening_m_s.iter().all(|g| *g >= -1e-7), "{solution:?}");
    assert!(solution.energy_change_j <= 1e-8, "{solution:?}");
    // Nothing closes, nothing happens.
    let mut leaving = single(1.0, &[1.0], c);
    leaving.velocity_m_s[0] = 1.0;
    assert_eq!(solver.solve(&leaving).unwrap().outcome, Outcome::NoImpact);
    // No contact at all.
    let none = Problem { contacts: vec![], inverse_inertia_per_kg: vec![], velocity_m_s: vec![], modes: vec![] };
    assert_eq!(solver.solve(&none).unwrap().outcome, Outcome::NoImpact);
    // An immovable body that moves is not a valid problem.
    let mut immovable = single(1.0, &[1.0], c);
    immovable.inverse_inertia_per_kg[0] = 0.0;
    assert!(matches!(solver.solve(&immovable), Err(SolveError::Invalid(_))));
}

/// A point of almost no mobility: its velocity may be as large as its mobility allows, and no larger.
#[test]
fn a_point_that_hardly_moves() {
    let mut solver = Solver::new();
    let contact = Contact { friction: Friction::None, coefficients: coefficients(0.5, 0.2, 0.1) };
    for hair in [1e-3, 1e-5, 3e-6, 1e-6] {
        // W = B B^T, v = B u with B = [[1, 0], [1, hair]] and u = (-1, 0.7).
        let mut problem = Problem {
            contacts: vec![contact; 2],
            inverse_inertia_per_kg: vec![1.0, 1.0, 1.0, 1.0 + hair * hair],
            velocity_m_s: vec![-1.0, -1.0 + 0.7 * hair],
            modes: vec![],
        };
        assert!(solver.solve(&problem).is_ok(), "{hair:e}: {:?}", solver.solve(&problem));
        problem.velocity_m_s[1] += 100.0 * hair;
        let off = solver.solve(&problem);
        assert!(hair >= 1e-5 || matches!(off, Err(SolveError::Invalid(_))), "{hair:e}: {off:?}");
    }
}

/// Masses and shapes over twelve decades and more, with the same `Z`: the same restitution.
#[test]
fn twelve_decades_of_mass() {
    let c = coefficients(0.9, 0.3, 0.2);
    let expected = c.rebound(1.0).unwrap().restitution;
    let mut solver = Solver::new();
    for power in [-12, -6, 0, 6, 12] {
        let mass_kg = 10f64.powi(power);
        let phi = [(0.5 / mass_kg).sqrt(), -(0.5 / mass_kg).sqrt()];
        let solution = solver.solve(&single(mass_kg, &phi, c)).unwrap();
        assert_eq!(solution.outcome, Outcome::Solved, "1e{power} kg");
        assert!((solution.velocity_m_s[0] - expected).abs() < 1e-9, "1e{power} kg: {solution:?}");
    }
}

/// A striker that is far heavier than the structure takes up an impulse that is many times the one that stops both together. The demands
/// are met nevertheless.
#[test]
fn a_striker_far_heavier_than_the_structure() {
    let mut solver = Solver::new();
    for power in 5..=11 {
        let z = 10f64.powi(power);
        let phi = [(0.36 * z).sqrt(), -(0.64 * z).sqrt()];
        for c in [coefficients(1.0, 0.0, 0.0), coefficients(0.9, 0.3, 0.2), coefficients(1.0, 0.4, 1.0)] {
            let solution = solver.solve(&single(1.0, &phi, c)).unwrap();
            assert_eq!(solution.outcome, Outcome::Solved, "Z = 1e{power}, {c:?}");
            let expected = c.rebound(z).unwrap().restitution;
            assert!((solution.velocity_m_s[0] - expected).abs() < 1e-8, "Z = 1e{power}, {c:?}: {solution:?}");
        }
    }
}

/// Heavy strikers on a hundred modes, of which the contact hardly excites some.
#[test]
fn modes_that_are_hardly_excited() {
    let phi: Vec<f64> = (1..=116).map(|k| 0.3 * (1.7 * f64::from(k)).sin().powi(3)).collect();
    let sum: f64 = phi.iter().map(|phi| phi * phi).sum();
    for mass_kg in [1.0, 30.0, 770.0, 2e4, 1e5] {
        for c in [coefficients(0.937, 0.0285, 0.0), coefficients(0.9, 0.3, 0.2), coefficients(1.0, 0.0, 0.0)] {
            let solution = Solver::new().solve(&single(mass_kg, &phi, c)).unwrap();
            assert_eq!(solution.outcome, Outcome::Solved, "{mass_kg} kg, {c:?}");
            let expected = c.rebound(mass_kg * sum).unwrap().restitution;
            assert!((solution.velocity_m_s[0] - expected).abs() < 1e-9, "{mass_kg} kg, {c:?}: {solution:?}");
        }
    }
}

/// Demands that can be met are not lowered, although the iteration stops early on them if no active rows are known.
#[test]
fn demands_that_can_be_met_are_not_relaxed() {
    let contact = |c| Contact { friction: Friction::None, coefficients: c };
    let modes = [
        (-0.142, [0.0384, 0.0]),
        (0.113, [0.0384, 0.0]),
        (-0.0733, [-0.0384, 0.0]),
        (-0.093, [0.0448, 0.0724]),
        (-0.0316, [-0.0701, 0.0]),
        (-0.305, [0.0254, 0.0478]),
        (-0.262, [0.0, 0.00252]),
        (0.0372, [0.0, -0.00118]),
        (-0.471, [0.00294, -0.0182]),
        (0.0914, [0.0, -0.0502]),
    ];
    let problem = Problem {
        contacts: vec![contact(coefficients(0.724, 0.439, 0.603)), contact(coefficients(0.754, 1.92, 0.0))],
        inverse_inertia_per_kg: vec![771.0, 0.0, 0.0, 0.00278],
        velocity_m_s: vec![-0.0462, -0.141],
        modes: modes.iter().map(|&(rate, shape)| Mode { rate, shape: shape.to_vec() }).collect(),
    };
    assert_eq!(Solver::new().solve(&problem).unwrap().outcome, Outcome::Solved);
}

/// Two strikers on structures of their own, of which one weighs many times the other: two single impacts, or demands that are lowered.
#[test]
fn a_light_and_a_heavy_striker() {
    let c = coefficients(0.8, 0.3, 0.1);
    let contact = Contact { friction: Friction::None, coefficients: c };
    let mut solver = Solver::new();
    for power in 0..10 {
        let heavy_kg = 10f64.powi(power);
        let mode = |shape: [f64; 2]| Mode { rate: 0.0, shape: shape.to_vec() };
        let problem = Problem {
            contacts: vec![contact; 2],
            inverse_inertia_per_kg: vec![1.0, 0.0, 0.0, 1.0 / heavy_kg],
            velocity_m_s: vec![-1.0, -0.5],
            modes: vec![mode([1.3, 0.0]), mode([0.0, (0.7 / heavy_kg).sqrt()])],
        };
        let solution = solver.solve(&problem).unwrap();
        if solution.outcome != Outcome::Solved {
            assert!(power > 6, "1e{power} kg: {solution:?}");
            continue;
        }
        for (i, (speed, z)) in [(1.0, 1.69), (0.5, 0.7)].into_iter().enumerate() {
            let expected = speed * c.rebound(z).unwrap().restitution;
            assert!((solution.velocity_m_s[i] - expected).abs() < 1e-7, "1e{power} kg: {solution:?}");
        }
    }
}

/// Changes that must not affect the net restitution: a mode replaced by two that share its squared shape, the signs and the
/// order of the modes, and modes with zero shape, each for one contact and for two on one structure.
#[test]
fn equivalent_lists_of_modes() {
    let mut solver = Solver::new();
    let shapes = [[1.2, 0.3], [-0.4, 0.9], [0.7, -0.5]];
    let problem = |contacts: usize, shapes: &[[f64; 2]]| Problem {
        contacts: vec![Contact { friction: Friction::None, coefficients: coefficients(0.8, 0.2, 0.1) }; contacts],
        inverse_inertia_per_kg: if contacts == 1 { vec![2.0] } else { vec![2.0, 0.0, 0.0, 0.5] },
        velocity_m_s: [-1.0, -0.3][..contacts].to_vec(),
        modes: shapes.iter().map(|shape| Mode { rate: 0.0, shape: shape[..contacts].to_vec() }).collect(),
    };
    for contacts in [1, 2] {
        let plain = solver.solve(&problem(contacts, &shapes)).unwrap();
        assert_eq!(plain.outcome, Outcome::Solved);
        let (sine, cosine) = 0.7f64.sin_cos();
        let [first, second, third] = shapes;
        let split = vec![first.map(|phi| phi * sine), second, first.map(|phi| phi * cosine), third];
        let turned = vec![third.map(|phi| -phi), first.map(|phi| -phi), second];
        let idle = vec![first, [0.0; 2], second, third, [0.0; 2]];
        for (name, shapes) in [("split", split), ("turned", turned), ("idle", idle)] {
            let other = solver.solve(&problem(contacts, &shapes)).unwrap();
            assert_eq!(other.outcome, Outcome::Solved, "{name}");
            for (a, b) in plain.velocity_m_s.iter().zip(&other.velocity_m_s) {
                assert!((a - b).abs() < 1e-7, "{name}, {contacts} contacts: {a} against {b}");
            }
        }
    }
}
