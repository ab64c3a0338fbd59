//! Results for programs: histories as tables, the result as JSON, and the files of one impact.

#[cfg(feature = "files")]
pub(crate) mod aside;
#[cfg(feature = "files")]
mod files;

use std::error::Error;

use contact_models::ContactLaw;
use vibroimpact_sim::modal::{History, Sample};

#[cfg(feature = "files")]
pub use files::Files;

/// Any error of formatting or writing results.
pub type Failure = Box<dyn Error + Send + Sync>;

/// Equal intervals of a history, in addition to every step in contact.
const HISTORY_INTERVALS: usize = 1000;
/// Equal intervals of the modal energies.
const ENERGY_INTERVALS: usize = 400;

/// The summary as JSON text, ending in a line break.
///
/// # Errors
/// None that an impact could cause.
pub fn json(summary: &impl serde::Serialize) -> Result<String, Failure> {
    Ok(serde_json::to_string_pretty(summary)? + "\n")
}

/// Columns of numbers, each under its name; all of one length.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Names, which contain the units, and values.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl Table {
    /// The table as comma-separated values under a line of names.
    ///
    /// # Errors
    /// None that an impact could cause.
    pub fn csv(&self) -> Result<Vec<u8>, Failure> {
        let mut table = csv::Writer::from_writer(Vec::new());
        table.write_record(self.columns.iter().map(|(name, _)| name))?;
        let mut columns: Vec<_> = self.columns.iter().map(|(_, values)| values.iter()).collect();
        let mut row: Vec<f64> = columns.iter_mut().map_while(Iterator::next).copied().collect();
        while !row.is_empty() {
            table.serialize(&row)?;
            row.clear();
            row.extend(columns.iter_mut().map_while(Iterator::next));
        }
        Ok(table.into_inner()?)
    }
}

/// A column of a history: its name, and what it holds.
type Column = (&'static str, fn(&Sample) -> f64);

/// The columns of `history.csv`.
pub(crate) const HISTORY: [Column; 7] = [
    ("time_s", |sample| sample.time_s),
    ("structure_displacement_m", |sample| sample.structure_displacement_m),
    ("striker_displacement_m", |sample| sample.striker_displacement_m),
    ("structure_velocity_m_s", |sample| sample.structure_velocity_m_s),
    ("striker_velocity_m_s", |sample| sample.striker_velocity_m_s),
    ("compression_m", |sample| sample.compression_m),
    ("force_n", |sample| sample.force_n),
];

/// Motion and force over time until `until_s`: the table `history.csv`.
pub fn history<L: ContactLaw>(history: &History<L>, until_s: f64) -> Table {
    let times = history.times(until_s, HISTORY_INTERVALS);
    let samples: Vec<Sample> = times.into_iter().map(|time_s| history.at(time_s)).collect();
    let column = |(name, of): Column| (name.to_owned(), samples.iter().map(of).collect());
    Table { columns: HISTORY.map(column).into() }
}

/// The energy of each mode over time until `until_s`: the table `modal_energies.csv`.
pub fn modal_energies<L: ContactLaw>(history: &History<L>, until_s: f64) -> Table {
    let times: Vec<f64> = (0..=ENERGY_INTERVALS).map(|i| until_s * i as f64 / ENERGY_INTERVALS as f64).collect();
    let rows: Vec<Vec<f64>> = times.iter().map(|time_s| history.modal_energies_j(*time_s)).collect();
    let modes = rows.first().map_or(0, Vec::len);
    let mode = |k: usize| {
        let energies = rows.iter().filter_map(|row| row.get(k)).copied().collect();
        (format!("mode_{}_energy_j", k + 1), energies)
    };
    Table { columns: std::iter::once(("time_s".to_owned(), times)).chain((0..modes).map(mode)).collect() }
}
