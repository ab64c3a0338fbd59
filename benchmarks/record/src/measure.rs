//! Measurements of all problems.

use crate::instructions;
use crate::problem::{Problem, Reference, error, measured_problem};
use crate::record::{Conditions, Entry, Record};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use tasks::{Failure, Progress};

/// True results of the problems that have no closed form.
pub type References = BTreeMap<String, Vec<f64>>;

/// The references of all problems that need one; those that are not among the known ones are computed.
pub fn references(problems: &[Problem], known: &References) -> Result<References, Failure> {
    for_each("references", problems, |problem| match &problem.reference {
        Reference::Exact(_) => Ok(None),
        Reference::Tighter(compute) => known.get(&problem.name).cloned().map_or_else(compute, Ok).map(Some),
    })
}

/// Measures all problems. Instructions are counted if valgrind is installed.
pub fn measure(root: &Path, problems: &[Problem], truth: &References) -> Result<Record, Failure> {
    let conditions = conditions()?;
    let instructions: Vec<Option<u64>> = match conditions.valgrind {
        Some(_) => instructions::count(&root.join("out/callgrind"), problems.len())?.into_iter().map(Some).collect(),
        None => vec![None; problems.len()],
    };
    let mut entries = for_each("measurements", problems, |problem| measure_one(problem, truth).map(Some))?;
    for (problem, instructions) in problems.iter().zip(instructions) {
        if let Some(entry) = entries.get_mut(&problem.name) {
            entry.instructions = instructions;
        }
    }
    Ok(Record { conditions, problems: entries })
}

/// Does something for each problem, which `doing` names in the progress. Returns the results by name, or all failures.
fn for_each<T>(
    doing: &str,
    problems: &[Problem],
    of: impl Fn(&Problem) -> Result<Option<T>, Failure>,
) -> Result<BTreeMap<String, T>, Failure> {
    let (mut all, mut faults) = (BTreeMap::new(), Vec::new());
    let mut progress = Progress::of("problems");
    progress.begin(doing, problems.len() as u64, 0);
    for problem in problems {
        match of(problem) {
            Ok(found) => all.extend(found.map(|found| (problem.name.clone(), found))),
            Err(error) => faults.push(format!("{}: {error}", problem.name)),
        }
        progress.add(1);
    }
    progress.finish();
    if faults.is_empty() { Ok(all) } else { Err(faults.join("\n").into()) }
}

/// Measures one problem without its instructions.
pub fn measure_one(problem: &Problem, truth: &References) -> Result<Entry, Failure> {
    let found = measured_problem(problem)?;
    let reference = match &problem.reference {
        Reference::Exact(values) => values,
        Reference::Tighter(_) => truth.get(&problem.name).ok_or("no reference; cargo xtask bench-record makes one")?,
    };
    Ok(Entry {
        error: error(&found.values, reference)?,
        rounding: problem.rounding,
        costs: found.costs.into_iter().map(|(name, count)| (name.to_owned(), count)).collect(),
        instructions: None,
    })
}

fn conditions() -> Result<Conditions, Failure> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).arg("--version").output()?;
    Ok(Conditions {
        rustc: String::from_utf8(output.stdout)?.trim().to_owned(),
        target: format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
        profile: if cfg!(debug_assertions) { "debug" } else { "release" }.into(),
        valgrind: instructions::valgrind(),
    })
}
