//! Any contact law on any structure whose impulse response is a sum of powers of time.
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
//! is solved directly and not derived from (1), so that the rate is as accurate as the compression.
//!
//! # Method
//!
//! On a panel the force is a polynomial in a variable in which it is smooth (see [`super::rule`]); both integrals of it
//! are exact, and (3) at the Gauss nodes gives the nodal forces by Newton's method. A panel is accepted if the impulse of its last
//! two Legendre coefficients is below the tolerance. If the exponent of a law makes the force at touch nonsmooth, the first panels
//! are short, since the impulse decreases with the length.
//!
//! A branch of the law ends where one of its event functions, `a x + b x' - level`, falls below zero. Each event function is a
//! polynomial on the panel, which is searched for its first zero and for minima between samples. The panel that ends there is
//! found by secants. Integration continues on the branch that the law returns, with a panel that is again smooth in `sqrt(t)`.
//!
//! *Past*: impulses by age, as in [`super::history`]. *Flight*: [`flight`].
//!
//! Only for Hertz contact is it known whether a sustained contact ever ends ([`super::sustained`]). Here the run stops.

mod contact;
mod equations;
mod event;
pub(super) mod flight;
mod kernel;
mod law;
mod past;
mod solve;

pub use solve::solve_law;
