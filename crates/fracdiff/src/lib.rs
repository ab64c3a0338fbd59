//! Fractional derivatives and weakly singular Volterra equations: six methods for one type of problem, with events.
//!
//! # The problem
//!
//! [`Volterra`] is a system of Volterra equations of the second kind whose kernels are powers,
//!
//! ```text
//! y_i(t) = g_i(t) + sum over terms of  c int_0^t (t-s)^(a-1) f_k(s, y(s)) ds ,     0 <= t <= t_end,
//! ```
//!
//! They are weakly singular if an order `a` is below 1. Any number of terms may integrate one component `f_k` (sums of kernels,
//! `a = 1` and `a = 2` among them), and one equation may contain several terms. Fractional differential equations `D^b y + sum
//! of a_k D^(b_k) y = f(t, y)` with Caputo derivatives of any orders are reduced to such a system by `I^b`
//! ([`InitialValueProblem`]):
//!
//! ```text
//! y = T + sum a_k I^(b-b_k) T_k + I^b f - sum a_k I^(b-b_k) y ,   I^a f (t) = 1/Gamma(a) int_0^t (t-s)^(a-1) f(s) ds
//! ```
//!
//! with the Taylor polynomial `T` of the initial values and its part `T_k` below degree `b_k`. Forcing and density may
//! jump or have kinks in `t` at stated [`breaks`](Volterra::breaks); sign changes of functions of the solution are
//! located as [`Event`]s. Every method is implicit and solves its equations by Newton's method.
//!
//! | symbol | meaning | in the code | source |
//! |---|---|---|---|
//! | `y`, `g` | unknowns, forcing | [`Volterra::forcing`] | thesis Eqs. 2.3, 2.7 after integration |
//! | `f` | density, the integrand besides the kernel | [`Volterra::density`] | |
//! | `a`, `c` | order and factor of a kernel `c t^(a-1)` | [`Term`] | |
//! | `D^a` | Caputo or Riemann-Liouville derivative | [`operators`] | thesis A.1 |
//! | `A`, `B`, `c` | matrices of the Galerkin method | [`DasChatterjee`] | thesis Eq. A.1 |
//! | `q` | mapping `t - t0 = x^q` of panels | [`Collocation::mapping`] | |
//!
//! Times and values have the units of the problem.
//!
//! # The methods
//!
//! | [`Method`] | order | cost | memory | when to use it |
//! |---|---|---|---|---|
//! | [`Collocation`](Method::Collocation) | spectral | `O(P^2 n^2)` | `O(P n)` | first choice; reaches 12 digits |
//! | [`Trapezoidal`](Method::Trapezoidal) | 2 | `O(n log^2 n)` | `O(n)` | rough densities, many equal steps |
//! | [`SumOfExponentials`](Method::SumOfExponentials) | 2 | `O(n log n)` | `O(log n)` | long runs in bounded memory; graded steps |
//! | [`GalerkinStates`](Method::GalerkinStates) | 2, down to a floor | `O(n N)` | `O(N)` | the method of the literature |
//! | [`L1`](Method::L1) | 1; `2 - a` if smooth | `O(n log^2 n)` | `O(n)` | comparison |
//! | [`GrunwaldLetnikov`](Method::GrunwaldLetnikov) | 1 | `O(n log^2 n)` | `O(n)` | comparison |
//!
//! Collocation has `P` panels of `n` nodes, the other methods take `n` steps. [`Volterra::solve_to`] chooses the settings for a
//! requested accuracy and estimates the error.
//!
//! *Convolution methods* replace the integral by `h^a sum_j w_(n-j) f_j` on equal steps. For Gruenwald-Letnikov, `w` are the
//! coefficients of `(1-z)^-a`; for L1, those of the inverse of the L1 formula for the derivative of the fractional order, times
//! trapezoidal rules for the integer part of `a`. The trapezoidal method integrates the piecewise linear interpolant exactly,
//! with corrections for the first few values that make the rule exact for the powers `t^(j a)` below 1 with which the density
//! starts (Lubich 1986).
//!
//! *Decaying states*: `t^(a-1) ~ t^m sum_l w_l exp(-r_l t)` replaces the past by states that satisfy ordinary differential
//! equations. The sum is a quadrature of the Laplace integral of the kernel ([`ExponentialSum`]), accurate beyond one step, or
//! the Galerkin projection of Das and Chatterjee ([`DasChatterjee`]), which approximates the kernel everywhere.
//!
//! *Collocation*: on a panel of `x = (t - t0)^(1/q)`, `t0` the last break, the density is a polynomial through Gauss-Legendre
//! nodes. Kernels are integrated by Gauss-Jacobi rules that represent the singularity exactly: `t_i - s = (x_i - x) Q(x_i, x)`
//! with a positive, smooth `Q`. The contributions of past panels are Gauss sums, on dyadic pieces where they are near. Panels
//! are shortened until the last Legendre coefficients are negligible, so that they enclose a kink of the density (the end of a
//! contact) ever more closely.
//!
//! # Limits
//!
//! Kernels are sums of powers, and orders are constant. Newton's method solves dense systems of tens of unknowns, not
//! thousands. If a solution blows up, the run ends early, and [`Solution::stop`] states where and why.
//!
//! # Example
//!
//! A ball on a simplified infinite beam, `x = t - int [(t-s) + sqrt(t-s)] x ds`, until it lifts off:
//!
//! ```
//! use fracdiff::{Collocation, Event, Method, Stop, Volterra};
//!
//! let beam = Volterra::scalar(|t| t, |_, x| x, &[(2.0, -1.0), (1.5, -1.0)])
//!     .with_event(Event::new(|_, x| x[0]).terminal());
//! let solution = beam.solve(&Method::Collocation(Collocation::default()), 10.0)?;
//! assert_eq!(solution.stop, Stop::Event { index: 0 });
//! assert!((solution.end_time() - 2.5701454794074989).abs() < 1e-12);
//! assert!((solution.at(1.0)?[0] - 0.6347269613345202).abs() < 1e-12);
//! # Ok::<(), fracdiff::InvalidInput>(())
//! ```
//!
//! # Sources
//!
//! Hairer, Lubich & Schlichte (1985) for fast histories; Lubich (1986) for starting weights; Diethelm, Ford & Freed
//! (2004) for the product trapezoidal rule; Jiang, Zhang, Zhang & Zhang (2017) for sums of exponentials; Singh &
//! Chatterjee (2006) and Das & Chatterjee (2013) for Galerkin states; Brunner (2004) for collocation.

mod accuracy;
mod collocation;
mod convolution;
mod dense;
mod exponential;
mod implicit;
mod ivp;
mod method;
pub mod operators;
mod power;
mod problem;
mod quadrature;
mod recorder;
mod solution;
mod system;
pub mod test_problems;

pub use accuracy::Estimated;
pub use collocation::Collocation;
pub use convolution::Convolution;
pub use exponential::{DasChatterjee, ExponentialSum, GalerkinStates, SumOfExponentials};
pub use invalid_input::InvalidInput;
pub use ivp::{Equation, InitialValueProblem};
pub use method::Method;
pub use problem::{Density, Direction, Event, EventFunction, Forcing, Term, Volterra};
pub use solution::{Counts, EventHit, Solution, Stop};

/// The examples of the README, run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
