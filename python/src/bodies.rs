//! Scenes of bodies: runs, periodic motions.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibroimpact::assembly::{self, AssemblyScene, MOST_INTERVALS, Summary, Wanted};
use vibroimpact::orbit::Over;
use vibroimpact::vibroimpact_sim::assembly::OrbitSettings;
use vibroimpact::{InvalidInput, export};

use crate::errors::Fault;
use crate::input::Source;
use crate::output;

/// Time between two checks for Ctrl-C.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// Checks for signals at intervals.
struct Signals {
    looked: Instant,
    found: Option<PyErr>,
}

impl Signals {
    fn new() -> Signals {
        Signals { looked: Instant::now(), found: None }
    }

    /// Whether a signal was received.
    fn look(&mut self) -> bool {
        if self.found.is_none() && self.looked.elapsed() >= BETWEEN_LOOKS {
            self.looked = Instant::now();
            self.found = Python::attach(|py| py.check_signals()).err();
        }
        self.found.is_some()
    }

    /// The result so far, unless a signal was received.
    fn unless<T>(self, found: Result<T, Fault>) -> PyResult<T> {
        match self.found {
            Some(signal) => Err(signal),
            None => Ok(found?),
        }
    }
}

/// The solution of a scene of bodies.
pub fn simulate<'py>(py: Python<'py>, scene: &AssemblyScene, history: bool) -> PyResult<Bound<'py, PyDict>> {
    let mut signals = Signals::new();
    let stop = AtomicBool::new(false);
    let found = py.detach(|| {
        let wanted = Wanted {
            intervals: MOST_INTERVALS,
            reliability: true,
            course: history,
            take: None,
            stop: &stop,
            tell: &mut |_| stop.store(signals.look(), Ordering::Relaxed),
        };
        let found = scene.simulate_with(wanted)?;
        let json = Summary::new(&found).json(scene)?;
        Ok((json, found.posed.contacts, found.course))
    });
    let (json, names, course) = signals.unless(found)?;
    let result = output::result(py, &json)?;
    if let Some(course) = course {
        result.set_item("history", output::columns(py, assembly::history(&names, &course.rows))?)?;
        let section = course.period_s.map(|_| output::columns(py, assembly::history(&names, &course.section)));
        result.set_item("section", section.transpose()?)?;
    }
    Ok(result)
}

/// Find the periodic motion of a scene of bodies under a harmonic load, or follow a branch of them over a field.
///
/// After `transient` periods of the load from the scene's start, Newton's method finds a motion with a period of `periods` of
/// them. Returns the object that `vibroimpact orbit --json` prints, with `points` as a structured array and
/// `floquet_multipliers` as a complex one.
///
/// With `over`, the path of a number in the scene as in a sweep, the branch is followed from `from_` (default: the value in the
/// scene) to `to`; `step` is the first step as a share of that range. The entry `columns` is then a dictionary of arrays with a
/// value for each of the `orbits`: those of the table that `--csv` writes.
///
/// Raises `InvalidInput` for a scene, or a field, that cannot be used. Ctrl-C ends a branch.
#[pyfunction]
#[pyo3(signature = (scene, *, periods = 1, transient = 100, over = None, from_ = None, to = None, step = 0.02))]
#[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub fn orbit(
    py: Python<'_>,
    scene: Source,
    periods: u32,
    transient: u32,
    over: Option<String>,
    from_: Option<f64>,
    to: Option<f64>,
    step: f64,
) -> PyResult<Bound<'_, PyDict>> {
    let settings = OrbitSettings { forcing_periods: periods, transient_periods: transient, ..OrbitSettings::default() };
    let Some(field) = over else {
        let json = py.detach(|| Ok::<_, Fault>(export::json(&scene.bodies()?.orbit(&settings)?)?))?;
        return output::result(py, &json);
    };
    let mut signals = Signals::new();
    let found = py.detach(|| {
        let needed = || InvalidInput::missing("to", "needed beside over: a finite number");
        let over = Over { field: &field, from: from_, to: to.ok_or_else(needed)?, step };
        let branch = scene.bodies()?.orbit_branch(&over, &settings, |_| !signals.look())?;
        let table = branch.csv().map_err(export::Failure::from)?;
        Ok((export::json(&branch)?, table))
    });
    let (json, table) = signals.unless(found)?;
    let result = output::result(py, &json)?;
    let columns = py.import("vibroimpact._convert")?.call_method1("columns", (String::from_utf8_lossy(&table),))?;
    result.set_item("columns", columns)?;
    Ok(result)
}
