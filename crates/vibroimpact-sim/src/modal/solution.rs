//! The result of an impact.

pub use crate::assembly::Counts;
pub use crate::outcome::Outcome;

/// One interval of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SubImpact {
    /// First touch (s).
    pub start_s: f64,
    /// Separation (s), or the end of the computation if it came first.
    pub end_s: f64,
    /// Impulse of the contact force (N s).
    pub impulse_n_s: f64,
    /// Largest contact force (N).
    pub peak_force_n: f64,
    /// Largest compression (m).
    pub peak_compression_m: f64,
}

/// The result of one impact.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The outcome.
    pub outcome: Outcome,
    /// Net restitution: relative speed of separation over that of approach, both of the rigid-body motions
    /// (for a structure without rigid-body modes: of the striker alone). 0 in sustained contact. `None` unless the bodies approached
    /// each other, fast enough for the ratio to be a number, and the impact ended.
    pub restitution: Option<f64>,
    /// Estimated error of the restitution, from two or three coarser solutions; `None` if not requested, and if it is not
    /// known because one of them stopped at a limit before its end. It is 1 if the bodies do not meet in one of them.
    pub restitution_uncertainty: Option<f64>,
    /// Every interval of contact, in order of time.
    pub sub_impacts: Vec<SubImpact>,
    /// Costs, including those of the coarser solutions.
    pub counts: Counts,
    /// Time of the last separation, or at which the computation stopped (s).
    pub end_s: f64,
    /// Velocity of the striker at `end_s`, positive away from the structure (m/s).
    pub striker_velocity_m_s: f64,
    /// Modal amplitudes at `end_s` (m kg^1/2).
    pub amplitude: Vec<f64>,
    /// Their rates at `end_s` (m kg^1/2 / s).
    pub rate: Vec<f64>,
}
