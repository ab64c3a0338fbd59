#![no_std]
#![forbid(unsafe_code)]
//! Net restitution without time integration: **e**nergy **m**inimisation under **o**utward **c**onstraints.
//!
//! A compact body of mass `m` strikes a vibrating structure at rest with speed `u = -v_i`. The sequence of sub-impacts
//! that follows is not resolved in time. Instead the velocity `v_f` after it and the modal speeds `a_k'` minimise the
//! kinetic energy
//!
//! ```text
//! (m v_f^2 + sum a_k'^2) / 2                                   (6.4)
//! ```
//!
//! under the conditions that the impulse `m (v_f + u)` limits the change of each mode, and that the bodies separate:
//!
//! ```text
//! |a_k'| <= phi_k m (v_f + u)                                  (6.5, fundamental)
//! v_f - sum phi_k a_k'          >= ebar u                      (6.6, restitution)
//! v_f - beta_0 sum phi_k |a_k'| >= beta_1 ebar u               (6.7, outward)
//! ```
//!
//! The thesis (A. Bhattacharjee, IIT Kanpur, 2019, chapters 5 to 8) solves this problem P_0 as a quadratic program
//! in `2 N + 1` variables. It has a closed form in two numbers, `Z` and the coefficients:
//!
//! ```text
//! e = v_f / u = ebar max( 1/(1+Z), (beta_0+beta_1)/(1+beta_0) ),      Z = m sum phi_k^2.
//! ```
//!
//! # Derivation
//!
//! In short, with `x = v_f/u` and the recoil speed of the contact point `y = -sum phi_k a_k'/u`:
//!
//! 1. For a given `y >= 0` the modal energy is smallest for `a_k' = -phi_k y u / sum phi^2` (Cauchy and Schwarz), and the same
//!    choice minimises `sum phi_k |a_k'|`; a negative `y` only costs energy. So P_0 is a problem in `(x, y)`: minimise `x^2 +
//!    y^2/Z` with `x + y >= ebar`, `x - beta_0 y >= beta_1 ebar`, `0 <= y <= Z (1+x)`.
//! 2. On `x + y = ebar` alone the energy is smallest at `x = ebar/(1+Z)`. If this satisfies the outward inequality, it is the
//!    solution; if not, both are equalities, which gives the second term, and the multipliers of both are positive.
//! 3. In either case `y <= ebar Z/(1+Z) < Z (1+x)`: the fundamental inequalities (6.5) are never active.
//!
//! Every step is in `docs/emoc-closed-form.md` of the repository. The tests compare the closed form with P_1
//! (Eqs. 6.8 to 6.13), its reduced form, and P_0 with all `2^N` sign combinations of (6.7).
//!
//! # Symbols
//!
//! | symbol | meaning | unit | equation |
//! |---|---|---|---|
//! | `m` | mass of the striker | kg | 6.4 |
//! | `phi_k` | mass-normalised mode shape at the contact | kg^-1/2 | 6.1 |
//! | `a_k'` | modal speed after the impact | kg^1/2 m/s | 6.2 |
//! | `u`, `v_f` | speed of approach, velocity after the impact | m/s | 6.4 |
//! | `e` | restitution `v_f/u` | 1 | |
//! | `Z` | moderated mass ratio `m sum phi_k^2` | 1 | 7.3 |
//! | `S_0`, `S_1` | `Z/N`, `m phi_1^2` | 1 | 7.6, 7.7 |
//! | `ebar` | restitution of the contact points, `e (mu_0^2 Z^2 + 1)/(mu_0^2 Z^2 + mu_0 Z + 1)` | 1 | 7.5 |
//! | `beta_0` | `alpha_0 S_0/(1 + alpha_0 S_0)` | 1 | 7.6 |
//! | `beta_1` | `alpha_1 S_1/(1 + alpha_1 S_1)` | 1 | 7.7 |
//! | `mu_0`, `alpha_0`, `alpha_1` | fitted parameters, not negative | 1 | 7.4 to 7.7 |
//! | `y` | recoil of the structure's point over `u` | 1 | |
//! | `W` | inverse of the contact inertia `M_C` | 1/kg | 5.1 |
//!
//! # Items
//!
//! - [`Coefficients::rebound`]: the closed form. [`Parameters::rebound`]: the three-parameter form of chapter 7, for
//!   an [`Impact`] at a [`Site`]. Both in `f64` or `f32`, without allocation, with derivatives, and with the
//!   [`Branch`] of the maximum that is active. The restitution is continuous and has a kink where both terms are
//!   equal ([`Rebound::kink_margin`] is zero); nowhere else.
//! - [`MovingImpact::rebound`]: the same for a structure that moves already, by two nested bisections, without allocation.
//! - `ScatteredLaw` (feature `scatter`): the distribution of the restitution about the law, and draws from it by a uniform random
//!   number, for physics engines.
//! - [`newton_restitution`]: a constant coefficient at the contact points, for comparison.
//! - `Problem` and `lcp` (feature `alloc`): several contacts at once; the linear complementarity baseline.
//! - `Solver` (feature `qp`): energy minimisation under outward constraints for several contacts, a structure that
//!   vibrates already, friction; `Solver::least_energy` is Todorov's rule (5.3). `SingleImpact`: P_1 and its
//!   reduced form as quadratic programs.
//!
//! Without features the crate has no third-party dependency and needs neither `std` nor an allocator. `qp` (default) adds `alloc`, `std`
//! and [Clarabel](https://docs.rs/clarabel); `scatter` adds [libm](https://docs.rs/libm), which needs neither.
//!
//! # Limits
//!
//! The closed form applies to one contact and a structure at rest, [`MovingImpact`] to one contact and any motion. Contact law,
//! speed and frequencies are not arguments, so that the number of modes takes the role of the duration of the contact: the
//! modes should reach somewhat beyond the frequencies that it excites. With three parameters for a structure the law follows
//! averages over location and mass. On the beams of the thesis its error compared with resolved impacts is 0.05 to 0.08 (rms),
//! and up to 0.3 for single ones.
//!
//! # Several contacts
//!
//! In contact coordinates (all contacts, normals and tangents, stacked) impulses `P` change the strikers' contact
//! velocities by `W P`, and `g = v - sum shape_k a_k'` is the velocity at which contacts open. The program is
//!
//! ```text
//! min  P.W P/2 + v.P + sum (a_k'^2 - a_k'(0)^2)/2                  change of kinetic energy
//!      p_i >= 0, (p_i, tau_i) in the friction pyramid              5.2.2
//!      g_i >= ebar_i max(u_i, 0),  u_i = -g_i(0)                   6.6; no interpenetration
//!      v_i - beta_0 sum |shape_ki| |a_k'| >= beta_1 ebar_i u_i     6.7, where u_i > 0
//!      |a_k' - a_k'(0)| <= sum_j (|shape_kj| + mu_j |shape_kj,t|) p_j   6.5
//! ```
//!
//! For one striker and a structure at rest this is P_1. With a structure that vibrates, or bodies that touch each other in
//! several locations, the demands on the right can exceed the available energy. Then all demands are lowered by a common share
//! `s`, to `(1-s)` times the values of the least-energy impact plus `s` times the demands, with the largest `s` (to 1e-6) at
//! which the energy does not grow. Such an `s` always exists, because the least-energy impact itself is feasible at `s = 0`.
//!
//! Clarabel's iterate is completed on its active rows, where the signs of the multipliers then prove optimality. A sequence
//! starts from the rows of its last solution and needs no iteration while these stay the same.
#![cfg_attr(
    feature = "qp",
    doc = r#"
