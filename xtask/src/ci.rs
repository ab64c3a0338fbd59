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

const STEPS: [Step; 4] = [
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
    Step { name: "tests", arguments: &["test", "--workspace", "--all-features", "--locked"], rustdocflags: "" },
];

const FUZZ_TARGETS: [&str; 3] = ["scene", "data_table", "impact"];

/// Runs format, clippy, docs (warnings denied), tests with doc tests, the chapters in their quick form, and at last the
/// fuzzer if there is one.
pub fn run(root: &Path, quick_chapters: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
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
    timed("chapters, quick form", quick_chapters)?;
    fuzz(root)
}

/// Each fuzz target for some seconds, where there is a fuzzer. Without one, the tests above have replayed the corpus.
fn fuzz(root: &Path) -> Result<(), Failure> {
    let fuzzer = || {
        let mut command = Command::new("rustup");
        command.current_dir(root.join("fuzz")).args(["run", "nightly", "cargo", "fuzz"]);
        command
    };
    let there = fuzzer().arg("--version").output().is_ok_and(|output| output.status.success());
    if !there {
        eprintln!("== fuzz: left out, for want of the nightly compiler and cargo-fuzz");
        return Ok(());
    }
    FUZZ_TARGETS.into_iter().try_for_each(|target| {
        timed(&format!("fuzz {target}"), || {
            // no sanitizer: the workspace has no unsafe code; panics and hangs are what is looked for
            let run = ["run", "--sanitizer", "none", target, "--", "-max_total_time=20", "-timeout=20"];
            if fuzzer().args(run).status()?.success() {
                Ok(())
            } else {
                Err(format!("fuzz target {target} failed").into())
            }
        })
    })
}

fn timed(name: &str, work: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
    eprintln!("== {name}");
    let start = Instant::now();
    work()?;
    eprintln!("== {name}: passed in {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}
