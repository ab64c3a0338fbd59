//! The program as a user meets it: files in, text, JSON, files and exit codes out.

use std::fs;

use crate::program::{run, stdout};
use serde_json::{Value, json};

/// The scene of the documentation; 40 damped modes of a stepped cantilever.
const SCENE: &str = r#"{ "structure": { "kind": "beam", "ends": ["clamped", "free"],
    "segments": [ { "length_m": 0.5, "youngs_modulus_pa": 2e11, "density_kg_m3": 7800, "width_m": 0.011323, "thickness_m": 0.011323 },
                  { "length_m": 0.5, "flexural_rigidity_n_m2": 34.2, "mass_per_length_kg_m": 0.5 } ],
    "damping_ratio": 0.02 },
  "striker": { "mass_kg": 0.11027, "radius_m": 0.015, "speed_m_s": 1.0 },
  "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 },
  "location_m": 0.4, "modes": 40 }"#;

/// Runs `simulate` on a text, with `--out`, and returns the message; it must reject the input and write nothing.
fn refusal(text: impl AsRef<[u8]>) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), text).unwrap();
    let output = run(folder.path(), &["simulate", "scene.json", "--json", "--out", "results"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(output.stdout.is_empty());
    assert!(!message.contains("panicked"), "{message}");
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["scene.json"], "{message}");
    message
}

/// The scene with one value replaced (`None`: removed), by its JSON pointer.
fn altered(pointer: &str, value: Option<Value>) -> String {
    let mut scene: Value = serde_json::from_str(SCENE).unwrap();
    let (parent, name) = pointer.rsplit_once('/').unwrap();
    let object = scene.pointer_mut(parent).unwrap().as_object_mut().unwrap();
    match value {
        Some(value) => object.insert(name.to_owned(), value),
        None => object.remove(name),
    };
    scene.to_string()
}

#[test]
fn simulate_prints_one_json_object_with_the_promised_keys() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), SCENE).unwrap();
    let result: Value =
        serde_json::from_str(&stdout(&run(folder.path(), &["simulate", "scene.json", "--json"]))).unwrap();

    assert_eq!(result["outcome"], "rebound");
    assert_eq!(result["modes"], 40);
    let restitution = result["restitution"].as_f64().unwrap();
    assert!(restitution > 0.0 && restitution < 1.0);
    assert!((restitution - result["striker_velocity_m_s"].as_f64().unwrap()).abs() < 1e-14);
    assert!(result["uncertainty"]["solver"].as_f64().unwrap() < 1e-6);
    assert!(result["restitution_uncertainty"].as_f64() >= result["uncertainty"]["modes_left_out"].as_f64());

    let contacts = result["sub_impacts"].as_array().unwrap();
    assert_eq!(result["sub_impact_count"], contacts.len());
    let number = |value: &Value, key: &str| value[key].as_f64().unwrap_or_else(|| panic!("{key} in {value}"));
    for pair in contacts.windows(2) {
        assert!(number(&pair[0], "end_s") <= number(&pair[1], "start_s"));
    }
    for contact in contacts {
        assert!(number(contact, "start_s") < number(contact, "end_s"));
        assert!(number(contact, "peak_force_n") > 0.0 && number(contact, "peak_compression_m") > 0.0);
    }
    // The impulses have reversed the striker.
    let impulse: f64 = contacts.iter().map(|contact| number(contact, "impulse_n_s")).sum();
    assert!((impulse / (0.11027 * (1.0 + restitution)) - 1.0).abs() < 1e-9);

    let energy = &result["energy"];
    let parts =
        ["striker_j", "structure_j", "modal_damping_j", "contact_j", "residual_j"].map(|key| number(energy, key));
    let initial = number(energy, "initial_j");
    assert!((initial - 0.5 * 0.11027).abs() < 1e-15);
    assert!((parts.iter().sum::<f64>() - initial).abs() < 1e-14);
    assert!(number(energy, "residual_j").abs() < 1e-9 * initial);
    assert_eq!(energy["modes_j"].as_array().unwrap().len(), 40);
    assert!(number(&result["counts"], "contact_steps") > 0.0);
}

