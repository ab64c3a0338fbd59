//! The program with scenes of bodies: text, JSON, files, exit codes.

use std::fs;

use crate::gallery::datasets;
use crate::program::{run, stdout};
use serde_json::{Value, json};
use std::sync::atomic::AtomicBool;
use vibroimpact::assembly::{AssemblyScene, Wanted};

fn scene(name: &str) -> String {
    datasets(&format!("assemblies/{name}.json")).display().to_string()
}

#[test]
fn simulate_prints_one_json_object_with_the_promised_keys() {
    let folder = tempfile::tempdir().unwrap();
    let printed = stdout(&run(folder.path(), &["simulate", &scene("sdnl105"), "--json"]));
    let result: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!((result["outcome"].as_str(), result["end_s"].as_f64()), (Some("end"), Some(1.0)));
    assert_eq!(result["reliable_until_s"], result["end_s"]);
    assert!(result["steady_motion"].is_null());
    // The result contains the scene that it belongs to.
    assert_eq!(result["vibroimpact"], env!("CARGO_PKG_VERSION"));
    assert_eq!(result["scene"]["version"], 1);
    let again = AssemblyScene::from_value(&result["scene"]).unwrap();
    assert_eq!(again, AssemblyScene::read(&datasets("assemblies/sdnl105.json")).unwrap());
    let contact = &result["contacts"]["1-2"];
    assert_eq!(contact["count"], contact["intervals"].as_array().unwrap().len());
    let last = contact["intervals"].as_array().unwrap().last().unwrap();
    assert!(last["end_s"].is_null() && last["separation_speed_m_s"].is_null(), "{last}");
    let first = &contact["intervals"][0];
    for key in ["start_s", "end_s", "impulse_n_s", "peak_force_n", "approach_speed_m_s", "separation_speed_m_s"] {
        assert!(first[key].as_f64().is_some_and(|value| value > 0.0), "{key}: {first}");
    }
    for key in ["time_share", "rms_force_n", "largest_force_n", "contact_work_rate_w"] {
        assert!(contact[key].as_f64().is_some_and(|value| value > 0.0), "{key}: {contact}");
    }
    // The work of the load must be accounted for.
    let energy = &result["energy"];
    let joule = |value: &Value| value.as_f64().unwrap();
    let bodies = energy["bodies"].as_object().unwrap();
    assert_eq!(bodies.len(), 3);
    let gained: f64 = bodies.values().map(|body| joule(&body["end_j"]) - joule(&body["start_j"])).sum();
    let rest = joule(&energy["load_work_j"]) - gained - joule(&energy["contacts_stored_j"]);
    assert!(rest.abs() < 1e-9 * joule(&energy["load_work_j"]), "{energy}");
    assert!(joule(&energy["residual_j"]).abs() < 1e-9 * joule(&energy["load_work_j"]), "{energy}");
    let points = result["points"].as_array().unwrap();
    assert_eq!(points.len(), 4);
    assert_eq!((points[1]["contact"].as_str(), points[1]["side"].as_u64()), (Some("1-2"), Some(1)));
    assert!(points[1]["displacement_m"].as_f64().unwrap() > 0.016);
    // The list is truncated as requested, and the statistics are not.
    let short = stdout(&run(folder.path(), &["simulate", &scene("sdnl105"), "--json", "--intervals", "1"]));
    let short: Value = serde_json::from_str(&short).unwrap();
    // The interval that begins first is listed.
    assert_eq!(short["contacts"]["1-2"]["intervals"].as_array().unwrap().len(), 1);
    assert_eq!(short["contacts"]["1-2"]["intervals_left_out"], 1);
    assert_eq!(short["contacts"]["2-3"]["intervals_left_out"], 4);
    assert_eq!(short["contacts"]["2-3"]["rms_force_n"], result["contacts"]["2-3"]["rms_force_n"]);
}

/// A ball that is pressed into the floor at the start: its energy is that of the contact alone.
#[test]
fn a_reader_can_close_the_energy_balance_of_an_interference() {
    let scene = json!({
        "bodies": { "ball": { "kind": "mass", "mass_kg": 0.3 } },
        "contacts": [{ "name": "floor", "between": [{ "body": "ball" }, "ground"], "gap_m": -1e-4,
                       "law": "kelvin-voigt", "stiffness_n_m": 1e6, "damping_n_s_m": 100 }],
        "end_s": 0.01
    });
    let found = AssemblyScene::from_value(&scene).unwrap().simulate().unwrap();
    let energy = serde_json::to_value(vibroimpact::assembly::Summary::new(&found)).unwrap()["energy"].clone();
    let joule = |pointer: &str| energy.pointer(pointer).and_then(Value::as_f64).unwrap();
    let start_j = joule("/bodies/ball/start_j") + joule("/contacts_stored_at_start_j");
    let end_j = joule("/bodies/ball/end_j") + joule("/contacts_stored_j");
    assert!((start_j - 0.5 * 1e6 * 1e-8).abs() < 1e-15, "{energy}");
    assert!((start_j - end_j - joule("/contact_loss_j")).abs() < 1e-10 * start_j, "{energy}");
}

