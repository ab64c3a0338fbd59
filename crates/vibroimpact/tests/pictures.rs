//! Pictures and reports as the program writes them.

use std::fs;
use std::path::Path;

use vibroimpact::Scene;
use vibroimpact::simulate::Simulation;

use crate::program::{run, stdout};

const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../datasets/scenes");

fn scene(name: &str) -> String {
    format!("{SCENES}/{name}.json")
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn simulate_draws_and_reports_every_kind_of_scene() {
    for name in ["pinned-beam-small-ball", "measured-modes", "linear-stop", "infinite-beam", "infinite-plate"] {
        let folder = tempfile::tempdir().unwrap();
        let arguments = ["simulate", &scene(name), "--plot", "a/b.svg", "--report", "r.html"];
        let printed = stdout(&run(folder.path(), &arguments));
        assert!(printed.contains("wrote a/b.svg") && printed.contains("wrote r.html"), "{printed}");
        let svg = fs::read_to_string(folder.path().join("a/b.svg")).unwrap();
        for part in ["displacement (", "contact force (", "structure", "striker", "<text"] {
            assert!(svg.contains(part), "{part} in the picture of {name}");
        }
        let html = fs::read_to_string(folder.path().join("r.html")).unwrap();
        // what is printed about the accuracy is in the report, too
        for part in ["how far to trust it", "modes left out"].into_iter().filter(|part| printed.contains(part)) {
            assert!(html.to_lowercase().contains(part), "{part} in the report of {name}");
        }
        for part in ["<svg", "How to repeat this", "Contacts", "What was modelled", env!("CARGO_PKG_VERSION")] {
            assert!(html.contains(part), "{part} in the report of {name}");
        }
        assert_eq!(names(folder.path()), ["a", "r.html"]);
        assert_eq!(names(&folder.path().join("a")), ["b.svg"]);
        // The same again.
        stdout(&run(folder.path(), &[&arguments[..], &["--force"]].concat()));
        assert_eq!(fs::read_to_string(folder.path().join("a/b.svg")).unwrap(), svg);
        assert_eq!(fs::read_to_string(folder.path().join("r.html")).unwrap(), html);
    }
}

/// A string swings below a striker that it does not reach: its first mode at 50 Hz.
#[test]
fn without_contact_a_period_is_drawn_and_the_striker_at_its_distance() {
    let folder = tempfile::tempdir().unwrap();
    let scene = r#"
        location_m = 0.5
        modes = 4
        structure = { kind = "string", length_m = 1, tension_n = 100, mass_per_length_kg_m = 0.01, damping_ratio = 0.01 }
        start = { gap_m = 1e-3, moving_modes = [{ mode = 1, velocity_m_s = 0.1 }] }
        striker = { mass_kg = 0.001, speed_m_s = 0 }
        contact = { law = "hertz", stiffness_n_m1_5 = 1e7 }
    "#;
    fs::write(folder.path().join("s.toml"), scene).unwrap();
    stdout(&run(folder.path(), &["simulate", "s.toml", "--out", "o", "--animate", "a.svg"]));
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert!(!read("a.svg").contains("NaN"));
    for table in ["o/history.csv", "o/modal_energies.csv"] {
        let last_s: f64 = read(table).lines().last().unwrap().split(',').next().unwrap().parse().unwrap();
        assert!((last_s - 0.02).abs() < 1e-9, "{table} ends at {last_s} s");
    }
    let scene = Scene::from_toml(scene).unwrap();
    let found = scene.simulate().unwrap();
    let Simulation::Modal(resolved) = &found else { panic!("a string has modes") };
    let deflection = resolved.deflection(&found.scene(&scene), resolved.until_s(None), [10, 10]).unwrap().unwrap();
    assert!(deflection.striker_m.iter().all(|place_m| (place_m - 1e-3).abs() < 1e-15), "{:?}", deflection.striker_m);
}

#[test]
fn a_report_is_self_contained_and_escapes_text_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(scene("linear-stop")).unwrap();
    let mut hostile: serde_json::Value = serde_json::from_str(&text).unwrap();
    hostile["description"] = "<script>alert(1)</script> ![x](http://evil/x.png) ``` | <a href='//evil'>b</a>".into();
    fs::write(folder.path().join("s.json"), hostile.to_string()).unwrap();
    stdout(&run(folder.path(), &["simulate", "s.json", "--json", "--report", "r.HTML"]));
    let html = fs::read_to_string(folder.path().join("r.HTML")).unwrap();
    for tag in ["<script", "<img", "<a ", "<link", "@import", "url(", "<iframe"] {
        assert!(!html.contains(tag), "{tag}");
    }
    assert!(html.contains("&lt;script&gt;alert(1)&lt;/script&gt; ![x](http://evil/x.png) ```"));
    // Nothing is loaded: there is no address except the name of SVG's language and the one in the description.
    let addresses = html.matches("http").count();
    assert_eq!(addresses, html.matches("http://www.w3.org/2000/svg").count() + html.matches("http://evil").count());
    assert!(!html.contains("src=") && html.matches("href=").count() == html.matches("href='//evil'").count());
}

