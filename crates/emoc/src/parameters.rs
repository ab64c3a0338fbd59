//! The three-parameter form of chapter 7.

use crate::closed_form::sum_of_squares;
use crate::require::{require, require_fraction, require_non_negative, require_positive};
use crate::{Coefficients, Real, Rebound};
use invalid_input::InvalidInput;

/// The three numbers of a location on a structure that the model uses, from its mode shapes there.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Site<T = f64> {
    /// `sum_k phi_k(b)^2` over the active modes (1/kg).
    pub sum_phi_squared_per_kg: T,
    /// `phi_1(b)^2` of the first mode (1/kg).
    pub first_phi_squared_per_kg: T,
    /// Number `N` of active modes.
    pub modes: usize,
}

impl<T: Real> Site<T> {
    /// From mass-normalised mode shapes `phi_k(b)` (kg^-1/2), lowest mode first. Signs do not matter. Without modes the
    /// structure is rigid and immovable.
    ///
    /// # Errors
    /// [`InvalidInput`] for a shape that is not finite or makes the sum of squares overflow.
    pub fn new(phi: &[T]) -> Result<Site<T>, InvalidInput> {
        let first = phi.first().map_or(T::ZERO, |&phi_1| phi_1 * phi_1);
        Ok(Site { sum_phi_squared_per_kg: sum_of_squares(phi)?, first_phi_squared_per_kg: first, modes: phi.len() })
    }
}

/// The dimensionless numbers of one impact (Eqs. 7.3, 7.6, 7.7).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Impact<T = f64> {
    /// Mass `m` of the striker (kg); for a dropped tilted rod the effective mass of Eq. 8.9.
    pub mass_kg: T,
    /// `Z = m sum phi_k^2`, the moderated mass ratio.
    pub z: T,
    /// `S_0 = Z / N`, the average modal richness (0 without modes).
    pub s0: T,
    /// `S_1 = m phi_1^2`, the pseudostatic response.
    pub s1: T,
}

impl<T: Real> Impact<T> {
    /// A striker of mass `mass_kg` (finite, greater than 0) at `site`.
    ///
    /// # Errors
    /// [`InvalidInput`] for a mass that is not positive and finite, or if `Z` overflows.
    #[inline]
    pub fn new(mass_kg: T, site: &Site<T>) -> Result<Impact<T>, InvalidInput> {
        require_positive("mass_kg", mass_kg)?;
        let z = mass_kg * site.sum_phi_squared_per_kg;
        let s0 = if site.modes > 0 { z / T::from_count(site.modes) } else { T::ZERO };
        let impact = Impact { mass_kg, z, s0, s1: mass_kg * site.first_phi_squared_per_kg };
        impact.validate()?;
        Ok(impact)
    }

    #[inline]
    fn validate(&self) -> Result<(), InvalidInput> {
        require_positive("mass_kg", self.mass_kg)?;
        require_non_negative("z", self.z)?;
        require_non_negative("s0", self.s0)?;
        require_non_negative("s1", self.s1)
    }
}

/// The fitted parameters `mu_0`, `alpha_0`, `alpha_1` and the notional restitution (thesis 7.1).
///
/// The thesis defines the three as positive; 0 is allowed here and means the limit.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Parameters<T = f64> {
    /// `mu_0`, the moderated mass ratio coefficient (Eq. 7.4).
    pub mu0: T,
    /// `alpha_0`, the modal richness coefficient (Eq. 7.6).
    pub alpha0: T,
    /// `alpha_1`, the slow response coefficient (Eq. 7.7).
    pub alpha1: T,
    /// `e`, the restitution without vibration, 0 to 1; 1 for an elastic contact (Eq. 7.5).
    pub notional_restitution: T,
}

impl<T: Real> Default for Parameters<T> {
    /// All equal to 1, which the thesis suggests if nothing has been fitted (7.3).
    fn default() -> Self {
        Parameters { mu0: T::ONE, alpha0: T::ONE, alpha1: T::ONE, notional_restitution: T::ONE }
    }
}

/// Partial derivatives of the restitution with respect to the parameters and the striker's mass (`Z`, `S_0` and `S_1` are
/// proportional to it). They are exact on either side of the kink, where [`Rebound::kink_margin`] is zero; at the kink they are
/// those of the reported branch.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ParameterGradient<T = f64> {
    /// With respect to `mu_0`.
    pub per_mu0: T,
    /// With respect to `alpha_0`.
    pub per_alpha0: T,
    /// With respect to `alpha_1`.
    pub per_alpha1: T,
    /// With respect to the notional restitution `e`.
    pub per_notional_restitution: T,
    /// With respect to the mass (1/kg).
    pub per_mass_per_kg: T,
}

impl<T: Real> Parameters<T> {
    /// Checks the ranges of the four numbers.
    ///
    /// # Errors
    /// [`InvalidInput`] for `mu_0`, `alpha_0` or `alpha_1` that is negative or not finite, or a notional restitution outside 0
    /// to 1.
    #[inline]
    pub fn validate(&self) -> Result<(), InvalidInput> {
        require_non_negative("mu0", self.mu0)?;
        require_non_negative("alpha0", self.alpha0)?;
        require_non_negative("alpha1", self.alpha1)?;
        require_fraction("notional_restitution", self.notional_restitution)
    }

