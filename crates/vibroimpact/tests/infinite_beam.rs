//! The command `infinite-beam`, and scenes with infinite structures, as a user meets them.

use std::fs;
use std::path::PathBuf;

use crate::program::{run, stdout};
use serde_json::{Value, json};
use vibroimpact::Scene;

fn solved(arguments: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    serde_json::from_str(&stdout(&run(folder.path(), arguments))).unwrap()
}

/// Runs a command that must reject its input and write nothing; returns the message.
fn refusal(arguments: &[&str], scene: Option<String>) -> String {
    let folder = tempfile::tempdir().unwrap();
    let files = usize::from(scene.is_some());
    if let Some(text) = scene {
        fs::write(folder.path().join("scene.json"), text).unwrap();
    }
    let output = run(folder.path(), arguments);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(output.stdout.is_empty() && !message.contains("panicked"), "{message}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), files, "{message}");
    message
}

fn gallery(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../datasets/scenes").join(name)
}

fn scene() -> Value {
    serde_json::from_str(&fs::read_to_string(gallery("infinite-beam.json")).unwrap()).unwrap()
}

#[test]
fn sustained_contact_after_four_separations() {
    let result = solved(&["infinite-beam", "--s", "15", "--json"]);
    assert_eq!(result["s"], 15.0);
    assert_eq!(result["outcome"], "sustained");
    assert_eq!(result["separations"], 4);
    assert!(result["rebound_ratio"].is_null());
    assert!(result["first_rebound_ratio"].as_f64().unwrap() < 0.0);
    assert!(result["digits"].as_f64().unwrap() > 9.0);
    assert!(result.get("physical").is_none());
    let contacts = result["contacts"].as_array().unwrap();
    assert_eq!(contacts.len(), 5);
    assert_eq!(contacts[0]["start"], 0.0);
    for pair in contacts.windows(2) {
        assert!(pair[0]["start"].as_f64() < pair[0]["end"].as_f64());
        assert!(pair[0]["end"].as_f64() < pair[1]["start"].as_f64());
        assert!(pair[0]["peak_force"].as_f64() > pair[1]["peak_force"].as_f64());
    }
    assert!(contacts[4]["end"].is_null() && contacts[4].get("end").is_some());
}

#[test]
fn one_contact_and_a_rebound() {
    let result = solved(&["infinite-beam", "--s", "1", "--json"]);
    assert_eq!((&result["outcome"], &result["separations"]), (&json!("rebound"), &json!(1)));
    assert_eq!(result["rebound_ratio"], result["first_rebound_ratio"]);
    let ratio = result["rebound_ratio"].as_f64().unwrap();
    assert!(ratio > 0.0 && ratio < 1.0);
    // The weakest impact on the beam is one on an immovable body.
    let gentle = solved(&["infinite-beam", "--s", "1e-12", "--json"]);
    assert!(gentle["rebound_ratio"].as_f64().unwrap() > ratio);
}

#[test]
fn no_separation_at_large_s() {
    let result = solved(&["infinite-beam", "--json", "--s", "4e5"]);
    assert_eq!((&result["outcome"], &result["separations"]), (&json!("sustained"), &json!(0)));
    assert!(result["rebound_ratio"].is_null() && result["first_rebound_ratio"].is_null());
    assert_eq!(result["contacts"].as_array().unwrap().len(), 1);
}

#[test]
fn turning_points_are_listed_with_their_uncertainty() {
    let result = solved(&["infinite-beam", "turning-points", "--count", "4", "--json"]);
    let critical = result["critical_s"].as_f64().unwrap();
    assert!((critical / 1.559 - 1.0).abs() < 1e-3);
    assert!(result["critical_s_uncertainty"].as_f64().unwrap() < 1e-11);
    let points = result["turning_points"].as_array().unwrap();
    assert_eq!(points.len(), 4);
    for (k, (point, thesis)) in points.iter().zip([3.528e4, 521.9, 74.391, 22.403]).enumerate() {
        assert_eq!(point["n"], k + 1);
        let s = point["s"].as_f64().unwrap();
        assert!((s / thesis - 1.0).abs() < 1e-3, "{point}");
        assert!(point["uncertainty"].as_f64().unwrap() < 1e-10 * s, "{point}");
    }
    let folder = tempfile::tempdir().unwrap();
    let table = stdout(&run(folder.path(), &["infinite-beam", "turning-points", "--count", "2"]));
    assert!(table.contains("critical S 1.56") && table.lines().count() == 5, "{table}");
}

/// An impact given in physical units and by its `S` is the same, and the units connect the two.
#[test]
fn a_scene_is_its_s_in_other_units() {
    let path = gallery("infinite-beam.json");
    let result = solved(&["infinite-beam", path.to_str().unwrap(), "--json"]);
    let s = result["s"].as_f64().unwrap();
    assert!((s / 15.556 - 1.0).abs() < 2e-3);
    let mut by_s = solved(&["infinite-beam", "--s", &format!("{s:?}"), "--json"]);
    by_s["physical"] = result["physical"].clone();
    assert_eq!(result, by_s);
    assert_eq!(solved(&["simulate", path.to_str().unwrap(), "--json"])["infinite"], result);

    let physical = &result["physical"];
    let unit = |name: &str| physical[name].as_f64().unwrap();
    assert_eq!(unit("speed_m_s"), 0.5);
    assert!((unit("displacement_unit_m") / (0.5 * unit("time_unit_s")) - 1.0).abs() < 1e-14);
    let (last, last_s) = (&result["contacts"][4], &physical["contacts"][4]);
    assert!(last_s["end_s"].is_null() && physical["rebound_velocity_m_s"].is_null());
    let start = last["start"].as_f64().unwrap() * unit("time_unit_s");
    assert!((last_s["start_s"].as_f64().unwrap() / start - 1.0).abs() < 1e-14);
}

#[test]
fn a_plate_is_solved_by_simulate_and_always_releases_the_striker() {
    let path = gallery("infinite-plate.json");
    let result = &solved(&["simulate", path.to_str().unwrap(), "--json"])["infinite"];
    assert_eq!((&result["outcome"], &result["separations"]), (&json!("rebound"), &json!(1)));
    let physical = &result["physical"];
    let (ratio, velocity) = (result["rebound_ratio"].as_f64(), physical["rebound_velocity_m_s"].as_f64());
    assert_eq!(ratio.map(|ratio| ratio * physical["speed_m_s"].as_f64().unwrap()), velocity);
    let message = refusal(&["infinite-beam", path.to_str().unwrap()], None);
    assert!(message.contains("structure.kind = \"infinite-plate\"") && message.contains("simulate"), "{message}");
}

/// Other laws on infinite structures have the same documents as Hertz contact, without `S`; a long beam with ends, by its
/// modes, agrees.
#[test]
fn every_law_is_solved_and_reported_in_the_same_form() {
    let laws = [
        json!({ "law": "kelvin-voigt", "stiffness_n_m": 1e6, "restitution": 0.8 }),
        json!({ "law": "hunt-crossley", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3, "restitution": 0.7 }),
        json!({ "law": "linear-spring", "stiffness_n_m": 1e6 }),
        json!({ "law": "elastoplastic", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3, "yield_pressure_pa": 2e9 }),
    ];
    for (file, kind) in [("infinite-beam.json", "beam"), ("infinite-plate.json", "plate")] {
        for law in &laws {
            let mut tree: Value = serde_json::from_str(&fs::read_to_string(gallery(file)).unwrap()).unwrap();
            tree["contact"] = law.clone();
            tree["striker"] = json!({ "density_kg_m3": 7800, "radius_m": 0.01, "speed_m_s": 1 });
            let folder = tempfile::tempdir().unwrap();
            fs::write(folder.path().join("scene.json"), tree.to_string()).unwrap();
            let printed = stdout(&run(folder.path(), &["simulate", "scene.json", "--json", "--out", "a"]));
            let result: Value = serde_json::from_str(&printed).unwrap();
            let found = &result["infinite"];
            assert!(found["s"].is_null() && found.get("s").is_some(), "{printed}");
            assert_eq!(result["outcome"], "rebound", "{law} on a {kind}");
            let restitution = result["restitution"].as_f64().unwrap();
            assert_eq!(found["rebound_ratio"].as_f64().unwrap(), restitution);
            assert!(restitution > 0.0 && restitution < 1.0 && found["digits"].as_f64().unwrap() > 9.0);
            let contact = &result["sub_impacts"][0];
            let peak = contact["peak_force_n"].as_f64().unwrap();
            assert!(contact["impulse_n_s"].as_f64().unwrap() > 0.0 && peak > 0.0);
            // The tables contain the same motion.
            let table = fs::read_to_string(folder.path().join("a/history.csv")).unwrap();
            let rows: Vec<[f64; 7]> =
                csv::Reader::from_reader(table.as_bytes()).deserialize().map(Result::unwrap).collect();
            let highest = rows.iter().map(|row| row[6]).fold(0.0, f64::max);
            assert!((highest / peak - 1.0).abs() < 1e-3, "{law} on a {kind}: {highest} {peak}");
            assert!((rows.last().unwrap()[4] - restitution).abs() < 1e-9, "{law} on a {kind}");
            assert!(!fs::read_to_string(folder.path().join("a/impact.svg")).unwrap().contains("no data"));
            let text = stdout(&run(folder.path(), &["simulate", "scene.json", "--report", "report.html"]));
            let name = law["law"].as_str().unwrap();
            assert!(text.contains(&format!("infinite {kind}; {name} contact")) && !text.contains("\n  S  "), "{text}");
            assert!(fs::read_to_string(folder.path().join("report.html")).unwrap().contains(&format!("law is {name}")));
            if kind == "beam" {
                let section = tree["structure"].as_object_mut().unwrap();
                section.remove("kind");
                section.insert("length_m".to_owned(), json!(3));
                let mut long = json!({ "structure": { "kind": "beam", "segments": [section.clone()],
                    "ends": ["pinned", "pinned"], "damping_ratio": 0 }, "location_m": 1.5, "model": "modal", "modes": 300 });
                long["striker"] = tree["striker"].clone();
                long["contact"] = law.clone();
                let scene = Scene::from_json(&long.to_string()).unwrap();
                let reference = scene.answer().unwrap().restitution.unwrap();
                assert!((restitution - reference).abs() < 1e-4, "{law}: {restitution} {reference}");
            }
        }
    }
}

/// A contact that lasts is reported as one whose end is not known.
#[test]
fn a_contact_that_lasts_is_reported() {
    let mut tree = scene();
    tree["contact"] = json!({ "law": "kelvin-voigt", "stiffness_n_m": 1e5, "damping_n_s_m": 1e4 });
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), tree.to_string()).unwrap();
    let result = solved(&["simulate", folder.path().join("scene.json").to_str().unwrap(), "--json"]);
    assert_eq!((&result["outcome"], &result["stopped_by"]), (&json!("stopped"), &json!("contact lasts")));
    assert!(result["restitution"].is_null() && result["sub_impacts"][0]["end_s"].is_null());
    let text = stdout(&run(folder.path(), &["infinite-beam", "scene.json"]));
    assert!(text.contains("it is not known whether it ever ends"), "{text}");
}

