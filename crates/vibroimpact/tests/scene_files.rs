//! Scenes as files: JSON and TOML, versions, the schema, tables of modes, named points, motion before the impact.

use std::fs;

use crate::gallery::{assemblies, assembly, assert_checked_in, datasets, gallery, named, paths};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use serde_json::{Value, json};
use vibroimpact::assembly::AssemblyScene;
use vibroimpact::scene::{MovingMode, Start, Structure, schema};
use vibroimpact::{Scene, SceneError};

fn tree(scene: &Scene) -> Value {
    serde_json::from_str(&scene.to_json()).unwrap()
}

/// The file as JSON or TOML text would give it, with its table of modes not yet read.
fn file_tree(path: &std::path::Path) -> Value {
    let text = fs::read_to_string(path).unwrap();
    match path.extension() {
        Some(toml) if toml == "toml" => serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap(),
        _ => serde_json::from_str(&text).unwrap(),
    }
}

/// The error of a scene, from reading it or from defining the impact.
fn fault(scene: &Value) -> vibroimpact::InvalidInput {
    Scene::from_value(scene).and_then(|scene| scene.impact()).and_then(|impact| impact.solve()).unwrap_err()
}

#[test]
fn json_and_toml_are_equivalent() {
    for (name, scene) in gallery() {
        let toml = scene.to_toml().unwrap();
        assert_eq!(Scene::from_toml(&toml).unwrap(), scene, "{name}");
        assert_eq!(Scene::from_json(&scene.to_json()).unwrap(), scene, "{name}");
        // Writing and reading again changes nothing.
        assert_eq!(tree(&Scene::from_toml(&toml).unwrap()), tree(&scene), "{name}");
        assert_eq!(tree(&scene)["version"], 1, "{name}");
    }
}

#[test]
fn a_written_file_contains_the_fields_that_were_read() {
    for path in paths() {
        let file = file_tree(&path);
        let Ok(scene) = Scene::from_value(&file) else { panic!("{path:?}") };
        let written = tree(&scene);
        // Every field of the file is written; additional ones are defaults.
        fn is_part(of: &Value, whole: &Value) -> bool {
            match (of, whole) {
                (Value::Object(of), Value::Object(whole)) => {
                    of.iter().all(|(key, value)| whole.get(key).is_some_and(|other| is_part(value, other)))
                }
                (Value::Array(of), Value::Array(whole)) => {
                    of.len() == whole.len() && of.iter().zip(whole).all(|(a, b)| is_part(a, b))
                }
                (Value::Number(a), Value::Number(b)) => a.as_f64() == b.as_f64(),
                _ => of == whole,
            }
        }
        let mut file = file;
        file.as_object_mut().unwrap().remove("$schema");
        assert!(is_part(&file, &written), "{path:?}: {written:#}");
    }
}

#[test]
fn an_error_in_toml_is_located() {
    for (text, expected) in [
        ("striker = { mass_kg = 1", "line 1, column"),
        ("location_m = 1\nlocation_m = 2\n", "line 2, column 1"),
        ("[striker]\nmass_kg = 1\n[striker]\n", "line 3, column"),
        ("tolerance = nan", "tolerance = NaN is not allowed; it must be a number from 1e-13 to 0.1"),
        (
            "[structure]\nkind = 'beam'\nends = []\nsegments = [{ length_m = -inf }]",
            "structure.segments[0].length_m = -inf",
        ),
        ("[[striker]]", "striker = [{}] is not allowed"),
        ("location_m = 1979-05-27", "location_m = \"1979-05-27\" is not allowed"),
        ("é = = 1", "line 1, column"),
        ("", "is missing"),
    ] {
        let message = Scene::from_toml(text).unwrap_err().to_string();
        assert!(message.contains(expected), "{text}: {message}");
    }
}

