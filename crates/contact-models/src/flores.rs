//! Flores, Machado, Silva and Martins's law.

use crate::damped::{self, Damped, LOWEST_APPROACH_SPEED_M_S, damped_law};
use crate::range::{require_positive, require_restitution};
use invalid_input::InvalidInput;

/// `F = k_H <xi>^(3/2) (1 + D xi_dot)` with `D = 8 (1 - e) / (5 e v0)` from the approach speed `v0` of each contact.
///
/// Source: P. Flores, M. Machado, M. T. Silva and J. M. Martins, *Multibody Syst. Dyn.* 25 (2011) 357.
/// It was proposed for the whole range of restitutions, soft contacts included. The restitution at a wall, at any speed, is:
///
/// | restitution required | 0.95 | 0.9 | 0.8 | 0.7 | 0.5 | 0.3 | 0.1 |
/// |---|---|---|---|---|---|---|---|
/// | obtained | 0.947 | 0.894 | 0.789 | 0.683 | 0.470 | 0.256 | 0.069 |
///
/// Tension: as for [`Viscous`](crate::Viscous). The damping would increase without bound as `v0` decreases, and a contact that
/// continues to be pressed after a slow touch would not move any more; below `lowest_approach_speed_m_s` the damping is
/// therefore constant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Flores {
    /// Stiffness `k_H` (N/m^1.5).
    pub stiffness_n_m1_5: f64,
    /// Restitution `e` that the damping is intended to give.
    pub restitution: f64,
    /// Approach speed (m/s) below which `D` is constant.
    pub lowest_approach_speed_m_s: f64,
}

impl Flores {
    /// The law with stiffness `k_H` (N/m^1.5) and intended restitution; the damping is constant below an approach speed of 1e-6
    /// m/s.
    ///
    /// # Errors
    /// A stiffness that is not positive, a restitution outside 0.001 to 1.
    pub fn new(stiffness_n_m1_5: f64, restitution: f64) -> Result<Flores, InvalidInput> {
        let lowest_approach_speed_m_s = LOWEST_APPROACH_SPEED_M_S;
        Flores { stiffness_n_m1_5, restitution, lowest_approach_speed_m_s }.validated()
    }

    /// The law whose restitution at a wall is `restitution`, at any speed above the lowest. The intended restitution of the law
    /// is then another number, which corrects the paper's approximation.
    ///
    /// # Errors
    /// As [`Flores::new`].
    pub fn with_restitution(stiffness_n_m1_5: f64, restitution: f64) -> Result<Flores, InvalidInput> {
        require_restitution("restitution", restitution)?;
        // D v0 = 8 (1 - e) / (5 e), solved for e
        Flores::new(stiffness_n_m1_5, 1.6 / (1.6 + damped::damping_ratio(restitution)))
    }

    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// As [`Flores::new`], and a lowest approach speed that is not positive.
    pub fn validated(self) -> Result<Flores, InvalidInput> {
        require_positive("stiffness_n_m1_5", self.stiffness_n_m1_5)?;
        require_restitution("restitution", self.restitution)?;
        require_positive("lowest_approach_speed_m_s", self.lowest_approach_speed_m_s)?;
        Ok(self)
    }
}

impl Damped for Flores {
    fn stiffness(&self) -> f64 {
        self.stiffness_n_m1_5
    }

    fn damping_s_m(&self, approach_speed_m_s: f64) -> f64 {
        let e = self.restitution;
        1.6 * (1.0 - e) / e / approach_speed_m_s.max(self.lowest_approach_speed_m_s)
    }
}

damped_law!(Flores);
