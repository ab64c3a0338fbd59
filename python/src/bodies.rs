//! Scenes of bodies: runs, periodic motions.

use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibroimpact::assembly::{self, AssemblyScene, MOST_INTERVALS, Summary, Wanted};
use vibroimpact::orbit::Over;
use vibroimpact::vibroimpact_sim::assembly::OrbitSettings;
use vibroimpact::{InvalidInput, export};

use crate::errors::{Fault, interrupted};
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

    /// The result, or the exception of a signal; that of Ctrl-C has the result so far.
    fn deliver<'py>(self, py: Python<'py>, result: Bound<'py, PyDict>) -> PyResult<Bound<'py, PyDict>> {
        match self.found {
            None => Ok(result),
            Some(signal) if signal.is_instance_of::<PyKeyboardInterrupt>(py) => Err(interrupted(py, signal, result)),
            Some(signal) => Err(signal),
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
        Ok::<_, Fault>((json, found.posed.contacts, found.course))
    });
    let (json, names, course) = found?;
    let result = output::result(py, &json)?;
    if let Some(course) = course {
        result.set_item("history", output::columns(py, assembly::history(&names, &course.rows))?)?;
        let section = course.period_s.map(|_| output::columns(py, assembly::history(&names, &course.section)));
        result.set_item("section", section.transpose()?)?;
    }
    signals.deliver(py, result)
}

/// Find the periodic motion of a scene of bodies under a harmonic load, or follow a branch of them over a field.
///
/// After `transient` periods of the load from the scene's start, Newton's method finds a motion with a period of `periods` of
/// them. If it fails, the motion is followed for `search` more periods, and Newton's method begins where it nearly repeats itself.
/// Returns the object that `vibroimpact orbit --json` prints, with `points` as a structured array and
/// `floquet_multipliers` as a complex one.
///
/// With `over`, the path of a number in the scene as in a sweep, the branch is followed from `from_` (default: the value in the
/// scene) to `to`; `step` is the first step as a share of that range. With `branches` the branches that begin at
/// period doublings and pitchforks are followed too, 1 for those of the branch itself, 2 also for theirs. The entry `columns` is then a
/// dictionary of arrays with a value for each orbit of all branches: those of the table that `--csv` writes.
///
/// Raises `InvalidInput` for a scene, or a field, that cannot be used. Ctrl-C ends the search with the exception `Interrupted`,
/// a `KeyboardInterrupt` whose `result` is the result so far.
#[pyfunction]
#[pyo3(signature = (scene, *, periods = 1, transient = 100, search = 1500, over = None, from_ = None, to = None, step = 0.02, branches = 0))]
#[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub fn orbit(
    py: Python<'_>,
    scene: Source,
    periods: u32,
    transient: u32,
    search: u32,
    over: Option<String>,
    from_: Option<f64>,
    to: Option<f64>,
    step: f64,
    branches: u32,
) -> PyResult<Bound<'_, PyDict>> {
    let settings = OrbitSettings {
        forcing_periods: periods,
        transient_periods: transient,
        search_periods: search,
        ..OrbitSettings::default()
    };
    let Some(field) = over else {
        let (found, signals) = py.detach(|| {
            until_signal(|stop| {
                let scene = scene.bodies()?;
                Ok(scene.orbit_until(&settings, stop)?.json(&scene)?)
            })
        });
        return signals.deliver(py, output::result(py, &found?)?);
    };
    let (found, signals) = py.detach(|| {
        until_signal(|stop| {
            let needed = || InvalidInput::missing("to", "a finite number, because over needs it");
            let over = Over { field: &field, from: from_, to: to.ok_or_else(needed)?, step, branches };
            let scene = scene.bodies()?;
            let branch = scene.orbit_branch(&over, &settings, stop)?;
            let table = branch.csv().map_err(export::Failure::from)?;
            Ok((branch.json(&scene)?, table))
        })
    });
    let (json, table) = found?;
    let result = output::result(py, &json)?;
    let columns = py.import("vibroimpact._convert")?.call_method1("columns", (String::from_utf8_lossy(&table),))?;
    result.set_item("columns", columns)?;
    signals.deliver(py, result)
}

/// Runs a search that a signal stops, and returns the signal too.
fn until_signal<T>(search: impl FnOnce(&dyn Fn() -> bool) -> Result<T, Fault>) -> (Result<T, Fault>, Signals) {
    let signals = RefCell::new(Signals::new());
    let found = search(&|| signals.borrow_mut().look());
    (found, signals.into_inner())
}