#[test]
fn simulate_without_json_is_for_readers() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), SCENE).unwrap();
    let text = stdout(&run(folder.path(), &["simulate", "scene.json"]));
    for part in ["restitution", "rebound", "sub-impacts", "peak force", "clamped-free beam of 2 segments"] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// A mode that takes hours to come back: its second contact lasts a millionth of a millionth of that.
#[test]
fn times_of_many_digits_keep_their_columns_apart() {
    let folder = tempfile::tempdir().unwrap();
    let scene = json!({
        "structure": { "kind": "modal", "omega_rad_s": [1e-4], "shape_at_location": [1] },
        "striker": { "mass_kg": 10, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": 1e12 }
    });
    fs::write(folder.path().join("scene.json"), scene.to_string()).unwrap();
    let text = stdout(&run(folder.path(), &["simulate", "scene.json"]));
    let second = text.lines().find(|line| line.starts_with("    2 ")).unwrap();
    let words: Vec<&str> = second.split_whitespace().collect();
    // the uncertainty of the force has a sign, a number and a unit, or is not known
    assert!([13, 15].contains(&words.len()), "{text}");
    assert!(words[1].len() >= 12 && words[2] == "ks" && words[4] == "ks", "{text}");
}

/// A free body that moves away faster than the ball approaches.
#[test]
fn bodies_that_never_meet_are_a_result_with_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let scene = json!({
        "structure": { "kind": "modal", "omega_rad_s": [0], "shape_at_location": [1] },
        "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 },
        "start": { "moving_modes": [{ "mode": 1, "velocity_m_s": -2 }] }
    });
    fs::write(folder.path().join("scene.json"), scene.to_string()).unwrap();
    let printed = stdout(&run(folder.path(), &["simulate", "scene.json", "--json", "--out", "a"]));
    let result: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!((result["outcome"].as_str(), result["sub_impact_count"].as_u64()), (Some("no contact"), Some(0)));
    assert!(folder.path().join("a/history.csv").exists());
}

#[test]
fn out_writes_histories_picture_and_result() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), SCENE).unwrap();
    let printed = stdout(&run(folder.path(), &["simulate", "scene.json", "--json", "--out", "a/b"]));
    let read = |name: &str| fs::read_to_string(folder.path().join("a/b").join(name)).unwrap();
    assert_eq!(read("result.json"), printed);
    assert!(read("impact.svg").starts_with("<svg"));
    assert_eq!(fs::read_dir(folder.path().join("a/b")).unwrap().count(), 5);

    let result: Value = serde_json::from_str(&printed).unwrap();
    let history = read("history.csv");
    let mut rows = csv::Reader::from_reader(history.as_bytes());
    assert_eq!(
        rows.headers().unwrap().iter().collect::<Vec<_>>().join(","),
        "time_s,structure_displacement_m,striker_displacement_m,structure_velocity_m_s,striker_velocity_m_s,\
         compression_m,force_n"
    );
    let rows: Vec<[f64; 7]> = rows.deserialize().map(|row| row.unwrap()).collect();
    assert!(rows.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    assert!((rows[0][4] + 1.0).abs() < 1e-12);
    assert!((rows[rows.len() - 1][4] - result["striker_velocity_m_s"].as_f64().unwrap()).abs() < 1e-14);
    let peak = rows.iter().map(|row| row[6]).fold(0.0, f64::max);
    let reported = result["sub_impacts"][0]["peak_force_n"].as_f64().unwrap();
    assert!((peak / reported - 1.0).abs() < 0.01, "{peak} {reported}");

    let energies = read("modal_energies.csv");
    assert_eq!(energies.lines().next().unwrap().split(',').count(), 41);
    assert_eq!(read("sub_impacts.csv").lines().count() - 1, result["sub_impacts"].as_array().unwrap().len());

    // A second run replaces the files by the same bytes.
    stdout(&run(folder.path(), &["simulate", "scene.json", "--json", "--out", "a/b", "--force"]));
    assert_eq!(read("history.csv"), history);
    assert_eq!(fs::read_dir(folder.path().join("a/b")).unwrap().count(), 5);
}

