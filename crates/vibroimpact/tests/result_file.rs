//! The object that `simulate --json` prints: one form for every model and structure, documented key by key.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::program::{run, stdout};
use serde_json::{Value, json};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

fn scene(name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(format!("{ROOT}/datasets/scenes/{name}.json")).unwrap()).unwrap()
}

/// A scene with the model that it requests.
fn asking(model: &str) -> Value {
    let mut scene = scene("pinned-beam-converged");
    for key in ["modes", "residual_compliance"] {
        scene.as_object_mut().unwrap().remove(key);
    }
    scene["model"] = json!(model);
    scene
}

fn simulate(folder: &Path, scene: &Value, options: &[&str]) -> Value {
    fs::write(folder.join("scene.json"), scene.to_string()).unwrap();
    let printed = stdout(&run(folder, &[&["simulate", "scene.json", "--json"][..], options].concat()));
    serde_json::from_str(&printed).unwrap()
}

/// Each kind of result, by its name.
fn answers(folder: &Path) -> Vec<(&'static str, Value)> {
    let tiny = {
        let mut scene = asking("infinite-beam");
        scene["striker"] = json!({ "density_kg_m3": 7800, "radius_m": 0.004, "speed_m_s": 1 });
        scene
    };
    [
        ("modal", scene("pinned-beam-converged")),
        ("rigid", asking("rigid")),
        ("emoc", asking("emoc")),
        ("infinite-beam of a beam", tiny),
        ("infinite-beam", scene("infinite-beam")),
        ("infinite-plate", scene("infinite-plate")),
        ("dropped-rod", scene("dropped-rod")),
        ("stop", scene("sdnl32")),
    ]
    .map(|(name, scene)| (name, simulate(folder, &scene, &[])))
    .into()
}

/// Every key, with the objects that contain it; the scene and its contents are separate.
fn keys(tree: &Value, within: &str, found: &mut BTreeSet<String>) {
    match tree {
        Value::Object(entries) => {
            for (key, value) in entries {
                let path = if within.is_empty() { key.clone() } else { format!("{within}.{key}") };
                if path != "scene" {
                    keys(value, &path, found);
                }
                found.insert(path);
            }
        }
        Value::Array(items) => items.iter().for_each(|item| keys(item, &format!("{within}[]"), found)),
        _ => {}
    }
}

#[test]
fn all_results_have_one_form_and_every_key_is_documented() {
    let folder = tempfile::tempdir().unwrap();
    let answers = answers(folder.path());
    let names = |tree: &Value| tree.as_object().unwrap().keys().cloned().collect::<BTreeSet<String>>();
    let first = names(&answers[0].1);
    let page = fs::read_to_string(format!("{ROOT}/docs/how-to/result-file.md")).unwrap();
    for (name, answer) in &answers {
        assert_eq!(names(answer), first, "{name}");
        assert_eq!(names(&answer["choice"]), names(&answers[0].1["choice"]), "{name}");
        assert_eq!(answer["vibroimpact"], env!("CARGO_PKG_VERSION"), "{name}");
        assert_eq!(answer["scene"]["version"], 1, "{name}");
        for key in ["outcome", "restitution", "restitution_uncertainty", "sub_impact_count"] {
            assert_eq!(answer[key], answer["choice"][key], "{name}: {key}");
        }
        if let Some(contacts) = answer["sub_impacts"].as_array() {
            assert_eq!(answer["sub_impact_count"], contacts.len(), "{name}");
        }
        let mut all = BTreeSet::new();
        keys(answer, "", &mut all);
        for path in all {
            let key = path.rsplit('.').next().unwrap();
            assert!(page.contains(&format!("`{path}`")) || page.contains(&format!("`{key}`")), "{path} of {name}");
        }
        // The scene in the result gives the result again.
        let again = simulate(folder.path(), &answer["scene"], &[]);
        assert_eq!(&again, answer, "{name}");
    }
}

/// The compliance of no remainder modes is an empty sum, which is -0 for floating-point numbers.
#[test]
fn nothing_is_zero_without_a_sign() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["measured-modes", "linear-stop"] {
        let found = simulate(folder.path(), &scene(name), &[]).to_string();
        assert!(!found.contains("-0.0,") && !found.contains("-0.0}"), "{name}: {found}");
    }
}

#[test]
fn contacts_on_an_infinite_beam_balance_the_strikers_momentum() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["infinite-beam", "infinite-plate"] {
        let found = simulate(folder.path(), &scene(name), &[]);
        let number = |value: &Value| value.as_f64().unwrap();
        let contacts = found["sub_impacts"].as_array().unwrap();
        for (contact, units) in contacts.iter().zip(found["infinite"]["contacts"].as_array().unwrap()) {
            let force = number(&found["infinite"]["physical"]["force_unit_n"]) * number(&units["peak_force"]);
            assert!((number(&contact["peak_force_n"]) / force - 1.0).abs() < 1e-12, "{name}");
            // The law of the scene.
            let stiffness = number(&contact["peak_force_n"]) / number(&contact["peak_compression_m"]).powf(1.5);
            let first = number(&contacts[0]["peak_force_n"]) / number(&contacts[0]["peak_compression_m"]).powf(1.5);
            assert!((stiffness / first - 1.0).abs() < 1e-9, "{name}");
        }
        if let (Some(velocity), Some(mass)) =
            (found["striker_velocity_m_s"].as_f64(), found["scene"]["striker"]["mass_kg"].as_f64())
        {
            let impulse: f64 = contacts.iter().map(|contact| number(&contact["impulse_n_s"])).sum();
            let change = mass * (velocity + number(&found["scene"]["striker"]["speed_m_s"]));
            assert!((impulse / change - 1.0).abs() < 1e-9, "{name}: {impulse} {change}");
        }
    }
}

