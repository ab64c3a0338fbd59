//! `cargo xtask work-precision`.

use clap::{Parser, Subcommand};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use vibroimpact::report::write_whole;
use work_precision::measure::Effort;
use work_precision::{export, impact, machine, outside, report, run, table};

/// Error against time of every solver of the workspace and of its peers.
#[derive(Parser)]
struct Cli {
    #[command(subcommand)]
    task: Option<Task>,
    /// Fewer settings and shorter repetitions through the same code
    #[arg(long)]
    quick: bool,
    /// Only problems whose name contains this
    #[arg(long, value_name = "PROBLEM")]
    only: Option<String>,
    /// The folder to write to; docs for a whole run, out/work-precision otherwise
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

#[derive(Subcommand)]
enum Task {
    /// Write impacts and quadratic programs as text files for solvers outside Rust
    Export {
        /// The folder to write to
        folder: PathBuf,
    },
}

fn main() -> ExitCode {
    match work(Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn work(cli: Cli) -> Result<(), String> {
    if let Some(Task::Export { folder }) = cli.task {
        return export::write(&impact::library()?, &folder);
    }
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = package.parent().and_then(Path::parent).ok_or("no workspace above the package")?;
    let whole = !cli.quick && cli.only.is_none();
    let out = cli.out.unwrap_or_else(|| root.join(if whole { "docs" } else { "out/work-precision" }));

    let about = machine::describe();
    let effort = if cli.quick { Effort::QUICK } else { Effort::FULL };
    let mut rows = run(cli.only.as_deref(), &effort, |what| eprintln!("{what}"))?;
    if rows.is_empty() {
        return Err(format!("no problem's name contains {:?}", cli.only.unwrap_or_default()));
    }
    let outside = outside::rows(&package.join("outside"))?;
    let versions = outside.map(|(others, versions)| {
        let known: Vec<String> = rows.iter().map(|row| row.problem.clone()).collect();
        rows.extend(others.into_iter().filter(|row| known.contains(&row.problem)));
        versions
    });
    let page = report::report(&rows, &about, versions.as_deref())?;
    let text = |error: std::io::Error| error.to_string();
    write_whole(&out.join("work-precision.csv"), table(&rows)?.as_bytes()).map_err(text)?;
    write_whole(&out.join("work-precision.md"), page.report.markdown().as_bytes()).map_err(text)?;
    for (path, svg) in &page.figures {
        write_whole(&out.join(path), svg.as_bytes()).map_err(text)?;
    }
    println!("{}", out.join("work-precision.md").display());
    Ok(())
}
