//! The error for parameters outside a law's range.

/// A parameter that the crate cannot work with: which, its value, and what is allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{field} = {value} is not allowed: {allowed}")]
pub struct InvalidInput {
    /// Name of the parameter, as in the public structs.
    pub field: String,
    /// The value given, as text.
    pub value: String,
    /// What would be allowed.
    pub allowed: &'static str,
}

/// Smallest positive parameter. With [`LARGEST`] it bounds every product a law forms, so that
/// no force overflows; both lie far outside any physics.
pub(crate) const SMALLEST: f64 = 1e-30;
/// Largest parameter that a law takes, and largest compression (m) and rate (m/s) that it computes with: beyond, its
/// force is the one at this bound.
pub const LARGEST: f64 = 1e30;

impl InvalidInput {
    /// Passes `value` if `holds`, and reports it with what is `allowed` otherwise.
    pub(crate) fn require(field: &str, value: f64, holds: bool, allowed: &'static str) -> Result<(), InvalidInput> {
        if holds { Ok(()) } else { Err(InvalidInput { field: field.into(), value: value.to_string(), allowed }) }
    }

    /// Passes a number greater than zero within the crate's range.
    pub(crate) fn require_positive(field: &str, value: f64) -> Result<(), InvalidInput> {
        let holds = (SMALLEST..=LARGEST).contains(&value);
        InvalidInput::require(field, value, holds, "a number greater than 0 (from 1e-30 to 1e30)")
    }

    /// Passes zero and any positive number up to the crate's limit.
    pub(crate) fn require_not_negative(field: &str, value: f64) -> Result<(), InvalidInput> {
        InvalidInput::require(field, value, (0.0..=LARGEST).contains(&value), "a number from 0 to 1e30")
    }

    /// Passes a coefficient of restitution that a damped law can have.
    pub(crate) fn require_restitution(field: &str, value: f64) -> Result<(), InvalidInput> {
        let holds = (0.001..=1.0).contains(&value);
        InvalidInput::require(field, value, holds, "a coefficient of restitution from 0.001 to 1")
    }
}

/// A compression or rate, held within what the laws compute with.
pub(crate) fn bounded(value: f64) -> f64 {
    value.clamp(-LARGEST, LARGEST)
}
