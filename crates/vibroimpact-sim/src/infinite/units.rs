//! The state at the start of a contact, and the units in which it is solved.

use super::problem::Structure;

/// The state at touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub s: f64,
    /// Time of touch (units of `T`).
    pub time: f64,
    /// Closing speed (units of `v`).
    pub closing: f64,
    /// Speed of the body towards the structure (units of `v`).
    pub body: f64,
}

/// Natural units of a contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Units {
    /// Unit of time (units of `T`).
    pub time: f64,
    /// Unit of compression (units of `v T`).
    pub length: f64,
    /// Unit of speed, the closing speed at touch (units of `v`).
    pub speed: f64,
    /// Factor of the kernel `theta - phi`.
    pub linear: f64,
    /// Factor of the structure's kernel.
    pub memory: f64,
    /// Scaled `int xi_+^(3/2)` to impulse (units of `m v`).
    pub impulse: f64,
}

impl Units {
    /// The units of the impact itself.
    pub const OF_IMPACT: Units = Units { time: 1.0, length: 1.0, speed: 1.0, linear: 1.0, memory: 1.0, impulse: 1.0 };

    pub fn new(structure: Structure, s: f64, closing: f64) -> Units {
        let drive = (s * closing).sqrt();
        let power = match structure {
            Structure::Beam => 2.0,
            Structure::Plate => 1.5,
        };
        // Newton in ln(w) on a convex, increasing function; both bounds are close
        let load = |w: f64| drive * (w.powf(2.5) + w.powf(power));
        let mut w = drive.powf(-0.4).min(drive.powf(-1.0 / power));
        for _ in 0..60 {
            let (linear, memory) = (drive * w.powf(2.5), drive * w.powf(power));
            let step = load(w).ln() * (linear + memory) / (2.5 * linear + power * memory);
            w *= (-step).exp();
            if step.abs() < 1e-15 {
                break;
            }
        }
        let linear = drive * w.powf(2.5);
        let memory = drive * w.powf(power);
        Units { time: w, length: closing * w, speed: closing, linear, memory, impulse: closing * linear }
    }
}
