//! Runs every check that a change must pass before it is merged, the quickest checks first.

use std::error::Error;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::time::Instant;
use std::{fs, io};

#[cfg(test)]
mod circles;
#[cfg(test)]
mod features;
#[cfg(test)]
mod lock_files;
#[cfg(test)]
mod packed_files;
#[cfg(test)]
mod test_files;
#[cfg(test)]
mod workflows;

type Failure = Box<dyn Error>;

/// One call of cargo: its arguments, where `FEATURES` and `PUBLISHED` stand for features and packages that are found out, and the
/// flags for rustdoc.
struct Step {
    name: &'static str,
    arguments: &'static [&'static str],
    rustdocflags: &'static str,
}

/// Every step except the first two builds all features of the workspace except `mpi`, which needs an MPI library. The second
/// step checks only the libraries, without sweeps, pictures and the program.
const STEPS: [Step; 7] = [
    Step { name: "format", arguments: &["fmt", "--all", "--check"], rustdocflags: "" },
    Step {
        // beside third parties that give the libraries the features of the other steps, so that these use what is compiled here; the
        // job `alone` of ci.yml checks the library with its own features
        name: "lints of the libraries",
        arguments: &[
            "clippy",
            "--package",
            "vibroimpact",
            "--package",
            "third-parties",
            "--lib",
            "--no-default-features",
            "--locked",
            "--",
            "-D",
            "warnings",
        ],
        rustdocflags: "",
    },
    Step {
        // without the tests, which take as long again
        name: "lints",
        arguments: &["clippy", "--workspace", "--locked", "FEATURES", "--", "-D", "warnings"],
        rustdocflags: "",
    },
    Step {
        name: "lints of tests, examples and benches",
        arguments: &["clippy", "--workspace", "--all-targets", "--locked", "FEATURES", "--", "-D", "warnings"],
        rustdocflags: "",
    },
    Step {
        name: "docs",
        arguments: &["doc", "--workspace", "--no-deps", "--locked", "FEATURES"],
        rustdocflags: "-D warnings",
    },
    Step {
        // checks that each crate can be packed; the job `alone` of ci.yml also builds the packages
        name: "packages",
        arguments: &["package", "--quiet", "PUBLISHED", "--no-verify", "--allow-dirty", "--locked"],
        rustdocflags: "",
    },
    Step { name: "tests", arguments: &["test", "--workspace", "--locked", "FEATURES"], rustdocflags: "" },
];

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}

/// Runs format, clippy, docs (warnings denied), packaging, tests with doc tests (sweeps over MPI among them where it is
/// installed); one of the tests reproduces all chapters in their quick form.
fn run() -> Result<(), Failure> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).ok_or("no workspace above xtask/ci")?;
    let mpi = MPI_PROGRAMS.into_iter().all(is_installed);
    if !mpi {
        eprintln!("== sweeps over MPI: not tested, since {} are not all installed", MPI_PROGRAMS.join(", "));
    }
    STEPS.iter().try_for_each(|step| timed(step.name, || carry_out(step, root, mpi)))
}

/// Programs that the `mpi` feature needs to be built and tested. `clang` is looked for because libclang is installed with it.
const MPI_PROGRAMS: [&str; 3] = ["mpicc", "mpirun", "clang"];

fn is_installed(program: &str) -> bool {
    let tried = Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    tried.is_ok_and(|status| status.success())
}

fn carry_out(step: &Step, root: &Path, mpi: bool) -> Result<(), Failure> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.current_dir(root);
    for argument in step.arguments {
        match *argument {
            "FEATURES" if mpi => command.args(["--features", "vibroimpact/mpi"]),
            "FEATURES" => &mut command,
            "PUBLISHED" => command.args(published(root)?.iter().map(|name| format!("--package={name}"))),
            argument => command.arg(argument),
        };
    }
    if !step.rustdocflags.is_empty() {
        command.env("RUSTDOCFLAGS", step.rustdocflags);
    }
    let status = command.status()?;
    if status.success() { Ok(()) } else { Err(format!("{command:?} failed").into()) }
}

/// The packages that are published: those in `crates`, in folders of their names.
fn published(root: &Path) -> io::Result<Vec<String>> {
    let entries = fs::read_dir(root.join("crates"))?.collect::<io::Result<Vec<_>>>()?;
    let packages = entries.iter().filter(|entry| entry.path().join("Cargo.toml").is_file());
    let mut names: Vec<String> = packages.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    Ok(names)
}

fn timed(name: &str, work: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
    eprintln!("== {name}");
    let start = Instant::now();
    work()?;
    eprintln!("== {name}: passed in {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}
