//! Parameters out of range are reported with field, value and what is allowed.

use contact_models::{Body, Felt, Flores, Hertz, HuntCrossley, Hysteretic, InvalidInput, KelvinVoigt};
use contact_models::{LankaraniNikravesh, Law, LinearSpring, Memory, Power, Thornton, Viscous};
use contact_models::{effective_modulus_pa, effective_radius_m, trace};

const BAD: [f64; 6] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 1e31, 1e-320];

const HYSTERETIC: Hysteretic =
    Hysteretic { stiffness_n_m1_5: 1.0, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m: 0.0 };

fn field<T: std::fmt::Debug>(result: Result<T, InvalidInput>) -> String {
    result.unwrap_err().field.to_string()
}

#[test]
fn parameters_of_every_law() {
    for bad in BAD {
        assert_eq!(field(Hertz::new(bad)), "stiffness_n_m1_5");
        assert_eq!(field(LinearSpring::new(bad)), "stiffness_n_m");
        assert_eq!(field(Viscous::new(bad, 0.1)), "stiffness_n_m1_5");
        assert_eq!(field(Hysteretic { stiffness_n_m1_5: bad, ..HYSTERETIC }.validated()), "stiffness_n_m1_5");
        assert_eq!(field(Hysteretic { theta_m: bad, ..HYSTERETIC }.validated()), "theta_m");
        assert_eq!(field(Hysteretic { k_bar: bad, ..HYSTERETIC }.validated()), "k_bar");
        assert_eq!(field(KelvinVoigt::new(bad, 1.0)), "stiffness_n_m");
        assert_eq!(field(KelvinVoigt::new(1.0, bad)), "damping_n_s_m");
        assert_eq!(field(HuntCrossley::new(bad, 1.5, 0.1)), "stiffness_n_m_n");
        assert_eq!(field(HuntCrossley::new(1.0, bad, 0.1)), "exponent");
        assert_eq!(field(Power::new(bad, 1.5)), "stiffness_n_m_n");
        assert_eq!(field(Power::new(1.0, bad)), "exponent");
        assert_eq!(field(Felt::new(bad, 2.5, 1e-4)), "stiffness_n_m_n");
        assert_eq!(field(Felt::new(1.0, bad, 1e-4)), "exponent");
        assert_eq!(field(Felt::new(1.0, 2.5, bad)), "retardation_time_s");
        assert_eq!(field(LankaraniNikravesh::new(bad, 0.9)), "stiffness_n_m1_5");
        assert_eq!(field(LankaraniNikravesh::new(1.0, bad)), "restitution");
        assert_eq!(field(Flores::new(bad, 0.9)), "stiffness_n_m1_5");
        assert_eq!(field(Flores::new(1.0, bad)), "restitution");
        assert_eq!(field(Thornton::new(bad, 1.0, 1.0)), "effective_modulus_pa");
        assert_eq!(field(Thornton::new(1.0, bad, 1.0)), "effective_radius_m");
        assert_eq!(field(Thornton::new(1.0, 1.0, bad)), "yield_pressure_pa");
        assert_eq!(field(Viscous::with_restitution(1.0, bad, 1.0)), "restitution");
        assert_eq!(field(Viscous::with_restitution(1.0, 0.9, bad)), "speed_m_s");
        assert_eq!(field(HuntCrossley::with_restitution(1.0, 1.5, 0.9, bad)), "speed_m_s");
        assert_eq!(field(HuntCrossley::with_restitution_first_order(1.0, 1.5, bad, 1.0)), "restitution");
        assert_eq!(field(KelvinVoigt::with_restitution(1.0, bad, 1.0)), "restitution");
        assert_eq!(field(KelvinVoigt::with_restitution(1.0, 0.9, bad)), "mass_kg");
    }
    for bad in [f64::NAN, f64::INFINITY, -0.1] {
        assert_eq!(field(Viscous::new(1.0, bad)), "damping_s_m");
        assert_eq!(field(HuntCrossley::new(1.0, 1.5, bad)), "damping_s_m");
        assert_eq!(field(Hysteretic { beta: bad, ..HYSTERETIC }.validated()), "beta");
        assert_eq!(field(Hysteretic { epsilon_m: bad, ..HYSTERETIC }.validated()), "epsilon_m");
    }
    // the recovery of an elastoplastic contact is larger than the rounding of its compression
    for (pressure, valid) in [(1e2, true), (0.99e2, false), (1e-30, false)] {
        assert_eq!(Thornton::new(1e11, 0.01, pressure).is_ok(), valid);
    }
    assert_eq!(field(Thornton::new(1e11, 0.01, 1e-6)), "yield_pressure_pa");
    assert_eq!(field(Hysteretic { beta: 2.7, ..HYSTERETIC }.validated()), "beta");
    // The ends of the range of exponents.
    for (exponent, power, felt) in [(0.99, false, false), (1.0, true, false), (1.99, true, false), (2.0, true, true)] {
        assert_eq!((Power::new(1.0, exponent).is_ok(), Felt::new(1.0, exponent, 1.0).is_ok()), (power, felt));
    }
    assert!(Power::new(1.0, 6.01).is_err() && Felt::new(1.0, 6.01, 1.0).is_err());
    let message = Viscous::new(1.0, -0.1).unwrap_err().to_string();
    assert_eq!(message, "damping_s_m = -0.1 is not allowed; it must be a number from 0 to 1e30");
}

#[test]
fn a_changed_field_can_be_checked_again() {
    let mut law = Hertz::new(1.0).unwrap();
    law.stiffness_n_m1_5 = f64::NAN;
    assert_eq!(field(Law::from(law).validated()), "stiffness_n_m1_5");
}

