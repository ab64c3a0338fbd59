//! Shear coefficients.

use crate::chapters::material::Material;

/// Relative change of the shear coefficient that represents the differences between the usual values.
pub const APART: f64 = 0.02;

/// A usual shear coefficient for the square section of the thesis.
pub struct Coefficient {
    pub name: &'static str,
    pub value: f64,
}

/// The shear coefficients of Eq. (4).
pub fn coefficients(material: &Material) -> [Coefficient; 4] {
    let nu = material.poissons_ratio;
    [
        Coefficient { name: "Reissner", value: 5.0 / 6.0 },
        Coefficient { name: "Cowper", value: 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu) },
        Coefficient { name: "Kaneko", value: kaneko(material) },
        Coefficient { name: "Hutchinson", value: 0.8723 },
    ]
}

/// The default coefficient of the program.
pub fn kaneko(material: &Material) -> f64 {
    let nu = material.poissons_ratio;
    5.0 * (1.0 + nu) / (6.0 + 5.0 * nu)
}
