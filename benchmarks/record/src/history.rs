//! Every value that was ever recorded, and a figure of the history.

use crate::record::Record;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;
use tasks::Failure;
use vibroimpact::plot::{Axis, Figure, Marker, Panel, Series};

/// One recorded value. A recording adds only the values that changed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Number of the recording, from 1.
    pub recording: u32,
    /// Day of the commit.
    pub date: String,
    /// The commit, with `+` if there were changes on top of it.
    pub commit: String,
    /// Version of the workspace.
    pub version: String,
    /// The compiler.
    pub rustc: String,
    /// Name of the problem.
    pub problem: String,
    /// Name of a cost, `instructions` or `error`.
    pub measure: String,
    /// Its value.
    pub value: f64,
}

/// The date and the commit of a recording.
pub struct Stamp {
    /// Day of the commit.
    pub date: String,
    /// The commit.
    pub commit: String,
}

/// Reads a history, which is empty if there is no file.
pub fn read(path: &Path) -> Result<Vec<Row>, Failure> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    csv::Reader::from_path(path)?.deserialize().map(|row| Ok(row?)).collect()
}

/// Writes a history.
pub fn write(path: &Path, history: &[Row]) -> Result<(), Failure> {
    let mut writer = csv::Writer::from_path(path)?;
    history.iter().try_for_each(|row| writer.serialize(row))?;
    Ok(writer.flush()?)
}

/// Adds the values that changed since the last recording, and returns their number.
pub fn append(history: &mut Vec<Row>, record: &Record, stamp: &Stamp) -> usize {
    let recording = history.last().map_or(1, |row| row.recording + 1);
    let mut last: BTreeMap<(String, String), f64> = BTreeMap::new();
    for row in history.iter() {
        last.insert((row.problem.clone(), row.measure.clone()), row.value);
    }
    let before = history.len();
    for (problem, entry) in &record.problems {
        let costs = entry.costs.iter().map(|(name, &value)| (name.clone(), value as f64));
        let others = [("instructions", entry.instructions.map(|n| n as f64)), ("error", Some(entry.error))];
        let others = others.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?)));
        for (measure, value) in costs.chain(others) {
            if last.get(&(problem.clone(), measure.clone())) != Some(&value) {
                history.push(Row {
                    recording,
                    date: stamp.date.clone(),
                    commit: stamp.commit.clone(),
                    version: env!("CARGO_PKG_VERSION").into(),
                    rustc: record.conditions.rustc.clone(),
                    problem: problem.clone(),
                    measure,
                    value,
                });
            }
        }
    }
    history.len() - before
}

/// The recordings: number, day, commit, compiler.
pub fn recordings(history: &[Row]) -> Vec<&Row> {
    let mut first: Vec<&Row> = Vec::new();
    for row in history {
        if first.last().is_none_or(|last| last.recording != row.recording) {
            first.push(row);
        }
    }
    first
}

/// Plots three histories side by side, each relative to the first recording: counts, instructions and errors.
pub fn figure(history: &[Row], record: &Record) -> Figure {
    let panel = |title: &str, is_shown: &dyn Fn(&str) -> bool| {
        let numbers = Axis::new("recording").integers();
        let mut panel = Panel::new(numbers, Axis::new("relative to the first").log()).title(title).height(170.0);
        for group in groups(record) {
            let (x, y) = course(history, record, &group, is_shown);
            if !x.is_empty() {
                panel = panel.with(Series::line_points(&x, &y, Marker::Circle).label(group));
            }
        }
        panel
    };
    Figure::new("Cost and error since the first recording, geometric means").width(960.0).row([
        panel("steps, iterations, evaluations", &|measure| !["instructions", "error"].contains(&measure)),
        panel("instructions", &|measure| measure == "instructions"),
        panel("error", &|measure| measure == "error"),
    ])
}

/// The first part of the problems' names.
pub fn groups(record: &Record) -> Vec<String> {
    let mut groups: Vec<String> = record.problems.keys().map(|name| group(name).to_owned()).collect();
    groups.dedup();
    groups
}

pub fn group(problem: &str) -> &str {
    problem.split('/').next().unwrap_or(problem)
}

/// For each recording, the geometric mean over a group of the ratio of each value to its first value.
fn course(history: &[Row], record: &Record, of: &str, is_shown: &dyn Fn(&str) -> bool) -> (Vec<f64>, Vec<f64>) {
    let mut first_and_now: BTreeMap<(&str, &str), (f64, f64)> = BTreeMap::new();
    let (mut x, mut y) = (Vec::new(), Vec::new());
    let rows: Vec<&Row> = history.iter().filter(|row| group(&row.problem) == of && is_shown(&row.measure)).collect();
    for recording in recordings(history).into_iter().map(|row| row.recording) {
        for row in rows.iter().filter(|row| row.recording == recording) {
            // zero has no logarithm: counts are at least one here, and errors at least the rounding error
            let least = match record.problems.get(&row.problem) {
                Some(entry) if row.measure == "error" => entry.rounding,
                _ => 1.0,
            };
            let value = row.value.max(least);
            first_and_now.entry((&row.problem, &row.measure)).or_insert((value, value)).1 = value;
        }
        if !first_and_now.is_empty() {
            let logarithms = first_and_now.values().map(|(first, now)| (now / first).ln());
            x.push(f64::from(recording));
            y.push((logarithms.sum::<f64>() / first_and_now.len() as f64).exp());
        }
    }
    (x, y)
}
