//! The law with its scatter: restitutions drawn from a distribution.
//!
//! Impacts with the same three numbers `Z`, `S_0`, `S_1` have different restitutions, because the order and the times of their
//! sub-impacts differ. Their distribution is taken as logistic in the logarithm of the odds `e/(1-e)` about that of the law,
//!
//! ```text
//! P(e <= x) = 1 / (1 + (o (1-x)/x)^(1/s)),       o = m/(1-m)                               (1)
//! e(u) = m / (m + (1-m) ((1-u)/u)^s),            u uniform from 0 to 1                     (2)
//! s = s_0 + s_1 (z_s Z)^2 / (1 + (z_s Z)^2)                                                (3)
//! ```
//!
//! with the law's restitution `m` as the median, both divided by the notional restitution. Its values are between 0 and 1, its
//! quantiles (2) have a closed form, and it becomes narrow as `m` approaches 1: at a small `Z` a single contact leaves only a
//! share of `1 - e` to chance. At a `Z` above `1/z_s` sub-impacts follow each other, and the scatter grows from `s_0` to `s_0 +
//! s_1`.

use crate::require::{require, require_fraction, require_non_negative, require_positive};
use crate::{Impact, Parameters};
use invalid_input::InvalidInput;

/// The law's parameters and those of its scatter (3).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ScatteredLaw {
    /// The law for the median.
    pub law: Parameters,
    /// `s_0`, the scatter of a single contact; greater than 0.
    pub single: f64,
    /// `s_1`, the addition by repeated contacts; not negative.
    pub repeated: f64,
    /// `z_s`, the inverse of the `Z` at which half of that is added; not negative.
    pub onset: f64,
}

/// The distribution of the restitution of one impact, by equation (1).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Scatter {
    /// The median, as a share of the notional restitution: from 0 to 1.
    pub median_share: f64,
    /// The scale `s` in the logarithm of the odds.
    pub scale: f64,
    /// The notional restitution, the largest that can be drawn.
    pub notional_restitution: f64,
}

impl ScatteredLaw {
    /// Fitted to the beams of thesis chapter 4 (converged modes, steel balls at 1 m/s, Hertz contact), with 50 modes in the
    /// law: the law to all beams at once, the scatter to each beam as the others predict it. See `docs/scatter-of-the-law.md`
    /// of the repository.
    pub const BEAMS: ScatteredLaw = ScatteredLaw {
        law: Parameters { mu0: 0.312, alpha0: 2.41, alpha1: 0.492, notional_restitution: 1.0 },
        single: 0.079,
        repeated: 0.222,
        onset: 1.71,
    };

    /// Checks the ranges of all parameters.
    ///
    /// # Errors
    /// [`InvalidInput`] names the first number out of range.
    pub fn validate(&self) -> Result<(), InvalidInput> {
        self.law.validate()?;
        require_positive("single", self.single)?;
        require_non_negative("repeated", self.repeated)?;
        require_non_negative("onset", self.onset)
    }

    /// The distribution of the restitution of an impact on a structure at rest.
    ///
    /// ```
    /// use emoc::{Impact, ScatteredLaw, Site};
    /// let site = Site::new(&[1.41, 0.9, -0.3])?;
    /// let scatter = ScatteredLaw::BEAMS.rebound(&Impact::new(0.2, &site)?)?;
    /// // u comes from the engine's own random numbers
    /// let restitution = scatter.draw(0.37)?;
    /// assert!(restitution > 0.0 && restitution < 1.0);
    /// let [low, high] = scatter.interval(0.9)?;
    /// assert!(low < restitution && restitution < high);
    /// # Ok::<(), emoc::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// [`InvalidInput`] as [`ScatteredLaw::validate`], and for an impact whose numbers are out of range.
    pub fn rebound(&self, impact: &Impact) -> Result<Scatter, InvalidInput> {
        self.validate()?;
        let notional_restitution = self.law.notional_restitution;
        // Computed from the shape alone, so that a notional restitution of 0 needs no exception.
        let shape = Parameters { notional_restitution: 1.0, ..self.law };
        let median_share = shape.rebound(impact)?.restitution;
        let x = self.onset * impact.z;
        // x^2/(1+x^2) without overflow
        let share = if x < 1.0 { x * x / (1.0 + x * x) } else { 1.0 / (1.0 + 1.0 / x / x) };
        Ok(Scatter { median_share, scale: self.single + self.repeated * share, notional_restitution })
    }
}

impl Scatter {
    /// The restitution for a number that is uniform from 0 to 1, ends included: equation (2). It increases with the number, so
    /// that `draw(0.5)` is the median and `draw(p)` the quantile at `p`.
    ///
    /// # Errors
    /// [`InvalidInput`] for a number outside 0 to 1.
    pub fn draw(&self, uniform: f64) -> Result<f64, InvalidInput> {
        require_fraction("uniform", uniform)?;
        let against = libm::pow((1.0 - uniform) / uniform, self.scale);
        let m = self.median_share;
        let share = match (m > 0.0, m < 1.0) {
            (false, _) => 0.0,
            (_, false) => 1.0,
            // The power may overflow, and then exceeds any odds.
            _ => 1.0 / (1.0 + (1.0 - m) / m * against),
        };
        Ok(self.notional_restitution * share)
    }

    /// The central interval that contains the restitution with probability `level`.
    ///
    /// # Errors
    /// [`InvalidInput`] for a `level` outside 0 to 1.
    pub fn interval(&self, level: f64) -> Result<[f64; 2], InvalidInput> {
        require_fraction("level", level)?;
        Ok([self.draw(0.5 * (1.0 - level))?, self.draw(0.5 * (1.0 + level))?])
    }

    /// The probability of a restitution of at most `restitution`: equation (1).
    ///
    /// # Errors
    /// [`InvalidInput`] for a restitution that is not finite.
    pub fn probability_below(&self, restitution: f64) -> Result<f64, InvalidInput> {
        require(restitution.is_finite(), "restitution", restitution, "a finite number")?;
        let x = restitution / self.notional_restitution;
        let m = self.median_share;
        Ok(match (x > 0.0, x < 1.0) {
            // The whole probability is at 0 if the median is.
            (false, _) => f64::from(u8::from(restitution == 0.0 && (m == 0.0 || self.notional_restitution == 0.0))),
            (_, false) => 1.0,
            _ if m == 0.0 => 1.0,
            _ if m == 1.0 => 0.0,
            _ => 1.0 / (1.0 + libm::pow(m / (1.0 - m) * ((1.0 - x) / x), 1.0 / self.scale)),
        })
    }

    /// The natural logarithm of the probability density at a restitution strictly between 0 and the notional one; minus
    /// infinity where the density is zero.
    pub fn log_density(&self, restitution: f64) -> f64 {
        let (x, m) = (restitution / self.notional_restitution, self.median_share);
        if !(x > 0.0 && x < 1.0 && m > 0.0 && m < 1.0) {
            return f64::NEG_INFINITY;
        }
        // Of the logistic distribution in the logarithm of the odds, symmetric about 0.
        let t = libm::fabs(libm::log(x / (1.0 - x)) - libm::log(m / (1.0 - m))) / self.scale;
        let logistic = -t - 2.0 * libm::log1p(libm::exp(-t)) - libm::log(self.scale);
        logistic - libm::log(x * (1.0 - x)) - libm::log(self.notional_restitution)
    }
}
