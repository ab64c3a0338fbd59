//! Runs the example programs. Each must succeed and print something.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tasks::Failure;

fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo")))
}

/// Runs the examples of the workspace's crates with the profile of the tests, so that nothing is built twice. The workspace's own
/// packages request every feature but `mpi`, which needs an MPI library.
pub fn of_crates(root: &Path) -> Result<(), Failure> {
    let output = cargo()
        .current_dir(root)
        .args(["build", "--workspace", "--examples", "--locked", "--profile", "test"])
        .arg("--message-format=json-render-diagnostics")
        .stderr(Stdio::inherit())
        .output()?;
    if !output.status.success() {
        return Err("the examples do not build".into());
    }
    let mut programs: Vec<PathBuf> = Vec::new();
    for line in String::from_utf8(output.stdout)?.lines() {
        let message: serde_json::Value = serde_json::from_str(line)?;
        let is_example = message["target"]["kind"].as_array().is_some_and(|kinds| kinds.iter().any(|k| k == "example"));
        if let (true, Some(program)) = (is_example, message["executable"].as_str()) {
            programs.push(program.into());
        }
    }
    programs.sort();
    if programs.is_empty() {
        return Err("no examples found".into());
    }
    programs.iter().try_for_each(|program| run(&program.display().to_string(), &mut Command::new(program)))
}

/// Runs the programs in `examples/`, each a package of its own outside the workspace, and their tests.
pub fn alone(root: &Path) -> Result<(), Failure> {
    let mut manifests: Vec<PathBuf> = Vec::new();
    for entry in fs::read_dir(root.join("examples"))? {
        let manifest = entry?.path().join("Cargo.toml");
        if manifest.is_file() {
            manifests.push(manifest);
        }
    }
    manifests.sort();
    if manifests.is_empty() {
        return Err("no packages in examples/".into());
    }
    for manifest in &manifests {
        for task in ["run", "test"] {
            let mut command = cargo();
            command.args([task, "--quiet", "--manifest-path"]).arg(manifest);
            // one target folder for all examples, so that common dependencies are built once
            if std::env::var_os("CARGO_TARGET_DIR").is_none() {
                command.env("CARGO_TARGET_DIR", root.join("target/examples"));
            }
            run(&manifest.display().to_string(), &mut command)?;
        }
    }
    Ok(())
}

fn run(name: &str, command: &mut Command) -> Result<(), Failure> {
    let output = command.stderr(Stdio::inherit()).output()?;
    if !output.status.success() {
        return Err(format!("{name} failed with {}", output.status).into());
    }
    if output.stdout.trim_ascii().is_empty() {
        return Err(format!("{name} printed nothing").into());
    }
    eprintln!(
        "   {name}: {} lines",
        output.stdout.split(|byte| *byte == b'\n').filter(|line| !line.is_empty()).count()
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failing_and_silent_programs_are_refused() {
        let shell = |script: &str| run("program", Command::new("sh").args(["-c", script]));
        assert!(shell("echo 1").is_ok());
        assert!(shell("echo 1; exit 3").unwrap_err().to_string().contains("program failed"));
        assert!(shell("echo").unwrap_err().to_string().contains("program printed nothing"));
    }
}
