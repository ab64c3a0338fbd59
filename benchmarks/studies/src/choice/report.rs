//! Report of the study of the automatic choice: text, tables and a figure.

use super::row::{Row, TOLERANCES};
use tasks::{Failure, Study};
use vibroimpact::model::Model;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::{Comparison, significant};

/// Largest number of rows that are listed individually.
const LISTED: usize = 40;

fn geometric(values: &[f64]) -> f64 {
    (values.iter().map(|v| v.ln()).sum::<f64>() / values.len() as f64).exp()
}

/// Coverage and cost of some rows.
struct Tally {
    rows: usize,
    counted: usize,
    settled: usize,
    /// Of the settled ones.
    within: usize,
    stated: usize,
    /// Of those with a stated uncertainty.
    covered: usize,
    worst: f64,
    /// Mode-steps relative to those of the cheapest model, for rows with integrated modes.
    costs: Vec<f64>,
}

impl Tally {
    fn of<'a>(rows: impl Iterator<Item = &'a Row>) -> Tally {
        let rows: Vec<&Row> = rows.collect();
        let counted: Vec<&Row> = rows.iter().copied().filter(|row| row.counts()).collect();
        let settled: Vec<&Row> = counted.iter().copied().filter(|row| row.settled).collect();
        let overruns: Vec<f64> = counted.iter().filter_map(|row| row.overrun()).collect();
        let cost = |row: &&Row| Some(row.mode_steps as f64 / row.cheapest_mode_steps? as f64);
        Tally {
            rows: rows.len(),
            counted: counted.len(),
            settled: settled.len(),
            within: settled.iter().filter(|row| row.meets()).count(),
            stated: overruns.len(),
            covered: overruns.iter().filter(|overrun| **overrun <= 1.0).count(),
            worst: overruns.iter().copied().fold(0.0, f64::max),
            costs: settled.iter().filter(|row| row.mode_steps > 0).filter_map(cost).collect(),
        }
    }

    const HEADERS: [&str; 8] = [
        "rows",
        "counted",
        "said to have converged",
        "of these within the tolerance",
        "with an uncertainty",
        "of these covered",
        "worst error over uncertainty",
        "cost over cheapest",
    ];

    fn cells(&self) -> Vec<String> {
        let mut cells: Vec<String> = [self.rows, self.counted, self.settled, self.within, self.stated, self.covered]
            .map(|n| n.to_string())
            .into();
        cells.push(significant(self.worst, 3));
        cells.push(if self.costs.is_empty() { "-".to_owned() } else { significant(geometric(&self.costs), 3) });
        cells
    }
}

pub(super) fn write(study: &mut Study, rows: &[Row]) -> Result<(), Failure> {
    let all = Tally::of(rows.iter());
    let share = |part: usize, whole: usize| part as f64 / whole.max(1) as f64;
    let targets = [
        ("converged answers within their tolerance", "at least 99.9 %", (0.999, 1.0), share(all.within, all.settled)),
        ("errors within the stated uncertainty", "at least 99.9 %", (0.999, 1.0), share(all.covered, all.stated)),
        ("mode-steps over those of the cheapest model", "at most 2", (0.0, 2.0), geometric(&all.costs)),
    ];
    for (what, words, range, ours) in targets {
        study.state(Comparison::range(what, "target", words, range, ours));
    }
    let planned: Vec<(&Row, [u64; 2])> =
        rows.iter().filter(|row| row.mode_steps > 0).filter_map(|row| Some((row, row.planned()?))).collect();
    let held = planned.iter().filter(|(row, [least, most])| (*least..=*most).contains(&row.mode_steps)).count();
    study.state(Comparison::range(
        "mode-steps within the range that plan states",
        "target",
        "at least 95 %",
        (0.95, 1.0),
        share(held, planned.len()),
    ));
    study.text(&quantiles(&planned));
    study.text(
        "The cheapest model has the fewest modes from which on the error stays within the tolerance, and is solved once, \
         as if that number were known. The mean cost is that of converged answers for which modes were integrated.",
    );
    let mut lines = vec![[vec!["all".to_owned()], all.cells()].concat()];
    for tolerance in TOLERANCES {
        let of = Tally::of(rows.iter().filter(|row| row.tolerance == tolerance));
        lines.push([vec![significant(tolerance, 1)], of.cells()].concat());
    }
    let headers = |first| [&[first], &Tally::HEADERS[..]].concat();
    study.table(&headers("tolerance"), &lines);
    for (name, of) in [("structure", (|row| row.kind.clone()) as fn(&Row) -> String), ("law", |row| row.law.clone())] {
        let mut groups: Vec<String> = rows.iter().map(of).collect();
        groups.sort();
        groups.dedup();
        let line = |group: String| {
            let cells = Tally::of(rows.iter().filter(|row| of(row) == group)).cells();
            [vec![group], cells].concat()
        };
        study.table(&headers(name), &groups.into_iter().map(line).collect::<Vec<_>>());
    }
    listed(study, "Answers that are said to have converged, but are beyond the tolerance:", rows, |row| {
        row.settled && !row.meets()
    });
    listed(study, "Answers beyond the stated uncertainty:", rows, |row| {
        row.overrun().is_some_and(|overrun| overrun > 1.0)
    });
    listed(study, "Not converged:", rows, |row| row.chosen && !row.settled);
    picture(study, rows)
}

