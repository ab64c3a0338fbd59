//! Derivatives with respect to the numbers of scenes, compared with differences of solutions of changed scenes.

use std::fs;
use std::path::PathBuf;

use crate::program::{run, stdout};
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

/// A tree of the gallery, after some changes.
fn changed(name: &str, change: impl Fn(&mut Value)) -> Value {
    let mut tree = serde_json::from_str(&fs::read_to_string(gallery(name)).unwrap()).unwrap();
    change(&mut tree);
    tree
}

/// Fourth-order difference of the restitution.
fn difference(tree: &Value, pointer: &str, step: f64) -> f64 {
    let value = tree.pointer(pointer).unwrap().as_f64().unwrap();
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|i| restitution(tree, pointer, value + i * step));
    (8.0 * (c - b) - (d - a)) / (12.0 * step)
}

/// A contact that yields far below its load recovers little of its compression: the unloading line depends on the small difference of
/// two numbers of its branch. The less it recovers, the more of the derivative is lost to the rounding of these numbers.
#[test]
fn derivatives_of_a_contact_that_hardly_recovers_agree_with_differences() {
    let fields = ["striker.speed_m_s", "contact.yield_pressure_pa", "contact.youngs_modulus_pa"].map(str::to_owned);
    for (yield_pressure_pa, most) in [(2e3, 1e-4), (2e2, 3e-3), (2e1, 1e-2)] {
        let tree = json!({
            "structure": {
                "kind": "modal", "omega_rad_s": [900.0, 1800.0], "shape_at_location": [2.0, 1.5], "damping_ratios": [0.02, 0.01]
            },
            "striker": { "mass_kg": 0.1, "speed_m_s": 0.5, "radius_m": 0.05 },
            "contact": {
                "law": "elastoplastic", "youngs_modulus_pa": 2e8, "poissons_ratio": 0.3, "yield_pressure_pa": yield_pressure_pa
            },
            "tolerance": 1e-10
        });
        let found = Scene::from_value(&tree).unwrap().sensitivity(&fields).unwrap();
        for field in &fields {
            let pointer = format!("/{}", field.replace('.', "/"));
            let value = found.scene.pointer(&pointer).unwrap().as_f64().unwrap();
            let derivative = found.of("restitution", field).unwrap();
            let reference = difference(&found.scene, &pointer, 3e-3 * value);
            let error = (derivative.value - reference).abs();
            let known = derivative.uncertainty.unwrap();
            assert!(error < known && known < most * reference.abs(), "{field}: {derivative:?} {reference}");
        }
    }
}

/// In the middle of a beam the shapes of the even modes are zero, but their derivatives are not.
#[test]
fn shapes_that_pass_through_zero_keep_their_sign() {
    let at_node = changed("moving-beam.json", |tree| {
        tree["location_m"] = json!(0.5);
        tree["modes"] = json!(20);
        tree["start"]["moving_modes"] = json!([{ "mode": 2, "location_m": 0.25, "velocity_m_s": 0.1 }]);
    });
    let fields = ["location_m", "structure.segments[0].length_m"].map(str::to_owned);
    let found = Scene::from_value(&at_node).unwrap().sensitivity(&fields).unwrap();
    for (field, pointer) in fields.iter().zip(["/location_m", "/structure/segments/0/length_m"]) {
        let derivative = found.of("restitution", field).unwrap();
        let reference = difference(&found.scene, pointer, 1e-5);
        let error = (derivative.value - reference).abs();
        assert!(reference.abs() > 0.1 && error < 1e-5 * reference.abs(), "{field}: {derivative:?} {reference}");
    }
    // sqrt(2/m) sin(2 pi x/L)
    let mass: f64 = 7800.0 * 0.011323 * 0.011323;
    let slope = -2.0 * std::f64::consts::PI * (2.0 / mass).sqrt();
    let shape = found.of("shape[1]", "location_m").unwrap();
    assert!(
        (shape.value - slope).abs() <= shape.uncertainty.unwrap() && shape.uncertainty.unwrap() < 1e-6,
        "{shape:?}"
    );
}

