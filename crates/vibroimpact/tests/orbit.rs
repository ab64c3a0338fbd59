//! Periodic motions of scenes: text, JSON, branches, errors.

use std::fs;
use std::path::Path;

use crate::gallery::datasets;
use crate::program::{run, stdout};
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
    // The result contains the scene that it belongs to.
    assert_eq!(orbit["vibroimpact"], env!("CARGO_PKG_VERSION"));
    assert_eq!(orbit["scene"]["loads"][0]["frequency_hz"], 1.3);
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

/// Numbers with a negative exponent are not taken for options.
#[test]
fn the_range_of_a_field_may_be_negative() {
    let folder = tempfile::tempdir().unwrap();
    let scene = rig(folder.path(), 1.0);
    let range = ["--over", "loads[0].force_n", "--from", "-2e-1", "--to", "-1e-1"];
    let printed = stdout(&run(folder.path(), &[&["orbit", &scene, "--json"], &range[..]].concat()));
    let branch: Value = serde_json::from_str(&printed).unwrap();
    let orbits = branch["orbits"].as_array().unwrap();
    assert_eq!([orbits.first(), orbits.last()].map(|orbit| orbit.unwrap()["value"].as_f64()), [Some(-0.2), Some(-0.1)]);
}

/// The damper's motion is irregular for hundreds of periods before it converges to one of four periods. The masses of the second
/// scene lose no energy, so that no transient converges. Whether a motion that is found from an irregular one is stable depends on
/// rounding.
#[test]
fn near_returns_of_a_long_motion_lead_to_periodic_ones() {
    for (name, periods, converges) in [("impact-damper", "4", true), ("sdnd125", "1", false)] {
        let scene = datasets(&format!("assemblies/{name}.json")).display().to_string();
        let after = |transient: &str| -> Value {
            let arguments = ["orbit", &scene, "--periods", periods, "--transient", transient, "--json"];
            let found: Value = serde_json::from_str(&stdout(&run(Path::new("."), &arguments))).unwrap();
            assert_eq!(found["outcome"], "found", "{name}");
            assert!(found["closure"].as_f64().unwrap() < 1e-9, "{name}");
            found
        };
        after("100");
        if converges {
            let found = after("2000");
            assert_eq!(found["stable"], true, "{name}");
            let largest = found["floquet_multipliers"][0][0].as_f64().unwrap();
            assert!((largest - 0.849176474).abs() < 1e-6, "{name} {largest}");
        }
        // Without a search it is chance whether Newton's method converges from where a transient ends.
        let without_search = |transient: &str| {
            let arguments =
                ["orbit", &scene, "--periods", periods, "--search", "0", "--transient", transient, "--json"];
            let found: Value = serde_json::from_str(&stdout(&run(Path::new("."), &arguments))).unwrap();
            found["outcome"].as_str().unwrap().to_owned()
        };
        assert!(
            ["50", "60", "90", "100"].into_iter().any(|transient| without_search(transient) == "not found"),
            "{name}"
        );
    }
}

/// After 80 periods the damper still moves irregularly. That it converges later must not contradict what is said of it then.
#[test]
fn a_motion_that_has_not_converged_is_called_chaotic_only_so_far() {
    let scene = datasets("assemblies/impact-damper.json").display().to_string();
    let output = run(Path::new("."), &["orbit", &scene, "--transient", "40", "--search", "40"]);
    // on a busy machine it takes so long that a line of progress appears beside the result
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{text}");
    assert!(text.contains("has converged to no periodic motion") && text.contains("is chaotic so far"), "{text}");
}