#[test]
fn a_newer_version_is_reported_before_its_fields() {
    let newer = Scene::from_json(r#"{ "version": 2, "friction": 0.3 }"#).unwrap_err().to_string();
    assert!(newer.starts_with("version = 2 is not allowed; it must be at most 1, "), "{newer}");
    let newer = Scene::from_toml("version = 3\nnew = 1").unwrap_err().to_string();
    assert!(
        newer.starts_with("version = 3 is not allowed; it must be ") && newer.contains("newer vibroimpact"),
        "{newer}"
    );
    for bad in ["0", "-1", "1.5", "\"1\"", "null", "[]"] {
        let fault = Scene::from_json(&format!("{{ \"version\": {bad} }}")).unwrap_err().to_string();
        assert!(fault.starts_with("version = "), "{fault}");
    }
    let unknown = Scene::from_json(r#"{ "version": 1, "friction": 0.3 }"#).unwrap_err().to_string();
    assert!(unknown.starts_with("friction = 0.3"), "{unknown}");
}

#[test]
fn the_schema_is_current_and_distinguishes_scenes_from_others() {
    let schema = schema::of_scenes();
    assert_checked_in("schema/scene.schema.json", &schema::text(&schema));
    let validator = jsonschema::draft202012::options().build(&schema).unwrap();
    for path in paths() {
        let faults: Vec<String> = validator.iter_errors(&file_tree(&path)).map(|fault| fault.to_string()).collect();
        assert!(faults.is_empty(), "{path:?}: {faults:?}");
    }
    for (name, scene) in gallery() {
        assert!(validator.is_valid(&tree(&scene)), "{name}");
    }
    // Mistakes that both the schema and the program find.
    for (name, place, slip) in [
        ("pinned-beam", "/version", json!(2)),
        ("pinned-beam", "/gravity", json!(9.81)),
        ("pinned-beam", "/structure", json!(null)),
        ("pinned-beam", "/structure/kind", json!("bem")),
        ("pinned-beam", "/structure/ends", json!(["pinned"])),
        ("pinned-beam", "/structure/ends/1", json!("welded")),
        ("pinned-beam", "/structure/damping_ratio", json!(-0.1)),
        ("pinned-beam", "/structure/segments/0/length_m", json!(0)),
        ("pinned-beam", "/structure/segments/0/width_m", json!("wide")),
        ("pinned-beam", "/structure/segments/0/colour", json!("red")),
        ("pinned-beam", "/structure/omega_rad_s", json!([1])),
        ("pinned-beam", "/striker", json!([1, 2, 3])),
        ("pinned-beam", "/striker/density_kg_m3", json!(-7800)),
        ("pinned-beam", "/striker/weight", json!(1)),
        ("pinned-beam", "/contact/law", json!("herz")),
        ("pinned-beam", "/contact/restitution", json!(0.5)),
        ("pinned-beam", "/contact/poissons_ratio", json!(0.7)),
        ("pinned-beam", "/location_m", json!("middle")),
        ("pinned-beam", "/modes", json!(-1)),
        ("pinned-beam", "/modes", json!(100_000)),
        ("pinned-beam", "/modes", json!(2.5)),
        ("pinned-beam", "/tolerance", json!(0.6)),
        ("pinned-beam", "/residual_compliance", json!("yes")),
        ("pinned-beam", "/location_m", Value::Null),
        ("pinned-beam", "/location", json!("middle")),
        ("pinned-beam", "/striker/mass_kg", json!(0.1)),
        ("pinned-beam", "/striker/radius_m", Value::Null),
        ("pinned-beam", "/striker/density_kg_m3", Value::Null),
        ("pinned-beam", "/structure/damping_ratio", json!(1e7)),
        ("pinned-beam", "/structure/segments/0/diameter_m", json!(0.01)),
        ("pinned-beam", "/structure/segments/0/width_m", Value::Null),
        ("rubber-ball", "/striker/density_kg_m3", json!(1000)),
        ("measured-modes", "/location_m", json!(0.1)),
        ("measured-modes", "/structure/omega_rad_s", json!([])),
        ("baseball-bat", "/location", Value::Null),
        ("infinite-plate", "/location_m", json!(0.1)),
        ("infinite-plate", "/tolerance", json!(1e-3)),
        ("infinite-beam", "/structure/diameter_m", json!(0.1)),
        ("dropped-rod", "/striker/mass_kg", json!(1)),
        ("dropped-rod", "/location_m", json!(0.1)),
        ("linear-stop", "/striker/immovable", json!(true)),
        ("sdnl32", "/striker/mass_kg", json!(1)),
        ("pinned-beam", "/start", json!({ "gap_m": -1 })),
        ("pinned-beam", "/start", json!({ "moving_modes": [{ "mode": 0 }] })),
        ("hysteretic", "/contact/k_bar", json!(0)),
        ("rubber-ball", "/contact/restitution", json!(1.5)),
        ("pinned-beam", "/contact", json!({ "law": "kelvin-voigt", "stiffness_n_m": 1e6, "restitution": 1 })),
        ("pinned-beam", "/structure/attachments", json!([{ "location_m": 0.5, "mass_kg": -1 }])),
        ("infinite-plate", "/structure/length_m", json!(1)),
        ("infinite-plate", "/structure/thickness_m", json!(-1)),
        ("dropped-rod", "/structure/inclination_deg", json!(91)),
        ("dropped-rod", "/structure/axial_modes", json!(10_001)),
        ("baseball-bat", "/structure/points/150_mm/shape/0", json!("1")),
        ("baseball-bat", "/structure/points/150_mm/colour", json!(1)),
        ("baseball-bat", "/structure/omega_rad_s/3", json!(-1)),
        ("baseball-bat", "/structure/modal_mass_kg", json!([0])),
        ("simply-supported-plate", "/structure/edges", json!(["pinned", "pinned"])),
        ("simply-supported-plate", "/structure/edges/2", json!("guided")),
        ("simply-supported-plate", "/structure/theory", json!("timoshenko")),
        ("simply-supported-plate", "/structure/shear_coefficient", json!(0)),
        ("simply-supported-plate", "/structure/thickness_m", json!(0)),
        ("simply-supported-plate", "/structure/width_m", json!("wide")),
        ("simply-supported-plate", "/structure/poissons_ratio", json!(0.6)),
        ("simply-supported-plate", "/structure/damping_ratio", json!(-1)),
        ("simply-supported-plate", "/location_m", json!([0.1])),
        ("simply-supported-plate", "/location_m", json!([0.1, 0.1, 0.1])),
        ("simply-supported-plate", "/location_m/1", json!("middle")),
        ("piano-hammer", "/structure/tension_n", json!(0)),
        ("piano-hammer", "/structure/length_m", json!(-1)),
        ("piano-hammer", "/structure/mass_per_length_kg_m", json!(0)),
        ("piano-hammer", "/structure/damping_ratio", json!(-1)),
        ("piano-hammer", "/structure/ends", json!(["pinned", "pinned"])),
        ("piano-hammer", "/contact/exponent", json!(0.5)),
        ("piano-hammer", "/contact/stiffness_n_m_n", json!(0)),
        ("piano-hammer", "/contact/retardation_time_s", json!(1e-4)),
        ("simply-supported-plate", "/structure/theory", json!("mindlin")),
        ("simply-supported-plate", "/structure/shear_coefficient", json!(0.8)),
        ("cantilever-plate", "/structure/theory", json!("mindlin")),
        ("sdnl32", "/modes", json!("auto")),
        ("sdnl32", "/model", json!("rigid")),
        ("moving-beam", "/modes", json!("auto")),
        ("falling-ball", "/model", json!("emoc")),
        ("infinite-plate", "/model", json!("modal")),
        ("infinite-beam", "/modes", json!(3)),
        ("dropped-rod", "/model", json!("rigid")),
        ("dropped-rod", "/striker/immovable", json!(true)),
        ("dropped-rod", "/striker/speed_m_s", json!(0)),
        ("infinite-beam", "/striker/speed_m_s", json!(-1)),
        ("infinite-beam", "/residual_compliance", json!(true)),
        ("dropped-rod", "/modes", json!(5)),
        ("measured-modes", "/model", json!("infinite-beam")),
        ("pinned-beam", "/structure/segments", json!([])),
        ("pinned-beam", "/structure/theory", json!("timoshenko")),
        ("timoshenko-beam", "/structure/axial_force_n", json!(1)),
        ("measured-modes", "/structure", json!({ "kind": "modal", "omega_rad_s": [100] })),
        (
            "measured-modes",
            "/structure",
            json!({ "kind": "modal", "omega_rad_s": [100], "shape_at_location": [1], "static_compliance_m_n": 1e-4,
                    "residual_compliance_m_n": 1e-6 }),
        ),
        ("baseball-bat", "/structure/points", json!({})),
        ("baseball-bat", "/structure/shape_at_location", json!([1])),
        ("pinned-beam", "/contact/poissons_ratio", Value::Null),
        ("pinned-beam", "/contact/stiffness_n_m1_5", json!(1e9)),
        ("pinned-beam", "/contact/striker_poissons_ratio", json!(0.3)),
        ("pinned-beam", "/contact/law", Value::Null),
        ("pinned-beam", "/striker", json!({ "mass_kg": 0.1, "speed_m_s": 1 })),
        ("hysteretic", "/contact/epsilon_m", Value::Null),
        ("viscous", "/contact/restitution", json!(0.5)),
        ("rubber-ball", "/contact/restitution", Value::Null),
        ("linear-stop", "/contact", json!({ "law": "linear", "stiffness_n_m": 1e6 })),
        ("pinned-beam", "/contact", json!({ "law": "elastoplastic", "yield_pressure_pa": 1e9 })),
        ("pinned-beam", "/contact", json!({ "law": "kelvin-voigt", "stiffness_n_m": 1e6 })),
        ("pinned-beam", "/contact", json!({ "law": "hunt-crossley", "stiffness_n_m_n": 1e9, "damping_s_m": 0.1 })),
        (
            "pinned-beam",
            "/contact",
            json!({ "law": "felt", "stiffness_n_m_n": 1e9, "exponent": 1.5, "retardation_time_s": 1e-5 }),
        ),
    ] {
        let mut spoilt = tree(&named(name));
        let (holder, key) = place.rsplit_once('/').unwrap();
        match spoilt.pointer_mut(holder).unwrap() {
            Value::Array(items) => items[key.parse::<usize>().unwrap()] = slip,
            Value::Object(entries) => drop(entries.insert(key.to_owned(), slip)),
            other => panic!("{other}"),
        }
        assert!(!validator.is_valid(&spoilt), "{name}{place}");
        let refused = Scene::from_value(&spoilt).and_then(|scene| scene.simulate().map(drop));
        assert!(refused.is_err(), "{name}{place}");
    }
}

/// Values at the ends of the ranges are right to both.
#[test]
fn the_schema_accepts_what_the_program_accepts() {
    let validator = jsonschema::draft202012::options().build(&schema::of_scenes()).unwrap();
    for (holder, field, value) in [
        ("/structure", "attachments", json!([{ "location_m": 0.5, "mass_kg": 0, "spring_n_m": 0 }])),
        ("", "contact", json!({ "law": "kelvin-voigt", "stiffness_n_m": 1e6, "restitution": 0.999 })),
        ("", "contact", json!({ "law": "hunt-crossley", "stiffness_n_m1_5": 1e9, "restitution": 1 })),
        ("", "modes", json!(4.0)),
        ("", "version", json!(1.0)),
        ("", "contact", json!({ "law": "viscous", "stiffness_n_m1_5": 1e9, "damping_s_m": 0.1, "restitution": null })),
        (
            "",
            "contact",
            json!({ "law": "hertz", "material": "steel", "poissons_ratio": 0.29, "striker_material": "glass" }),
        ),
        ("", "start", json!({ "moving_modes": [{ "mode": 1.0, "velocity_m_s": 0.1 }] })),
    ] {
        let mut scene = tree(&named("pinned-beam"));
        scene.pointer_mut(holder).unwrap()[field] = value;
        assert!(validator.is_valid(&scene), "{scene}");
        assert!(Scene::from_value(&scene).and_then(|scene| scene.impact()).is_ok(), "{scene}");
    }
}

/// Scenes of bodies in the same way. Mistakes are JSON pointers; `null` removes a field.
#[test]
fn the_schema_distinguishes_scenes_of_bodies_from_others() {
    let validator = jsonschema::draft202012::options().build(&schema::of_scenes()).unwrap();
    for (name, scene) in assemblies() {
        let text = fs::read_to_string(datasets(&format!("assemblies/{name}.json"))).unwrap();
        for tree in [serde_json::from_str(&text).unwrap(), serde_json::from_str(&scene.to_json()).unwrap()] {
            let faults: Vec<String> = validator.iter_errors(&tree).map(|fault| fault.to_string()).collect();
            assert!(faults.is_empty(), "{name}: {faults:?}");
        }
    }
    let point = |body: &str| json!({ "body": body });
    for (name, place, slip) in [
        ("sdnl104", "/version", json!(2)),
        ("sdnl104", "/bodies", json!({})),
        ("sdnl104", "/contacts", Value::Null),
        ("sdnl104", "/end_s", Value::Null),
        ("sdnl104", "/end_s", json!(0)),
        ("sdnl104", "/end_s", json!(1e13)),
        ("sdnl104", "/structure", json!({})),
        ("sdnl104", "/gravity_m_s2", json!(-9.81)),
        ("sdnl104", "/tolerance", json!(0.2)),
        ("sdnl104", "/tolerance", json!(1e-14)),
        ("sdnl104", "/static_start", json!("yes")),
        ("sdnl104", "/bodies/beam", json!([])),
        ("sdnl104", "/bodies/ground", json!({ "kind": "mass", "mass_kg": 1 })),
        ("sdnl104", "/bodies/beam/kind", json!("bem")),
        ("sdnl104", "/bodies/beam/kind", Value::Null),
        ("sdnl104", "/bodies/beam/kind", json!("dropped-rod")),
        ("sdnl104", "/bodies/beam/modes", Value::Null),
        ("sdnl104", "/bodies/beam/modes", json!(2.5)),
        ("sdnl104", "/bodies/beam/modes", json!(10_001)),
        ("sdnl104", "/bodies/beam/mass_kg", json!(1)),
        ("sdnl104", "/bodies/beam/segments/0/width_m", json!(0.1)),
        ("sdnl104", "/bodies/beam/gravity_participation_kg0_5", json!([1])),
        ("sdnl104", "/bodies/beam/start", json!({ "gap_m": 0 })),
        ("sdnl104", "/bodies/ball", json!({ "kind": "mass", "mass_kg": 0 })),
        ("sdnl104", "/bodies/ball", json!({ "kind": "mass" })),
        ("sdnl104", "/bodies/ball", json!({ "kind": "mass", "mass_kg": 1, "density_kg_m3": 1 })),
        ("sdnl104", "/bodies/ball", json!({ "kind": "mass", "mass_kg": 1, "modes": 1 })),
        ("two-rods", "/bodies/first/residual_compliance", json!(true)),
        ("two-rods", "/bodies/first/segments/0/area_m2", json!(1)),
        ("two-rods", "/bodies/first/segments/0/density_kg_m3", Value::Null),
        ("two-rods", "/bodies/first/ends/0", json!("clamped")),
        ("two-rods", "/bodies/first/modes", Value::Null),
        ("sdnl104", "/contacts/0", json!("stop")),
        ("sdnl104", "/contacts/0/name", Value::Null),
        ("sdnl104", "/contacts/0/name", json!("")),
        ("sdnl104", "/contacts/0/between", json!([point("beam")])),
        ("sdnl104", "/contacts/0/between", json!(["ground", "ground"])),
        ("sdnl104", "/contacts/0/between/1", json!("wall")),
        ("sdnl104", "/contacts/0/between/0/bodies", json!("beam")),
        ("sdnl104", "/contacts/0/gap_m", json!("wide")),
        ("sdnl104", "/contacts/0/two_sided", json!(1)),
        ("sdnl104", "/contacts/0/law", Value::Null),
        ("sdnl104", "/contacts/0/law", json!("herz")),
        ("sdnl104", "/contacts/0/stiffness_n_m1_5", json!(1)),
        ("sdnl104", "/contacts/0/stiffness_n_m", json!(-1)),
        ("sdnl104", "/contacts/0/colour", json!("red")),
        ("sdnl104", "/contacts/0/youngs_modulus_pa", json!(1e9)),
        ("dropped-ball", "/contacts/0/damping_s_m", Value::Null),
        ("dropped-ball", "/contacts/0/restitution", json!(0.5)),
        ("dropped-ball", "/contacts/0/stiffness_n_m1_5", Value::Null),
        ("impact-damper", "/contacts/0/reduced_mass_kg", Value::Null),
        ("impact-damper", "/contacts/0/damping_n_s_m", json!(1)),
        ("two-rods", "/bodies/first/segments", json!([])),
        ("sdnl104", "/contacts/0/approach_speed_m_s", json!(0)),
        ("sdnl104", "/loads/0/force_n", Value::Null),
        ("sdnl104", "/loads/0/body", Value::Null),
        ("sdnl104", "/loads/0/phase_deg", json!(30)),
        ("sdnl104", "/loads/0/frequency_hz", json!(0)),
        ("sdnl104", "/loads/0/times_s", json!([0, 1])),
        ("sdnl104", "/loads/0", json!({ "body": "beam", "location_m": 1, "times_s": [0], "forces_n": [1] })),
        ("sdnl104", "/loads/0", json!({ "body": "beam", "location_m": 1, "times_s": [0, 1] })),
        ("shaken-table", "/ground_motion/acceleration_m_s2", json!(1)),
        ("shaken-table", "/ground_motion/frequency_hz", Value::Null),
        ("shaken-table", "/ground_motion/displacement_m", Value::Null),
        ("shaken-table", "/ground_motion/times_s", json!([0, 1])),
        ("shaken-table", "/ground_motion/colour", json!(1)),
    ] {
        let mut spoilt: Value = serde_json::from_str(&assembly(name).to_json()).unwrap();
        let (holder, key) = place.rsplit_once('/').unwrap();
        match spoilt.pointer_mut(holder).unwrap_or_else(|| panic!("{name}{place}")) {
            Value::Array(items) => items[key.parse::<usize>().unwrap()] = slip,
            Value::Object(entries) if slip.is_null() => drop(entries.remove(key)),
            Value::Object(entries) => drop(entries.insert(key.to_owned(), slip)),
            other => panic!("{other}"),
        }
        assert!(!validator.is_valid(&spoilt), "the schema passes {name}{place}: {spoilt}");
        let refused = AssemblyScene::from_value(&spoilt).and_then(|scene| scene.pose().map(drop));
        assert!(refused.is_err(), "the program passes {name}{place}");
    }
}

#[test]
fn a_table_of_modes_is_read_from_the_folder_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let scene = |table: &str, location: &str| {
        fs::write(folder.path().join("modes.csv"), table).unwrap();
        let scene = format!(
            r#"{{ "structure": {{ "kind": "modes-file", "file": "modes.csv", "static_compliances_m_n": {{ "tip": 1e-3 }} }},
                 "striker": {{ "mass_kg": 0.1, "speed_m_s": 1 }}, "contact": {{ "law": "hertz", "stiffness_n_m1_5": 1e9 }},
                 "location": "{location}" }}"#
        );
        fs::write(folder.path().join("scene.json"), scene).unwrap();
        Scene::read(&folder.path().join("scene.json"))
    };
    let good = "tip, frequency_hz, modal_mass_kg, damping_ratio, middle\n1,10,4,0.01,0.5\n\n-1,60,1,0.02,0.7\n";
    let read = scene(good, "tip").unwrap();
    let modes = read.structure().unwrap().modes;
    assert!((modes[0].omega_rad_s - 20.0 * std::f64::consts::PI).abs() < 1e-12);
    assert_eq!((modes[0].shape, modes[1].shape, modes[1].damping_ratio), (0.5, -1.0, 0.02));
    // The scene is then self-contained.
    let Structure::Modal(modal) = &read.structure else { panic!() };
    assert_eq!(modal.points["tip"].static_compliance_m_n, Some(1e-3));
    assert_eq!(Scene::from_json(&read.to_json()).unwrap(), read);

    let rows = "tip,omega_rad_s,damping_ratio\n1,10,0.01\n";
    for (table, location, expected) in [
        (rows, "top", r#"location = "top" is not allowed; it must be one of the structure's points "tip""#),
        ("tip,omega_rad_s\n1,10\n1,-5\n", "tip", "modes.csv, line 3, omega_rad_s = -5.0 is not allowed"),
        ("tip,omega_rad_s\n1,10\n\n1,ten\n", "tip", "modes.csv, line 4, omega_rad_s = ten is not allowed"),
        ("tip,omega_rad_s\n1,10\n1\n", "tip", "modes.csv, line 3 = 1 cell is not allowed"),
        ("tip,omega_rad_s\n1,\n", "tip", "modes.csv, line 2, omega_rad_s is missing"),
        ("tip,omega_rad_s,damping_ratio\n1,10,nan\n", "tip", "modes.csv, line 2, damping_ratio = nan"),
        ("tip,omega_rad_s,modal_mass_kg\n1,10,0\n", "tip", "modes.csv, line 2, modal_mass_kg = 0.0"),
        // beyond the ranges of the solver, which no list of a table repeats
        ("tip,omega_rad_s\n1,10\n1,1e200\n", "tip", "modes.csv, line 3, omega_rad_s = 1e+200 is not allowed"),
        (
            "tip,frequency_hz\n1,10\n1,1e200\n",
            "tip",
            "modes.csv, line 3, frequency_hz = 1e+200 is not allowed; it must be such that the angular frequency in rad/s, now 6.28",
        ),
        (
            "tip,side,omega_rad_s,modal_mass_kg\n1,3,10,1e-300\n",
            "tip",
            "modes.csv, line 2, side = 3.0 is not allowed; it must be such that the shape over the square root of modal_mass_kg",
        ),
        ("tip,tip,omega_rad_s\n1,1,10\n", "tip", "modes.csv, column tip = 2 columns"),
        (
            "tip,omega_rad_s,frequency_hz\n1,1,10\n",
            "tip",
            "modes.csv, column frequency_hz = 1 column is not allowed; it must be left out",
        ),
        ("tip,damping_ratio\n1,1\n", "tip", "modes.csv, column omega_rad_s is missing"),
        ("omega_rad_s\n1\n", "tip", "modes.csv, a column with the shapes at a point is missing"),
        ("middle,omega_rad_s\n1,1\n", "tip", "structure.static_compliances_m_n.tip = 0.001 is not allowed"),
        ("", "tip", "modes.csv, column omega_rad_s is missing"),
    ] {
        let told = scene(table, location).map_err(|fault| fault.to_string());
        let told = told.and_then(|scene| scene.impact().map_err(|fault| fault.to_string())).unwrap_err();
        assert!(told.starts_with(expected), "{table}: {told}");
    }
    for outside in ["/etc/passwd", "../modes.csv", "a/../../modes.csv", ""] {
        let mut scene = tree(&read);
        scene["structure"] = json!({ "kind": "modes-file", "file": outside });
        let told = Scene::from_value(&scene).unwrap().read_modes_file(folder.path()).unwrap_err().to_string();
        assert!(told.starts_with("structure.file = "), "{told}");
    }
    // A table that was not read states how to read it.
    let mut scene = tree(&read);
    scene["structure"] = json!({ "kind": "modes-file", "file": "modes.csv" });
    assert!(fault(&scene).to_string().contains("Scene::read"));
    scene["structure"]["file"] = "none.csv".into();
    let told = Scene::from_value(&scene).unwrap().read_modes_file(folder.path()).unwrap_err();
    assert!(matches!(told, SceneError::Read { ref path, .. } if path.ends_with("none.csv")), "{told}");
}

