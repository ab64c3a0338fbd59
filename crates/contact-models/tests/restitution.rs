//! Restitution at a wall: closed relations compared with step-by-step integration, and the restitutions of the published
//! calibrations.

use crate::common::{BALL_MASS_KG, K_H, rebound};
use contact_models::{Felt, Flores, Hertz, HuntCrossley, Hysteretic, KelvinVoigt, LankaraniNikravesh};
use contact_models::{Law, LinearSpring, Power, Thornton, Viscous};

fn wall(law: impl Into<Law>, speed_m_s: f64) -> f64 {
    law.into().wall_restitution(BALL_MASS_KG, speed_m_s).unwrap()
}

/// Every law with weak and, where possible, strong dissipation, with the duration of its contact.
fn cases() -> Vec<(Law, f64)> {
    let t = 6e-5;
    let omega = (1e8 / BALL_MASS_KG).sqrt();
    vec![
        (Hertz::new(K_H).unwrap().into(), t),
        (Viscous::new(K_H, 0.08).unwrap().into(), t),
        (Viscous::new(K_H, 3.0).unwrap().into(), 2.0 * t),
        (
            Hysteretic { stiffness_n_m1_5: K_H / 4.0, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m: 5e-8 }
                .validated()
                .unwrap()
                .into(),
            t,
        ),
        (
            Hysteretic { stiffness_n_m1_5: K_H / 4.0, theta_m: 1.6, beta: 1.4, k_bar: 4.0, epsilon_m: 1e-7 }
                .validated()
                .unwrap()
                .into(),
            t,
        ),
        (LinearSpring::new(1e8).unwrap().into(), 3.0 / omega),
        (KelvinVoigt::with_restitution(1e8, 0.7, BALL_MASS_KG).unwrap().into(), 3.0 / omega),
        (KelvinVoigt::with_restitution(1e8, 0.1, BALL_MASS_KG).unwrap().into(), 3.0 / omega),
        (HuntCrossley::new(1e12, 2.2, 0.3).unwrap().into(), 2.0 * t),
        (Power::new(1e12, 2.2).unwrap().into(), 2.0 * t),
        (Felt::new(1e12, 2.5, 1e-5).unwrap().into(), 4.0 * t),
        (Felt::new(1e12, 2.0, 3e-4).unwrap().into(), 4.0 * t),
        (Felt::new(1e15, 4.5, 1e-4).unwrap().into(), 4.0 * t),
        (LankaraniNikravesh::new(K_H, 0.8).unwrap().into(), t),
        (Flores::new(K_H, 0.3).unwrap().into(), 2.0 * t),
        (Thornton::new(1.1e11, 0.015, 1.2e9).unwrap().into(), t),
    ]
}

#[test]
fn closed_relations_agree_with_integration() {
    for (law, duration) in cases() {
        for speed in [0.3, 1.0] {
            let (closed, stepped) = (wall(law, speed), rebound(&law, BALL_MASS_KG, speed, duration));
            assert!((closed - stepped).abs() < 5e-12, "{law:?} at {speed}: {closed} {stepped}");
        }
    }
}

/// The tables in the documentation of the three laws.
#[test]
fn restitutions_of_the_published_rules() {
    let targets = [0.95, 0.9, 0.8, 0.7, 0.5, 0.3, 0.1];
    let hunt_crossley = [0.952, 0.909, 0.833, 0.768, 0.663, 0.581, 0.516];
    let lankarani_nikravesh = [0.954, 0.913, 0.847, 0.796, 0.725, 0.684, 0.665];
    let flores = [0.947, 0.894, 0.789, 0.683, 0.470, 0.256, 0.069];
    for (i, e) in targets.into_iter().enumerate() {
        for speed in [0.01, 5.0] {
            let first_order = HuntCrossley::with_restitution_first_order(K_H, 1.5, e, speed).unwrap();
            assert!((wall(first_order, speed) - hunt_crossley[i]).abs() < 5.1e-4);
            assert!((wall(LankaraniNikravesh::new(K_H, e).unwrap(), speed) - lankarani_nikravesh[i]).abs() < 5.1e-4);
            assert!((wall(Flores::new(K_H, e).unwrap(), speed) - flores[i]).abs() < 5.1e-4);
        }
    }
}

