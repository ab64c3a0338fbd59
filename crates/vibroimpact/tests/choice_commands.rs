//! `plan`, `compare` and `simulate` under every model, as a user meets them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::{Value, json};

const MODELS: [&str; 4] = ["rigid", "emoc", "infinite-beam", "modal"];

/// The pinned beam of chapter 3, with some fields changed.
fn scene(changes: &[(&str, Value)]) -> Value {
    let mut scene = json!({
        "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.02, "segments": [
            { "length_m": 1, "youngs_modulus_pa": 2e11, "density_kg_m3": 7800, "width_m": 0.011323, "thickness_m": 0.011323 }
        ] },
        "striker": { "density_kg_m3": 7800, "radius_m": 0.015, "speed_m_s": 1 },
        "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 },
        "location_m": 0.6180339887498949
    });
    for (pointer, value) in changes {
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        scene.pointer_mut(parent).unwrap().as_object_mut().unwrap().insert(key.to_owned(), value.clone());
    }
    scene
}

/// A 7 g ball in the middle: every model has a result.
fn light(model: &str) -> Value {
    scene(&[("/striker/radius_m", json!(0.006)), ("/location_m", json!(0.5)), ("/model", json!(model))])
}

/// A folder with a scene in it.
struct Folder(tempfile::TempDir);

impl Folder {
    fn with(scene: &Value) -> Folder {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.json"), scene.to_string()).unwrap();
        Folder(folder)
    }

    fn run(&self, command: &str, options: &[&str]) -> Output {
        let mut program = Command::new(env!("CARGO_BIN_EXE_vibroimpact"));
        program.current_dir(self.0.path()).args([command, "scene.json"]).args(options).output().unwrap()
    }

    fn printed(&self, command: &str, options: &[&str]) -> String {
        let output = self.run(command, options);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(output.stderr.is_empty());
        String::from_utf8(output.stdout).unwrap()
    }

    fn json(&self, command: &str) -> Value {
        serde_json::from_str(&self.printed(command, &["--json"])).unwrap()
    }

    /// The message of a run that must fail because of its input, with nothing printed and nothing written.
    fn refusal(&self, command: &str, options: &[&str]) -> String {
        let before = self.files();
        let output = self.run(command, options);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{command} {options:?}");
        assert_eq!(self.files(), before);
        String::from_utf8(output.stderr).unwrap()
    }

