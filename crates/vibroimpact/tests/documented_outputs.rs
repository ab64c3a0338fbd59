//! The keys and columns that the commands write, compared with the page that documents them.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::program::{run, stdout};
use serde_json::{Value, json};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

fn page(name: &str) -> String {
    fs::read_to_string(format!("{ROOT}/docs/how-to/{name}.md")).unwrap()
}

/// The text of the section of a page whose heading begins with this text.
fn section(page: &str, heading: &str) -> String {
    let begins = format!("\n## {heading}");
    let rest = page.split_once(&begins).unwrap_or_else(|| panic!("no section {heading}")).1;
    rest.split("\n## ").next().unwrap().to_owned()
}

/// Keys at any depth. Values under the keys `apart`, whose keys are names in the scene, are omitted.
fn keys(tree: &Value, apart: &[&str], found: &mut BTreeSet<String>) {
    match tree {
        Value::Object(entries) => entries.iter().for_each(|(key, value)| {
            found.insert(key.clone());
            if !apart.contains(&key.as_str()) {
                keys(value, apart, found);
            }
        }),
        Value::Array(items) => items.iter().for_each(|item| keys(item, apart, found)),
        _ => {}
    }
}

/// Whether a text contains a key or column in a code span: alone, as the end of a path, or in a list.
fn names(text: &str, key: &str) -> bool {
    ["`", "."].iter().any(|before| ["`", "[]"].iter().any(|after| text.contains(&format!("{before}{key}{after}"))))
}

/// Runs a command that prints one object, and checks that every key of it is in a section of the page.
fn documented(folder: &Path, heading: &str, command: &[&str], apart: &[&str]) -> Value {
    let printed: Value = serde_json::from_str(&stdout(&run(folder, &[command, &["--json"]].concat()))).unwrap();
    let text = section(&page("outputs"), heading);
    let mut found = BTreeSet::new();
    keys(&printed, apart, &mut found);
    for key in found {
        assert!(names(&text, &key), "{key} of {command:?} is not in the section {heading}");
    }
    printed
}

/// Checks that every column of a table is in a text, after the names of this scene have been replaced by those of the page.
fn columns(table: &Path, text: &str, replaced: &[(&str, &str)]) {
    let first = fs::read_to_string(table).unwrap().lines().next().unwrap().to_owned();
    for column in first.split(',') {
        let general = replaced.iter().fold(column.to_owned(), |name, (ours, page)| name.replace(ours, page));
        let error_of = general.strip_suffix("_standard_error").unwrap_or(&general);
        assert!(names(text, &general) || names(text, error_of), "{general} of {}", table.display());
    }
}

fn dataset(name: &str) -> String {
    format!("{ROOT}/datasets/{name}")
}

#[test]
fn every_key_of_every_command_is_documented() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let beam = dataset("scenes/pinned-beam.json");
    documented(folder, "`plan`", &["plan", &beam], &[]);
    documented(folder, "`compare`", &["compare", &beam], &[]);
    documented(folder, "`modes`", &["modes", &beam, "--count", "3"], &[]);
    documented(folder, "`emoc`", &["emoc", &beam], &[]);
    let observed = "mass_kg,location_m,restitution\n0.01,0.2,0.8\n0.05,0.3,0.5\n0.1,0.5,0.35\n0.2,0.6,0.3\n";
    fs::write(folder.join("observed.csv"), observed).unwrap();
    documented(folder, "`fit`", &["fit", "observed.csv", "--scene", &beam], &[]);
    let wanted = ["law", "--restitution", "0.5", "--mass-kg", "0.1", "--speed-m-s", "2", "--step-s", "0.002"];
    documented(folder, "`law`", &wanted, &[]);
    documented(folder, "`infinite-beam`", &["infinite-beam", &dataset("scenes/infinite-beam.json")], &[]);
    documented(folder, "`infinite-beam`", &["infinite-beam", "turning-points", "--count", "1"], &[]);
    let bodies = dataset("assemblies/sdnl104.json");
    let text = section(&page("outputs"), "`sensitivity`");
    for command in [["sensitivity", &beam, "--by", "striker.speed_m_s"], ["sensitivity", &bodies, "--by", "end_s"]] {
        let found = documented(folder, "`sensitivity`", &command, &["scene", "derivatives", "outputs"]);
        for output in found["derivatives"].as_object().unwrap().keys() {
            // The page uses the first contact and the first mode.
            let mut general = output.replace(".stop.", ".NAME.").replace(".beam.", ".NAME.");
            if let Some((list, rest)) = general.clone().split_once('[') {
                general = format!("{list}[0]{}", rest.split_once(']').unwrap().1);
            }
            assert!(names(&text, &general), "{general}");
        }
    }
}