#[test]
fn points_of_a_modal_structure_are_named() {
    let scene = json!({
        "structure": { "kind": "modal", "omega_rad_s": [100, 400], "modal_mass_kg": [4, 1],
            "points": { "tip": { "shape": [2, -1], "static_compliance_m_n": 1 }, "middle": { "shape": [1, 1] } } },
        "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 },
        "location": "tip"
    });
    let with = |place: &str, value: Value| {
        let mut scene = scene.clone();
        let (holder, key) = place.rsplit_once('/').unwrap();
        scene.pointer_mut(holder).unwrap()[key] = value;
        scene
    };
    let posed = Scene::from_value(&scene).unwrap().structure().unwrap();
    assert_eq!((posed.modes[0].shape, posed.modes[1].shape), (1.0, -1.0));
    for (spoilt, field) in [
        (with("/location", json!("top")), "location"),
        (with("/location", json!(null)), "location"),
        (with("/location_m", json!(1)), "location_m"),
        (with("/structure/modal_mass_kg", json!([1])), "structure.modal_mass_kg"),
        (with("/structure/modal_mass_kg", json!([1, -1])), "structure.modal_mass_kg[1]"),
        (with("/structure/omega_rad_s", json!([1, -1])), "structure.omega_rad_s[1]"),
        (with("/structure/damping_ratios", json!([-1, 0])), "structure.damping_ratios[0]"),
        (with("/structure/points/tip/shape", json!([1])), "structure.points.tip.shape"),
        (with("/structure/points/tip/shape", json!([1, 1e200])), "structure.points.tip.shape[1]"),
        (with("/structure/points/tip", json!([1])), "structure.points.tip"),
        (with("/structure/points/tip/colour", json!(1)), "structure.points.tip.colour"),
        (with("/structure/points", json!({})), "structure.points"),
        (with("/structure/shape_at_location", json!([1, 1])), "structure.shape_at_location"),
        (with("/structure/static_compliance_m_n", json!(1)), "structure.static_compliance_m_n"),
    ] {
        assert_eq!(fault(&spoilt).field, field, "{}", fault(&spoilt));
    }
    let mut scene = with("/location", json!("middle"));
    scene["residual_compliance"] = true.into();
    assert_eq!(fault(&scene).field, "structure.points.middle.static_compliance_m_n");
}

