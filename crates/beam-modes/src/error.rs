//! The error for input that the crate cannot work with.

/// An input out of its range: which, its value, and what is allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{field} = {value} is not allowed: {allowed}")]
pub struct InvalidInput {
    /// Name of the input, as in the public structs and functions.
    pub field: String,
    /// The value given, as text.
    pub value: String,
    /// What would be allowed.
    pub allowed: &'static str,
}

impl InvalidInput {
    pub(crate) fn new(field: impl Into<String>, value: impl ToString, allowed: &'static str) -> Self {
        Self { field: field.into(), value: value.to_string(), allowed }
    }

    /// Passes a finite number greater than zero, and reports anything else.
    pub(crate) fn require_positive(field: impl Into<String>, value: f64) -> Result<f64, InvalidInput> {
        if value.is_finite() && value > 0.0 {
            Ok(value)
        } else {
            Err(Self::new(field, value, "a finite number greater than 0"))
        }
    }

    /// Passes a location on a structure of the given length.
    pub(crate) fn require_on(field: &str, x_m: f64, length_m: f64) -> Result<f64, InvalidInput> {
        if x_m >= 0.0 && x_m <= length_m {
            Ok(x_m)
        } else {
            Err(Self::new(field, x_m, "a location on the structure, from 0 to its length"))
        }
    }
}
