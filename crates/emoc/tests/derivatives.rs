//! Analytic derivatives compared with differences, the ranges of the restitution, and single precision.

use crate::common::Random;
use emoc::{Branch, Coefficients, Impact, ParameterGradient, Parameters, Site, newton_restitution};

/// Central difference of fourth order.
fn difference(f: impl Fn(f64) -> f64, x: f64) -> f64 {
    let h = 1e-3 * x.abs().max(1e-3);
    (8.0 * (f(x + h) - f(x - h)) - (f(x + 2.0 * h) - f(x - 2.0 * h))) / (12.0 * h)
}

fn random_case(random: &mut Random) -> (Parameters<f64>, f64, Site<f64>) {
    let phi: Vec<f64> = (0..1 + random.below(50)).map(|_| random.range(-2.0, 2.0)).collect();
    let parameters = Parameters {
        mu0: random.log_range(1e-2, 1e2),
        alpha0: random.log_range(1e-2, 1e2),
        alpha1: random.log_range(1e-2, 1e2),
        notional_restitution: random.range(0.1, 0.9),
    };
    (parameters, random.log_range(1e-3, 1e1), Site::new(&phi).unwrap())
}

#[test]
fn gradients_are_those_of_differences_on_both_branches() {
    let mut random = Random(3);
    let mut seen = [0, 0];
    while seen[0].min(seen[1]) < 500 {
        let (p, mass, site) = random_case(&mut random);
        let e = |p: Parameters<f64>, mass: f64| p.rebound(&Impact::new(mass, &site).unwrap()).unwrap().restitution;
        let (rebound, gradient) = p.rebound_with_gradient(&Impact::new(mass, &site).unwrap()).unwrap();
        if rebound.kink_margin.abs() < 0.02 {
            continue; // Differences must not cross the kink.
        }
        seen[usize::from(rebound.branch == Branch::Outward)] += 1;
        let notional = p.notional_restitution;
        let pairs = [
            (gradient.per_mu0, difference(|x| e(Parameters { mu0: x, ..p }, mass), p.mu0), p.mu0),
            (gradient.per_alpha0, difference(|x| e(Parameters { alpha0: x, ..p }, mass), p.alpha0), p.alpha0),
            (gradient.per_alpha1, difference(|x| e(Parameters { alpha1: x, ..p }, mass), p.alpha1), p.alpha1),
            (
                gradient.per_notional_restitution,
                difference(|x| e(Parameters { notional_restitution: x, ..p }, mass), notional),
                notional,
            ),
            (gradient.per_mass_per_kg, difference(|x| e(p, x), mass), mass),
        ];
        for (which, (analytic, numeric, at)) in pairs.into_iter().enumerate() {
            assert!((analytic - numeric).abs() * at < 1e-10, "{which}: {analytic} {numeric} {p:?} {rebound:?}");
        }
    }
}

#[test]
fn gradient_in_the_coefficients_is_that_of_differences() {
    let mut random = Random(4);
    for _ in 0..1000 {
        let c =
            Coefficients { ebar: random.range(0.1, 0.9), beta0: random.range(0.1, 3.0), beta1: random.range(0.1, 0.9) };
        let z = random.log_range(1e-2, 1e2);
        let (rebound, gradient) = c.rebound_with_gradient(z).unwrap();
        if rebound.kink_margin.abs() < 0.01 {
            continue;
        }
        let e = |c: Coefficients<f64>, z: f64| c.rebound(z).unwrap().restitution;
        for (analytic, numeric) in [
            (gradient.per_ebar, difference(|x| e(Coefficients { ebar: x, ..c }, z), c.ebar)),
            (gradient.per_beta0, difference(|x| e(Coefficients { beta0: x, ..c }, z), c.beta0)),
            (gradient.per_beta1, difference(|x| e(Coefficients { beta1: x, ..c }, z), c.beta1)),
            (gradient.per_z, difference(|x| e(c, x), z)),
        ] {
            assert!((analytic - numeric).abs() < 1e-9, "{analytic} {numeric}");
        }
    }
}

#[test]
fn at_the_kink_the_branches_meet_and_their_slopes_do_not() {
    let c: Coefficients<f64> = Coefficients { ebar: 1.0, beta0: 0.5, beta1: 0.25 }; // kink at Z = 1
    let (before, slope_before) = c.rebound_with_gradient(1.0 - 1e-12).unwrap();
    let (after, slope_after) = c.rebound_with_gradient(1.0 + 1e-12).unwrap();
    assert_eq!((before.branch, after.branch), (Branch::Basic, Branch::Outward));
    assert!((before.restitution - after.restitution).abs() < 1e-11);
    assert!((slope_before.per_z + 0.25).abs() < 1e-11 && slope_after.per_z == 0.0);
    assert!((before.recoil - after.recoil).abs() < 1e-11);
}

