//! A plain striker at a wall, integrated step by step through the contract of a law.

#![allow(dead_code)] // each test binary uses a part

use contact_models::{After, Branch, ContactLaw, Memory};

pub const BALL_MASS_KG: f64 = 0.11027;
pub const K_H: f64 = 1.7945e10;

/// Speed ratio of a rigid striker after its contact with a wall, by the classical Runge-Kutta
/// method with steps of `duration_s / 20000`, landing on every boundary.
pub fn rebound(law: &impl ContactLaw, mass_kg: f64, speed_m_s: f64, duration_s: f64) -> f64 {
    let mut branch = law.touch(&Memory::default(), speed_m_s);
    let mut state = (0.0, speed_m_s);
    let h = duration_s / 20000.0;
    for _ in 0..10_000_000 {
        let full = step(law, &branch, mass_kg, state, h);
        let boundaries = law.boundaries(&branch);
        let margin = |which: usize, (xi, rate): (f64, f64)| boundaries[which].margin(xi, rate);
        let Some(which) = (0..2).find(|&which| margin(which, full) < 0.0) else {
            state = full;
            continue;
        };
        let (mut inside, mut beyond) = (0.0, h);
        for _ in 0..60 {
            let middle = 0.5 * (inside + beyond);
            *(if margin(which, step(law, &branch, mass_kg, state, middle)) < 0.0 {
                &mut beyond
            } else {
                &mut inside
            }) = middle;
        }
        state = step(law, &branch, mass_kg, state, beyond);
        match law.cross(&branch, which, state.0, state.1) {
            After::Continue(next) => branch = next,
            After::Release(_) => return -state.1 / speed_m_s,
        }
    }
    panic!("the contact does not end");
}

fn step(law: &impl ContactLaw, branch: &Branch, mass_kg: f64, (xi, v): (f64, f64), h: f64) -> (f64, f64) {
    let slope = |xi: f64, v: f64| (v, -law.force(branch, xi, v).force_n / mass_kg);
    let k1 = slope(xi, v);
    let k2 = slope(xi + 0.5 * h * k1.0, v + 0.5 * h * k1.1);
    let k3 = slope(xi + 0.5 * h * k2.0, v + 0.5 * h * k2.1);
    let k4 = slope(xi + h * k3.0, v + h * k3.1);
    (xi + h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0), v + h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1))
}
