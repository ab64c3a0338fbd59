//! Figs. 7.3 to 7.6: table and law along the beam, one panel per ball.

use super::Dataset;
use super::fits::BeamFit;
use crate::chapters::study::Study;
use serde::Serialize;
use tasks::Failure;
use vibroimpact::net;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::significant;

#[derive(Serialize)]
struct PointRow {
    beam: String,
    mass_kg: f64,
    location_m: f64,
    restitution: f64,
    restitution_of_the_law: f64,
    z: f64,
    s0: f64,
    s1: f64,
    branch: &'static str,
}

pub(super) fn run(study: &mut Study, data: &[Dataset], fits: &[BeamFit]) -> Result<(), Failure> {
    study.section("Law and tables, ball by ball (Figs. 7.3 to 7.6)");
    for ((data, found), number) in data.iter().zip(fits).zip(3..) {
        let law: Vec<f64> = found.fit.residuals.iter().zip(&data.rows).map(|(r, row)| r + row.e()).collect();
        let p: Vec<String> = found.fit.parameters.iter().map(|p| significant(*p, 3)).collect();
        let title = format!("Fig. 7.{number}  {}: μ₀ = {}, α₀ = {}, α₁ = {}", data.beam.title, p[0], p[1], p[2]);
        let model = Curve { values: &law, colour: Colour::Blue, marker: Some(Marker::Circle), label: "algebraic law" };
        let caption = "Red: the table, resolved in time. Blue: the law, with one set of parameters for the beam.";
        study.figure(&format!("fig-7-{number:02}"), &by_ball(&title, data, &[model]), caption)?;
        let rows: Vec<PointRow> = (0..data.rows.len())
            .map(|i| {
                let impact = &found.observations.impacts[i];
                let branch = net::law(&found.fit.parameters).rebound(impact).map_or("", |r| r.branch.as_str());
                PointRow {
                    beam: data.beam.name.clone(),
                    mass_kg: data.rows[i].mass_kg,
                    location_m: data.rows[i].location_m,
                    restitution: data.rows[i].e(),
                    restitution_of_the_law: law[i],
                    z: impact.z,
                    s0: impact.s0,
                    s1: impact.s1,
                    branch,
                }
            })
            .collect();
        study.csv(&format!("fig-7-{number:02}.csv"), &rows)?;
    }
    Ok(())
}

/// Values of a law for the rows of a data set with their style: markers, or a line if there is no marker.
pub(super) struct Curve<'a> {
    pub values: &'a [f64],
    pub colour: Colour,
    pub marker: Option<Marker>,
    pub label: &'a str,
}

/// Draws one panel per ball: restitution along the beam, with the table in red and the curves over it.
pub(super) fn by_ball(title: &str, data: &Dataset, curves: &[Curve]) -> Figure {
    let balls = &data.table.balls;
    // incomplete rows are filled so that the panels are aligned
    let per_row = [3, 4, 2].into_iter().find(|n| balls.len().is_multiple_of(*n)).unwrap_or(3);
    let panel = |(j, ball): (usize, &crate::chapters::impact::Ball)| {
        let of_ball: Vec<usize> = (0..data.rows.len()).filter(|&i| data.rows[i].mass_kg == ball.mass_kg).collect();
        let b: Vec<f64> = of_ball.iter().map(|&i| data.rows[i].location_m).collect();
        let table: Vec<f64> = of_ball.iter().map(|&i| data.rows[i].e()).collect();
        let bottom = j + per_row >= balls.len();
        let x = Axis::new("location b").unit("m").limits(-0.02, 1.02);
        let y = Axis::new("restitution e").limits(-0.04, 1.04);
        let x = if bottom { x } else { x.unlabelled() };
        let y = if j % per_row == 0 { y } else { y.unlabelled() };
        let mut panel = Panel::new(x, y).title(format!("m = {:.4} kg", ball.mass_kg)).height(105.0);
        let first = |series: Series, label: &str| if j == 0 { series.label(label) } else { series };
        panel =
            panel.with(first(Series::points(&b, &table, Marker::Plus).colour(Colour::Vermilion), "resolved in time"));
        for curve in curves {
            let values: Vec<f64> = of_ball.iter().map(|&i| curve.values[i]).collect();
            let series = match curve.marker {
                Some(marker) => Series::points(&b, &values, marker),
                None => Series::line(&b, &values),
            };
            panel = panel.with(first(series.colour(curve.colour), curve.label));
        }
        panel
    };
    let panels: Vec<Panel> = balls.iter().enumerate().map(panel).collect();
    panels.chunks(per_row).fold(Figure::new(title).width(960.0), |figure, row| figure.row(row.to_vec()))
}
