//! The error for input outside the model's range.

use crate::Real;
use core::fmt;

/// An input that the crate cannot work with: which, its value, and what is allowed.
///
/// It owns no memory, so that it exists without an allocator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InvalidInput {
    /// Name of the field, as in the public structs.
    pub field: &'static str,
    /// Place within the field, where it is a list.
    pub index: Option<usize>,
    /// The value given; a length where the length is at fault.
    pub value: f64,
    /// What would be allowed.
    pub allowed: &'static str,
}

impl fmt::Display for InvalidInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.index {
            Some(index) => write!(f, "{}[{}] = {} is not allowed: {}", self.field, index, self.value, self.allowed),
            None => write!(f, "{} = {} is not allowed: {}", self.field, self.value, self.allowed),
        }
    }
}

impl core::error::Error for InvalidInput {}

/// Passes when `holds`, and otherwise reports the field. Written so that a comparison with NaN reports it.
#[inline]
pub(crate) fn require<T: Real>(
    holds: bool,
    field: &'static str,
    value: T,
    allowed: &'static str,
) -> Result<(), InvalidInput> {
    if holds { Ok(()) } else { Err(InvalidInput { field, index: None, value: value.to_f64(), allowed }) }
}

/// Passes a finite number not less than zero.
#[inline]
pub(crate) fn require_non_negative<T: Real>(field: &'static str, value: T) -> Result<(), InvalidInput> {
    require(value >= T::ZERO && value <= T::MAX, field, value, "a finite number not less than 0")
}

/// Passes a finite number greater than zero.
#[inline]
pub(crate) fn require_positive<T: Real>(field: &'static str, value: T) -> Result<(), InvalidInput> {
    require(value > T::ZERO && value <= T::MAX, field, value, "a finite number greater than 0")
}

/// Passes a number from zero to one.
#[inline]
pub(crate) fn require_fraction<T: Real>(field: &'static str, value: T) -> Result<(), InvalidInput> {
    require(value >= T::ZERO && value <= T::ONE, field, value, "a number from 0 to 1")
}
