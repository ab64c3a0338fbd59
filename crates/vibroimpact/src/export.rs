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
        let until_s = history.duration_s() * (1.0 + AFTERMATH);
        let samples: Vec<Sample> =
            history.times(until_s, HISTORY_INTERVALS).into_iter().map(|time_s| history.at(time_s)).collect();
        Ok(Files(vec![
            ("result.json", json(summary)?.into_bytes()),
            ("history.csv", history_csv(&samples)?),
            ("modal_energies.csv", energies_csv(history, until_s, summary.modes)?),
            ("sub_impacts.csv", sub_impacts_csv(summary)?),
            ("impact.svg", pictures::impact(title, summary, history).svg()?.into_bytes()),
        ]))
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

fn history_csv(samples: &[Sample]) -> Result<Vec<u8>, Failure> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([
        "time_s",
        "structure_displacement_m",
        "striker_displacement_m",
        "structure_velocity_m_s",
        "striker_velocity_m_s",
        "compression_m",
        "force_n",
    ])?;
    for sample in samples {
        table.serialize((
            sample.time_s,
            sample.structure_displacement_m,
            sample.striker_displacement_m,
            sample.structure_velocity_m_s,
            sample.striker_velocity_m_s,
            sample.compression_m,
            sample.force_n,
        ))?;
    }
    Ok(table.into_inner()?)
}

fn energies_csv(history: &History<Law>, until_s: f64, modes: usize) -> Result<Vec<u8>, Failure> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table
        .write_record(std::iter::once("time_s".to_owned()).chain((1..=modes).map(|k| format!("mode_{k}_energy_j"))))?;
    for i in 0..=ENERGY_INTERVALS {
        let time_s = until_s * i as f64 / ENERGY_INTERVALS as f64;
        table.serialize((time_s, history.modal_energies_j(time_s)))?;
    }
    Ok(table.into_inner()?)
}

fn sub_impacts_csv(summary: &Summary) -> Result<Vec<u8>, Failure> {
    let mut table = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    table.write_record(["number", "start_s", "end_s", "impulse_n_s", "peak_force_n", "peak_compression_m"])?;
    for (i, contact) in summary.sub_impacts.iter().enumerate() {
        table.serialize((i + 1, contact))?;
    }
    Ok(table.into_inner()?)
}
