//! An interrupted sweep continues, with nothing lost and nothing doubled.

use super::*;
use std::io::Write;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

/// Some thousand points: seconds of work.
fn long_sweep() -> Value {
    let mut sweep = super::sweep();
    sweep["random"]["draws"] = json!(400);
    sweep
}

fn points_done(bench: &Bench, folder: &str) -> u64 {
    let Ok(text) = fs::read_to_string(bench.path(folder).join("progress.json")) else { return 0 };
    serde_json::from_str::<Value>(&text).unwrap()["chunks"].as_u64().unwrap()
}

#[test]
fn killed_at_any_time_it_continues_to_the_same_bytes() {
    let bench = Bench::new(&long_sweep());
    bench.succeeds(&["sweep", "sweep.json", "--out", "whole", "--quiet"]);
    let arguments = ["sweep", "sweep.json", "--out", "killed", "--threads", "2", "--quiet"];
    let mut done = 0;
    let mut advances = 0;
    for attempt in 0..12u64 {
        let mut child = bench.command(&arguments).stdout(Stdio::null()).spawn().unwrap();
        // Times spread over the whole run, the first within the start of the program.
        sleep(Duration::from_millis(2 + attempt * attempt * 4 + attempt * 7919 % 40));
        let _ = child.kill();
        child.wait().unwrap();
        let now = points_done(&bench, "killed");
        assert!(now >= done, "what was done is lost");
        advances += u32::from(now > done);
        done = now;
    }
    assert!(advances > 0, "killed too early to tell");
    bench.succeeds(&arguments);
    assert_same(&bench.path("whole"), &bench.path("killed"));
}

/// The states of a folder in which a sweep was killed before its first rows: the folder alone, with the lock, with a part of the
/// record, with the record, and with a part of the header.
#[test]
fn a_sweep_killed_as_it_begins_continues() {
    let bench = Bench::new(&super::sweep());
    bench.succeeds(&["sweep", "sweep.json", "--out", "whole", "--quiet"]);
    let record = bench.read("whole/sweep.json");
    let header = bench.read("whole/results.csv")[..40].to_vec();
    let states: [&[(&str, &[u8])]; 6] = [
        &[],
        &[("lock", &[])],
        &[("lock", &[]), ("sweep.part", &record[..100])],
        &[("lock", &[]), ("sweep.json", &record)],
        &[("lock", &[]), ("sweep.json", &record), ("results.csv", &header)],
        &[("lock", &[]), ("sweep.json", &record), ("results.csv", &header), ("progress.part", b"{")],
    ];
    for (i, state) in states.into_iter().enumerate() {
        let out = format!("out-{i}");
        fs::create_dir(bench.path(&out)).unwrap();
        for (name, bytes) in state {
            fs::write(bench.path(&out).join(name), bytes).unwrap();
        }
        bench.succeeds(&["sweep", "sweep.json", "--out", &out, "--quiet"]);
        assert_same(&bench.path("whole"), &bench.path(&out));
    }
}

#[test]
fn a_torn_line_is_dropped() {
    let bench = Bench::new(&super::sweep());
    bench.succeeds(&["sweep", "sweep.json", "--out", "whole", "--quiet"]);
    bench.succeeds(&["sweep", "sweep.json", "--out", "torn", "--quiet"]);
    // As if interrupted while the rows of the second half were being written.
    let all = bench.read("torn/results.csv");
    let half = all.iter().enumerate().filter(|(_, byte)| **byte == b'\n').nth(300).unwrap().0 + 1;
    let mut progress: Value = serde_json::from_slice(&bench.read("torn/progress.json")).unwrap();
    progress["chunks"] = json!(300);
    progress["bytes"] = json!(half);
    progress["crc32"] = json!(crc32fast::hash(&all[..half]));
    progress["finished"] = json!(false);
    fs::write(bench.path("torn/progress.json"), progress.to_string()).unwrap();
    fs::write(bench.path("torn/results.csv"), &all[..half + 17]).unwrap();
    let output = bench.run(&["sweep", "sweep.json", "--out", "torn"]);
    assert!(output.status.success());
    assert!(String::from_utf8(output.stderr).unwrap().contains("300 of 600 points are done; continuing"));
    assert_same(&bench.path("whole"), &bench.path("torn"));

    // But rows that were recorded as written must be unchanged.
    fs::write(bench.path("torn/progress.json"), progress.to_string()).unwrap();
    fs::write(bench.path("torn/results.csv"), &all[..half - 1]).unwrap();
    let told = bench.refuses(&["sweep", "sweep.json", "--out", "torn"]);
    assert!(told.contains("was changed after this program wrote it"), "{told}");
}

#[test]
fn a_finished_sweep_is_not_computed_again() {
    let bench = Bench::new(&super::sweep());
    bench.succeeds(&["sweep", "sweep.json", "--out", "out"]);
    let before = files(&bench.path("out"));
    let printed = bench.succeeds(&["sweep", "sweep.json", "--out", "out"]);
    assert!(printed.contains("nothing; all points were done"), "{printed}");
    assert_eq!(before, files(&bench.path("out")));
}

