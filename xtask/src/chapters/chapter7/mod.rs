//! Chapter 7: the three parameters of the algebraic law, fitted to the tables of chapter 4.

mod dataset;
pub(super) mod failure;
pub(super) mod fits;
pub(super) mod laws;
mod pictures;

use super::chapter4::Case;
use super::chapter4::tables::compute;
use super::study::Study;
use dataset::SETTLED_MODES;
pub(super) use dataset::{Dataset, LAW_MODES};
use std::time::Instant;
use tasks::Failure;

const INTRODUCTION: &str = "The law of energy minimisation under outward constraints (chapter 6, closed form) with the \
three parameters μ₀, α₀, α₁ is fitted to the restitution tables of chapter 4, one set of parameters a beam. The law has \
50 modes, the tables have 40, as in the thesis; a second set of tables, 100 modes with remainder modes for all \
others, is what the same model settles to with more modes. The thesis does not print its \
tables, its parameters, or where its stepped beams have their step, so errors can be compared in kind only. After the \
thesis's own form the report asks where it fails and why, how one beam's parameters serve another, and sets a law with \
two parameters beside it that does better on every count.";

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let case = Case::load()?;
    study.section("The tables");
    let start = Instant::now();
    let truncated = compute(study, &case, case.parameters.modes, false)?;
    let seconds = start.elapsed().as_secs_f64();
    let settled = compute(study, &case, SETTLED_MODES, true)?;
    study.text("Computed as in chapter 4; see its report for pictures of them.");
    let [truncated, settled]: [Vec<Dataset>; 2] =
        [&truncated, &settled].map(|tables| tables.iter().map(Dataset::new).collect());

    let fits = fits::run(study, &truncated, &settled, seconds)?;
    pictures::run(study, &truncated, &fits)?;
    fits::against_modes(study, &truncated)?;
    failure::run(study, &truncated, &fits)?;
    laws::run(study, [("N = 40", &truncated), ("converged", &settled)])?;
    Ok(INTRODUCTION)
}
