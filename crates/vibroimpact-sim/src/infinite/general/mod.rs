//! Any law of contact on any structure whose impulse response is a sum of powers of time.
//!
//! # Mathematics
//!
//! With time in units of `T`, where `m y(T) = T`, force in `F = m v / T` and displacement in `v T`, the compression `x` and
//! the force obey
//!
//! ```text
//! x(t)  = t - int_0^t [(t - s) + kappa(t - s)] f(s) ds,                                 (1)
//! x'(t) = 1 - int_0^t [1 + kappa'(t - s)] f(s) ds - kappa(0) f(t),                      (2)
//! f     = law(x, x'),        kappa(t) = sum_k c_k t^(p_k),   0 <= p_k < 1,              (3)
//! ```
//!
//! where `kappa(0)` is the sum of the `c_k` with `p_k = 0`, and `kappa'` is singular at zero but integrable. Equation (2)
//! is used as it stands and not as a derivative of (1), so that the rate is as accurate as the compression.
//!
//! # Method
//!
//! On a panel the force is a polynomial in a variable in which it is smooth (see [`super::rule`]); both integrals of it
//! are exact, and (3) at the Gauss nodes gives the nodal forces by Newton's method. A panel is taken if the impulse that
//! its last two Legendre coefficients carry is below the tolerance. As an impulse shrinks with the panel, laws whose
//! exponents make no smooth force at touch are met by short first panels.
//!
//! A branch of the law ends where one of its margins, `a x + b x' - level`, falls below zero: each margin is a polynomial
//! on the panel, searched for its first crossing and for minima between samples. The panel that ends there is found by
//! secants; the march goes on along the branch that the law names, on a panel that is again smooth in `sqrt(t)`.
//!
//! *Past*: impulses by age, as in [`super::history`]. *Flight*: [`flight`].
//!
//! Whether a contact that lasts will ever end is known for Hertz contact alone ([`super::sustained`]). Here the run stops.

mod contact;
mod equations;
mod event;
pub(super) mod flight;
mod kernel;
mod law;
mod past;
mod solve;

pub use solve::solve_law;
