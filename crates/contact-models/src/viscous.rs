//! The thesis's viscous contact dissipation.

use crate::damped::{self, Damped, damped_law};
use crate::range::{require_not_negative, require_positive};
use invalid_input::InvalidInput;

/// `F = k_H <xi>^(3/2) (1 + c xi_dot)` (thesis Eq. 3.15), `c` the same for every contact.
///
/// Valid for light damping: the thesis assumes, and checks, `|c xi_dot| < 1`. Tension: while surfaces separate faster than
/// `1/c` the force is zero (slack), until they separate more slowly or the compression is zero; a striker at a wall never
/// reaches this state. The restitution decreases with the speed, as `1 - (2/3) c v0` for small `c v0`. The thesis's `c = 0.08`
/// s/m gives 0.9494 at 1 m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Viscous {
    /// Stiffness `k_H` (N/m^1.5).
    pub stiffness_n_m1_5: f64,
    /// Damping `c` (s/m).
    pub damping_s_m: f64,
}

impl Viscous {
    /// The law with stiffness `k_H` (N/m^1.5) and damping `c` (s/m, may be zero).
    ///
    /// # Errors
    /// A stiffness that is not positive, a negative damping.
    pub fn new(stiffness_n_m1_5: f64, damping_s_m: f64) -> Result<Viscous, InvalidInput> {
        Viscous { stiffness_n_m1_5, damping_s_m }.validated()
    }

    /// The law whose restitution at a wall is `restitution` for a striker at `speed_m_s`. The
    /// relation is solved exactly, to rounding; it does not depend on mass or stiffness.
    ///
    /// # Errors
    /// A restitution outside 0.001 to 1, a stiffness or speed that is not positive.
    pub fn with_restitution(stiffness_n_m1_5: f64, restitution: f64, speed_m_s: f64) -> Result<Viscous, InvalidInput> {
        Viscous::new(stiffness_n_m1_5, damped::calibrated(restitution, speed_m_s, damped::damping_ratio)?)
    }

    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// As [`Viscous::new`].
    pub fn validated(self) -> Result<Viscous, InvalidInput> {
        require_positive("stiffness_n_m1_5", self.stiffness_n_m1_5)?;
        require_not_negative("damping_s_m", self.damping_s_m)?;
        Ok(self)
    }
}

impl Damped for Viscous {
    fn stiffness(&self) -> f64 {
        self.stiffness_n_m1_5
    }

    fn damping_s_m(&self, _approach_speed_m_s: f64) -> f64 {
        self.damping_s_m
    }
}

damped_law!(Viscous);