#[test]
fn out_writes_tables_and_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let printed = stdout(&run(folder.path(), &["infinite-beam", "--s", "15", "--json", "--out", "a/b"]));
    let read = |name: &str| fs::read_to_string(folder.path().join("a/b").join(name)).unwrap();
    assert_eq!(read("result.json"), printed);
    assert!(read("impact.svg").starts_with("<svg") && !read("impact.svg").contains("no data"));
    assert_eq!(read("contacts.csv").lines().count(), 6);
    assert_eq!(fs::read_dir(folder.path().join("a/b")).unwrap().count(), 4);

    let table = read("history.csv");
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let header =
        "time,structure_displacement,striker_displacement,structure_velocity,striker_velocity,compression,force";
    assert_eq!(rows.headers().unwrap().iter().collect::<Vec<_>>().join(","), header);
    let rows: Vec<[f64; 7]> = rows.deserialize().map(|row| row.unwrap()).collect();
    assert!(rows.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    assert_eq!(rows[0][4], -1.0);
    for row in &rows {
        let law = 15f64.sqrt() * row[5].max(0.0).powf(1.5);
        assert!((row[6] - law).abs() < 1e-12 && (row[1] - row[2] - row[5]).abs() < 1e-12, "{row:?}");
    }
    let result: Value = serde_json::from_str(&printed).unwrap();
    let peak = rows.iter().map(|row| row[6]).fold(0.0, f64::max);
    assert!((peak / result["contacts"][0]["peak_force"].as_f64().unwrap() - 1.0).abs() < 1e-3);

    let path = gallery("infinite-beam.json");
    let text = stdout(&run(folder.path(), &["infinite-beam", path.to_str().unwrap(), "--out", "c"]));
    assert!(text.contains("on an infinite beam") && text.contains("wrote result.json, history.csv"), "{text}");
    let physical = fs::read_to_string(folder.path().join("c/history.csv")).unwrap();
    assert!(physical.starts_with("time_s,structure_displacement_m,"), "{physical}");
}

