//! The codes in Rust, each with its settings, from the loosest to the tightest.

mod diffsol;
mod dop853;
mod net;
mod own;
mod penalty;
mod phases;
mod sweep;

use crate::outcome::Outcome;
use crate::problem::Problem;
use work_precision::measure::Effort;

pub use diffsol::solve as diffsol;
pub use dop853::solve as dop853;
pub use own::assembly as own_assembly;
pub use sweep::Answer;

/// Every run of every code on a problem.
pub fn run_all(problem: &Problem, effort: &Effort) -> Vec<Outcome> {
    let all = [own::runs, net::runs, dop853::runs, diffsol::runs, penalty::runs];
    all.into_iter().flat_map(|runs| runs(problem, effort)).collect()
}
