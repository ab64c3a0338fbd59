#![forbid(unsafe_code)]
//! Nonlinear least squares over closures: estimates, intervals, cross-validation.
//!
//! Given residuals `r_i(p)`, `i = 1..m`, as a closure, [`fit`] looks for the parameters `p` with the least
//!
//! ```text
//! S(p) = sum w_i r_i(p)^2.
//! ```
//!
//! # How
//!
//! - **Ranges by transformation.** A parameter is sought in a coordinate `u` without bounds: `p = u`, `p = exp u`
//!   or `p = low + (high - low)/(1 + exp(-u))` ([`Range`]). Derivatives are multiplied by `dp/du`.
//! - **Several starts.** The parameters' own starting point, then Halton's sequence over their search intervals in
//!   `u`: even cover, no random numbers. What each start leads to is part of the [`Fit`].
//! - **Smooth residuals.** The method of Levenberg and Marquardt, from the crate `levenberg-marquardt` (a port of
//!   MINPACK). The Jacobian is yours or comes from central differences with steps of `cbrt(eps) max(1, |u|)`.
//! - **Kinked residuals.** Where `r` has kinks, as with a maximum in the model, a gradient method can end on a
//!   kink that is no minimum. The simplex method of Nelder and Mead, restarted until it gains nothing,
//!   goes on from the best point ([`Method::Both`], the default).
//! - **Intervals.** `C = s^2 (J^T J)^-1`, `s^2 = S/(m - n)`, in `u`, with Student's quantile ([`Fit::intervals`]; its
//!   assumptions are stated there), or by resampling with a seed ([`bootstrap`]).
//! - **What is determined.** [`Information`] gives the covariance, the directions that the residuals leave open, and what
//!   further residuals would add; [`profile`] follows the sum of squares where the covariance is too simple; and
//!   [`chi_square_tail`] and [`fisher_tail`] test whether noise explains the misfit.
//! - **Prediction.** [`cross_validate`] leaves out random folds ([`k_folds`]) or groups that belong together.
//!
//! The same input gives the same bits: one thread, sums in order, random numbers from a seed only.
//!
//! | symbol | meaning |
//! |---|---|
//! | `m`, `n` | number of residuals, of parameters |
//! | `p`, `u` | parameter in its own unit, transformed coordinate |
//! | `r_i`, `w_i` | residual, its weight (a count in resampling, 0 for what is left out) |
//! | `J` | Jacobian `d (sqrt(w_i) r_i) / d u_j` |
//! | `S`, `s^2` | sum of squares, variance `S/(m - n)` |
//! | `C` | covariance of `u` |
//!
//! # Limits
//!
//! Jacobians are dense: a few parameters, up to some thousand residuals. The loss is the sum of squares, in which
//! outliers count in full. Intervals assume independent errors of equal variance.
//!
//! # What can happen
//!
//! Bad input is an [`InvalidInput`]. A model that is not finite at any starting point is
//! [`FitError::NonFiniteModel`]; where it is not finite on the way, the search turns back. A search that ends at its
//! limit says so in its [`Outcome`]. No closure that returns makes the crate panic or loop without end.

mod covariance;
mod distributions;
mod error;
mod fit;
mod gradient_method;
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
pub use intervals::{Interval, bootstrap};
pub use invalid_input::InvalidInput;
pub use parameter::{Parameter, Range};
pub use problem::{Fit, Method, Outcome, Problem, ResidualsFn, Settings, Start};
pub use profile::{Profile, profile};
pub use report::Residuals;
pub use validation::{CrossValidation, Fold, cross_validate, k_folds};

/// Runs the example of the readme.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
