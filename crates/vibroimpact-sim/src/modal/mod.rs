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
//! | `c` | residual static compliance of the modes left out; 0 in the thesis | m/N |
//! | `g` | overlap of the undeformed surfaces, `sum phi_k a_k - z` | m |
//! | `mu` | inverse mass of striker and rigid-body modes at the contact, `1/m + sum_rigid phi_k^2` | 1/kg |
//!
//! # The method
//! The modes are linear and all driven by one scalar `F(t)`. On a step of a contact, `F` is a polynomial through
//! Gauss nodes. Its effect on every mode is exact: `int P_n(2s-1) e^{z(1-s)} ds = (-1)^n e^{z/2} i_n(z/2)`, with
//! `i_n` the modified spherical Bessel function, so that no frequency is too high for the step. The only unknowns are
//! the nodal forces, which the law fixes; Newton's method finds them. Steps come from a ladder `2^-j` s whose
//! propagators and responses are tabulated, so a step costs `O(N)` multiplications and no transcendental function.
//! A branch of the law ends (separation, reversal, yield) on its boundary, landed on by a step of unknown length.
//! In free flight nothing is integrated: a bound on the gap's motion gives a time before which no contact can come
//! (see `flight.rs`), and a bound that none will come at all ends the impact.
//!
//! The uncertainty of the restitution rests on coarser solutions: one of 32 times the tolerance, and one of eight times,
//! whose steps all lie between those of the others (see `time_unit.rs`). It is two and a half times the larger difference to them.
//! Where that is more than the tolerance the impact amplifies errors, undamped ones with many modes by 1e5 and more, and two
//! solutions may agree by accident: a third is asked, and the largest difference counts five times.

mod history;
mod posed;
pub(crate) mod problem;
mod solution;
mod solve;
mod time_unit;

pub use history::{EnergyLedger, History, Sample};
pub use problem::{Mode, Settings, Start, Striker, Structure};
pub use solution::{Counts, Outcome, Solution, SubImpact};
pub use solve::Solver;
