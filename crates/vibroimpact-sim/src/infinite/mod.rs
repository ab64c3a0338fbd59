//! A compact body strikes an infinite structure, as a beam or a thin plate (thesis chapter 2).
//!
//! # Mathematics
//!
//! An impulse `P` at a point of an infinite Euler-Bernoulli beam moves that point by
//! `P C sqrt(t)` (Eq. 2.1), of a thin infinite plate by the constant `P alpha` (Zener 1941). With
//! Hertz contact, time in units of `T = C^2 m^2`, force in units of `F = v/(C^2 m)`, speed in units
//! of `v` and displacement in units of `v T`, the compression obeys one scalar Volterra equation
//! with one parameter,
//!
//! ```text
//! x(t) = t - int_0^t [ (t - s) + K(t - s) ] f(s) ds,      f = sqrt(S) max(x, 0)^(3/2),
//! K(t) = sqrt(t) for the beam, 1 for the plate.
//! ```
//!
//! | symbol | meaning | unit | source |
//! |---|---|---|---|
//! | `x` | compression, body minus structure displacement; negative: gap | `v T` | Eq. 2.5, `xi` |
//! | `f` | contact force | `F` | Eqs. 2.5, 2.10 |
//! | `t` | time since first touch | `T` | Eq. 2.9 |
//! | `S` | the single nondimensional parameter, `C^10 k_H^2 m^8 v` for the beam | 1 | Eq. 2.8 |
//! | `u` | speed of the body towards the structure | `v` | |
//!
//! Displacements in the thesis's unit `D` (Eq. 2.11) are `S^(1/3)` times those in `v T`.
//!
//! Any other law, on a structure with an impulse response that is a sum of powers of time, obeys the same equation. With time in
//! units of `T`, where `m y(T) = T`, the force in `F = m v / T` and displacements in `v T`,
//!
//! ```text
//! x(t)  = t - int_0^t [(t - s) + kappa(t - s)] f(s) ds,                                 (1)
//! x'(t) = 1 - int_0^t [1 + kappa'(t - s)] f(s) ds - kappa(0) f(t),                      (2)
//! f     = law(x, x'),        kappa(t) = sum_k c_k t^(p_k),   0 <= p_k < 1,              (3)
//! ```
//!
//! where `kappa(0)` is the sum of the `c_k` with `p_k = 0`, and `kappa'` is singular at zero but integrable. [`Receptance`] admits
//! one to eight terms, with powers of 0 or 0.1 to 0.9.
//!
//! # Method
//!
//! *Contact*: spectral collocation on panels. The force is a polynomial in a variable in which it is smooth, the square root of
//! time at touch and separation; both integrals of it are exact (`kernel.rs`), and (3) at the Gauss nodes gives the nodal forces by
//! Newton's method (`equations.rs`). Equation (2) is solved only for laws that ask for the rate, and not derived from (1), so that the
//! rate is as accurate as the compression. A panel is accepted if the impulse of its last two Legendre coefficients is below the
//! tolerance. If the exponent of a law makes the force at touch nonsmooth, the first panels are short, since the impulse decreases
//! with the length.
//!
//! *Events*: a branch of the law ends where one of its event functions, `a x + b x' - level`, falls below zero. Each is a polynomial
//! on the panel, which is searched for its first zero and for minima between samples (`event.rs`). The panel that ends there is found
//! by Newton's method. The contact goes on with the branch that the law returns, with a panel that is again smooth in `sqrt(t)`.
//!
//! *Past*: of the recent panels those between start and end by closed-form integrals of Legendre polynomials against `sqrt(z - u)`,
//! where the square root is the whole after-effect (`root_sum.rs`), and the others by Gauss rules in pieces (`past.rs`). Older ones are
//! Gauss rules of the positive measure `f ds`, by age (`history.rs`), on a time origin that moves along (`contact.rs`).
//!
//! *Flight*: closed form; the gap is convex, so there is at most one next contact, and Newton's method finds it (`flight.rs`).
//!
//! *End*: a contact is sustained once relative oscillations of the force about that of an attached body ([`attached`]) have shrunk
//! below one half over two natural periods, at a time from which the beam's damping outweighs everything that makes them grow,
//!
//! ```text
//! d ln a / d ln t = 9/8 - 0.300 S^(1/4) t^(5/8),
//! ```
//!
//! at least four times over. Only for Hertz contact is it known whether a sustained contact ever ends (`sustained.rs`); with another
//! law the run stops. Close to the critical `S` the end may depend on more digits than floating-point numbers have
//! ([`StopReason::DigitsExhausted`](crate::StopReason::DigitsExhausted)): see [`Solution::certain_separations`].
//!
//! # Example
//!
//! ```
//! use vibroimpact_sim::infinite::{Outcome, Settings, Structure, solve};
//!
//! let solution = solve(Structure::Beam, 15.0, &Settings::default())?;
//! assert_eq!(solution.outcome, Outcome::Sustained);
//! assert_eq!(solution.separations(), 4);
//! let now = solution.at(0.5).unwrap();
//! assert!(now.force > 0.0 && now.compression > 0.0);
//! # Ok::<(), vibroimpact_sim::InvalidInput>(())
//! ```

mod asymptotic;
mod contact;
mod equations;
mod event;
mod flight;
mod free;
mod groups;
mod history;
mod kernel;
mod law;
mod natural_times;
mod panel;
mod past;
mod problem;
mod receptance;
mod root_sum;
mod rule;
mod semi_analytical;
mod solution;
mod solve;
mod sustained;
mod turning;

pub use asymptotic::{Attached, attached, displacement_eq_2_47};
pub use groups::{BeamSection, Groups, Impact, Material, PlateSection};
pub use problem::{S_RANGE, Settings, Structure};
pub use receptance::{Receptance, Scale, Term};
pub use semi_analytical::FirstContact;
pub use solution::{Extremum, Outcome, Solution, State, SubImpact};
pub use solve::{solve, solve_law};
pub use turning::{CriticalS, MOST_TURNING_POINTS, TurningPoint, critical_s, turning_point, turning_points};
