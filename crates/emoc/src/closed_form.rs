//! The minimum of problem P_0 in closed form.

use crate::Real;
use crate::require::{require, require_fraction, require_non_negative};
use core::fmt;
use invalid_input::InvalidInput;

/// The three coefficients of the model's inequalities (thesis Eqs. 6.6 and 6.7).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Coefficients<T = f64> {
    /// `ebar`: restitution demanded of the contact points, 0 to 1 (Eq. 6.6).
    pub ebar: T,
    /// `beta_0`: weight of the modal speeds in the outward inequality, not negative (Eq. 6.7).
    pub beta0: T,
    /// `beta_1`: share of `ebar` demanded of the striker by itself, 0 to 1 (Eq. 6.7).
    pub beta1: T,
}

/// Which of the two inequalities determines the rebound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Branch {
    /// The restitution inequality (6.6) alone: `e = ebar / (1 + Z)`. The outward inequality is not active, or only just.
    Basic,
    /// Both inequalities: `e = ebar (beta_0 + beta_1) / (1 + beta_0)`, for any `Z`.
    Outward,
}

impl Branch {
    /// `"basic"` or `"outward"`, for output files.
    pub const fn as_str(self) -> &'static str {
        match self {
            Branch::Basic => "basic",
            Branch::Outward => "outward",
        }
    }
}

impl fmt::Display for Branch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

/// The solution of P_0, in units of the speed of approach `u = -v_i`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Rebound<T = f64> {
    /// `e = v_f / u`, from 0 to `ebar`.
    pub restitution: T,
    /// `y = -sum phi_k a_k' / u`: recoil speed of the structure's point over `u`. It equals `ebar - e`, computed without
    /// cancellation.
    pub recoil: T,
    /// Which of the inequalities determines it.
    pub branch: Branch,
    /// `1/(1+Z) - (beta_0+beta_1)/(1+beta_0)`: not negative on the basic branch, negative on the outward one, and zero at the
    /// kink, where the restitution has a different derivative on each side.
    pub kink_margin: T,
}

impl<T: Real> Rebound<T> {
    /// Share of the striker's kinetic energy that the modes receive: `y^2 / Z`.
    ///
    /// ```
    /// let coefficients = emoc::Coefficients { ebar: 1.0, beta0: 0.0, beta1: 0.0 };
    /// let rebound = coefficients.rebound(3.0).unwrap();
    /// assert_eq!(rebound.restitution, 0.25);
    /// assert_eq!(rebound.modal_energy_fraction(3.0), 0.1875);
    /// ```
    pub fn modal_energy_fraction(&self, z: T) -> T {
        if z > T::ZERO { self.recoil * (self.recoil / z) } else { T::ZERO }
    }

    /// Writes the modal speeds after the impact, `a_k' = -phi_k y u / sum phi^2` (kg^1/2 m/s), for mode
    /// shapes `phi` (kg^-1/2) at the contact and a speed of approach `speed_m_s`.
    ///
    /// # Errors
    /// [`InvalidInput`] for lists of different length, a speed that is negative or not finite, or a mode shape that is not
    /// finite or makes the sum of squares overflow.
    pub fn modal_rates(&self, speed_m_s: T, phi: &[T], rates: &mut [T]) -> Result<(), InvalidInput> {
        require_non_negative("speed_m_s", speed_m_s)?;
        require(phi.len() == rates.len(), ["rates", "len()"], T::from_count(rates.len()), "the number of mode shapes")?;
        let sum = sum_of_squares(phi)?;
        let s = if sum > T::ZERO { self.recoil * speed_m_s / sum } else { T::ZERO };
        for (rate, &phi_k) in rates.iter_mut().zip(phi) {
            *rate = -phi_k * s;
        }
        Ok(())
    }
}

/// Partial derivatives of the restitution with respect to the arguments of the closed form. At the kink they are those of the
/// reported branch.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct CoefficientGradient<T = f64> {
    /// With respect to `ebar`.
    pub per_ebar: T,
    /// With respect to `beta_0`.
    pub per_beta0: T,
    /// With respect to `beta_1`.
    pub per_beta1: T,
    /// With respect to `Z`.
    pub per_z: T,
}

