//! Development tasks: checks, the chapters of the thesis, studies, and the record of cost and error.

mod book;
mod chapters;
mod examples;
mod fuzz;
mod pages;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::str::FromStr;

use chapters::Part;
use clap::{Args, Parser, Subcommand};
use tasks::{BadInput, Failure, ended, say};

/// Development tasks: checks, benchmarks, chapters of the thesis.
#[derive(Parser)]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Check the book: links, commands, scenes, and the chapters' numbers against a run of them
    Book {
        /// Write the chapters' tables and figures from a run instead of checking them
        #[arg(long)]
        write: bool,
    },
    /// Run the example programs of the crates
    Examples {
        /// Run the examples outside the workspace, each of which uses one crate alone
        #[arg(long)]
        alone: bool,
    },
    /// Measure cost and error of every solver, and write the record, its history and its page
    #[command(disable_help_flag = true)]
    BenchRecord(Passed),
    /// Measure, and fail where cost or error is worse than recorded
    #[command(disable_help_flag = true)]
    BenchCheck(Passed),
    /// Reproduce a chapter of the thesis: CSV tables, SVG figures, and a report that compares its numbers with ours
    ReproduceChapter {
        /// The chapter: 2 to 8; `ensemble` for chapter 4 with varied unstated parameters; `theories` for chapters 3, 4 and 7
        /// by Timoshenko's theory; `all` for the whole thesis in one report
        chapter: Chapters,
        /// Compute fewer points, with the same code
        #[arg(long)]
        quick: bool,
        /// The folder to write to [default: out/chapter-N or out/all]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// For chapter 8, measured points that are fitted too (CSV: length_m, angle_deg, restitution)
        #[arg(long, value_name = "FILE")]
        data: Option<PathBuf>,
    },
    /// Run every fuzz target; needs a nightly compiler and cargo-fuzz
    Fuzz {
        /// Time for each target (s)
        #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..))]
        seconds: u32,
    },
    /// Solve random impacts far outside the usual range: no panic, no NaN, no energy gained, no hang
    #[command(disable_help_flag = true)]
    Soak(Passed),
    /// Measure error against time of every solver and of its peers: docs/work-precision.md, with figures and a table
    #[command(disable_help_flag = true)]
    WorkPrecision(Passed),
    /// Run impactbench for the codes in Rust, and write docs/impactbench.md from the results of all codes
    #[command(disable_help_flag = true)]
    Impactbench(Passed),
    /// Test the automatic choice of the model: random scenes against a far more accurate reference
    #[command(disable_help_flag = true)]
    StudyAuto(Passed),
    /// Fit the scatter of the law of energy minimisation, and test its intervals on beams left out
    StudyScatter {
        /// Compute fewer points, with the same code
        #[arg(long)]
        quick: bool,
        /// The folder to write to
        #[arg(long, value_name = "DIR", default_value = "out/study-scatter")]
        out: PathBuf,
    },
    /// Test identification: random tables of synthetic measurements with noise
    #[command(disable_help_flag = true)]
    StudyIdentify(Passed),
    /// Test derivatives: random impacts against differences of an independent solution in 32 digits
    #[command(disable_help_flag = true)]
    StudyDerivatives(Passed),
    /// Measure the gain of a control variate from derivatives over plain draws of uncertain fields
    #[command(disable_help_flag = true)]
    StudyControl(Passed),
}

/// Arguments for the program of another package, which has its own help.
#[derive(Args)]
struct Passed {
    /// Arguments of that program; --help lists them
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<OsString>,
}

fn main() -> ExitCode {
    ended(run(Cli::parse().task))
}

fn run(task: Task) -> Result<(), Failure> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().ok_or("no workspace above xtask")?;
    match task {
        Task::Book { write: true } => pages::write(root),
        Task::Book { write: false } => book::run(root).and_then(|()| pages::check(root)),
        Task::Examples { alone: false } => examples::of_crates(root),
        Task::Examples { alone: true } => examples::alone(root),
        Task::BenchRecord(passed) => package(root, "record", Some("bench-record"), &passed),
        Task::BenchCheck(passed) => package(root, "record", Some("bench-check"), &passed),
        Task::ReproduceChapter { chapter, quick, out, data } => {
            let out = out.unwrap_or_else(|| match chapter {
                Chapters::All => PathBuf::from("out/all"),
                Chapters::One(part) => Path::new("out").join(part.folder()),
            });
            reproduce(chapter, &out, quick, data.as_deref())
        }
        Task::Fuzz { seconds } => fuzz::run(root, seconds),
        Task::Soak(passed) => package(root, "studies", Some("soak"), &passed),
        Task::WorkPrecision(passed) => package(root, "work-precision", None, &passed),
        Task::Impactbench(passed) => package(root, "impactbench", None, &passed),
        Task::StudyAuto(passed) => package(root, "studies", Some("study-auto"), &passed),
        Task::StudyScatter { quick, out } => say(&chapters::study_scatter(&out, quick)?),
        Task::StudyIdentify(passed) => package(root, "studies", Some("study-identify"), &passed),
        Task::StudyDerivatives(passed) => package(root, "studies", Some("study-derivatives"), &passed),
        Task::StudyControl(passed) => package(root, "studies", Some("study-control"), &passed),
    }
}

/// Continues as the program of another package. It is not a dependency of this one, so that neither waits for the other's
/// dependencies to compile.
fn package(root: &Path, name: &str, command: Option<&str>, passed: &Passed) -> Result<(), Failure> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut program = Command::new(cargo);
    program.args(["run", "--release", "--package", name, "--manifest-path"]).arg(root.join("Cargo.toml"));
    program.arg("--").args(command).args(&passed.arguments);
    become_program(&mut program)
}

/// Replaces this process, so that signals reach the program and its exit code is ours.
#[cfg(unix)]
fn become_program(program: &mut Command) -> Result<(), Failure> {
    use std::os::unix::process::CommandExt;
    Err(program.exec().into())
}

/// Runs the program, and ends with its exit code.
#[cfg(not(unix))]
fn become_program(program: &mut Command) -> Result<(), Failure> {
    std::process::exit(program.status()?.code().unwrap_or(1))
}

/// Arguments of `reproduce-chapter`.
#[derive(Clone, Copy)]
enum Chapters {
    All,
    One(Part),
}

impl FromStr for Chapters {
    type Err = BadInput;

    fn from_str(text: &str) -> Result<Chapters, BadInput> {
        if text == "all" { Ok(Chapters::All) } else { text.parse().map(Chapters::One) }
    }
}

fn reproduce(chapter: Chapters, out: &Path, quick: bool, data: Option<&Path>) -> Result<(), Failure> {
    say(&match chapter {
        Chapters::All => chapters::run_all(out, quick, data)?,
        Chapters::One(part) => chapters::run(part, out, quick, data)?.study.summary,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_and_help_of_other_packages_are_passed_on() {
        for command in ["soak", "study-auto", "bench-record", "work-precision", "impactbench"] {
            let parsed = Cli::try_parse_from(["xtask", command, "--impacts", "3", "--help"]);
            let Ok(Cli {
                task:
                    Task::Soak(passed)
                    | Task::StudyAuto(passed)
                    | Task::BenchRecord(passed)
                    | Task::WorkPrecision(passed)
                    | Task::Impactbench(passed),
            }) = parsed
            else {
                panic!("{command}")
            };
            assert_eq!(passed.arguments, ["--impacts", "3", "--help"]);
        }
    }
}
