//! The linear spring. Conservative.

use crate::conservative::{Conservative, conservative_law};
use crate::range::{bounded, require_positive};
use invalid_input::InvalidInput;

/// `F = k <xi>`.
///
/// Source: textbook (W. Goldsmith, *Impact*, 1960, ch. 4). Valid for contacts whose area does not grow with the load, and as a
/// penalty in place of a rigid stop. Tension: none.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct LinearSpring {
    /// Stiffness `k` (N/m).
    pub stiffness_n_m: f64,
}

impl LinearSpring {
    /// The law with stiffness `k` (N/m).
    ///
    /// # Errors
    /// A stiffness that is not positive.
    pub fn new(stiffness_n_m: f64) -> Result<LinearSpring, InvalidInput> {
        LinearSpring { stiffness_n_m }.validated()
    }

    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// As [`LinearSpring::new`].
    pub fn validated(self) -> Result<LinearSpring, InvalidInput> {
        require_positive("stiffness_n_m", self.stiffness_n_m)?;
        Ok(self)
    }
}

impl Conservative for LinearSpring {
    fn exponent(&self) -> f64 {
        1.0
    }

    fn curve(&self, compression_m: f64) -> (f64, f64) {
        // The continuation below zero is linear and tensile, so that an iteration may step over the boundary.
        (self.stiffness_n_m * bounded(compression_m), self.stiffness_n_m)
    }
}

conservative_law!(LinearSpring);
