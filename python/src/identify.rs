//! Fields of a scene from measurements.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibroimpact::identify::{self as identification, Free, Request};
use vibroimpact::{InvalidInput, export};

use crate::errors::Fault;
use crate::input::{Columns, Source};
use crate::output;

/// Free fields in the form of the command line.
pub struct FreeFields(Vec<String>);

impl<'a, 'py> FromPyObject<'a, 'py> for FreeFields {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<FreeFields> {
        let convert = given.py().import("vibroimpact._convert")?;
        Ok(FreeFields(convert.call_method1("to_free", (given,))?.extract()?))
    }
}

/// Find fields of a scene from measurements, by resolved impacts.
///
/// `data` has a row for each measured impact: columns under their names (a dictionary of arrays, or a data frame of pandas), or
/// the path of a CSV file. Columns are fields of the scene, such as `"striker.speed_m_s"`, which replace those of the scene;
/// measured quantities, such as `"restitution"` or `"first_contact_s"`; and their standard deviations, such as
/// `"restitution_sd"`. NaN marks a missing measurement.
///
/// `free` lists the fields to find, each within a factor of three of the scene's value; or maps each to the two limits of its
/// search. `level` is the probability with which an interval contains the true value, `starts` the number of starting points of
/// the search. `candidates` contains possible experiments, which are ranked by the information that they would add.
///
/// Returns the object that `vibroimpact identify --json` prints.
#[pyfunction]
#[pyo3(signature = (scene, data, free, *, level = 0.95, starts = 4, candidates = None))]
pub fn identify(
    py: Python<'_>,
    scene: Source,
    data: Columns,
    free: FreeFields,
    level: f64,
    starts: usize,
    candidates: Option<Columns>,
) -> PyResult<Bound<'_, PyDict>> {
    let json = py.detach(|| {
        let scene = scene.scene()?;
        let free = free.0.iter().map(|text| Free::parse(text)).collect::<Result<Vec<_>, InvalidInput>>()?;
        let candidates = candidates.map(|table| table.candidates()).transpose()?;
        let found = identification::identify(&scene, &data.measured()?, &free, &Request { level, starts, candidates })?;
        Ok::<_, Fault>(export::json(&found)?)
    })?;
    output::result(py, &json)
}