    /// `ebar`, `beta_0` and `beta_1` of an impact (Eqs. 7.5 to 7.7).
    ///
    /// ```
    /// let site = emoc::Site::<f64>::new(&[1.0, 1.0])?;
    /// let impact = emoc::Impact::new(0.5, &site)?; // Z = 1, S_0 = 1/2, S_1 = 1/2
    /// let coefficients = emoc::Parameters::default().coefficients(&impact)?;
    /// assert!((coefficients.ebar - 2.0 / 3.0).abs() < 1e-15);
    /// assert!((coefficients.beta0 - 1.0 / 3.0).abs() < 1e-15);
    /// # Ok::<(), emoc::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// [`InvalidInput`] as [`Parameters::validate`], and for an impact whose numbers are out of range.
    #[inline]
    pub fn coefficients(&self, impact: &Impact<T>) -> Result<Coefficients<T>, InvalidInput> {
        self.validate()?;
        impact.validate()?;
        Ok(Coefficients {
            ebar: self.notional_restitution * (T::ONE - dip(self.mu0 * impact.z)),
            beta0: saturate(self.alpha0 * impact.s0),
            beta1: saturate(self.alpha1 * impact.s1),
        })
    }

    /// Rebound of an impact on a structure at rest, without allocation.
    ///
    /// ```
    /// use emoc::{Impact, Parameters, Site};
    /// let site = Site::new(&[1.2, 0.4, 0.9])?;              // phi_k(b), kg^-1/2
    /// let rebound = Parameters::default().rebound(&Impact::new(0.2, &site)?)?;
    /// assert!(rebound.restitution > 0.0 && rebound.restitution <= 1.0);
    /// # Ok::<(), emoc::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// As [`Parameters::coefficients`].
    #[inline]
    pub fn rebound(&self, impact: &Impact<T>) -> Result<Rebound<T>, InvalidInput> {
        Ok(self.coefficients(impact)?.rebound_unchecked(impact.z))
    }

    /// Rebound and the derivatives of the restitution.
    ///
    /// ```
    /// use emoc::{Impact, Parameters, Site};
    /// let impact = Impact::<f64>::new(0.2, &Site::new(&[1.2, 0.4, 0.9])?)?;
    /// let (rebound, gradient) = Parameters::default().rebound_with_gradient(&impact)?;
    /// assert!((gradient.per_notional_restitution - rebound.restitution).abs() < 1e-15);
    /// # Ok::<(), emoc::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// As [`Parameters::coefficients`], and for a mass so small that the derivative with respect to it is too large for a number.
    #[inline]
    pub fn rebound_with_gradient(
        &self,
        impact: &Impact<T>,
    ) -> Result<(Rebound<T>, ParameterGradient<T>), InvalidInput> {
        let coefficients = self.coefficients(impact)?;
        let (rebound, per) = coefficients.rebound_with_gradient(impact.z)?;

        let e = self.notional_restitution;
        let (t, x0, x1) = (self.mu0 * impact.z, self.alpha0 * impact.s0, self.alpha1 * impact.s1);
        // The mass enters through t, x_0, x_1 and Z, each proportional to it.
        let per_log_mass = -per.per_ebar * e * dip_log_slope(t)
            + per.per_beta0 * saturate_log_slope(x0)
            + per.per_beta1 * saturate_log_slope(x1)
            + per.per_z * impact.z;
        let per_mass_per_kg = per_log_mass / impact.mass_kg;
        let allowed = "a mass with respect to which the derivative is a finite number";
        require(per_mass_per_kg <= T::MAX && per_mass_per_kg >= -T::MAX, "mass_kg", impact.mass_kg, allowed)?;
        let gradient = ParameterGradient {
            per_mu0: -per.per_ebar * e * dip_slope(t) * impact.z,
            per_alpha0: per.per_beta0 * saturate_slope(x0) * impact.s0,
            per_alpha1: per.per_beta1 * saturate_slope(x1) * impact.s1,
            per_notional_restitution: per.per_ebar * (T::ONE - dip(t)),
            per_mass_per_kg,
        };
        Ok((rebound, gradient))
    }
}

/// `g(t) = t / (t^2 + t + 1)`, so that `ebar = e (1 - g(mu_0 Z))` is Eq. 7.5. If `t^2` overflows, `g` is below the rounding of
/// 1.
#[inline]
fn dip<T: Real>(t: T) -> T {
    let square = t * (T::ONE + t);
    if square <= T::MAX { t / (T::ONE + square) } else { T::ZERO }
}

/// `g'(t) = (1 - t^2) / (t^2 + t + 1)^2`.
#[inline]
fn dip_slope<T: Real>(t: T) -> T {
    let one = T::ONE;
    let (r, factor) = if t < one { (t, one) } else { (one / t, -(one / t) * (one / t)) };
    let sum = one + r * (one + r);
    factor * (one - r * r) / (sum * sum)
}

/// `t g'(t)`, also if `t` has overflowed.
#[inline]
fn dip_log_slope<T: Real>(t: T) -> T {
    let one = T::ONE;
    let (r, factor) = if t < one { (t, t) } else { (one / t, -(one / t)) };
    let sum = one + r * (one + r);
    factor * (one - r * r) / (sum * sum)
}

/// `x / (1 + x)`, Eqs. 7.6 and 7.7, also if `x` has overflowed.
#[inline]
fn saturate<T: Real>(x: T) -> T {
    if x <= T::MAX { x / (T::ONE + x) } else { T::ONE }
}

/// Derivative of [`saturate`], `1 / (1 + x)^2`.
#[inline]
fn saturate_slope<T: Real>(x: T) -> T {
    let scale = T::ONE / (T::ONE + x);
    scale * scale
}

/// `x / (1 + x)^2`.
#[inline]
fn saturate_log_slope<T: Real>(x: T) -> T {
    saturate(x) * (T::ONE / (T::ONE + x))
}
