//! Impact on a structure described by its modes (thesis chapters 3 and 4).
//!
//! # The problem
//! A striker of mass `m` meets a structure at one point. With mass-normalised modes,
//!
//! ```text
//! a_k'' + 2 zeta_k omega_k a_k' + omega_k^2 a_k = -phi_k F        k = 1 .. N        (thesis 3.7, 3.10)
//! m z'' = F                                                                         (thesis 3.8)
//! xi = sum phi_k a_k - z,      F = law(xi, xi')                                     (thesis 3.11)
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
//! An impact is the smallest assembly ([`crate::assembly`] describes the method): two bodies, of which the striker is
//! one rigid mode, and one contact (`posed.rs`). The modes are propagated exactly. The only unknown is the force: on each panel a
//! polynomial, times `t^(3/2)` where it begins or ends so. A bound on the motion gives a time before which no contact can occur,
//! and the impact ends when none can occur any more. The tables that depend on the structure alone are cached for further strikers,
//! speeds and laws, and threads share them. A mode that the contact does not excite, at its node, is left out unless it moves
//! before the impact.
//!
//! The uncertainty of the restitution is estimated from two coarser solutions, with 16 and with 8 times the tolerance. Each has
//! steps of its own, so that no two of the three solutions share one (`panel/dyadic.rs`). The restitutions
//! are compared, and also those that would result if the impact ended in each flight between two contacts: two solutions may agree
//! in one number by accident, but hardly in all. The uncertainty is three times the largest difference, and 0.0025 of the
//! tolerance more for each contact. If that difference
//! exceeds the tolerance, the impact amplifies errors (undamped ones with many modes by 1e5 and more); if the numbers of contacts
//! differ, it is close to a graze, where errors do not grow in proportion. A further solution, with 8 times the tolerance in the
//! steps of the first, is then computed, and its difference counts twice.

mod differentiate;
mod fall;
mod history;
mod posed;
pub(crate) mod problem;
mod pulse;
mod recording;
mod restitutions;
mod solution;
mod solve;

pub use differentiate::{
    Derivative, Derivatives, Differentiated, NearMiss, NoDerivative, Parameter, Posing, Stencil, SubImpactDerivatives,
};
pub use history::{EnergyLedger, History, Sample};
pub use problem::{Mode, Settings, Start, Striker, Structure};
pub use pulse::Pulse;
pub use recording::Recording;
pub use solution::{Counts, Outcome, Solution, SubImpact};
pub use solve::Solver;
