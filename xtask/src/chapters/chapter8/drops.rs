//! Drops of rods, resolved in time.

use super::Parameters;
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use serde::Serialize;
use tasks::Failure;
use vibroimpact::plot::{Axis, Figure, Marker, Panel, Series};
use vibroimpact_sim::modal::{Settings, Solver};

/// Our reading of "nearly vertical": within a ninth of the right angle.
const NEARLY_VERTICAL: f64 = 80.0;

/// One drop.
#[derive(Debug, Clone, Serialize)]
pub(super) struct DropRow {
    pub length_m: f64,
    pub angle_deg: f64,
    pub restitution: Option<f64>,
    pub restitution_uncertainty: Option<f64>,
    pub micro_collisions: usize,
    /// Restitution after the first micro-collision alone.
    pub restitution_of_the_first: f64,
    pub last_separation_s: f64,
    pub outcome: &'static str,
}

/// Solves a drop.
pub(super) fn solve(parameters: &Parameters, length_m: f64, angle_deg: f64) -> Result<DropRow, Failure> {
    let (rod, speed_m_s) = (parameters.rod(length_m, angle_deg), parameters.our_choice.speed_m_s);
    let drop = rod.drop(speed_m_s)?;
    let settings = Settings { tolerance: 1e-7, ..Settings::default() };
    let solution = Solver::new(&drop.structure)?.solve(&drop.surface, &drop.law, Some(&drop.start), &settings)?;
    Ok(DropRow {
        length_m,
        angle_deg,
        restitution: solution.restitution,
        restitution_uncertainty: solution.restitution_uncertainty,
        micro_collisions: solution.sub_impacts.len(),
        restitution_of_the_first: solution
            .sub_impacts
            .first()
            .map_or(f64::NAN, |first| first.impulse_n_s / (rod.rigid_body_mass_kg() * speed_m_s) - 1.0),
        last_separation_s: solution.end_s,
        outcome: solution.outcome.as_str(),
    })
}

/// Solves the drops of all rods at all angles, ordered by rod.
pub(super) fn run(study: &mut Study, parameters: &Parameters) -> Result<Vec<DropRow>, Failure> {
    study.section("Drops resolved in time");
    let steps = parameters.our_choice.angles.max(2) - 1;
    let all: Vec<f64> = (0..=steps).map(|i| 90.0 * i as f64 / steps as f64).collect();
    let angles = study.thin(&all, 7);
    let cases: Vec<(f64, f64)> =
        parameters.lengths_m.iter().flat_map(|&length| angles.iter().map(move |&angle| (length, angle))).collect();
    let rows = study.sweep(&cases, 1, |&(length, angle)| solve(parameters, length, angle))?;
    study.csv("drops.csv", &rows)?;

    let x = Axis::new("inclination θ").unit("°").limits(-2.0, 92.0);
    let mut above = Panel::new(x.clone().unlabelled(), Axis::new("restitution e")).height(240.0);
    let mut below = Panel::new(x, Axis::new("micro-collisions").integers()).height(150.0);
    let markers = [Marker::Circle, Marker::Cross, Marker::Square, Marker::Triangle, Marker::Plus];
    for (length, marker) in parameters.lengths_m.iter().zip(markers) {
        let of_rod: Vec<&DropRow> = rows.iter().filter(|row| row.length_m == *length).collect();
        let angle: Vec<f64> = of_rod.iter().map(|row| row.angle_deg).collect();
        let e: Vec<f64> = of_rod.iter().map(|row| row.restitution.unwrap_or(f64::NAN)).collect();
        let count: Vec<f64> = of_rod.iter().map(|row| row.micro_collisions as f64).collect();
        above = above.with(Series::line_points(&angle, &e, marker).label(format!("{:.0} mm", 1e3 * length)));
        below = below.with(Series::line_points(&angle, &count, marker));
    }
    let steep = |row: &&DropRow| row.angle_deg == 90.0;
    let least = rows.iter().filter(steep).map(|row| row.restitution.unwrap_or(f64::NAN)).fold(f64::INFINITY, f64::min);
    study.state(Statement::trend(
        "least restitution of the upright rods with their own Hertz contact",
        "8.2.1, 8.2.2",
        "remarkable behavior: e = 1 for one rod and a rigid surface; in reality still high",
        (0.95, 1.0),
        "the one-dimensional theory has no local compliance; ours may take a twentieth",
        least,
    ));
    let most = rows.iter().filter(|row| row.angle_deg >= NEARLY_VERTICAL).map(|row| row.micro_collisions);
    study.state(
        Statement::trend(
            "most micro-collisions of a rod from 80° on",
            "8.2.1, A.5",
            "for nearly vertical impacts, there occurs a single contact event",
            (1.0, 1.0),
            "as stated; from where on \"nearly\" holds is our reading",
            most.max().unwrap_or(0) as f64,
        )
        .note("The statement of the thesis is about the measured rods; ours are resolved."),
    );
    let figure = Figure::new("Rods dropped on an immovable surface, resolved in time").row([above]).row([below]);
    study.figure(
        "drops",
        &figure,
        "Restitution of the rigid-body motion of the contact point (top) and number of micro-collisions within the \
         impact (bottom).",
    )?;
    Ok(rows)
}
