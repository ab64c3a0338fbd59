//! The program, run in a folder.

use std::path::Path;
use std::process::{Command, Output};

pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_vibroimpact")).current_dir(folder).args(arguments).output().unwrap()
}

/// The output of a run that must succeed without warnings.
pub fn stdout(output: &Output) -> String {
    let complaints = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && complaints.is_empty(), "{complaints}");
    String::from_utf8(output.stdout.clone()).unwrap()
}
