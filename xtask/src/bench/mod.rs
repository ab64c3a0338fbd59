//! The record of cost and error of the solvers. `cargo xtask bench-record` writes it, and `cargo xtask bench-check` compares
//! new measurements with it.

mod history;
mod impacts;
mod instructions;
mod leaves;
mod page;
mod problem;
mod record;

use history::Stamp;
pub use instructions::RUN_TASK;
use problem::{Problem, Reference, error, measured_problem};
use record::{Comparison, Conditions, Entry, Record, compare};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tasks::{Failure, Progress};

/// True results of the problems that have no closed form.
type References = BTreeMap<String, Vec<f64>>;

/// The files of the record.
struct Files {
    record: PathBuf,
    references: PathBuf,
    history: PathBuf,
    figure: PathBuf,
    page: PathBuf,
}

impl Files {
    fn of(docs: &Path) -> Files {
        let file = |name: &str| docs.join("benchmarks").join(name);
        Files {
            record: file("record.json"),
            references: file("references.json"),
            history: file("history.csv"),
            figure: file("history.svg"),
            page: docs.join("benchmarks.md"),
        }
    }
}

/// The fixed list of problems.
fn problems(root: &Path) -> Result<Vec<Problem>, Failure> {
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

/// Measures all problems, and writes the record, its history, the page and the figure. With `references` all reference results
/// are computed anew; without it only the missing ones.
pub fn record(root: &Path, references: bool) -> Result<(), Failure> {
    let files = Files::of(&root.join("docs"));
    let problems = problems(root)?;
    let kept: References =
        if references || !files.references.exists() { References::new() } else { read(&files.references)? };
    let truth: References = for_each("references", &problems, |problem| match &problem.reference {
        Reference::Exact(_) => Ok(None),
        Reference::Tighter(compute) => kept.get(&problem.name).cloned().map_or_else(compute, Ok).map(Some),
    })?;
    let measured = measure(root, &problems, &truth)?;
    if measured.conditions.valgrind.is_none() {
        eprintln!("valgrind is not installed: the record has no instructions");
    }
    fs::create_dir_all(root.join("docs/benchmarks"))?;
    if files.record.exists() {
        // an unreadable record must not prevent writing a new one
        match read(&files.record) {
            Ok(recorded) => tell(&compare(&recorded, &measured)),
            Err(error) => eprintln!("{error}"),
        }
    }
    let mut rows = history::read(&files.history)?;
    let changed = history::append(&mut rows, &measured, &stamp(root));
    write(&files.references, &truth)?;
    write(&files.record, &measured)?;
    history::write(&files.history, &rows)?;
    history::figure(&rows, &measured).write(&files.figure)?;
    fs::write(&files.page, page::page(&measured, &rows))?;
    println!("{} problems recorded, {changed} values changed: {}", problems.len(), files.page.display());
    Ok(())
}

/// Measures all problems, and fails if cost or error is worse than recorded.
pub fn check(root: &Path) -> Result<(), Failure> {
    check_against(root, &root.join("docs"))
}

fn check_against(root: &Path, docs: &Path) -> Result<(), Failure> {
    let files = Files::of(docs);
    let recorded: Record = read(&files.record)?;
    let problems = problems(root)?;
    let measured = measure(root, &problems, &read(&files.references)?)?;
    let found = compare(&recorded, &measured);
    tell(&found);
    if !found.worse.is_empty() {
        return Err(format!(
            "{} regressions against {}:\n  {}\nIf this is meant: cargo xtask bench-record",
            found.worse.len(),
            files.record.display(),
            found.worse.join("\n  ")
        )
        .into());
    }
    if fs::read_to_string(&files.page)? != page::page(&recorded, &history::read(&files.history)?) {
        return Err(format!("{} does not show the record: cargo xtask bench-record", files.page.display()).into());
    }
    println!("{} problems: no regression", problems.len());
    Ok(())
}

fn tell(found: &Comparison) {
    if let Some(reason) = &found.instructions_left_out {
        eprintln!("instructions not compared: {reason}");
    }
    if !found.better.is_empty() {
        eprintln!("better than the record; cargo xtask bench-record keeps it:\n  {}", found.better.join("\n  "));
    }
}

fn measure(root: &Path, problems: &[Problem], truth: &References) -> Result<Record, Failure> {
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

/// Results of the problems that have one, by name; or a list of all problems that failed.
/// Does something for each problem; `doing` names it while it goes on.
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

fn measure_one(problem: &Problem, truth: &References) -> Result<Entry, Failure> {
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

/// Date and commit, if git knows them.
fn stamp(root: &Path) -> Stamp {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").current_dir(root).args(arguments).output().ok().filter(|o| o.status.success());
        output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let unknown = || "unknown".to_owned();
    let dirty = git(&["status", "--porcelain", "--untracked-files=no"]).is_some_and(|changes| !changes.is_empty());
    let commit = git(&["rev-parse", "--short=9", "HEAD"]).unwrap_or_else(unknown);
    Stamp {
        date: git(&["show", "-s", "--format=%cs", "HEAD"]).unwrap_or_else(unknown),
        commit: if dirty { commit + "+" } else { commit },
    }
}

fn read<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, Failure> {
    let hint =
        |error: &dyn std::fmt::Display| format!("{}: {error}; cargo xtask bench-record writes it", path.display());
    let text = fs::read_to_string(path).map_err(|error| hint(&error))?;
    serde_json::from_str(&text).map_err(|error| hint(&error).into())
}

fn write<T: serde::Serialize>(path: &Path, value: &T) -> Result<(), Failure> {
    Ok(fs::write(path, serde_json::to_string_pretty(value)? + "\n")?)
}

#[cfg(test)]
mod tests;