#[test]
fn a_residual_compliance_is_that_of_the_modes_beyond_the_list() {
    // The whole compliance is that of the listed modes, 2^2/(4 100^2) + 1/400^2, and the residual one.
    let (listed, residual) = (1e-4 + 6.25e-6, 3e-6);
    let of = |field: &str, value: f64| {
        json!({
            "structure": { "kind": "modal", "omega_rad_s": [100, 400], "modal_mass_kg": [4, 1],
                "points": { "tip": { "shape": [2, -1], (field): value } } },
            "striker": { "mass_kg": 0.1, "speed_m_s": 1 }, "contact": { "law": "hertz", "stiffness_n_m1_5": 1e6 },
            "location": "tip", "residual_compliance": true
        })
    };
    let modes = |scene: &Value| Scene::from_value(scene).unwrap().structure().unwrap().modes;
    let (by_residual, by_whole) =
        (modes(&of("residual_compliance_m_n", residual)), modes(&of("static_compliance_m_n", listed + residual)));
    assert!(by_residual.len() > 2 && by_residual.len() == by_whole.len());
    for (one, other) in by_residual.iter().zip(&by_whole) {
        assert!((one.omega_rad_s / other.omega_rad_s - 1.0).abs() < 1e-9 && (one.shape - other.shape).abs() < 1e-9);
    }
    let mut both = of("residual_compliance_m_n", residual);
    both["structure"]["points"]["tip"]["static_compliance_m_n"] = json!(1);
    for (spoilt, told) in [
        (both, "structure.points.tip.residual_compliance_m_n = 3e-6 is not allowed; it must be left out"),
        (of("residual_compliance_m_n", -1.0), "structure.points.tip.residual_compliance_m_n = -1.0 is not allowed"),
    ] {
        assert!(fault(&spoilt).to_string().starts_with(told), "{}", fault(&spoilt));
    }
}

