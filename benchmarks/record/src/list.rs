//! The fixed list of problems.

use crate::problem::{Problem, measured_problem};
use crate::{impacts, leaves};
use std::collections::BTreeSet;
use std::path::Path;
use tasks::Failure;

/// All problems, each with a name of its own.
pub fn problems(root: &Path) -> Result<Vec<Problem>, Failure> {
    let mut problems = impacts::on_modes(root)?;
    problems.extend(impacts::on_infinite_structures());
    problems.extend(leaves::modes(root)?);
    problems.extend(leaves::laws()?);
    problems.extend(leaves::net_restitution());
    problems.extend(leaves::fits());
    problems.extend(leaves::fractional());
    problems.extend(leaves::scenes(root)?);
    let mut names = BTreeSet::new();
    match problems.iter().find(|problem| !names.insert(&problem.name)) {
        Some(twice) => Err(format!("two problems are called {}", twice.name).into()),
        None => Ok(problems),
    }
}

/// Runs every problem once under callgrind.
pub fn run_all(root: &Path) -> Result<(), Failure> {
    problems(root)?.iter().try_for_each(|problem| measured_problem(problem).map(|_| ()))
}
