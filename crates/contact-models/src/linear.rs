//! The linear spring. Conservative.

use crate::error::bounded;
use crate::{After, Boundary, Branch, ContactLaw, Force, InvalidInput, Memory, Stage};

/// `F = k <xi>`.
///
/// Source: textbook (W. Goldsmith, *Impact*, 1960, ch. 4). Valid for contacts whose area does not
/// grow with the load, and as a penalty in place of a rigid stop. Tensile tail: none.
#[derive(Debug, Clone, Copy, PartialEq)]
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

    /// The law itself if its parameters are in range.
    ///
    /// # Errors
    /// As [`LinearSpring::new`].
    pub fn validated(self) -> Result<LinearSpring, InvalidInput> {
        InvalidInput::require_positive("stiffness_n_m", self.stiffness_n_m)?;
        Ok(self)
    }

    /// Rebound speed over approach speed of a rigid striker at a wall.
    pub(crate) fn wall_restitution(&self, _mass_kg: f64, _speed_m_s: f64) -> f64 {
        1.0
    }
}

impl ContactLaw for LinearSpring {
    fn touch(&self, _memory: &Memory, _approach_speed_m_s: f64) -> Branch {
        Branch { stage: Stage::Single, anchor_m: 0.0, internal: 0.0 }
    }

    fn force(&self, _branch: &Branch, compression_m: f64, _rate_m_s: f64) -> Force {
        let k = self.stiffness_n_m;
        // the extension below zero pulls: linear, so that an iteration may step over the boundary
        Force { force_n: k * bounded(compression_m), per_compression_n_m: k, per_rate_n_s_m: 0.0 }
    }

    fn stored_energy_j(&self, _branch: &Branch, compression_m: f64) -> f64 {
        let xi = bounded(compression_m).max(0.0);
        0.5 * self.stiffness_n_m * xi * xi
    }

    fn boundaries(&self, _branch: &Branch) -> [Boundary; 2] {
        [Boundary::compression_falls_to(0.0), Boundary::NEVER]
    }

    fn cross(&self, _branch: &Branch, _which: usize, _compression_m: f64, _rate_m_s: f64) -> After {
        After::Release(Memory::default())
    }

    fn depends_on_rate(&self) -> bool {
        false
    }
}
