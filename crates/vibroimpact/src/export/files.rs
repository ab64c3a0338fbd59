//! The files of one impact: histories and contacts as CSV, the picture as SVG, the result as JSON.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use super::aside::Aside;
use super::{Failure, history, modal_energies};
use crate::plot::Figure;
use crate::simulate::Resolved;
use crate::summary::Summary;

/// The files of one result in memory, so that nothing is written unless all files are complete.
#[derive(Debug, Clone, PartialEq)]
pub struct Files {
    files: Vec<(&'static str, Vec<u8>)>,
    beside: &'static [&'static str],
}

impl Files {
    /// File names of the results of all scenes.
    pub const NAMES: [&str; 11] = [
        "result.json",
        "history.csv",
        "modal_energies.csv",
        "sub_impacts.csv",
        "contacts.csv",
        "impact.svg",
        "intervals.csv",
        "intervals.parquet",
        "run.svg",
        "report.html",
        "section.csv",
    ];

    /// `result.json`, `history.csv`, `modal_energies.csv`, `sub_impacts.csv` and `impact.svg`. `result` is the text of
    /// the first, `until_s` the end of the tables.
    ///
    /// # Errors
    /// Errors of the writers, which an impact cannot cause.
    pub fn new(result: String, resolved: &Resolved, until_s: f64, figure: &Figure) -> Result<Files, Failure> {
        Ok(Files::of(vec![
            ("result.json", result.into_bytes()),
            ("history.csv", history(&resolved.history, until_s).csv()?),
            ("modal_energies.csv", modal_energies(&resolved.history, until_s).csv()?),
            ("sub_impacts.csv", sub_impacts_csv(&resolved.summary)?),
            ("impact.svg", figure.svg()?.into_bytes()),
        ]))
    }

    /// These files, by their names.
    pub fn of(files: Vec<(&'static str, Vec<u8>)>) -> Files {
        Files { files, beside: &[] }
    }

    /// These files, next to others of the same result that are in the folder already.
    #[must_use]
    pub fn beside(self, names: &'static [&'static str]) -> Files {
        Files { beside: names, ..self }
    }

    /// `result.json` and `impact.svg`, for a model that does not resolve the motion in time.
    ///
    /// # Errors
    /// Errors of the writers, which an impact cannot cause.
    pub fn of_net(result: String, figure: &Figure) -> Result<Files, Failure> {
        Ok(Files::of(vec![("result.json", result.into_bytes()), ("impact.svg", figure.svg()?.into_bytes())]))
    }

    /// Writes the files into a folder, which is created if it is missing. Each file appears complete or not at all, and none
    /// appears before all have been written under temporary names. Files of an earlier result are replaced, and those that this
    /// result does not have are removed.
    ///
    /// # Errors
    /// A folder or file that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), Failure> {
        let blame = |error: std::io::Error| format!("cannot write to {}: {error}", folder.display());
        fs::create_dir_all(folder).map_err(blame)?;
        let aside = Aside::new_in(folder).map_err(blame)?;
        for (name, content) in &self.files {
            fs::write(aside.path().join(name), content).map_err(blame)?;
        }
        for (name, _) in &self.files {
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

    /// The names of the files, and of those beside them.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.files.iter().map(|(name, _)| *name).chain(self.beside.iter().copied())
    }
}

fn sub_impacts_csv(summary: &Summary) -> Result<Vec<u8>, Failure> {
    let mut table = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    table.write_record([
        "number",
        "start_s",
        "end_s",
        "impulse_n_s",
        "peak_force_n",
        "peak_force_uncertainty_n",
        "peak_force_uncertainty_solver_n",
        "peak_force_uncertainty_modes_left_out_n",
        "peak_force_uncertainty_beam_theory_n",
        "peak_compression_m",
    ])?;
    for (i, contact) in summary.sub_impacts.iter().enumerate() {
        table.serialize((i + 1, contact))?;
    }
    Ok(table.into_inner()?)
}
