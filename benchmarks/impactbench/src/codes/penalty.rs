//! The semi-implicit Euler rule with a fixed step, as in physics engines, with the law of the problem as a penalty. It is not a
//! product: it shows what a page of code can do that uses the law but does not locate its events.

use super::sweep::{Answer, TOO_SLOW, laws, sweep};
use crate::outcome::Outcome;
use crate::problem::Problem;
use crate::system::{System, answers, start};
use std::time::Instant;
use work_precision::measure::Effort;

/// Largest number of ends of branches within a step.
const PASSED: usize = 4;

/// All runs, with steps from a thousandth to a few millionths of the time.
pub(super) fn runs(problem: &Problem, effort: &Effort) -> Vec<Outcome> {
    let Some(laws) = laws(problem).filter(|laws| !laws.is_empty()) else { return Vec::new() };
    let Ok(system) = System::new(problem, &laws) else { return Vec::new() };
    let stride = if effort.quick { 3 } else { 1 };
    let counts = (6..=13).step_by(stride).map(|halves| 10f64.powf(0.5 * f64::from(halves)));
    let steps: Vec<f64> = counts.map(|count| problem.end_s / count.round()).collect();
    sweep(problem, "semi-implicit Euler (own)", &steps, effort, |step_s, deadline| {
        follow(problem, &system, step_s, deadline)
    })
}

fn follow(problem: &Problem, system: &System, step_s: f64, deadline: Instant) -> Answer {
    let mut y = start(problem);
    let n = system.modes();
    let mut states = system.first_states(&y);
    let mut accelerations = vec![0.0; n];
    let count = (problem.end_s / step_s).round() as u64;
    for step in 0..count {
        if step % 1024 == 0 && Instant::now() > deadline {
            return Err(TOO_SLOW.into());
        }
        for c in 0..states.len() {
            for _ in 0..PASSED {
                let margins = system.margins(c, &states[c], &y);
                let Some(which) = (0..2).find(|&which| margins[which] < 0.0) else { break };
                states[c] = system.next(&states[c], c, which, &y);
            }
        }
        system.accelerations(&states, step as f64 * step_s, &y, &mut accelerations);
        for k in 0..n {
            y[n + k] += step_s * accelerations[k];
            y[k] += step_s * y[n + k];
        }
    }
    if y.iter().all(|value| value.is_finite()) { answers(problem, &y) } else { Err("diverged".into()) }
}
