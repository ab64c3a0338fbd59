//! Derivatives with respect to the numbers of scenes, compared with differences of solutions of changed scenes.

mod program;

use std::fs;
use std::path::PathBuf;

use program::{run, stdout};
use serde_json::{Value, json};
use vibroimpact::Scene;
use vibroimpact::assembly::{AssemblyScene, Summary};
use vibroimpact::sensitivity::OfField;

fn gallery(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../datasets/scenes").join(name)
}

/// The restitution of a scene with a number changed, solved to 1e-13.
fn restitution(tree: &Value, pointer: &str, value: f64) -> f64 {
    let mut tree = tree.clone();
    *tree.pointer_mut(pointer).unwrap() = json!(value);
    tree["tolerance"] = json!(1e-13);
    let solution = Scene::from_value(&tree).unwrap().impact().unwrap().solve().unwrap();
    solution.restitution.unwrap()
}

#[test]
fn derivatives_of_gallery_scenes_agree_with_differences() {
    let scenes: [(&str, &[&str]); 7] = [
        ("stepped-cantilever.json", &["/structure/segments/0/length_m", "/structure/damping_ratio", "/location_m"]),
        ("timoshenko-beam.json", &["/structure/segments/0/poissons_ratio", "/striker/speed_m_s"]),
        ("piano-hammer.json", &["/contact/exponent", "/structure/tension_n", "/location_m"]),
        ("dropped-rod.json", &["/structure/inclination_deg", "/structure/length_m", "/striker/speed_m_s"]),
        ("elastoplastic.json", &["/striker/speed_m_s", "/contact/yield_pressure_pa", "/structure/damping_ratio"]),
        ("hysteretic.json", &["/contact/k_bar", "/structure/segments/0/width_m", "/striker/speed_m_s"]),
        // Two of its modes exchange their order within these steps.
        ("cantilever-plate.json", &["/structure/length_m"]),
    ];
    for (scene, pointers) in scenes {
        let stated = Scene::read(&gallery(scene)).unwrap();
        let field = |pointer: &&str| pointer[1..].replace("/0/", "[0].").replace('/', ".");
        let fields: Vec<String> = pointers.iter().map(field).collect();
        let found = stated.sensitivity(&fields).unwrap();
        for (pointer, field) in pointers.iter().zip(&fields) {
            let value = found.scene.pointer(pointer).unwrap().as_f64().unwrap();
            let step = 1e-5;
            let [a, b, c, d] =
                [-2.0, -1.0, 1.0, 2.0].map(|i| restitution(&found.scene, pointer, value * (1.0 + i * step)));
            let reference = (8.0 * (c - b) - (d - a)) / (12.0 * step * value);
            let derivative = found.of("restitution", field).unwrap();
            // Solutions are accurate to some 1e-13.
            let known = 3e-8 / value;
            let error = (derivative.value - reference).abs();
            let allowed = 1e-5 * reference.abs() + known;
            assert!(error <= allowed, "{scene} {field}: {derivative:?}, {reference} +- {known:e}");
        }
    }
}

#[test]
fn frequencies_change_according_to_theory() {
    let scene = Scene::read(&gallery("pinned-beam.json")).unwrap();
    let by = ["structure.segments[0].length_m", "structure.segments[0].youngs_modulus_pa"].map(str::to_owned);
    let found = scene.sensitivity(&by).unwrap();
    let omega = scene.mode_shapes(3).unwrap()[2].omega_rad_s;
    // omega ~ sqrt(E) / L^2.
    for (field, exponent, value) in [(&by[0], -2.0, 1.0), (&by[1], 0.5, 2e11)] {
        let derivative = found.of("omega_rad_s[2]", field).unwrap();
        assert!((derivative.value * value / omega - exponent).abs() < 1e-9, "{field}: {derivative:?}");
        assert!((derivative.value * value / omega - exponent).abs() <= derivative.uncertainty.unwrap() * value / omega);
    }
}