/// On the diagonal of a square some shapes are zero, and in each of them two coefficients are equally large.
#[test]
fn shapes_on_the_diagonal_of_a_square_plate_have_derivatives() {
    let tree = changed("cantilever-plate.json", |tree| {
        tree["structure"]["width_m"] = json!(0.3);
        tree["structure"]["edges"] = json!(["free", "free", "free", "free"]);
        tree["location_m"] = json!([0.2, 0.2]);
        tree["modes"] = json!(12);
    });
    let field = "structure.length_m";
    let found = Scene::from_value(&tree).unwrap().sensitivity(&[field.to_owned()]).unwrap();
    let shape = |length: f64| {
        let mut tree = tree.clone();
        tree["structure"]["length_m"] = json!(length);
        Scene::from_value(&tree).unwrap().mode_shapes(12).unwrap()[4].shape
    };
    assert!(shape(0.3).abs() < 1e-9);
    let reference = (shape(0.3003) - shape(0.2997)) / 6e-4;
    let derivative = found.of("shape[4]", field).unwrap();
    assert!(reference.abs() > 1.0 && (derivative.value / reference - 1.0).abs() < 1e-4, "{derivative:?} {reference}");
}

/// If the last mode is one of two with the same frequency, the length changes which of them it is, but the location does not.
#[test]
fn the_last_mode_of_a_square_plate_does_not_blur_the_location() {
    let tree = changed("simply-supported-plate.json", |tree| {
        tree["structure"]["length_m"] = json!(0.3);
        tree["structure"]["width_m"] = json!(0.3);
        tree["location_m"] = json!([0.1, 0.1]);
        tree["modes"] = json!(12);
        tree["residual_compliance"] = json!(false);
    });
    let fields = ["structure.length_m", "location_m[0]"].map(str::to_owned);
    let found = Scene::from_value(&tree).unwrap().sensitivity(&fields).unwrap();
    let [length, location] = fields.each_ref().map(|field| found.of("restitution", field).unwrap());
    let reference = difference(&found.scene, "/location_m/0", 1e-5);
    let (error, uncertainty) = ((location.value - reference).abs(), location.uncertainty.unwrap());
    assert!(error <= 1e-5 * reference.abs() && uncertainty < 1e-5 * reference.abs(), "{location:?} {reference}");
    assert!(length.uncertainty.is_none_or(|by| by > 1e-3 * length.value.abs()), "{length:?}");
}

