//! Chapter 4: four beams, twelve balls, twenty-five locations.

mod case;
mod courses;
mod finite_elements;
mod settled;
mod studies;
pub(super) mod tables;
pub(super) mod trends;

use super::statement::Statement;
use super::study::Study;
use case::Histories;
pub(super) use case::{Case, EnsembleChoice};
use tasks::Failure;

const INTRODUCTION: &str = "Steel balls strike four steel beams of 1 m length with 40 modes and Hertz contact. Every \
mode has 2 % of critical damping. The tables `restitution-*.csv` have the net restitution of every ball at every \
location; chapter 7 fits its model to them. The thesis states neither the position of the steps, nor the thickness of \
the slim parts, nor the list of balls. Here the step is at half the length, the slim part has half the thickness, and \
the balls have 9 to 53 mm in steps of 4 mm, so that the list contains every mass that the chapter states. These are \
our choices (`datasets/chapter4.json`), so the figures of the stepped beams can only be compared qualitatively.";

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let case = Case::load()?;
    numbers(study, &case)?;
    studies::run(study, &case)?;
    courses::run(study, &case)?;
    let tables = tables::run(study, &case)?;
    trends::tell(study, &tables);
    settled::run(study, &case, &tables)?;
    finite_elements::run(study, &case)?;
    Ok(INTRODUCTION)
}

/// The numbers of section 4.2.
fn numbers(study: &mut Study, case: &Case) -> Result<(), Failure> {
    let (small, middle, large) = (case.ball(0.025)?, case.ball(0.033)?, case.ball(0.053)?);
    study.state(Statement::printed("mass of the 25 mm ball (kg)", "4.2", "0.0638", small.mass_kg));
    let stiffness = small.stiffness_n_m1_5;
    study.state(Statement::printed("Hertz stiffness, 25 mm ball (N/m^1.5)", "4.2", "1.638e10", stiffness));
    for (diameter, source, printed, ball) in [("33", "Fig. 4.3", 0.147, middle), ("53", "Fig. 4.10", 0.608, large)] {
        study.state(Statement::self_check(
            format!("mass of the {diameter} mm ball (kg)"),
            [source, &printed.to_string(), "half a unit of the last digit; the diameter is ours, found from the mass"],
            (printed - 5e-4, printed + 5e-4),
            ball.mass_kg,
        ));
    }
    let pinned = case.beam("pinned-pinned")?;
    let omega = pinned.omega_rad_s();
    study.state(Statement::identity(
        "40th over first natural frequency, pinned-pinned",
        ["4.2", "1600", "40², exactly"],
        (1600.0 - 1e-6, 1600.0 + 1e-6),
        omega[39] / omega[0],
    ));
    study.state(Statement::identity(
        "smallest location other than 0 (m)",
        ["4.2", "0.04166…", "1/24, as printed"],
        (0.04166, 0.04167),
        case.places(pinned)[1],
    ));
    Ok(())
}
