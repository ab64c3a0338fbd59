//! A compact body strikes an infinite beam or a thin infinite plate (thesis chapter 2).
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
//! # Method
//!
//! *Contact*: spectral collocation on panels, mapped at touch and separation where `x` is smooth
//! in the square root of time; exact product integration within a panel; past panels through
//! closed-form integrals of Legendre polynomials against `sqrt(z - u)`. *Flight*: closed form; the
//! gap is convex, so the next contact exists exactly when the body still moves towards the
//! structure, and is found by Newton's method from both sides. *Past*: Gauss rules of the positive
//! measure `f ds`, by age, on a time origin that moves along. *End*: see
//! [`Outcome::Sustained`].
//!
//! *Other laws, other structures*: [`solve_law`] solves the same equation for any [`ContactLaw`](contact_models::ContactLaw)
//! and for any [`Receptance`] that is a sum of powers of time. It shares panels, history and solution with the solver for
//! `S`, computes the rate from a separate integral, and locates changes of the law's branch.
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
mod collocate;
mod contact;
mod flight;
mod free;
mod general;
mod groups;
mod history;
mod panel;
mod piece;
mod problem;
mod receptance;
mod rule;
mod semi_analytical;
mod solution;
mod solve;
mod sustained;
mod turning;
mod units;

pub use asymptotic::{Attached, attached, displacement_eq_2_47};
pub use general::solve_law;
pub use groups::{BeamSection, Groups, Impact, Material, PlateSection};
pub use problem::{S_RANGE, Settings, Structure};
pub use receptance::{Receptance, Scale, Term};
pub use semi_analytical::FirstContact;
pub use solution::{Extremum, Outcome, Solution, State, SubImpact};
pub use solve::solve;
pub use turning::{CriticalS, MOST_TURNING_POINTS, TurningPoint, critical_s, turning_point, turning_points};
