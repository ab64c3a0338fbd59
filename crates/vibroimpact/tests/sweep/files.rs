//! Sweep files: JSON and TOML, versions, the files that they name, the schema.

use super::*;
use vibroimpact::scene::schema;
use vibroimpact::sweep::{Sweep, schema as schema_of_sweeps};

const TOML: &str = r#"
version = 1
[scene.structure]
kind = "modal"
omega_rad_s = [300, 1900]
shape_at_location = [1.1, -0.7]
[scene.striker]
speed_m_s = 1
[scene.contact]
law = "hertz"
stiffness_n_m1_5 = 1e9
[[vary]]
field = "striker.mass_kg"
from = 0.01
to = 1
count = 5
scale = "log"
"#;

#[test]
fn toml_is_equivalent_to_json() {
    let sweep = Sweep::from_toml(TOML).unwrap();
    let tree = serde_json::to_value(TOML.parse::<toml::Table>().unwrap()).unwrap();
    assert_eq!(Sweep::from_json(&tree.to_string()).unwrap(), sweep);
    // Neither version nor schema is part of the computation.
    let mut plain = tree.clone();
    plain.as_object_mut().unwrap().remove("version");
    plain["$schema"] = json!("sweep.schema.json");
    assert_eq!(Sweep::from_value(&plain).unwrap().fingerprint(), sweep.fingerprint());

    let bench = Bench::new(&tree);
    fs::write(bench.path("sweep.toml"), TOML).unwrap();
    bench.succeeds(&["sweep", "sweep.toml", "--out", "toml", "--quiet"]);
    bench.succeeds(&["sweep", "sweep.json", "--out", "json", "--quiet"]);
    assert_same(&bench.path("toml"), &bench.path("json"));
}

#[test]
fn errors_of_the_text_name_a_sweep_and_newer_files() {
    let told = |text: &str| Sweep::from_json(text).unwrap_err().to_string();
    let early = told("{ \"vary\": [");
    assert!(
        early.contains("the text ends too early") && early.ends_with("a sweep is one complete JSON object"),
        "{early}"
    );
    assert!(told("{ \"version\": 2, \"grid\": [] }").contains("at most 1, the newest version of the sweep format"));
    assert!(told("{ \"version\": \"1\" }").contains("version = \"1\" is not allowed; it must be the whole number 1"));
    assert!(
        told("{ \"$schema\": 3 }")
            .contains("$schema = 3 is not allowed; it must be a text, the address of the schema of sweeps")
    );
    assert!(told("[1]").contains("the sweep = [1] is not allowed; it must be an object"));
    assert!(told("{ \"vary\": [{ \"from\": NaN }] }").contains("vary[0].from = NaN is not allowed"));
    let located = Sweep::from_toml("version = 1\n[vary\n").unwrap_err().to_string();
    assert!(located.starts_with("line 2, column"), "{located}");
}

#[test]
fn a_scene_can_be_toml_and_name_a_table_of_modes() {
    let named =
        json!({ "scene_file": "scenes/shaft.toml", "vary": [{ "field": "striker.mass_kg", "values": [0.1, 0.2] }] });
    let bench = Bench::new(&named);
    fs::create_dir(bench.path("scenes")).unwrap();
    let table = "middle,omega_rad_s,damping_ratio\n1.5,300,0.02\n0.3,900,0.01\n";
    fs::write(bench.path("scenes/modes.csv"), table).unwrap();
    let scene = r#"
        location = "middle"
        structure = { kind = "modes-file", file = "modes.csv", static_compliances_m_n = { middle = 1e-4 } }
        striker = { speed_m_s = 1 }
        contact = { law = "hertz", stiffness_n_m1_5 = 1e9 }
    "#;
    fs::write(bench.path("scenes/shaft.toml"), scene).unwrap();
    bench.succeeds(&["sweep", "sweep.json", "--out", "named", "--quiet"]);
    // The same scene within the sweep; its table is then in the folder of the sweep.
    fs::write(bench.path("modes.csv"), table).unwrap();
    let tree = serde_json::to_value(scene.parse::<toml::Table>().unwrap()).unwrap();
    let within = json!({ "scene": tree, "vary": named["vary"] });
    fs::write(bench.path("sweep.json"), within.to_string()).unwrap();
    bench.succeeds(&["sweep", "sweep.json", "--out", "within", "--quiet"]);
    assert_same(&bench.path("named"), &bench.path("within"));
    assert!(bench.rows("named").iter().all(|row| &row[2] == "rebound" && &row[12] == "2"), "{:?}", bench.rows("named"));
    // The folder contains the numbers, so that a part continues without the table.
    assert!(String::from_utf8(bench.read("named/sweep.json")).unwrap().contains("1.5"));
    fs::write(bench.path("modes.csv"), "middle,omega_rad_s\n1.5,-300\n").unwrap();
    let told = bench.refuses(&["sweep", "sweep.json", "--out", "out"]);
    assert!(told.contains("modes.csv, line 2, omega_rad_s = -300"), "{told}");
}

