//! Numbers that the thesis states for its three laws.

use contact_models::{Body, Hertz, Hysteretic, Law, Viscous};

const BALL_MASS_KG: f64 = 0.11027;
const K_H: f64 = 1.7945e10;

#[test]
fn hertz_stiffness_of_the_steel_ball_on_the_beam() {
    let ball = Body { youngs_modulus_pa: 2e11, poissons_ratio: 0.3, radius_m: 0.015 };
    let law = Hertz::from_bodies(&ball, &Body::flat(2e11, 0.3)).unwrap();
    // Eq. 3.14 itself, and the five digits of Eq. 3.20
    let eq_3_14 = 2.0 * 2e11 * 0.015_f64.sqrt() / (3.0 * (1.0 - 0.09));
    assert!((law.stiffness_n_m1_5 / eq_3_14 - 1.0).abs() < 1e-15);
    assert!((law.stiffness_n_m1_5 - K_H).abs() < 0.5e6);
}

#[test]
fn viscous_restitution_at_the_wall() {
    let law = Law::from(Viscous::new(K_H, 0.08).unwrap());
    let e = law.wall_restitution(BALL_MASS_KG, 1.0).unwrap();
    assert!((e - 0.95).abs() < 0.001, "{e}");
}

#[test]
fn hysteretic_restitution_at_the_wall() {
    let restitution = |eps: f64, speed: f64| {
        let law = Law::from(Hysteretic::new(K_H / 4.0, 1.6, 1.4, 0.4, eps).unwrap());
        law.wall_restitution(BALL_MASS_KG, speed).unwrap()
    };
    let limit = ((1.2 / 2.5 + 2.8 / 2.9_f64) / 1.6).sqrt();
    assert!((restitution(0.0, 1.0) - limit).abs() < 1e-14);
    assert!((restitution(0.0, 0.3) - limit).abs() < 1e-14);
    // Fig. 3.8: close to 0.95, decreasing very slightly with increasing velocity
    let [slow, middle, fast] = [0.6, 0.9, 1.2].map(|speed| restitution(5e-8, speed));
    println!("{slow} {middle} {fast}");
    assert!(slow > middle && middle > fast && fast > limit && slow < limit + 1e-3);
}
