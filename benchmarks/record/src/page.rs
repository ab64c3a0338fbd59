//! The page of the record.

use crate::history::{Row, group, groups, recordings};
use crate::record::{COST_COUNTS, COST_MARGIN, ERROR_FACTOR, Entry, INSTRUCTION_MARGIN, Record};
use std::fmt::Write;

/// Writes the page `docs/benchmarks.md`.
pub fn page(record: &Record, history: &[Row]) -> String {
    let mut text = format!(
        "# Costs over time

This page records what the solvers cost and how accurate they are, so that a change for the worse is noticed. A fixed list of
problems is solved. Steps, iterations, evaluations and instructions are counted, and results are compared with references.
No clock is read, so the figures are the same on a busy machine and on an idle one. `cargo xtask bench-check`, which the
workflow runs, fails if

- a count has grown by more than {cost:.0} % and by more than {counts},
- instructions have grown by more than {instructions:.0} % (compared where compiler, target, profile and valgrind are those
  of the record),
- an error has grown to more than {factor} times the recorded one, or {factor} times rounding if that is more,
- a problem was added or removed, or this page does not show the record.

After an intended change, `cargo xtask bench-record` writes the record (`benchmarks/record.json`), adds the values that
changed to `benchmarks/history.csv`, and makes this page and its figure. Times differ from machine to machine. Criterion
(`cargo bench`) measures them, and they are compared for every pull request as information.

The error of a problem is the largest error of its results, relative if the reference is above one in size and absolute
otherwise. References are closed forms, multiple precision, or runs with a tighter tolerance in `benchmarks/references.json`.
A problem on modes consists of five impacts at speeds from 0.8 to 1.25 m/s, at the tolerance that ends its name.

The instructions were counted for {conditions}.

",
        cost = 100.0 * COST_MARGIN,
        counts = COST_COUNTS,
        instructions = 100.0 * INSTRUCTION_MARGIN,
        factor = ERROR_FACTOR,
        conditions = record.conditions,
    );
    for name in groups(record) {
        let entries: Vec<(&str, &Entry)> = record
            .problems
            .iter()
            .filter(|(problem, _)| group(problem) == name)
            .map(|(problem, entry)| (problem.get(name.len() + 1..).unwrap_or(problem), entry))
            .collect();
        table(&mut text, &name, &entries);
    }
    text.push_str("## History\n\n![Cost and error since the first recording](benchmarks/history.svg)\n\n");
    text.push_str("| recording | date | commit | version | compiler |\n|---|---|---|---|---|\n");
    for row in recordings(history) {
        let _ =
            writeln!(text, "| {} | {} | `{}` | {} | {} |", row.recording, row.date, row.commit, row.version, row.rustc);
    }
    text
}

fn table(text: &mut String, name: &str, entries: &[(&str, &Entry)]) {
    let costs: std::collections::BTreeSet<&str> =
        entries.iter().flat_map(|(_, entry)| entry.costs.keys().map(String::as_str)).collect();
    let _ = write!(text, "## {name}\n\n| problem | error | instructions |");
    for cost in &costs {
        let _ = write!(text, " {} |", cost.replace('_', " "));
    }
    let _ = writeln!(text, "\n|---|---|---|{}", "---|".repeat(costs.len()));
    for (problem, entry) in entries {
        let instructions = entry.instructions.map_or_else(|| "-".into(), |n| format!("{:.3} M", n as f64 / 1e6));
        let error = if entry.error == 0.0 { "0".into() } else { format!("{:.1e}", entry.error) };
        let _ = write!(text, "| {problem} | {error} | {instructions} |");
        for cost in &costs {
            let _ = write!(text, " {} |", entry.costs.get(*cost).map_or_else(|| "-".into(), u64::to_string));
        }
        text.push('\n');
    }
    text.push('\n');
}
