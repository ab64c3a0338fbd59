//! The results of a sweep in memory: the columns of `results.csv`.

use std::sync::atomic::AtomicBool;

use invalid_input::InvalidInput;

use super::definition::Sweep;
use super::error::SweepError;
use super::part::Part;
use super::row::{Row, columns};
use super::status::{Sink, Status};
use super::table::Kind;
use super::threads;

/// Largest number of points of a sweep in memory.
pub const MOST_IN_MEMORY: u64 = 10_000_000;

/// One column.
#[derive(Debug, Clone, PartialEq)]
pub enum Column {
    /// Numbers; NaN if there is none.
    Numbers(Vec<f64>),
    /// Texts, empty if there is none; `true` and `false` are texts too.
    Texts(Vec<String>),
}

/// Computes a whole sweep and returns the columns of its results under their names, without any file; otherwise as
/// [`run`](super::run).
///
/// # Errors
/// More than [`MOST_IN_MEMORY`] points; [`SweepError::Stopped`] after `stop` has become true.
///
/// ```
/// use std::sync::atomic::AtomicBool;
/// use vibroimpact::sweep::{Column, Sweep, run_in_memory};
///
/// let sweep = Sweep::from_value(&serde_json::json!({
///     "scene": {
///         "structure": { "kind": "modal", "omega_rad_s": [300, 1900], "shape_at_location": [1.1, -0.7] },
///         "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
///         "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 }
///     },
///     "vary": [{ "field": "striker.mass_kg", "values": [0.01, 0.1, 1] }]
/// }))?;
/// let columns = run_in_memory(&sweep, 2, &AtomicBool::new(false), &mut |_| ())?;
/// assert_eq!(columns[1], ("striker.mass_kg".to_owned(), Column::Numbers(vec![0.01, 0.1, 1.0])));
/// # Ok::<(), vibroimpact::sweep::SweepError>(())
/// ```
pub fn run_in_memory(
    sweep: &Sweep,
    threads: usize,
    stop: &AtomicBool,
    tell: &mut dyn FnMut(Status),
) -> Result<Vec<(String, Column)>, SweepError> {
    if sweep.points() > MOST_IN_MEMORY {
        let allowed = format!(
            "at most {MOST_IN_MEMORY} for a sweep in memory; vibroimpact sweep writes larger sweeps to a folder"
        );
        return Err(InvalidInput::new("number of points", sweep.points().to_string(), allowed).into());
    }
    let column = |(name, kind)| match kind {
        Kind::Whole | Kind::Number => (name, Column::Numbers(Vec::new())),
        Kind::Truth | Kind::Text => (name, Column::Texts(Vec::new())),
    };
    let mut table = Table { sweep, columns: columns(sweep).into_iter().map(column).collect(), chunks: 0, points: 0 };
    threads::compute(sweep, Part::WHOLE, sweep.chunks(), &mut table, threads, stop, tell)?;
    Ok(table.columns)
}

/// Columns that are being filled.
struct Table<'a> {
    sweep: &'a Sweep,
    columns: Vec<(String, Column)>,
    chunks: u64,
    points: u64,
}

impl Sink for Table<'_> {
    fn chunks(&self) -> u64 {
        self.chunks
    }

    fn append(&mut self, chunks: u64, rows: &[u8]) -> Result<(), SweepError> {
        for cells in csv::ReaderBuilder::new().has_headers(false).from_reader(rows).records() {
            let cells = cells.map_err(|fault| SweepError::Refused(fault.to_string()))?;
            let row = Row::new(self.sweep, self.points, &cells)?;
            for ((_, column), cell) in self.columns.iter_mut().zip(row.cells()) {
                match column {
                    Column::Numbers(values) => values.push(cell.parse().unwrap_or(f64::NAN)),
                    Column::Texts(values) => values.push(cell.to_owned()),
                }
            }
            self.points += 1;
        }
        self.chunks += chunks;
        Ok(())
    }
}
