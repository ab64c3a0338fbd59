//! The same impact in another unit of time: its result is the same, while its dyadic steps differ.
//!
//! Steps are powers of two of a second. Two solutions of different tolerances share many of these steps and therefore their
//! errors. With times written in another unit, every step differs from those in seconds.

use super::problem::{Mode, Start, Striker};
use contact_models::{After, Boundary, Branch, ContactLaw, Force, Memory};

/// A unit of time, given by its number in a second.
#[derive(Clone, Copy)]
pub(crate) struct Unit(pub f64);

/// A law between compressions and their rates per unit.
pub(crate) struct Law<'a> {
    law: &'a dyn ContactLaw,
    units: f64,
}

impl Unit {
    /// Modes with their frequencies per unit.
    pub fn modes(self, modes: &[Mode]) -> Vec<Mode> {
        modes.iter().map(|mode| Mode { omega_rad_s: mode.omega_rad_s / self.0, ..*mode }).collect()
    }

    /// The striker with its speed per unit.
    pub fn striker(self, striker: &Striker) -> Striker {
        Striker { speed_m_s: striker.speed_m_s / self.0, ..*striker }
    }

    /// The motion at the start with its rates per unit.
    pub fn start(self, start: &Start) -> Start {
        Start { rate: start.rate.iter().map(|rate| rate / self.0).collect(), ..start.clone() }
    }

    /// A time in this unit in seconds.
    pub fn seconds(self, time: f64) -> f64 {
        time / self.0
    }

    /// The law between compressions and their rates per unit.
    pub fn law(self, law: &dyn ContactLaw) -> Law<'_> {
        Law { law, units: self.0 }
    }
}

impl ContactLaw for Law<'_> {
    fn touch(&self, memory: &Memory, approach_speed_m_s: f64) -> Branch {
        self.law.touch(memory, approach_speed_m_s * self.units)
    }

    fn force(&self, branch: &Branch, compression_m: f64, rate_m_s: f64) -> Force {
        let force = self.law.force(branch, compression_m, rate_m_s * self.units);
        Force {
            force_n: force.force_n / (self.units * self.units),
            per_compression_n_m: force.per_compression_n_m / (self.units * self.units),
            per_rate_n_s_m: force.per_rate_n_s_m / self.units,
        }
    }

    fn stored_energy_j(&self, branch: &Branch, compression_m: f64) -> f64 {
        self.law.stored_energy_j(branch, compression_m) / (self.units * self.units)
    }

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        let boundary = self.law.boundary(branch, which)?;
        Some(Boundary { per_rate: boundary.per_rate * self.units, ..boundary })
    }

    fn cross(&self, branch: &Branch, which: usize, compression_m: f64, rate_m_s: f64) -> After {
        self.law.cross(branch, which, compression_m, rate_m_s * self.units)
    }
}
