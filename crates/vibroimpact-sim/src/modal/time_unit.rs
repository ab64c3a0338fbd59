//! The same impact in another unit of time: its result is the same, while its dyadic steps differ.
//!
//! Steps are powers of two of a second. Two solutions of different tolerances share many of them, and so what these steps
//! get wrong. With times written in units of `sqrt(1/2)` s all steps lie between those of before.

use super::problem::{Mode, Start, Striker};
use contact_models::{After, Boundary, Branch, ContactLaw, Force, Memory};
use std::f64::consts::SQRT_2;

/// So many units make a second.
const UNITS: f64 = SQRT_2;

/// Modes with their frequencies per unit.
pub(crate) fn modes(modes: &[Mode]) -> Vec<Mode> {
    modes.iter().map(|mode| Mode { omega_rad_s: mode.omega_rad_s / UNITS, ..*mode }).collect()
}

/// The striker with its speed per unit.
pub(crate) fn striker(striker: &Striker) -> Striker {
    Striker { speed_m_s: striker.speed_m_s / UNITS, ..*striker }
}

/// The motion at the start with its rates per unit.
pub(crate) fn start(start: &Start) -> Start {
    Start { rate: start.rate.iter().map(|rate| rate / UNITS).collect(), ..start.clone() }
}

/// A law between compressions and their rates per unit.
pub(crate) struct Law<'a>(pub &'a dyn ContactLaw);

impl ContactLaw for Law<'_> {
    fn touch(&self, memory: &Memory, approach_speed_m_s: f64) -> Branch {
        self.0.touch(memory, approach_speed_m_s * UNITS)
    }

    fn force(&self, branch: &Branch, compression_m: f64, rate_m_s: f64) -> Force {
        let force = self.0.force(branch, compression_m, rate_m_s * UNITS);
        Force {
            force_n: force.force_n / (UNITS * UNITS),
            per_compression_n_m: force.per_compression_n_m / (UNITS * UNITS),
            per_rate_n_s_m: force.per_rate_n_s_m / UNITS,
        }
    }

    fn stored_energy_j(&self, branch: &Branch, compression_m: f64) -> f64 {
        self.0.stored_energy_j(branch, compression_m) / (UNITS * UNITS)
    }

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        let boundary = self.0.boundary(branch, which)?;
        Some(Boundary { per_rate: boundary.per_rate * UNITS, ..boundary })
    }

    fn cross(&self, branch: &Branch, which: usize, compression_m: f64, rate_m_s: f64) -> After {
        self.0.cross(branch, which, compression_m, rate_m_s * UNITS)
    }
}
