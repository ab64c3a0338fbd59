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

const INTRODUCTION: &str = "A body strikes an infinite Euler-Bernoulli beam with Hertz contact. The displacement of \
the beam at the contact after an impulse P is P C √t. The single parameter S = C¹⁰ k² m⁸ v determines the outcome: one \
contact and a rebound, some separations and then sustained contact, or sustained contact from the first touch. All \
quantities are dimensionless, in the thesis's units T of time, F of force and D of displacement (Eqs. 2.9 to 2.11), \
unless a name states otherwise. Displacements are positive upwards, towards the striker. The figures have the numbers \
of the thesis. The uncertainty of the turning points and of the critical S is the scatter over three resolutions. \
`timings.csv`, `timings-methods.csv` and `timings-methods.svg` contain measured times, which differ from run to run.";

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
