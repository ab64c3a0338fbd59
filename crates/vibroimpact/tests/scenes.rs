//! Scene files: the gallery runs, a scene that is written is read back unchanged, and no input causes a panic.

use crate::gallery::{gallery, named, restitution};
use proptest::prelude::*;
use serde_json::{Value, json};
use vibroimpact::assembly::{AnyScene, AxialEnd};
use vibroimpact::model::{Model, Modes};
use vibroimpact::scene::{BeamTheory, Contact, Edge, End, Modal, PlateTheory, Structure};
use vibroimpact::{Scene, SceneError};

#[test]
fn every_scene_of_the_gallery_runs_and_balances_its_energy() {
    let gallery = gallery();
    assert!(gallery.len() >= 10);
    for (name, scene) in gallery.into_iter().filter(|(_, scene)| !scene.is_infinite()) {
        let impact = scene.impact().unwrap();
        let (solution, history) = impact.record().unwrap();
        let energy = history.energy_ledger();
        // A structure that moves beforehand may supply more energy than the striker.
        let most = if scene.start.is_some() { f64::INFINITY } else { 1.0 };
        assert!(solution.restitution.is_some_and(|e| e > 0.0 && e < most), "{name}: {solution:?}");
        let allowed = impact.settings.tolerance.max(1e-9);
        assert!(energy.residual_j.abs() < allowed * energy.initial_j, "{name}: {energy:?}");
        assert!(scene.description.is_some_and(|text| !text.is_empty()), "{name}");
    }
}

/// The name of each value is that in scene files, and is read back.
macro_rules! named_as_in_scenes {
    ($($kind:ident: $($value:ident),+;)+) => {$($(
        assert_eq!(serde_json::to_value($kind::$value).unwrap(), $kind::$value.as_str());
        assert_eq!($kind::$value.to_string().parse(), Ok($kind::$value));
    )+)+};
}

#[test]
fn enums_have_the_names_of_scene_files() {
    named_as_in_scenes! {
        Model: Auto, Rigid, InfiniteBeam, Modal, Emoc;
        BeamTheory: EulerBernoulli, Timoshenko, Auto;
        End: Clamped, Pinned, Free, Guided;
        Edge: Clamped, Pinned, Free;
        PlateTheory: Kirchhoff, Mindlin;
        AxialEnd: Fixed, Free;
    }
    let fault = "glued".parse::<End>().unwrap_err();
    assert_eq!(fault.to_string(), "end = glued is not allowed; it must be one of clamped, pinned, free, guided");
}

/// A structure given by three modes, listed in this order, that moves at the start; the lowest two are taken.
fn listed(order: [usize; 3]) -> Value {
    let by = |values: [f64; 3]| order.map(|k| values[k]);
    json!({
        "structure": { "kind": "modal", "omega_rad_s": by([100.0, 400.0, 900.0]), "damping_ratios": by([0.01, 0.02, 0.03]),
                       "modal_mass_kg": by([1.0, 2.0, 3.0]), "points": { "tip": { "shape": by([1.0, 0.5, -0.7]) } } },
        "striker": { "mass_kg": 0.1, "speed_m_s": 1 }, "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 },
        "location": "tip", "modes": 2, "start": { "moving_modes": [{ "mode": 2, "velocity_m_s": 0.1 }] }
    })
}

