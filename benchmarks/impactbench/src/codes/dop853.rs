//! The explicit eighth-order pair of Dormand and Prince with its dense output: a general solver that is given the
//! equations phase by phase and finds the events itself.

use super::{Answer, TOO_SLOW, laws, sweep};
use crate::outcome::Outcome;
use crate::problem::Problem;
use crate::system::{State, System, answers, start};
use contact_models::Law;
use ivp::dense::StepInterpolant;
use ivp::methods::{DOP853, Tolerance};
use ivp::prelude::{ControlFlag, FirstOrderSystem};
use ivp::solout::SolOut;
use std::time::Instant;
use work_precision::measure::Effort;

/// Most changes of phase.
const MOST_PHASES: usize = 20_000;

/// All runs.
pub(super) fn runs(problem: &Problem, effort: &Effort) -> Vec<Outcome> {
    let Some(laws) = laws(problem).filter(|laws| !laws.is_empty()) else { return Vec::new() };
    sweep(problem, "DOP853", &effort.tolerances(4, 14), effort, |tolerance, deadline| {
        solve(problem, &laws, tolerance, deadline)
    })
}

/// The answer at a tolerance.
///
/// # Errors
/// Why it could not go on.
pub fn solve(problem: &Problem, laws: &[Law], tolerance: f64, deadline: Instant) -> Answer {
    let system = System::new(problem, laws)?;
    let mut y = start(problem);
    let mut states = system.first_states(&y);
    let tolerances = tolerances(problem, &system, &y, tolerance);
    let mut time_s = 0.0;
    for _ in 0..MOST_PHASES {
        let phase = Phase::new(&system, &states, time_s, &y);
        let mut watch = Watch { phase: &phase, met: None, now: (0.0, y.clone()), late: false, deadline };
        let closed = states.iter().any(|state| matches!(state, State::Closed(_)));
        // the force begins as a power 3/2 of time, which error estimates do not see
        let first_step = closed.then(|| (1e-3 * problem.end_s * tolerance.powf(0.4)).min(problem.end_s - time_s));
        let solver = DOP853 {
            dense_output: true,
            max_steps: 10_000_000,
            stiff_test: usize::MAX,
            first_step,
            ..DOP853::default()
        };
        let (rtol, atol) = (Tolerance::Scalar(0.0), Tolerance::Vector(tolerances.clone()));
        // time is counted from the start of the phase, so that short steps are not lost in it
        let found = solver.solve(&phase, 0.0, &y, problem.end_s - time_s, rtol, atol, Some(&mut watch));
        let status = found.map_err(|error| error.to_string())?.status;
        if !status.is_success() {
            return Err(format!("{status:?}"));
        }
        let Watch { met, now, late, .. } = watch;
        if late {
            return Err(TOO_SLOW.into());
        }
        time_s += now.0;
        y = now.1;
        let Some((contact, which)) = met else { return answers(problem, &y) };
        states[contact] = system.next(&states[contact], contact, which, &y);
        if time_s >= problem.end_s {
            return answers(problem, &y);
        }
    }
    Err(format!("more than {MOST_PHASES} events"))
}

/// Absolute tolerances that let every component add alike: speeds to the fastest, displacements to what it covers in the
/// time that matters to them.
fn tolerances(problem: &Problem, system: &System, y: &[f64], tolerance: f64) -> Vec<f64> {
    let rates = &y[system.modes()..];
    let driven = system.driven(problem.end_s);
    let speed = rates.iter().map(|rate| rate * rate).sum::<f64>().sqrt().max(driven).max(1e-30);
    let displacement = |k: usize| tolerance * speed * (1.0 / system.omega(k)).min(0.01 * problem.end_s);
    (0..system.modes()).map(displacement).chain(rates.iter().map(|_| tolerance * speed)).collect()
}

/// The equations while no contact changes.
struct Phase<'a> {
    system: &'a System,
    states: &'a [State],
    /// When the phase begins (s).
    start_s: f64,
    /// Subtracted from the margins: a phase that begins beyond its own end by a rounding does not end there.
    offsets: Vec<[f64; 2]>,
}

impl Phase<'_> {
    fn new<'a>(system: &'a System, states: &'a [State], start_s: f64, y: &[f64]) -> Phase<'a> {
        let offset = |(c, state)| system.margins(c, state, y).map(|margin| margin.min(0.0));
        Phase { system, states, start_s, offsets: states.iter().enumerate().map(offset).collect() }
    }

    fn margin(&self, contact: usize, which: usize, y: &[f64]) -> f64 {
        self.system.margins(contact, &self.states[contact], y)[which] - self.offsets[contact][which]
    }
}

impl FirstOrderSystem for Phase<'_> {
    fn derivative(&self, time_s: f64, y: &[f64], dy: &mut [f64]) {
        let (amplitudes, rates) = dy.split_at_mut(self.system.modes());
        amplitudes.copy_from_slice(&y[self.system.modes()..]);
        self.system.accelerations(self.states, self.start_s + time_s, y, rates);
    }
}

/// Looks for the first end of the phase in each step.
struct Watch<'a> {
    phase: &'a Phase<'a>,
    met: Option<(usize, usize)>,
    now: (f64, Vec<f64>),
    late: bool,
    deadline: Instant,
}

impl SolOut for Watch<'_> {
    fn solout(
        &mut self,
        before: f64,
        x: &mut f64,
        y: &mut [f64],
        interpolant: Option<&StepInterpolant<'_>>,
    ) -> ControlFlag {
        self.late = Instant::now() > self.deadline;
        let mut inside = vec![0.0; y.len()];
        let mut end = *x;
        for contact in 0..self.phase.states.len() {
            for which in 0..2 {
                let (Some(interpolant), true) = (interpolant, self.phase.margin(contact, which, y) < 0.0) else {
                    continue;
                };
                let (mut low, mut high) = (before, *x);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    interpolant.interpolate(middle, &mut inside);
                    *(if self.phase.margin(contact, which, &inside) < 0.0 { &mut high } else { &mut low }) = middle;
                }
                if self.met.is_none() || high < end {
                    (end, self.met) = (high, Some((contact, which)));
                }
            }
        }
        self.now.0 = end;
        match (self.met, interpolant) {
            (Some(_), Some(interpolant)) => interpolant.interpolate(end, &mut self.now.1),
            _ => self.now.1.copy_from_slice(y),
        }
        if self.met.is_some() || self.late { ControlFlag::Interrupt } else { ControlFlag::Continue }
    }
}
