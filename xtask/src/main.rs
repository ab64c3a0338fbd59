//! The workspace's own tasks: `cargo xtask ci`, `cargo xtask reproduce-chapter` and `cargo xtask work-precision`.

mod chapters;
mod ci;

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use chapters::{BadInput, Failure};
use clap::{Parser, Subcommand};

/// The chapters that can be reproduced.
const CHAPTERS: [u32; 6] = [2, 3, 4, 6, 7, 8];

/// Keeps the house, and reproduces the chapters of the thesis.
#[derive(Parser)]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Check everything: format, clippy, docs, tests, and the chapters in their quick form
    Ci,
    /// Compute a chapter anew: CSV tables, SVG figures, and a report of the thesis's numbers beside ours
    ReproduceChapter {
        /// The chapter: 2, 3, 4, 6, 7 or 8
        chapter: u32,
        /// Fewer points through the same code
        #[arg(long)]
        quick: bool,
        /// The folder to write to; out/chapter-N when left out
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Chapter 8: measured points to fit as well (CSV: length_m, angle_deg, restitution)
        #[arg(long, value_name = "FILE")]
        data: Option<PathBuf>,
    },
    /// Measure error against time of every solver and of its peers: docs/work-precision.md, with figures and a table
    WorkPrecision {
        /// Fewer settings through the same code
        #[arg(long)]
        quick: bool,
        /// Only problems whose name contains this
        #[arg(long, value_name = "PROBLEM")]
        only: Option<String>,
        /// The folder to write to; docs for a whole run, out/work-precision otherwise
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

fn main() -> ExitCode {
    match run(Cli::parse().task) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            // 2 for input that cannot be used, as in the program itself
            if failure.is::<BadInput>() { ExitCode::from(2) } else { ExitCode::FAILURE }
        }
    }
}

fn run(task: Task) -> Result<(), Failure> {
    match task {
        Task::Ci => {
            let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().ok_or("no workspace above xtask")?;
            ci::run(root, || {
                CHAPTERS.into_iter().try_for_each(|chapter| {
                    let out = root.join(format!("out/ci/chapter-{chapter}"));
                    reproduce(chapter, &out, true, None)
                })
            })
        }
        Task::ReproduceChapter { chapter, quick, out, data } => {
            let out = out.unwrap_or_else(|| PathBuf::from(format!("out/chapter-{chapter}")));
            reproduce(chapter, &out, quick, data.as_deref())
        }
        Task::WorkPrecision { quick, only, out } => work_precision(quick, only.as_deref(), out.as_deref()),
    }
}

/// Runs the package of that name, which this one does not depend on: its peers take minutes to compile.
fn work_precision(quick: bool, only: Option<&str>, out: Option<&Path>) -> Result<(), Failure> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["run", "--release", "--quiet", "--package", "work-precision", "--"]);
    command.args(quick.then_some("--quick"));
    command.args(only.into_iter().flat_map(|only| ["--only", only]));
    if let Some(out) = out {
        command.arg("--out").arg(out);
    }
    if command.status()?.success() { Ok(()) } else { Err("work-precision failed".into()) }
}

fn reproduce(chapter: u32, out: &Path, quick: bool, data: Option<&Path>) -> Result<(), Failure> {
    let summary = chapters::run(chapter, out, quick, data)?;
    match writeln!(std::io::stdout(), "{summary}") {
        // a reader that has seen enough is no failure
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
