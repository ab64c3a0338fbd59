//! No option lets a result replace a file that the same command reads, `--force` included.

use std::fs;
use std::path::Path;

use crate::program::{run, stdout};

const IMPACT: &str = r#"{ "structure": { "kind": "modes-file", "file": "history.csv" }, "location": "tip",
    "striker": { "mass_kg": 0.1, "speed_m_s": 1 }, "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 } }"#;

const INFINITE: &str = r#"{ "structure": { "kind": "infinite-beam", "material": "steel", "width_m": 0.01, "thickness_m": 0.01 },
    "striker": { "material": "steel", "radius_m": 0.01, "speed_m_s": 1 }, "contact": { "law": "hertz", "material": "steel" } }"#;

const BODIES: &str = r#"{ "bodies": { "mass": { "kind": "mass", "mass_kg": 1 } }, "end_s": 0.1,
    "contacts": [ { "name": "stop", "between": [{ "body": "mass" }, "ground"], "law": "linear-spring", "stiffness_n_m": 1e4 } ],
    "loads": [ { "body": "mass", "file": "load.svg" }, { "body": "mass", "force_n": 1, "frequency_hz": 5 } ] }"#;

/// A folder with all inputs of the commands below, under names that their outputs may have.
fn inputs() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in [
        ("scene.svg", IMPACT),
        ("scene.html", IMPACT),
        ("result.json", IMPACT),
        ("history.csv", "omega_rad_s,tip\n100,1\n"),
        ("infinite.svg", INFINITE),
        ("bodies.svg", BODIES),
        ("load.svg", "time_s,force_n\n0,1\n1,1\n"),
        ("data.svg", "restitution,force_file\n0.3,force.svg\n"),
        ("force.svg", "time_s,force_n\n0,0\n1,1\n2,3\n3,4\n4,4\n5,3\n6,1\n7,0\n"),
        ("places.svg", "striker.speed_m_s\n2\n"),
    ] {
        fs::write(folder.path().join(name), content).unwrap();
    }
    folder
}

/// The names and contents of all files.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let read =
        |entry: fs::DirEntry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap_or_default());
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| read(entry.unwrap())).collect();
    files.sort();
    files
}

/// The command is refused with a message that names the option, its value and the file that is read, and changes nothing.
fn assert_refused(folder: &Path, arguments: &[&str], parts: &[&str]) {
    let before = contents(folder);
    let output = run(folder, arguments);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(parts.iter().all(|part| message.contains(part)), "{arguments:?}: {parts:?} in {message}");
    assert!(output.stdout.is_empty() && contents(folder) == before, "{arguments:?}");
}

#[test]
fn an_output_never_replaces_an_input() {
    let folder = inputs();
    let with_identify = ["identify", "data.svg", "--scene", "scene.svg", "--free", "striker.speed_m_s"];
    let identify = |more: &[&'static str]| [&with_identify[..], more].concat();
    let orbit =
        |more: &[&'static str]| [&["orbit", "bodies.svg", "--over", "loads[1].force_n", "--to", "2"], more].concat();
    for (arguments, option, read) in [
        (vec!["simulate", "scene.svg", "--plot", "./scene.svg"], "--plot = ./scene.svg", "scene.svg"),
        (vec!["simulate", "./scene.svg", "--animate", "scene.svg"], "--animate = scene.svg", "./scene.svg"),
        (vec!["simulate", "scene.html", "--report", "scene.html"], "--report = scene.html", "scene.html"),
        (vec!["simulate", "result.json", "--out", "."], "--out = .", "result.json"),
        (vec!["simulate", "scene.svg", "--out", "."], "--out = .", "history.csv"),
        (vec!["simulate", "bodies.svg", "--plot", "load.svg"], "--plot = load.svg", "load.svg"),
        (vec!["infinite-beam", "infinite.svg", "--plot", "infinite.svg"], "--plot = infinite.svg", "infinite.svg"),
        (vec!["modes", "scene.svg", "--plot", "scene.svg"], "--plot = scene.svg", "scene.svg"),
        (vec!["compare", "scene.svg", "--plot", "scene.svg"], "--plot = scene.svg", "scene.svg"),
        (vec!["sensitivity", "scene.svg", "--plot", "scene.svg"], "--plot = scene.svg", "scene.svg"),
        (orbit(&["--csv", "load.svg"]), "--csv = load.svg", "load.svg"),
        (orbit(&["--plot", "bodies.svg"]), "--plot = bodies.svg", "bodies.svg"),
        (identify(&["--plot", "data.svg"]), "--plot = data.svg", "data.svg"),
        (identify(&["--plot", "force.svg"]), "--plot = force.svg", "force.svg"),
        (identify(&["--candidates", "places.svg", "--plot", "places.svg"]), "--plot = places.svg", "places.svg"),
    ] {
        let forced = [&arguments[..], &["--force"]].concat();
        for arguments in [&arguments, &forced] {
            assert_refused(folder.path(), arguments, &[option, "reads ", read, "it must be"]);
        }
    }
}

#[cfg(unix)]
#[test]
fn links_do_not_hide_an_input() {
    let folder = inputs();
    for (target, link) in [("scene.svg", "link.svg"), ("bodies.svg", "intervals.csv"), (".", "here")] {
        std::os::unix::fs::symlink(target, folder.path().join(link)).unwrap();
    }
    for (scene, option, path) in [
        ("scene.svg", "--plot", "link.svg"),
        ("link.svg", "--plot", "scene.svg"),
        ("scene.svg", "--plot", "here/scene.svg"),
        ("bodies.svg", "--out", "here"),
    ] {
        assert_refused(folder.path(), &["simulate", scene, option, path, "--force"], &[option, path, scene]);
    }
}

/// A file is completed elsewhere than under a name that another one may have.
#[test]
fn no_file_beside_an_output_is_touched() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.svg.part"), INFINITE).unwrap();
    stdout(&run(folder.path(), &["simulate", "a.svg.part", "--plot", "a.svg"]));
    let files = contents(folder.path());
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!((names, files[1].1.as_slice()), (vec!["a.svg", "a.svg.part"], INFINITE.as_bytes()));
}

/// A sweep whose own file has the name of a record in the folder of the results.
#[test]
fn a_sweep_does_not_replace_its_own_file() {
    let folder = tempfile::tempdir().unwrap();
    let sweep =
        format!(r#"{{ "scene": {INFINITE}, "vary": [ {{ "field": "striker.speed_m_s", "values": [1, 2] }} ] }}"#);
    fs::write(folder.path().join("sweep.json"), &sweep).unwrap();
    assert_refused(folder.path(), &["sweep", "sweep.json", "--out", "."], &["sweep.json", "choose another folder"]);
}
