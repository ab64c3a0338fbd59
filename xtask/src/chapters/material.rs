//! The material of a chapter.

use serde::Deserialize;

/// An isotropic elastic material, the same for beam and ball (thesis sections 3.3.1 and 4.2).
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Material {
    pub youngs_modulus_pa: f64,
    pub poissons_ratio: f64,
    pub density_kg_m3: f64,
}