#[test]
fn wall_restitution_needs_a_striker() {
    let law = Law::from(Hertz::new(1.0).unwrap());
    for bad in BAD {
        assert_eq!(field(law.wall_restitution(bad, 1.0)), "mass_kg");
        assert_eq!(field(law.wall_restitution(1.0, bad)), "speed_m_s");
    }
}

/// The limits of the ranges of parameters, mass and speed.
#[test]
fn extremes_stay_finite() {
    use contact_models::ContactLaw;
    let ends = [1e-30, 1.0, 1e30];
    for a in ends {
        for b in ends {
            for c in ends {
                let laws: [Law; 11] = [
                    Hertz::new(a).unwrap().into(),
                    LinearSpring::new(a).unwrap().into(),
                    Viscous::new(a, b).unwrap().into(),
                    Hysteretic {
                        stiffness_n_m1_5: a,
                        theta_m: b,
                        beta: b.min(1.0),
                        k_bar: c.min(1000.0),
                        epsilon_m: c,
                    }
                    .validated()
                    .unwrap()
                    .into(),
                    KelvinVoigt::new(a, b).unwrap().into(),
                    HuntCrossley::new(a, 6.0, b).unwrap().into(),
                    Power::new(a, 6.0).unwrap().into(),
                    Felt::new(a, if c < 1.0 { 2.0 } else { 6.0 }, b).unwrap().into(),
                    LankaraniNikravesh::new(a, 0.5).unwrap().into(),
                    Flores { lowest_approach_speed_m_s: b, ..Flores::new(a, 0.001).unwrap() }.into(),
                    Thornton::new(a, b, c.max(1e-9 * a)).unwrap().into(),
                ];
                for law in laws {
                    let law = law.validated().unwrap();
                    for mass in ends {
                        for speed in ends {
                            let e = law.wall_restitution(mass, speed).unwrap();
                            assert!((0.0..=1.0 + 1e-12).contains(&e), "{law:?} {mass} {speed}: {e}");
                        }
                    }
                    let branch = law.touch(&Memory::default(), 0.0);
                    for x in [-f64::MAX, 0.0, f64::MIN_POSITIVE, 1e-30, 1.0, f64::MAX] {
                        for v in [-f64::MAX, 0.0, f64::MAX] {
                            let force = law.force(&branch, x, v);
                            let numbers = [force.force_n, force.per_compression_n_m, force.per_rate_n_s_m];
                            assert!(numbers.iter().all(|n| n.is_finite()), "{law:?} {x} {v} {force:?}");
                            assert!(law.stored_energy_j(&branch, x).is_finite(), "{law:?} {x}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn pairs_of_bodies() {
    let steel = |radius_m: f64| Body { youngs_modulus_pa: 2e11, poissons_ratio: 0.3, radius_m };
    // Two equal balls have half the radius; against a rigid one, twice the modulus of equal bodies.
    assert!((effective_radius_m(&steel(0.02), &steel(0.02)).unwrap() - 0.01).abs() < 1e-16);
    let like = effective_modulus_pa(&steel(0.02), &steel(0.02)).unwrap();
    let rigid = effective_modulus_pa(&steel(0.02), &Body::rigid(f64::INFINITY)).unwrap();
    assert!((rigid / like - 2.0).abs() < 1e-15);
    // A ball in a wider seat.
    assert!((effective_radius_m(&steel(0.02), &steel(-0.04)).unwrap() - 0.04).abs() < 1e-16);
    for (first, second) in [(0.02, -0.02), (0.04, -0.02), (f64::INFINITY, f64::INFINITY), (0.0, 1.0), (f64::NAN, 1.0)] {
        assert_eq!(field(effective_radius_m(&steel(first), &steel(second))), "radius_m");
    }
    assert_eq!(field(effective_modulus_pa(&Body::rigid(1.0), &Body::rigid(1.0))), "youngs_modulus_pa");
    let wrong = |nu: f64| effective_modulus_pa(&Body::flat(2e11, nu), &steel(1.0));
    for nu in [-1.0, 0.51, f64::NAN] {
        assert_eq!(field(wrong(nu)), "poissons_ratio");
    }
    assert_eq!(field(Hertz::from_bodies(&Body::flat(-1.0, 0.3), &steel(1.0))), "youngs_modulus_pa");
}

#[test]
fn motions_that_cannot_be_followed() {
    let law = Hertz::new(1.0).unwrap();
    assert_eq!(field(trace(&law, &[0.0, 0.0], |_| (0.0, 0.0))), "times_s");
    assert_eq!(field(trace(&law, &[0.0, f64::NAN], |_| (0.0, 0.0))), "times_s");
    assert_eq!(field(trace(&law, &[0.0, 1.0], |t| (t / 0.0, 0.0))), "compression_m");
    assert_eq!(field(trace(&law, &[0.0, 1.0], |_| (0.0, f64::INFINITY))), "rate_m_s");
    assert_eq!(field(trace(&law, &[0.0, 1.0], |t| (1e300 * t, 1.0))), "compression_m");
    assert!(trace(&law, &[], |_| (0.0, 0.0)).unwrap().is_empty());
    // A rate that is not that of the compression gives a meaningless result, but ends.
    let thornton = Thornton::new(1.0, 1.0, 0.1).unwrap();
    let path = trace(&thornton, &[0.0, 1.0, 2.0, 3.0], |t| (t - 1.5, -1.0)).unwrap();
    assert!(path.len() >= 4 && path.iter().all(|point| point.force_n.is_finite()));
}