#[test]
fn motion_before_the_impact_can_be_stated_in_two_ways() {
    let scene = named("moving-beam");
    let by_place = scene.impact().unwrap().start.unwrap();
    let shape_at_middle = {
        let there = Scene { location_m: Some(0.5.into()), start: None, ..scene.clone() };
        there.structure().unwrap().modes[0].shape
    };
    let start = Start { gap_m: 1e-4, rate_m_kg0_5_s: vec![0.5 / shape_at_middle], ..Start::default() };
    assert_eq!(Scene { start: Some(start), ..scene.clone() }.impact().unwrap().start.unwrap(), by_place);

    let moving = |mode: MovingMode| Start { moving_modes: vec![mode], ..Start::default() };
    let one = MovingMode { mode: 1, velocity_m_s: 1.0, ..MovingMode::default() };
    for (start, field) in [
        (Start { gap_m: -1.0, ..Start::default() }, "start.gap_m"),
        (Start { gap_m: f64::NAN, ..Start::default() }, "start.gap_m"),
        (Start { rate_m_kg0_5_s: vec![0.0; 101], ..Start::default() }, "start.rate_m_kg0_5_s"),
        (Start { amplitude_m_kg0_5: vec![f64::INFINITY], ..Start::default() }, "start.amplitude[0]"),
        (moving(MovingMode { mode: 0, ..one.clone() }), "start.moving_modes[0].mode"),
        (moving(MovingMode { mode: 101, ..one.clone() }), "start.moving_modes[0].mode"),
        (moving(MovingMode { mode: 2, location_m: Some(0.5.into()), ..one.clone() }), "start.moving_modes[0].mode"),
        (moving(MovingMode { location_m: Some(2.0.into()), ..one.clone() }), "start.moving_modes[0].location_m"),
        (moving(MovingMode { location: Some("tip".into()), ..one.clone() }), "start.moving_modes[0].location"),
        (moving(MovingMode { velocity_m_s: f64::NAN, ..one.clone() }), "start.moving_modes[0].velocity_m_s"),
    ] {
        let scene = Scene { start: Some(start), ..scene.clone() };
        let told = scene.impact().and_then(|impact| impact.solve()).unwrap_err();
        assert_eq!(told.field, field, "{told}");
    }
    let mut infinite = tree(&named("infinite-beam"));
    infinite["start"] = json!({});
    assert_eq!(Scene::from_value(&infinite).unwrap().infinite_impact().unwrap_err().field, "start");
}