#[test]
fn exact_calibrations_have_the_required_restitution() {
    for e in [0.001, 0.01, 0.1, 0.5, 0.9, 0.99, 0.9999, 1.0 - 1e-8, 1.0] {
        for speed in [1e-3, 1.0, 30.0] {
            let viscous = wall(Viscous::with_restitution(K_H, e, speed).unwrap(), speed);
            assert!((viscous - e).abs() < 1e-14, "{e} {viscous}");
            let hunt_crossley = wall(HuntCrossley::with_restitution(1e8, 1.0, e, speed).unwrap(), speed);
            assert!((hunt_crossley - e).abs() < 1e-14, "{e} {hunt_crossley}");
            if e < 1.0 {
                let kelvin_voigt = wall(KelvinVoigt::with_restitution(1e8, e, BALL_MASS_KG).unwrap(), speed);
                assert!((kelvin_voigt - e).abs() < 1e-14, "{e} {kelvin_voigt}");
            }
        }
    }
    // Critical damping, where the closed form is a limit.
    let critical = KelvinVoigt::new(1e8, 2.0 * (1e8 * BALL_MASS_KG).sqrt()).unwrap();
    assert!((wall(critical, 1.0) - (-2.0_f64).exp()).abs() < 1e-15);
    // 2 zeta acos(zeta)/sqrt(1 - zeta^2) = 2 - 4 d/3 - 2 d^2/5 - ... with d = 1 - zeta of either sign
    for d in [1e-15, 1e-12, 1e-9, 1e-6, 1e-5, -1e-15, -1e-12, -1e-9, -1e-6, -1e-5] {
        let near = KelvinVoigt { damping_n_s_m: critical.damping_n_s_m * (1.0 - d), ..critical };
        let exact = (-2.0 + d * (4.0 / 3.0 + 0.4 * d)).exp();
        assert!((wall(near, 1.0) / exact - 1.0).abs() < 2e-15, "{d} {} {exact}", wall(near, 1.0));
    }
}

/// Below the lowest approach speed the damping is constant, so that slow impacts have a higher restitution.
#[test]
fn damping_by_approach_speed_is_bounded() {
    let law = LankaraniNikravesh { lowest_approach_speed_m_s: 0.1, ..LankaraniNikravesh::new(K_H, 0.5).unwrap() };
    assert_eq!(wall(law, 0.1), wall(law, 2.0));
    assert!(wall(law, 0.01) > 0.9 && wall(law, 1e-20) <= 1.0);
}

/// Felt with very little damping loses the work of its dashpot along the elastic motion, `1 - e = beta p int x^(p-1) |x'| dx`
/// over loading and unloading; with very much damping the striker creeps back.
#[test]
fn felt_at_the_ends_of_its_range() {
    let (p, mass, speed) = (2.0, 1.0, 1.0);
    // x'^2 = 1 - 2 x^3/3 at p = 2: int_0^xm 2 x sqrt(1 - 2 x^3/3) dx = (3/2)^(2/3) (2/3) B(2/3, 3/2), twice.
    let lost = 2.0 * 1.5_f64.powf(2.0 / 3.0) * (2.0 / 3.0) * 1.1087612396699105;
    for beta in [1e-9, 1e-6, 1e-4] {
        let e = Law::from(Felt::new(1.0, p, beta).unwrap()).wall_restitution(mass, speed).unwrap();
        assert!(((1.0 - e) / (beta * lost) - 1.0).abs() < 1e-3 + 10.0 * beta, "{beta} {} {}", (1.0 - e) / beta, lost);
    }
    let mut last = 1.0;
    for exponent in 0..40 {
        let beta = 1e-10 * 10f64.powi(exponent);
        let e = Law::from(Felt::new(1.0, p, beta).unwrap()).wall_restitution(mass, speed).unwrap();
        assert!(e <= last && e > 0.0, "{beta} {e}");
        last = e;
    }
}

/// Thornton's own closed form for the restitution, in terms of the yield speed.
#[test]
fn thornton_closed_form() {
    let law = Thornton::new(1.1e11, 0.015, 1.2e9).unwrap();
    let yield_speed = law.yield_speed_m_s(BALL_MASS_KG).unwrap();
    assert_eq!(wall(law, 0.999 * yield_speed), 1.0);
    for ratio in [1.0 + 1e-9, 1.5, 10.0, 1000.0] {
        let y: f64 = 1.0 / ratio;
        let bracket = y / (y + 2.0 * (1.2 - 0.2 * y * y).sqrt());
        let e = (1.2 * 3.0_f64.sqrt() * (1.0 - y * y / 6.0)).sqrt() * bracket.powf(0.25);
        assert!((wall(law, ratio * yield_speed) / e - 1.0).abs() < 1e-12, "{ratio}");
    }
}
