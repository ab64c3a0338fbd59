//! Differences between the tables with 40 modes and the converged restitution.

use super::Case;
use super::tables::{Table, compute};
use crate::chapters::impact::Row;
use crate::chapters::study::Study;
use serde::Serialize;
use tasks::Failure;
use vibroimpact::plot::{Axis, Figure};
use vibroimpact::report::significant;

/// One location and ball in four models.
#[derive(Serialize)]
struct SettledRow {
    beam: String,
    mass_kg: f64,
    diameter_m: f64,
    location_m: f64,
    restitution_truncated: Option<f64>,
    restitution_with_residual: Option<f64>,
    restitution_coarser_reference: Option<f64>,
    restitution_reference: Option<f64>,
}

pub(super) fn run(study: &mut Study, case: &Case, tables: &[Table]) -> Result<(), Failure> {
    let [coarse, fine] = case.parameters.our_choice.settled_modes;
    let modes = case.parameters.modes;
    study.section("How far N = 40 is from the converged restitution");
    let same_modes = compute(study, case, modes, true)?;
    let coarser = compute(study, case, coarse, true)?;
    let reference = compute(study, case, fine, true)?;
    study.text(&format!(
        "The reference has {fine} modes with remainder modes for all others. Its difference from the same model with \
         {coarse} modes shows how far it has converged. The table has the differences of the restitution over all \
         locations and balls."
    ));

    let (mut rows, mut panels) = (Vec::new(), Vec::new());
    for k in 0..tables.len() {
        let name = &tables[k].beam.title;
        let models = [
            (format!("N = {modes}, as in the thesis"), &tables[k]),
            (format!("N = {modes} with remainder modes"), &same_modes[k]),
            (format!("N = {coarse} with remainder modes"), &coarser[k]),
        ];
        for (model, table) in models {
            rows.push(summary(name, &model, &distances(table, &reference[k])));
        }
        // differences below the uncertainty of the reference are not shown in the map
        let map = distances(&tables[k], &reference[k]).into_iter().map(|d| d.max(1e-5)).collect::<Vec<_>>();
        let by_place: Vec<&[f64]> = map.chunks(tables[k].balls.len()).collect();
        let by_ball = (0..tables[k].balls.len()).map(|j| by_place.iter().map(|place| place[j]).collect()).collect();
        let value = Axis::new("|difference of e|").log().limits(1e-5, 1.0);
        panels.push(tables[k].map(by_ball, value).title(name.clone()));

        let all = [&tables[k], &same_modes[k], &coarser[k], &reference[k]].map(|t| t.all().collect::<Vec<&Row>>());
        let table: Vec<SettledRow> = (0..all[0].len()).map(|i| settled_row([0, 1, 2, 3].map(|m| all[m][i]))).collect();
        study.csv(&format!("settled-{}.csv", tables[k].beam.name), &table)?;
    }
    study.table(&["beam", "model", "median", "90 % below", "largest", "share above 0.03"], &rows);
    let mut figure = Figure::new("Difference between N = 40, truncated, and the converged restitution").width(960.0);
    for pair in panels.chunks(2) {
        figure = figure.row(pair.to_vec());
    }
    study.figure("settled", &figure, "Absolute value of the difference for each location and ball.")
}

fn settled_row([truncated, residual, coarser, reference]: [&Row; 4]) -> SettledRow {
    SettledRow {
        beam: truncated.beam.clone(),
        mass_kg: truncated.mass_kg,
        diameter_m: truncated.diameter_m,
        location_m: truncated.location_m,
        restitution_truncated: truncated.restitution,
        restitution_with_residual: residual.restitution,
        restitution_coarser_reference: coarser.restitution,
        restitution_reference: reference.restitution,
    }
}

/// Absolute differences of the restitution, location by location.
fn distances(table: &Table, reference: &Table) -> Vec<f64> {
    table.all().zip(reference.all()).map(|(a, b)| (a.e() - b.e()).abs()).collect()
}

fn summary(beam: &str, model: &str, distances: &[f64]) -> Vec<String> {
    let mut sorted = distances.to_vec();
    sorted.sort_by(f64::total_cmp);
    let quantile = |q: f64| sorted[((sorted.len() - 1) as f64 * q).round() as usize];
    let above = distances.iter().filter(|d| **d > 0.03).count();
    let share = format!("{:.1} %", 100.0 * above as f64 / distances.len() as f64);
    let numbers = [0.5, 0.9, 1.0].map(|q| significant(quantile(q), 2));
    [vec![beam.to_string(), model.to_string()], numbers.to_vec(), vec![share]].concat()
}
