//! Solves a scene of bodies.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};

use vibroimpact_sim::assembly::{CommonPeriod, Force, Interval, Load, Outcome, Reason, Run, Solver};

use super::steady::SteadyMotion;
use super::watch::{Course, Sink, Watch};
use super::{AssemblyScene, Posed};
use crate::export::Failure;

/// Default of the largest number of intervals of contact in memory, about 80 MB; further ones are counted and written to files.
pub const MOST_INTERVALS: usize = 1_000_000;

/// Options of a run.
pub struct Wanted<'a> {
    /// Intervals of contact that are kept in memory, the first of all contacts together; the rest are counted.
    pub intervals: usize,
    /// Whether to find the time up to which the times of the events are certain. This takes a second run, and needs all intervals
    /// in memory.
    pub reliability: bool,
    /// Whether samples of the motion are kept, for histories and pictures.
    pub course: bool,
    /// Called for every interval when it is found, with the number of its contact.
    pub take: Option<Sink<'a>>,
    /// Ends the run when it becomes true; the results so far are returned.
    pub stop: &'a AtomicBool,
    /// Called from time to time with the time that the run has reached (s).
    pub tell: &'a mut dyn FnMut(f64),
}

impl fmt::Debug for Wanted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Wanted")
            .field("intervals", &self.intervals)
            .field("reliability", &self.reliability)
            .field("course", &self.course)
            .finish_non_exhaustive()
    }
}

/// The result of [`AssemblyScene::simulate`].
#[derive(Debug, Clone)]
pub struct Simulation {
    /// The solved problem.
    pub posed: Posed,
    /// The result.
    pub run: Run,
    /// Time up to which touches and releases are certain (s): up to it a second run with a thousandth of the tolerance finds each
    /// of them within the tolerance times the time since the start. `None` if it was not requested, if not all intervals were
    /// kept, or if the run was interrupted.
    pub reliable_until_s: Option<f64>,
    /// Intervals of contact, contact by contact, as many as were requested.
    pub intervals: Vec<Vec<Interval>>,
    /// Number of intervals beyond these.
    pub left_out: Vec<u64>,
    /// The common period of the harmonic loads (s), if they have one.
    pub period_s: Option<f64>,
    /// The motion to which the run has converged at the end, in these periods.
    pub steady: Option<SteadyMotion>,
    /// Samples of the motion, if they were requested.
    pub course: Option<Course>,
}

impl AssemblyScene {
    /// Solves the scene and keeps every interval of contact up to [`MOST_INTERVALS`].
    ///
    /// # Errors
    /// As [`AssemblyScene::pose`].
    ///
    /// ```
    /// let scene = vibroimpact::assembly::AssemblyScene::from_json(r#"{
    ///     "bodies": { "ball": { "kind": "mass", "mass_kg": 0.1, "position_m": 0.01 } },
    ///     "contacts": [{ "name": "floor", "between": [{ "body": "ball" }, "ground"],
    ///                    "law": "linear-spring", "stiffness_n_m": 1e7 }],
    ///     "gravity_m_s2": 9.81, "end_s": 0.2
    /// }"#)?;
    /// let found = scene.simulate()?;
    /// // it falls for 45 ms and is back every 90 ms
    /// assert_eq!(found.intervals[0].len(), 2);
    /// # Ok::<(), Box<dyn std::error::Error + Send + Sync>>(())
    /// ```
    pub fn simulate(&self) -> Result<Simulation, Failure> {
        self.simulate_with(Wanted {
            intervals: MOST_INTERVALS,
            reliability: true,
            course: false,
            take: None,
            stop: &AtomicBool::new(false),
            tell: &mut |_| (),
        })
    }

    /// Solves the scene and records what is requested.
    ///
    /// # Errors
    /// As [`AssemblyScene::pose`], and errors of the receiver of the intervals.
    pub fn simulate_with(&self, wanted: Wanted) -> Result<Simulation, Failure> {
        let posed = self.pose()?;
        let period_s = CommonPeriod::of(&posed.assembly.loads).ok().map(|common| common.period_s);
        let section_s = period_s.or_else(|| slowest_period_s(&posed));
        let course = wanted.course.then(|| Course::new(&posed.assembly, posed.settings.end_s, section_s));
        let contacts = posed.contacts.len();
        let mut watch = Watch::new(contacts, wanted.intervals, wanted.take, course, period_s, wanted.stop, wanted.tell);
        let in_scene = |fault| posed.in_scene(fault);
        let solver = Solver::new(&posed.assembly).map_err(in_scene)?;
        let run = solver.run(&posed.settings, &mut watch).map_err(in_scene)?;
        let Watch { intervals, left_out, fault, course, moments, .. } = watch;
        let steady = moments.and_then(|moments| moments.steady());
        if let Some(fault) = fault {
            return Err(fault);
        }
        let whole = left_out.iter().all(|count| *count == 0) && run.outcome != Outcome::Stopped(Reason::Interrupted);
        let reliable_until_s = match wanted.reliability && whole && run.end_s > 0.0 {
            true => {
                let mut stop = || wanted.stop.load(Ordering::Relaxed);
                solver.reliable_until(&posed.settings, &intervals, run.end_s, &mut stop).map_err(in_scene)?
            }
            false => None,
        };
        drop(solver);
        Ok(Simulation { posed, run, reliable_until_s, intervals, left_out, period_s, steady, course })
    }
}

/// The period of the slowest harmonic load (s).
fn slowest_period_s(posed: &Posed) -> Option<f64> {
    let period_s = |load: &Load| match load.force {
        Force::Harmonic { omega_rad_s, .. } => Some(std::f64::consts::TAU / omega_rad_s),
        _ => None,
    };
    posed.assembly.loads.iter().filter_map(period_s).reduce(f64::max)
}
