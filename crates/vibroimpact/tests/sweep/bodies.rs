//! Sweeps over scenes of bodies.

use super::*;
use vibroimpact::assembly::{AnyScene, AssemblyScene, Summary};
use vibroimpact::sweep::Sweep;

/// A ball between a vibrating floor and a ceiling.
fn shaken() -> Value {
    json!({
        "bodies": { "ball": { "kind": "mass", "mass_kg": 0.1, "position_m": 0.001 } },
        "contacts": [
            { "name": "floor", "between": [{ "body": "ball" }, "ground"],
              "law": "kelvin-voigt", "stiffness_n_m": 1e6, "restitution": 0.5, "reduced_mass_kg": 0.1 },
            { "name": "stops", "between": [{ "body": "ball" }, "ground"], "gap_m": 0.01, "two_sided": true,
              "law": "linear-spring", "stiffness_n_m": 1e6 }
        ],
        "gravity_m_s2": 9.81,
        "ground_motion": { "displacement_m": 0.0007, "frequency_hz": 20 },
        "end_s": 0.5
    })
}

fn sweep_of(scene: Value) -> Value {
    json!({
        "scene": scene,
        "vary": [
            { "field": "contacts[0].gap_m", "values": [0, 1e-4, "wide", 1e31] },
            { "field": "bodies.ball.velocity_m_s", "from": -0.2, "to": 0.2, "count": 3 }
        ],
        "random": { "seed": 3, "draws": 2, "fields": [
            { "field": "ground_motion.displacement_m", "from": 1e-4, "to": 1e-3, "scale": "log" }] }
    })
}

#[test]
fn the_time_up_to_which_a_run_is_certain_is_computed_on_request() {
    let mut file = json!({
        "scene": shaken(),
        "vary": [{ "field": "bodies.ball.velocity_m_s", "values": [-0.1, 0.2] }],
        "reliability": true
    });
    let bench = Bench::new(&file);
    bench.succeeds(&["sweep", "sweep.json", "--out", "out"]);
    let mut table = csv::Reader::from_path(bench.path("out/results.csv")).unwrap();
    let place = table.headers().unwrap().iter().position(|name| name == "reliable_until_s").unwrap();
    let sweep = Sweep::from_value(&file).unwrap();
    for (point, row) in table.records().map(Result::unwrap).enumerate() {
        let AnyScene::Bodies(scene) = sweep.scene(point as u64).unwrap() else { panic!("point {point}") };
        let expected = scene.simulate().unwrap().reliable_until_s.unwrap();
        assert_eq!(row[place].parse::<f64>().ok(), Some(expected));
    }
    file["reliability"] = json!("yes");
    let told = Bench::new(&file).refuses(&["sweep", "sweep.json", "--out", "out"]);
    assert!(told.contains("reliability") && told.contains("true or false"), "{told}");
}

/// Four values, one of which has the wrong type, are rejected; with a value that is out of range there are rows with errors.
#[test]
fn each_row_agrees_with_simulate_and_bytes_depend_on_nothing_else() {
    let mut file = sweep_of(shaken());
    let bench = Bench::new(&file);
    let told = bench.refuses(&["sweep", "sweep.json", "--out", "out"]);
    assert!(told.contains("vary[0].values[2]") && told.contains("contacts[0].gap_m"), "{told}");
    assert!(!bench.path("out").exists());
    file["vary"][0]["values"] = json!([0, 1e-4, 1e31]);
    let bench = Bench::new(&file);
    bench.succeeds(&["sweep", "sweep.json", "--out", "one", "--threads", "1"]);
    bench.succeeds(&["sweep", "sweep.json", "--out", "two", "--threads", "2"]);
    assert_same(&bench.path("one"), &bench.path("two"));
    for part in ["1/2", "2/2"] {
        bench.succeeds(&["sweep", "sweep.json", "--out", &format!("part-{}", &part[..1]), "--shard", part]);
    }
    bench.succeeds(&["merge", "part-1", "part-2", "--out", "merged"]);
    assert_same(&bench.path("one"), &bench.path("merged"));

    let table = bench.read("one/results.csv");
    let mut table = csv::Reader::from_reader(&table[..]);
    let header: Vec<String> = table.headers().unwrap().iter().map(str::to_owned).collect();
    let place = |name: &str| header.iter().position(|column| column == name).unwrap_or_else(|| panic!("{name}"));
    let sweep = Sweep::from_value(&file).unwrap();
    let mut failures = 0;
    for (point, row) in table.records().map(Result::unwrap).enumerate() {
        let AnyScene::Bodies(scene) = sweep.scene(point as u64).unwrap() else { panic!("point {point}") };
        let Ok(found) = scene.simulate() else {
            assert!(row[place("error")].contains("contacts[0].gap_m = 1e+31 is not allowed"), "{row:?}");
            failures += 1;
            continue;
        };
        let summary = Summary::new(&found);
        let number = |name: &str| row[place(name)].parse::<f64>().ok();
        assert_eq!(&row[place("outcome")], summary.outcome);
        assert_eq!(number("end_s"), Some(summary.end_s));
        assert_eq!(number("reliable_until_s"), None);
        for (name, contact) in &summary.contacts {
            assert_eq!(row[place(&format!("{name}.count"))], contact.count.to_string());
            assert_eq!(number(&format!("{name}.impulse_n_s")), Some(contact.impulse_n_s));
            assert_eq!(number(&format!("{name}.rms_force_n")), Some(contact.rms_force_n));
        }
        assert_eq!(summary.contacts.keys().collect::<Vec<_>>(), ["floor", "stops+", "stops-"]);
        assert_eq!(number("floor.displacement_0_m"), Some(summary.points[0].displacement_m));
        assert_eq!(number("floor.velocity_1_m_s"), Some(0.0));
        assert_eq!(number("load_work_j"), Some(summary.energy.as_ref().unwrap().load_work_j));
        let all: u64 = summary.contacts.values().map(|contact| contact.count).sum();
        assert_eq!(row[place("intervals")], all.to_string());
        assert_eq!(number("motion_intervals"), summary.steady_motion.map(|motion| motion.intervals as f64));
    }
    assert_eq!(failures, 6);
    let tally: Value = serde_json::from_slice(&bench.read("one/summary.json")).unwrap();
    assert_eq!((tally["points"].as_u64(), tally["failures"].as_u64()), (Some(18), Some(6)));
    assert!(tally["restitution"].is_null() && tally["largest_force_n"]["greatest"].as_f64().unwrap() > 0.0, "{tally}");
    assert!(bench.read("one/results.parquet").starts_with(b"PAR1"));
}

