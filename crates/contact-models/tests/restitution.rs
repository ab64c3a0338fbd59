//! Restitution at a wall: closed relations against step-by-step integration, and what the
//! published calibrations achieve.

mod common;

use common::{BALL_MASS_KG, K_H, rebound};
use contact_models::{Flores, Hertz, HuntCrossley, Hysteretic, KelvinVoigt, LankaraniNikravesh};
use contact_models::{Law, LinearSpring, Thornton, Viscous};

fn wall(law: impl Into<Law>, speed_m_s: f64) -> f64 {
    law.into().wall_restitution(BALL_MASS_KG, speed_m_s).unwrap()
}

/// Every law, weakly and strongly dissipating where it can be, with the time its contact lasts.
fn cases() -> Vec<(Law, f64)> {
    let t = 6e-5;
    let omega = (1e8 / BALL_MASS_KG).sqrt();
    vec![
        (Hertz::new(K_H).unwrap().into(), t),
        (Viscous::new(K_H, 0.08).unwrap().into(), t),
        (Viscous::new(K_H, 3.0).unwrap().into(), 2.0 * t),
        (Hysteretic::new(K_H / 4.0, 1.6, 1.4, 0.4, 5e-8).unwrap().into(), t),
        (Hysteretic::new(K_H / 4.0, 1.6, 1.4, 4.0, 1e-7).unwrap().into(), t),
        (LinearSpring::new(1e8).unwrap().into(), 3.0 / omega),
        (KelvinVoigt::with_restitution(1e8, 0.7, BALL_MASS_KG).unwrap().into(), 3.0 / omega),
        (KelvinVoigt::with_restitution(1e8, 0.1, BALL_MASS_KG).unwrap().into(), 3.0 / omega),
        (HuntCrossley::new(1e12, 2.2, 0.3).unwrap().into(), 2.0 * t),
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
            println!("{:20} {speed} {closed:.12} {:.1e}", law.name(), stepped - closed);
            assert!((closed - stepped).abs() < 2e-9, "{law:?} at {speed}: {closed} {stepped}");
        }
    }
}

#[test]
fn published_rules() {
    for e in [0.95, 0.9, 0.8, 0.7, 0.5, 0.3, 0.1] {
        println!(
            "{e} HC {:.3} LN {:.3} FL {:.3}",
            wall(HuntCrossley::with_restitution_first_order(K_H, 1.5, e, 0.7).unwrap(), 0.7),
            wall(LankaraniNikravesh::new(K_H, e).unwrap(), 0.7),
            wall(Flores::new(K_H, e).unwrap(), 0.7)
        );
    }
}
