//! Why there is no fit.

use invalid_input::InvalidInput;

/// Why there is no fit.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// The input is not valid.
    #[error(transparent)]
    Invalid(#[from] InvalidInput),
    /// The model gave NaN, an infinity or a number beyond 1e100 at every starting point.
    #[error("the model is not finite at any of {starts} starting points")]
    NonFiniteModel {
        /// Number of starting points tried.
        starts: usize,
    },
}