#[test]
fn a_dropped_rod_states_its_final_velocities() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene("dropped-rod");
    let found = simulate(folder.path(), &scene, &[]);
    let number = |value: &Value| value.as_f64().unwrap();
    let (rod, structure) = (&found["rod"], &scene["structure"]);
    let (length, radius) = (number(&structure["length_m"]), 0.5 * number(&structure["diameter_m"]));
    let mass = number(&structure["density_kg_m3"]) * std::f64::consts::PI * radius.powi(2) * length;
    let speed = number(&scene["striker"]["speed_m_s"]);
    // The impulses of the floor reverse the velocity of the centre
    let impulse: f64 = found["sub_impacts"].as_array().unwrap().iter().map(|c| number(&c["impulse_n_s"])).sum();
    let centre = number(&rod["centre_velocity_m_s"]);
    assert!((mass * (centre + speed) / impulse - 1.0).abs() < 1e-9, "{rod}");
    // and, at half its length, cause its rotation.
    let arm = 0.5 * length * number(&structure["inclination_deg"]).to_radians().cos();
    let spin = number(&rod["angular_velocity_rad_s"]);
    assert!((mass * length.powi(2) / 12.0 * spin / (impulse * arm) - 1.0).abs() < 1e-9, "{rod}");
    let end = number(&rod["end_velocity_m_s"]);
    assert!((end - (centre + arm * spin)).abs() < 1e-12 && (end / speed - number(&found["restitution"])).abs() < 1e-9);
    let text = stdout(&run(folder.path(), &["simulate", "scene.json"]));
    assert!(text.contains("rod leaves at") && !text.contains("striker leaves at"), "{text}");
}

/// A run that stopped early, or a sustained contact, has no rebound in which a body would leave.
#[test]
fn bodies_leave_only_in_a_rebound() {
    use vibroimpact::{Scene, simulate::Simulation};
    for (name, body) in [("dropped-rod", "rod"), ("pinned-beam-undamped", "striker")] {
        let Simulation::Modal(found) = Scene::from_value(&scene(name)).unwrap().simulate().unwrap() else {
            panic!("{name} is resolved")
        };
        let mut summary = found.summary;
        for (outcome, verb) in [("rebound", "leaves"), ("stopped", "moves"), ("sustained", "moves")] {
            summary.outcome = outcome;
            let text = vibroimpact::text::result(&summary);
            assert!(text.contains(&format!("  {body} {verb} at ")), "{text}");
            assert_eq!(text.contains(" leaves at "), outcome == "rebound", "{text}");
        }
        (summary.energy.contact_j, summary.energy.residual_j) = (0.0, 0.0);
        let text = vibroimpact::text::result(&summary);
        assert!(text.contains("    unaccounted                  0 J\n"), "{text}");
    }
}

#[test]
fn histories_extend_to_the_requested_time_where_the_motion_is_known() {
    let folder = tempfile::tempdir().unwrap();
    let last_time = |scene: &Value, until: &[&str], table: &str| {
        simulate(folder.path(), scene, &[&["--out", "out", "--force"][..], until].concat());
        let text = fs::read_to_string(folder.path().join("out").join(table)).unwrap();
        text.lines().last().unwrap().split(',').next().unwrap().parse::<f64>().unwrap()
    };
    let modal = scene("pinned-beam-converged");
    let end_s = simulate(folder.path(), &modal, &[])["end_s"].as_f64().unwrap();
    for table in ["history.csv", "modal_energies.csv"] {
        assert!((last_time(&modal, &[], table) / (1.1 * end_s) - 1.0).abs() < 1e-12);
        for until in [0.001, 0.5] {
            let last = last_time(&modal, &["--until", &until.to_string()], table);
            assert!((last / until - 1.0).abs() < 1e-12, "{table}: {last}");
        }
    }
    assert!((last_time(&scene("infinite-beam"), &["--until", "1e-4"], "history.csv") / 1e-4 - 1.0).abs() < 1e-9);
    for until in ["0", "-1", "nan", "inf", "soon"] {
        let output = run(folder.path(), &["simulate", "scene.json", "--until", until]);
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&output.stderr).contains("a finite number greater than 0"), "{until}");
    }
}

#[test]
fn pictures_show_and_name_the_moving_bodies() {
    let folder = tempfile::tempdir().unwrap();
    let picture = |name: &str| {
        simulate(folder.path(), &scene(name), &["--plot", "p.svg", "--force"]);
        fs::read_to_string(folder.path().join("p.svg")).unwrap()
    };
    for (name, shown, not_shown) in [
        (
            "dropped-rod",
            vec!["\nstop\n", "\nstructure at the contact\n", "velocity (m/s)"],
            vec!["\nstriker\n", "(fm/s)"],
        ),
        ("sdnl32", vec!["\nstop\n", "\nstructure at the contact\n"], vec!["\nstriker\n", "(fm/s)"]),
        ("moving-beam", vec!["\nstriker\n", "\nstructure at the contact\n"], vec!["\nstop\n"]),
        ("pinned-beam-converged", vec!["\nstriker\n", "\nstructure at the contact\n"], vec!["\nstop\n"]),
    ] {
        let svg = picture(name);
        for part in shown {
            assert!(svg.contains(part), "{part} in the picture of {name}");
        }
        for part in not_shown {
            assert!(!svg.contains(part), "{part} in the picture of {name}");
        }
    }
    for name in ["dropped-rod", "sdnl32"] {
        simulate(folder.path(), &scene(name), &["--report", "r.html", "--force"]);
        let report = fs::read_to_string(folder.path().join("r.html")).unwrap();
        assert!(!report.contains("inf g") && !report.contains("A striker of"), "{name}");
    }
}