/// A finished sweep whose rows have changed is not said to be complete. The files that are made from the rows are made again.
#[test]
fn a_finished_folder_is_checked_and_completed() {
    let bench = Bench::new(&super::sweep());
    let arguments = ["sweep", "sweep.json", "--out", "out", "--quiet"];
    bench.succeeds(&arguments);
    let before = files(&bench.path("out"));
    for name in ["results.parquet", "summary.json", "report.html", "report.md"] {
        fs::remove_file(bench.path("out").join(name)).unwrap();
        bench.succeeds(&arguments);
        assert_eq!(before, files(&bench.path("out")), "{name}");
    }
    fs::write(bench.path("out/summary.json"), "{").unwrap();
    bench.succeeds(&arguments);
    assert_eq!(before, files(&bench.path("out")));
    // a single byte changed, as by a disk, and a file cut short
    for (name, bytes) in before.iter().filter(|(name, _)| !name.starts_with("results.csv") && !name.ends_with(".json"))
    {
        let mut changed = bytes.clone();
        changed[bytes.len() / 2] ^= 1;
        for damaged in [&changed[..], &bytes[..bytes.len() / 2], &[]] {
            fs::write(bench.path("out").join(name), damaged).unwrap();
            bench.succeeds(&arguments);
            assert!(before == files(&bench.path("out")), "{name} was not made again");
        }
    }

    let rows = bench.read("out/results.csv");
    for changed in [&rows[..rows.len() / 2], &[], &[&rows[..], b"1,2,3\n"].concat()] {
        fs::write(bench.path("out/results.csv"), changed).unwrap();
        let told = bench.refuses(&arguments);
        assert!(told.contains("was changed after this program wrote it"), "{told}");
    }
    fs::remove_file(bench.path("out/results.csv")).unwrap();
    let told = bench.refuses(&arguments);
    assert!(told.contains("results.csv is missing; remove the folder to begin anew"), "{told}");
    assert!(!bench.path("out/results.csv").exists());
    for bytes in [&b""[..], &b"\xff\xfe"[..]] {
        fs::write(bench.path("out/progress.json"), bytes).unwrap();
        let told = bench.refuses(&arguments);
        assert!(told.contains("progress.json cannot be read"), "{told}");
    }
}

#[test]
fn another_sweep_in_the_same_folder_is_refused() {
    let bench = Bench::new(&super::sweep());
    bench.succeeds(&["sweep", "sweep.json", "--out", "out", "--quiet"]);
    let before = files(&bench.path("out"));
    let mut changed = super::sweep();
    changed["scene"]["striker"]["speed_m_s"] = json!(1.0000001);
    fs::write(bench.path("sweep.json"), changed.to_string()).unwrap();
    let told = bench.refuses(&["sweep", "sweep.json", "--out", "out"]);
    assert!(told.contains("out holds results of another sweep") && told.contains("choose another folder"), "{told}");
    // Spaces, the order of keys and the path of the scene do not make another sweep.
    let mut same = super::sweep();
    let scene = same.as_object_mut().unwrap().remove("scene").unwrap();
    fs::write(bench.path("scene.json"), format!("{scene:#}")).unwrap();
    same["scene_file"] = json!("scene.json");
    fs::write(bench.path("sweep.json"), format!("{same:#}")).unwrap();
    bench.succeeds(&["sweep", "sweep.json", "--out", "out"]);
    let told = bench.refuses(&["sweep", "sweep.json", "--out", "out", "--shard", "1/2"]);
    assert!(told.contains("holds part 1/1 of this sweep"), "{told}");
    assert_eq!(before, files(&bench.path("out")));
}

#[test]
fn results_of_something_else_are_left_alone() {
    let bench = Bench::new(&super::sweep());
    fs::create_dir(bench.path("out")).unwrap();
    fs::File::create(bench.path("out/results.csv")).unwrap().write_all(b"mine").unwrap();
    assert!(bench.refuses(&["sweep", "sweep.json", "--out", "out"]).contains("not the folder of a sweep"));
    assert_eq!(files(&bench.path("out")), [("results.csv".to_owned(), b"mine".to_vec())]);
}

#[test]
fn two_processes_do_not_share_a_folder() {
    let bench = Bench::new(&super::sweep());
    bench.succeeds(&["sweep", "sweep.json", "--out", "out", "--quiet"]);
    let lock = fs::File::create(bench.path("out/lock")).unwrap();
    lock.lock().unwrap();
    let told = bench.refuses(&["sweep", "sweep.json", "--out", "out"]);
    assert!(told.contains("another process is working in out"), "{told}");
}

#[cfg(unix)]
#[test]
fn a_signal_stops_it_cleanly() {
    let bench = Bench::new(&long_sweep());
    let arguments = ["sweep", "sweep.json", "--out", "out", "--threads", "1"];
    let child = bench.command(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    while points_done(&bench, "out") == 0 {
        sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{told}");
    assert!(told.contains("points done; the same command continues from there"), "{told}");
    bench.succeeds(&arguments);
    assert_eq!(bench.rows("out").len(), 12_000);
}
