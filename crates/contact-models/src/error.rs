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

impl InvalidInput {
    /// Passes a finite number greater than zero, and reports anything else.
    pub(crate) fn require_positive(field: &str, value: f64) -> Result<f64, InvalidInput> {
        if value.is_finite() && value > 0.0 {
            Ok(value)
        } else {
            Err(InvalidInput {
                field: field.into(),
                value: value.to_string(),
                allowed: "a finite number greater than 0",
            })
        }
    }
}