#[test]
fn a_branch_is_followed_drawn_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let scene = rig(folder.path(), 0.05);
    let over = ["--over", "loads[0].frequency_hz", "--from", "1.3", "--to", "1.9", "--csv", "b.csv", "--plot", "b.svg"];
    let arguments: Vec<&str> = ["orbit", &scene, "--json"].into_iter().chain(over).collect();
    let branch: Value = serde_json::from_str(&stdout(&run(folder.path(), &arguments))).unwrap();
    assert_eq!((branch["field"].as_str(), branch["complete"].as_bool()), (Some("loads[0].frequency_hz"), Some(true)));
    assert_eq!((branch["scene"]["version"].as_u64(), branch["interrupted"].as_bool()), (Some(1), Some(false)));
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
fn loads_of_one_and_one_and_a_half_hertz_repeat_themselves_after_two_seconds() {
    let folder = tempfile::tempdir().unwrap();
    let scene = rig(folder.path(), 1.0);
    let one = r#"{ "body": "rig", "location": "tip", "force_n": 0.6, "frequency_hz": 1.3 }"#;
    let two = |second_hz: f64| {
        let load = |frequency_hz: f64| one.replace("1.3", &frequency_hz.to_string());
        fs::read_to_string(&scene).unwrap().replace(one, &format!("{}, {}", load(1.0), load(second_hz)))
    };
    fs::write(folder.path().join("two.json"), two(1.5)).unwrap();
    let found: Value = serde_json::from_str(&stdout(&run(folder.path(), &["orbit", "two.json", "--json"]))).unwrap();
    assert_eq!((found["outcome"].as_str(), found["forcing_periods"].as_u64()), (Some("found"), Some(1)));
    assert!((found["period_s"].as_f64().unwrap() - 2.0).abs() < 1e-14, "{found}");
    // A run settles into the same motion.
    let longer = two(1.5).replace(r#""end_s": 10"#, r#""end_s": 120"#);
    fs::write(folder.path().join("longer.json"), longer).unwrap();
    let run_to = |file: &str| -> Value {
        serde_json::from_str(&stdout(&run(folder.path(), &["simulate", file, "--json"]))).unwrap()
    };
    assert_eq!(run_to("longer.json")["steady_motion"]["periods"], 1);
    // The error names the load and its frequency as the scene states them.
    fs::write(folder.path().join("none.json"), two(27.12345678)).unwrap();
    let output = run(folder.path(), &["orbit", "none.json"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("loads[1].frequency_hz = 27.12345678 is") && !message.contains("rad/s"), "{message}");
    assert!(run_to("none.json")["steady_motion"].is_null());
}

#[test]
fn a_field_on_which_the_motion_does_not_depend_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = rig(folder.path(), 1.0);
    for field in ["end_s", "tolerance"] {
        let arguments = ["orbit", &scene, "--over", field, "--from", "1e-9", "--to", "1e-8"];
        let output = run(folder.path(), &arguments);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(field) && message.contains("on which the periodic motion depends"), "{message}");
    }
}