#[test]
fn the_schema_is_current_and_distinguishes_sweeps_from_others() {
    let schema = schema_of_sweeps();
    let text = schema::text(&schema);
    let bench = Bench::new(&super::sweep());
    assert_eq!(bench.succeeds(&["schema", "sweep"]), text);
    let datasets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets");
    let checked_in = datasets.join("schema/sweep.schema.json");
    if std::env::var_os("VIBROIMPACT_BLESS").is_some() {
        fs::write(&checked_in, &text).unwrap();
    }
    let found = fs::read_to_string(&checked_in).unwrap_or_default();
    assert!(found == text, "{} is out of date: run this test with VIBROIMPACT_BLESS=1", checked_in.display());

    let validator = jsonschema::draft202012::options().build(&schema).unwrap();
    let valid = |sweep: &Value| validator.iter_errors(sweep).map(|fault| fault.to_string()).collect::<Vec<_>>();
    assert_eq!(valid(&super::sweep()), [""; 0]);
    let mut toml_files = 0;
    for entry in fs::read_dir(datasets.join("sweeps")).unwrap().map(Result::unwrap) {
        let text = fs::read_to_string(entry.path()).unwrap();
        let tree = if entry.path().extension().is_some_and(|extension| extension == "toml") {
            toml_files += 1;
            serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap()
        } else {
            serde_json::from_str(&text).unwrap()
        };
        assert_eq!(valid(&tree), [""; 0], "{:?}", entry.path());
    }
    assert!(toml_files > 0);
    // Mistakes that both the schema and the program find.
    for (place, slip) in [
        ("/version", json!(2)),
        ("/$schema", json!(1)),
        ("/grid", json!([])),
        ("/scene", json!(7)),
        ("/scene_file", json!("a.json")),
        ("/scene/gravity", json!(9.81)),
        ("/scene/structure/kind", json!("bem")),
        ("/scene/striker/weight", json!(1)),
        ("/scene/contact/law", json!("herz")),
        ("/scene/contact/stiffness_n_m1_5", json!(-1)),
        ("/scene/tolerance", json!(0.6)),
        ("/scene/residual_compliance", json!("yes")),
        ("/vary", json!({})),
        ("/vary/0", json!(3)),
        ("/vary/0/field", json!(3)),
        ("/vary/0/count", json!(1)),
        ("/vary/0/count", json!(2.5)),
        ("/vary/0/count", json!(2e12 as u64)),
        ("/vary/0/from", json!("x")),
        ("/vary/0/scale", json!("cubic")),
        ("/vary/0/step", json!(1)),
        ("/vary/0/values", json!([1])),
        ("/vary/0/whole_numbers", json!(1)),
        ("/vary/1/values", json!([])),
        ("/vary/1/count", json!(3)),
        ("/random", json!([])),
        ("/random/seed", json!(-1)),
        ("/random/draws", json!(0)),
        ("/random/fields", json!([])),
        ("/random/fields/0/to", json!(null)),
        ("/random/fields/0/count", json!(2)),
    ] {
        let mut spoilt = super::sweep();
        let (holder, key) = place.rsplit_once('/').unwrap();
        match spoilt.pointer_mut(holder).unwrap() {
            Value::Array(items) => items[key.parse::<usize>().unwrap()] = slip,
            Value::Object(entries) => drop(entries.insert(key.to_owned(), slip)),
            other => panic!("{other}"),
        }
        assert!(!validator.is_valid(&spoilt), "{place}");
        assert!(Sweep::from_value(&spoilt).is_err(), "{place}");
    }
    for key in ["scene", "vary"] {
        let mut short = super::sweep();
        short.as_object_mut().unwrap().remove(key);
        short.as_object_mut().unwrap().remove("random");
        assert!(!validator.is_valid(&short) && Sweep::from_value(&short).is_err(), "{key}");
    }
}

/// A program without MPI reports this, and how to build one with MPI.
#[cfg(not(feature = "mpi"))]
#[test]
fn mpi_without_the_feature_is_refused() {
    let bench = Bench::new(&super::sweep());
    let told = bench.refuses(&["sweep", "sweep.json", "--out", "out", "--mpi"]);
    assert!(told.contains("built without MPI; build it with `cargo build --release --features mpi`"), "{told}");
    assert!(!bench.path("out").exists());
}