/// Tables that the scene names are in the same folder as its file, and become part of the sweep.
#[test]
fn tables_of_a_scene_of_bodies_are_read() {
    let mut scene = shaken();
    scene["ground_motion"] = json!({ "file": "shake.csv" });
    scene["bodies"]["bar"] = json!({ "kind": "modes-file", "file": "bar.csv", "gravity_participation_kg0_5": [1] });
    let bench = Bench::new(&json!({
        "scene_file": "scenes/ball.json",
        "vary": [{ "field": "bodies.ball.position_m", "values": [0.001, 0.002] }]
    }));
    fs::create_dir(bench.path("scenes")).unwrap();
    fs::write(bench.path("scenes/ball.json"), scene.to_string()).unwrap();
    fs::write(bench.path("scenes/bar.csv"), "omega_rad_s,tip\n300,1.5\n").unwrap();
    fs::write(bench.path("scenes/shake.csv"), "time_s,acceleration_m_s2\n0,0\n0.1,1\n").unwrap();
    bench.succeeds(&["sweep", "sweep.json", "--out", "out"]);
    let AnyScene::Bodies(read) = AnyScene::read(&bench.path("scenes/ball.json")).unwrap() else { panic!() };
    let canonical: Value = serde_json::from_slice(&bench.read("out/sweep.json")).unwrap();
    let kept = canonical.pointer("/sweep/scene").or(canonical.get("scene")).unwrap();
    assert_eq!(AssemblyScene::from_value(kept).unwrap(), *read);
    fs::write(bench.path("scenes/shake.csv"), "time_s,acceleration_m_s2\n0,x\n").unwrap();
    let told = bench.refuses(&["sweep", "sweep.json", "--out", "other"]);
    assert!(told.contains("shake.csv, line 2"), "{told}");
    scene["bodies"]["bar"]["file"] = json!("../bar.csv");
    fs::write(bench.path("scenes/ball.json"), scene.to_string()).unwrap();
    let told = bench.refuses(&["sweep", "sweep.json", "--out", "other"]);
    assert!(told.contains("scene.bodies.bar.file"), "{told}");
}

/// The ball on a shaken table with one impact in n periods. At Gamma = A w^2/g = 0.9 and restitution 0.8 those with n = 1 and 2
/// exist and are stable in closed form (from n pi (1-e)/(1+e) = 0.349 and 0.698 up to 1.071 and 1.240), that with n = 3 does
/// not exist (1.047), and a ball that has come to rest stays at rest, as Gamma is below 1. The impact speed is n g T/(1+e).
#[test]
fn basins_of_the_ball_on_a_shaken_table_contain_the_motions_of_the_closed_form() {
    let datasets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets/sweeps");
    let text = fs::read_to_string(datasets.join("shaken-table-basins.json")).unwrap();
    let mut file: Value = serde_json::from_str(&text).unwrap();
    for axis in file["vary"].as_array_mut().unwrap() {
        axis["count"] = json!(7);
    }
    let bench = Bench::new(&file);
    bench.succeeds(&["sweep", "sweep.json", "--out", "out"]);
    let tally: Value = serde_json::from_slice(&bench.read("out/summary.json")).unwrap();
    let motions: Vec<&str> = tally["motions"].as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!(motions, ["0/1", "1/1", "1/2"], "{tally}");
    let picture = fs::read_to_string(bench.path("out/figures/maps.svg")).unwrap();
    assert!(picture.contains("intervals/periods") && picture.contains("1/2"));

    let sweep = Sweep::from_value(&file).unwrap();
    let rows = bench.rows("out");
    for periods in [1, 2] {
        let row = rows.iter().find(|row| (&row[6], &row[7]) == (periods.to_string().as_str(), "1")).unwrap();
        let AnyScene::Bodies(scene) = sweep.scene(row[0].parse().unwrap()).unwrap() else { panic!() };
        let found = scene.simulate().unwrap();
        let last = &found.intervals[0][found.intervals[0].len() - 2];
        let approach = f64::from(periods) * 9.81 * 0.05 / 1.8;
        assert!((last.approach_speed_m_s / approach - 1.0).abs() < 5e-3, "{last:?} {approach}");
    }
}
