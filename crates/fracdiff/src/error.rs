//! The error for input that no solver could work with.

/// An input that the crate cannot work with: which, its value, and what is allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{field} = {value} is not allowed: {allowed}")]
pub struct InvalidInput {
    /// Name of the input, as in the public structs and arguments.
    pub field: String,
    /// The value given, as text.
    pub value: String,
    /// What would be allowed.
    pub allowed: &'static str,
}

impl InvalidInput {
    pub(crate) fn new(field: impl Into<String>, value: impl ToString, allowed: &'static str) -> Self {
        InvalidInput { field: field.into(), value: value.to_string(), allowed }
    }

    /// Passes a value for which `ok` holds, and reports any other.
    pub(crate) fn require<T: ToString + Copy>(
        ok: bool,
        field: &str,
        value: T,
        allowed: &'static str,
    ) -> Result<T, InvalidInput> {
        if ok { Ok(value) } else { Err(InvalidInput::new(field, value, allowed)) }
    }

    /// Passes a finite number greater than zero, and reports anything else.
    pub(crate) fn require_positive(field: &str, value: f64) -> Result<f64, InvalidInput> {
        Self::require(value.is_finite() && value > 0.0, field, value, "a finite number greater than 0")
    }

    /// Passes a finite number, and reports anything else.
    pub(crate) fn require_finite(field: &str, value: f64) -> Result<f64, InvalidInput> {
        Self::require(value.is_finite(), field, value, "a finite number")
    }
}
