//! Rows of the results: one point, one line of comma-separated values.

use serde_json::Value;

use super::definition::Sweep;
use super::error::SweepError;
use super::evaluate::evaluate;
use super::results::Results;
use super::table::Kind;
use crate::model::Kept;

/// The word for a run that has not converged to a motion.
pub(super) const NO_MOTION: &str = "none";

/// Every column of a sweep's results: `index`, the varied fields under their paths, the results.
pub(super) fn columns(sweep: &Sweep) -> Vec<(String, Kind)> {
    let axes = sweep.axes.iter().map(|axis| if axis.is_numeric() { Kind::Number } else { Kind::Text });
    let fields = sweep.names().zip(axes.chain(std::iter::repeat(Kind::Number)));
    std::iter::once(("index".to_owned(), Kind::Whole)).chain(fields).chain(sweep.results().columns()).collect()
}

/// The line of column names.
pub(super) fn header(sweep: &Sweep) -> Vec<u8> {
    lines([columns(sweep).into_iter().map(|(name, _)| name)])
}

/// The lines of a chunk, computed one after the other; `None` if `stop` interrupted it.
pub(super) fn rows(sweep: &Sweep, chunk: u64, kept: &mut Kept, stop: impl Fn() -> bool) -> Option<Vec<u8>> {
    let mut scene = sweep.tree().clone();
    let mut row = |point| {
        if stop() {
            return None;
        }
        let values = sweep.values(point);
        let solved = evaluate(sweep.scene_in(&mut scene, &values), sweep.results(), kept, &stop)?;
        let results = solved.unwrap_or_else(|error| sweep.results().failed(error));
        Some(std::iter::once(point.to_string()).chain(values.iter().map(cell)).chain(results).collect())
    };
    let points = sweep.first_of_chunk(chunk)..sweep.first_of_chunk(chunk + 1);
    let rows: Vec<Vec<String>> = points.map(&mut row).collect::<Option<_>>()?;
    Some(lines(rows))
}

/// A value of a varied field: numbers and texts as they are, anything else as JSON.
pub(super) fn cell(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Null => String::new(),
        other => other.to_string(),
    }
}

/// Lines of a table. A line break within a cell becomes a space, so that rows and lines are the same.
pub(super) fn lines(rows: impl IntoIterator<Item = impl IntoIterator<Item = String>>) -> Vec<u8> {
    let mut table = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    let whole = |cell: String| if cell.contains(['\n', '\r']) { cell.replace(['\n', '\r'], " ") } else { cell };
    for cells in rows {
        // writing to memory cannot fail
        let written = table.write_record(cells.into_iter().map(|cell| whole(cell).into_bytes())).is_ok();
        debug_assert!(written);
    }
    table.into_inner().unwrap_or_default()
}

/// A row that is read.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row<'a> {
    cells: &'a csv::StringRecord,
    /// The position of the first result.
    first: usize,
    results: &'a Results,
}

impl<'a> Row<'a> {
    /// Parses a line of the table, which must be that of the point with this number.
    pub(super) fn new(sweep: &'a Sweep, point: u64, cells: &'a csv::StringRecord) -> Result<Row<'a>, SweepError> {
        let (first, results) = (1 + sweep.fields().count(), sweep.results());
        if cells.len() != first + results.columns().len() || cells.get(0) != Some(&point.to_string()) {
            let found = cells.get(0).unwrap_or_default();
            return Err(SweepError::Refused(format!(
                "the results are damaged: row {found:?} is where {point} should be"
            )));
        }
        Ok(Row { cells, first, results })
    }

    /// All cells, in the order of the columns.
    pub(super) fn cells(&self) -> impl Iterator<Item = &'a str> {
        self.cells.iter()
    }

    /// The cell of a result, by the name of its column.
    pub(super) fn text(&self, name: &str) -> &'a str {
        self.results.place(name).map_or("", |place| self.at(place))
    }

    /// The cell of a result by its position among the results.
    fn at(&self, place: usize) -> &'a str {
        self.cells.get(self.first + place).unwrap_or_default()
    }

    /// The motion to which a run has converged, `intervals/periods`; `none` if it has not, empty without a harmonic load.
    pub(super) fn motion(&self) -> String {
        match (self.text("motion_intervals"), self.text("motion_periods")) {
            (_, "") => String::new(),
            (_, "0") => NO_MOTION.to_owned(),
            (intervals, periods) => format!("{intervals}/{periods}"),
        }
    }

    /// The same as a number; `None` if there is none.
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.text(name).parse().ok()
    }

    /// The same for a result by its position among the results.
    pub(super) fn number_at(&self, place: usize) -> Option<f64> {
        self.at(place).parse().ok()
    }
}
