//! Impact on a structure described by its modes (thesis chapters 3 and 4).
//!
//! # The problem
//! A striker of mass `m` meets a structure at one point. With mass-normalised modes,
//!
//! ```text
//! a_k'' + 2 zeta_k omega_k a_k' + omega_k^2 a_k = -phi_k F        k = 1 .. N        (thesis 3.7, 3.10)
//! m z'' = F                                                                         (thesis 3.8)
//! xi = sum phi_k a_k - z - c F,      F = law(xi, xi')                               (thesis 3.11)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `a_k`, `phi_k` | modal amplitude; mass-normalised shape at the contact | m kg^1/2; kg^-1/2 |
//! | `omega_k`, `zeta_k` | undamped circular frequency, damping ratio | rad/s, 1 |
//! | `z`, `m` | displacement (positive away from the structure) and mass of the striker | m, kg |
//! | `xi`, `F` | compression and force of the contact | m, N |
//!
//! # The method
//! An impact is the smallest assembly ([`crate::assembly`] describes the method): two bodies, of which the striker is one rigid
//! mode, and one contact (`posed.rs`). The modes are propagated exactly. The only unknown is the force, a polynomial on each
//! panel. A bound on the motion gives a time before which no contact can occur, and the impact ends when none can occur any
//! more. The tables that depend on the structure alone are cached for further strikers, speeds and laws, and threads share them.
//!
//! The uncertainty of the restitution is estimated from two coarser solutions: one with 32 times the tolerance, and one with
//! eight times, whose steps all lie between those of the others (see `time_unit.rs`). It is two and a half times the larger
//! difference from them. If that exceeds the tolerance, the impact amplifies errors (undamped ones with many modes by 1e5 and
//! more), and two solutions may agree by accident. A third solution is then computed, and the largest difference counts five
//! times.

mod differentiate;
mod history;
mod posed;
pub(crate) mod problem;
mod solution;
mod solve;
mod time_unit;

pub use differentiate::{
    Derivative, Derivatives, Differentiated, NoDerivative, Parameter, Posing, Stencil, SubImpactDerivatives,
};
pub use history::{EnergyLedger, History, Sample};
pub use problem::{Mode, Settings, Start, Striker, Structure};
pub use solution::{Counts, Outcome, Solution, SubImpact};
pub use solve::Solver;
