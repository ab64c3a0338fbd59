//! The record of what the solvers cost and how far off they are.
//!
//! A fixed list of problems is solved. Steps, iterations, evaluations and instructions are counted, and results are compared with
//! references. No clock is read, so that a deviation is always a change of the program.
//!
//! | command | what it does |
//! |---|---|
//! | `cargo xtask bench-record` | measures, and writes the record, its history, its figure and its page (`docs/benchmarks.md`) |
//! | `cargo xtask bench-check` | measures, and fails where cost or error is worse than recorded |
//!
//! `list` puts the problems together from those of `impacts` and `leaves`; `measure` runs them, and `instructions` runs this
//! program under callgrind. `record` compares two records.

mod files;
mod history;
mod impacts;
mod instructions;
mod leaves;
mod list;
mod measure;
mod page;
mod problem;
mod record;

use clap::{Parser, Subcommand};
use files::{Files, read, write};
use history::Stamp;
use list::{problems, run_all};
use measure::{References, measure, references};
use record::{Comparison, Record, compare};
use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode};
use tasks::{Failure, ended};

/// The record of what the solvers cost and how far off they are.
#[derive(Parser)]
#[command(bin_name = "cargo xtask")]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Measure cost and error of every solver, and write the record, its history and its page
    #[command(name = "bench-record")]
    Record {
        /// Compute the references anew as well
        #[arg(long)]
        references: bool,
    },
    /// Measure, and fail where cost or error is worse than recorded
    #[command(name = "bench-check")]
    Check,
    /// Run every problem of the record once, for callgrind
    #[command(hide = true, name = instructions::RUN_TASK)]
    Run,
}

fn main() -> ExitCode {
    ended(run(Cli::parse().task))
}

fn run(task: Task) -> Result<(), Failure> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).ok_or("no workspace above the package")?;
    match task {
        Task::Record { references } => record(root, references),
        Task::Check => check(root),
        Task::Run => run_all(root),
    }
}

/// Measures all problems, and writes the record, its history, the page and the figure. With `anew` all reference results are
/// computed; without it only the missing ones.
fn record(root: &Path, anew: bool) -> Result<(), Failure> {
    let files = Files::of(&root.join("docs"));
    let problems = problems(root)?;
    let kept: References =
        if anew || !files.references.exists() { References::new() } else { read(&files.references)? };
    let truth = references(&problems, &kept)?;
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
fn check(root: &Path) -> Result<(), Failure> {
    let files = Files::of(&root.join("docs"));
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

#[cfg(test)]
mod tests;
