//! A power of the compression. Conservative.

use crate::conservative::{Conservative, conservative_law, power_of};
use crate::range::require_positive;
use invalid_input::InvalidInput;

/// `F = k <xi>^n` with any exponent from 1 to 6.
///
/// Source: textbook (W. Goldsmith, *Impact*, 1960, ch. 4); for the felt of piano hammers, T. Yanagisawa and K. Nakamura, *J.
/// Acoust. Soc. Jpn.* 40 (1984) 725, and A. Chaigne and A. Askenfelt, *J. Acoust. Soc. Am.* 95 (1994) 1112, with `n` from 2 to
/// 5. [`Hertz`](crate::Hertz) is `n = 3/2`, [`LinearSpring`](crate::LinearSpring) is `n = 1`; a blunt tip, flatter than a
/// sphere, has `n` below 3/2, and a cone `n = 2`. Valid if loading and unloading follow one curve; [`Felt`](crate::Felt)
/// includes the losses of felt. Tension: none.
///
/// ```
/// use contact_models::{ContactLaw, Memory, Power};
///
/// let hammer = Power::new(4.5e9, 2.5)?; // C4 of a grand piano
/// let branch = hammer.touch(&Memory::default(), 2.0);
/// assert!((hammer.force(&branch, 1e-4, 0.0).force_n - 0.45).abs() < 1e-12);
/// # Ok::<(), contact_models::InvalidInput>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Power {
    /// Stiffness `k` (N/m^n).
    pub stiffness_n_m_n: f64,
    /// Exponent `n`, from 1 to 6.
    pub exponent: f64,
}

impl Power {
    /// The law with stiffness `k` (N/m^n) and exponent `n`.
    ///
    /// # Errors
    /// A stiffness that is not positive, an exponent outside 1 to 6.
    pub fn new(stiffness_n_m_n: f64, exponent: f64) -> Result<Power, InvalidInput> {
        Power { stiffness_n_m_n, exponent }.validated()
    }

    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// As [`Power::new`].
    pub fn validated(self) -> Result<Power, InvalidInput> {
        require_positive("stiffness_n_m_n", self.stiffness_n_m_n)?;
        InvalidInput::unless((1.0..=6.0).contains(&self.exponent), "exponent", self.exponent, "a number from 1 to 6")?;
        Ok(self)
    }
}

impl Conservative for Power {
    fn exponent(&self) -> f64 {
        self.exponent
    }

    fn curve(&self, compression_m: f64) -> (f64, f64) {
        power_of(self.stiffness_n_m_n, self.exponent, compression_m)
    }
}

conservative_law!(Power);
