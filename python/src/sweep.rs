//! Many scenes at once.

use std::sync::atomic::{AtomicBool, Ordering};

use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibroimpact::InvalidInput;
use vibroimpact::sweep::{Column, run_in_memory};

use crate::errors::Fault;
use crate::input::Source;

/// Largest number of threads.
const MOST_THREADS: usize = 1024;

/// Solve many scenes that differ in some fields, on all cores.
///
/// `definition` is a sweep file or its content: `scene` or `scene_file`, with `vary`, `random` or `uncertain` fields. Returns the
/// columns of `results.csv` as a dictionary of arrays: `index`, the varied fields under their paths, and the results. Missing
/// numbers are NaN; a scene that cannot be solved has the reason in `error`, which is empty otherwise. The values do not depend on
/// `threads`, which is the number of cores by default. Ctrl-C ends the sweep.
#[pyfunction]
#[pyo3(signature = (definition, *, threads = None))]
pub fn sweep(py: Python<'_>, definition: Source, threads: Option<usize>) -> PyResult<Bound<'_, PyDict>> {
    if let Some(threads) = threads.filter(|threads| !(1..=MOST_THREADS).contains(threads)) {
        let allowed = format!("a whole number from 1 to {MOST_THREADS}");
        return Err(Fault::from(InvalidInput::new("threads", threads, allowed)).into());
    }
    let stop = AtomicBool::new(false);
    let mut interrupted = None;
    let found = py.detach(|| {
        let mut look_for_signals = |_| {
            if let Err(signal) = Python::attach(|py| py.check_signals()) {
                interrupted = Some(signal);
                stop.store(true, Ordering::Relaxed);
            }
        };
        let sweep = definition.sweep()?;
        Ok(run_in_memory(&sweep, threads.unwrap_or(0), &stop, &mut look_for_signals)?)
    });
    if let Some(signal) = interrupted {
        return Err(signal);
    }
    let table = PyDict::new(py);
    for (name, column) in found.map_err(|fault: Fault| fault.0)? {
        match column {
            Column::Numbers(values) if name == "index" => {
                let whole: Vec<i64> = values.into_iter().map(|value| value as i64).collect();
                table.set_item(name, whole.into_pyarray(py))?;
            }
            Column::Numbers(values) => table.set_item(name, values.into_pyarray(py))?,
            Column::Texts(texts) => table.set_item(name, py.import("numpy")?.call_method1("array", (texts,))?)?,
        }
    }
    Ok(table)
}
