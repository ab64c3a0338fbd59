//! The workspace's own tasks: `cargo xtask ci` and `cargo xtask reproduce-chapter`.

mod chapters;
mod ci;

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::str::FromStr;

use chapters::{BadInput, Failure};
use clap::{Parser, Subcommand};

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
        /// The chapter: 2, 3, 4, 6, 7 or 8, or `all` for the whole thesis and one report
        chapter: Chapters,
        /// Fewer points through the same code
        #[arg(long)]
        quick: bool,
        /// The folder to write to; out/chapter-N, or out/all, when left out
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Chapter 8: measured points to fit as well (CSV: length_m, angle_deg, restitution)
        #[arg(long, value_name = "FILE")]
        data: Option<PathBuf>,
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
            ci::run(root, || reproduce(Chapters::All, &root.join("out/ci"), true, None))
        }
        Task::ReproduceChapter { chapter, quick, out, data } => {
            let out = out.unwrap_or_else(|| match chapter {
                Chapters::All => PathBuf::from("out/all"),
                Chapters::One(number) => PathBuf::from(format!("out/chapter-{number}")),
            });
            reproduce(chapter, &out, quick, data.as_deref())
        }
    }
}

/// What `reproduce-chapter` is asked for.
#[derive(Clone, Copy)]
enum Chapters {
    All,
    One(u32),
}

impl FromStr for Chapters {
    type Err = BadInput;

    fn from_str(text: &str) -> Result<Chapters, BadInput> {
        let known = |number: &u32| chapters::CHAPTERS.contains(number);
        match text {
            "all" => Ok(Chapters::All),
            _ => text.parse().ok().filter(known).map(Chapters::One).ok_or_else(|| BadInput::chapter(text)),
        }
    }
}

fn reproduce(chapter: Chapters, out: &Path, quick: bool, data: Option<&Path>) -> Result<(), Failure> {
    let summary = match chapter {
        Chapters::All => chapters::run_all(out, quick, data)?,
        Chapters::One(number) => chapters::run(number, out, quick, data)?.summary,
    };
    match writeln!(std::io::stdout(), "{summary}") {
        // a reader that has seen enough is no failure
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
