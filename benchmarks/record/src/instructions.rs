//! Instruction counts, by running this program under callgrind.

use crate::problem::measured_problem;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use tasks::Failure;

/// The task that runs every problem once.
pub const RUN_TASK: &str = "bench-run";

/// The version of valgrind, if it is installed.
pub fn valgrind() -> Option<String> {
    let output = Command::new("valgrind").arg("--version").output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Instructions of `count` problems, in the order in which [`RUN_TASK`] runs them. `folder` is emptied and used.
pub fn count(folder: &Path, count: usize) -> Result<Vec<u64>, Failure> {
    if folder.exists() {
        fs::remove_dir_all(folder)?;
    }
    fs::create_dir_all(folder)?;
    // by its full name: callgrind takes no pattern for the dumps
    let measured = std::any::type_name_of_val(&measured_problem);
    let status = Command::new("valgrind")
        .args(["--tool=callgrind", "--quiet"])
        .arg(format!("--callgrind-out-file={}", folder.join("callgrind").display()))
        // callgrind counts only what happens within the function, and writes a file each time the function returns
        .args([format!("--toggle-collect={measured}"), format!("--dump-after={measured}")])
        .arg(std::env::current_exe()?)
        .arg(RUN_TASK)
        .stdout(Stdio::null())
        .status()?;
    if !status.success() {
        return Err(format!("valgrind failed with {status}").into());
    }
    (1..=count).map(|number| total(&folder.join(format!("callgrind.{number}")))).collect()
}

/// Reads the number of instructions from one file.
fn total(path: &Path) -> Result<u64, Failure> {
    let missing = |error| format!("callgrind did not write {}: {error}", path.display());
    let file = fs::File::open(path).map_err(missing)?;
    for line in BufReader::new(file).lines() {
        if let Some(number) = line?.strip_prefix("summary: ") {
            let number: u64 = number.trim().parse()?;
            if number == 0 {
                break;
            }
            return Ok(number);
        }
    }
    Err(format!("{} counts no instructions", path.display()).into())
}
