//! Periodic motions of scenes: text, JSON, branches, errors.

mod program;

use std::fs;
use std::path::Path;

use program::{run, stdout};
use serde_json::Value;

/// A lightly damped oscillator below its resonance, with a stop that it may or may not reach.
fn rig(folder: &Path, gap_m: f64) -> String {
    let text = format!(
        r#"{{ "bodies": {{ "rig": {{ "kind": "modal", "omega_rad_s": [10], "damping_ratios": [0.02],
                 "points": {{ "tip": {{ "shape": [1] }} }} }} }},
             "contacts": [{{ "name": "stop", "between": ["ground", {{ "body": "rig", "location": "tip" }}],
                 "gap_m": {gap_m}, "law": "linear-spring", "stiffness_n_m": 2000 }}],
             "loads": [{{ "body": "rig", "location": "tip", "force_n": 0.6, "frequency_hz": 1.3 }}], "end_s": 10 }}"#
    );
    let path = folder.join("rig.json");
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

#[test]
fn the_steady_motion_is_found_with_its_multipliers() {
    let folder = tempfile::tempdir().unwrap();
    let scene = rig(folder.path(), 1.0);
    let printed = stdout(&run(folder.path(), &["orbit", &scene, "--json"]));
    let orbit: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(orbit["outcome"], "found");
    assert!((orbit["period_s"].as_f64().unwrap() * 1.3 - 1.0).abs() < 1e-14);
    assert_eq!((orbit["stable"].as_bool(), orbit["intervals_per_period"].as_u64()), (Some(true), Some(0)));
    let size = (-0.02f64 * 10.0 / 1.3).exp();
    for multiplier in orbit["floquet_multipliers"].as_array().unwrap() {
        let [re, im] = [0, 1].map(|i| multiplier[i].as_f64().unwrap());
        assert!((re.hypot(im) - size).abs() < 1e-8, "{multiplier}");
    }
    let omega = std::f64::consts::TAU * 1.3;
    let amplitude = 0.6 / ((100.0 - omega * omega).powi(2) + (0.4 * omega).powi(2)).sqrt();
    let moving = &orbit["points"][1];
    assert_eq!((moving["contact"].as_str(), moving["side"].as_u64()), (Some("stop"), Some(1)));
    let found = moving["displacement_first_harmonic_m"].as_f64().unwrap();
    assert!((found / amplitude - 1.0).abs() < 1e-9, "{found} {amplitude}");
    // the extremes are those of the motion and not of its samples
    for (name, expected) in [("displacement_max_m", amplitude), ("displacement_min_m", -amplitude)] {
        let found = moving[name].as_f64().unwrap();
        assert!((found / expected - 1.0).abs() < 1e-9, "{name}: {found} {expected}");
    }
    let text = stdout(&run(folder.path(), &["orbit", &scene]));
    assert!(text.contains("stable") && text.contains("Floquet multipliers"), "{text}");
}

#[test]
fn a_branch_is_followed_drawn_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let scene = rig(folder.path(), 0.05);
    let over = ["--over", "loads[0].frequency_hz", "--from", "1.3", "--to", "1.9", "--csv", "b.csv", "--plot", "b.svg"];
    let arguments: Vec<&str> = ["orbit", &scene, "--json"].into_iter().chain(over).collect();
    let branch: Value = serde_json::from_str(&stdout(&run(folder.path(), &arguments))).unwrap();
    assert_eq!((branch["field"].as_str(), branch["complete"].as_bool()), (Some("loads[0].frequency_hz"), Some(true)));
    let kinds: Vec<&str> =
        branch["special_points"].as_array().unwrap().iter().map(|point| point["kind"].as_str().unwrap()).collect();
    assert!(kinds.contains(&"grazing"), "{kinds:?}");
    let orbits = branch["orbits"].as_array().unwrap();
    assert_eq!(orbits[0]["value"].as_f64(), Some(1.3));
    assert_eq!(orbits[orbits.len() - 1]["value"].as_f64(), Some(1.9));
    let table = fs::read_to_string(folder.path().join("b.csv")).unwrap();
    assert_eq!(table.lines().count(), orbits.len() + 1);
    assert!(fs::read_to_string(folder.path().join("b.svg")).unwrap().contains("grazing"));
}

#[test]
fn a_branch_keeps_its_orbits_where_the_field_cannot_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let scene = rig(folder.path(), 1.0);
    let over = ["--over", "bodies.rig.damping_ratios[0]", "--from", "0.02", "--to", "0"];
    let arguments: Vec<&str> = ["orbit", &scene, "--json"].into_iter().chain(over).collect();
    let branch: Value = serde_json::from_str(&stdout(&run(folder.path(), &arguments))).unwrap();
    let last = branch["orbits"].as_array().unwrap().last().unwrap()["value"].as_f64().unwrap();
    assert!((0.0..1e-6).contains(&last), "{last}");
}

#[test]
fn errors_name_the_field() {
    let folder = tempfile::tempdir().unwrap();
    let scene = rig(folder.path(), 0.05);
    for (arguments, named) in [
        (vec!["--over", "loads[0].colour", "--to", "2"], "--over"),
        (vec!["--over", "loads[7].frequency_hz", "--to", "2", "--from", "1"], "loads has 1 entry"),
        (vec!["--over", "loads[0].frequency_hz", "--to", "1.3"], "to"),
        (vec!["--over", "loads[0].frequency_hz", "--to", "2", "--step", "7"], "step"),
    ] {
        let arguments: Vec<&str> = ["orbit", &scene].into_iter().chain(arguments).collect();
        let output = run(folder.path(), &arguments);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(message.contains(named), "{arguments:?}: {message}");
    }
    // No load is periodic.
    let still = fs::read_to_string(&scene).unwrap().replace("\"frequency_hz\": 1.3", "\"frequency_hz\": null");
    fs::write(folder.path().join("still.json"), still).unwrap();
    assert_eq!(run(folder.path(), &["orbit", "still.json"]).status.code(), Some(2));
}