#[cfg(feature = "png")]
#[test]
fn png_files_are_png() {
    let folder = tempfile::tempdir().unwrap();
    stdout(&run(folder.path(), &["simulate", &scene("linear-stop"), "--plot", "a.png"]));
    stdout(&run(folder.path(), &["modes", &scene("stepped-cantilever"), "--count", "6", "--plot", "m.png"]));
    for name in ["a.png", "m.png"] {
        let png = fs::read(folder.path().join(name)).unwrap();
        assert!(png.starts_with(b"\x89PNG\r\n\x1a\n") && png.len() > 10_000);
        assert_eq!(u32::from_be_bytes([png[16], png[17], png[18], png[19]]), 1520);
    }
}

/// The picture of the first modes of a scene of the gallery.
fn drawn_modes(folder: &Path, name: &str, count: &str) -> String {
    stdout(&run(folder, &["modes", &scene(name), "--count", count, "--json", "--plot", "m.svg", "--force"]));
    fs::read_to_string(folder.join("m.svg")).unwrap()
}

#[test]
fn modes_are_drawn_along_a_beam_and_as_stems() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |name: &str, count: &str| drawn_modes(folder.path(), name, count);
    let beam = draw("stepped-cantilever", "12");
    assert!(beam.contains("location along the beam (m)") && beam.contains("frequency (kHz)"));
    assert!(!draw("measured-modes", "2").contains("along the beam"));
    // Each mode is drawn, as long as they can be distinguished.
    let named = |svg: &str, number: usize| svg.contains(&format!("\n{number}: "));
    assert!((1..=12).all(|number| named(&beam, number)) && !named(&beam, 13));
    let many = draw("stepped-cantilever", "40");
    assert!(named(&many, 30) && !named(&many, 31) && many.contains("Shapes of the first 30 along"));
}

#[test]
fn modes_are_drawn_along_a_string_and_over_a_plate() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |name: &str, count: &str| drawn_modes(folder.path(), name, count);
    let string = draw("piano-hammer", "5");
    assert!(string.contains("location along the string (m)") && string.contains("\n5: "));
    for name in ["cantilever-plate", "simply-supported-plate"] {
        let plate = draw(name, "14");
        assert!((1..=12).all(|number| plate.contains(&format!("\n{number}: "))) && !plate.contains("\n13: "), "{name}");
        assert!(plate.contains("x (") && plate.contains("y (") && plate.contains("frequency ("), "{name}");
    }
}

#[test]
fn other_extensions_are_refused_before_anything_is_solved() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, allowed) in [
        (vec!["simulate", "missing.json", "--plot", "a.jpg"], ".svg"),
        (vec!["simulate", "missing.json", "--plot", "svg"], ".svg"),
        (vec!["simulate", "missing.json", "--report", "a.pdf"], ".html"),
        (vec!["modes", "missing.json", "--count", "3", "--plot", "a"], ".svg"),
        (vec!["infinite-beam", "--s", "15", "--plot", "a.gif"], ".svg"),
    ] {
        let output = run(folder.path(), &arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        // The extension is checked first: the missing scene is not yet an error.
        assert!(message.contains(allowed) && !message.contains("missing.json"), "{message}");
        assert!(output.stdout.is_empty() && names(folder.path()).is_empty());
    }
}

#[test]
fn a_path_that_cannot_be_written_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    let output = run(folder.path(), &["simulate", &scene("linear-stop"), "--plot", "file/a.svg"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot write to file/a.svg"));
    assert_eq!(names(folder.path()), ["file"]);
    // There is a folder in place of the picture.
    fs::create_dir(folder.path().join("a.svg")).unwrap();
    let output = run(folder.path(), &["simulate", &scene("linear-stop"), "--plot", "a.svg", "--force"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(names(folder.path()), ["a.svg", "file"]);
}

#[test]
fn completions_and_manual_name_every_command() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = stdout(&run(folder.path(), &["completions", shell]));
        for word in ["simulate", "modes", "infinite-beam", "--plot", "turning-points"] {
            let word = if shell == "fish" { word.trim_start_matches("--") } else { word };
            assert!(script.contains(word), "{word} for {shell}");
        }
    }
    assert_eq!(run(folder.path(), &["completions", "cmd"]).status.code(), Some(2));
    let manual = stdout(&run(folder.path(), &["manual"]));
    assert!(manual.contains(".TH vibroimpact") && manual.contains("simulate"));
}

#[test]
fn every_command_shows_examples() {
    let folder = tempfile::tempdir().unwrap();
    for command in ["simulate", "modes", "emoc", "fit", "infinite-beam", "completions", "manual"] {
        let help = stdout(&run(folder.path(), &[command, "--help"]));
        assert!(help.contains(&format!("  vibroimpact {command}")), "{command}");
    }
}
