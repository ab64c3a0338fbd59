//! The BDF of variable order of `diffsol`, with an exact Jacobian. It integrates the equations phase by phase, and events are
//! located on its dense output. Its own root finding misses an event function that is zero at the start of a phase, as those of
//! balls that touch are.

use super::phases::{End, Phase, follow};
use super::sweep::{Answer, TOO_SLOW, laws, sweep};
use crate::outcome::Outcome;
use crate::problem::Problem;
use contact_models::Law;
use diffsol::{DiffsolError, NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason, Vector};
use std::time::Instant;
use work_precision::measure::Effort;

/// All runs.
pub(super) fn runs(problem: &Problem, effort: &Effort) -> Vec<Outcome> {
    let Some(laws) = laws(problem).filter(|laws| !laws.is_empty()) else { return Vec::new() };
    sweep(problem, "diffsol, BDF", &effort.tolerances(4, 12), effort, |tolerance, deadline| {
        solve(problem, &laws, tolerance, deadline)
    })
}

/// The result at a tolerance.
///
/// # Errors
/// The reason why it could not continue.
pub fn solve(problem: &Problem, laws: &[Law], tolerance: f64, deadline: Instant) -> Answer {
    follow(problem, laws, tolerance, |phase, tolerances, y| {
        let first_s = phase.first_step_s(tolerance).unwrap_or(1e-5 * phase.left_s);
        advance(phase, tolerances, first_s, y, deadline)
    })
}

/// Advances the state to the end of a phase.
fn advance(
    phase: &Phase<'_>,
    tolerances: &[f64],
    first_s: f64,
    y: &mut [f64],
    deadline: Instant,
) -> Result<End, String> {
    let text = |error: DiffsolError| error.to_string();
    let start = y.to_vec();
    let equations = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(1e-14)
        .atol(tolerances.iter().copied())
        .h0(first_s)
        .rhs_implicit(
            |y: &[f64], _: &[f64], time_s: f64, dy: &mut [f64]| phase.derivative(time_s, y, dy),
            |y: &[f64], _: &[f64], _: f64, v: &[f64], jv: &mut [f64]| {
                let (amplitudes, rates) = jv.split_at_mut(phase.system.modes());
                amplitudes.copy_from_slice(&v[phase.system.modes()..]);
                phase.system.jacobian_times(phase.states, y, v, rates);
            },
        )
        .init(|_: &[f64], _: f64, y: &mut [f64]| y.copy_from_slice(&start), start.len())
        .build()
        .map_err(text)?;
    let mut solver = equations.bdf::<NalgebraLU<f64>>().map_err(text)?;
    solver.set_stop_time(phase.left_s).map_err(text)?;
    let mut before_s = 0.0;
    loop {
        let reason = solver.step().map_err(text)?;
        let time_s = solver.state().t;
        y.copy_from_slice(&solver.state().y.clone_as_vec());
        let at = |time_s: f64, inside: &mut [f64]| {
            inside.copy_from_slice(&solver.interpolate(time_s).map_err(text)?.clone_as_vec());
            Ok::<_, String>(())
        };
        if let Some(end) = phase.first_end((before_s, time_s), y, at)? {
            y.copy_from_slice(&solver.interpolate(end.0).map_err(text)?.clone_as_vec());
            return Ok(end);
        }
        if let OdeSolverStopReason::TstopReached = reason {
            return Ok((time_s, None));
        }
        if Instant::now() > deadline {
            return Err(TOO_SLOW.into());
        }
        before_s = time_s;
    }
}
