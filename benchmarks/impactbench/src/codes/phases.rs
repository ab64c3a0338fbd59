//! A problem in the form for general solvers: phase by phase. In a phase no contact changes, so that the equations are smooth;
//! it ends where an event function becomes negative.

use super::sweep::Answer;
use crate::problem::Problem;
use crate::system::{State, System, answers, start};
use contact_models::Law;

/// Largest number of changes of phase.
const MOST_PHASES: usize = 20_000;

/// The end of a phase: its time, counted from the start of the phase (s), and the contact that reaches one of its ends.
pub(super) type End = (f64, Option<(usize, usize)>);

/// The equations while no contact changes.
pub(super) struct Phase<'a> {
    pub system: &'a System,
    pub states: &'a [State],
    /// Start of the phase (s).
    pub start_s: f64,
    /// Remaining time of the problem (s).
    pub left_s: f64,
    /// Subtracted from the event functions, so that a phase that begins beyond its own end by rounding does not end there.
    offsets: Vec<[f64; 2]>,
}

impl Phase<'_> {
    /// A first step that is short enough; `None` if the equations determine it. The force begins as a power 3/2 of time, which
    /// error estimates do not detect.
    pub fn first_step_s(&self, tolerance: f64) -> Option<f64> {
        let closed = self.states.iter().any(|state| matches!(state, State::Closed(_)));
        closed.then(|| (1e-3 * (self.start_s + self.left_s) * tolerance.powf(0.4)).min(self.left_s))
    }

    /// The rates of the state, at a time from the start of the phase.
    pub fn derivative(&self, time_s: f64, y: &[f64], dy: &mut [f64]) {
        let (amplitudes, rates) = dy.split_at_mut(self.system.modes());
        amplitudes.copy_from_slice(&y[self.system.modes()..]);
        self.system.accelerations(self.states, self.start_s + time_s, y, rates);
    }

    /// The first end between two times, the first of which is within the phase, by bisection on a solver's dense output.
    pub fn first_end<E>(
        &self,
        (before_s, after_s): (f64, f64),
        y_after: &[f64],
        mut at: impl FnMut(f64, &mut [f64]) -> Result<(), E>,
    ) -> Result<Option<End>, E> {
        let mut inside = vec![0.0; y_after.len()];
        let mut found: Option<End> = None;
        for contact in 0..self.states.len() {
            for which in 0..2 {
                if self.margin(contact, which, y_after) >= 0.0 {
                    continue;
                }
                let (mut low, mut high) = (before_s, after_s);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    at(middle, &mut inside)?;
                    *(if self.margin(contact, which, &inside) < 0.0 { &mut high } else { &mut low }) = middle;
                }
                if found.is_none_or(|(end_s, _)| high < end_s) {
                    found = Some((high, Some((contact, which))));
                }
            }
        }
        Ok(found)
    }

    fn margin(&self, contact: usize, which: usize, y: &[f64]) -> f64 {
        self.system.margins(contact, &self.states[contact], y)[which] - self.offsets[contact][which]
    }
}

/// The result of a solver that advances the state to the end of a phase, or to that of the problem, with these absolute
/// tolerances.
pub(super) fn follow(
    problem: &Problem,
    laws: &[Law],
    tolerance: f64,
    mut advance: impl FnMut(&Phase<'_>, &[f64], &mut [f64]) -> Result<End, String>,
) -> Answer {
    let system = System::new(problem, laws)?;
    let mut y = start(problem);
    let mut states = system.first_states(&y);
    let tolerances = tolerances(problem, &system, &y, tolerance);
    let mut time_s = 0.0;
    for _ in 0..MOST_PHASES {
        let offset = |(c, state)| system.margins(c, state, &y).map(|margin| margin.min(0.0));
        let offsets = states.iter().enumerate().map(offset).collect();
        let phase =
            Phase { system: &system, states: &states, start_s: time_s, left_s: problem.end_s - time_s, offsets };
        let (elapsed_s, met) = advance(&phase, &tolerances, &mut y)?;
        time_s += elapsed_s;
        let Some((contact, which)) = met else { return answers(problem, &y) };
        states[contact] = system.next(&states[contact], contact, which, &y);
        if time_s >= problem.end_s {
            return answers(problem, &y);
        }
    }
    Err(format!("more than {MOST_PHASES} events"))
}

/// Absolute tolerances for which every component contributes equally: for velocities relative to the fastest, for displacements
/// relative to its distance travelled in the relevant time.
fn tolerances(problem: &Problem, system: &System, y: &[f64], tolerance: f64) -> Vec<f64> {
    let rates = &y[system.modes()..];
    let driven = system.driven(problem.end_s);
    let speed = rates.iter().map(|rate| rate * rate).sum::<f64>().sqrt().max(driven).max(1e-30);
    let displacement = |k: usize| tolerance * speed * (1.0 / system.omega(k)).min(0.01 * problem.end_s);
    (0..system.modes()).map(displacement).chain(rates.iter().map(|_| tolerance * speed)).collect()
}
