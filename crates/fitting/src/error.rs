//! Errors.

/// An input that cannot be worked with: which, its value, and what is allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{field} = {value} is not allowed: {allowed}")]
pub struct InvalidInput {
    /// Name of the field, as in the public structs.
    pub field: String,
    /// The value given, as text.
    pub value: String,
    /// What would be allowed.
    pub allowed: &'static str,
}

impl InvalidInput {
    pub(crate) fn new(field: impl Into<String>, value: impl ToString, allowed: &'static str) -> InvalidInput {
        InvalidInput { field: field.into(), value: value.to_string(), allowed }
    }
}

/// Why there is no fit.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// The input is not usable.
    #[error(transparent)]
    Invalid(#[from] InvalidInput),
    /// The model gave NaN, an infinity or a number beyond 1e100 at every starting point.
    #[error("the model is not finite at any of {starts} starting points")]
    NonFiniteModel {
        /// Number of starting points tried.
        starts: usize,
    },
}