    fn files(&self) -> Vec<PathBuf> {
        let mut files: Vec<PathBuf> = fs::read_dir(self.0.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files
    }
}

fn gallery(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets/scenes").join(name);
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn simulate_uses_the_requested_model() {
    for model in MODELS {
        let folder = Folder::with(&light(model));
        let result = folder.json("simulate");
        let answer = &result["choice"];
        assert_eq!(answer["model"], model);
        assert!(answer["restitution"].is_f64(), "{answer}");
        let text = folder.printed("simulate", &["--out", "results"]);
        assert!(text.contains(&format!("{model}: ")) && text.contains("restitution"), "{text}");
        let kept: Value =
            serde_json::from_str(&fs::read_to_string(folder.0.path().join("results/result.json")).unwrap()).unwrap();
        assert_eq!(kept, result);
        assert_eq!(folder.0.path().join("results/history.csv").exists(), matches!(model, "modal" | "rigid"));
        assert!(folder.0.path().join("results/impact.svg").exists());
    }
}

#[test]
fn every_model_is_drawn_and_reported() {
    for model in MODELS {
        let folder = Folder::with(&light(model));
        for (option, file) in [("--plot", "impact.svg"), ("--report", "impact.html")] {
            folder.printed("simulate", &[option, file]);
            let written = fs::read_to_string(folder.0.path().join(file)).unwrap();
            // A model with a history shows it.
            assert_eq!(written.contains("contact force ("), matches!(model, "modal" | "rigid"), "{model} {option}");
            assert!(written.contains("restitution"), "{model} {option}");
        }
    }
}

#[test]
fn a_model_without_histories_has_no_end_of_them() {
    for model in ["emoc", "infinite-beam"] {
        for output in [&["--out", "results"][..], &["--plot", "impact.svg"], &[]] {
            let message = Folder::with(&light(model)).refusal("simulate", &[output, &["--until", "0.5"]].concat());
            let expected = format!(
                "--until = 0.5 is not allowed; it must be left out, because the model {model} gives the net result alone"
            );
            assert!(message.contains(&expected) && message.contains("\"modal\""), "{message}");
        }
    }
    Folder::with(&light("rigid")).printed("simulate", &["--out", "results", "--until", "0.5"]);
}

#[test]
fn the_infinite_beam_is_shown_from_the_group_velocity() {
    let folder = Folder::with(&light("auto"));
    let plan = folder.json("plan");
    assert_eq!(plan["model"], "infinite-beam");
    let text = folder.printed("simulate", &[]).split_whitespace().collect::<Vec<_>>().join(" ");
    for part in ["rad/s, travel at", "m/s at most and return from an end after", "the last contact ends after"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn plan_and_compare_list_every_model() {
    let folder = Folder::with(&light("auto"));
    let (plan, comparison) = (folder.json("plan"), folder.json("compare"));
    for tiers in [&plan["tiers"], &comparison["tiers"]] {
        let names: Vec<&str> = tiers.as_array().unwrap().iter().map(|tier| tier["model"].as_str().unwrap()).collect();
        assert_eq!(names, MODELS);
    }
    assert_eq!(comparison["chosen"]["model"], plan["model"]);
    for model in MODELS {
        assert!(folder.printed("plan", &[]).contains(model) && folder.printed("compare", &[]).contains(model));
    }
    folder.printed("compare", &["--plot", "models.svg"]);
    let picture = fs::read_to_string(folder.0.path().join("models.svg")).unwrap();
    assert!(picture.starts_with("<svg") && MODELS.iter().all(|model| picture.contains(model)));
    let output = folder.run("compare", &["--plot", "models.gif"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_scene_that_does_not_converge_has_a_result_that_states_this() {
    // Six undamped modes, far too few for the contact.
    let mut undamped = scene(&[("/tolerance", json!(1e-5))]);
    undamped["structure"] = json!({ "kind": "modal", "omega_rad_s": [163, 653, 1469, 2611, 4080, 5876],
        "shape_at_location": [1.3, -0.9, -0.6, 1.4, -0.4, -1.1], "static_compliance_m_n": 6.602e-5 });
    undamped.as_object_mut().unwrap().remove("location_m");
    let folder = Folder::with(&undamped);
    let choice = &folder.json("simulate")["choice"];
    assert_eq!(choice["settled"], false);
    assert!(choice["spread"].as_f64().unwrap() > 1e-5);
    let text = folder.printed("simulate", &[]);
    assert!(text.contains("NOT CONVERGED") && text.contains("nothing damps"), "{text}");
}

#[test]
fn an_unavailable_model_is_refused() {
    let spring = json!({ "law": "linear-spring", "stiffness_n_m": 1e7 });
    let infinite = scene(&[("/model", json!("infinite-beam")), ("/contact", spring)]);
    let free = scene(&[("/model", json!("emoc")), ("/structure/ends", json!(["free", "free"]))]);
    for (scene, reason) in [(infinite, "hertz"), (free, "rigid body")] {
        for command in ["simulate", "plan"] {
            let message = Folder::with(&scene).refusal(command, &["--json"]);
            assert!(message.contains("model = \"") && message.contains(reason), "{command}: {message}");
        }
        // A comparison lists it among the others.
        let comparison = Folder::with(&scene).json("compare");
        let refused = comparison["tiers"].as_array().unwrap().iter().any(|tier| {
            tier["model"] == scene["model"] && tier["refused"].as_str().is_some_and(|text| text.contains(reason))
        });
        assert!(refused, "{comparison}");
    }
}

#[test]
fn structures_that_move_before_the_impact_have_only_the_modal_model() {
    for (name, why) in [
        ("dropped-rod.json", "dropped rod"),
        ("moving-beam.json", "moves before the impact"),
        ("sdnl32.json", "before the impact"),
    ] {
        let mut scene = gallery(name);
        let folder = Folder::with(&scene);
        let (plan, comparison, result) = (folder.json("plan"), folder.json("compare"), folder.json("simulate"));
        assert_eq!((&plan["model"], &comparison["best"]), (&json!("modal"), &json!("modal")), "{name}");
        assert_eq!(comparison["chosen"]["restitution"], result["restitution"], "{name}");
        for (planned, compared) in plan["tiers"].as_array().unwrap().iter().zip(comparison["tiers"].as_array().unwrap())
        {
            let modal = planned["model"] == "modal";
            assert_eq!((&planned["applies"], compared["refused"].is_null()), (&json!(modal), modal), "{name}");
            assert!(modal || planned["reason"].as_str().unwrap().contains(why), "{planned}");
        }
        folder.printed("compare", &["--plot", "models.svg"]);
        scene["model"] = json!("modal");
        assert_eq!(Folder::with(&scene).json("simulate")["restitution"], result["restitution"]);
        scene["model"] = json!("rigid");
        for command in ["simulate", "plan"] {
            let message = Folder::with(&scene).refusal(command, &[]);
            assert!(message.contains("auto or modal") && message.contains(why), "{message}");
        }
    }
    // There is no limit of many modes to converge to: the number has to be stated.
    let mut scene = gallery("moving-beam.json");
    scene.as_object_mut().unwrap().remove("modes");
    for command in ["simulate", "plan", "compare"] {
        let message = Folder::with(&scene).refusal(command, &[]);
        assert!(message.contains("modes is missing"), "{message}");
    }
}