#[test]
fn a_folder_that_cannot_be_made_is_not_an_error_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), SCENE).unwrap();
    let output = run(folder.path(), &["simulate", "scene.json", "--out", "scene.json/results"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot write to scene.json/results"));
    assert!(String::from_utf8_lossy(&output.stdout).contains("restitution"));
}

#[test]
fn modes_lists_frequencies_and_shapes_in_the_form_of_a_modal_structure() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), SCENE).unwrap();
    let printed = stdout(&run(folder.path(), &["modes", "scene.json", "--count", "40", "--json"]));
    let modes: Value = serde_json::from_str(&printed).unwrap();
    let list = |key: &str| -> Vec<f64> { serde_json::from_value(modes[key].clone()).unwrap() };
    let (omega, frequency, shape) = (list("omega_rad_s"), list("frequency_hz"), list("shape_at_location"));
    assert_eq!((omega.len(), frequency.len(), shape.len()), (40, 40, 40));
    assert!(omega.windows(2).all(|pair| pair[0] < pair[1]));
    assert!((omega[7] / frequency[7] - std::f64::consts::TAU).abs() < 1e-14);

    let table = stdout(&run(folder.path(), &["modes", "scene.json", "--count", "3"]));
    assert_eq!(table.lines().count(), 4);
    // without a number, ten of them
    assert_eq!(stdout(&run(folder.path(), &["modes", "scene.json"])).lines().count(), 11);

    // The same impact, defined by those modes.
    let modal = json!({
        "structure": { "kind": "modal", "omega_rad_s": omega, "shape_at_location": shape, "damping_ratios": vec![0.02; 40] },
        "striker": { "mass_kg": 0.11027, "radius_m": 0.015, "speed_m_s": 1.0 },
        "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 },
    });
    fs::write(folder.path().join("modal.json"), modal.to_string()).unwrap();
    let short = ["--set", "structure.omega_rad_s=[10,20]", "--set", "structure.shape_at_location=[1,1]"];
    let undamped = ["--set", "structure.damping_ratios=[0,0]"];
    let table = stdout(&run(folder.path(), &[&["modes", "modal.json"][..], &short, &undamped].concat()));
    assert_eq!(table.lines().count(), 3);
    let result = |name: &str| {
        let mut result: Value =
            serde_json::from_str(&stdout(&run(folder.path(), &["simulate", name, "--json"]))).unwrap();
        // Everything except the text of the reason, the scene, and the statements on truncated modes and thickness, which a
        // list of modes does not have.
        let fields = result.as_object_mut().unwrap();
        let choice = fields.remove("choice").unwrap();
        fields.remove("scene");
        fields.remove("trust");
        fields.remove("restitution_uncertainty").unwrap();
        let uncertainty = fields.remove("uncertainty").unwrap();
        fields.remove("peak_forces_not_known").unwrap();
        for contact in fields["sub_impacts"].as_array_mut().unwrap() {
            let contact = contact.as_object_mut().unwrap();
            contact.remove("peak_force_uncertainty_n").unwrap();
            contact["peak_force_uncertainty_parts_n"] = contact["peak_force_uncertainty_parts_n"]["solver"].clone();
        }
        (result, choice["restitution"].clone(), uncertainty["solver"].clone())
    };
    assert_eq!(result("modal.json"), result("scene.json"));
}

