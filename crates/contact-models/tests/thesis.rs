//! Numbers that the thesis states for its three laws.

use contact_models::{Body, Hertz, Hysteretic, Law, Viscous, trace};
use std::f64::consts::PI;

const BALL_MASS_KG: f64 = 0.11027;
const K_H: f64 = 1.7945e10;

#[test]
fn hertz_stiffness_of_the_steel_ball_on_the_beam() {
    let ball = Body { youngs_modulus_pa: 2e11, poissons_ratio: 0.3, radius_m: 0.015 };
    let law = Hertz::from_bodies(&ball, &Body::flat(2e11, 0.3)).unwrap();
    // Eq. 3.14 itself, and the five digits of Eq. 3.20.
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
        let law = Law::from(
            Hysteretic { stiffness_n_m1_5: K_H / 4.0, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m: eps }
                .validated()
                .unwrap(),
        );
        law.wall_restitution(BALL_MASS_KG, speed).unwrap()
    };
    let limit = ((1.2 / 2.5 + 2.8 / 2.9_f64) / 1.6).sqrt();
    assert!((restitution(0.0, 1.0) - limit).abs() < 1e-14);
    assert!((restitution(0.0, 0.3) - limit).abs() < 1e-14);
    // Fig. 3.8: close to 0.95, decreasing very slightly with increasing velocity.
    let [slow, middle, fast] = [0.6, 0.9, 1.2].map(|speed| restitution(5e-8, speed));
    assert!(slow > middle && middle > fast && fast > limit && slow < limit + 1e-3);
}

/// Fig. 3.2: the closed form of `theta` compared with Eq. 3.17 integrated in time.
#[test]
fn hysteresis_loops_satisfy_the_differential_equation() {
    let (theta_m, beta, k_bar, eps) = (1.6, 1.4, 4.0, 1e-4);
    let law = Hysteretic { stiffness_n_m1_5: 1.0, theta_m, beta, k_bar, epsilon_m: eps }.validated().unwrap();
    let motion = |t: f64| {
        let (slow, fast) = (2.0 * PI * t, 8.0 * PI * t);
        (slow.sin() + 0.5 * fast.sin(), 2.0 * PI * slow.cos() + 4.0 * PI * fast.cos())
    };
    let theta_rate = |t: f64, theta: f64| {
        let (xi, rate) = motion(t);
        k_bar * (theta_m + beta * (xi * rate).signum() - theta) * rate.abs() / (xi.abs() + eps)
    };
    let times: Vec<f64> = (0..=400).map(|i| f64::from(i) / 400.0).collect();
    let path = trace(&law, &times, motion).unwrap();
    let (mut theta, mut reversals, mut lowest) = (theta_m + beta, 0, f64::INFINITY);
    for pair in times.windows(2) {
        let steps = 4000;
        let h = (pair[1] - pair[0]) / f64::from(steps);
        for i in 0..steps {
            let t = pair[0] + f64::from(i) * h;
            if motion(t).0 <= 0.0 {
                theta = theta_m + beta; // Every contact starts anew.
                continue;
            }
            reversals += i32::from(motion(t).1 * motion(t + h).1 < 0.0);
            let k1 = theta_rate(t, theta);
            let k2 = theta_rate(t + 0.5 * h, theta + 0.5 * h * k1);
            theta += h * theta_rate(t + 0.75 * h, theta + 0.75 * h * k2) * 4.0 / 9.0 + h * (2.0 * k1 + 3.0 * k2) / 9.0;
            lowest = theta.min(lowest);
        }
        let point = path.iter().find(|point| point.time_s == pair[1]).unwrap();
        let force = point.compression_m.max(0.0).powf(1.5) * (1.0 + theta);
        assert!((point.force_n - force).abs() < 1e-6, "t = {}: {} {force}", pair[1], point.force_n);
    }
    // The motion has minor loops, and theta covers its range.
    assert!(reversals >= 4 && lowest < theta_m - 0.99 * beta, "{reversals} {lowest}");
}

/// The statement on minor loops in the documentation of the law: below `theta_m` they return more work than they receive, while
/// complete contacts lose energy.
#[test]
fn minor_loops_of_the_hysteretic_law() {
    let law =
        Hysteretic { stiffness_n_m1_5: 1.0, theta_m: 1.6, beta: 1.4, k_bar: 4.0, epsilon_m: 0.0 }.validated().unwrap();
    // From each of these compressions to the next in unit time, along half a cosine.
    let turns = [-0.1, 1.0, 0.5, 0.55, 0.5, -0.1];
    let motion = |t: f64| {
        let i = (t as usize).min(turns.len() - 2);
        let (phase, swing) = (PI * (t - i as f64), turns[i + 1] - turns[i]);
        (turns[i] + 0.5 * swing * (1.0 - phase.cos()), 0.5 * PI * swing * phase.sin())
    };
    let times: Vec<f64> = (0..=500).map(|i| f64::from(i) / 100.0).collect();
    let path = trace(&law, &times, motion).unwrap();
    let at = |time: f64| path.iter().find(|point| point.time_s == time).unwrap();
    assert!(at(4.0).work_j < at(2.0).work_j - 1e-4 && at(4.0).stored_energy_j > at(2.0).stored_energy_j + 1e-4);
    assert!(at(5.0).work_j > 0.5);
}