#[test]
fn a_stop_and_a_dropped_rod_accept_only_fields_that_apply() {
    let with = |name: &str, place: &str, value: Value| {
        let mut scene = tree(&named(name));
        let (holder, key) = place.rsplit_once('/').unwrap();
        scene.pointer_mut(holder).unwrap()[key] = value;
        fault(&scene).field
    };
    for (place, value, field) in [
        ("/striker/speed_m_s", json!(1), "striker.speed_m_s"),
        ("/striker/mass_kg", json!(1), "striker.mass_kg"),
        ("/striker/immovable", json!(1), "striker.immovable"),
    ] {
        assert_eq!(with("sdnl32", place, value), field);
    }
    for (place, value, field) in [
        ("/striker/speed_m_s", json!(0), "striker.speed_m_s"),
        ("/striker/mass_kg", json!(1), "striker.mass_kg"),
        ("/location_m", json!(0.1), "location_m"),
        ("/location", json!("end"), "location"),
        ("/modes", json!(10), "modes"),
        ("/start", json!({}), "start"),
        ("/residual_compliance", json!(true), "residual_compliance"),
        ("/structure/inclination_deg", json!(-1), "structure.inclination_deg"),
        ("/structure/length_m", json!(-1), "structure.length_m"),
        ("/structure/damping_ratio", json!(-1), "structure.damping_ratio"),
        ("/structure/bending_modes", json!(100_000), "structure.bending_modes"),
        ("/contact/law", json!("viscous"), "contact.damping_s_m"),
    ] {
        let found = with("dropped-rod", place, value);
        assert!(found == field || field.starts_with("contact") && found.first() == Some("contact"), "{found} {field}");
    }
    // A floor of the rod's own material is half as stiff as a rigid one.
    let stiffness = |scene: &Scene| match scene.impact().unwrap().law {
        vibroimpact::contact_models::Law::Hertz(law) => law.stiffness_n_m1_5,
        other => panic!("{other:?}"),
    };
    let rigid = named("dropped-rod");
    let mut steel = tree(&rigid);
    steel["contact"] = json!({ "law": "hertz", "youngs_modulus_pa": 2.1e11, "poissons_ratio": 0.3 });
    let steel = Scene::from_value(&steel).unwrap();
    assert!((stiffness(&steel) / stiffness(&rigid) - 0.5).abs() < 1e-12);
    assert_eq!(rigid.mode_shapes(3).unwrap().len(), 3);
    // Without integration, the mass is that of the rigid-body motions (thesis Eq. 8.9); a moving beam is not supported.
    let net = rigid.emoc(&vibroimpact::emoc::Parameters::default(), None).unwrap();
    let rod_kg = 7876.74 * std::f64::consts::PI / 4.0 * 0.0127f64.powi(2) * 0.2;
    assert!((net.mass_kg / (rod_kg / 2.5) - 1.0).abs() < 1e-12);
    let moving = named("moving-beam").emoc(&vibroimpact::emoc::Parameters::default(), None);
    assert_eq!(moving.unwrap_err().field, "start");
}

