//! Laws of contact for a requested restitution.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibroimpact::law::{Kind, Request};
use vibroimpact::{InvalidInput, export};

use crate::errors::Fault;
use crate::output;

/// Compute the parameters of the laws of contact that have a restitution (0.001 to 1) for a mass and a speed of approach.
///
/// Returns the object that `vibroimpact law --json` prints. `other_mass_kg` is the mass of the other body, which is immovable
/// by default; `compression_m` is the largest compression. `step_s` is the step of an engine that uses the semi-implicit Euler
/// rule: each law then states its restitution with this step, and parameters that correct for the step. `law` selects a single
/// law: `mujoco`, `kelvin-voigt`, `hunt-crossley`, `flores`, `lankarani-nikravesh`.
#[pyfunction]
#[pyo3(signature = (restitution, mass_kg, speed_m_s, *, other_mass_kg = None, compression_m = None, step_s = None, law = None))]
#[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub fn law<'py>(
    py: Python<'py>,
    restitution: f64,
    mass_kg: f64,
    speed_m_s: f64,
    other_mass_kg: Option<f64>,
    compression_m: Option<f64>,
    step_s: Option<f64>,
    law: Option<&str>,
) -> PyResult<Bound<'py, PyDict>> {
    let kind = law.map(|name| {
        Kind::ALL.into_iter().find(|kind| kind.name() == name).ok_or_else(|| {
            let names = Kind::ALL.map(Kind::name).join(", ");
            Fault::from(InvalidInput::new("law", name, format!("one of {names}")))
        })
    });
    let law = kind.transpose()?;
    let request = Request { restitution, mass_kg, other_mass_kg, speed_m_s, compression_m, step_s, law };
    let json = py.detach(|| Ok::<_, Fault>(export::json(&request.answer()?)?))?;
    output::result(py, &json)
}
