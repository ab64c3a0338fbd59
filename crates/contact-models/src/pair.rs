//! Two bodies in contact: effective modulus and radius.

use crate::range::{LARGEST, require_positive};
use invalid_input::InvalidInput;

/// One of two elastic bodies where they touch: an isotropic material and a sphere's curvature.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Body {
    /// Young's modulus `E` (Pa).
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio `nu`, greater than -1 and at most 0.5.
    pub poissons_ratio: f64,
    /// Radius of curvature `R` (m): positive for a ball, infinite for a flat, negative for a
    /// spherical seat.
    pub radius_m: f64,
}

impl Body {
    /// A body with a flat surface.
    pub const fn flat(youngs_modulus_pa: f64, poissons_ratio: f64) -> Body {
        Body { youngs_modulus_pa, poissons_ratio, radius_m: f64::INFINITY }
    }

    /// A rigid body of this radius: its modulus is infinite.
    pub const fn rigid(radius_m: f64) -> Body {
        Body { youngs_modulus_pa: f64::INFINITY, poissons_ratio: 0.0, radius_m }
    }

    /// `(1 - nu^2) / E` (1/Pa).
    fn compliance_per_pa(&self) -> Result<f64, InvalidInput> {
        if self.youngs_modulus_pa != f64::INFINITY {
            require_positive("youngs_modulus_pa", self.youngs_modulus_pa)?;
        }
        let nu = self.poissons_ratio;
        let allowed = "a number greater than -1 and not greater than 0.5";
        InvalidInput::unless(nu > -1.0 && nu <= 0.5, "poissons_ratio", nu, allowed)?;
        Ok((1.0 - nu * nu) / self.youngs_modulus_pa)
    }

    /// `1 / R` (1/m), zero for a flat.
    fn curvature_per_m(&self) -> Result<f64, InvalidInput> {
        if self.radius_m != f64::INFINITY {
            let allowed = "a radius from 1e-30 to 1e30 in size, positive for a ball and negative for a concave seat, or infinite \
                           for a flat surface";
            let holds = self.radius_m.abs() >= 1.0 / LARGEST && self.radius_m.abs() <= LARGEST;
            InvalidInput::unless(holds, "radius_m", self.radius_m, allowed)?;
        }
        Ok(1.0 / self.radius_m)
    }
}

/// Effective modulus `E*` (Pa): `1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2`.
///
/// # Errors
/// A modulus that is not positive, a Poisson's ratio outside `(-1, 0.5]`, or two rigid bodies.
pub fn effective_modulus_pa(first: &Body, second: &Body) -> Result<f64, InvalidInput> {
    let modulus = 1.0 / (first.compliance_per_pa()? + second.compliance_per_pa()?);
    InvalidInput::unless(
        modulus.is_finite(),
        "youngs_modulus_pa",
        modulus,
        "finite for at least one of the two bodies",
    )?;
    Ok(modulus)
}

/// Effective radius `R*` (m): `1/R* = 1/R1 + 1/R2`.
///
/// # Errors
/// A radius of zero or NaN, or two bodies that do not touch at a single point (two flats, or a ball in a seat that is not
/// wider).
pub fn effective_radius_m(first: &Body, second: &Body) -> Result<f64, InvalidInput> {
    let radius = 1.0 / (first.curvature_per_m()? + second.curvature_per_m()?);
    let holds = radius > 0.0 && radius <= LARGEST;
    let allowed = "such that 1/R1 + 1/R2 is greater than 0, so that the bodies meet at a point";
    InvalidInput::unless(holds, "radius_m", radius, allowed)?;
    Ok(radius)
}