/// Factors for the limits of the planned ranges that would leave 2 % of the rows out on either side.
fn quantiles(planned: &[(&Row, [u64; 2])]) -> String {
    let of = |group: fn(&Row) -> bool| {
        let rows = planned.iter().filter(|(row, _)| group(row));
        let mut ratios: Vec<[f64; 2]> =
            rows.map(|(row, ends)| ends.map(|end| row.mode_steps as f64 / end.max(1) as f64)).collect();
        let mut at = |end: usize, share: f64| {
            ratios.sort_by(|a, b| a[end].total_cmp(&b[end]));
            let place = (share * ratios.len().saturating_sub(1) as f64).round() as usize;
            ratios.get(place).map_or_else(|| "-".to_owned(), |ratio| significant(ratio[end], 3))
        };
        format!("{} and {}", at(0, 0.02), at(1, 0.98))
    };
    format!(
        "The mode-steps of an answer are divided by the least and by the greatest number that was planned. Of the \
         first ratio 2 % lie below the first number, of the second 2 % above the second number: {} for one contact, \
         {} for several, {} where the modes are stated.",
        of(|row| row.chosen && row.sub_impacts == Some(1)),
        of(|row| row.chosen && row.sub_impacts != Some(1)),
        of(|row| !row.chosen)
    )
}

fn listed(study: &mut Study, heading: &str, rows: &[Row], of: impl Fn(&Row) -> bool) {
    let found: Vec<&Row> = rows.iter().filter(|row| row.counts() && of(row)).collect();
    let small = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| significant(v, 2));
    let line = |row: &&Row| {
        vec![
            row.scene.to_string(),
            row.kind.clone(),
            row.law.clone(),
            significant(row.damping_ratio, 2),
            row.model.as_str().to_owned(),
            row.modes.to_string(),
            row.sub_impacts.map_or_else(|| "-".to_owned(), |n| n.to_string()),
            small(Some(row.tolerance)),
            small(row.error()),
            small(row.uncertainty),
            small(row.reference_change),
        ]
    };
    let headers = [
        "scene",
        "structure",
        "law",
        "damping ratio",
        "model",
        "modes",
        "contacts",
        "tolerance",
        "error",
        "uncertainty",
        "reference's change",
    ];
    study.text(&format!("{heading} {} of the rows counted.", found.len()));
    if !found.is_empty() {
        study.table(&headers, &found.iter().take(LISTED).map(line).collect::<Vec<_>>());
    }
}

const MODELS: [(Model, Colour, Marker); 4] = [
    (Model::Rigid, Colour::Grey, Marker::Square),
    (Model::InfiniteBeam, Colour::Green, Marker::Triangle),
    (Model::Modal, Colour::Blue, Marker::Circle),
    (Model::Emoc, Colour::Orange, Marker::Plus),
];

fn picture(study: &mut Study, rows: &[Row]) -> Result<(), Failure> {
    let counted: Vec<&Row> = rows.iter().filter(|row| row.counts() && row.chosen).collect();
    // errors below the error of the reference are drawn at that value
    let error = |row: &Row| row.error().unwrap_or(1.0).max(row.reference_change.unwrap_or(0.0)).max(1e-12);
    let panel = |x: &str, of: fn(&Row) -> f64, low: f64| {
        let panel = Panel::new(Axis::new(x).log().limits(low, 1.0), Axis::new("actual error").log().limits(1e-12, 1.0));
        let mut panel = panel.with(Series::line(&[low, 1.0], &[low, 1.0]).colour(Colour::Black));
        for (model, colour, marker) in MODELS {
            let of_model: Vec<&&Row> = counted.iter().filter(|row| row.model == model).collect();
            if of_model.is_empty() {
                continue;
            }
            let x: Vec<f64> = of_model.iter().map(|row| of(row)).collect();
            let y: Vec<f64> = of_model.iter().map(|row| error(row)).collect();
            panel = panel.with(Series::points(&x, &y, marker).colour(colour).label(model.as_str()));
        }
        panel
    };
    // scenes with the same tolerance are spread out horizontally
    let spread = |row: &Row| row.tolerance * 10f64.powf(0.6 * ((row.scene % 97) as f64 / 97.0 - 0.5));
    let tolerance = panel("tolerance (points spread apart)", spread, 3e-7);
    let uncertainty = panel("reported uncertainty", |row| row.uncertainty.unwrap_or(1.0).max(1e-9), 1e-9);
    study.figure(
        "choosing-the-model",
        &Figure::new("The automatic choice on random scenes").row([tolerance, uncertainty]),
        "Each mark is one scene at one tolerance. Below the line the error is smaller than the requested tolerance (left) or \
         the reported uncertainty (right).",
    )
}
