//! How significant is the agreement of three extremes of undamped impacts? The same extremes for other contact stiffnesses.

use super::Case;
use super::scatter::{fingerprint, gives_the_three_numbers};
use crate::chapters::impact::{Row, Setup};
use crate::chapters::study::Study;
use contact_models::{Hertz, Law};
use serde::Serialize;
use tasks::Failure;
use vibroimpact::report::significant;

#[derive(Serialize)]
struct ScanRow {
    stiffness_over_printed: f64,
    smallest_restitution: f64,
    largest_restitution: f64,
    gives_the_three_numbers: bool,
}

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("The extremes for other contact stiffnesses");
    let scan = &case.parameters.our_choice.stiffness_scan;
    let steps = scan.values.max(2) - 1;
    let all: Vec<f64> = (0..=steps).map(|i| scan.from + (scan.to - scan.from) * i as f64 / steps as f64).collect();
    let factors = study.thin(&all, 5);
    let counts: Vec<usize> = (30..=40).collect();
    let found = study.sweep(&factors, counts.len(), |factor| {
        let law = Law::Hertz(Hertz { stiffness_n_m1_5: factor * case.ball.stiffness_n_m1_5 });
        let setup = Setup { law, ..case.setup(case.golden_m(), 0) };
        counts.iter().map(|&modes| Setup { modes, ..setup }.solve()).collect::<Result<Vec<Row>, Failure>>()
    })?;
    let rows: Vec<ScanRow> = factors
        .iter()
        .zip(&found)
        .map(|(&stiffness_over_printed, rows)| {
            let (smallest_restitution, largest_restitution) = fingerprint(rows);
            let gives_the_three_numbers = gives_the_three_numbers((smallest_restitution, largest_restitution));
            ScanRow { stiffness_over_printed, smallest_restitution, largest_restitution, gives_the_three_numbers }
        })
        .collect();
    study.csv("stiffness-scan.csv", &rows)?;
    let hits = rows.iter().filter(|row| row.gives_the_three_numbers).count();
    study.text(&format!(
        "Undamped impacts amplify every disturbance, so that the extremes of eleven of them might agree by chance. Of \
         {} contact stiffnesses from {} to {} times the printed one, {hits} ({} %) give \"about 0.1\", \"about 0.6\" \
         and \"a factor of 6\" for 30 to 40 modes. The printed one is among them, which is evidence that our model is \
         that of the thesis.",
        rows.len(),
        significant(scan.from, 3),
        significant(scan.to, 3),
        significant(100.0 * hits as f64 / rows.len() as f64, 2)
    ));
    Ok(())
}