/// In the middle of a beam the restitution has an extremum, so that its derivative is zero, within the stated uncertainty.
#[test]
fn errors_of_the_modes_are_part_of_the_uncertainty() {
    let mut tree: Value = serde_json::from_str(&fs::read_to_string(gallery("timoshenko-beam.json")).unwrap()).unwrap();
    let length = tree["structure"]["segments"][0]["length_m"].as_f64().unwrap();
    tree["location_m"] = json!(0.5 * length);
    tree["modes"] = json!(40);
    let field = "location_m".to_owned();
    let found = Scene::from_value(&tree).unwrap().sensitivity(std::slice::from_ref(&field)).unwrap();
    let derivative = found.of("restitution", &field).unwrap();
    assert!(derivative.value.abs() <= derivative.uncertainty.unwrap(), "{derivative:?}");
    assert!(derivative.uncertainty.unwrap() < 1e-3, "{derivative:?}");
}

#[test]
fn a_damping_of_zero_can_only_increase() {
    let mut tree: Value = serde_json::from_str(&fs::read_to_string(gallery("piano-hammer.json")).unwrap()).unwrap();
    tree["structure"]["damping_ratio"] = json!(0.0);
    let scene = Scene::from_value(&tree).unwrap();
    let field = "structure.damping_ratio".to_owned();
    let found = scene.sensitivity(std::slice::from_ref(&field)).unwrap();
    let derivative = found.of("restitution", &field).unwrap();
    let tree = found.scene;
    let [at_zero, above, far] = [0.0, 1e-5, 2e-5].map(|zeta| restitution(&tree, "/structure/damping_ratio", zeta));
    let reference = (4.0 * above - 3.0 * at_zero - far) / 2e-5;
    assert!((derivative.value - reference).abs() < 1e-5 * reference.abs(), "{derivative:?} {reference}");
}

#[test]
fn the_command_prints_a_table_a_picture_and_json() {
    let folder = tempfile::tempdir().unwrap();
    let scene = gallery("dropped-rod.json").display().to_string();
    let by = "structure.length_m,striker.speed_m_s";
    let text = stdout(&run(folder.path(), &["sensitivity", &scene, "--by", by, "--plot", "tornado.svg"]));
    assert!(text.contains("structure.length_m") && text.contains("by 1 % more"), "{text}");
    assert!(fs::read_to_string(folder.path().join("tornado.svg")).unwrap().contains("1 % more"));
    let printed = stdout(&run(folder.path(), &["sensitivity", &scene, "--by", by, "--json"]));
    let found: Value = serde_json::from_str(&printed).unwrap();
    let derivative = &found["derivatives"]["restitution"]["structure.length_m"];
    assert!(derivative["value"].as_f64().unwrap() < 0.0 && derivative["uncertainty"].as_f64().unwrap() > 0.0);
    assert_eq!(found["derivatives"]["end_s"].as_object().unwrap().len(), 2);
}

