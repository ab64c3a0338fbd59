#![forbid(unsafe_code)]
//! Nonlinear least squares over closures: estimates, intervals, cross-validation.
//!
//! Given residuals `r_i(p)`, `i = 1..m`, as a closure, [`fit`] finds the parameters `p` with the smallest
//!
//! ```text
//! S(p) = sum w_i r_i(p)^2.
//! ```
//!
//! # Methods
//!
//! - **Ranges by transformation.** A parameter is represented by a coordinate `u` without bounds: `p = u`, `p = exp u` or `p =
//!   low + (high - low)/(1 + exp(-u))` ([`Range`]). Derivatives are multiplied by `dp/du`.
//! - **Several starts.** The starting points are that of the parameters and then Halton's sequence over their search intervals
//!   in `u`, which covers them evenly without random numbers. The end of each start is part of the [`Fit`].
//! - **Smooth residuals.** The method is that of Levenberg and Marquardt, from the crate `levenberg-marquardt` (a port of
//!   MINPACK). The Jacobian is given or comes from central differences with steps of `cbrt(eps) max(1, |u|)`; for a free parameter
//!   whose search interval is shorter than 1, its length takes the place of the 1.
//! - **Residuals with kinks.** If `r` has kinks, as with a maximum in the model, a gradient method can end on a kink that is
//!   not a minimum. The simplex method of Nelder and Mead, restarted until it gains nothing, continues from the best point
//!   ([`Method::Both`], the default).
//! - **Intervals.** `C = s^2 (J^T J)^-1`, `s^2 = S/(m - n)`, in `u`, with Student's quantile ([`Fit::intervals`], which states
//!   the assumptions), by likelihood profile, also next to the end of a range ([`profile_intervals`]), or by resampling with a seed
//!   ([`bootstrap`]).
//! - **Determination.** [`Information`] gives the covariance, the directions that the residuals do not determine, and the gain
//!   from further residuals; [`profile`] follows the sum of squares if the covariance is too simple; and [`chi_square_tail`]
//!   and [`fisher_tail`] test whether noise explains the misfit.
//! - **Prediction.** [`cross_validate`] omits random folds ([`k_folds`]) or groups that belong together.
//!
//! The same input gives the same result to the last bit: there is one thread, sums have a fixed order, and random numbers a
//! seed.
//!
//! | symbol | meaning |
//! |---|---|
//! | `m`, `n` | number of residuals, number of parameters |
//! | `p`, `u` | parameter in its own unit, transformed coordinate |
//! | `r_i`, `w_i` | residual, its weight (a count in resampling, 0 for an omitted residual) |
//! | `J` | Jacobian `d (sqrt(w_i) r_i) / d u_j` |
//! | `S`, `s^2` | sum of squares, variance `S/(m - n)` |
//! | `C` | covariance of `u` |
//!
//! # Limits
//!
//! Jacobians are dense: a few parameters, up to some thousand residuals. The loss is the sum of squares, in which
//! outliers count in full. Intervals assume independent errors of equal variance.
//!
//! # Outcomes
//!
//! Invalid input is an [`InvalidInput`]. A model that is not finite at any starting point is [`FitError::NonFiniteModel`]; if
//! it is not finite further on, the search turns back. A search that ends at its limit reports this in its [`Outcome`]. No
//! closure that returns makes the crate panic or loop forever.

mod covariance;
mod distributions;
mod error;
mod fit;
mod gradient_method;
mod incomplete;
mod information;
mod intervals;
mod objective;
mod parameter;
mod problem;
mod profile;
mod random;
mod report;
mod simplex;
mod validation;

pub use distributions::{chi_square_tail, fisher_tail, two_sided_quantile};
pub use error::FitError;
pub use fit::fit;
pub use information::{Direction, Information};
pub use intervals::{Interval, bootstrap, profile_intervals};
pub use invalid_input::InvalidInput;
pub use parameter::{Parameter, Range};
pub use problem::{Fit, Method, Outcome, Problem, ResidualsFn, Settings, Start};
pub use profile::{Profile, profile};
pub use report::Residuals;
pub use validation::{CrossValidation, Fold, cross_validate, k_folds};

/// Runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
