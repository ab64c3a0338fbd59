//! The files of the record.

use std::fs;
use std::path::{Path, PathBuf};
use tasks::Failure;

/// The files of the record.
pub struct Files {
    pub record: PathBuf,
    pub references: PathBuf,
    pub history: PathBuf,
    pub figure: PathBuf,
    pub page: PathBuf,
}

impl Files {
    /// The files below this folder.
    pub fn of(docs: &Path) -> Files {
        let file = |name: &str| docs.join("benchmarks").join(name);
        Files {
            record: file("record.json"),
            references: file("references.json"),
            history: file("history.csv"),
            figure: file("history.svg"),
            page: docs.join("benchmarks.md"),
        }
    }
}

/// Reads a file of JSON.
pub fn read<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, Failure> {
    let hint =
        |error: &dyn std::fmt::Display| format!("{}: {error}; cargo xtask bench-record writes it", path.display());
    let text = fs::read_to_string(path).map_err(|error| hint(&error))?;
    serde_json::from_str(&text).map_err(|error| hint(&error).into())
}

/// Writes a file of JSON.
pub fn write<T: serde::Serialize>(path: &Path, value: &T) -> Result<(), Failure> {
    Ok(fs::write(path, serde_json::to_string_pretty(value)? + "\n")?)
}
