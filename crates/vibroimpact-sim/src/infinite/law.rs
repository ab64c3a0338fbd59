//! A contact law in the units of an impact.

use super::receptance::Scale;
use contact_models::{After, Boundary, Branch, ContactLaw, Memory, boundaries};

/// A law whose compressions are in `v T`, rates in `v` and forces in `F`.
pub(super) struct Scaled<'a> {
    pub law: &'a dyn ContactLaw,
    pub scale: Scale,
    /// The force is that of a compression which is larger by this part of itself: zero, or as much as rounding.
    pub rounding: f64,
}

/// Force and its derivatives by compression and rate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Force {
    pub force: f64,
    pub stiffness: f64,
    pub damping: f64,
}

impl Force {
    pub fn is_finite(&self) -> bool {
        self.force.is_finite() && self.stiffness.is_finite() && self.damping.is_finite()
    }
}

/// `per_compression x + per_rate x' - level` is positive within a branch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Margin {
    pub per_compression: f64,
    pub per_rate: f64,
    pub level: f64,
}

impl Margin {
    pub fn at(&self, x: f64, rate: f64) -> f64 {
        self.per_compression * x + self.per_rate * rate - self.level
    }

    /// The size of its terms.
    pub fn size(&self, x: f64, rate: f64) -> f64 {
        (self.per_compression * x).abs() + (self.per_rate * rate).abs() + self.level.abs()
    }
}

impl Scaled<'_> {
    pub fn touch(&self, memory: &Memory, closing: f64) -> Branch {
        self.law.touch(memory, closing * self.scale.speed_m_s)
    }

    pub fn force(&self, branch: &Branch, x: f64, rate: f64) -> Force {
        let Scale { force_n, displacement_m, speed_m_s, .. } = self.scale;
        let force = self.law.force(branch, displacement_m * x * (1.0 + self.rounding), speed_m_s * rate);
        Force {
            force: force.force_n / force_n,
            stiffness: force.per_compression_n_m * displacement_m / force_n,
            damping: force.per_rate_n_s_m * speed_m_s / force_n,
        }
    }

    pub fn margins(&self, branch: &Branch) -> Vec<Margin> {
        let Scale { displacement_m, speed_m_s, .. } = self.scale;
        let margin = |boundary: Boundary| Margin {
            per_compression: boundary.per_compression * displacement_m,
            per_rate: boundary.per_rate * speed_m_s,
            level: boundary.level,
        };
        boundaries(self.law, branch).map(margin).collect()
    }

    pub fn cross(&self, branch: &Branch, which: usize, x: f64, rate: f64) -> After {
        let Scale { displacement_m, speed_m_s, .. } = self.scale;
        self.law.cross(branch, which, displacement_m * x, speed_m_s * rate)
    }
}