#[test]
fn modes_may_be_listed_in_any_order() {
    let solved = |order, amplitudes: Value, change: &dyn Fn(&mut Value)| {
        let mut scene = listed(order);
        scene["start"]["amplitude_m_kg0_5"] = amplitudes;
        change(&mut scene);
        let impact = Scene::from_value(&scene)?.impact()?;
        Ok::<_, vibroimpact::InvalidInput>(impact.solve().unwrap())
    };
    let (sorted, none) = (solved([0, 1, 2], json!([1e-4, 2e-4]), &|_| {}).unwrap(), |_: &mut Value| {});
    assert_eq!(solved([1, 0, 2], json!([2e-4, 1e-4]), &none).unwrap(), sorted);
    assert_ne!(solved([1, 0, 2], json!([1e-4, 2e-4]), &none).unwrap(), sorted);
    // of the highest mode, which is listed first and not taken
    assert!(solved([2, 0, 1], json!([0, 1e-4]), &none).is_ok());
    let fault = solved([2, 0, 1], json!([3e-4, 1e-4]), &none).unwrap_err();
    assert_eq!(fault.field, "start.amplitude_m_kg0_5[0]");
    assert!(fault.to_string().contains("0, because this mode is not one of the 2 lowest of the list"), "{fault}");
    // an error names the place in the list
    let fault = solved([2, 0, 1], json!([]), &|scene| scene["structure"]["damping_ratios"][1] = json!(-1)).unwrap_err();
    assert_eq!(fault.field, "structure.damping_ratios[1]");
}

#[test]
fn every_infinite_scene_of_the_gallery_runs() {
    use vibroimpact::vibroimpact_sim::infinite::{Outcome, Settings, solve};
    let infinite: Vec<_> = gallery().into_iter().filter(|(_, scene)| scene.is_infinite()).collect();
    assert_eq!(infinite.len(), 2);
    for (name, scene) in infinite {
        let impact = scene.infinite_impact().unwrap();
        let solution = solve(impact.structure, impact.groups().unwrap().s, &Settings::default()).unwrap();
        assert!(!matches!(solution.outcome, Outcome::Stopped(_)), "{name}");
        assert!(solution.digits().is_some_and(|digits| digits > 9.0), "{name}");
        assert_eq!(scene.impact().unwrap_err().field, "structure.kind", "{name}");
        assert!(scene.description.is_some_and(|text| !text.is_empty()), "{name}");
    }
}

#[test]
fn written_scenes_are_read_back_unchanged() {
    for (name, scene) in gallery() {
        let text = scene.to_json();
        assert_eq!(Scene::from_json(&text).unwrap(), scene, "{name}");
        assert_eq!(serde_json::from_str::<Scene>(&text).unwrap(), scene, "{name}");
        assert!(!text.contains("null"), "{name}");
    }
}

#[test]
fn the_book_shows_a_scene_of_the_gallery_and_its_restitution() {
    let page = include_str!("../../../docs/how-to/commands.md");
    let block = page.split("```json").nth(1).unwrap().split("```").next().unwrap();
    let gallery = Scene { description: None, ..named("pinned-beam-converged") };
    assert_eq!(Scene::from_json(block).unwrap(), gallery);
    let printed =
        |line: &str| -> f64 { page.split(line).nth(1).unwrap().split('±').next().unwrap().trim().parse().unwrap() };
    assert!((printed("  as modelled ") - restitution(&gallery)).abs() < 1e-7);
    // The headline shows no more digits than the total uncertainty allows.
    assert!((printed("  restitution ") - restitution(&gallery)).abs() < 1e-4);
}

