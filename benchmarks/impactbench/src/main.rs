//! `cargo xtask impactbench`.

use clap::{Parser, Subcommand};
use impactbench::{codes, library, outcome, problem::Problem, report};
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;
use vibroimpact::report::write_whole;
use work_precision::machine;
use work_precision::measure::Effort;

/// A benchmark of impact for any code.
#[derive(Parser)]
struct Cli {
    #[command(subcommand)]
    task: Option<Task>,
    /// Fewer settings and shorter repetitions through the same code; writes to out/impactbench
    #[arg(long)]
    quick: bool,
    /// Only problems whose name contains this; writes to out/impactbench
    #[arg(long, value_name = "PROBLEM")]
    only: Option<String>,
}

#[derive(Subcommand)]
enum Task {
    /// Make the files of the problems and their references anew
    Problems,
    /// Write the page from the results that are there
    Report,
}

fn main() -> ExitCode {
    match work(&Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn work(cli: &Cli) -> Result<(), String> {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = package.parent().and_then(Path::parent).ok_or("no workspace above the package")?;
    let folder = package.join("problems");
    if let Some(Task::Problems) = cli.task {
        for problem in library::problems()? {
            let text = serde_json::to_string_pretty(&problem).map_err(|error| error.to_string())?;
            write(&folder.join(format!("{}.json", problem.name)), &(text + "\n"))?;
        }
        return Ok(());
    }
    let problems = Problem::read_all(&folder)?;
    let whole = !cli.quick && cli.only.is_none();
    let (results, docs) = match whole {
        true => (package.join("results"), root.join("docs")),
        false => (root.join("out/impactbench"), root.join("out/impactbench")),
    };
    if cli.task.is_none() {
        let about = machine::describe();
        let effort = if cli.quick {
            Effort::QUICK
        } else {
            // Short repetitions, as there are thousands of runs.
            Effort { cap: Duration::from_secs(2), budget: Duration::from_millis(50), ..Effort::FULL }
        };
        let wanted = |problem: &&Problem| cli.only.as_ref().is_none_or(|only| problem.name.contains(only));
        let mut outcomes = Vec::new();
        for problem in problems.iter().filter(wanted) {
            eprintln!("{}", problem.name);
            outcomes.extend(codes::run_all(problem, &effort));
        }
        write(&results.join("rust.csv"), &outcome::table(&outcomes)?)?;
        write(&results.join("rust.txt"), &format!("{about}\n"))?;
    }
    let page = report::page(&problems, &outcome::read_all(&results)?, &report::machines(&results)?)?;
    write(&docs.join("impactbench.md"), &page.text)?;
    for (path, svg) in &page.figures {
        write(&docs.join(path), svg)?;
    }
    println!("{}", docs.join("impactbench.md").display());
    Ok(())
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    write_whole(path, text.as_bytes()).map_err(|error| format!("{}: {error}", path.display()))
}