/// A text with a few of its characters replaced, removed or inserted.
fn mutated(mut text: Vec<char>, changes: &[(prop::sample::Index, Option<char>, bool)]) -> String {
    for (at, new, insert) in changes {
        let i = at.index(text.len().max(1)).min(text.len().saturating_sub(1));
        match new {
            Some(new) if *insert => text.insert(i, *new),
            Some(new) => text[i] = *new,
            None => drop(text.remove(i)),
        }
    }
    text.into_iter().collect()
}

proptest! {
    // The draws of a run are the same everywhere, and so is its time; `cargo xtask fuzz` searches further.
    #![proptest_config(ProptestConfig {
        cases: 400,
        rng_seed: RngSeed::Fixed(2019),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Any text is a scene, or is rejected with a position in the text or a field.
    #[test]
    fn mutated_scenes_never_panic(
        which in any::<prop::sample::Index>(),
        in_toml in any::<bool>(),
        changes in prop::collection::vec(
            (any::<prop::sample::Index>(), prop::option::of(prop::sample::select("0-.e{}[]\",=:#\n\u{e9}a9".chars().collect::<Vec<_>>())), any::<bool>()),
            1..4,
        ),
    ) {
        let gallery = gallery();
        let scene = &which.get(&gallery).1;
        let text = if in_toml { scene.to_toml().unwrap() } else { scene.to_json() };
        let text = mutated(text.chars().collect(), &changes);
        let read = if in_toml { Scene::from_toml(&text) } else { Scene::from_json(&text) };
        match read {
            Err(SceneError::Syntax { line, reason, .. }) => prop_assert!(line >= 1 && !reason.is_empty()),
            Err(SceneError::Invalid(fault)) => prop_assert!(!fault.field.is_empty() || fault.value.is_some()),
            Err(other) => prop_assert!(false, "{other}"),
            Ok(scene) if scene.is_infinite() => drop(scene.posed_on_infinite()),
            Ok(scene) => drop(scene.impact()),
        }
    }

    #[test]
    fn arbitrary_tables_of_modes_never_panic(table in "([a-z_0-9.,\\-]{0,12}\n){0,5}\\PC{0,10}") {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("modes.csv"), &table).unwrap();
        let mut scene = Scene { structure: vibroimpact::scene::ModesFile { file: "modes.csv".into(), ..Default::default() }.into(), ..named("baseball-bat") };
        if scene.read_modes_file(folder.path()).is_ok() {
            prop_assert!(matches!(scene.structure, Structure::Modal(_)));
        }
    }
}