#[test]
fn simulate_without_json_is_for_readers() {
    let folder = tempfile::tempdir().unwrap();
    let text = stdout(&run(folder.path(), &["simulate", &scene("sdnd102")]));
    for part in ["1 body with 1 mode, 1 contact, moving ground", "the requested time was reached", "wall", "RMS force"]
    {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn springs_without_losses_lose_nothing_in_print() {
    let folder = tempfile::tempdir().unwrap();
    let cradle = [&scene("newtons-cradle"), "--set", "tolerance=1e-4"];
    let text = stdout(&run(folder.path(), &[&["simulate"], &cradle[..]].concat()));
    let result = stdout(&run(folder.path(), &[&["simulate", "--json"], &cradle[..]].concat()));
    let result: Value = serde_json::from_str(&result).unwrap();
    let work_j = result["energy"]["contact_loss_j"].as_f64().unwrap();
    let lines = format!("    lost in contacts        0 J\n    unaccounted             {work_j:.0e} J\n");
    assert!(work_j != 0.0 && text.contains(&lines), "{lines}\nin\n{text}");
}

#[test]
fn out_writes_intervals_histories_picture_and_report() {
    let folder = tempfile::tempdir().unwrap();
    let printed = stdout(&run(folder.path(), &["simulate", &scene("rattling-gear"), "--json", "--out", "a"]));
    let result: Value = serde_json::from_str(&printed).unwrap();
    let read = |name: &str| fs::read(folder.path().join("a").join(name)).unwrap();
    assert_eq!(read("result.json"), printed.as_bytes());
    assert!(read("run.svg").starts_with(b"<svg") && read("report.html").starts_with(b"<!DOCTYPE html>"));
    assert!(read("intervals.parquet").starts_with(b"PAR1"));
    let rows = |name: &str| -> Vec<Vec<String>> {
        let table = read(name);
        let mut rows = csv::Reader::from_reader(table.as_slice());
        rows.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect()
    };
    let intervals = rows("intervals.csv");
    let counts = ["flank+", "flank-"].map(|name| result["contacts"][name]["count"].as_u64().unwrap());
    assert_eq!(intervals.len() as u64, counts[0] + counts[1]);
    let listed = result["contacts"]["flank+"]["intervals"].as_array().unwrap();
    let of_flank: Vec<_> = intervals.iter().filter(|row| row[0] == "flank+").collect();
    for (number, (row, listed)) in of_flank.iter().zip(listed).enumerate() {
        assert_eq!(row[1], (number + 1).to_string());
        assert_eq!(row[2].parse::<f64>().unwrap(), listed["start_s"].as_f64().unwrap());
    }
    // There is a force where the gap is negative, none where it is open beyond rounding; the section has one row per period.
    let history = rows("history.csv");
    assert!(history.len() > 4096);
    let number = |cell: &String| cell.parse::<f64>().unwrap();
    assert!(history.windows(2).all(|pair| number(&pair[0][0]) <= number(&pair[1][0])));
    assert!(history.iter().all(|row| number(&row[1]) <= 1e-15 || number(&row[3]) == 0.0));
    assert!(history.iter().any(|row| number(&row[3]) > 100.0));
    assert_eq!(rows("section.csv").len(), 25);
    assert_eq!(fs::read_dir(folder.path().join("a")).unwrap().count(), 7);
}

/// A row of balls above floors of their own, all at the same height.
fn many_balls(count: usize) -> Value {
    let bodies = (0..count)
        .map(|i| (format!("b{i}"), json!({ "kind": "mass", "mass_kg": 0.1 + 0.01 * i as f64, "position_m": 1e-4 })));
    let contacts: Vec<Value> = (0..count)
        .map(|i| {
            json!({ "name": format!("floor-{i}"), "between": [{ "body": format!("b{i}") }, "ground"],
                    "law": "linear-spring", "stiffness_n_m": 1e7 })
        })
        .collect();
    let bodies: serde_json::Map<String, Value> = bodies.collect();
    json!({ "bodies": bodies, "contacts": contacts, "gravity_m_s2": 9.81, "end_s": 0.02 })
}

#[test]
fn the_picture_shows_every_contact_or_says_which() {
    let folder = tempfile::tempdir().unwrap();
    let picture = |scene: &str| {
        stdout(&run(folder.path(), &["simulate", scene, "--plot", "run.svg", "--force"]));
        fs::read_to_string(folder.path().join("run.svg")).unwrap()
    };
    let eight = picture(&scene("sdnl301"));
    for support in 1..=4 {
        for side in ["+", "-"] {
            assert!(eight.contains(&format!("support-{support}{side}")), "{support}{side}");
        }
    }
    fs::write(folder.path().join("many.json"), many_balls(30).to_string()).unwrap();
    let many = picture("many.json");
    assert!(many.contains("the 24 of 30 contacts with the largest RMS force"));
    // the heaviest balls press hardest
    assert!(many.contains("floor-29") && !many.contains("floor-0<") && many.matches("floor-").count() == 24);
}

/// A mode of 40 Hz and one of 100 kHz, which 4,096 samples in 2 s cannot represent, rattle freely between stops.
#[test]
fn the_spectrum_has_no_motion_that_is_too_fast_for_its_samples() {
    let folder = tempfile::tempdir().unwrap();
    let both = json!({
        "bodies": { "rig": { "kind": "modal", "omega_rad_s": [251.3, 628_000.0], "damping_ratios": [0.001, 0.0],
            "points": { "tip": { "shape": [1, 1] } }, "start": { "amplitude_m_kg0_5": [1e-3, 1e-4] } } },
        "contacts": [{ "name": "stop", "between": ["ground", { "body": "rig", "location": "tip" }], "gap_m": 0.01,
            "law": "linear-spring", "stiffness_n_m": 1e4 }],
        "end_s": 2
    });
    let scene = AssemblyScene::from_value(&both).unwrap();
    let found = scene
        .simulate_with(Wanted {
            intervals: 10,
            reliability: false,
            course: true,
            take: None,
            stop: &AtomicBool::new(false),
            tell: &mut |_| (),
        })
        .unwrap();
    let samples = &found.course.as_ref().unwrap().spectrum;
    assert_eq!(samples.fast_modes, 1);
    let values = samples.of_contact(0);
    assert_eq!(values.len(), 4096);
    for (i, value) in values.iter().enumerate() {
        let time_s = i as f64 * samples.step_s;
        let slow = 1e-3 * (-0.2513 * time_s).exp() * (251.3 * time_s).cos();
        assert!((value - slow).abs() < 2e-6, "{time_s}: {value:e} {slow:e}");
    }
    fs::write(folder.path().join("both.json"), both.to_string()).unwrap();
    stdout(&run(folder.path(), &["simulate", "both.json", "--plot", "run.svg"]));
    let picture = fs::read_to_string(folder.path().join("run.svg")).unwrap();
    assert!(picture.contains("Spectrum of the displacements without 1 mode above 1.024 kHz"), "{picture}");
}

#[test]
fn intervals_are_printed_with_enough_digits_to_tell_their_ends_apart() {
    let folder = tempfile::tempdir().unwrap();
    let text = stdout(&run(folder.path(), &["simulate", &scene("shaken-table")]));
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
    let rows: Vec<_> = rows.iter().filter(|row| row.first() == Some(&"table") && row[2].ends_with('s')).collect();
    assert_eq!(rows.len(), 20, "{text}");
    let start_s = |row: &[&str]| row[1].parse::<f64>().unwrap() * if row[2] == "ms" { 1e-3 } else { 1.0 };
    assert!(rows.iter().any(|row| start_s(row) >= 1.0), "{text}");
    assert!(rows.iter().all(|row| row[1] != row[3]), "{text}");
}

#[test]
fn the_name_of_a_body_is_apart_from_its_energy() {
    let name = "a body with a name of many words";
    let scene =
        json!({ "bodies": { name: { "kind": "mass", "mass_kg": 1, "velocity_m_s": 1 } }, "contacts": [], "end_s": 1 });
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), scene.to_string()).unwrap();
    let text = stdout(&run(folder.path(), &["simulate", "scene.json"]));
    assert!(text.contains(&format!("{name}  500.0 mJ at the start")), "{text}");
}

