//! The codes in Rust, each with its settings, from the loosest to the tightest.

mod diffsol;
mod dop853;
mod net;
mod own;
mod penalty;
mod phases;

use crate::outcome::Outcome;
use crate::problem::Problem;
use contact_models::Law;
use std::time::Instant;
use work_precision::measure::{Effort, least_time};

pub use diffsol::solve as diffsol;
pub use dop853::solve as dop853;
pub use own::assembly as own_assembly;

/// An answer, or why there is none.
pub type Answer = Result<Vec<f64>, String>;

/// Every run of every code on a problem.
pub fn run_all(problem: &Problem, effort: &Effort) -> Vec<Outcome> {
    let all = [own::runs, net::runs, dop853::runs, diffsol::runs, penalty::runs];
    all.into_iter().flat_map(|runs| runs(problem, effort)).collect()
}

/// The laws of the contacts; none if a restitution is requested in their place.
fn laws(problem: &Problem) -> Option<Vec<Law>> {
    problem.contacts.iter().map(|contact| contact.law.law().ok().flatten()).collect()
}

/// Runs a code over its settings. After a run that took too long no tighter setting is tried.
fn sweep(
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

/// Why a run was stopped.
const TOO_SLOW: &str = "too slow";
