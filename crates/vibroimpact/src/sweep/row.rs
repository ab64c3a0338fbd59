//! Rows of the results: one point, one line of comma-separated values.

use serde_json::Value;

use super::definition::Sweep;
use super::error::SweepError;
use super::evaluate::evaluate;
use super::table::Kind;
use crate::model::{Answer, Kept};
use crate::scene::json::number;

/// The columns after the varied fields.
const RESULTS: [(&str, Kind); 23] = [
    ("outcome", Kind::Text),
    ("restitution", Kind::Number),
    ("restitution_uncertainty", Kind::Number),
    ("uncertainty_solver", Kind::Number),
    ("uncertainty_modes_left_out", Kind::Number),
    ("uncertainty_beam_theory", Kind::Number),
    ("settled", Kind::Truth),
    ("spread", Kind::Number),
    ("sub_impact_count", Kind::Whole),
    ("model", Kind::Text),
    ("mode_count", Kind::Whole),
    ("residual_compliance_m_n", Kind::Number),
    ("solves", Kind::Whole),
    ("modes_computed", Kind::Whole),
    ("contact_steps", Kind::Whole),
    ("rejected_steps", Kind::Whole),
    ("newton_iterations", Kind::Whole),
    ("law_evaluations", Kind::Whole),
    ("flight_steps", Kind::Whole),
    ("mode_steps", Kind::Whole),
    ("panels", Kind::Whole),
    ("stopped_by", Kind::Text),
    ("error", Kind::Text),
];

/// Every column of a sweep's results: `index`, the varied fields under their paths, the results.
pub(super) fn columns(sweep: &Sweep) -> Vec<(String, Kind)> {
    let axes = sweep.axes.iter().map(|axis| if axis.is_numeric() { Kind::Number } else { Kind::Text });
    let fields = sweep.fields().map(ToString::to_string).zip(axes.chain(std::iter::repeat(Kind::Number)));
    let results = RESULTS.map(|(name, kind)| (name.to_owned(), kind));
    std::iter::once(("index".to_owned(), Kind::Whole)).chain(fields).chain(results).collect()
}

/// The line of column names.
pub(super) fn header(sweep: &Sweep) -> Vec<u8> {
    line(columns(sweep).into_iter().map(|(name, _)| name))
}

/// The lines of a chunk, computed one after the other; `None` if `stop` told to give up on the way.
pub(super) fn rows(sweep: &Sweep, chunk: u64, kept: &mut Kept, stop: impl Fn() -> bool) -> Option<Vec<u8>> {
    let mut lines = Vec::new();
    for point in sweep.first_of_chunk(chunk)..sweep.first_of_chunk(chunk + 1) {
        if stop() {
            return None;
        }
        let values = sweep.values(point);
        lines.extend(row(point, &values, &evaluate(sweep.scene_with(&values), kept)));
    }
    Some(lines)
}

fn row(point: u64, values: &[Value], solved: &Result<Answer, String>) -> Vec<u8> {
    let results = match solved {
        Ok(answer) => cells(answer),
        Err(error) => {
            let mut empty: [String; RESULTS.len()] = Default::default();
            empty[RESULTS.len() - 1].clone_from(error);
            empty
        }
    };
    line(std::iter::once(point.to_string()).chain(values.iter().map(cell)).chain(results))
}

/// An answer in the columns of [`RESULTS`].
fn cells(answer: &Answer) -> [String; RESULTS.len()] {
    let known = |value: Option<f64>| value.map_or_else(String::new, number);
    let cost = answer.cost;
    [
        answer.outcome.to_owned(),
        known(answer.restitution),
        known(answer.restitution_uncertainty),
        known(answer.uncertainty.solver),
        known(answer.uncertainty.modes_left_out),
        known(answer.uncertainty.beam_theory),
        answer.settled.to_string(),
        known(answer.spread),
        answer.sub_impact_count.map_or_else(String::new, |count| count.to_string()),
        answer.model.as_str().to_owned(),
        answer.modes.to_string(),
        number(answer.residual_compliance_m_n),
        cost.solves.to_string(),
        cost.modes_computed.to_string(),
        cost.contact_steps.to_string(),
        cost.rejected_steps.to_string(),
        cost.newton_iterations.to_string(),
        cost.law_evaluations.to_string(),
        cost.flight_steps.to_string(),
        cost.mode_steps.to_string(),
        cost.panels.to_string(),
        answer.stopped_by.map_or_else(String::new, |reason| reason.as_str().to_owned()),
        String::new(),
    ]
}

/// A value of a varied field: numbers and texts as they are, anything else as JSON.
pub(super) fn cell(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Null => String::new(),
        other => other.to_string(),
    }
}

/// One line of a table. A line break within a cell becomes a space, so that rows and lines are the same.
fn line(cells: impl Iterator<Item = String>) -> Vec<u8> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let cells = cells.map(|cell| if cell.contains(['\n', '\r']) { cell.replace(['\n', '\r'], " ") } else { cell });
    // memory does not fail to be written
    let written = table.write_record(cells.map(String::into_bytes)).is_ok();
    debug_assert!(written);
    table.into_inner().unwrap_or_default()
}

/// A row read back.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row<'a> {
    cells: &'a csv::StringRecord,
    /// Where the results begin.
    results: usize,
}

impl<'a> Row<'a> {
    /// Takes a line of the table apart; it must be that of the point with this number.
    pub(super) fn new(sweep: &Sweep, point: u64, cells: &'a csv::StringRecord) -> Result<Row<'a>, SweepError> {
        let results = 1 + sweep.fields().count();
        if cells.len() != results + RESULTS.len() || cells.get(0) != Some(&point.to_string()) {
            let found = cells.get(0).unwrap_or_default();
            return Err(SweepError::Refused(format!(
                "the results are damaged: row {found:?} stands where {point} should"
            )));
        }
        Ok(Row { cells, results })
    }

    /// All cells, in the order of the columns.
    pub(super) fn cells(&self) -> impl Iterator<Item = &'a str> {
        self.cells.iter()
    }

    /// The cell of a result, by the name of its column.
    pub(super) fn text(&self, name: &str) -> &'a str {
        let place = RESULTS.iter().position(|(column, _)| *column == name);
        place.and_then(|place| self.cells.get(self.results + place)).unwrap_or_default()
    }

    /// The same as a number; `None` if there is none.
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.text(name).parse().ok()
    }
}