#[test]
fn a_ball_that_starts_inside_a_beam_leaves_the_range_of_contact_laws() {
    let mut inside: Value = serde_json::from_str(&fs::read_to_string(scene("dropped-ball")).unwrap()).unwrap();
    inside["bodies"]["ball"]["position_m"] = json!(-1);
    inside["end_s"] = json!(1e-7);
    let check = |scene: &Value| -> Value {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.json"), scene.to_string()).unwrap();
        let printed = stdout(&run(folder.path(), &["simulate", "scene.json", "--json"]));
        let result: Value = serde_json::from_str(&printed).unwrap();
        let text = stdout(&run(folder.path(), &["simulate", "scene.json"]));
        let verdict = result["trust"][0]["verdict"].as_str().unwrap().to_owned();
        assert!(text.contains(&format!("{verdict}: the surfaces of contact overlap by up to")), "{text}");
        result["trust"][0].clone()
    };
    let outside = check(&inside);
    assert_eq!((outside["check"].as_str(), outside["verdict"].as_str()), (Some("compression"), Some("outside")));
    assert!(outside["value"].as_f64().unwrap() > 80.0, "{outside}");
    inside["bodies"]["ball"]["position_m"] = json!(1e-5);
    inside["end_s"] = json!(0.1);
    assert_eq!(check(&inside)["verdict"], "within");
}

#[test]
fn a_scene_that_cannot_be_used_is_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(scene("sdnl104")).unwrap().replace("\"location_m\": 1 ", "\"location_m\": 1.5 ");
    fs::write(folder.path().join("scene.json"), text).unwrap();
    let output = run(folder.path(), &["simulate", "scene.json", "--out", "a", "--plot", "b.svg"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("contacts[0].between[0].location_m = 1.5 is not allowed"), "{message}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    // Commands for single impacts name the commands for such a scene.
    let output = run(folder.path(), &["plan", &scene("sdnl104")]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(message.contains("vibroimpact simulate"), "{message}");
}
