//! Chapter 5: earlier impact laws, compared with the tables of chapter 4, and the examples of the chapter with rigid bodies.

mod bodies;
mod laws;
mod pictures;

use super::chapter4::Case;
use super::chapter4::tables::compute;
use super::chapter7::Dataset;
use super::study::Study;
use tasks::Failure;

const INTRODUCTION: &str = "The central argument of the thesis is that known algebraic impact laws, which do not \
represent sub-impacts, cannot give the net restitution of a ball on a vibrating beam, and that least energy under \
outward constraints can. Here each of these laws predicts the tables of chapter 4 (four beams, twelve balls, 25 \
locations, resolved in time with 40 modes). Laws with parameters are fitted to each beam. As in chapter 7 the laws \
have 50 modes, in Z = m Σφₖ². The small examples of the chapter follow: two bodies that touch at a point (5.2), the \
rod of Fig. 5.1, and the ball of Fig. 5.2.";

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let case = Case::load()?;
    study.section("The tables of chapter 4");
    let tables = compute(study, &case, case.parameters.modes, false)?;
    study.text("The tables are computed as in chapter 4, whose report has figures of them.");
    let data: Vec<Dataset> = tables.iter().map(Dataset::new).collect();
    let found = laws::run(study, &data)?;
    pictures::run(study, &data, &found)?;
    bodies::run(study)?;
    Ok(INTRODUCTION)
}
