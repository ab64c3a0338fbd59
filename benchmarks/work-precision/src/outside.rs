//! Rows of solvers outside Rust, which `benchmarks/peers.sh` wrote earlier.

use crate::measure::Row;
use std::path::Path;

/// The rows, with the machine and the versions with which they were made; `None` without the file.
///
/// # Errors
/// If a line is not a row.
pub fn rows(folder: &Path) -> Result<Option<(Vec<Row>, String)>, String> {
    let table = folder.join("outside.csv");
    if !table.exists() {
        return Ok(None);
    }
    let fault = |error: csv::Error| format!("{}: {error}", table.display());
    let mut reader = csv::Reader::from_path(&table).map_err(fault)?;
    let rows = reader.deserialize().collect::<Result<Vec<Row>, _>>().map_err(fault)?;
    let versions = std::fs::read_to_string(folder.join("versions.txt")).unwrap_or_default();
    Ok(Some((rows, versions)))
}
