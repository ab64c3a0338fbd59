//! Sweeps as a user meets them: from a file to a folder, with interruptions.

mod bodies;
mod bytes;
mod definition;
mod files;
mod parts;
mod resume;
mod uncertain;
mod uncertain_bodies;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::{Value, json};
use tempfile::TempDir;

/// A structure of three modes, which is cheap to solve.
fn scene() -> Value {
    json!({
        "structure": { "kind": "modal", "omega_rad_s": [120, 700, 2100], "shape_at_location": [1.1, -0.7, 0.9],
                       "damping_ratios": [0.02, 0.02, 0.02] },
        "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 }
    })
}

/// 600 points in 4 dimensions, a sixth of which fail.
fn sweep() -> Value {
    json!({
        "description": "A test",
        "scene": scene(),
        "vary": [
            { "field": "striker.mass_kg", "from": 0.01, "to": 1, "count": 10, "scale": "log" },
            { "field": "modes", "values": [1, 3, 4] }
        ],
        "random": { "seed": 5, "draws": 20, "fields": [
            { "field": "striker.speed_m_s", "from": 0.1, "to": 10, "scale": "log" },
            { "field": "structure.shape_at_location[1]", "from": -1, "to": 1 }
        ] }
    })
}

/// A folder with a sweep file in it.
struct Bench(TempDir);

impl Bench {
    fn new(sweep: &Value) -> Bench {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("sweep.json"), sweep.to_string()).unwrap();
        Bench(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_vibroimpact"));
        command.current_dir(self.0.path()).args(arguments);
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs the program, which must succeed, and returns what it prints.
    fn succeeds(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs the program, which must reject its input without output on the standard output, and returns the message.
    fn refuses(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(output.stdout.is_empty());
        assert!(!message.contains("panicked"), "{message}");
        message
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|fault| panic!("{name}: {fault}"))
    }

    fn rows(&self, folder: &str) -> Vec<csv::StringRecord> {
        csv::Reader::from_reader(&self.read(&format!("{folder}/results.csv"))[..])
            .records()
            .map(Result::unwrap)
            .collect()
    }
}

/// Every file of a folder and its subfolders, by name, without the lock.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        if entry.file_type().unwrap().is_dir() {
            found.extend(files(&entry.path()).into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else if name != "lock" {
            found.push((name, fs::read(entry.path()).unwrap()));
        }
    }
    found.sort();
    found
}

/// Checks that two folders contain the same files, to the byte.
fn assert_same(a: &Path, b: &Path) {
    let (a, b) = (files(a), files(b));
    let names = |files: &[(String, Vec<u8>)]| files.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&a), names(&b));
    for ((name, a), (_, b)) in a.iter().zip(&b) {
        assert!(a == b, "{name} differs");
    }
}
