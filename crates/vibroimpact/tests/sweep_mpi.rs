//! Sweeps over several ranks on one machine: `cargo test -p vibroimpact --features mpi --test sweep_mpi`.

#![cfg(feature = "mpi")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

use serde_json::{Value, json};

/// A sweep in which every third scene fails.
fn sweep(draws: u64) -> Value {
    json!({
        "scene": {
            "structure": { "kind": "modal", "omega_rad_s": [120, 700, 2100], "shape_at_location": [1.1, -0.7, 0.9],
                           "damping_ratios": [0.02, 0.02, 0.02] },
            "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
            "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 }
        },
        "vary": [{ "field": "striker.mass_kg", "from": 0.01, "to": 1, "count": 10, "scale": "log" },
                 { "field": "modes", "values": [1, 3, 4] }],
        "random": { "seed": 5, "draws": draws, "fields": [{ "field": "striker.speed_m_s", "from": 0.1, "to": 10 }] }
    })
}

fn over_ranks(folder: &Path, ranks: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new("mpirun");
    // As many ranks as requested, for any machine and user.
    command.args(["--allow-run-as-root", "--oversubscribe", "-n", ranks, env!("CARGO_BIN_EXE_vibroimpact")]);
    command.args(arguments).current_dir(folder).env("OMPI_MCA_rmaps_base_oversubscribe", "1");
    command
}

fn run(folder: &Path, ranks: &str, out: &str) -> Output {
    over_ranks(folder, ranks, &["sweep", "sweep.json", "--out", out, "--mpi", "--quiet"]).output().unwrap()
}

fn alone(folder: &Path) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibroimpact"));
    let output =
        command.current_dir(folder).args(["sweep", "sweep.json", "--out", "alone", "--quiet"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

fn assert_same(folder: &Path, out: &str) {
    for file in ["results.csv", "results.parquet", "summary.json", "report.html", "progress.json", "sweep.json"] {
        let read = |out: &str| fs::read(folder.join(out).join(file)).unwrap_or_else(|fault| panic!("{file}: {fault}"));
        assert!(read(out) == read("alone"), "{file} differs");
    }
}

#[test]
fn any_number_of_ranks_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("sweep.json"), sweep(20).to_string()).unwrap();
    alone(folder.path());
    for ranks in ["1", "2", "4"] {
        let output = run(folder.path(), ranks, ranks);
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{message}");
        assert_same(folder.path(), ranks);
        let printed = String::from_utf8_lossy(&output.stdout);
        assert_eq!(printed.matches("400 rebound").count(), 1, "one rank tells: {printed}");
    }
    // A finished sweep is reported, and nothing is computed.
    let output = run(folder.path(), "3", "4");
    assert!(String::from_utf8_lossy(&output.stdout).contains("nothing; all points were done"));
}

#[test]
fn ranks_continue_a_killed_job() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("sweep.json"), sweep(600).to_string()).unwrap();
    alone(folder.path());
    let arguments = ["sweep", "sweep.json", "--out", "killed", "--mpi", "--quiet"];
    for attempt in 0..3 {
        let mut job =
            over_ranks(folder.path(), "3", &arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        sleep(Duration::from_millis(500 + 150 * attempt));
        // The ranks of a killed mpirun end by themselves, and only then can the folder be used again.
        let _ = job.kill();
        job.wait().unwrap();
        sleep(Duration::from_millis(500));
    }
    let mut output = run(folder.path(), "3", "killed");
    for _ in 0..20 {
        if output.status.success() {
            break;
        }
        sleep(Duration::from_millis(250));
        output = run(folder.path(), "3", "killed");
    }
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_same(folder.path(), "killed");
}

#[test]
fn an_invalid_sweep_ends_every_rank() {
    let folder = tempfile::tempdir().unwrap();
    let mut bad = sweep(20);
    bad["vary"][0]["field"] = json!("striker.mas_kg");
    fs::write(folder.path().join("sweep.json"), bad.to_string()).unwrap();
    let output = run(folder.path(), "3", "out");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("vary[0].field = \"striker.mas_kg\""));
    assert!(!folder.path().join("out").exists());
}