#[test]
fn every_key_of_an_identification_is_documented() {
    let folder = tempfile::tempdir().unwrap();
    let [table, next, scene] =
        ["identification/rubber-ball.csv", "identification/rubber-ball-next.csv", "scenes/rubber-ball.json"]
            .map(dataset);
    let command = ["identify", &table, "--scene", &scene, "--free", "structure.damping_ratio", "--starts", "1"];
    let command = [&command[..], &["--candidates", &next]].concat();
    let found = documented(folder.path(), "`identify`", &command, &["direction", "fields"]);
    let filled = |found: &Value, key: &str| !found[key].as_array().unwrap().is_empty();
    assert!(filled(&found, "undetermined") && filled(&found, "candidates"));
    // at a rigid location the contact lasts as long for every stiffness and mass of the same ratio
    let rigid = json!({
        "structure": { "kind": "modal", "omega_rad_s": [1000], "shape_at_location": [1e-6] },
        "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 }
    });
    fs::write(folder.path().join("rigid.json"), rigid.to_string()).unwrap();
    let measured = "striker.speed_m_s,first_contact_s,first_contact_s_sd\n1,3e-4,1e-6\n2,2.6e-4,1e-6\n";
    fs::write(folder.path().join("measured.csv"), measured).unwrap();
    let free = "contact.stiffness_n_m1_5,striker.mass_kg";
    let command = ["identify", "measured.csv", "--scene", "rigid.json", "--free", free, "--starts", "1"];
    let found = documented(folder.path(), "`identify`", &command, &["direction", "fields", "exponents"]);
    assert!(filled(&found, "combinations"));
}

#[test]
fn every_key_and_column_of_an_orbit_is_documented() {
    let folder = tempfile::tempdir().unwrap();
    let table = dataset("assemblies/shaken-table.json");
    let text = documented(folder.path(), "`orbit`", &["orbit", &table], &["scene"]);
    assert_eq!(text["outcome"], "found");
    let over = ["--over", "ground_motion.displacement_m", "--to", "0.00096", "--branches", "1", "--csv", "branch.csv"];
    let branch = documented(folder.path(), "`orbit`", &[&["orbit", &table][..], &over].concat(), &["scene"]);
    assert_eq!(branch["branches"].as_array().unwrap().len(), 1);
    let text = section(&page("outputs"), "`orbit`");
    let ours = [("table.", "NAME."), ("NAME.1.", "NAME.0."), ("ground_motion.displacement_m", "field")];
    columns(&folder.path().join("branch.csv"), &text, &ours);
}

