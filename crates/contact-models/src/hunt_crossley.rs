//! Hunt and Crossley's damped power law.

use crate::damped::{self, Damped, damped_law};
use crate::range::{require_not_negative, require_positive};
use invalid_input::InvalidInput;

/// `F = k <xi>^n (1 + D xi_dot)` with any exponent; `D` is the same for every contact.
///
/// Source: K. H. Hunt and F. R. E. Crossley, *J. Appl. Mech.* 42 (1975) 440, who write the damping as `lambda xi^n xi_dot` with
/// `lambda = D k`. Valid for light damping and smooth bodies. Tension: as for [`Viscous`](crate::Viscous), which is this law
/// with `n = 3/2`.
///
/// Calibration: [`with_restitution`](HuntCrossley::with_restitution) is exact. The paper's own rule `D = 3 (1 - e) / (2 v0)`,
/// [`with_restitution_first_order`](HuntCrossley::with_restitution_first_order), is of first order in `1 - e` and gives too
/// little damping:
///
/// | restitution required | 0.95 | 0.9 | 0.8 | 0.7 | 0.5 | 0.3 | 0.1 |
/// |---|---|---|---|---|---|---|---|
/// | obtained | 0.952 | 0.909 | 0.833 | 0.768 | 0.663 | 0.581 | 0.516 |
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct HuntCrossley {
    /// Stiffness `k` (N/m^n).
    pub stiffness_n_m_n: f64,
    /// Exponent `n`, from 1 to 6.
    pub exponent: f64,
    /// Damping factor `D` (s/m).
    pub damping_s_m: f64,
}

impl HuntCrossley {
    /// The law with stiffness `k` (N/m^n), exponent `n` and damping factor `D` (s/m, may be zero).
    ///
    /// # Errors
    /// A stiffness that is not positive, an exponent outside 1 to 6, a negative damping.
    pub fn new(stiffness_n_m_n: f64, exponent: f64, damping_s_m: f64) -> Result<HuntCrossley, InvalidInput> {
        HuntCrossley { stiffness_n_m_n, exponent, damping_s_m }.validated()
    }

    /// The law whose restitution at a wall is `restitution` for a striker at `speed_m_s`, exact to
    /// rounding for every mass, stiffness and exponent.
    ///
    /// # Errors
    /// As [`HuntCrossley::new`]; a restitution outside 0.001 to 1, a speed that is not positive.
    pub fn with_restitution(
        stiffness_n_m_n: f64,
        exponent: f64,
        restitution: f64,
        speed_m_s: f64,
    ) -> Result<HuntCrossley, InvalidInput> {
        let damping = damped::calibrated(restitution, speed_m_s, damped::damping_ratio)?;
        HuntCrossley::new(stiffness_n_m_n, exponent, damping)
    }

    /// The law with the paper's approximate damping for a restitution and speed; the table above
    /// gives its error.
    ///
    /// # Errors
    /// As [`HuntCrossley::with_restitution`].
    pub fn with_restitution_first_order(
        stiffness_n_m_n: f64,
        exponent: f64,
        restitution: f64,
        speed_m_s: f64,
    ) -> Result<HuntCrossley, InvalidInput> {
        let damping = damped::calibrated(restitution, speed_m_s, |e| 1.5 * (1.0 - e))?;
        HuntCrossley::new(stiffness_n_m_n, exponent, damping)
    }

    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// As [`HuntCrossley::new`].
    pub fn validated(self) -> Result<HuntCrossley, InvalidInput> {
        require_positive("stiffness_n_m_n", self.stiffness_n_m_n)?;
        InvalidInput::unless((1.0..=6.0).contains(&self.exponent), "exponent", self.exponent, "a number from 1 to 6")?;
        require_not_negative("damping_s_m", self.damping_s_m)?;
        Ok(self)
    }
}

impl Damped for HuntCrossley {
    fn stiffness(&self) -> f64 {
        self.stiffness_n_m_n
    }

    fn exponent(&self) -> f64 {
        self.exponent
    }

    fn damping_s_m(&self, _approach_speed_m_s: f64) -> f64 {
        self.damping_s_m
    }
}

damped_law!(HuntCrossley);