impl<T: Real> Coefficients<T> {
    /// Checks the ranges: `0 <= ebar <= 1`, `beta_0 >= 0`, `0 <= beta_1 <= 1`.
    ///
    /// # Errors
    /// [`InvalidInput`] names the first number out of range.
    #[inline]
    pub fn validate(&self) -> Result<(), InvalidInput> {
        require_fraction("ebar", self.ebar)?;
        require_non_negative("beta0", self.beta0)?;
        require_fraction("beta1", self.beta1)
    }

    /// Solves P_0 for the moderated mass ratio `z` (Eq. 7.3), which must be finite and not negative:
    ///
    /// `e = ebar * max( 1/(1+Z), (beta_0+beta_1)/(1+beta_0) )`.
    ///
    /// ```
    /// use emoc::{Branch, Coefficients};
    /// let coefficients = Coefficients::<f64> { ebar: 0.9, beta0: 0.5, beta1: 0.25 };
    /// let rebound = coefficients.rebound(4.0)?;
    /// assert_eq!(rebound.branch, Branch::Outward);
    /// assert!((rebound.restitution - 0.9 * 0.75 / 1.5).abs() < 1e-15);
    /// # Ok::<(), emoc::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// [`InvalidInput`] for a coefficient out of range, or a `z` that is negative or not finite.
    #[inline]
    pub fn rebound(&self, z: T) -> Result<Rebound<T>, InvalidInput> {
        self.validate()?;
        require_non_negative("z", z)?;
        Ok(self.rebound_unchecked(z))
    }

    /// The closed form, for numbers that are known to be in range.
    #[inline]
    pub(crate) fn rebound_unchecked(&self, z: T) -> Rebound<T> {
        let one = T::ONE;
        let basic = one / (one + z);
        let outward = (self.beta0 + self.beta1) / (one + self.beta0);
        let kink_margin = basic - outward;
        let (branch, share, recoil) = if kink_margin >= T::ZERO {
            // z/(1+z) without a division, without cancellation for small z, and without overflow for large z.
            (Branch::Basic, basic, if z < one { z * basic } else { one - basic })
        } else {
            (Branch::Outward, outward, (one - self.beta1) / (one + self.beta0))
        };
        Rebound { restitution: self.ebar * share, recoil: self.ebar * recoil, branch, kink_margin }
    }

    /// The rebound and its derivatives with respect to the coefficients and `Z`.
    ///
    /// ```
    /// let coefficients = emoc::Coefficients { ebar: 1.0, beta0: 0.0, beta1: 0.0 };
    /// let (_, gradient) = coefficients.rebound_with_gradient(1.0)?;
    /// assert_eq!(gradient.per_z, -0.25);
    /// # Ok::<(), emoc::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// As [`Coefficients::rebound`].
    #[inline]
    pub fn rebound_with_gradient(&self, z: T) -> Result<(Rebound<T>, CoefficientGradient<T>), InvalidInput> {
        let rebound = self.rebound(z)?;
        let one = T::ONE;
        let gradient = match rebound.branch {
            Branch::Basic => {
                let share = one / (one + z);
                CoefficientGradient {
                    per_ebar: share,
                    per_beta0: T::ZERO,
                    per_beta1: T::ZERO,
                    per_z: -self.ebar * share * share,
                }
            }
            Branch::Outward => {
                let scale = one / (one + self.beta0);
                CoefficientGradient {
                    per_ebar: (self.beta0 + self.beta1) * scale,
                    per_beta0: self.ebar * ((one - self.beta1) * scale) * scale,
                    per_beta1: self.ebar * scale,
                    per_z: T::ZERO,
                }
            }
        };
        Ok((rebound, gradient))
    }
}

/// `sum phi_k^2`, for finite shapes whose sum of squares is finite too.
pub(crate) fn sum_of_squares<T: Real>(phi: &[T]) -> Result<T, InvalidInput> {
    let mut sum = T::ZERO;
    for (index, &phi_k) in phi.iter().enumerate() {
        sum = sum + phi_k * phi_k;
        // False both for NaN and for overflow.
        let finite = sum <= T::MAX;
        require(finite, ("phi", index), phi_k, "a finite mode shape that leaves the sum of squares finite")?;
    }
    Ok(sum)
}
