//! The meaning of a sweep file, and rejected files.

use super::*;
use vibroimpact::Scene;
use vibroimpact::assembly::AnyScene;
use vibroimpact::sweep::Sweep;

fn impact(sweep: &Sweep, point: u64) -> Scene {
    match sweep.scene(point).unwrap() {
        AnyScene::Impact(scene) => *scene,
        AnyScene::Bodies(scene) => panic!("{scene:?}"),
    }
}

#[test]
fn the_grid_is_a_product_whose_last_axis_runs_fastest() {
    let sweep = Sweep::from_value(&json!({
        "scene": scene(),
        "vary": [
            { "field": "striker.mass_kg", "values": [0.1, 0.2] },
            { "field": "striker.speed_m_s", "from": 1, "to": 3, "count": 3 }
        ]
    }))
    .unwrap();
    assert_eq!(sweep.points(), 6);
    let found: Vec<Vec<f64>> =
        (0..6).map(|point| sweep.values(point).iter().map(|value| value.as_f64().unwrap()).collect()).collect();
    assert_eq!(found, [[0.1, 1.0], [0.1, 2.0], [0.1, 3.0], [0.2, 1.0], [0.2, 2.0], [0.2, 3.0]]);
    let mut expected = scene();
    expected["striker"] = json!({ "mass_kg": 0.2, "speed_m_s": 1 });
    assert_eq!(impact(&sweep, 3), Scene::from_value(&expected).unwrap());
}

#[test]
fn every_grid_point_has_the_same_draws() {
    let sweep = Sweep::from_value(&super::sweep()).unwrap();
    assert_eq!(sweep.points(), 10 * 3 * 20);
    for draw in 0..20 {
        let drawn = |grid: u64| sweep.values(20 * grid + draw)[2..].to_vec();
        assert_eq!(drawn(0), drawn(7));
        let speed = drawn(0)[0].as_f64().unwrap();
        assert!((0.1..10.0).contains(&speed));
    }
    assert_ne!(sweep.values(0)[2..], sweep.values(1)[2..]);
    assert_eq!(sweep.values(599)[..2], [json!(1), json!(4)]);
}

#[test]
fn whole_objects_and_list_entries_can_vary() {
    let sweep = Sweep::from_value(&json!({
        "scene": scene(),
        "vary": [
            { "field": "contact", "values": [{ "law": "hertz", "stiffness_n_m1_5": 1e9 },
                                             { "law": "linear-spring", "stiffness_n_m": 1e6 }] },
            { "field": "structure.omega_rad_s[2]", "from": 1000, "to": 2000, "count": 2 }
        ]
    }))
    .unwrap();
    let scene = impact(&sweep, 3);
    assert_eq!(scene.contact.law_name(), "linear-spring");
    assert!(scene.to_json().contains("2000"));
}

/// A sweep file with one change must be rejected before anything is written.
#[track_caller]
fn refused(change: impl FnOnce(&mut Value), message: &str) {
    let mut file = super::sweep();
    change(&mut file);
    let bench = Bench::new(&file);
    let told = bench.refuses(&["sweep", "sweep.json", "--out", "out"]);
    assert!(told.contains(message), "{message:?} in {told}");
    assert!(!bench.path("out").exists());
}

#[test]
fn errors_of_the_sweep_file_name_their_field() {
    refused(|file| file["vary"] = json!({}), "vary = {} is not allowed; it must be a list of axes");
    refused(|file| file["vary"][0] = json!(3), "vary[0] = 3 is not allowed; it must be an object");
    refused(
        |file| file["vary"][0]["from"] = json!("x"),
        "vary[0].from = \"x\" is not allowed; it must be a finite number",
    );
    refused(|file| file["vary"][0]["from"] = json!(-1), "vary[0].from = -1.0 is not allowed");
    refused(
        |file| file["vary"][0]["to"] = json!(0.01),
        "vary[0].to = 0.01 is not allowed; it must be a finite number other than",
    );
    refused(
        |file| file["vary"][0]["count"] = json!(1),
        "vary[0].count = 1 is not allowed; it must be a whole number from 2",
    );
    refused(|file| file["vary"][0]["count"] = json!(2.5), "vary[0].count = 2.5 is not allowed");
    refused(
        |file| file["vary"][0]["scale"] = json!("cubic"),
        "vary[0].scale = \"cubic\" is not allowed; it must be linear or log",
    );
    refused(|file| file["vary"][0]["step"] = json!(1), "vary[0].step = 1 is not a known field");
    refused(
        |file| file["vary"][1]["values"] = json!([]),
        "vary[1].values = [] is not allowed; it must be a list of at least one",
    );
    refused(|file| file["vary"][1]["count"] = json!(3), "vary[1].values = [1,3,4] is not allowed");
    refused(|file| drop(file["vary"][0].as_object_mut().unwrap().remove("count")), "vary[0].count is missing");
    refused(
        |file| drop(file["vary"][0].as_object_mut().unwrap().remove("field")),
        "vary[0].field is missing; it must be the path",
    );
    refused(
        |file| file["random"]["draws"] = json!(0),
        "random.draws = 0 is not allowed; it must be a whole number from 1",
    );
    refused(|file| file["random"]["seed"] = json!(-1), "random.seed = -1 is not allowed");
    refused(|file| file["random"]["fields"] = json!([]), "random.fields = [] is not allowed");
    refused(|file| file["random"]["fields"][1]["to"] = json!(null), "random.fields[1].to = null is not allowed");
    refused(|file| drop(file.as_object_mut().unwrap().remove("scene")), "scene is missing");
    refused(
        |file| *file = json!({ "scene": scene() }),
        "vary is missing; it must be given, unless random or uncertain is",
    );
    refused(|file| *file = json!([1]), "is not allowed; it must be an object");
    refused(|file| file["scene_file"] = json!("a.json"), "left out in the presence of scene_file");
}

