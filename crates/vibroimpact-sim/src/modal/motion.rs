//! The state of an impact, and the record of how it came about.

use super::ladder::Vibration;
use super::legendre::Nodal;
use contact_models::Branch;

/// Everything that moves. The gap between the surfaces at the contact, positive when they overlap, is the sum of the
/// excited elastic modes plus the *drift*: rigid-body modes less the striker, one double integrator together.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Motion {
    pub time: f64,
    pub vibration: Vibration,
    pub drift: f64,
    pub drift_rate: f64,
    /// Impulse so far, and its integral over time: what they did to each rigid mode and to the striker follows.
    pub impulse: f64,
    pub impulse_integral: f64,
}

impl Motion {
    /// Overlap of the surfaces (m).
    pub fn gap(&self) -> f64 {
        self.drift + self.vibration.alpha.iter().sum::<f64>()
    }

    /// Its rate (m/s).
    pub fn gap_rate(&self) -> f64 {
        self.drift_rate + self.vibration.beta.iter().sum::<f64>()
    }

    /// Takes over another motion of as many modes, without new memory.
    pub fn copy_from(&mut self, other: &Motion) {
        self.carry_on_from(other);
        self.vibration.alpha.copy_from_slice(&other.vibration.alpha);
        self.vibration.beta.copy_from_slice(&other.vibration.beta);
    }

    /// Takes over everything but the vibration, which is about to be overwritten.
    pub fn carry_on_from(&mut self, other: &Motion) {
        (self.time, self.drift, self.drift_rate) = (other.time, other.drift, other.drift_rate);
        (self.impulse, self.impulse_integral) = (other.impulse, other.impulse_integral);
    }

    /// The drift over `h` seconds under a force of Legendre coefficients `force`, with inverse mass `mu`; returns how
    /// far it went.
    pub fn advance_drift(&mut self, h: f64, force: &Nodal, mu: f64) -> f64 {
        // int (1-s) P_n ds is 1/2, -1/6 and 0 from then on
        let (impulse, moment) = (h * force[0], h * h * (force[0] / 2.0 - force[1] / 6.0));
        self.time += h;
        self.impulse_integral += self.impulse * h + moment;
        self.impulse += impulse;
        let moved = self.drift_rate * h - mu * moment;
        self.drift += moved;
        self.drift_rate -= mu * impulse;
        moved
    }

    /// The drift over `h` seconds without force.
    pub fn coast(&mut self, h: f64) {
        self.time += h;
        self.impulse_integral += self.impulse * h;
        self.drift += self.drift_rate * h;
    }
}

/// A piece of history between two events: free flight, or one step in contact.
#[derive(Debug, Clone)]
pub(crate) struct Piece {
    pub start: Motion,
    pub contact: Option<ContactPiece>,
}

/// What is needed to evaluate a step in contact at any time.
#[derive(Debug, Clone)]
pub(crate) struct ContactPiece {
    pub length: f64,
    /// Legendre coefficients of the force (N).
    pub force: Nodal,
    pub branch: Branch,
}
