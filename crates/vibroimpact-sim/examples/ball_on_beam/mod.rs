//! The structure and the striker of the examples.

use vibroimpact_sim::modal::{Mode, Striker, Structure};

/// A pinned beam of 1 kg and 1 m in its first three modes, struck at 0.4 m by a ball of 0.11 kg at 1 m/s.
pub fn ball_on_beam() -> (Structure, Striker) {
    let mode = |k: f64| Mode {
        omega_rad_s: 165.0 * k * k,
        damping_ratio: 0.02,
        shape: 2f64.sqrt() * (0.4 * std::f64::consts::PI * k).sin(),
    };
    (Structure { modes: [1.0, 2.0, 3.0].map(mode).to_vec() }, Striker { mass_kg: 0.11, speed_m_s: 1.0 })
}
