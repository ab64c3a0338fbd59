//! The result of a code: a line of a table of results.

use serde::{Deserialize, Serialize};
use std::path::Path;

/// One run of a code at one setting.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Name of the problem.
    pub problem: String,
    /// Name of the code, including the way in which it is used.
    pub code: String,
    /// Tolerance or step of the run.
    pub setting: f64,
    /// Least wall time of repeated runs (s).
    pub time_s: Option<f64>,
    /// `ok`, or the reason why there is no result.
    pub status: String,
    /// The requested quantities, in the order of the problem, separated by blanks.
    pub values: String,
}

impl Outcome {
    /// The result, if there is one.
    pub fn answer(&self) -> Option<Vec<f64>> {
        let values: Result<Vec<f64>, _> = self.values.split_whitespace().map(str::parse).collect();
        values.ok().filter(|values| self.status == "ok" && !values.is_empty())
    }
}

/// Reads the tables of all codes in a folder, `*.csv`.
///
/// # Errors
/// A file that cannot be read, by its name.
pub fn read_all(folder: &Path) -> Result<Vec<Outcome>, String> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))? {
        paths.push(entry.map_err(|error| error.to_string())?.path());
    }
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "csv"));
    paths.sort();
    let mut outcomes = Vec::new();
    for path in paths {
        let told = |error: csv::Error| format!("{}: {error}", path.display());
        for row in csv::Reader::from_path(&path).map_err(told)?.deserialize() {
            outcomes.push(row.map_err(told)?);
        }
    }
    Ok(outcomes)
}

/// The table as text.
///
/// # Errors
/// A line that cannot be written.
pub fn table(outcomes: &[Outcome]) -> Result<String, String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for outcome in outcomes {
        writer.serialize(outcome).map_err(|error| error.to_string())?;
    }
    String::from_utf8(writer.into_inner().map_err(|error| error.to_string())?).map_err(|error| error.to_string())
}
