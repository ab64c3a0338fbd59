//! The files of one impact: histories and contacts as CSV, the picture as SVG, the result as JSON.

use std::error::Error;
use std::fs;
use std::path::Path;

use contact_models::Law;
use tempfile::TempDir;
use vibroimpact_sim::modal::{History, Sample};

use crate::pictures;
use crate::summary::Summary;

/// Whatever can go wrong between the numbers and the disk.
pub type Failure = Box<dyn Error + Send + Sync>;

/// Equal intervals of a history; every step in contact comes on top.
const HISTORY_INTERVALS: usize = 1000;
/// Equal intervals of the modal energies.
const ENERGY_INTERVALS: usize = 400;
/// How far past the last separation the histories go, as a share of the time until then.
const AFTERMATH: f64 = 0.1;

/// The files of one impact, ready in memory, so that nothing is written unless all of it can be.
#[derive(Debug, Clone, PartialEq)]
pub struct Files(pub(crate) Vec<(&'static str, Vec<u8>)>);

impl Files {
    /// `result.json`, `history.csv`, `modal_energies.csv`, `sub_impacts.csv` and `impact.svg`.
    ///
    /// # Errors
    /// None that an impact could cause; those of the writers are passed on.
    pub fn new(title: &str, summary: &Summary, history: &History<Law>) -> Result<Files, Failure> {
        Ok(Files(vec![
            ("result.json", json(summary)?.into_bytes()),
            ("history.csv", self::history(history).csv()?),
            ("modal_energies.csv", modal_energies(history).csv()?),
            ("sub_impacts.csv", sub_impacts_csv(summary)?),
            ("impact.svg", pictures::impact(title, summary, history).svg()?.into_bytes()),
        ]))
    }

    /// These files, by their names.
    pub fn of(files: Vec<(&'static str, Vec<u8>)>) -> Files {
        Files(files)
    }

    /// `result.json` alone, for a model without a course in time.
    pub fn result(json: String) -> Files {
        Files(vec![("result.json", json.into_bytes())])
    }

    /// Writes the files into a folder, which is made if it is missing. Each file appears whole or not at all, and
    /// none before all have been written beside their places.
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

/// How far the histories go (s).
fn until_s(history: &History<Law>) -> f64 {
    history.duration_s() * (1.0 + AFTERMATH)
}

/// Motion and force over time: what `history.csv` holds.
pub fn history(history: &History<Law>) -> Table {
    let times = history.times(until_s(history), HISTORY_INTERVALS);
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

/// The energy of each mode over time: what `modal_energies.csv` holds.
pub fn modal_energies(history: &History<Law>) -> Table {
    let until_s = until_s(history);
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
