//! The files of one impact: histories and contacts as CSV, the picture as SVG, the result as JSON.

use std::error::Error;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use contact_models::Law;
use tempfile::TempDir;
use vibroimpact_sim::modal::{History, Sample};

use crate::plot::Figure;
use crate::simulate::Resolved;
use crate::summary::Summary;

/// Whatever can go wrong between the numbers and the disk.
pub type Failure = Box<dyn Error + Send + Sync>;

/// Equal intervals of a history; every step in contact comes on top.
const HISTORY_INTERVALS: usize = 1000;
/// Equal intervals of the modal energies.
const ENERGY_INTERVALS: usize = 400;

/// The files of one impact, ready in memory, so that nothing is written unless all of it can be.
#[derive(Debug, Clone, PartialEq)]
pub struct Files(pub(crate) Vec<(&'static str, Vec<u8>)>);

impl Files {
    /// Every name that a file of the result of a scene with bodies may have beside those of [`Files::NAMES`].
    pub const NAMES_OF_BODIES: [&str; 5] =
        ["intervals.csv", "intervals.parquet", "run.svg", "report.html", "section.csv"];
    /// Every name that a file of the result of one impact may have.
    pub const NAMES: [&str; 6] =
        ["result.json", "history.csv", "modal_energies.csv", "sub_impacts.csv", "contacts.csv", "impact.svg"];

    /// `result.json`, `history.csv`, `modal_energies.csv`, `sub_impacts.csv` and `impact.svg`. `result` is the text of
    /// the first, `until_s` how far the tables go.
    ///
    /// # Errors
    /// None that an impact could cause; those of the writers are passed on.
    pub fn new(result: String, resolved: &Resolved, until_s: f64, figure: &Figure) -> Result<Files, Failure> {
        Ok(Files(vec![
            ("result.json", result.into_bytes()),
            ("history.csv", history(&resolved.history, until_s).csv()?),
            ("modal_energies.csv", modal_energies(&resolved.history, until_s).csv()?),
            ("sub_impacts.csv", sub_impacts_csv(&resolved.summary)?),
            ("impact.svg", figure.svg()?.into_bytes()),
        ]))
    }

    /// These files, by their names.
    pub fn of(files: Vec<(&'static str, Vec<u8>)>) -> Files {
        Files(files)
    }

    /// `result.json` and `impact.svg`, for a model without a course in time.
    ///
    /// # Errors
    /// None that an impact could cause.
    pub fn of_net(result: String, figure: &Figure) -> Result<Files, Failure> {
        Ok(Files(vec![("result.json", result.into_bytes()), ("impact.svg", figure.svg()?.into_bytes())]))
    }

    /// Writes the files into a folder, which is made if it is missing. Each file appears whole or not at all, and
    /// none before all have been written beside their places. Files of an earlier result are replaced, and those that
    /// this result does not have are removed.
    ///
    /// # Errors
    /// A folder or file that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), Failure> {
        let blame = |error: std::io::Error| format!("cannot write to {}: {error}", folder.display());
        fs::create_dir_all(folder).map_err(blame)?;
        let aside = TempDir::new_in(folder).map_err(blame)?;
        for (name, content) in &self.0 {
            fs::write(aside.path().join(name), content).map_err(blame)?;
        }
        for name in self.names() {
            fs::rename(aside.path().join(name), folder.join(name)).map_err(blame)?;
        }
        for name in Files::NAMES.into_iter().filter(|name| self.names().all(|written| written != *name)) {
            match fs::remove_file(folder.join(name)) {
                Err(error) if error.kind() != ErrorKind::NotFound => return Err(blame(error).into()),
                _ => {}
            }
        }
        Ok(())
    }

    /// The names of the files.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.0.iter().map(|(name, _)| *name)
    }
}

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
    /// Names, which carry the units, and values.
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

/// Motion and force over time until `until_s`: what `history.csv` holds.
pub fn history(history: &History<Law>, until_s: f64) -> Table {
    let times = history.times(until_s, HISTORY_INTERVALS);
    let samples: Vec<Sample> = times.into_iter().map(|time_s| history.at(time_s)).collect();
    let column = |name: &str, of: fn(&Sample) -> f64| (name.to_owned(), samples.iter().map(of).collect());
    Table {
        columns: vec![
            column("time_s", |sample| sample.time_s),
            column("structure_displacement_m", |sample| sample.structure_displacement_m),
            column("striker_displacement_m", |sample| sample.striker_displacement_m),
            column("structure_velocity_m_s", |sample| sample.structure_velocity_m_s),
            column("striker_velocity_m_s", |sample| sample.striker_velocity_m_s),
            column("compression_m", |sample| sample.compression_m),
            column("force_n", |sample| sample.force_n),
        ],
    }
}

/// The energy of each mode over time until `until_s`: what `modal_energies.csv` holds.
pub fn modal_energies(history: &History<Law>, until_s: f64) -> Table {
    let times: Vec<f64> = (0..=ENERGY_INTERVALS).map(|i| until_s * i as f64 / ENERGY_INTERVALS as f64).collect();
    let rows: Vec<Vec<f64>> = times.iter().map(|time_s| history.modal_energies_j(*time_s)).collect();
    let modes = rows.first().map_or(0, Vec::len);
    let mode = |k: usize| {
        let energies = rows.iter().filter_map(|row| row.get(k)).copied().collect();
        (format!("mode_{}_energy_j", k + 1), energies)
    };
    Table { columns: std::iter::once(("time_s".to_owned(), times)).chain((0..modes).map(mode)).collect() }
}

fn sub_impacts_csv(summary: &Summary) -> Result<Vec<u8>, Failure> {
    let mut table = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    table.write_record(["number", "start_s", "end_s", "impulse_n_s", "peak_force_n", "peak_compression_m"])?;
    for (i, contact) in summary.sub_impacts.iter().enumerate() {
        table.serialize((i + 1, contact))?;
    }
    Ok(table.into_inner()?)
}
