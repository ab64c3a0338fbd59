//! The workspace's own tasks: `cargo xtask ci` and `cargo xtask reproduce-chapter`.

mod chapters;
mod ci;

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

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
    /// Put the automatic choice of the model to the test: random scenes against a far tighter reference
    StudyAuto {
        /// Fewer scenes through the same code
        #[arg(long)]
        quick: bool,
        /// The folder to write to
        #[arg(long, value_name = "DIR", default_value = "out/study-auto")]
        out: PathBuf,
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
        Task::StudyAuto { quick, out } => print(&chapters::study_auto(&out, quick)?),
    }
}

fn reproduce(chapter: u32, out: &Path, quick: bool, data: Option<&Path>) -> Result<(), Failure> {
    print(&chapters::run(chapter, out, quick, data)?)
}

fn print(summary: &str) -> Result<(), Failure> {
    match writeln!(std::io::stdout(), "{summary}") {
        // a reader that has seen enough is no failure
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
