//! The report of a sweep: varied fields, results, figures.

use std::io;

use super::definition::Sweep;
use super::folder::DISTRIBUTION;
use super::row::cell;
use super::tally::Tally;
use super::uncertain::{Sampling, Sequence};
use super::values::{AxisValues, Interval, Scale};
use crate::plot::Figure;
use crate::report::{Report, significant};

/// Largest number of values of a list that are printed individually.
const VALUES_TOLD: usize = 12;

pub(super) fn report(sweep: &Sweep, tally: &Tally, figures: Vec<(String, Figure, String)>) -> io::Result<Report> {
    let mut report = Report::new(sweep.description.as_deref().unwrap_or("A sweep"));
    report.heading("Results");
    report.text(&format!("```text\n{}```", tally.text()));
    for (name, figure, caption) in figures {
        report.figure(&name, &figure, &caption)?;
    }
    report.heading("Varied fields");
    report.table(&["field", "values", "number"], &varied(sweep));
    if let Some(random) = &sweep.random {
        report.text(&format!("Seed of the random draws: {}.", random.seed));
    }
    if let Some(uncertain) = &sweep.uncertain {
        let Sampling { seed, sequence, replicates, .. } = uncertain.sampling;
        let from = match sequence {
            Sequence::Sobol => "Draws are scrambled Sobol' points",
            Sequence::Random => "Draws are random",
        };
        report
            .text(&format!("{from}, in {replicates} independent replicates; seed {seed}. Figures: `{DISTRIBUTION}`."));
    }
    report.heading("The scene");
    let scene = sweep.canonical().get("scene").map_or_else(String::new, |scene| format!("{scene:#}"));
    report.text(&format!("```json\n{scene}\n```"));
    report.text(
        "Varied fields have the values above in place of those that stand here. All results: `results.csv`, \
                 `results.parquet`.",
    );
    Ok(report)
}

fn varied(sweep: &Sweep) -> Vec<Vec<String>> {
    let interval = |Interval { from, to, scale, whole_numbers }: &Interval| {
        let scale = if *scale == Scale::Log { ", logarithmic" } else { "" };
        let whole = if *whole_numbers { ", whole numbers" } else { "" };
        format!("{} to {}{scale}{whole}", significant(*from, 6), significant(*to, 6))
    };
    let axes = sweep.axes.iter().map(|axis| {
        let values = match &axis.values {
            AxisValues::Range(range, _) => interval(range),
            AxisValues::List(values) => {
                let told: Vec<String> = values.iter().take(VALUES_TOLD).map(cell).collect();
                told.join(", ") + if values.len() > VALUES_TOLD { ", ..." } else { "" }
            }
        };
        vec![format!("`{}`", axis.field), values, axis.count().to_string()]
    });
    let drawn = sweep.random.iter().flat_map(|random| {
        random.fields.iter().map(|(field, range)| {
            vec![format!("`{field}`"), format!("{}, at random", interval(range)), random.draws.to_string()]
        })
    });
    let uncertain = sweep.uncertain.iter().flat_map(|uncertain| {
        uncertain
            .fields
            .iter()
            .map(|(field, distribution)| vec![format!("`{field}`"), distribution.text(), sweep.draws().to_string()])
    });
    axes.chain(drawn).chain(uncertain).collect()
}