/// Shapes by Ritz's method have larger errors than others, which the neighbours magnify.
#[test]
fn errors_of_the_modes_of_a_plate_are_part_of_the_uncertainty() {
    let tree = changed("cantilever-plate.json", |tree| tree["modes"] = json!(40));
    let field = "structure.poissons_ratio".to_owned();
    let found = Scene::from_value(&tree).unwrap().sensitivity(std::slice::from_ref(&field)).unwrap();
    let derivative = found.of("restitution", &field).unwrap();
    // over a distance at which these errors do not matter
    let reference = difference(&found.scene, "/structure/poissons_ratio", 3e-4);
    let (error, uncertainty) = ((derivative.value - reference).abs(), derivative.uncertainty.unwrap());
    assert!(error > 1e-8 && error <= uncertainty, "{derivative:?} {reference}");
    assert!(uncertainty < 1e-3 * reference.abs(), "{derivative:?} {reference}");
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

/// Where the derivatives do not hold for one per cent, less is shown.
#[test]
fn the_picture_stays_within_the_range_of_the_derivatives() {
    let folder = tempfile::tempdir().unwrap();
    let scene = gallery("pinned-beam.json").display().to_string();
    let arguments = ["sensitivity", &scene, "--by", "structure.segments[0].length_m", "--plot", "tornado.svg"];
    let text = stdout(&run(folder.path(), &arguments));
    assert!(text.contains("by 0.001 % more") && text.contains("For 1 % they predict a change of 46"), "{text}");
    assert!(fs::read_to_string(folder.path().join("tornado.svg")).unwrap().contains("0.001 % less"));
}

/// All numbers of a scene, of which some have no derivatives.
#[test]
fn fields_without_derivatives_are_listed_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |scene: &str, more: &[&str]| {
        let scene = gallery(scene).display().to_string();
        let arguments: Vec<&str> = ["sensitivity", &scene].into_iter().chain(more.iter().copied()).collect();
        stdout(&run(folder.path(), &arguments))
    };
    let text = rows("sdnl32.json", &[]);
    assert!(text.contains("striker.speed_m_s  it must be 0 for an immovable striker"), "{text}");
    assert!(text.contains("\n  start.gap_m "), "{text}");
    let text = rows("../assemblies/newtons-cradle.json", &[]);
    assert!(text.contains(r#"contacts[1].gap_m         contact "2-3" touches without speed at 0 s"#), "{text}");
    assert!(text.contains("  bodies.ball-1.mass_kg"), "{text}");
    // numbers in lists
    let text = rows("simply-supported-plate.json", &[]);
    assert!(text.contains("  location_m[0]") && text.contains("  location_m[1]"), "{text}");
    let frequencies: Vec<f64> = (1..=21).map(f64::from).collect();
    let shapes = vec![1.0; 21];
    let listed = json!({ "kind": "modal", "omega_rad_s": frequencies, "shape_at_location": shapes });
    let text = rows("measured-modes.json", &["--set", &format!("structure={listed}")]);
    let told =
        "structure.shape_at_location  a list of 21 numbers; --by structure.shape_at_location[0] and so on selects";
    assert!(text.contains(told), "{text}");
    // neither does any mode of a free beam vibrate at a spring of zero stiffness, nor do two modes swap
    let attached = r#"structure.attachments=[{"location_m":0.3,"spring_n_m":0}]"#;
    let text = rows("pinned-beam.json", &["--set", r#"structure.ends=["free","free"]"#, "--set", attached]);
    assert!(
        text.contains("attachments[0].spring_n_m                 a rigid-body motion becomes a vibration"),
        "{text}"
    );
    assert!(text.contains("  structure.attachments[0].rotary_inertia_kg_m2             0"), "{text}");
}

/// The remainder modes of a location and of its neighbours follow from the same number of modes.
#[test]
fn a_location_at_the_end_of_a_beam_has_a_derivative() {
    let tree = changed("cantilever-tip.json", |tree| {
        tree["location_m"] = tree["structure"]["segments"][0]["length_m"].clone();
    });
    let length = tree["location_m"].as_f64().unwrap();
    let found = Scene::from_value(&tree).unwrap().sensitivity(&["location_m".to_owned()]).unwrap();
    let derivative = found.of("restitution", "location_m").unwrap();
    let [at, near, far] = [0.0, 1e-6, 2e-6].map(|by| restitution(&found.scene, "/location_m", length - by));
    let reference = (3.0 * at - 4.0 * near + far) / 2e-6;
    assert!((derivative.value / reference - 1.0).abs() < 1e-3, "{derivative:?} {reference}");
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
        ("pinned-beam.json", &["--by", "locaton_m"], "; did you mean location_m?"),
        (
            "pinned-beam.json",
            &["--by", "location_m,location_m"],
            "--by = location_m is not allowed; it must be stated only once",
        ),
        ("pinned-beam.json", &["--by", "structure.kind"], "the path of a number"),
        ("pinned-beam.json", &["--by", "modes"], "can vary continuously"),
        ("pinned-beam.json", &["--by", ".."], "the path of a field"),
        ("pinned-beam.json", &["--of", "restitutions"], "; did you mean restitution?"),
        ("pinned-beam.json", &["--set", "model=infinite-beam"], "rigid"),
        ("../assemblies/shaken-table.json", &["--by", "bodies.ball.mass"], "bodies.ball.mass_kg"),
        ("../assemblies/shaken-table.json", &["--of", "restitution"], "an output of this scene"),
        ("../assemblies/shaken-table.json", &["--by=end_s", "--set=end_s=1e5"], "panels"),
        ("infinite-beam.json", &["--of", "restitution"], "a structure with modes"),
        ("../assemblies/newtons-cradle.json", &["--by", "contacts[1].gap_m"], "touches without speed"),
    ] {
        let message = refused(scene, more);
        assert!(message.contains(told), "{more:?}: {message}");
    }
}

/// As in the middle of a beam that is struck once.
#[test]
fn shapes_of_bodies_that_pass_through_zero_keep_their_sign() {
    let mut tree = changed("../assemblies/dropped-ball.json", |tree| {
        tree["contacts"][0]["between"][1]["location_m"] = json!(0.5);
        tree["bodies"]["beam"]["start"] =
            json!({ "moving_modes": [{ "mode": 2, "location_m": 0.25, "velocity_m_s": 0.1 }] });
        tree["static_start"] = json!(false);
        tree["end_s"] = json!(0.05);
    });
    tree["tolerance"] = json!(1e-11);
    let field = "contacts[0].between[1].location_m";
    let found = AssemblyScene::from_value(&tree).unwrap().sensitivity(&[field.to_owned()]).unwrap();
    let impulse = |location: f64| {
        contacts(&tree, "/contacts/0/between/1/location_m", location)["contact"]["intervals"][1]["impulse_n_s"]
            .as_f64()
            .unwrap()
    };
    let reference = (impulse(0.5 + 1e-6) - impulse(0.5 - 1e-6)) / 2e-6;
    let derivative = found.table.of("contacts.contact.intervals[1].impulse_n_s", field).unwrap();
    assert!((derivative.value / reference - 1.0).abs() < 1e-5, "{derivative:?} {reference}");
}

/// The name of a body may contain what separates the steps of a path.
#[test]
fn bodies_whose_names_hold_dots_have_derivatives() {
    let of = |name: &str| {
        let scene = json!({
            "bodies": { name: { "kind": "mass", "mass_kg": 0.1, "position_m": 0.01 } },
            "contacts": [{ "name": "floor", "between": [{ "body": name }, "ground"],
                           "law": "hertz", "stiffness_n_m1_5": 1e9 }],
            "gravity_m_s2": 9.81, "end_s": 0.08
        });
        let scene = AssemblyScene::from_value(&scene).unwrap();
        let all = scene.sensitivity(&[]).unwrap().table;
        assert!(all.left_out.is_empty(), "{:?}", all.left_out);
        let field = format!("bodies.{name}.mass_kg");
        let by_mass = all.of("contacts.floor.intervals[0].impulse_n_s", &field).unwrap();
        assert_eq!(scene.sensitivity(std::slice::from_ref(&field)).unwrap().table.fields[0].path, field);
        (all.fields.len(), by_mass)
    };
    let plain = of("ball");
    assert!(plain.1.value > 0.0);
    for name in ["ball no. 2", "a[0]", "a.b[x"] {
        assert_eq!(of(name), plain, "{name}");
    }
}

/// A contact touches again as it opens. Along the coarser motion, too, no step fits between the two.
#[test]
fn a_contact_that_touches_as_it_opens_has_derivatives_with_uncertainties() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/touches_as_it_opens.json");
    let table = AssemblyScene::read(&path).unwrap().sensitivity(&["bodies.b0.mass_kg".to_owned()]).unwrap().table;
    let tree = serde_json::to_value(&table).unwrap();
    let found: Vec<&Value> =
        tree["derivatives"].as_object().unwrap().values().flat_map(|of| of.as_object().unwrap().values()).collect();
    assert!(found.len() > 50 && found.iter().all(|of| of["uncertainty"].is_number()), "{found:?}");
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

/// At a pinned end no mode moves, and there are no remainder modes. The restitution falls with the square of the distance from it, and
/// its derivative vanishes, as the limit of those at interior locations.
#[test]
fn the_derivative_by_the_location_vanishes_on_a_pinned_end() {
    for (end, inside) in [(0.0, 1e-4), (1.0, 1.0 - 1e-4)] {
        let at = |location: f64, remainder_modes: usize| {
            let tree = changed("pinned-beam-converged.json", |tree| tree["location_m"] = json!(location));
            let scene = Scene::from_value(&tree).unwrap();
            let found = scene.sensitivity(&["location_m".to_owned()]).unwrap();
            assert_eq!(found.remainder_modes, remainder_modes);
            found.of("restitution", "location_m").unwrap()
        };
        let (there, beside) = (at(end, 0), at(inside, 2));
        assert!(there.value.abs() < 1e-6 && there.uncertainty.is_some_and(|by| by < 1e-6), "{there:?}");
        assert!((0.1..10.0).contains(&beside.value.abs()), "{beside:?}");
    }
}

/// Remainder modes change with their distance from the end, which is a small share of the location near the far one.
#[test]
fn derivatives_by_the_location_exist_near_both_ends() {
    for distance in [1e-4, 1e-5, 1e-6, 1e-7] {
        let [near, far] = [distance, 1.0 - distance].map(|location| {
            let tree = changed("pinned-beam-converged.json", |tree| tree["location_m"] = json!(location));
            let found = Scene::from_value(&tree).unwrap().sensitivity(&["location_m".to_owned()]).unwrap();
            found.of("restitution", "location_m").unwrap()
        });
        // the beam is symmetric, and the restitution falls with the square of the distance
        let known = near.uncertainty.unwrap() + far.uncertainty.unwrap();
        assert!((near.value + far.value).abs() <= known, "{distance}: {near:?} {far:?}");
        assert!((far.value / distance / 12678.2 - 1.0).abs() < 1e-3, "{distance}: {far:?}");
        assert!(far.uncertainty.unwrap() < 0.1 * far.value, "{distance}: {far:?}");
    }
}

/// Remainder modes follow from fewer computed modes on a step or an attached mass than next to it, which is part of their error.
#[test]
fn the_restitution_is_continuous_at_a_step_to_its_uncertainty() {
    let step = changed("pinned-beam-converged.json", |tree| {
        let mut segment = tree["structure"]["segments"][0].clone();
        segment["length_m"] = json!(0.5);
        let mut thinner = segment.clone();
        thinner["thickness_m"] = json!(0.002);
        tree["structure"]["segments"] = json!([segment, thinner]);
    });
    let mass = changed("timoshenko-beam.json", |tree| {
        tree["structure"]["attachments"] = json!([{ "location_m": 0.5, "mass_kg": 0.01 }]);
        tree["residual_compliance"] = json!(true);
    });
    for (mut tree, modes) in [(step.clone(), 40), (step, 100), (mass.clone(), 40), (mass, 100)] {
        tree["modes"] = json!(modes);
        let [before, on, after] = [0.5 - 1e-9, 0.5, 0.5 + 1e-9].map(|location| {
            tree["location_m"] = json!(location);
            let answer = Scene::from_value(&tree).unwrap().answer().unwrap();
            (answer.restitution.unwrap(), answer.restitution_uncertainty.unwrap())
        });
        for (beside, _) in [before, after] {
            assert!((beside - on.0).abs() < 0.1 * on.1, "{modes}: {beside} {on:?}");
        }
    }
}

/// The shapes at 1e-9 from a clamped end are 1e-14 of their largest values, and those at the neighbours are rounding.
#[test]
fn a_location_where_shapes_are_rounding_is_refused_with_the_reason() {
    let tree = changed("pinned-beam-converged.json", |tree| {
        tree["structure"]["ends"] = json!(["pinned", "clamped"]);
        tree["location_m"] = json!(1.0 - 1e-10);
    });
    let refused = Scene::from_value(&tree).unwrap().sensitivity(&["location_m".to_owned()]).unwrap_err().to_string();
    assert!(refused.contains("or moves the point by no more than its rounding"), "{refused}");
}

/// The curvature of the modes jumps at a step, so that the polynomial through neighbours on both sides does not have their slope.
#[test]
fn derivatives_by_the_location_are_correct_at_a_step() {
    let tree = changed("pinned-beam.json", |tree| {
        let mut segment = tree["structure"]["segments"][0].clone();
        segment["length_m"] = json!(0.5);
        let mut thinner = segment.clone();
        thinner["thickness_m"] = json!(0.006);
        tree["structure"]["segments"] = json!([segment, thinner]);
    });
    for location in [0.5 - 1e-8, 0.5, 0.5 + 1e-8] {
        let mut tree = tree.clone();
        tree["location_m"] = json!(location);
        tree["tolerance"] = json!(1e-11);
        let found = Scene::from_value(&tree).unwrap().sensitivity(&["location_m".to_owned()]).unwrap();
        let derivative = found.of("restitution", "location_m").unwrap();
        let [before, after] = [-3e-8, 3e-8].map(|by| restitution(&tree, "/location_m", location + by));
        let reference = (after - before) / 6e-8;
        let error = (derivative.value - reference).abs();
        assert!(error < 1e-5 * reference.abs(), "{location}: {derivative:?} {reference}");
        assert!(derivative.uncertainty.unwrap() < 1e-5 * reference.abs(), "{location}: {derivative:?}");
    }
}

/// With a smaller gap the surfaces of the stop would overlap at the start.
#[test]
fn derivatives_at_a_touch_at_the_start_hold_on_one_side() {
    let scene = "../assemblies/sdnd101.json";
    let arguments = |json: &[&'static str]| {
        let path = gallery(scene).display().to_string();
        let fixed = ["sensitivity".to_owned(), path, "--by".to_owned(), "contacts[0].gap_m,end_s".to_owned()];
        fixed.into_iter().chain(json.iter().map(|word| (*word).to_owned())).collect::<Vec<String>>()
    };
    let output = |arguments: &[String]| {
        stdout(&run(std::path::Path::new("."), &arguments.iter().map(String::as_str).collect::<Vec<_>>()))
    };
    let found: Value = serde_json::from_str(&output(&arguments(&["--json"]))).unwrap();
    assert_eq!(
        (&found["fields"][0]["holds_for"], &found["fields"][1]["holds_for"]),
        (&json!("increase"), &json!(null))
    );
    assert!(output(&arguments(&[])).contains("Derivatives by contacts[0].gap_m hold for an increase of it"));
}

/// A ball that rests on the floor presses it at once if it moves downwards. If it moves upwards, it comes back later.
#[test]
fn derivatives_by_the_speed_of_a_body_at_rest_hold_on_one_side() {
    let tree = json!({
        "bodies": { "ball": { "kind": "mass", "mass_kg": 1 } },
        "contacts": [{ "name": "c", "between": [{ "body": "ball" }, "ground"], "law": "hertz", "stiffness_n_m1_5": 1e6 }],
        "gravity_m_s2": 9.81,
        "end_s": 0.01,
    });
    let fields = ["bodies.ball.velocity_m_s", "bodies.ball.mass_kg"].map(str::to_owned);
    let found = AssemblyScene::from_value(&tree).unwrap().sensitivity(&fields).unwrap();
    let approach = found.table.of("contacts.c.intervals[0].approach_speed_m_s", &fields[0]).unwrap();
    assert!((approach.value + 1.0).abs() < 1e-9, "{approach:?}");
    assert_eq!(found.table.fields.iter().map(|field| field.holds_for).collect::<Vec<_>>(), [Some("decrease"), None]);
}

/// The gap is that between the surfaces at the start, so that they touch there whatever the structure is displaced by: what rounding
/// leaves of the change of their distance is none.
#[test]
fn a_displacement_at_the_start_does_not_part_surfaces_that_touch() {
    for displacement in [-1e-4, 0.0, 1e-6] {
        let tree = changed("pinned-beam.json", |tree| {
            tree["start"] =
                json!({ "moving_modes": [{ "mode": 1, "displacement_m": displacement, "velocity_m_s": 0.1 }] });
        });
        let path = "start.moving_modes[0].displacement_m".to_owned();
        let found = Scene::from_value(&tree).unwrap().sensitivity(&[path]).unwrap();
        let start = found.of("sub_impacts[0].start_s", &found.table.fields[0].path).unwrap();
        assert_eq!((start.value, found.table.fields[0].holds_for), (0.0, None), "{displacement}");
    }
}

/// A jump moves to one side only, and so does a load that begins with the run. Other times have derivatives.
#[test]
fn times_at_which_a_load_jumps_have_no_derivative() {
    let scene = |times: [f64; 3]| {
        let tree = json!({
            "bodies": { "ball": { "kind": "mass", "mass_kg": 1, "position_m": 1 } },
            "contacts": [{ "name": "c", "between": [{ "body": "ball" }, "ground"], "law": "hertz", "stiffness_n_m1_5": 1e6 }],
            "loads": [{ "body": "ball", "times_s": times, "forces_n": [5, 5, 0] }],
            "end_s": 0.05,
        });
        AssemblyScene::from_value(&tree).unwrap()
    };
    let pulse = scene([0.0, 0.01, 0.01]);
    for k in 0..3 {
        let fault = pulse.sensitivity(&[format!("loads[0].times_s[{k}]")]).unwrap_err();
        assert!(fault.field == "--by" && fault.to_string().contains("a load jumps there"), "{fault}");
    }
    let found = pulse.sensitivity(&[]).unwrap();
    assert_eq!(found.table.left_out.iter().filter(|left| left.path.contains("times_s")).count(), 3);
    // half of the last interval counts, and it begins later
    let ramp = scene([0.0, 0.01, 0.02]);
    let by_time = ramp.sensitivity(&["loads[0].times_s[2]".to_owned()]).unwrap();
    let value = by_time.table.of("points[0].velocity_m_s", "loads[0].times_s[2]").unwrap().value;
    assert!((value.abs() - 2.5).abs() < 1e-9, "{value}");
}
