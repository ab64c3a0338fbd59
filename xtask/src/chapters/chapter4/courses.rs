//! Motion and force of single impacts: Figs. 4.5, 4.10 and 4.11.

use super::{Case, Histories};
use crate::chapters::figures::{Course, slug};
use crate::chapters::impact::Setup;
use crate::chapters::study::Study;
use contact_models::Law;
use tasks::Failure;
use vibroimpact::plot::{Figure, Panel};
use vibroimpact_sim::modal::{History, Solution};

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    detailed(study, case)?;
    case.parameters.our_choice.histories.iter().try_for_each(|h| several_places(study, case, h))
}

type Recorded = (Solution, History<Law>);

/// Samples an impact until shortly after the last separation.
fn course((solution, history): &Recorded) -> Course {
    Course::new(history, (0.0, 1.08 * solution.end_s), 1500)
}

fn heading(location_m: f64, solution: &Solution) -> String {
    format!(
        "b = {location_m:.3} m: e = {:.3}, {} sub-impacts",
        solution.restitution.unwrap_or(f64::NAN),
        solution.sub_impacts.len()
    )
}

/// Fig. 4.5: displacement, velocity and force at four locations.
fn detailed(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Four impacts in detail (Fig. 4.5)");
    let p = &case.parameters.our_choice.detailed;
    let (beam, ball) = (case.beam(&p.beam)?, case.ball(p.diameter_m)?);
    let setups: Vec<Setup> = p.locations_m.iter().map(|&b| case.setup(beam, ball, b)).collect();
    let found = study.sweep(&setups, 1, Setup::record)?;
    let courses: Vec<Course> = found.iter().map(course).collect();
    let mut figure = Figure::new(format!("Fig. 4.5  {}, m = {:.4} kg", beam.title, ball.mass_kg));
    let letters = ["A", "B", "C", "D"];
    for pair in (0..found.len()).collect::<Vec<_>>().chunks(2) {
        let row = |panel: &dyn Fn(usize) -> Panel| pair.iter().map(|&k| panel(k)).collect::<Vec<_>>();
        let title = |k: usize| format!("{}  {}", letters[k % 4], heading(setups[k].location_m, &found[k].0));
        figure = figure
            .row(row(&|k| courses[k].displacements().title(title(k)).height(130.0)))
            .row(row(&|k| courses[k].velocities().height(130.0)))
            .row(row(&|k| courses[k].force().height(100.0)));
    }
    study.figure(
        "fig-4-05",
        &figure.width(860.0),
        "Displacements, velocities and contact force of each case, from top to bottom.",
    )?;
    for (course, letter) in courses.iter().zip(letters) {
        study.csv(&format!("fig-4-05-{letter}.csv"), &course.rows())?;
    }
    Ok(())
}

/// Figs. 4.10 and 4.11: displacements at several locations.
fn several_places(study: &mut Study, case: &Case, p: &Histories) -> Result<(), Failure> {
    let (beam, ball) = (case.beam(&p.beam)?, case.ball(p.diameter_m)?);
    study.section(&format!("{}: displacements at several locations (Fig. {})", beam.title, p.figure));
    let setups: Vec<Setup> = p.locations_m.iter().map(|&b| case.setup(beam, ball, b)).collect();
    let found = study.sweep(&setups, 1, Setup::record)?;
    let mut figure = Figure::new(format!("Fig. {}  {}, m = {:.3} kg", p.figure, beam.title, ball.mass_kg)).width(860.0);
    let mut panels = Vec::new();
    for (recorded, setup) in found.iter().zip(&setups) {
        let course = course(recorded);
        study.csv(&format!("fig-{}-b-{:.3}.csv", slug(&p.figure), setup.location_m), &course.rows())?;
        panels.push(course.displacements().title(heading(setup.location_m, &recorded.0)).height(140.0));
    }
    for pair in panels.chunks(2) {
        figure = figure.row(pair.to_vec());
    }
    study.figure(
        &format!("fig-{}", slug(&p.figure)),
        &figure,
        "Displacements of the ball and of the beam at the contact. The more compliant the location is, the further the \
         beam is displaced.",
    )
}
