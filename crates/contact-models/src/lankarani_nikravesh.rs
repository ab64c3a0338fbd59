//! Lankarani and Nikravesh's law.

use crate::damped::{self, Damped, LOWEST_APPROACH_SPEED_M_S, damped_law};
use crate::range::{require_positive, require_restitution};
use invalid_input::InvalidInput;

/// `F = k_H <xi>^(3/2) (1 + D xi_dot)` with `D = 3 (1 - e^2) / (4 v0)` from the approach speed `v0` of each contact.
///
/// Source: H. M. Lankarani and P. E. Nikravesh, *J. Mech. Des.* 112 (1990) 369.
/// Valid for restitutions near 1: the rule comes from an energy balance for small losses, and its damping is too small for
/// lower restitutions (at a wall, at any speed):
///
/// | restitution required | 0.95 | 0.9 | 0.8 | 0.7 | 0.5 | 0.3 | 0.1 |
/// |---|---|---|---|---|---|---|---|
/// | obtained | 0.954 | 0.913 | 0.847 | 0.796 | 0.725 | 0.684 | 0.665 |
///
/// Tension: as for [`Viscous`](crate::Viscous). The damping would increase without bound as `v0` decreases, and a contact that
/// continues to be pressed after a slow touch would not move any more; below `lowest_approach_speed_m_s` the damping is
/// therefore constant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct LankaraniNikravesh {
    /// Stiffness `k_H` (N/m^1.5).
    pub stiffness_n_m1_5: f64,
    /// Restitution `e` that the damping is intended to give.
    pub restitution: f64,
    /// Approach speed (m/s) below which `D` is constant.
    pub lowest_approach_speed_m_s: f64,
}

impl LankaraniNikravesh {
    /// The lowest restitution of the law, rounded up: its damping is at most `D v0 = 3/4`.
    pub const LEAST_RESTITUTION: f64 = 0.663;

    /// The law with stiffness `k_H` (N/m^1.5) and intended restitution; the damping is constant below an approach speed of 1e-6
    /// m/s.
    ///
    /// # Errors
    /// A stiffness that is not positive, a restitution outside 0.001 to 1.
    pub fn new(stiffness_n_m1_5: f64, restitution: f64) -> Result<LankaraniNikravesh, InvalidInput> {
        let lowest_approach_speed_m_s = LOWEST_APPROACH_SPEED_M_S;
        LankaraniNikravesh { stiffness_n_m1_5, restitution, lowest_approach_speed_m_s }.validated()
    }

    /// The law whose restitution at a wall is `restitution`, at any speed above the lowest. The intended restitution of the law
    /// is then another number, which corrects the paper's approximation.
    ///
    /// # Errors
    /// A stiffness that is not positive, or a restitution that the law cannot have, since its damping is at most `D v0 = 3/4`.
    pub fn with_restitution(stiffness_n_m1_5: f64, restitution: f64) -> Result<LankaraniNikravesh, InvalidInput> {
        require_restitution("restitution", restitution)?;
        // D v0 = 3 (1 - e^2) / 4, solved for e
        let squared = 1.0 - damped::damping_ratio(restitution) / 0.75;
        let allowed = "a coefficient of restitution from 0.663 to 1, the range of the law of Lankarani and Nikravesh";
        InvalidInput::unless(squared >= 1e-6, "restitution", restitution, allowed)?;
        LankaraniNikravesh::new(stiffness_n_m1_5, squared.sqrt())
    }

    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// As [`LankaraniNikravesh::new`], and a lowest approach speed that is not positive.
    pub fn validated(self) -> Result<LankaraniNikravesh, InvalidInput> {
        require_positive("stiffness_n_m1_5", self.stiffness_n_m1_5)?;
        require_restitution("restitution", self.restitution)?;
        require_positive("lowest_approach_speed_m_s", self.lowest_approach_speed_m_s)?;
        Ok(self)
    }
}

impl Damped for LankaraniNikravesh {
    fn stiffness(&self) -> f64 {
        self.stiffness_n_m1_5
    }

    fn damping_s_m(&self, approach_speed_m_s: f64) -> f64 {
        let e = self.restitution;
        0.75 * (1.0 - e * e) / approach_speed_m_s.max(self.lowest_approach_speed_m_s)
    }
}

damped_law!(LankaraniNikravesh);
