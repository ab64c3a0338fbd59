//! Everything that must hold before a change goes in, in the order in which it fails soonest.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use crate::chapters::Failure;

/// One call of cargo: its arguments, and the flags for rustdoc.
struct Step {
    name: &'static str,
    arguments: &'static [&'static str],
    rustdocflags: &'static str,
}

// the features that are on by default are all but `mpi`, which needs more than Rust
const STEPS: [Step; 4] = [
    Step { name: "format", arguments: &["fmt", "--all", "--check"], rustdocflags: "" },
    Step {
        name: "clippy",
        arguments: &["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"],
        rustdocflags: "",
    },
    Step { name: "docs", arguments: &["doc", "--workspace", "--no-deps", "--locked"], rustdocflags: "-D warnings" },
    Step { name: "tests", arguments: &["test", "--workspace", "--locked"], rustdocflags: "" },
];

/// Where MPI and what its bindings are built with are found.
const MPI_STEPS: [Step; 2] = [
    Step {
        name: "clippy with MPI",
        arguments: &[
            "clippy",
            "-p",
            "vibroimpact",
            "--features",
            "mpi",
            "--all-targets",
            "--locked",
            "--",
            "-D",
            "warnings",
        ],
        rustdocflags: "",
    },
    Step {
        name: "sweeps over MPI",
        arguments: &["test", "-p", "vibroimpact", "--features", "mpi", "--test", "sweep_mpi", "--locked"],
        rustdocflags: "",
    },
];

/// Runs format, clippy, docs (warnings denied), tests with doc tests, sweeps over MPI where it is installed, and at last
/// the chapters in their quick form.
pub fn run(root: &Path, quick_chapters: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
    STEPS.iter().try_for_each(|step| carry_out(step, root))?;
    if MPI_PROGRAMS.into_iter().all(is_installed) {
        MPI_STEPS.iter().try_for_each(|step| carry_out(step, root))?;
    } else {
        eprintln!("== sweeps over MPI: left out, {} are not all installed", MPI_PROGRAMS.join(", "));
    }
    timed("chapters, quick form", quick_chapters)
}

/// What the `mpi` feature is built and tested with; clang stands for its library.
const MPI_PROGRAMS: [&str; 3] = ["mpicc", "mpirun", "clang"];

fn is_installed(program: &str) -> bool {
    let tried = Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    tried.is_ok_and(|status| status.success())
}

fn carry_out(step: &Step, root: &Path) -> Result<(), Failure> {
    timed(step.name, || {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut command = Command::new(cargo);
        command.current_dir(root).args(step.arguments);
        if !step.rustdocflags.is_empty() {
            command.env("RUSTDOCFLAGS", step.rustdocflags);
        }
        let status = command.status()?;
        if status.success() { Ok(()) } else { Err(format!("cargo {} failed", step.arguments.join(" ")).into()) }
    })
}

fn timed(name: &str, work: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
    eprintln!("== {name}");
    let start = Instant::now();
    work()?;
    eprintln!("== {name}: passed in {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}
