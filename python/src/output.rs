//! Output for Python: dictionaries and arrays.

use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibroimpact::export::Table;

/// A result that the command line prints as JSON, with its tables as arrays.
pub fn result<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyDict>> {
    Ok(py.import("vibroimpact._convert")?.call_method1("from_json", (json,))?.cast_into::<PyDict>()?)
}

/// Columns under their names.
pub fn columns(py: Python<'_>, table: Table) -> PyResult<Bound<'_, PyDict>> {
    let columns = PyDict::new(py);
    for (name, values) in table.columns {
        columns.set_item(name, values.into_pyarray(py))?;
    }
    Ok(columns)
}

/// A table of time and modes: times, and energies with a row for each time and a column for each mode.
pub fn modal_energies(py: Python<'_>, table: Table) -> PyResult<Bound<'_, PyDict>> {
    let mut columns = table.columns.into_iter();
    let (name, times) = columns.next().unwrap_or_default();
    let modes: Vec<Vec<f64>> = columns.map(|(_, energies)| energies).collect();
    let rows: Vec<Vec<f64>> =
        (0..times.len()).map(|i| modes.iter().filter_map(|mode| mode.get(i)).copied().collect()).collect();
    let energies = PyDict::new(py);
    energies.set_item(name, times.into_pyarray(py))?;
    energies.set_item("energy_j", PyArray2::from_vec2(py, &rows)?)?;
    Ok(energies)
}