#[test]
fn fields_without_a_derivative_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |scene: &str, more: &[&str]| {
        let scene = gallery(scene).display().to_string();
        let arguments: Vec<&str> = ["sensitivity", &scene].into_iter().chain(more.iter().copied()).collect();
        let output = run(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    for (scene, more, told) in [
        ("pinned-beam.json", &["--by", "striker.mass"], "striker.radius_m"),
        ("pinned-beam.json", &["--by", "structure.kind"], "the path of a number"),
        ("pinned-beam.json", &["--by", "modes"], "can vary continuously"),
        ("pinned-beam.json", &["--by", ".."], "the path of a field"),
        ("pinned-beam.json", &["--of", "restitutions"], "an output of this scene"),
        ("pinned-beam.json", &["--set", "model=infinite-beam"], "rigid"),
        ("../assemblies/shaken-table.json", &["--by", "bodies.ball.mass"], "bodies.ball.mass_kg"),
        ("../assemblies/shaken-table.json", &["--of", "restitution"], "an output of this scene"),
        ("../assemblies/shaken-table.json", &["--by=end_s", "--set=end_s=1e5"], "panels"),
        ("infinite-beam.json", &["--of", "restitution"], "a structure with modes"),
    ] {
        let message = refused(scene, more);
        assert!(message.contains(told), "{more:?}: {message}");
    }
}

/// The contacts of a scene of bodies with a number changed, solved to 1e-13.
fn contacts(tree: &Value, pointer: &str, value: f64) -> Value {
    let mut tree = tree.clone();
    *tree.pointer_mut(pointer).unwrap() = json!(value);
    tree["tolerance"] = json!(1e-13);
    let simulation = AssemblyScene::from_value(&tree).unwrap().simulate().unwrap();
    serde_json::to_value(Summary::new(&simulation).contacts).unwrap()
}

#[test]
fn derivatives_of_scenes_of_bodies_agree_with_differences() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../datasets/assemblies");
    let outputs = ["intervals/1/impulse_n_s", "intervals/1/start_s", "intervals/0/separation_speed_m_s"];
    for (name, end_s, contact, pointers) in [
        ("shaken-table", 0.2, "table", ["/ground_motion/frequency_hz", "/bodies/ball/mass_kg", "/gravity_m_s2"]),
        (
            "settling-chain",
            0.2,
            "block-1",
            ["/contacts/0/damping_n_s_m", "/bodies/block-1/position_m", "/gravity_m_s2"],
        ),
        (
            "dropped-ball",
            0.5,
            "contact",
            ["/bodies/beam/segments/0/length_m", "/bodies/ball/position_m", "/gravity_m_s2"],
        ),
        (
            "sdnl104",
            0.2,
            "stop",
            ["/loads/0/force_n", "/bodies/beam/segments/0/youngs_modulus_pa", "/contacts/0/gap_m"],
        ),
    ] {
        let mut tree: Value =
            serde_json::from_str(&fs::read_to_string(folder.join(format!("{name}.json"))).unwrap()).unwrap();
        tree["end_s"] = json!(end_s);
        let scene = AssemblyScene::from_value(&tree).unwrap();
        let field = |pointer: &&str| pointer[1..].replace("/0/", "[0].").replace('/', ".");
        let fields: Vec<String> = pointers.iter().map(field).collect();
        let found = scene.sensitivity(&fields).unwrap();
        for (pointer, field) in pointers.iter().zip(&fields) {
            let value = tree.pointer(pointer).unwrap().as_f64().unwrap();
            let step = 1e-5 * value;
            let near = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|place| contacts(&tree, pointer, value + place * step));
            for output in outputs {
                let at = |found: &Value| found.pointer(&format!("/{contact}/{output}")).unwrap().as_f64().unwrap();
                let [a, b, here, c, d] = near.each_ref().map(at);
                let reference = (8.0 * (c - b) - (d - a)) / (12.0 * step);
                let path = format!("contacts.{contact}.{}", output.replace("/0/", "[0].").replace("/1/", "[1]."));
                let OfField { value: derivative, uncertainty } = found.table.of(&path, field).unwrap();
                let error = (derivative - reference).abs();
                // Runs are accurate to some 1e-13.
                let known = 3e-13 * here.abs() / step.abs();
                let allowed = known + uncertainty.unwrap().min(1e-5 * reference.abs());
                assert!(error <= allowed, "{name} {path} by {field}: {derivative:e} {uncertainty:?}, {reference:e}");
            }
        }
    }
}

/// The thesis's law of three parameters is a rational function of `Z`.
#[test]
fn net_laws_have_derivatives_too() {
    let scene = Scene::read(&gallery("pinned-beam.json")).unwrap();
    let field = "striker.radius_m".to_owned();
    let found = scene.sensitivity(std::slice::from_ref(&field)).unwrap();
    let by_law = found.of("emoc_restitution", &field).unwrap();
    let at = |radius: f64| {
        let mut tree: Value = found.scene.clone();
        tree["striker"]["radius_m"] = json!(radius);
        let law = vibroimpact::emoc::Parameters::default();
        Scene::from_value(&tree).unwrap().emoc(&law, None).unwrap().restitution
    };
    let radius = found.scene["striker"]["radius_m"].as_f64().unwrap();
    let reference = (at(radius + 1e-6) - at(radius - 1e-6)) / 2e-6;
    assert!((by_law.value - reference).abs() < 1e-6 * reference.abs(), "{by_law:?} {reference}");
    let net = Scene { model: vibroimpact::model::Model::Emoc, ..scene };
    let of_net = net.sensitivity(std::slice::from_ref(&field)).unwrap();
    let derivative = of_net.of("restitution", &field).unwrap();
    let at = |radius: f64| {
        let mut tree: Value = of_net.scene.clone();
        tree["striker"]["radius_m"] = json!(radius);
        Scene::from_value(&tree).unwrap().answer().unwrap().restitution.unwrap()
    };
    let reference = (at(radius + 1e-6) - at(radius - 1e-6)) / 2e-6;
    assert!((derivative.value - reference).abs() < 1e-6 * reference.abs(), "{derivative:?} {reference}");
}
