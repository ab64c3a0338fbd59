//! Hertz: elastic contact of curved, frictionless bodies. Conservative.

use crate::conservative::{Conservative, conservative_law, power_of};
use crate::pair::{Body, effective_modulus_pa, effective_radius_m};
use crate::range::require_positive;
use invalid_input::InvalidInput;

/// `F = k_H <xi>^(3/2)` (thesis Eqs. 3.12 to 3.14).
///
/// Source: H. Hertz, *J. reine angew. Math.* 92 (1882) 156; K. L. Johnson, *Contact Mechanics* (1985), ch. 4. Valid while the
/// contact radius is small compared with the bodies' radii, the material is elastic, and the contact lasts long compared with
/// the travel of waves through the bodies. Tension: none.
///
/// ```
/// use contact_models::{Body, Hertz};
///
/// let (ball, flat) = (Body { youngs_modulus_pa: 2e11, poissons_ratio: 0.3, radius_m: 0.015 }, Body::flat(2e11, 0.3));
/// let law = Hertz::from_bodies(&ball, &flat)?;
/// assert!((law.stiffness_n_m1_5 - 1.7945e10).abs() < 1e6); // thesis Eq. 3.20
/// # Ok::<(), contact_models::InvalidInput>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Hertz {
    /// Stiffness `k_H` (N/m^1.5).
    pub stiffness_n_m1_5: f64,
}

impl Hertz {
    /// The law with stiffness `k_H` (N/m^1.5).
    ///
    /// # Errors
    /// A stiffness that is not positive.
    pub fn new(stiffness_n_m1_5: f64) -> Result<Hertz, InvalidInput> {
        Hertz { stiffness_n_m1_5 }.validated()
    }

    /// The law of two spheres: `k_H = (4/3) E* sqrt(R*)`. For equal materials and one flat this
    /// is thesis Eq. 3.14, `k_H = 2 E sqrt(R) / (3 (1 - nu^2))`.
    ///
    /// # Errors
    /// A body outside the range stated at [`Body`], or two bodies that are both rigid or do not touch at a point.
    pub fn from_bodies(first: &Body, second: &Body) -> Result<Hertz, InvalidInput> {
        Hertz::new(4.0 / 3.0 * effective_modulus_pa(first, second)? * effective_radius_m(first, second)?.sqrt())
    }

    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// As [`Hertz::new`].
    pub fn validated(self) -> Result<Hertz, InvalidInput> {
        require_positive("stiffness_n_m1_5", self.stiffness_n_m1_5)?;
        Ok(self)
    }
}

impl Conservative for Hertz {
    fn exponent(&self) -> f64 {
        1.5
    }

    fn curve(&self, compression_m: f64) -> (f64, f64) {
        power_of(self.stiffness_n_m1_5, 1.5, compression_m)
    }
}

conservative_law!(Hertz);
