//! Figures that compare laws with tables.

use super::laws::{Found, LAWS};
use crate::chapters::chapter7::Dataset;
use crate::chapters::impact::Row;
use crate::chapters::study::Study;
use serde::Serialize;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};

/// One law for one impact.
#[derive(Serialize)]
struct PointRow {
    law: &'static str,
    beam: String,
    mass_kg: f64,
    location_m: f64,
    restitution: f64,
    restitution_of_the_law: f64,
}

/// Draws every fifth value, since more points would overlap. Each location has twelve balls, and five and twelve have no
/// common factor, so every ball is drawn.
fn thinned(values: &[f64]) -> Vec<f64> {
    values.iter().copied().step_by(5).collect()
}

pub(super) fn run(study: &mut Study, data: &[Dataset], found: &[Found]) -> Result<(), Failure> {
    let tables: Vec<&Row> = data.iter().flat_map(|data| data.rows.iter().copied()).collect();
    let resolved: Vec<f64> = tables.iter().map(|row| row.e()).collect();
    let mut panels = Vec::new();
    let mut rows = Vec::new();
    for (law, found) in LAWS.iter().zip(found) {
        let predicted = found.by_beam.concat();
        let y = Axis::new("e of the law").limits(-1.05, 1.05);
        let panel = Panel::new(Axis::new("e resolved in time").limits(-0.03, 1.03), y)
            .title(law.name)
            .height(150.0)
            .with(Series::line(&[0.0, 1.0], &[0.0, 1.0]).colour(Colour::Grey))
            .with(Series::points(&thinned(&resolved), &thinned(&predicted), Marker::Dot).colour(Colour::Blue));
        panels.push(panel);
        rows.extend(tables.iter().zip(predicted).map(|(row, restitution_of_the_law)| PointRow {
            law: law.name,
            beam: row.beam.clone(),
            mass_kg: row.mass_kg,
            location_m: row.location_m,
            restitution: row.e(),
            restitution_of_the_law,
        }));
    }
    study.csv("predictions.csv", &rows)?;
    let figure = panels
        .chunks(3)
        .fold(Figure::new("Nine laws against the tables of chapter 4").width(960.0), |f, row| f.row(row.to_vec()));
    study.main_figure(
        "laws",
        &figure,
        "The points are every fifth impact of the four tables. On the grey line law and table are equal. A negative \
         restitution means that the ball would move on into the beam.",
    )
}