#[test]
fn without_json_it_is_for_readers() {
    let folder = tempfile::tempdir().unwrap();
    let text = stdout(&run(folder.path(), &["infinite-beam", "--s", "15"]));
    for part in ["sustained contact", "separations           4", "first rebound ratio", "digits", "duration"] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    assert!(!text.contains("\n  rebound ratio"), "{text}");
    let many = stdout(&run(folder.path(), &["infinite-beam", "--s", "1.6"]));
    assert!(many.contains("separations           33") && many.contains("and 14 more"), "{many}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn s_out_of_range_is_refused_with_value_and_range() {
    for (given, told) in [
        ("0", "0"),
        ("-1", "-1"),
        ("-0", "-0"),
        ("nan", "NaN"),
        ("inf", "inf"),
        ("-inf", "-inf"),
        ("1e-13", "1e-13"),
        ("1.1e10", "11000000000"),
        ("1e999", "inf"),
    ] {
        let message = refusal(&["infinite-beam", "--s", given, "--json", "--out", "results"], None);
        let value = message.strip_prefix("error: --s = ").and_then(|rest| rest.split(' ').next()).unwrap_or_default();
        let same = value == told || value.parse::<f64>().ok() == told.parse().ok();
        assert!(same && message.contains("from 1e-12 to 1e10"), "{given}: {message}");
    }
    for count in ["0", "61", "1000000"] {
        let message = refusal(&["infinite-beam", "turning-points", "--count", count, "--json"], None);
        assert!(
            message.contains(&format!("invalid value '{count}' for '--count <N>'")) && message.contains("1 to 60"),
            "{message}"
        );
    }
}

#[test]
fn usage_errors_exit_with_2_as_well() {
    for arguments in [
        &["infinite-beam"][..],
        &["infinite-beam", "--json"],
        &["infinite-beam", "--s", "fifteen"],
        &["infinite-beam", "scene.json", "--s", "15"],
        &["infinite-beam", "nowhere.json"],
        &["infinite-beam", "turning-points"],
        &["infinite-beam", "turning-points", "--count", "-3"],
        &["infinite-beam", "turning-points", "--count", "2.5"],
    ] {
        refusal(arguments, None);
    }
}

/// A nearly rigid structure returns the ball as a wall does, also where the number `S` lies below its range.
#[test]
fn a_nearly_rigid_structure_is_a_wall() {
    let mut altered = scene();
    altered["structure"] = json!({ "kind": "infinite-beam", "youngs_modulus_pa": 2e11, "density_kg_m3": 7800,
                                   "width_m": 3.0, "thickness_m": 3.0 });
    altered["striker"] = json!({ "density_kg_m3": 7800, "radius_m": 1e-3, "speed_m_s": 0.5 });
    let scene = Scene::from_json(&altered.to_string()).unwrap();
    assert!(scene.infinite_impact().unwrap().groups().unwrap().s < 1e-12);
    let (_, solution) = scene.solve_infinite().unwrap();
    let loss = 1.0 - solution.rebound_ratio().unwrap();
    assert!(loss > 0.0 && loss < 1e-3, "{loss}");
}

#[test]
fn scenes_that_do_not_fit_are_refused_by_field() {
    for (pointer, value, part) in [
        (
            "/structure/width_m",
            json!(-1),
            "structure.width_m = -1.0 is not allowed; it must be a finite number greater than 0",
        ),
        ("/structure/width_m", Value::Null, "structure.width_m is missing"),
        ("/structure/length_m", json!(1), "structure.length_m = 1"),
        ("/structure/poissons_ratio", json!(0.6), "structure.poissons_ratio = 0.6 is not allowed"),
        ("/structure/shear_coefficient", json!(3), "structure.shear_coefficient = 3.0 is not allowed"),
        (
            "/structure/shear_rigidity_n",
            json!(1e7),
            "structure.shear_rigidity_n = 10000000.0 is not allowed; it must be left out",
        ),
        (
            "/structure/rotary_inertia_kg_m",
            json!(1),
            "structure.rotary_inertia_kg_m = 1.0 is not allowed; it must be left out",
        ),
        ("/structure/kind", json!("beam"), "structure.density_kg_m3 = 7800 is not a known field"),
        ("/striker/speed_m_s", json!(0), "striker.speed_m_s = 0 is not allowed"),
        ("/striker/speed_m_s", json!(-1), "striker.speed_m_s = -1 is not allowed"),
        (
            "/striker/speed_m_s",
            json!(1e30),
            "striker.speed_m_s = 1e+30 is not allowed; it must be such that the number S of the impact, now",
        ),
        ("/striker/radius_m", json!(-0.01), "striker.radius_m = -0.01"),
        ("/contact", json!({ "law": "linear-spring", "stiffness_n_m": -1 }), "contact.stiffness_n_m = -1"),
        ("/contact", json!({ "law": "kelvin-voigt", "stiffness_n_m": 1e6 }), "contact.damping_n_s_m"),
        (
            "/contact",
            json!({ "law": "hunt-crossley", "stiffness_n_m_n": 1e8, "exponent": 0.5, "damping_s_m": 0.1 }),
            "contact.exponent = 0.5",
        ),
        ("/contact", json!({ "law": "hertz", "stiffness_n_m1_5": -1 }), "contact.stiffness_n_m1_5 = -1"),
        ("/location_m", json!(0.5), "location_m = 0.5 is not allowed; it must be left out"),
        ("/modes", json!(40), "modes = 40 is not allowed; it must be left out"),
        ("/residual_compliance", json!(true), "residual_compliance = true is not allowed; it must be left out"),
        ("/tolerance", json!(1e-9), "tolerance = 1e-9 is not allowed; it must be left out"),
    ] {
        let mut altered = scene();
        let (parent, name) = pointer.rsplit_once('/').unwrap();
        altered.pointer_mut(parent).unwrap().as_object_mut().unwrap().insert(name.to_owned(), value);
        for command in ["infinite-beam", "simulate"] {
            let message = refusal(&[command, "scene.json", "--json", "--out", "results"], Some(altered.to_string()));
            assert!(message.contains(part), "{part}: {message}");
        }
    }
    let message = refusal(&["modes", "scene.json", "--count", "3"], Some(scene().to_string()));
    assert!(
        message
            .contains("structure.kind = \"infinite-beam\" is not allowed; it must be one of beam, string, plate, modal, dropped-rod"),
        "{message}"
    );
}

/// The section may be given by rigidity and mass, by a rectangle, or by a diameter.
#[test]
fn a_section_can_be_given_in_three_ways() {
    let s = |structure: Value| {
        let mut altered = scene();
        altered["structure"] = structure;
        Scene::from_json(&altered.to_string()).unwrap().infinite_impact().unwrap().groups().unwrap().s
    };
    let square = s(scene()["structure"].clone());
    let side: f64 = 0.028;
    let (rigidity, mass) = (2e11 * side.powi(4) / 12.0, 7800.0 * side * side);
    let kind = "infinite-beam";
    let given = s(json!({ "kind": kind, "flexural_rigidity_n_m2": rigidity, "mass_per_length_kg_m": mass }));
    assert!((given / square - 1.0).abs() < 1e-12);
    let round = s(json!({ "kind": kind, "youngs_modulus_pa": 2e11, "density_kg_m3": 7800, "diameter_m": side }));
    // S ~ EI^(-5/2) (mass per length)^(-15/2).
    let pi = std::f64::consts::PI;
    let expected = (12.0 * pi / 64.0).powf(-2.5) * (pi / 4.0).powf(-7.5);
    assert!((round / square / expected - 1.0).abs() < 1e-12);
}