/// The examples of the page, with as few points as show that every one of them can be solved.
#[test]
fn the_sweeps_of_the_page_solve_every_point() {
    let folder = tempfile::tempdir().unwrap();
    let page = fs::read_to_string(format!("{ROOT}/docs/sweeps.md")).unwrap();
    let blocks: Vec<&str> = page.split("```json\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert_eq!(blocks.len(), 2);
    for (number, block) in blocks.into_iter().enumerate() {
        let mut sweep: Value = serde_json::from_str(block).unwrap();
        sweep["scene_file"] = json!(dataset("scenes/pinned-beam.json"));
        let axes = sweep.get_mut("vary").and_then(Value::as_array_mut);
        let counts = axes.into_iter().flatten().filter_map(|axis| axis.get_mut("count"));
        counts.for_each(|count| *count = json!(2));
        for (draws, least) in [("/random/draws", 1), ("/sampling/draws", 160)] {
            if let Some(draws) = sweep.pointer_mut(draws) {
                *draws = json!(least);
            }
        }
        fs::write(folder.path().join("sweep.json"), sweep.to_string()).unwrap();
        let printed = run(folder.path(), &["sweep", "sweep.json", "--out", &number.to_string(), "--json"]);
        let summary: Value = serde_json::from_str(&stdout(&printed)).unwrap();
        assert_eq!(summary["failures"], 0, "{block}");
    }
}

#[test]
fn every_key_and_column_of_a_sweep_is_documented() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let text = section(&page("outputs"), "`sweep`");
    let sweeps = fs::read_to_string(format!("{ROOT}/docs/sweeps.md")).unwrap();
    let beam = dataset("scenes/pinned-beam.json");
    let runs = [
        ("grid", json!({ "scene_file": beam, "vary": [{ "field": "location_m", "values": [0.3, 0.5] }] })),
        (
            "drawn",
            json!({ "scene_file": beam, "uncertain": { "location_m": { "normal": [0.6, 0.001] } },
                    "sampling": { "draws": 128, "indices": true } }),
        ),
        (
            "mapped",
            json!({ "scene_file": beam, "vary": [{ "field": "striker.speed_m_s", "values": [1] }],
                    "uncertain": { "location_m": { "normal": [0.6, 0.001] } }, "sampling": { "draws": 32 } }),
        ),
        (
            "bodies",
            json!({ "scene_file": dataset("assemblies/sdnl104.json"), "vary": [{ "field": "end_s", "values": [0.01] }] }),
        ),
        (
            "drawn-bodies",
            json!({ "scene_file": dataset("assemblies/sdnl104.json"), "sampling": { "draws": 32 },
                    "uncertain": { "end_s": { "uniform": [0.01, 0.011] } } }),
        ),
    ];
    for (name, sweep) in runs {
        fs::write(folder.join("sweep.json"), sweep.to_string()).unwrap();
        let apart = ["outcomes", "models", "motions"];
        let indices = ["location_m"];
        let printed = run(folder, &["sweep", "sweep.json", "--out", name, "--json"]);
        let printed: Value = serde_json::from_str(&stdout(&printed)).unwrap();
        let mut found = BTreeSet::new();
        keys(&printed, &apart, &mut found);
        for key in found {
            assert!(names(&text, &key) || indices.contains(&key.as_str()), "{key} of the sweep {name}");
        }
        let ours = [("stop.", "NAME."), ("location_m", "FIELD"), ("drawn.FIELD", "drawn.FIELD")];
        let varied = " `index` `FIELD` `striker.speed_m_s` `end_s` `drawn.FIELD`";
        columns(&folder.join(name).join("results.csv"), &(sweeps.clone() + varied), &ours);
        let distribution = folder.join(name).join("distribution.csv");
        assert_eq!(distribution.exists(), ["drawn", "mapped", "drawn-bodies"].contains(&name));
        if distribution.exists() {
            columns(&distribution, &(text.clone() + varied), &ours);
        }
    }
}

#[test]
fn every_column_of_the_tables_over_time_is_documented() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let text = page("result-file");
    stdout(&run(
        folder,
        &["simulate", &dataset("scenes/pinned-beam.json"), "--out", "impact", "--until", "0.001", "--quiet"],
    ));
    for table in ["history.csv", "sub_impacts.csv"] {
        columns(&folder.join("impact").join(table), &text, &[]);
    }
    let energies = fs::read_to_string(folder.join("impact/modal_energies.csv")).unwrap();
    assert!(energies.starts_with("time_s,mode_1_energy_j,") && names(&text, "mode_1_energy_j"));
    let table = dataset("assemblies/shaken-table.json");
    stdout(&run(folder, &["simulate", &table, "--set", "end_s=0.2", "--out", "run", "--quiet"]));
    for name in ["history.csv", "intervals.csv", "section.csv"] {
        columns(&folder.join("run").join(name), &text, &[("table_", "NAME_")]);
    }
    stdout(&run(folder, &["infinite-beam", "--s", "15", "--out", "infinite", "--quiet"]));
    let text = section(&page("outputs"), "`infinite-beam`");
    for name in ["contacts.csv", "history.csv"] {
        columns(&folder.join("infinite").join(name), &text, &[]);
    }
}
