//! Invalid input as a user meets it: exit code 2, a message that states what would be allowed, and nothing written.

use std::fs;
use std::path::Path;

use crate::program::{run, stdout};
use serde_json::Value;
use tempfile::TempDir;

const BEAM: &str = r#"{
    "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.02,
                   "segments": [{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }] },
    "striker": { "mass_kg": 0.2, "speed_m_s": 1 },
    "contact": { "law": "hertz", "stiffness_n_m1_5": 1.8e10 },
    "location_m": 0.3
}"#;
const TABLE: &str = "mass_kg,location_m,restitution\n0.1,0.2,0.5\n0.2,0.4,0.4\n0.3,0.3,0.3\n0.1,0.5,0.35\n";

/// A folder with files of these names.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Runs the program, which must reject the input and write nothing, and returns the message.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let names = || {
        let mut names: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let before = names();
    let output = run(folder, arguments);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert_eq!(names(), before, "{arguments:?}");
    message
}

#[test]
fn fit_takes_only_data_that_can_be_fitted() {
    let header = "mass_kg,location_m,restitution\n";
    let fit = ["fit", "data.csv", "--scene", "scene.json"];
    for (table, part) in [
        (
            TABLE.replace("0.35", "1.3"),
            "data.csv, line 5, restitution = 1.3 is not allowed; it must be a coefficient of restitution from 0",
        ),
        (TABLE.replace("0.35", "-0.3"), "data.csv, line 5, restitution = -0.3"),
        (TABLE.replace("0.4\n", "0.4,7\n"), "data.csv, line 3 = 4 cells is not allowed"),
        (TABLE.replace(",0.4\n", "\n"), "data.csv, line 3 = 2 cells is not allowed"),
        // lines that end with a carriage return alone, as some spreadsheets write them
        (TABLE.replace(",0.4\n", "\n").replace('\n', "\r"), "data.csv, line 3 = 2 cells is not allowed"),
        (
            format!("{header}{}", "0.1,0.2,0.5\n".repeat(5)),
            "data.csv, lines of data that differ in mass or location = 1",
        ),
        (
            format!("{header}{}", "0.1,0.2,0.5\n0.2,0.2,0.5\n".repeat(5)),
            "data.csv, lines of data that differ in mass or location = 2",
        ),
    ] {
        let folder = folder(&[("scene.json", BEAM), ("data.csv", &table)]);
        let message = refused(folder.path(), &fit);
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn a_parameter_that_the_data_do_not_determine_is_not_called_converged() {
    // With light strikers only, mu0 may have any small value, and the restitution then depends on neither of the others.
    let table: String = (1..10).map(|i| format!("{},0.{i},0.99\n", 1e-4 * f64::from(i))).collect();
    let table = format!("mass_kg,location_m,restitution\n{table}");
    let folder = folder(&[("scene.json", BEAM), ("data.csv", &table)]);
    let fit = ["fit", "data.csv", "--scene", "scene.json"];
    let found: Value = serde_json::from_str(&stdout(&run(folder.path(), &[&fit[..], &["--json"]].concat()))).unwrap();
    let runaway: Vec<&str> = ["mu0", "alpha0", "alpha1"]
        .into_iter()
        .filter(|name| !(1e-6..=1e6).contains(&found[*name].as_f64().unwrap()))
        .collect();
    assert_eq!(runaway, ["mu0"], "{found}");
    assert_eq!(found["undetermined"], serde_json::json!(["mu0", "alpha0", "alpha1"]));
    assert_eq!((&found["converged"], &found["intervals"]), (&Value::Bool(false), &Value::Null));
    assert!(stdout(&run(folder.path(), &fit)).contains("not determined by these data"));
}

/// Text that is no number, and numbers out of range, of every option that asks for a number.
#[test]
fn numbers_of_options_are_refused_with_their_range() {
    let folder = folder(&[("scene.json", BEAM), ("data.csv", TABLE)]);
    let identify = ["identify", "data.csv", "--scene", "scene.json", "--free", "contact.stiffness_n_m1_5"];
    let predictability = ["predictability", "scene.json", "--over", "location_m=0.1:0.2:3", "--blur", "location_m=1%"];
    for (command, option, values, allowed) in [
        (&["orbit", "scene.json"][..], "--periods", ["0", "1001", "1e2"], "a whole number from 1 to 1000"),
        (&["orbit", "scene.json"], "--search", ["-1", "10000001", "x"], "a whole number from 0 to 10000000"),
        (&["orbit", "scene.json"], "--transient", ["-1", "4294967296", "x"], "a whole number from 0 to 4294967295"),
        (&["orbit", "scene.json", "--over", "end_s"], "--branches", ["-1", "9", ""], "a whole number from 0 to 8"),
        (&["sweep", "sweep.json", "--out", "out"], "--threads", ["0", "4097", "x"], "a whole number from 1 to 4096"),
        (&identify, "--starts", ["0", "1001", "x"], "a whole number from 1 to 1000"),
        (
            &predictability,
            "--draws",
            ["-1", "1e3", "99999999999999999999"],
            "a whole number from 0 to 18446744073709551615",
        ),
        (&["infinite-beam", "turning-points"], "--count", ["0", "61", "x"], "a whole number from 1 to 60"),
        (&["emoc", "scene.json"], "--mu0", ["x", "1,5", ""], "a number"),
        (&["emoc", "scene.json"], "--alpha0", ["x", "1,5", ""], "a number"),
        (&["emoc", "scene.json"], "--alpha1", ["x", "1,5", ""], "a number"),
    ] {
        for value in values {
            let message = refused(folder.path(), &[command, &[&format!("{option}={value}")]].concat());
            let part = format!("invalid value '{value}' for '{option}");
            assert!(message.contains(&part) && message.contains(&format!("it must be {allowed}")), "{message}");
        }
    }
}

#[test]
fn structures_without_modes_are_refused() {
    let folder = folder(&[
        ("scene.json", BEAM),
        ("data.csv", TABLE),
        ("modes.csv", "omega_rad_s,tip\n"),
        (
            "table.json",
            r#"{ "structure": { "kind": "modes-file", "file": "modes.csv" }, "location": "tip",
                 "striker": { "mass_kg": 1, "speed_m_s": 1 }, "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 } }"#,
        ),
        (
            "list.json",
            r#"{ "structure": { "kind": "modal", "omega_rad_s": [], "shape_at_location": [] },
                 "striker": { "mass_kg": 1, "speed_m_s": 1 }, "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 } }"#,
        ),
        ("rigid.json", &BEAM.replace("\"location_m\"", "\"modes\": 0, \"location_m\"")),
    ]);
    for (arguments, part) in [
        (&["modes", "scene.json", "--count", "0"][..], "from 1 to 10000"),
        (&["modes", "scene.json", "--count", "1000000000"], "from 1 to 10000"),
        (&["modes", "scene.json", "--count", "-1"], "from 1 to 10000"),
        (&["modes", "scene.json", "--count", "many"], "from 1 to 10000"),
        (&["emoc", "scene.json", "--emoc-modes", "0"], "from 1 to 10000"),
        (&["fit", "data.csv", "--scene", "scene.json", "--emoc-modes", "0"], "from 1 to 10000"),
        (&["emoc", "rigid.json"], "modes = 0 is not allowed"),
        (&["simulate", "table.json"], "modes.csv, number of modes = 0 is not allowed"),
        (&["simulate", "list.json"], "structure.omega_rad_s = [] is not allowed"),
    ] {
        let message = refused(folder.path(), arguments);
        assert!(message.contains(part) && !message.contains("auto"), "{arguments:?}: {message}");
    }
}

#[test]
fn a_damping_ratio_is_reported_by_its_name_in_the_scene() {
    let folder = folder(&[
        ("scene.json", &BEAM.replace("0.02", "1e7")),
        ("stated.json", &BEAM.replace("0.02", "1e7").replace("\"location_m\"", "\"modes\": 4, \"location_m\"")),
        ("modes.csv", "omega_rad_s,damping_ratio,tip\n10,1e7,1\n"),
        (
            "table.json",
            r#"{ "structure": { "kind": "modes-file", "file": "modes.csv" }, "location": "tip",
                 "striker": { "mass_kg": 1, "speed_m_s": 1 }, "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 } }"#,
        ),
    ]);
    for (scene, part) in [
        ("scene.json", "structure.damping_ratio = 10000000.0 is not allowed; it must be a number from 0 to 1e6"),
        ("stated.json", "structure.damping_ratio = 10000000.0 is not allowed; it must be a number from 0 to 1e6"),
        (
            "table.json",
            "modes.csv, line 2, damping_ratio = 10000000.0 is not allowed; it must be a number from 0 to 1e6",
        ),
    ] {
        let message = refused(folder.path(), &["simulate", scene]);
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn for_a_mistyped_name_the_probable_one_is_suggested() {
    for (from, to, meant) in [
        ("\"beam\"", "\"bem\"", "beam"),
        ("\"beam\"", "\"dropped_rod\"", "dropped-rod"),
        ("\"hertz\"", "\"herz\"", "hertz"),
        ("\"pinned\", \"pinned\"", "\"pined\", \"pinned\"", "pinned"),
        ("\"length_m\"", "\"lenght_m\"", "length_m"),
        ("\"speed_m_s\"", "\"speed\"", "speed_m_s"),
        ("\"stiffness_n_m1_5\"", "\"stiffness\"", "stiffness_n_m1_5"),
        ("\"location_m\"", "\"locaton_m\"", "location_m"),
        ("\"location_m\"", "\"model\": \"modl\", \"location_m\"", "modal"),
    ] {
        let folder = folder(&[("scene.json", &BEAM.replacen(from, to, 1))]);
        let message = refused(folder.path(), &["simulate", "scene.json"]);
        assert!(message.contains(&format!("did you mean {meant}?")), "{to}: {message}");
    }
    let folder = folder(&[("scene.json", &BEAM.replace("\"hertz\"", "\"granite\""))]);
    assert!(!refused(folder.path(), &["simulate", "scene.json"]).contains("did you mean"));
    let message = refused(folder.path(), &["simulat", "scene.json"]);
    assert!(message.contains("simulate"), "{message}");
}

#[test]
fn messages_are_short_and_cannot_control_a_terminal() {
    let escape = '\u{1b}';
    let digits = "9".repeat(400);
    let folder = folder(&[
        ("value.json", &BEAM.replace("\"hertz\"", r#""her\u001b[2Jtz""#)),
        ("name.json", &BEAM.replace("\"location_m\"", r#""loc\u001b[2Jation_m""#)),
        ("broken.json", &BEAM.replace("\"hertz\"", &format!("{escape}[2J"))),
        ("toml.toml", &format!("location_m = {escape}[2J")),
        ("long.json", &BEAM.replace("0.3", &digits)),
        ("long_name.json", &BEAM.replace("\"location_m\"", &format!("\"{digits}\""))),
        ("data.csv", &TABLE.replace("0.35", &format!("{escape}[2J"))),
        ("scene.json", BEAM),
    ]);
    let name = format!("a{escape}[2J.json");
    let endless = format!("--s={digits}x");
    for arguments in [
        &["simulate", "value.json"][..],
        &["simulate", "name.json"],
        &["simulate", "broken.json"],
        &["simulate", "toml.toml"],
        &["simulate", "long.json"],
        &["simulate", "long_name.json"],
        &["simulate", &name],
        &["simulate", "scene.json", "--plot", &name],
        &["fit", "data.csv", "--scene", "scene.json"],
        &["modes", "scene.json", "--count", &digits],
        &["modes", "scene.json", "--count", &name],
        &["infinite-beam", &endless],
    ] {
        let message = refused(folder.path(), arguments);
        assert!(!message.contains(escape), "{arguments:?}: {message:?}");
        assert!(!message.contains(&digits[..100]), "{arguments:?}: {message:?}");
    }
    // A name that is allowed is printed, but cannot control a terminal either.
    let points = r#"{ "structure": { "kind": "modal", "omega_rad_s": [9], "points": { "t\u001b[2J": { "shape": [1] } } },
        "location": "t\u001b[2J", "striker": { "mass_kg": 1, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 } }"#;
    fs::write(folder.path().join("points.json"), points).unwrap();
    let printed = stdout(&run(folder.path(), &["simulate", "points.json"]));
    assert!(printed.contains(", at t\\u{1b}[2J;") && !printed.contains(escape), "{printed:?}");
}

#[test]
fn a_text_with_the_extension_of_another_format_is_recognised() {
    let toml = "location_m = 0.3\n[structure]\nkind = 'beam'\n";
    let folder = folder(&[("scene.json", toml), ("scene.toml", BEAM), ("neither.json", "location_m"), ("e.json", "")]);
    let message = refused(folder.path(), &["simulate", "scene.json"]);
    assert!(message.contains("the text is TOML") && message.contains("ends in .toml"), "{message}");
    let message = refused(folder.path(), &["simulate", "scene.toml"]);
    assert!(message.contains("the text is JSON") && message.contains("ends in .json"), "{message}");
    for name in ["neither.json", "e.json"] {
        assert!(!refused(folder.path(), &["simulate", name]).contains("the text is TOML"));
    }
}

#[test]
fn nothing_that_exists_is_replaced_without_force() {
    let quick = BEAM.replace("\"location_m\"", "\"modes\": 4, \"location_m\"");
    let folder = folder(&[("scene.json", &quick), ("mine.svg", "mine"), ("mine.html", "mine")]);
    fs::create_dir(folder.path().join("out")).unwrap();
    fs::write(folder.path().join("out/result.json"), "mine").unwrap();
    fs::write(folder.path().join("out/contacts.csv"), "mine").unwrap();
    let simulate = ["simulate", "scene.json"];
    let modes = ["modes", "scene.json", "--count", "3"];
    let infinite = ["infinite-beam", "--s", "1"];
    let (plot, report, out) = (["--plot", "mine.svg"], ["--report", "mine.html"], ["--out", "out"]);
    let commands = [
        [&simulate[..], &plot].concat(),
        [&simulate[..], &report].concat(),
        [&simulate[..], &out].concat(),
        [&infinite[..], &plot].concat(),
        [&infinite[..], &report].concat(),
        [&infinite[..], &out].concat(),
        [&modes[..], &plot].concat(),
        [&["compare", "scene.json"][..], &plot].concat(),
    ];
    for command in &commands {
        let message = refused(folder.path(), command);
        assert!(message.contains("--force"), "{message}");
    }
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    for name in ["mine.svg", "mine.html", "out/result.json", "out/contacts.csv"] {
        assert_eq!(read(name), "mine");
    }
    for command in &commands {
        stdout(&run(folder.path(), &[&command[..], &["--force"]].concat()));
    }
    for name in ["mine.svg", "mine.html", "out/result.json"] {
        assert_ne!(read(name), "mine");
    }
    // Remains of an earlier result could be mistaken for a part of this one.
    stdout(&run(folder.path(), &[&simulate[..], &out, &["--force"]].concat()));
    assert!(!folder.path().join("out/contacts.csv").exists() && folder.path().join("out/history.csv").exists());
    fs::write(folder.path().join("drop.toml"), stdout(&run(folder.path(), &["init", "--kind", "bodies", "-"])))
        .unwrap();
    let bodies = stdout(&run(folder.path(), &[&["simulate", "drop.toml", "--force"][..], &out].concat()));
    let names = ["result.json", "history.csv", "run.svg", "report.html", "intervals.csv", "intervals.parquet"];
    assert!(bodies.contains(&format!("wrote {} to out\n", names.join(", "))), "{bodies}");
    assert!(names.iter().all(|name| folder.path().join("out").join(name).exists()));
    assert!(!folder.path().join("out/impact.svg").exists());
    stdout(&run(folder.path(), &[&simulate[..], &out, &["--force"]].concat()));
    assert!(names[2..].iter().all(|name| !folder.path().join("out").join(name).exists()));
}

#[test]
fn options_that_would_replace_the_file_of_another_are_refused() {
    let quick = BEAM.replace("\"location_m\"", "\"modes\": 4, \"location_m\"");
    let folder = folder(&[("scene.json", &quick), ("file", "mine")]);
    fs::write(folder.path().join("drop.toml"), stdout(&run(folder.path(), &["init", "--kind", "bodies", "-"])))
        .unwrap();
    let simulate = ["simulate", "scene.json"];
    for (command, options, names) in [
        (&simulate[..], &["--plot", "a.svg", "--animate", "./b/../a.svg"][..], ["--animate", "--plot = a.svg"]),
        (&simulate, &["--out", "o", "--plot", "o/impact.svg"], ["--plot", "--out = o"]),
        (&simulate, &["--out", "o", "--report", "o/report.html", "--force"], ["--report", "--out = o"]),
        (&["simulate", "drop.toml"], &["--report", "o/report.html", "--out", "o/"], ["--report", "--out = o/"]),
        (&["demo"], &["--out", "a.svg", "--animate", "a.svg"], ["--animate", "--out = a.svg"]),
        (&["infinite-beam", "--s", "1"], &["--out", "o", "--plot", "o/x.svg"], ["--plot", "--out = o"]),
        (
            &["orbit", "drop.toml", "--over", "gravity_m_s2", "--to", "9"],
            &["--csv", "a.svg", "--plot", "a.svg"],
            ["--csv", "--plot = a.svg"],
        ),
    ] {
        let message = refused(folder.path(), &[command, options].concat());
        let [second, first] = names;
        assert!(message.starts_with(&format!("error: {second} = ")) && message.contains(first), "{message}");
    }
    // a file in place of a folder
    for command in [&simulate[..], &["simulate", "drop.toml"], &["infinite-beam", "--s", "1"]] {
        let message = refused(folder.path(), &[command, &["--out", "file"]].concat());
        assert!(message.contains("--out = file is not allowed; it must be a folder"), "{message}");
    }
    let sweep = format!(r#"{{ "scene": {quick}, "vary": [{{ "field": "striker.speed_m_s", "values": [1, 2] }}] }}"#);
    fs::write(folder.path().join("sweep.json"), sweep).unwrap();
    assert!(refused(folder.path(), &["sweep", "sweep.json", "--out", "file"]).contains("file is a file"));
}

/// A file that cannot be written does not discard what was computed.
#[test]
fn a_result_is_printed_even_if_its_files_cannot_be_written() {
    let quick = BEAM.replace("\"location_m\"", "\"modes\": 4, \"location_m\"");
    let folder = folder(&[("scene.json", &quick), ("file", "mine")]);
    fs::write(folder.path().join("drop.toml"), stdout(&run(folder.path(), &["init", "--kind", "bodies", "-"])))
        .unwrap();
    for command in [
        &["simulate", "scene.json"][..],
        &["simulate", "drop.toml"],
        &["infinite-beam", "--s", "1"],
        &["modes", "scene.json"],
        &["compare", "scene.json"],
        &["sensitivity", "scene.json", "--by", "striker.mass_kg"],
    ] {
        let printed = |more: &[&str]| run(folder.path(), &[command, &["--json"], more].concat());
        let output = printed(&["--plot", "file/a.svg"]);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{command:?}: {message}");
        assert!(message.contains("cannot write to file/a.svg"), "{message}");
        assert_eq!(output.stdout, printed(&[]).stdout, "{command:?}");
    }
}

/// A beam whose rigidity and mass follow from other fields.
const STEEL: &str = r#"{ "location_m": 0.3,
    "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "segments": [{ "length_m": 1, "width_m": 0.012,
        "thickness_m": 0.01, "youngs_modulus_pa": 2e11, "density_kg_m3": 7800 }] },
    "striker": { "density_kg_m3": 7800, "radius_m": 0.02, "speed_m_s": 1 },
    "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 } }"#;

/// A value that the field of a scene cannot have is an error of this field, of the option or of the file that states it.
#[test]
fn errors_name_the_field_that_has_to_change() {
    let infinite = r#"{ "structure": { "kind": "infinite-beam", "youngs_modulus_pa": 2e11, "density_kg_m3": 7800,
        "width_m": 0.028, "thickness_m": 0.028 }, "striker": { "density_kg_m3": 7800, "radius_m": 0.13, "speed_m_s": 0.5 },
        "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 } }"#;
    let weightless = r#"{ "structure": { "kind": "infinite-beam", "flexural_rigidity_n_m2": 5e-324,
        "mass_per_length_kg_m": 5e-324 }, "striker": { "mass_kg": 1, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 } }"#;
    let light = r#"{ "bodies": { "bar": { "kind": "beam", "modes": 2, "ends": ["pinned", "pinned"], "segments": [{ "length_m": 1,
        "flexural_rigidity_n_m2": 1, "mass_per_length_kg_m": 1e-50 }] } },
        "contacts": [{ "name": "c", "between": [{ "body": "bar", "location_m": 0.3 }, "ground"], "law": "hertz",
        "stiffness_n_m1_5": 1e9 }], "end_s": 0.01 }"#;
    let bodies = r#"{ "bodies": { "a": { "kind": "mass", "mass_kg": 1, "velocity_m_s": -1 } },
        "contacts": [{ "name": "c", "between": [{ "body": "a" }, "ground"], "law": "hertz", "stiffness_n_m1_5": 1e9 }],
        "loads": [{ "body": "a", "force_n": 1, "frequency_hz": 5 }], "end_s": 0.01 }"#;
    let load = |text: &str| bodies.replace(r#""force_n": 1, "frequency_hz": 5"#, text);
    let modes = BEAM.replace("\"location_m\"", "\"modes\": 4, \"location_m\"");
    let axis = r#"{ "field": "modes", "from": 1, "to": 3, "count": 5 }"#;
    let drawn = r#"{ "seed": 1, "draws": 2, "fields": [{ "field": "modes", "from": 1, "to": 3 }] }"#;
    let modal = |mass: &str, damping: &str| {
        format!(
            r#"{{ "structure": {{ "kind": "modal", "omega_rad_s": [100, 400], "shape_at_location": [1, 1],
                              "damping_ratios": [{damping}, 0] }},
            "striker": {{ "mass_kg": {mass}, "speed_m_s": 1 }},
            "contact": {{ "law": "hertz", "stiffness_n_m1_5": 1e9 }} }}"#
        )
    };
    let rod = r#"{ "structure": { "kind": "dropped-rod", "length_m": 0.2, "diameter_m": 1e15, "youngs_modulus_pa": 2e11,
        "density_kg_m3": 7800, "poissons_ratio": 0.3, "inclination_deg": 45 }, "striker": { "speed_m_s": 1 },
        "contact": { "law": "hertz" } }"#;
    let folder = folder(&[
        ("infinite.json", infinite),
        ("rod.json", rod),
        ("fast.json", &infinite.replace("0.5", "1e300")),
        ("weightless.json", weightless),
        ("light.json", light),
        ("wide.json", &infinite.replace("\"width_m\": 0.028", "\"width_m\": 1e300")),
        ("slow.json", &load(r#""force_n": 1, "frequency_hz": 1e-300"#)),
        (
            "shaken.json",
            &bodies.replace(r#""end_s""#, r#""ground_motion": { "displacement_m": 1e-3, "frequency_hz": 5 }, "end_s""#),
        ),
        ("short.json", &load(r#""times_s": [], "forces_n": []"#)),
        ("table.json", &load(r#""file": "empty.csv""#)),
        ("empty.csv", "time_s,force_n\n"),
        ("alone.json", r#"{ "bodies": { "a": { "kind": "mass", "mass_kg": 1 } }, "contacts": [], "end_s": 1 }"#),
        ("name.json", &bodies.replace("\"a\"", r#""a\u001b""#)),
        ("contact.json", &bodies.replace("\"c\"", r#""c\u0000""#)),
        ("scene.json", &modes),
        ("steel.json", STEEL),
        ("axial.json", &modes.replace("\"kind\"", "\"axial_force_n\": 1e12, \"kind\"")),
        ("data.csv", "striker.speed_m_s,restitution\n1,0.3\n2,0.4\n0.5,0.2\n"),
        ("axis.json", &format!(r#"{{ "scene": {modes}, "vary": [{axis}] }}"#)),
        ("drawn.json", &format!(r#"{{ "scene": {modes}, "random": {drawn} }}"#)),
        ("large.toml", "[striker]\nspeed_m_s = 99999999999999999999 # fast\n"),
        ("larger.toml", "striker = { mass_kg = 1, speed_m_s = 18446744073709551615 }\n"),
        ("twice.toml", "[striker]\nspeed_m_s = 1\nspeed_m_s = 2\n"),
        ("tiny.json", &modal("1", "5e-324")),
        ("creeping.json", &modal("1", "0").replace("\"speed_m_s\": 1", "\"speed_m_s\": 1e-300")),
        ("heavy.json", &modal("1.79e308", "0")),
    ]);
    let predictability = ["predictability", "scene.json", "--out", "o", "--over"];
    for (arguments, part) in [
        (
            &["simulate", "infinite.json"][..],
            "striker.radius_m = 0.13 is not allowed; it must be such that the number S",
        ),
        (&["infinite-beam", "fast.json"], "striker.speed_m_s = 1e+300 is not allowed; it must be such that"),
        (
            &["simulate", "infinite.json", "--set", "structure.thickness_m=1e-9"],
            "structure.thickness_m = 1e-9 is not allowed; it must be such that the number S of the impact, now",
        ),
        (
            &["simulate", "infinite.json", "--set", "contact.youngs_modulus_pa=1e25"],
            "contact.youngs_modulus_pa = 1e+25 is not allowed; it must be such that the number S",
        ),
        (
            &["simulate", "weightless.json"],
            "it must be such that the impulse response of the structure, now inf, is a finite number greater than 0",
        ),
        (
            &["simulate", "steel.json", "--set", "modes=4", "--set", "structure.segments[0].density_kg_m3=1e-30"],
            "structure.segments[0].density_kg_m3 = 1e-30 is not allowed; it must be such that omega_rad_s of mode 1, now",
        ),
        (
            &["simulate", "steel.json", "--set", "structure.rayleigh_stiffness_s=1e9"],
            "structure.rayleigh_stiffness_s = 1000000000.0 is not allowed; it must be such that damping_ratio of mode",
        ),
        (
            &["simulate", "light.json"],
            "bodies.bar.segments[0].mass_per_length_kg_m = 1e-50 is not allowed; it must be such that omega_rad_s of mode 1",
        ),
        (
            &["simulate", "wide.json"],
            "structure.width_m = 1e+300 is not allowed; it must be such that the flexural rigidity",
        ),
        (&["infinite-beam", "--s", "1", "--set", "a=1"], "'--s <S>' cannot be used with '--set <FIELD=VALUE>'"),
        (&["simulate", "slow.json"], "loads[0].frequency_hz = 1e-300"),
        (
            &["simulate", "shaken.json", "--set", "ground_motion.displacement_m=1e29"],
            "ground_motion.displacement_m = 1e+29 is not allowed; it must be such that the acceleration of the ground in m/s^2, now",
        ),
        (
            &["simulate", "shaken.json", "--set", "ground_motion.frequency_hz=1e20"],
            "ground_motion.frequency_hz = 1e+20 is not allowed; it must be such that the acceleration of the ground in m/s^2, now",
        ),
        (&["simulate", "short.json"], "of at least two values each"),
        (&["simulate", "table.json"], "empty.csv, number of rows = 0 is not allowed; it must be at least 2"),
        (&["sensitivity", "alone.json"], "contacts = [] is not allowed"),
        (&["simulate", "name.json"], r#"bodies = "a\u{1b}" is not allowed"#),
        (&["simulate", "contact.json"], r#"contacts[0].name = "c\0" is not allowed"#),
        (
            &["simulate", "rod.json"],
            "structure.diameter_m = 1000000000000000.0 is not allowed; it must be such that the flexural rigidity, now",
        ),
        (
            &["simulate", "steel.json", "--set", "contact.youngs_modulus_pa=1e-30"],
            "contact.youngs_modulus_pa = 1e-30 is not allowed; it must be such that the stiffness of the contact, now",
        ),
        (
            &[
                "simulate",
                "steel.json",
                "--set",
                r#"contact={"law":"elastoplastic","youngs_modulus_pa":1e-30,"poissons_ratio":0.3,"yield_pressure_pa":1}"#,
            ],
            "contact.youngs_modulus_pa = 1e-30 is not allowed; it must be such that the effective modulus of the contact, now",
        ),
        (
            &[
                "simulate",
                "steel.json",
                "--set",
                r#"contact={"law":"hysteretic","youngs_modulus_pa":2e11,"poissons_ratio":0.3,"theta_m":1e308,"beta":1,"k_bar":1}"#,
            ],
            "contact.theta_m = 1e+308 is not allowed; it must be a number greater than 0",
        ),
        (
            &["modes", "steel.json", "--set", "structure.segments[0].thickness_m=1e-60"],
            "structure.segments[0].thickness_m = 1e-60 is not allowed; it must be such that the flexural rigidity, now 2e-172,",
        ),
        (
            &["simulate", "steel.json", "--set", "structure.segments[0].density_kg_m3=1e300"],
            "structure.segments[0].density_kg_m3 = 1e+300 is not allowed; it must be such that the mass per length, now 1.2e296,",
        ),
        (
            &["simulate", "steel.json", "--set", "striker.radius_m=1e40"],
            "striker.radius_m = 1e+40 is not allowed; it must be such that the mass of the sphere, now 3.27e124, is from 1e-30 to 1e30; it follows from density_kg_m3, radius_m",
        ),
        (
            &["simulate", "steel.json", "--set", "striker.density_kg_m3=1e-40"],
            "striker.density_kg_m3 = 1e-40 is not allowed; it must be such that the mass of the sphere",
        ),
        (
            &["simulate", "steel.json", "--set", "structure.segments.0.width_m=1"],
            "structure.segments is a list, whose first entry is structure.segments[0]",
        ),
        (&["simulate", "axial.json"], "structure.axial_force_n = 1000000000000 is not allowed"),
        (&["identify", "data.csv", "--scene", "scene.json", "--free", "modes"], "--free modes = 4 is not allowed"),
        (&["sweep", "axis.json", "--out", "o"], "vary[0] = 1 to 3 is not allowed"),
        (&["sweep", "drawn.json", "--out", "o"], "random.fields[0] = 1 to 3 is not allowed"),
        (&["simulate", "large.toml"], "line 2, column 13, in speed_m_s: the whole number 99999999999999999999"),
        (&["simulate", "larger.toml"], "in speed_m_s: the whole number 18446744073709551615"),
        (&["simulate", "twice.toml"], "line 3, column 1: the key \"speed_m_s\" occurs twice"),
        (
            &["sensitivity", "tiny.json", "--by", "structure.damping_ratios[0]"],
            "its neighbours cannot be distinguished from it",
        ),
        (
            &["simulate", "creeping.json"],
            "striker.speed_m_s = 1e-300 is not allowed; it must be 0, or a number from 1e-60",
        ),
        (&["emoc", "heavy.json"], "striker.mass_kg = 1.79e+308 is not allowed; it must be such that Z"),
        (&["simulate", "scene.json", "--until", "-1e-3"], "invalid value '-1e-3' for '--until <SECONDS>'"),
        (&["simulate", "scene.json", "--intervals", "-1"], "invalid value '-1' for '--intervals <N>'"),
        (&["sweep", "axis.json", "--out", "o", "--threads", "-1"], "invalid value '-1' for '--threads <N>'"),
        (&["sweep", "axis.json", "--out", "o", "--shard", "-1/3"], "invalid value '-1/3' for '--shard <K/N>'"),
        (
            &[&predictability[..], &["location_m=0:nan:3", "--blur", "location_m=1%"]].concat(),
            "--over location_m, to = NaN is not allowed",
        ),
        (
            &[&predictability[..], &["location_m=0.1:1:3", "--over", "location_m=0.1:1:3", "--blur", "location_m=1%"]]
                .concat(),
            "--over = \"location_m\" is not allowed; it must be stated only once for each field",
        ),
        (
            &[&predictability[..], &["location_m=0.1:1:3", "--blur", "location_m=-1%"]].concat(),
            "--blur location_m = -1.0% is not allowed; it must be a finite number greater than 0",
        ),
    ] {
        let message = refused(folder.path(), arguments);
        assert!(message.contains(part), "{part}: {message}");
    }
    // a whole number with a decimal point is one
    let with_point = ["simulate", "scene.json", "--set", "modes=4.0", "--json"];
    assert_eq!(
        stdout(&run(folder.path(), &with_point)),
        stdout(&run(folder.path(), &["simulate", "scene.json", "--json"]))
    );
}

#[test]
fn a_sweep_refuses_a_folder_of_something_else() {
    let sweep = format!(
        r#"{{ "scene": {}, "vary": [{{ "field": "striker.speed_m_s", "values": [1, 2] }}] }}"#,
        BEAM.replace("\"location_m\"", "\"modes\": 4, \"location_m\"")
    );
    let folder = folder(&[("sweep.json", &sweep)]);
    for name in ["report.html", "report.md", "summary.json", "results.parquet", "progress.json", "results.csv"] {
        fs::create_dir_all(folder.path().join("out")).unwrap();
        fs::write(folder.path().join("out").join(name), "mine").unwrap();
        let message = refused(folder.path(), &["sweep", "sweep.json", "--out", "out"]);
        assert!(message.contains(&format!("out holds {name}")), "{message}");
        assert_eq!(fs::read_to_string(folder.path().join("out").join(name)).unwrap(), "mine");
        fs::remove_dir_all(folder.path().join("out")).unwrap();
    }
    stdout(&run(folder.path(), &["sweep", "sweep.json", "--out", "out"]));
    // It accepts its own folder again, also with files of other names.
    fs::write(folder.path().join("out/notes.txt"), "mine").unwrap();
    assert!(stdout(&run(folder.path(), &["sweep", "sweep.json", "--out", "out"])).contains("all points were done"));
}

#[test]
fn a_sweep_without_a_single_result_fails() {
    // The first point is checked only as far as that costs little: its speed is found when it is solved.
    let sweep = |speeds: &str| {
        let scene = BEAM.replace("\"location_m\"", "\"modes\": 4, \"location_m\"");
        format!(r#"{{ "scene": {scene}, "vary": [{{ "field": "striker.speed_m_s", "values": {speeds} }}] }}"#)
    };
    for (speeds, code) in [("[1e300, 2e300]", 2), ("[1e300, 1]", 0)] {
        let folder = folder(&[("sweep.json", &sweep(speeds))]);
        // The same again when all rows are present, and for a program that reads the object.
        for option in ["--quiet", "--quiet", "--json"] {
            let output = run(folder.path(), &["sweep", "sweep.json", "--out", "out", option]);
            let message = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(code), "{message}");
            assert!(String::from_utf8(output.stdout).unwrap().contains("striker.speed_m_s = 1e+300"));
            assert_eq!(
                message.contains("none of the 2 points could be solved; the first: striker.speed_m_s"),
                code == 2
            );
        }
        assert!(folder.path().join("out/report.html").exists());
    }
}