```
use emoc::{Coefficients, Contact, Friction, Mode, Problem, Solver};
// Two strikers of 0.2 kg meet a structure with one mode that moves towards them.
let contact = Contact {
    friction: Friction::None,
    coefficients: Coefficients { ebar: 0.9, beta0: 0.2, beta1: 0.1 },
};
let problem = Problem {
    contacts: vec![contact; 2],
    inverse_inertia_per_kg: vec![5.0, 0.0, 0.0, 5.0],
    velocity_m_s: vec![-1.0, -0.5],
    modes: vec![Mode { rate: 0.1, shape: vec![1.0, 0.6] }],
};
let solution = Solver::new().solve(&problem)?;
assert!(solution.opening_m_s.iter().all(|g| *g > 0.0) && solution.energy_change_j < 0.0);
# Ok::<(), emoc::SolveError>(())
```
"#
)]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(feature = "qp")]
extern crate std;

#[cfg(feature = "qp")]
mod active_set;
mod closed_form;
#[cfg(feature = "qp")]
mod engine;
#[cfg(feature = "qp")]
mod general;
#[cfg(feature = "alloc")]
pub mod lcp;
#[cfg(feature = "alloc")]
mod matrix;
mod moving;
mod newton;
mod parameters;
#[cfg(feature = "alloc")]
mod problem;
#[cfg(feature = "qp")]
mod program;
mod real;
mod require;
#[cfg(feature = "qp")]
mod scaled;
#[cfg(feature = "scatter")]
mod scatter;
#[cfg(feature = "qp")]
mod single;

pub use closed_form::{Branch, CoefficientGradient, Coefficients, Rebound};
#[cfg(feature = "qp")]
pub use general::{SolveError, Solver};
pub use invalid_input::InvalidInput;
pub use moving::{MovingImpact, MovingRebound};
pub use newton::newton_restitution;
pub use parameters::{Impact, ParameterGradient, Parameters, Site};
#[cfg(feature = "alloc")]
pub use problem::{Contact, Friction, Mode, Outcome, Problem, Solution};
pub use real::Real;
#[cfg(feature = "scatter")]
pub use scatter::{Scatter, ScatteredLaw};
#[cfg(feature = "qp")]
pub use single::{SingleImpact, SingleSolution};

/// Runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
