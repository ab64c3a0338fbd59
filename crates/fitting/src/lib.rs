//! fitting
mod error;
mod fit;
mod gradient_method;
mod intervals;
mod objective;
mod parameter;
mod random;
mod report;
mod simplex;
mod validation;

pub use error::{FitError, InvalidInput};
pub use fit::{Fit, Method, Outcome, Problem, ResidualsFn, Settings, Start, fit};
pub use intervals::{Interval, bootstrap};
pub use parameter::{Parameter, Range};
pub use report::Residuals;
pub use validation::{CrossValidation, Fold, cross_validate, k_folds};