/// The branch of the shaken table: the motions of two and of four periods that begin at its period doublings.
#[test]
fn doubled_branches_are_followed_drawn_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let scene = crate::gallery::datasets("assemblies/shaken-table.json").display().to_string();
    let words = ["orbit", &scene, "--over", "ground_motion.displacement_m", "--to", "0.0011", "--json"];
    let more = ["--branches", "2", "--csv", "b.csv", "--plot", "b.svg"];
    let arguments: Vec<&str> = words.into_iter().chain(more).collect();
    let branch: Value = serde_json::from_str(&stdout(&run(folder.path(), &arguments))).unwrap();
    let doubled = branch["branches"].as_array().unwrap();
    let begins: Vec<f64> = doubled.iter().map(|branch| branch["begins_at"].as_f64().unwrap()).collect();
    assert_eq!(begins.len(), 2, "{begins:?}");
    let point = &branch["special_points"][0];
    assert_eq!((point["kind"].as_str(), point["value"].as_f64()), (Some("period doubling"), Some(begins[0])));
    assert!(begins[0] > 9.4e-4 && begins[0] < 9.6e-4 && begins[1] > begins[0], "{begins:?}");
    // The distances between the doublings of a cascade decrease by a ratio that tends to Feigenbaum's 4.669.
    let third = doubled[1]["special_points"][0]["value"].as_f64().unwrap();
    let ratio = (begins[1] - begins[0]) / (third - begins[1]);
    assert!((ratio / 4.669 - 1.0).abs() < 0.02, "{ratio}");
    for (branch, periods) in doubled.iter().zip([2, 4]) {
        let orbits = branch["orbits"].as_array().unwrap();
        assert!(orbits.len() > 3, "{branch}");
        for orbit in orbits {
            assert_eq!(orbit["forcing_periods"], periods);
            let section = orbit["points"][0]["displacement_section_m"].as_array().unwrap();
            assert_eq!(section.len(), periods);
        }
    }
    let rows = [&branch, &doubled[0], &doubled[1]].map(|branch| branch["orbits"].as_array().unwrap().len());
    let table = fs::read_to_string(folder.path().join("b.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + rows.iter().sum::<usize>());
    // Markers with a legend, which cannot cover each other as texts beside the points would.
    let picture = fs::read_to_string(folder.path().join("b.svg")).unwrap();
    assert_eq!(picture.matches("period doubling").count(), 1);
    assert!(picture.contains("once in each period"));
    // Otherwise the text says how to follow them.
    let text = stdout(&run(folder.path(), &words[..6]));
    assert!(text.contains("--branches 1"), "{text}");
}

/// Between two pitchforks the beam between two stops vibrates without symmetry. That branch is followed once, from one to the other.
#[test]
fn a_branch_between_two_pitchforks_is_followed_once() {
    let folder = tempfile::tempdir().unwrap();
    let scene = datasets("assemblies/beam-between-stops.json").display().to_string();
    let over = ["--over", "loads[0].frequency_hz", "--from", "18", "--to", "20", "--step", "0.05"];
    let words = ["orbit", &scene, "--set", "loads[0].force_n=6.5"].into_iter().chain(over);
    let arguments: Vec<&str> = words.chain(["--branches", "1", "--json"]).collect();
    let found: Value = serde_json::from_str(&stdout(&run(folder.path(), &arguments))).unwrap();
    let [one, other] = &found["special_points"].as_array().unwrap()[..] else { panic!("{}", found["special_points"]) };
    assert!([one, other].iter().all(|point| point["kind"] == "pitchfork"));
    let [branch] = &found["branches"].as_array().unwrap()[..] else { panic!("{}", found["branches"]) };
    assert_eq!((&branch["parent"], &branch["begins_with"]), (&Value::from(0), &Value::from("pitchfork")));
    assert_eq!((&branch["begins_at"], &branch["ends_at"]), (&one["value"], &other["value"]));
    assert_eq!(branch["complete"], true);
    // it is stable throughout, while the symmetric motion is unstable between the pitchforks
    let orbits = branch["orbits"].as_array().unwrap();
    assert!(orbits.len() > 5 && orbits[1..].iter().all(|orbit| orbit["stable"] == true));
    let range = |orbit: &Value, key: &str| orbit["points"][0][key].as_f64().unwrap();
    let middle = &orbits[orbits.len() / 2];
    let asymmetry = range(middle, "displacement_max_m") / -range(middle, "displacement_min_m") - 1.0;
    assert!(asymmetry.abs() > 0.05, "{asymmetry}");
}

#[test]
fn errors_name_the_field() {
    let folder = tempfile::tempdir().unwrap();
    let scene = rig(folder.path(), 0.05);
    for (arguments, named) in [
        (vec!["--over", "loads[0].colour", "--to", "2"], "--over"),
        (vec!["--over", "loads[7].frequency_hz", "--to", "2", "--from", "1"], "loads has 1 entry"),
        (vec!["--over", "loads[0].frequency_hz", "--to", "1.3"], "error: --to = 1.3 is not allowed"),
        (vec!["--over", "loads[0].frequency_hz", "--to", "2", "--step", "7"], "error: --step = 7 is not allowed"),
    ] {
        let arguments: Vec<&str> = ["orbit", &scene].into_iter().chain(arguments).collect();
        let output = run(folder.path(), &arguments);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(message.contains(named), "{arguments:?}: {message}");
    }
    // The transient, as many periods as are followed before the search, would be longer than any run.
    let slow = fs::read_to_string(&scene).unwrap().replace("\"frequency_hz\": 1.3", "\"frequency_hz\": 1e-11");
    fs::write(folder.path().join("slow.json"), slow).unwrap();
    let output = run(folder.path(), &["orbit", "slow.json"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("loads = periods of together 10000000000000 s is not allowed"), "{message}");
    // A scene of one impact has no bodies.
    let single = datasets("scenes/pinned-beam.json").display().to_string();
    let output = run(folder.path(), &["orbit", &single]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("left out, because a scene of bodies is needed here"), "{message}");
    // No load is periodic.
    let still = fs::read_to_string(&scene).unwrap().replace("\"frequency_hz\": 1.3", "\"frequency_hz\": null");
    fs::write(folder.path().join("still.json"), still).unwrap();
    assert_eq!(run(folder.path(), &["orbit", "still.json"]).status.code(), Some(2));
}
