//! The record: cost and error of every problem, and the comparison of two records.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Costs may always grow by this share or by [`COST_COUNTS`], whichever is larger: the last digits of `sin` and `exp` differ
/// between machines, and occasionally such a digit decides whether a step is accepted.
pub const COST_MARGIN: f64 = 0.05;
/// See [`COST_MARGIN`].
pub const COST_COUNTS: u64 = 2;
/// Instructions may grow by this share.
pub const INSTRUCTION_MARGIN: f64 = 0.02;
/// Errors may grow by this factor.
pub const ERROR_FACTOR: f64 = 3.0;

/// Versions and settings on which the number of instructions depends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Conditions {
    /// `rustc --version`.
    pub rustc: String,
    /// The kind of machine.
    pub target: String,
    /// `release` or `debug`.
    pub profile: String,
    /// `valgrind --version`; absent if it is not installed, and then no instructions are counted.
    pub valgrind: Option<String>,
}

/// One problem.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Largest error of the results: relative for results above one in size, absolute below.
    pub error: f64,
    /// Errors up to this size are due to rounding.
    pub rounding: f64,
    /// Costs that the solver counts.
    pub costs: BTreeMap<String, u64>,
    /// Instructions, where they were counted.
    pub instructions: Option<u64>,
}

impl Entry {
    /// The larger of the error and the rounding error.
    pub fn error_above_rounding(&self) -> f64 {
        self.error.max(self.rounding)
    }
}

/// All problems.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// The machine and compiler with which instructions were counted.
    pub conditions: Conditions,
    /// The problems by name.
    pub problems: BTreeMap<String, Entry>,
}

/// Findings of a comparison, each a line that begins with the name of the problem.
#[derive(Debug, Default)]
pub struct Comparison {
    /// Worse by more than the margins, or not comparable.
    pub worse: Vec<String>,
    /// Better by more than the margins.
    pub better: Vec<String>,
    /// Why instructions were not compared, if they were not.
    pub instructions_left_out: Option<String>,
}

/// Compares measurements with the record.
pub fn compare(recorded: &Record, measured: &Record) -> Comparison {
    let mut found =
        Comparison { instructions_left_out: instructions_left_out(recorded, measured), ..Default::default() };
    for (name, now) in &measured.problems {
        match recorded.problems.get(name) {
            Some(then) => compare_entries(name, then, now, &mut found),
            None => found.worse.push(format!("{name}: not in the record")),
        }
    }
    let gone = recorded.problems.keys().filter(|name| !measured.problems.contains_key(*name));
    found.worse.extend(gone.map(|name| format!("{name}: in the record, but no longer measured")));
    found
}

fn instructions_left_out(recorded: &Record, measured: &Record) -> Option<String> {
    let (then, now) = (&recorded.conditions, &measured.conditions);
    if now.valgrind.is_none() {
        return Some("valgrind is not installed".into());
    }
    (then != now).then(|| format!("the record was made with {then}, this is {now}"))
}

impl std::fmt::Display for Conditions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let valgrind = self.valgrind.as_deref().unwrap_or("no valgrind");
        write!(f, "{}, {}, {}, {valgrind}", self.rustc, self.target, self.profile)
    }
}

fn compare_entries(name: &str, then: &Entry, now: &Entry, found: &mut Comparison) {
    let keys: std::collections::BTreeSet<&String> = then.costs.keys().chain(now.costs.keys()).collect();
    for key in keys {
        match (then.costs.get(key), now.costs.get(key)) {
            (Some(&then), Some(&now)) => {
                let margin = COST_COUNTS.max((COST_MARGIN * then as f64) as u64);
                let line = || format!("{name}: {key} {then} -> {now} ({:+.1} %)", percent(then, now));
                if now > then + margin {
                    found.worse.push(format!("{}; allowed: {}", line(), then + margin));
                } else if now + margin < then {
                    found.better.push(line());
                }
            }
            (Some(_), None) => found.worse.push(format!("{name}: {key} is no longer counted")),
            _ => found.worse.push(format!("{name}: {key} is not in the record")),
        }
    }
    if found.instructions_left_out.is_none() {
        match (then.instructions, now.instructions) {
            (Some(then), Some(now)) => {
                let line = || format!("{name}: instructions {then} -> {now} ({:+.1} %)", percent(then, now));
                if percent(then, now) > 100.0 * INSTRUCTION_MARGIN {
                    found.worse.push(format!("{}; allowed: +{} %", line(), 100.0 * INSTRUCTION_MARGIN));
                } else if percent(then, now) < -100.0 * INSTRUCTION_MARGIN {
                    found.better.push(line());
                }
            }
            _ => found.worse.push(format!("{name}: instructions are missing")),
        }
    }
    let allowed = ERROR_FACTOR * then.error_above_rounding();
    let line = || format!("{name}: error {:.1e} -> {:.1e}", then.error, now.error);
    if now.error.is_nan() || now.error > allowed {
        found.worse.push(format!("{}; allowed: {allowed:.1e}", line()));
    } else if ERROR_FACTOR * now.error_above_rounding() < then.error_above_rounding() {
        found.better.push(line());
    }
}

fn percent(then: u64, now: u64) -> f64 {
    100.0 * (now as f64 / (then as f64).max(1.0) - 1.0)
}
