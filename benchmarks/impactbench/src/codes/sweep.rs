//! Common parts of all codes: the laws of a problem, and runs over the settings.

use crate::outcome::Outcome;
use crate::problem::Problem;
use contact_models::Law;
use std::time::Instant;
use work_precision::measure::{Effort, least_time};

/// A result, or the reason why there is none.
pub type Answer = Result<Vec<f64>, String>;

/// The laws of the contacts; `None` if a restitution is requested in their place.
pub(super) fn laws(problem: &Problem) -> Option<Vec<Law>> {
    problem.contacts.iter().map(|contact| contact.law.law().ok().flatten()).collect()
}

/// Runs a code over its settings. After a run that took too long no finer setting is tried.
pub(super) fn sweep(
    problem: &Problem,
    code: &str,
    settings: &[f64],
    effort: &Effort,
    run: impl Fn(f64, Instant) -> Answer,
) -> Vec<Outcome> {
    let mut outcomes = Vec::new();
    for &setting in settings {
        let (answer, time_s) = least_time(effort, || run(setting, Instant::now() + effort.cap));
        let row = |time_s, status: &str, values: String| Outcome {
            problem: problem.name.clone(),
            code: code.into(),
            setting,
            time_s,
            status: status.into(),
            values,
        };
        match answer {
            Ok(values) => {
                let values: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
                outcomes.push(row(Some(time_s), "ok", values.join(" ")));
            }
            Err(status) => {
                outcomes.push(row(None, &status, String::new()));
                if status == TOO_SLOW {
                    break;
                }
            }
        }
    }
    outcomes
}

/// The reason why a run was stopped.
pub(super) const TOO_SLOW: &str = "too slow";
