//! The net law: energy minimisation under outward constraints.

use numpy::ndarray::{ArrayD, Axis, Zip};
use numpy::{AllowTypeChange, IntoPyArray, PyArrayLike1, PyArrayLikeDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use vibroimpact::emoc::{Impact, Parameters, Site};
use vibroimpact::export;
use vibroimpact::invalid_input::{InvalidInput, Path, Step};
use vibroimpact::net::{Datum, FitSummary};

use crate::errors::Fault;
use crate::input::Source;
use crate::output;

/// Net restitution without integration in time: energy minimisation under outward constraints.
///
/// Returns the object that `vibroimpact emoc --json` prints. `modes` is the number of modes in the law, by default that of the
/// scene. Parameters for a beam come from `fit`.
#[pyfunction]
#[pyo3(signature = (scene, *, mu0 = 1.0, alpha0 = 1.0, alpha1 = 1.0, modes = None))]
pub fn emoc(
    py: Python<'_>,
    scene: Source,
    mu0: f64,
    alpha0: f64,
    alpha1: f64,
    modes: Option<usize>,
) -> PyResult<Bound<'_, PyDict>> {
    let parameters = Parameters { mu0, alpha0, alpha1, ..Parameters::default() };
    let json = py.detach(|| Ok::<_, Fault>(export::json(&scene.scene()?.emoc(&parameters, modes)?)?))?;
    output::result(py, &json)
}

/// Net restitution by the law of `emoc` for many impacts at once.
///
/// `mass_kg` contains the strikers' masses; the last axis of `shapes` contains the mass-normalised mode shapes at the point of
/// impact, from the lowest (kg^-1/2, as `modes` returns them; rigid-body modes are omitted). `mass_kg` and the other axes of
/// `shapes` are broadcast against each other, and the result has their common shape.
#[pyfunction]
#[pyo3(signature = (mass_kg, shapes, *, mu0 = 1.0, alpha0 = 1.0, alpha1 = 1.0))]
pub fn emoc_restitution<'py>(
    py: Python<'py>,
    mass_kg: PyArrayLikeDyn<'py, f64, AllowTypeChange>,
    shapes: PyArrayLikeDyn<'py, f64, AllowTypeChange>,
    mu0: f64,
    alpha0: f64,
    alpha1: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let (mass_kg, shapes) = (mass_kg.as_array().to_owned(), shapes.as_array().to_owned());
    let Some((_, places)) = shapes.shape().split_last() else {
        let allowed = "an array whose last axis contains the modes";
        return Err(Fault::from(InvalidInput::new("shapes", "a number", allowed)).into());
    };
    let common = py
        .import("numpy")?
        .call_method1("broadcast_shapes", (PyTuple::new(py, mass_kg.shape())?, PyTuple::new(py, places)?))?;
    let common: Vec<usize> = common.extract()?;
    let parameters = Parameters { mu0, alpha0, alpha1, ..Parameters::default() };
    let restitution = py.detach(|| restitution(&mass_kg, &shapes, &common, &parameters))?;
    // An array without axes becomes a number.
    restitution.into_pyarray(py).get_item(PyTuple::empty(py))
}

fn restitution(
    mass_kg: &ArrayD<f64>,
    shapes: &ArrayD<f64>,
    common: &[usize],
    parameters: &Parameters,
) -> Result<ArrayD<f64>, Fault> {
    parameters.validate()?;
    let last = Axis(shapes.ndim().saturating_sub(1));
    let mut fault = None;
    let mut keep = |found: InvalidInput| {
        fault.get_or_insert(found);
    };
    let sites = shapes.map_axis(last, |phi| Site::new(&phi.to_vec()).map_err(&mut keep).ok());
    let mut restitution = ArrayD::from_elem(common, f64::NAN);
    // numpy has determined the common shape, to which both can be broadcast.
    if let (Some(mass_kg), Some(sites)) = (mass_kg.broadcast(common), sites.broadcast(common)) {
        Zip::from(&mut restitution).and(mass_kg).and(sites).for_each(|e, &mass_kg, site| {
            let Some(site) = site else { return };
            match Impact::new(mass_kg, site).and_then(|impact| parameters.rebound(&impact)) {
                Ok(rebound) => *e = rebound.restitution,
                Err(found) => keep(found),
            }
        });
    }
    fault.map_or(Ok(restitution), |fault| Err(fault.into()))
}

/// Fit the three parameters of `emoc` to observed restitutions on the scene's beam.
///
/// `mass_kg`, `location_m` and `restitution` are arrays of one length, at least three; mass and location of the scene itself
/// are not used. Returns the object that `vibroimpact fit --json` prints; `intervals`, an array of shape (3, 2), is `None` if
/// the observations do not determine the parameters.
#[pyfunction]
#[pyo3(signature = (scene, mass_kg, location_m, restitution, *, modes = 50))]
pub fn fit<'py>(
    py: Python<'py>,
    scene: Source,
    mass_kg: PyArrayLike1<'py, f64, AllowTypeChange>,
    location_m: PyArrayLike1<'py, f64, AllowTypeChange>,
    restitution: PyArrayLike1<'py, f64, AllowTypeChange>,
    modes: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let [mass_kg, location_m, restitution] =
        [mass_kg, location_m, restitution].map(|values| values.as_array().to_vec());
    for (field, values) in [("location_m", &location_m), ("restitution", &restitution)] {
        if values.len() != mass_kg.len() {
            let value = format!("{} numbers", values.len());
            let allowed = format!("as long as mass_kg, which has {}", mass_kg.len());
            return Err(Fault::from(InvalidInput::new(field, value, allowed)).into());
        }
    }
    let table: Vec<Datum> = (0u64..)
        .zip(mass_kg)
        .zip(location_m.into_iter().zip(restitution))
        .map(|((line, mass_kg), (location_m, restitution))| Datum { line, mass_kg, location_m, restitution })
        .collect();
    let json = py.detach(|| {
        let observations = scene.scene()?.observations(&table, modes).map_err(of_element)?;
        Ok::<_, Fault>(export::json(&FitSummary::new(&observations, modes)?)?)
    })?;
    output::result(py, &json)
}

/// An error in a line of the table as one in an element of an array.
fn of_element(fault: InvalidInput) -> InvalidInput {
    match fault.field.steps() {
        [Step::Line(line), field @ ..] => {
            let element = (Path::from(field), *line as usize);
            fault.under(element)
        }
        _ => fault,
    }
}