#[test]
fn fields_that_the_scene_does_not_have_are_refused() {
    let field = |path: &'static str| move |file: &mut Value| file["vary"][0]["field"] = json!(path);
    refused(field("striker.mas_kg"), "vary[0].field = \"striker.mas_kg\" is not a known field");
    refused(
        field("strike.mass_kg"),
        "vary[0].field = \"strike.mass_kg\" is not allowed; it must be the path of a field of the scene, but the scene has no strike",
    );
    refused(field("structure.omega_rad_s[3]"), "structure.omega_rad_s has 3 entries");
    refused(field("striker..mass_kg"), "vary[0].field = \"striker..mass_kg\" is not allowed; it must be the path");
    refused(
        field("modes"),
        "vary[1].field = \"modes\" is not allowed; it must be a field that does not overwrite the field of vary[0]",
    );
    refused(
        |file| file["random"]["fields"][0]["field"] = json!("striker"),
        "random.fields[0].field = \"striker\" is not allowed; it must be a field that does not overwrite the field of vary[0]",
    );
}

#[test]
fn values_that_a_field_cannot_have_are_refused() {
    refused(|file| file["vary"][1]["values"][2] = json!("four"), "vary[1].values[2] = \"four\" is not allowed");
    refused(|file| file["vary"][1]["values"][0] = json!(1.5), "vary[1].values[0] = 1.5 is not allowed");
    refused(
        |file| file["vary"][1] = json!({ "field": "modes", "from": 1, "to": 2, "count": 3 }),
        "vary[1] = 1 to 2 is not allowed",
    );
}

#[test]
fn an_invalid_base_scene_is_refused() {
    refused(
        |file| file["scene"]["contact"]["law"] = json!("glue"),
        "scene.contact.law = \"glue\" is not allowed; it must be one of",
    );
    refused(|file| file["scene"]["contact"]["stiffness_n_m1_5"] = json!(-1), "scene.contact.stiffness_n_m1_5 = -1");
    refused(|file| drop(file["scene"].as_object_mut().unwrap().remove("contact")), "scene.contact is missing");
    refused(|file| file["scene"] = json!(7), "scene = 7 is not allowed; it must be a scene as an object");
}

#[test]
fn huge_sweeps_are_refused() {
    refused(|file| file["vary"][0]["count"] = json!(2e12 as u64), "vary[0].count = 2000000000000 is not allowed");
    refused(|file| file["vary"][0]["count"] = json!(u64::MAX), "vary[0].count = 18446744073709551615 is not allowed");
    refused(
        |file| {
            file["vary"][0]["count"] = json!(1_000_000_000);
            file["random"]["draws"] = json!(1_000_000_000);
        },
        "number of points = 1000000000 x 3 x 1000000000 is not allowed; it must be at most 1e12",
    );
}

#[test]
fn files_that_cannot_be_read_are_reported() {
    let bench = Bench::new(&json!({ "scene_file": "gone.json", "vary": [{ "field": "modes", "values": [1] }] }));
    assert!(bench.refuses(&["sweep", "sweep.json", "--out", "out"]).contains("cannot read gone.json"));
    fs::write(bench.path("gone.json"), "{ \"structure\": }").unwrap();
    assert!(bench.refuses(&["sweep", "sweep.json", "--out", "out"]).contains("(in gone.json)"));
    assert!(bench.refuses(&["sweep", "other.json", "--out", "out"]).contains("cannot read other.json"));
    assert!(!bench.path("out").exists());
    fs::write(bench.path("gone.json"), scene().to_string()).unwrap();
    bench.succeeds(&["sweep", "sweep.json", "--out", "out", "--quiet"]);
}

#[test]
fn the_sweeps_of_the_gallery_can_be_used() {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets/sweeps");
    let mut found = 0;
    for entry in fs::read_dir(gallery).unwrap().map(Result::unwrap) {
        let sweep = Sweep::read(&entry.path()).unwrap_or_else(|fault| panic!("{:?}: {fault}", entry.path()));
        for point in [0, sweep.points() / 2, sweep.points() - 1] {
            let count = match sweep.scene(point).unwrap() {
                AnyScene::Impact(scene) => scene.answer().unwrap().sub_impact_count.unwrap(),
                AnyScene::Bodies(scene) => scene.simulate().unwrap().intervals[0].len(),
            };
            assert!(count > 0, "{:?}, point {point}", entry.path());
        }
        found += 1;
    }
    assert!(found >= 6);
}
