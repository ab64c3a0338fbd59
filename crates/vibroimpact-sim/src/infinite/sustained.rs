//! The proof that a contact lasts.
//!
//! In sustained contact the force converges to that of a body attached to the beam, `f_a(t)` (see
//! [`attached`]): the force ratio `r = f / f_a` tends to 1. Around it the compression oscillates. With the
//! tangent stiffness `k = (3/2) sqrt(S x)` at the attached compression,
//! `k = 0.945 S^(1/3) t^(-1/2)`, small oscillations obey `p^2 + (sqrt(pi)/2) k sqrt(p) + k = 0`:
//! the beam damps them at the rate `gamma = 0.300 S^(1/4) t^(-3/8)`, while adiabatic change of `k`
//! (amplitude `~ k^(-1/4)`) and the fall of the compression (`~ 1/t`) let the relative amplitude
//! `a` grow like `t^(9/8)`. Together
//!
//! ```text
//! d ln a / d ln t = 9/8 - gamma t,      gamma t = 0.300 S^(1/4) t^(5/8).
//! ```
//!
//! After the time at which `gamma t = 9/8`, damping prevails more and more, so relative
//! oscillations only decrease from then on. A contact counts as sustained once, over two natural
//! periods, (1) `gamma t` was above `4 * 9/8`, (2) `r` stayed within `[1/2, 3/2]` and (3) its largest
//! deviation from 1 did not grow from the first period to the second (or is below 2 %). A
//! separation needs `r = 0`.
//!
//! On a plate `k` falls with the compression while the damping does too, faster: the body always
//! leaves, whatever `S`, and no contact lasts.

use super::asymptotic::attached;
use super::panel::Panel;
use super::problem::Structure;
use super::rule::{Kind, Tables};

/// Monitors the force ratio of one contact.
pub(super) struct Watch {
    structure: Structure,
    s: f64,
    touch_time: f64,
    /// `(t, |f / f_a - 1|)` at the nodes passed.
    deviations: Vec<(f64, f64)>,
}

impl Watch {
    pub fn new(structure: Structure, s: f64, touch_time: f64) -> Watch {
        Watch { structure, s, touch_time, deviations: Vec::new() }
    }

    /// Records the forces in a panel.
    pub fn see(&mut self, tables: &Tables, panel: &Panel) {
        if self.structure == Structure::Plate || panel.kind != Kind::Middle {
            return;
        }
        for (elapsed, force) in tables.rule(panel.kind).elapsed.iter().zip(&panel.force) {
            let t = self.touch_time + panel.start + panel.h * elapsed;
            self.deviations.push((t, (force / attached(self.structure, t).force - 1.0).abs()));
        }
    }

    /// Whether contact is known to last.
    pub fn lasting(&self) -> bool {
        let (Some(first), Some(last)) = (self.deviations.first(), self.deviations.last()) else { return false };
        if last.1 > 0.5 {
            return false;
        }
        let stiffness = 0.945 * self.s.cbrt() / last.0.sqrt();
        let period = std::f64::consts::TAU / stiffness.sqrt();
        let (begin, middle) = (last.0 - 2.0 * period, last.0 - period);
        let damping = 0.300 * self.s.powf(0.25) * begin.max(0.0).powf(0.625);
        if first.0 > begin || damping < 4.5 {
            return false;
        }
        let (mut early, mut late) = (0.0_f64, 0.0_f64);
        for &(t, deviation) in self.deviations.iter().rev().take_while(|d| d.0 >= begin) {
            if t < middle {
                early = early.max(deviation);
            } else {
                late = late.max(deviation);
            }
        }
        early <= 0.5 && late <= early.max(0.02)
    }
}
