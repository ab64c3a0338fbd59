//! Measurement: one run of one solver at one setting, repeated, with its errors and its cost.

use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};

/// The origin of a solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Origin {
    /// Of this workspace.
    Own,
    /// A general solver that does all the work.
    Peer,
    /// A general solver with the workspace's exact free flight between contacts.
    Assisted,
}

/// One solver at one setting on one problem, judged by one norm: a line of the table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the problem.
    pub problem: String,
    /// Name of the solver, including the form in which it is used.
    pub solver: String,
    /// Its origin.
    pub origin: Origin,
    /// The requested tolerance or resolution.
    pub setting: f64,
    /// The norm of `error`.
    pub norm: String,
    /// Distance from the reference; empty if the run failed.
    pub error: Option<f64>,
    /// Shortest wall time of the repeated runs (s).
    pub time_s: Option<f64>,
    /// Deterministic cost.
    pub cost: Option<u64>,
    /// The unit of `cost`.
    pub cost_unit: String,
    /// `ok`, or the reason why there is no result.
    pub status: String,
}

/// The result of one run: its deterministic cost, and its error in every norm.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Deterministic cost.
    pub cost: u64,
    /// Norms with their errors, the chief one first.
    pub errors: Vec<(&'static str, f64)>,
}

/// Limits on the time of a solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// A single run is stopped after this time.
    pub cap: Duration,
    /// Runs are repeated until they have taken this long in total,
    pub budget: Duration,
    /// but no more often than this.
    pub most_runs: usize,
    /// Fewer settings, the same code.
    pub quick: bool,
}

impl Effort {
    /// For the report.
    pub const FULL: Effort =
        Effort { cap: Duration::from_secs(8), budget: Duration::from_millis(150), most_runs: 400, quick: false };
    /// For a test.
    pub const QUICK: Effort =
        Effort { cap: Duration::from_millis(400), budget: Duration::from_millis(5), most_runs: 3, quick: true };

    /// Powers of ten from `10^-first` to `10^-last`; every third of them in a quick run.
    pub fn tolerances(&self, first: i32, last: i32) -> Vec<f64> {
        let stride = if self.quick { 3 } else { 1 };
        (first..=last).step_by(stride).map(|digits| 10f64.powi(-digits)).collect()
    }
}

/// A solver with its name, its origin and the unit of its cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solver<'a> {
    /// Name.
    pub name: &'a str,
    /// Its origin.
    pub origin: Origin,
    /// The unit of the cost.
    pub cost_unit: &'static str,
}

/// Shortest time of one call of `work` over repeated calls. The first is a warm-up and counts only if it alone has used up the
/// budget.
pub fn least_time<T>(effort: &Effort, mut work: impl FnMut() -> T) -> (T, f64) {
    let begin = Instant::now();
    let mut result = work();
    let mut least = begin.elapsed().as_secs_f64();
    if begin.elapsed() < effort.budget {
        least = f64::INFINITY;
    }
    let mut runs = 1;
    while runs < 2 || (begin.elapsed() < effort.budget && runs <= effort.most_runs) {
        if least.is_finite() && begin.elapsed() >= effort.budget {
            break;
        }
        let start = Instant::now();
        result = work();
        least = least.min(start.elapsed().as_secs_f64());
        runs += 1;
    }
    (result, least)
}

/// Runs a solver over its settings, from the loosest to the finest. After a run that took too long the finer settings are not
/// tried, and reported as such.
pub fn sweep(
    problem: &str,
    solver: Solver<'_>,
    settings: &[f64],
    effort: &Effort,
    mut run: impl FnMut(f64) -> Result<Found, String>,
) -> Vec<Row> {
    let mut rows = Vec::new();
    let row = |setting: f64| Row {
        problem: problem.into(),
        solver: solver.name.into(),
        origin: solver.origin,
        setting,
        norm: String::new(),
        error: None,
        time_s: None,
        cost: None,
        cost_unit: solver.cost_unit.into(),
        status: "ok".into(),
    };
    let mut too_slow = false;
    for &setting in settings {
        if too_slow {
            rows.push(Row { status: "not tried: a looser setting took too long".into(), ..row(setting) });
            continue;
        }
        let (result, time) = least_time(effort, || run(setting));
        match result {
            Ok(found) => rows.extend(found.errors.iter().map(|&(norm, error)| Row {
                norm: norm.into(),
                error: Some(error),
                time_s: Some(time),
                cost: Some(found.cost),
                ..row(setting)
            })),
            Err(status) => {
                too_slow = status.starts_with("too slow");
                rows.push(Row { status, ..row(setting) });
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_is_a_row_and_what_follows_a_slow_run_is_not_tried() {
        let solver = Solver { name: "s", origin: Origin::Peer, cost_unit: "calls" };
        let run = |setting: f64| match setting {
            x if x > 0.5 => Ok(Found { cost: 3, errors: vec![("a", 0.1), ("b", 0.2)] }),
            x if x > 0.2 => Err("step too small".to_string()),
            _ => Err("too slow: over 1 s".to_string()),
        };
        let rows = sweep("p", solver, &[1.0, 0.3, 0.1, 0.01], &Effort::QUICK, run);
        let told: Vec<(&str, Option<f64>)> = rows.iter().map(|row| (row.status.as_str(), row.error)).collect();
        assert_eq!(
            told,
            [
                ("ok", Some(0.1)),
                ("ok", Some(0.2)),
                ("step too small", None),
                ("too slow: over 1 s", None),
                ("not tried: a looser setting took too long", None),
            ]
        );
        assert!(rows[0].time_s.is_some_and(|time| time >= 0.0));
    }

    #[test]
    fn the_least_time_is_that_of_a_later_run() {
        let mut calls = 0;
        let slow_first = || {
            calls += 1;
            std::thread::sleep(Duration::from_millis(if calls == 1 { 40 } else { 1 }));
        };
        let effort = Effort { budget: Duration::from_millis(200), most_runs: 20, ..Effort::QUICK };
        let ((), least) = least_time(&effort, slow_first);
        assert!(least < 0.03, "{least}");
    }
}