#[test]
fn every_law_of_contact_models_can_be_named() {
    for (parameters, name) in [
        (r#""law": "hertz", "stiffness_n_m1_5": 1e9"#, "hertz"),
        (r#""law": "viscous", "stiffness_n_m1_5": 1e9, "restitution": 0.9"#, "viscous"),
        (r#""law": "hysteretic", "stiffness_n_m1_5": 1e9, "theta_m": 1.6, "beta": 1.4, "k_bar": 0.4"#, "hysteretic"),
        (r#""law": "linear-spring", "stiffness_n_m": 1e6"#, "linear"),
        (r#""law": "power", "stiffness_n_m_n": 1e9, "exponent": 1.4"#, "power"),
        (r#""law": "felt", "stiffness_n_m_n": 1e12, "exponent": 2.5, "retardation_time_s": 1e-5"#, "felt"),
        (r#""law": "kelvin-voigt", "stiffness_n_m": 1e6, "restitution": 0.5"#, "kelvin-voigt"),
        (r#""law": "hunt-crossley", "stiffness_n_m_n": 1e8, "exponent": 1.3, "damping_s_m": 0.1"#, "hunt-crossley"),
        (r#""law": "lankarani-nikravesh", "stiffness_n_m1_5": 1e9, "restitution": 0.9"#, "lankarani-nikravesh"),
        (r#""law": "flores", "stiffness_n_m1_5": 1e9, "restitution": 0.6"#, "flores"),
        (
            r#""law": "elastoplastic", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3, "yield_pressure_pa": 1e9"#,
            "thornton",
        ),
    ] {
        let value: Value = serde_json::from_str(&format!("{{{parameters}}}")).unwrap();
        let mut scene = named("pinned-beam-small-ball");
        scene.contact = serde_json::from_value(value.clone()).unwrap();
        assert_eq!(scene.contact.law_name(), value["law"]);
        assert_eq!(scene.impact().unwrap().law.name(), name);
        assert!(restitution(&scene) < 1.0, "{name}");

        // A law has one name in scenes, and a mistake is answered with all of them.
        let slip = scene.to_json().replace(scene.contact.law_name(), "slip");
        let message = Scene::from_json(&slip).unwrap_err().to_string();
        assert!(message.contains(scene.contact.law_name()), "{message}");
    }
    for name in ["linear", "thornton"] {
        let mut value = tree("pinned-beam-small-ball");
        value["contact"] = json!({ "law": name, "stiffness_n_m": 1e6 });
        let message = Scene::from_value(&value).unwrap_err().to_string();
        assert!(message.starts_with("contact.law = "), "{message}");
    }
}

/// A scene of the gallery as a tree.
fn tree(name: &str) -> Value {
    serde_json::from_str(&named(name).to_json()).unwrap()
}

/// A number that its law rejects is reported by its name in the scene.
#[test]
fn errors_of_a_law_name_the_field_of_the_scene() {
    for contact in [
        json!({ "law": "hertz", "stiffness_n_m1_5": 1e9 }),
        json!({ "law": "viscous", "stiffness_n_m1_5": 1e9, "restitution": 0.9 }),
        json!({ "law": "hysteretic", "stiffness_n_m1_5": 1e9, "theta_m": 1.6, "beta": 1.4, "k_bar": 0.4 }),
        json!({ "law": "linear-spring", "stiffness_n_m": 1e6 }),
        json!({ "law": "power", "stiffness_n_m_n": 1e9, "exponent": 1.4 }),
        json!({ "law": "felt", "stiffness_n_m_n": 1e12, "exponent": 2.5, "retardation_time_s": 1e-5 }),
        json!({ "law": "kelvin-voigt", "stiffness_n_m": 1e6, "restitution": 0.5 }),
        json!({ "law": "hunt-crossley", "stiffness_n_m1_5": 1e9, "restitution": 0.8 }),
        json!({ "law": "hunt-crossley", "stiffness_n_m_n": 1e8, "exponent": 1.3, "damping_s_m": 0.1 }),
        json!({ "law": "lankarani-nikravesh", "stiffness_n_m1_5": 1e9, "restitution": 0.9 }),
        json!({ "law": "flores", "stiffness_n_m1_5": 1e9, "restitution": 0.6 }),
        json!({ "law": "elastoplastic", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3, "yield_pressure_pa": 1e9 }),
    ] {
        for (key, _) in contact.as_object().unwrap().iter().filter(|(_, value)| value.is_number()) {
            let mut scene = tree("pinned-beam-small-ball");
            scene["contact"] = contact.clone();
            scene["contact"][key] = json!(-3.5);
            let fault = Scene::from_value(&scene).and_then(|scene| scene.impact().map(|_| ())).unwrap_err();
            assert_eq!(fault.field.to_string(), format!("contact.{key}"), "{contact}");
        }
    }
}

/// The damping that follows from a restitution depends on the speed of approach, and so on the motion of the structure.
#[test]
fn a_restitution_belongs_to_the_relative_speed() {
    for law in ["viscous", "hunt-crossley"] {
        let scene = |speed_m_s: f64, surface_m_s: f64| {
            json!({
                "structure": { "kind": "modal", "omega_rad_s": [0, 100, 400], "shape_at_location": [1.0, 0.5, -0.7] },
                "striker": { "mass_kg": 0.1, "speed_m_s": speed_m_s },
                "contact": { "law": law, "stiffness_n_m1_5": 1e9, "restitution": 0.5 },
                "start": { "moving_modes": [{ "mode": 1, "velocity_m_s": surface_m_s }] }
            })
        };
        let solved = |scene: &Value| Scene::from_value(scene).and_then(|scene| scene.impact()?.solve());
        let seen_from = |observer: f64| solved(&scene(1.0 + observer, -observer)).unwrap().restitution.unwrap();
        for observer in [-3.0, -1.0, -0.5, 0.7] {
            assert!((seen_from(observer) - seen_from(0.0)).abs() < 1e-9, "{law} {observer}");
        }
        // an immovable stop, which the structure approaches
        let mut stop = scene(0.0, 1.0);
        stop["striker"] = json!({ "immovable": true, "speed_m_s": 0 });
        assert!(solved(&stop).unwrap().restitution.is_some_and(|e| e > 0.0 && e < 1.0), "{law}");
        let fault = solved(&scene(1.0, -1.0)).unwrap_err();
        assert!(
            fault.field == "contact.restitution" && fault.allowed.contains("damping_s_m takes its place"),
            "{fault}"
        );
        stop["contact"] = json!({ "law": "kelvin-voigt", "stiffness_n_m": 1e6, "restitution": 0.5 });
        let fault = solved(&stop).unwrap_err();
        assert!(fault.field == "contact.restitution" && fault.allowed.contains("damping_n_s_m"), "{fault}");
    }
}

/// Without a separation the restitution is 0, whatever rounding is left of the motion, on every structure.
#[test]
fn sustained_contact_has_a_restitution_of_zero() {
    let mut scene = json!({
        "structure": { "kind": "modal", "omega_rad_s": [0], "shape_at_location": [1e6] },
        "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
        "contact": { "law": "kelvin-voigt", "stiffness_n_m": 1e7, "restitution": 0.4 }
    });
    let answer = |scene: &Value| Scene::from_value(scene).unwrap().answer().unwrap();
    let found = answer(&scene);
    assert_eq!((found.outcome, found.restitution), ("sustained", Some(0.0)));
    scene = tree("infinite-beam");
    let found = answer(&scene);
    assert_eq!((found.outcome, found.restitution), ("sustained", Some(0.0)));
}

#[test]
fn missing_parts_of_a_scene_are_named() {
    let mut scene = tree("pinned-beam-small-ball");
    scene["structure"] = json!({ "kind": "modal", "omega_rad_s": [100], "points": {} });
    assert_eq!(Scene::from_value(&scene).unwrap_err().field.to_string(), "structure.points");
    let bodiless = json!({ "contacts": [], "end_s": 1 });
    assert_eq!(AnyScene::from_value(&bodiless).unwrap_err().field.to_string(), "bodies");
}

#[test]
fn the_numbers_of_chapter_3() {
    // The reference values at N = 40 with plain truncation, and the limit of many modes, 0.142554, with remainder modes at N =
    // 100.
    assert!((restitution(&named("pinned-beam")) - 0.17739).abs() < 1e-5);
    assert!((restitution(&named("pinned-beam-converged")) - 0.142554).abs() < 1e-5);
    let small = named("pinned-beam-small-ball").impact().unwrap().solve().unwrap();
    assert_eq!(small.sub_impacts.len(), 1);
    // Thesis Eq. 3.20.
    let contact_models::Law::Hertz(hertz) = named("pinned-beam").impact().unwrap().law else { panic!() };
    assert!((hertz.stiffness_n_m1_5 - 1.7945e10).abs() < 5e5 * 1.0e1);
    // With materials, a hysteretic contact has Hertz's loading curve: a quarter of the stiffness (thesis 3.3.4).
    let contact_models::Law::Hysteretic(law) = named("hysteretic").impact().unwrap().law else { panic!() };
    assert!((law.stiffness_n_m1_5 / hertz.stiffness_n_m1_5 - 0.25).abs() < 1e-15);
}

#[test]
fn a_striker_of_another_material_softens_the_contact() {
    let mut scene = named("pinned-beam");
    let stiffness = |scene: &Scene| match scene.impact().unwrap().law {
        contact_models::Law::Hertz(law) => law.stiffness_n_m1_5,
        other => panic!("{other:?}"),
    };
    let steel = stiffness(&scene);
    let Contact::Hertz(ref mut hertz) = scene.contact else { panic!() };
    hertz.materials.striker_youngs_modulus_pa = Some(2e11 / 3.0);
    hertz.materials.striker_poissons_ratio = Some(0.3);
    // 1/E* grows from 2 to 4 times the structure's part.
    assert!((stiffness(&scene) / steel - 0.5).abs() < 1e-14);
}

#[test]
fn a_modal_structure_includes_the_compliance_of_its_truncated_modes() {
    let beam = named("pinned-beam-converged");
    let mut scene = beam.clone();
    let impact = beam.impact().unwrap();
    let modes = &impact.structure.modes[..impact.kept_modes()];
    let Structure::Beam(ref described) = beam.structure else { panic!() };
    let whole = described.to_beam().unwrap().static_compliance(0.6180339887498949).unwrap();
    scene.structure = Structure::Modal(Modal {
        omega_rad_s: modes.iter().map(|mode| mode.omega_rad_s).collect(),
        shape_at_location: modes.iter().map(|mode| mode.shape).collect(),
        damping_ratios: vec![0.02; modes.len()],
        static_compliance_m_n: Some(whole),
        ..Modal::default()
    });
    (scene.location_m, scene.modes) = (None, Modes::Auto);
    // Four remainder modes by the trend of the list, two by the beam itself: the same compliance, nearly the same impact.
    let listed = scene.impact().unwrap();
    assert_eq!((impact.remainder_modes, listed.remainder_modes, listed.kept_modes()), (2, 4, 100));
    assert_eq!(&listed.structure.modes[..100], modes);
    assert!((listed.residual_compliance_m_n() / impact.residual_compliance_m_n() - 1.0).abs() < 1e-9);
    assert!((restitution(&scene) - restitution(&beam)).abs() < 1e-4);

    let Structure::Modal(ref mut modal) = scene.structure else { panic!() };
    modal.static_compliance_m_n = Some(0.5 * whole);
    assert!(scene.structure().unwrap_err().to_string().contains("structure.static_compliance_m_n"));
    let Structure::Modal(ref mut modal) = scene.structure else { panic!() };
    modal.static_compliance_m_n = None;
    assert!(scene.structure().unwrap_err().to_string().contains("structure.static_compliance_m_n is missing"));
    let Structure::Modal(ref mut modal) = scene.structure else { panic!() };
    modal.shape_at_location.pop();
    assert!(scene.structure().unwrap_err().to_string().contains("structure.shape_at_location = 99 values"));
    // There is no elastic mode in the list, so that the response of the rest is unknown.
    let Structure::Modal(ref mut modal) = scene.structure else { panic!() };
    *modal = Modal {
        omega_rad_s: vec![0.0, 0.0, 50.0],
        shape_at_location: vec![1.0; 3],
        static_compliance_m_n: Some(1e-3),
        ..Modal::default()
    };
    for modes in [Modes::Count(0), Modes::Count(2)] {
        scene.modes = modes;
        let fault = scene.impact().unwrap_err();
        assert_eq!(fault.field, "structure.static_compliance_m_n");
        assert!(fault.allowed.contains("at least one mode with a frequency above 0"), "{fault}");
        assert_eq!(scene.answer().unwrap_err(), fault);
    }
    let Structure::Modal(ref mut modal) = scene.structure else { panic!() };
    modal.omega_rad_s[2] = 0.0;
    (scene.modes, scene.residual_compliance) = (Modes::Auto, None);
    assert_eq!(scene.answer().unwrap_err().field, "structure.static_compliance_m_n");
    scene.residual_compliance = Some(false);
    assert!(scene.answer().is_ok());
}

#[test]
fn values_that_json_cannot_represent_are_refused_too() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut scene = named("pinned-beam");
        scene.striker.speed_m_s = value;
        let refused = |scene: &Scene| scene.impact().and_then(|impact| impact.solve()).unwrap_err();
        assert_eq!(refused(&scene).field, "striker.speed_m_s");
        let mut scene = named("pinned-beam");
        scene.location_m = Some(value.into());
        assert_eq!(refused(&scene).field, "location_m");
        let mut scene = named("pinned-beam");
        scene.tolerance = Some(value);
        assert_eq!(refused(&scene).field, "tolerance");
        let mut scene = named("pinned-beam");
        let Structure::Beam(ref mut beam) = scene.structure else { panic!() };
        beam.segments[0].width_m = Some(value);
        assert_eq!(refused(&scene).field, "structure.segments[0].width_m");
    }
}

fn any_json() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<f64>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        "[a-z_é\"]{0,6}".prop_map(Value::from),
    ];
    leaf.prop_recursive(3, 24, 5, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..5).prop_map(Value::from),
            prop::collection::btree_map("[a-z_é]{0,6}", inner, 0..5)
                .prop_map(|map| Value::Object(map.into_iter().collect())),
        ]
    })
}

/// Every value in a tree, by JSON pointer.
fn places(tree: &Value, here: String, all: &mut Vec<String>) {
    all.push(here.clone());
    match tree {
        Value::Object(map) => map.iter().for_each(|(key, value)| places(value, format!("{here}/{key}"), all)),
        Value::Array(list) => list.iter().enumerate().for_each(|(i, value)| places(value, format!("{here}/{i}"), all)),
        _ => {}
    }
}

proptest! {
    #[test]
    fn arbitrary_text_never_panics(text in "\\PC{0,80}") {
        prop_assert!(Scene::from_json(&text).is_err());
    }

    #[test]
    fn arbitrary_json_never_panics(value in any_json()) {
        prop_assert!(Scene::from_json(&value.to_string()).is_err());
    }

    #[test]
    fn a_truncated_scene_is_a_syntax_error(cut in 0usize..400) {
        let text = named("stepped-cantilever").to_json();
        let whole = Scene::from_json(&text[..cut.min(text.len() - 1)]);
        prop_assert!(matches!(whole, Err(SceneError::Syntax { .. })), "{whole:?}");
    }

    /// A valid scene with one value overwritten is converted for the solver, or rejected with a field.
    #[test]
    fn a_changed_scene_is_accepted_or_refused(
        which in any::<prop::sample::Index>(),
        at in any::<prop::sample::Index>(),
        spoil in prop_oneof![
            any_json(),
            prop::sample::select(vec![0.0, -1.0, 1e-300, 1e300, 1e30, 1e-30, 1e9, 0.5, 3.0]).prop_map(Value::from),
            (0u64..60).prop_map(Value::from),
        ],
    ) {
        let gallery = gallery();
        let mut tree: Value = serde_json::from_str(&which.get(&gallery).1.to_json()).unwrap();
        let mut all = Vec::new();
        places(&tree, String::new(), &mut all);
        *tree.pointer_mut(at.get(&all).as_str()).unwrap() = spoil;
        match Scene::from_value(&tree) {
            Err(fault) => prop_assert!(fault.value.is_some() || !fault.field.is_empty()),
            Ok(scene) if scene.is_infinite() => match scene.posed_on_infinite() {
                Err(fault) => prop_assert!(!fault.field.is_empty(), "{fault}"),
                Ok(posed) => prop_assert!(posed.receptance.displacement_m(1.0) > 0.0),
            },
            Ok(scene) => match scene.impact() {
                Err(fault) => prop_assert!(!fault.field.is_empty(), "{fault}"),
                Ok(impact) => prop_assert!(impact.structure.modes.iter().all(|mode| mode.shape.is_finite())),
            },
        }
    }
}
