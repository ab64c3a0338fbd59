//! Accepts values in range, and reports the field otherwise. The comparisons are written so that NaN is reported.

use crate::Real;
use invalid_input::{InvalidInput, Path};

/// Succeeds if `holds`.
#[inline]
pub(crate) fn require<T: Real>(
    holds: bool,
    field: impl Into<Path>,
    value: T,
    allowed: &'static str,
) -> Result<(), InvalidInput> {
    InvalidInput::unless(holds, field, value.to_f64(), allowed)
}

/// Accepts a finite number not less than zero.
#[inline]
pub(crate) fn require_non_negative<T: Real>(field: &'static str, value: T) -> Result<(), InvalidInput> {
    require(value >= T::ZERO && value <= T::MAX, field, value, "a finite number not less than 0")
}

/// Accepts a finite number greater than zero.
#[inline]
pub(crate) fn require_positive<T: Real>(field: &'static str, value: T) -> Result<(), InvalidInput> {
    require(value > T::ZERO && value <= T::MAX, field, value, "a finite number greater than 0")
}

/// Accepts a number from zero to one.
#[inline]
pub(crate) fn require_fraction<T: Real>(field: &'static str, value: T) -> Result<(), InvalidInput> {
    require(value >= T::ZERO && value <= T::ONE, field, value, "a number from 0 to 1")
}