#[test]
fn a_scene_that_is_too_large_or_not_text_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.json");
    fs::write(&path, [b'{', 0xff, b'}']).unwrap();
    assert!(matches!(Scene::read(&path), Err(SceneError::Read { .. })));
    fs::File::create(&path).unwrap().set_len(65 << 20).unwrap();
    assert!(Scene::read(&path).unwrap_err().to_string().contains("larger than 64 MiB"));
    assert!(datasets("scenes/README.md").exists());
}

#[test]
fn the_program_reads_every_kind_of_file_and_prints_the_schema() {
    let run = |arguments: &[&std::ffi::OsStr]| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_vibroimpact")).args(arguments).output().unwrap();
        (output.status.code(), String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    assert_eq!(run(&["schema".as_ref()]).1, schema::text(&schema::of_scenes()));
    for (file, headline) in [
        (
            "stepped-shaft.toml",
            "263.1 g striker at 2.000 m/s on a pinned-pinned beam of 3 segments, 700.0 mm, at 350.0 mm",
        ),
        ("baseball-bat.json", "145.0 g striker at 40.00 m/s on a structure given by its modes, at 150_mm"),
        ("sdnl32.json", "immovable stop before a pinned-free beam, 783.0 mm, at 783.0 mm; linear-spring contact"),
        ("dropped-rod.json", "rod of 200.0 mm, 12.70 mm across, dropped at 1.000 m/s on a floor, inclined at 45°"),
    ] {
        let (code, printed, told) = run(&["simulate".as_ref(), datasets("scenes").join(file).as_os_str()]);
        assert_eq!(code, Some(0), "{told}");
        assert!(printed.starts_with(headline), "{printed}");
        assert!(!printed.contains("NaN") && !printed.contains("inf "), "{printed}");
    }
    let folder = tempfile::tempdir().unwrap();
    let newer = folder.path().join("newer.toml");
    fs::write(&newer, "version = 2\n").unwrap();
    let (code, _, told) = run(&["simulate".as_ref(), newer.as_os_str()]);
    assert_eq!(code, Some(2));
    assert!(told.starts_with("error: version = 2 is not allowed"), "{told}");
}

/// A stop has no mass that a message could name.
#[test]
fn a_stop_at_a_held_end_is_refused() {
    let scene = json!({
        "structure": { "kind": "beam", "ends": ["pinned", "free"],
            "segments": [{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }] },
        "striker": { "immovable": true, "speed_m_s": 0 },
        "contact": { "law": "linear-spring", "stiffness_n_m": 1e6 },
        "location_m": 0,
        "modes": 10,
        "start": { "gap_m": 0.001, "moving_modes": [{ "mode": 1, "velocity_m_s": 1, "location_m": 0.5 }] },
    });
    let fault = Scene::from_value(&scene).unwrap().simulate().unwrap_err();
    assert_eq!(fault.field, "striker.immovable", "{fault}");
}
