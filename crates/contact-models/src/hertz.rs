//! Hertz: elastic contact of curved, frictionless bodies. Conservative.

use crate::{After, Boundary, Branch, ContactLaw, Force, InvalidInput, Memory, Stage};

/// `F = k_H <xi>^(3/2)` (thesis Eqs. 3.12 to 3.14; Hertz 1882; K. L. Johnson, *Contact
/// Mechanics*, 1985, ch. 4). Valid while the contact radius stays small against the radii of
/// the bodies and the material elastic. The force never pulls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hertz {
    /// Stiffness `k_H` (N/m^1.5).
    pub stiffness_n_m1_5: f64,
}

impl Hertz {
    /// The law with a given stiffness `k_H` (N/m^1.5), which must be finite and positive.
    pub fn new(stiffness_n_m1_5: f64) -> Result<Hertz, InvalidInput> {
        InvalidInput::require_positive("stiffness_n_m1_5", stiffness_n_m1_5)
            .map(|stiffness_n_m1_5| Hertz { stiffness_n_m1_5 })
    }
}

impl ContactLaw for Hertz {
    fn touch(&self, _memory: &Memory, _approach_speed_m_s: f64) -> Branch {
        Branch { stage: Stage::Single, anchor_m: 0.0, internal: 0.0 }
    }

    fn force(&self, _branch: &Branch, compression_m: f64, _rate_m_s: f64) -> Force {
        let xi = compression_m.max(0.0);
        let root = xi.sqrt();
        Force {
            force_n: self.stiffness_n_m1_5 * xi * root,
            per_compression_n_m: 1.5 * self.stiffness_n_m1_5 * root,
            per_rate_n_s_m: 0.0,
        }
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
