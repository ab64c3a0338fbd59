//! The forms of the model agree: closed form, P_1, its reduced form, and P_0 with its 2^N inequalities.
#![cfg(feature = "qp")]

use crate::common::Random;
use crate::common::enumeration::minimise;
use emoc::{Branch, Coefficients, SingleImpact};

fn moderated_mass_ratio(impact: &SingleImpact) -> f64 {
    impact.mass_kg * impact.phi.iter().map(|phi| phi * phi).sum::<f64>()
}

/// Asserts that both quadratic programs give the closed form's restitution, modal speeds and energy.
fn assert_agreement(impact: &SingleImpact) {
    let z = moderated_mass_ratio(impact);
    let closed = impact.coefficients.rebound(z).unwrap();
    let mut rates = vec![0.0; impact.phi.len()];
    closed.modal_rates(1.0, impact.phi, &mut rates).unwrap();
    let energy = closed.restitution.powi(2) + closed.modal_energy_fraction(z);
    let floor = 2e-12;
    for solution in [impact.solve_full().unwrap(), impact.solve_reduced().unwrap()] {
        assert!((solution.restitution - closed.restitution).abs() < floor, "{impact:?}\n{solution:?}\n{closed:?}");
        assert!((solution.energy_ratio - energy).abs() < 50.0 * floor, "{impact:?}\n{solution:?}\n{energy}");
        for (found, rate) in solution.modal_rates_per_speed.iter().zip(&rates) {
            // The energy is flat in a mode, so that its speed has half the digits of the energy.
            assert!((found - rate).abs() < 1e-6 * impact.mass_kg.sqrt(), "{impact:?}\n{solution:?}\n{rates:?}");
        }
    }
}

#[test]
fn quadratic_programs_agree_with_the_closed_form_in_random_cases() {
    let mut random = Random(1);
    let mut branches = [0, 0];
    for _ in 0..2500 {
        let many = random.below(10) == 0;
        let n = 1 + random.below(if many { 50 } else { 12 });
        let phi: Vec<f64> = (0..n).map(|_| random.range(-2.0, 2.0)).collect();
        let impact =
            SingleImpact { mass_kg: random.log_range(1e-4, 1e2), phi: &phi, coefficients: random.coefficients() };
        let branch = impact.coefficients.rebound(moderated_mass_ratio(&impact)).unwrap().branch;
        branches[usize::from(branch == Branch::Outward)] += 1;
        assert_agreement(&impact);
    }
    assert!(branches.iter().all(|count| *count > 300), "{branches:?}");
}

#[test]
fn quadratic_programs_agree_with_the_closed_form_in_degenerate_cases() {
    let coefficients = [
        (1.0, 0.0, 0.0),
        (1.0, 0.5, 0.5),
        (0.0, 0.5, 0.5),
        (1.0, 0.0, 1.0),
        (1.0, 1.0, 1.0),
        (1.0, 1.0, 0.0),
        (0.5, 1e3, 0.2),
        (1e-6, 0.3, 0.3),
    ];
    let shapes: [&[f64]; 5] = [&[1.0], &[0.0, 1.0, 0.0], &[1.0, 1e-9, 1e-3], &[0.7; 50], &[1.0, -1.0, 1.0]];
    for (ebar, beta0, beta1) in coefficients {
        let coefficients = Coefficients { ebar, beta0, beta1 };
        for phi in shapes {
            for z in [1e-300, 1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12] {
                let mass_kg = z / phi.iter().map(|phi| phi * phi).sum::<f64>();
                assert_agreement(&SingleImpact { mass_kg, phi, coefficients });
            }
            assert_agreement(&SingleImpact { mass_kg: 1.0, phi: &vec![0.0; phi.len()], coefficients });
        }
        // The kink, to the last digit: 1/(1+Z) = (beta_0+beta_1)/(1+beta_0).
        if beta0 + beta1 > 0.0 {
            let z = (1.0 - beta1) / (beta0 + beta1);
            assert_agreement(&SingleImpact { mass_kg: z.max(1e-12), phi: &[0.6, 0.8], coefficients });
        }
    }
}

/// P_0 as section 6.4 writes it for the proof of uniqueness: the variables `v_f, a_1', ..`, and the outward
/// inequality as one row for each of the `2^N` choices of signs. Solved by trying every set of active rows.
fn p0_with_all_signs(impact: &SingleImpact) -> Vec<f64> {
    let n = impact.phi.len();
    let m = impact.mass_kg;
    let Coefficients { ebar, beta0, beta1 } = impact.coefficients;
    let phi: Vec<f64> = impact.phi.iter().map(|phi| phi.abs()).collect();
    let mut hessian = vec![1.0; n + 1];
    hessian[0] = m;
    let mut rows = Vec::new(); // coefficients and bound of row . x >= bound
    let row = |first: f64, modal: &dyn Fn(usize) -> f64| [vec![first], (0..n).map(modal).collect()].concat();
    rows.push((row(1.0, &|k| -phi[k]), ebar)); // 6.6
    for signs in 0..1 << n {
        let sign = |k: usize| if signs >> k & 1 == 1 { 1.0 } else { -1.0 };
        rows.push((row(1.0, &|k| -beta0 * sign(k) * phi[k]), beta1 * ebar)); // 6.7
    }
    for k in 0..n {
        for sign in [1.0, -1.0] {
            // 6.5 with v_i = -1.
            rows.push((row(phi[k] * m, &|j| if j == k { sign } else { 0.0 }), -phi[k] * m));
        }
    }
    minimise(&hessian, &rows).expect("P_0 always has a solution")
}

#[test]
fn closed_form_agrees_with_all_two_to_the_n_inequalities() {
    let mut random = Random(2);
    for case in 0..3000 {
        let n = if case % 30 == 0 { 3 } else { 1 + random.below(2) };
        let phi: Vec<f64> = (0..n).map(|_| random.range(0.01, 2.0)).collect();
        let mass_kg = random.log_range(1e-2, 1e2);
        let impact = SingleImpact { mass_kg, phi: &phi, coefficients: random.coefficients() };
        let closed = impact.coefficients.rebound(moderated_mass_ratio(&impact)).unwrap();
        let mut rates = vec![0.0; n];
        closed.modal_rates(1.0, &phi, &mut rates).unwrap();
        let oracle = p0_with_all_signs(&impact);
        assert!((oracle[0] - closed.restitution).abs() < 1e-11, "{impact:?} {oracle:?} {closed:?}");
        for (found, rate) in oracle[1..].iter().zip(&rates) {
            assert!((found - rate).abs() < 1e-9 * mass_kg.sqrt().max(1.0), "{impact:?} {oracle:?} {rates:?}");
        }
    }
}

#[test]
fn bad_input_is_reported() {
    let good = Coefficients { ebar: 1.0, beta0: 0.5, beta1: 0.5 };
    for mass_kg in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300] {
        let impact = SingleImpact { mass_kg, phi: &[1.0], coefficients: good };
        assert!(impact.solve_full().is_err() && impact.solve_reduced().is_err(), "{mass_kg}");
    }
    let impact = SingleImpact { mass_kg: 1.0, phi: &[1.0, f64::NAN], coefficients: good };
    assert_eq!(
        impact.solve_full().unwrap_err().to_string(),
        "phi[1] = NaN is not allowed; it must be a finite mode shape that leaves the sum of squares finite"
    );
}
