//! The scales of the first contact, from its law and striker alone.

use std::f64::consts::PI;

use contact_models::{ContactLaw, Law, Memory};
use vibroimpact_sim::modal::Striker;

/// The first contact on an immovable structure: scales, and bounds for elastic laws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wall {
    /// Greatest compression (m).
    pub compression_m: f64,
    /// Greatest force (N).
    pub force_n: f64,
    /// Slope of the law there (N/m).
    pub stiffness_n_m: f64,
    /// Exponent of the law there.
    pub exponent: f64,
    /// Duration (s).
    pub duration_s: f64,
}

impl Wall {
    /// From the work that equals the striker's energy: for `F ~ xi^n` it is `F xi / (1 + n)`.
    pub fn new(law: &Law, striker: &Striker) -> Wall {
        let energy = 0.5 * striker.mass_kg * striker.speed_m_s.powi(2);
        let branch = law.touch(&Memory::default(), striker.speed_m_s.max(0.0));
        let at = |xi: f64| {
            let force = law.force(&branch, xi, 0.0);
            let exponent = (xi * force.per_compression_n_m / force.force_n).clamp(0.5, 10.0);
            (force, if exponent.is_finite() { exponent } else { 1.0 })
        };
        let (mut low, mut high) = (-40.0f64, 20.0f64);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let xi = 10f64.powf(middle);
            let (force, exponent) = at(xi);
            *(if force.force_n * xi / (1.0 + exponent) < energy { &mut low } else { &mut high }) = middle;
        }
        let compression_m = 10f64.powf(low);
        let (force, exponent) = at(compression_m);
        Wall {
            compression_m,
            force_n: force.force_n,
            stiffness_n_m: force.per_compression_n_m,
            exponent,
            // pi for a linear spring, 2.943 for Hertz's exponent; near enough between and beyond
            duration_s: (PI - 0.4 * (exponent - 1.0)).max(1.0) * compression_m / striker.speed_m_s.abs(),
        }
    }
}