/// Numbers from the smallest to the largest that a double holds.
const EXTREMES: [f64; 9] = [0.0, 5e-324, 1e-300, 1e-8, 1.0, 1e8, 1e154, 1e300, f64::MAX];

#[test]
fn extreme_numbers_give_numbers_or_errors() {
    for a in EXTREMES {
        for b in EXTREMES {
            for c in EXTREMES {
                let p = Parameters { mu0: a, alpha0: b, alpha1: c, notional_restitution: 1.0 };
                for mass in EXTREMES {
                    for phi in [[0.0, 0.0], [1e-160, 1e-160], [1.0, 2.0], [1e150, 1.0], [1e200, 1.0]] {
                        let Ok(site) = Site::new(&phi) else { continue };
                        let Ok(impact) = Impact::new(mass, &site) else { continue };
                        let (rebound, gradient) = match p.rebound_with_gradient(&impact) {
                            Ok(both) => both,
                            Err(fault) => {
                                let mass_alone =
                                    fault.to_string().starts_with("mass_kg = 5e-324 is not allowed; it must be");
                                assert!(mass_alone && p.rebound(&impact).is_ok(), "{p:?} {impact:?} {fault}");
                                continue;
                            }
                        };
                        assert!((0.0..=1.0).contains(&rebound.restitution), "{p:?} {impact:?} {rebound:?}");
                        assert!((0.0..=1.0).contains(&rebound.recoil));
                        let ParameterGradient { per_mu0, per_alpha0, per_alpha1, per_mass_per_kg, .. } = gradient;
                        for slope in [per_mu0, per_alpha0, per_alpha1, per_mass_per_kg] {
                            assert!(slope.is_finite(), "{p:?} {impact:?} {gradient:?}");
                        }
                    }
                }
            }
        }
    }
    let site = Site::new(&[1.0]).unwrap();
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        assert!(Impact::new(bad, &site).is_err() && Site::new(&[bad * f64::INFINITY]).is_err());
        let good = Parameters::default();
        let impact = Impact::new(1.0, &site).unwrap();
        for p in [
            Parameters { mu0: bad, ..good },
            Parameters { alpha0: bad, ..good },
            Parameters { alpha1: bad, ..good },
            Parameters { notional_restitution: bad, ..good },
        ] {
            assert!(p.rebound(&impact).is_err());
        }
        assert!(newton_restitution(bad, 1.0).is_err() && newton_restitution(0.5, bad).is_err());
    }
    let error = Impact::new(-0.5, &site).unwrap_err();
    assert_eq!(error.to_string(), "mass_kg = -0.5 is not allowed; it must be a finite number greater than 0");
}

#[test]
fn limits_of_the_three_parameter_form() {
    let site = Site::new(&[1.0, 0.5]).unwrap();
    let e = |p: &Parameters<f64>, mass| p.rebound(&Impact::new(mass, &site).unwrap()).unwrap().restitution;
    let p = Parameters::default();
    // Eq. 7.4: 1 at both ends of Z, 2/3 at Z = 1/mu_0.
    assert!((e(&p, 1e-12) - 1.0).abs() < 1e-11 && (e(&p, 1e12) - 1.0).abs() < 1e-11);
    let coefficients = p.coefficients(&Impact::new(0.8, &site).unwrap()).unwrap();
    assert!((coefficients.ebar - 2.0 / 3.0).abs() < 1e-15);
    // A structure without modes is rigid.
    let rigid = Site::new(&[]).unwrap();
    let p = Parameters { notional_restitution: 0.6, ..p };
    assert_eq!(p.rebound(&Impact::new(1.0, &rigid).unwrap()).unwrap().restitution, 0.6);
}

#[test]
fn single_precision_gives_the_same_to_its_digits() {
    let mut random = Random(5);
    for _ in 0..1000 {
        let (p, mass, site) = random_case(&mut random);
        let double = p.rebound(&Impact::new(mass, &site).unwrap()).unwrap();
        let p = Parameters {
            mu0: p.mu0 as f32,
            alpha0: p.alpha0 as f32,
            alpha1: p.alpha1 as f32,
            notional_restitution: p.notional_restitution as f32,
        };
        let site = Site {
            sum_phi_squared_per_kg: site.sum_phi_squared_per_kg as f32,
            first_phi_squared_per_kg: site.first_phi_squared_per_kg as f32,
            modes: site.modes,
        };
        let single = p.rebound(&Impact::new(mass as f32, &site).unwrap()).unwrap();
        assert!((f64::from(single.restitution) - double.restitution).abs() < 1e-6);
    }
}