#[test]
fn values_out_of_range_are_refused_by_field_value_and_range() {
    for (pointer, value, field, allowed) in [
        ("/structure/segments/0/length_m", json!(-0.5), "structure.segments[0].length_m = -0.5", "greater than 0"),
        ("/structure/segments/0/length_m", json!(0), "structure.segments[0].length_m = 0.0", "greater than 0"),
        (
            "/structure/segments/1/mass_per_length_kg_m",
            json!(0),
            "structure.segments[1].mass_per_length_kg_m",
            "greater than 0",
        ),
        ("/structure/segments/0/thickness_m", json!(-1), "structure.segments[0].thickness_m = -1.0", "greater than 0"),
        ("/structure/segments/0/length_m", json!(1e200), "structure.segments[0].length_m = 1e+200", "1e60"),
        ("/structure/segments", json!([]), "structure.segments = []", "at least one"),
        ("/structure/damping_ratio", json!(-0.02), "structure.damping_ratio = -0.02", "from 0 to 1e6"),
        ("/structure/kind", json!("shell"), "structure.kind = \"shell\"", "plate"),
        (
            "/structure/ends",
            json!(["clamped", "welded"]),
            "structure.ends[1] = \"welded\"",
            "clamped, pinned, free, guided",
        ),
        ("/location_m", json!(1.5), "location_m = 1.5", "from 0 to its length"),
        ("/location_m", json!(-0.1), "location_m = -0.1", "from 0 to its length"),
        ("/striker/mass_kg", json!(0), "striker.mass_kg = 0.0", "greater than 0"),
        ("/striker/mass_kg", json!(-1), "striker.mass_kg = -1.0", "greater than 0"),
        ("/striker/radius_m", json!(0), "striker.radius_m = 0.0", "greater than 0"),
        (
            "/striker/density_kg_m3",
            json!(1000),
            "striker.mass_kg = 0.11027",
            "left out in the presence of density_kg_m3",
        ),
        ("/striker/speed_m_s", json!(1e300), "striker.speed_m_s = 1", "1e30"),
        ("/contact/law", json!("herz"), "contact.law = \"herz\"", "hertz, viscous, hysteretic"),
        ("/contact/poissons_ratio", json!(0.7), "contact.poissons_ratio = 0.7", "0.5"),
        ("/contact/youngs_modulus_pa", json!(-2e11), "contact.youngs_modulus_pa = -200000000000", "greater than 0"),
        ("/contact/stiffness_n_m1_5", json!(1e10), "contact.stiffness_n_m1_5 = 10000000000", "left out"),
        ("/contact/striker_poissons_ratio", json!(0.2), "contact.striker_youngs_modulus_pa is missing", "give"),
        ("/modes", json!(1_000_000_000), "modes = 1000000000", "from 0 to 10000"),
        ("/tolerance", json!(0), "tolerance = 0", "1e-13"),
    ] {
        let message = refusal(altered(pointer, Some(value)));
        assert!(message.contains(field) && message.contains(allowed), "{field}, {allowed}: {message}");
    }
}

#[test]
fn missing_fields_are_named() {
    for (pointer, field) in [
        ("/structure", "structure is missing"),
        ("/structure/kind", "structure.kind is missing"),
        ("/structure/ends", "structure.ends is missing"),
        ("/structure/segments", "structure.segments is missing"),
        ("/structure/segments/0/length_m", "structure.segments[0].length_m is missing"),
        ("/structure/segments/0/density_kg_m3", "structure.segments[0].density_kg_m3 is missing"),
        ("/structure/segments/1/mass_per_length_kg_m", "structure.segments[1].mass_per_length_kg_m is missing"),
        ("/striker/mass_kg", "striker.mass_kg is missing"),
        ("/striker/radius_m", "striker.radius_m is missing"),
        ("/striker/speed_m_s", "striker.speed_m_s is missing"),
        ("/contact/law", "contact.law is missing"),
        ("/contact/poissons_ratio", "contact.poissons_ratio is missing"),
        ("/location_m", "location_m is missing"),
    ] {
        let message = refusal(altered(pointer, None));
        assert!(message.contains(field), "{field}: {message}");
    }
}

