//! Chapter 2: a ball strikes an infinite beam. One number `S` determines all contacts.

mod first_contact;
mod invariance;
mod map;
mod methods;
mod motion;
mod parameters;
mod relatives;
mod sustained;

use super::study::Study;
use parameters::{Course, Motion, Parameters, Units, in_ratio, solved};
use tasks::Failure;

const INTRODUCTION: &str = "A body strikes an infinite Euler-Bernoulli beam; contact is Hertzian, and the beam answers \
an impulse P at once and for ever with the displacement P C √t. One number, S = C¹⁰ k² m⁸ v, decides everything: one \
contact and a rebound, some separations and then sustained contact, or sustained contact from the first touch. All \
quantities are dimensionless, in the thesis's units T of time, F of force and D of displacement (Eqs. 2.9 to 2.11), \
unless a name says otherwise; displacements are positive upwards, towards the striker. Figures carry the numbers of the \
thesis. Turning points and the critical S are given with an uncertainty: the scatter of three resolutions. \
`timings.csv`, `timings-methods.csv` and `timings-methods.svg` hold what was measured with a clock and therefore \
differs from run to run.";

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let parameters: Parameters = serde_json::from_str(include_str!("../../../../datasets/chapter2.json"))?;
    invariance::run(study, &parameters)?;
    motion::run(study, &parameters)?;
    first_contact::run(study, &parameters)?;
    sustained::run(study, &parameters)?;
    map::run(study, &parameters)?;
    relatives::run(study)?;
    methods::run(study)?;
    Ok(INTRODUCTION)
}
