//! Chapter 8: tilted rods dropped on an immovable surface.

mod drops;
mod law;
mod measured;
mod measurements;
mod parameters;
mod two_rods;
mod upright;

use super::study::Study;
use law::Point;
use parameters::Parameters;
use std::path::Path;
use tasks::{BadInput, Failure};

const INTRODUCTION: &str = "Steel rods with hemispherical ends fall on an immovable surface and meet it with one end, \
at inclinations from lying (0°) to upright (90°). **The points of the experiment (Stoianovici and Hurmuzlu 1996) are \
not printed in the thesis, so nothing here is compared with them.** Our own drops, resolved in time, take their place. \
They include rigid translation and rotation, bending and axial modes, and Hertz contact of the end. They neglect \
friction, gravity during the contact, and contact of the other end, which matters for rods that fall almost flat. The \
algebraic law is fitted to these drops. `cargo xtask reproduce-chapter 8 --data points.csv` (columns length_m, \
angle_deg, restitution) fits and plots points that were read off the published figure.";

/// Reads measured points from the user's file.
pub(super) fn points(path: &Path) -> Result<Vec<Point>, Failure> {
    measured::read(path).map_err(|fault| BadInput(fault.to_string()).into())
}

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(study: &mut Study, points: Option<&[Point]>) -> Result<&'static str, Failure> {
    let parameters = Parameters::load()?;
    let drops = drops::run(study, &parameters)?;
    upright::run(study, &parameters)?;
    two_rods::run(study, &parameters)?;
    law::run(study, &parameters, &drops)?;
    measurements::run(study, &parameters, &drops)?;
    if let Some(points) = points {
        measured::run(study, &parameters, points)?;
    }
    Ok(INTRODUCTION)
}
