//! Impacts resolved in time, and modes.

use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibroimpact::assembly::AnyScene;
use vibroimpact::infinite::{self, Summary, TurningPoints};
use vibroimpact::summary::ModeTable;
use vibroimpact::vibroimpact_sim::infinite::{Settings, Structure, solve};
use vibroimpact::{Scene, export};

use crate::bodies;
use crate::errors::Fault;
use crate::input::Source;
use crate::output;

/// Solve a scene: one impact, with every contact, the rebound, and the energy balance; or bodies, contacts and loads over time.
///
/// Returns the object that `vibroimpact simulate --json` prints, with `sub_impacts` (the `contacts` of an infinite structure,
/// the `intervals` of each contact between bodies, and `points`) as structured arrays and energies of modes as an array.
///
/// `history=True` adds two entries. For one impact they are `history`, motion and force over time as a dictionary of arrays,
/// and `modal_energies`, a dictionary of `time_s` and `energy_j`, the latter with a row for each time and a column for each
/// mode; either is `None` if the model does not resolve it. For bodies they are `history`, and `section`, the same once per
/// period of a harmonic load, or `None` without one.
///
/// Raises `InvalidInput` for a scene that cannot be used, `OSError` for a file that cannot be read. Sustained contact, and a
/// computation that stopped, are results: see `outcome`. Ctrl-C ends a run of bodies with the exception `Interrupted`, a
/// `KeyboardInterrupt` whose `result` is the result so far.
#[pyfunction]
#[pyo3(signature = (scene, *, history = false))]
pub fn simulate(py: Python<'_>, scene: Source, history: bool) -> PyResult<Bound<'_, PyDict>> {
    match py.detach(|| scene.any_scene().map_err(Fault::from))? {
        AnyScene::Impact(scene) => one_impact(py, &scene, history),
        AnyScene::Bodies(scene) => bodies::simulate(py, &scene, history),
    }
}

fn one_impact<'py>(py: Python<'py>, scene: &Scene, history: bool) -> PyResult<Bound<'py, PyDict>> {
    let (json, course, energies) = py.detach(|| {
        let found = scene.simulate()?;
        let (course, energies) = if history { (found.history(None), found.modal_energies(None)) } else { (None, None) };
        Ok::<_, Fault>((found.json(scene)?, course, energies))
    })?;
    let result = output::result(py, &json)?;
    if history {
        result.set_item("history", course.map(|table| output::columns(py, table)).transpose()?)?;
        result.set_item("modal_energies", energies.map(|table| output::modal_energies(py, table)).transpose()?)?;
    }
    Ok(result)
}

/// State which model would be used for a scene and why, and the cost of each model; nothing costly is solved.
///
/// Returns the object that `vibroimpact plan --json` prints.
#[pyfunction]
pub fn plan(py: Python<'_>, scene: Source) -> PyResult<Bound<'_, PyDict>> {
    let json = py.detach(|| Ok::<_, Fault>(export::json(&scene.scene()?.plan()?)?))?;
    output::result(py, &json)
}

/// Solve a scene with every model, side by side.
///
/// Returns the object that `vibroimpact compare --json` prints: differences are from the model with the smallest uncertainty.
#[pyfunction]
pub fn compare(py: Python<'_>, scene: Source) -> PyResult<Bound<'_, PyDict>> {
    let json = py.detach(|| Ok::<_, Fault>(export::json(&scene.scene()?.compare()?)?))?;
    output::result(py, &json)
}

/// Differentiate a scene, of one impact or of bodies, with respect to fields such as `"striker.mass_kg"`, or to all its numbers
/// if none is named.
///
/// Returns the object that `vibroimpact sensitivity --json` prints: `derivatives[output][field]` has a `value` and its
/// `uncertainty`, in the unit of the output over that of the field.
#[pyfunction]
#[pyo3(signature = (scene, by = Vec::new()))]
pub fn sensitivity(py: Python<'_>, scene: Source, by: Vec<String>) -> PyResult<Bound<'_, PyDict>> {
    let json = py.detach(|| {
        Ok::<_, Fault>(match scene.any_scene()? {
            AnyScene::Impact(scene) => export::json(&scene.sensitivity(&by)?)?,
            AnyScene::Bodies(scene) => export::json(&scene.sensitivity(&by)?)?,
        })
    })?;
    output::result(py, &json)
}

/// Compute natural frequencies, and mode shapes at the point of impact.
///
/// Returns a dictionary of arrays of length `count`, from the lowest mode: `omega_rad_s`, `frequency_hz`, and
/// `shape_at_location`, mass-normalised (kg^-1/2). Rigid-body modes come first, with frequency 0.
#[pyfunction]
pub fn modes(py: Python<'_>, scene: Source, count: usize) -> PyResult<Bound<'_, PyDict>> {
    let ModeTable { omega_rad_s, frequency_hz, shape_at_location, .. } =
        py.detach(|| Ok::<_, Fault>(ModeTable::new(&scene.scene()?.mode_shapes(count)?, None)))?;
    let table = PyDict::new(py);
    table.set_item("omega_rad_s", omega_rad_s.into_pyarray(py))?;
    table.set_item("frequency_hz", frequency_hz.into_pyarray(py))?;
    table.set_item("shape_at_location", shape_at_location.into_pyarray(py))?;
    Ok(table)
}

/// Solve the impact on an infinite beam, given by its only parameter S = C^10 k_H^2 m^8 v.
///
/// Returns the object that `vibroimpact infinite-beam --json` prints, with `contacts` as a structured array. Times are in units
/// of T, speeds of v, forces of F (thesis Eqs. 2.9 and 2.10). `history=True` adds the entry `history`: motion and force over
/// time as a dictionary of arrays.
#[pyfunction]
#[pyo3(signature = (s, *, history = false))]
pub fn infinite_beam(py: Python<'_>, s: f64, history: bool) -> PyResult<Bound<'_, PyDict>> {
    let (json, course) = py.detach(|| {
        let solution = solve(Structure::Beam, s, &Settings::default())?;
        let course = history.then(|| infinite::history(&solution, None, None));
        Ok::<_, Fault>((export::json(&Summary::new(&solution, None))?, course))
    })?;
    let result = output::result(py, &json)?;
    if let Some(table) = course {
        result.set_item("history", output::columns(py, table)?)?;
    }
    Ok(result)
}

/// Compute the critical S of the infinite beam, and the turning points, at which the n-th separation disappears.
///
/// Returns the object that `vibroimpact infinite-beam turning-points --json` prints, with `turning_points` as a structured
/// array of `n`, `s` and `uncertainty`; `count` is from 1 to 60.
#[pyfunction]
pub fn turning_points(py: Python<'_>, count: usize) -> PyResult<Bound<'_, PyDict>> {
    let json = py.detach(|| Ok::<_, Fault>(export::json(&TurningPoints::first(count)?)?))?;
    output::result(py, &json)
}
