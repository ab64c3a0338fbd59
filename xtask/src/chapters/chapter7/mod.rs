//! Chapter 7: the three parameters of the algebraic law, fitted to the tables of chapter 4.

pub(super) mod failure;
pub(super) mod fits;
pub(super) mod laws;
mod pictures;

use super::Failure;
use super::beam::Beam;
use super::chapter4::Case;
use super::chapter4::tables::{Table, compute};
use super::impact::Row;
use super::study::Study;
use emoc::{Impact, Site};
use std::time::Instant;
use vibroimpact::net::Observations;

const INTRODUCTION: &str = "The law of energy minimisation under outward constraints (chapter 6, closed form) with the \
three parameters μ₀, α₀, α₁ is fitted to the restitution tables of chapter 4, one set of parameters a beam. The law has \
50 modes, the tables have 40, as in the thesis; a second set of tables, 100 modes with remainder modes for all \
others, is what the same model settles to with more modes. The thesis does not print its \
tables, its parameters, or where its stepped beams have their step, so errors can be compared in kind only. After the \
thesis's own form the report asks where it fails and why, how one beam's parameters serve another, and sets a law with \
two parameters beside it that does better on every count.";

/// Modes in the law (thesis 7.2).
pub(super) const LAW_MODES: usize = 50;
/// Modes of the converged tables.
const SETTLED_MODES: usize = 100;

/// The table of one beam with the inputs of the laws for each impact.
pub(super) struct Dataset<'a> {
    pub beam: &'a Beam,
    table: &'a Table<'a>,
    /// The results that have a restitution, location by location.
    pub rows: Vec<&'a Row>,
}

impl<'a> Dataset<'a> {
    pub fn new(table: &'a Table<'a>) -> Dataset<'a> {
        Dataset { beam: table.beam, table, rows: table.all().filter(|row| row.restitution.is_some()).collect() }
    }

    /// Inputs of the law for each impact, with this many modes.
    pub fn observations(&self, modes: usize) -> Result<Observations, Failure> {
        let mut observations = Observations::default();
        for row in &self.rows {
            let structure = self.beam.structure(row.location_m, modes, 0.0, false)?;
            let phi: Vec<f64> = structure.modes.iter().map(|mode| mode.shape).collect();
            observations.impacts.push(Impact::new(row.mass_kg, &Site::new(&phi)?)?);
            observations.restitution.push(row.e());
        }
        Ok(observations)
    }
}

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
