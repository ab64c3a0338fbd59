//! Measured points that the user supplies, for example read off a published figure.

use super::Parameters;
use super::law::{Point, by_rod, observations};
use crate::chapters::study::Study;
use serde::{Deserialize, Serialize};
use std::path::Path;
use tasks::Failure;
use vibroimpact::report::significant;

/// Fewest points that determine three parameters.
const FEWEST: usize = 3;

#[derive(Deserialize)]
struct PointRow {
    length_m: f64,
    angle_deg: f64,
    restitution: f64,
}

/// Reads the points; other columns are ignored.
pub(super) fn read(path: &Path) -> Result<Vec<Point>, Failure> {
    let name = path.display();
    let mut table = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|fault| format!("cannot read {name}: {fault}"))?;
    let mut points = Vec::new();
    for (number, row) in table.deserialize::<PointRow>().enumerate() {
        let row = row.map_err(|fault| {
            format!("{name}: {fault}; the table must have the columns length_m, angle_deg and restitution, all with finite numbers")
        })?;
        let PointRow { length_m, angle_deg, restitution } = row;
        for (field, value, (low, high)) in [
            ("length_m", length_m, (0.01, 10.0)),
            ("angle_deg", angle_deg, (0.0, 90.0)),
            ("restitution", restitution, (-0.5, 1.5)),
        ] {
            if !(low..=high).contains(&value) {
                let place = format!("{name}, point {}", number + 1);
                return Err(format!(
                    "{place}: {field} = {value} is not allowed; it must be a number from {low} to {high}"
                )
                .into());
            }
        }
        points.push(Point { length_m, angle_deg, restitution });
    }
    if points.len() < FEWEST {
        return Err(format!("{name}: {} points are not allowed: at least {FEWEST}", points.len()).into());
    }
    Ok(points)
}

#[derive(Serialize)]
struct MeasuredRow {
    length_m: f64,
    angle_deg: f64,
    restitution: f64,
    restitution_of_the_law: f64,
}

/// Fits the law to the points and plots both.
pub(super) fn run(study: &mut Study, parameters: &Parameters, points: &[Point]) -> Result<(), Failure> {
    study.section("The points given");
    let found = observations(parameters, points, 0)?.fit()?;
    study.figure(
        "measured",
        &by_rod("Law and points given, one set of parameters:", "points given", parameters, points, &found)?,
        "Red: the points given. Blue: the law fitted to them, with one set of parameters for all rods.",
    )?;
    let p: Vec<String> = found.parameters.iter().map(|p| significant(*p, 4)).collect();
    study.text(&format!(
        "The fit to {} points has μ₀ = {}, α₀ = {}, α₁ = {}. The rms difference is {}, the largest {}.",
        found.report.count,
        p[0],
        p[1],
        p[2],
        significant(found.report.rms, 3),
        significant(found.report.max_abs, 3)
    ));
    let rows: Vec<MeasuredRow> = points
        .iter()
        .zip(&found.residuals)
        .map(|(&Point { length_m, angle_deg, restitution }, r)| MeasuredRow {
            length_m,
            angle_deg,
            restitution,
            restitution_of_the_law: restitution + r,
        })
        .collect();
    study.csv("measured.csv", &rows)
}
