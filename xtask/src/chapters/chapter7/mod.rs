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
three parameters μ₀, α₀, α₁ is fitted to the restitution tables of chapter 4, with one set of parameters for each \
beam. The law has 50 modes and the tables have 40, as in the thesis. A second set of tables, with 100 modes and \
remainder modes for all others, has the converged restitutions of the same model. The thesis states neither its \
tables, nor its parameters, nor the position of the steps, so errors can only be compared qualitatively. The report \
then shows where the form of the thesis fails and why, and how well the parameters of one beam predict another. It \
compares this form with a law of two parameters that is more accurate in every respect.";

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let case = Case::load()?;
    study.section("The tables");
    let start = Instant::now();
    let truncated = compute(study, &case, case.parameters.modes, false)?;
    let seconds = start.elapsed().as_secs_f64();
    let settled = compute(study, &case, SETTLED_MODES, true)?;
    study.text("The tables are computed as in chapter 4, whose report has figures of them.");
    let [truncated, settled]: [Vec<Dataset>; 2] =
        [&truncated, &settled].map(|tables| tables.iter().map(Dataset::new).collect());

    let fits = fits::run(study, &truncated, &settled, seconds)?;
    pictures::run(study, &truncated, &fits)?;
    fits::against_modes(study, &truncated)?;
    failure::run(study, &truncated, &fits)?;
    laws::run(study, [("N = 40", &truncated), ("converged", &settled)])?;
    Ok(INTRODUCTION)
}
