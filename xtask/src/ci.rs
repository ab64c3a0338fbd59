//! Everything that must hold before a change goes in, in the order in which it fails soonest.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use crate::chapters::Failure;

/// One call of cargo: its arguments, and the flags for rustdoc.
struct Step {
    name: &'static str,
    arguments: &'static [&'static str],
    rustdocflags: &'static str,
}

const STEPS: [Step; 5] = [
    Step { name: "format", arguments: &["fmt", "--all", "--check"], rustdocflags: "" },
    Step {
        name: "clippy",
        arguments: &["clippy", "--workspace", "--all-targets", "--all-features", "--locked", "--", "-D", "warnings"],
        rustdocflags: "",
    },
    Step {
        name: "docs",
        arguments: &["doc", "--workspace", "--all-features", "--no-deps", "--locked"],
        rustdocflags: "-D warnings",
    },
    Step {
        // that each crate can be packed; the job `alone` of ci.yml builds the packages as well
        name: "packages",
        arguments: &[
            "package",
            "--quiet",
            "--workspace",
            "--exclude",
            "xtask",
            "--no-verify",
            "--allow-dirty",
            "--locked",
        ],
        rustdocflags: "",
    },
    Step { name: "tests", arguments: &["test", "--workspace", "--all-features", "--locked"], rustdocflags: "" },
];

/// Something of our own that must not fail, with its name.
pub type Check<'a> = (&'a str, &'a dyn Fn() -> Result<(), Failure>);

/// Runs format, clippy, docs (warnings denied), packaging, tests with doc tests, and at last our own checks.
pub fn run(root: &Path, checks: &[Check]) -> Result<(), Failure> {
    for step in &STEPS {
        timed(step.name, || {
            let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
            let mut command = Command::new(cargo);
            command.current_dir(root).args(step.arguments);
            if !step.rustdocflags.is_empty() {
                command.env("RUSTDOCFLAGS", step.rustdocflags);
            }
            let status = command.status()?;
            if status.success() { Ok(()) } else { Err(format!("cargo {} failed", step.arguments.join(" ")).into()) }
        })?;
    }
    checks.iter().try_for_each(|(name, check)| timed(name, check))
}

fn timed(name: &str, work: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
    eprintln!("== {name}");
    let start = Instant::now();
    work()?;
    eprintln!("== {name}: passed in {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}
