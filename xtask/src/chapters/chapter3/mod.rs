//! Chapter 3: one beam, one ball, and the conditions under which the restitution converges as modes are added.

mod case;
mod convergence;
mod dissipation;
mod luck;
mod motion;
mod numbers;
mod residual;
pub(super) mod scatter;

use super::study::Study;
pub(super) use case::Case;
use tasks::Failure;

const INTRODUCTION: &str = "A steel ball strikes a pinned-pinned steel beam. The contact is Hertzian, without or with \
a little dissipation. The beam is undamped, or every mode has 2 % of critical damping. Every sub-impact is resolved. \
The chapter asks how the net restitution depends on the number N of retained modes. The figures have the numbers of \
the thesis. Undamped impacts with many modes amplify any disturbance by factors of 10⁵ and more; the column \
`restitution_uncertainty` of the tables states how many digits of each result can be trusted. *Scatter* is the \
standard deviation of the restitution over the numbers of modes.";

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let case = Case::load()?;
    numbers::run(study, &case)?;
    dissipation::run(study, &case)?;
    motion::run(study, &case)?;
    convergence::run(study, &case)?;
    luck::run(study, &case)?;
    residual::run(study, &case)?;
    Ok(INTRODUCTION)
}