#[test]
fn wrong_types_and_unknown_fields_are_named() {
    for (pointer, value, field) in [
        ("/structure", json!(7), "structure = 7"),
        ("/structure/segments/1", json!({ "length_m": "half" }), "structure.segments[1].length_m = \"half\""),
        ("/structure/segments", json!([[0.5, 34.2, 0.5]]), "structure.segments[0] = [0.5,34.2,0.5]"),
        ("/structure/ends", json!(["clamped"]), "structure.ends = [\"clamped\"]"),
        ("/striker", json!([0.1, null, 0.015, 1]), "striker = [0.1,null,0.015,1]"),
        ("/striker/speed_m_s", json!("fast"), "striker.speed_m_s = \"fast\""),
        ("/contact", json!("hertz"), "contact = \"hertz\""),
        ("/contact/poissons_ratio", json!([0.3]), "contact.poissons_ratio = [0.3]"),
        ("/contact/damping_s_m", json!(0.08), "contact.damping_s_m = 0.08"),
        ("/modes", json!(40.5), "modes = 40.5"),
        ("/modes", json!(-4), "modes = -4"),
        ("/residual_compliance", json!(1), "residual_compliance = 1"),
        ("/start", json!(3), "start = 3"),
        ("/friction", json!(0.3), "friction = 0.3"),
        ("/structure/segments/1/lenght_m", json!(1), "structure.segments[1].lenght_m = 1"),
    ] {
        let scene = if pointer == "/structure/segments/1" {
            SCENE.replace(r#""length_m": 0.5, "flex"#, r#""length_m": "half", "flex"#)
        } else {
            altered(pointer, Some(value))
        };
        let message = refusal(scene);
        assert!(message.contains(field) && message.contains(": "), "{field}: {message}");
        assert!(!message.contains("with structure, striker and contact"), "of the whole scene: {message}");
    }
}

#[test]
fn texts_that_are_not_json_are_refused_with_line_and_column() {
    for (text, part) in [
        (SCENE.replace("0.02", "NaN"), "structure.damping_ratio = NaN"),
        (SCENE.replace("0.02", "-Infinity"), "structure.damping_ratio = -Infinity"),
        (SCENE.replace("0.02", "1e999"), "structure.damping_ratio = 1e999"),
        (SCENE.replace("0.02", ".02"), "in structure.damping_ratio"),
        (SCENE.replace("0.02 }", "0.02, \"damping_ratio\": 0.02 }"), "\"damping_ratio\" occurs twice"),
        ("{ \"as at line 3\": 1, \"as at line 3\": 2 }".to_owned(), "the key \"as at line 3\" occurs twice"),
        (SCENE[..300].to_owned(), "ends too early"),
        (String::new(), "ends too early"),
        (" \n".to_owned(), "ends too early"),
        (format!("{SCENE} {SCENE}"), "trailing characters"),
        ("[".repeat(100_000), "recursion limit"),
        ("null".to_owned(), "the scene = null"),
    ] {
        let message = refusal(&text);
        assert!(message.contains(part), "{part}: {message}");
    }
    assert!(refusal([0xff, 0xfe, 0x00]).contains("UTF-8"));
}

#[test]
fn usage_errors_exit_with_2_as_well() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), SCENE).unwrap();
    for arguments in [
        &["simulate"][..],
        &["simulate", "nowhere.json"],
        &["simulate", "."],
        &["simulate", "scene.json", "--jason"],
        &["modes"],
        &["modes", "scene.json", "--count", "many"],
        &["modes", "scene.json", "--count", "99999999"],
        &["fly"],
        &[],
    ] {
        assert_eq!(run(folder.path(), arguments).status.code(), Some(2), "{arguments:?}");
    }
    assert!(stdout(&run(folder.path(), &["--version"])).starts_with("vibroimpact "));
    assert!(stdout(&run(folder.path(), &["simulate", "--help"])).contains("Examples:"));
    assert!(stdout(&run(folder.path(), &["--help"])).contains("\"structure\""));
}

#[test]
fn columns_of_the_table_of_modes_never_run_together() {
    let modes = [(0.0, 1e30), (1e-30, -1e30), (1e15, 1e-100), (1.0, 0.25)];
    let mode =
        |(omega_rad_s, shape)| vibroimpact::vibroimpact_sim::modal::Mode { omega_rad_s, damping_ratio: 0.0, shape };
    let text = vibroimpact::text::modes(&modes.map(mode), None);
    for (line, (_, shape)) in text.lines().skip(1).zip(modes) {
        let cells: Vec<&str> = line.split_whitespace().collect();
        assert!(cells.len() == 4 && cells[3].parse() == Ok(shape), "{line}");
    }
    assert!(text.ends_with("        0.25000000\n"), "{text}");
}
