//! Limits of the theories: the values compared with numbers found in other ways.

use std::f64::consts::PI;

use serde_json::{Value, json};
use vibroimpact::Scene;
use vibroimpact::trust::{Check, Verdict};

/// The impact of chapter 3, with remainder modes.
fn chapter_3() -> Value {
    json!({
        "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.02, "segments": [
            { "length_m": 1, "youngs_modulus_pa": 2e11, "density_kg_m3": 7800, "width_m": 0.011323, "thickness_m": 0.011323 }
        ] },
        "striker": { "density_kg_m3": 7800, "radius_m": 0.015, "speed_m_s": 1 },
        "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 },
        "location_m": 0.618_033_988_749_894_9, "modes": 100, "residual_compliance": true
    })
}

fn checks(scene: &Value) -> (Value, Vec<Check>) {
    let scene = Scene::from_value(scene).unwrap();
    let found = scene.simulate().unwrap();
    (serde_json::from_str(&found.json(&scene).unwrap()).unwrap(), scene.trust(&found).unwrap())
}

fn named<'a>(checks: &'a [Check], name: &str) -> &'a Check {
    checks.iter().find(|check| check.check == name).unwrap_or_else(|| panic!("{name} of {checks:?}"))
}

#[test]
fn the_contact_by_hertz_from_the_force_alone() {
    let mut scene = chapter_3();
    scene["yield_strength_pa"] = json!(1e9);
    let (result, found) = checks(&scene);
    let force = result["sub_impacts"][0]["peak_force_n"].as_f64().unwrap();
    // With E* of two steel bodies: a = (3 F R/(4 E*))^(1/3), p = (6 F E*^2/(pi^3 R^2))^(1/3).
    let (modulus, radius): (f64, f64) = (2e11 / (2.0 * 0.91), 0.015);
    let contact = (0.75 * force * radius / modulus).cbrt();
    let pressure = (6.0 * force * modulus.powi(2) / (PI.powi(3) * radius.powi(2))).cbrt();
    let near = |check: &Check, value: f64| assert!((check.value / value - 1.0).abs() < 1e-6, "{check:?} {value}");
    near(named(&found, "contact_radius"), contact / radius);
    near(named(&found, "indentation"), contact / 0.011323);
    let of_pressure = named(&found, "pressure");
    near(of_pressure, pressure / 1e9);
    assert_eq!(of_pressure.verdict, Verdict::Doubtful);
    for (strength, verdict) in [(2e9, Verdict::Within), (3e8, Verdict::Outside)] {
        scene["yield_strength_pa"] = json!(strength);
        let (other, found) = checks(&scene);
        assert_eq!(named(&found, "pressure").verdict, verdict);
        assert_eq!(other["restitution"], result["restitution"]);
    }
}

/// Ends, steps and edges, computed by hand: the nearest, in thicknesses.
#[test]
fn contacts_near_an_end_a_step_or_an_edge_are_not_on_a_half_space() {
    let mut scene = chapter_3();
    for (place, ratio, verdict) in [
        (0.618, 0.382 / 0.011323, Verdict::Within),
        (0.006, 0.006 / 0.011323, Verdict::Doubtful),
        (0.999, 0.001 / 0.011323, Verdict::Outside),
    ] {
        scene["location_m"] = json!(place);
        let check = named(&checks(&scene).1, "edge").clone();
        assert!((check.value / ratio - 1.0).abs() < 1e-9 && check.verdict == verdict, "{check:?}");
    }
    let mut half = scene["structure"]["segments"][0].clone();
    half["length_m"] = json!(0.5);
    scene["structure"]["segments"] = json!([half, half]);
    scene["location_m"] = json!(0.502);
    assert_eq!(named(&checks(&scene).1, "edge").verdict, Verdict::Outside);
    scene["structure"] = json!({ "kind": "plate", "length_m": 0.4, "width_m": 0.3, "thickness_m": 0.005, "edges":
        ["pinned", "pinned", "pinned", "pinned"], "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3, "density_kg_m3": 7800 });
    scene["location_m"] = json!([0.2, 0.297]);
    let check = named(&checks(&scene).1, "edge").clone();
    assert!((check.value - 0.6).abs() < 1e-9 && check.verdict == Verdict::Doubtful, "{check:?}");
}

/// A steel ball of 15 mm: `c_t` = 3,140 m/s, a lowest period of 11.4 us; and 17.75 ms of fall.
#[test]
fn ball_and_gravity_by_hand() {
    let (result, found) = checks(&chapter_3());
    let contact = &result["sub_impacts"][0];
    let duration = contact["end_s"].as_f64().unwrap() - contact["start_s"].as_f64().unwrap();
    assert!((named(&found, "ball").value - duration / 11.368e-6).abs() < 0.01, "{found:?}");
    assert_eq!(named(&found, "ball").verdict, Verdict::Within);
    let end = result["end_s"].as_f64().unwrap();
    assert!((named(&found, "gravity").value - 9.80665 * end).abs() < 1e-12);
    assert_eq!(named(&found, "gravity").verdict, Verdict::Outside);
    // One contact is too short for a fall.
    let mut small = chapter_3();
    small["striker"]["radius_m"] = json!(0.005);
    assert_eq!(named(&checks(&small).1, "gravity").verdict, Verdict::Within);
}

/// On a beam so heavy that it hardly moves, the force of a linear spring is half a sine, whose spectrum is known.
#[test]
fn the_spectrum_of_half_a_sine() {
    let (h, stiffness, mass): (f64, f64, f64) = (0.5, 1e9, 1.0);
    let duration = PI * (mass / stiffness).sqrt();
    for thinner in [1.0, 0.5, 0.3] {
        let thickness = h * thinner;
        let scene = json!({
            "structure": { "kind": "beam", "ends": ["clamped", "clamped"], "damping_ratio": 0.02, "segments": [
                { "length_m": 20, "youngs_modulus_pa": 2e15, "density_kg_m3": 7.8e7, "width_m": 2, "thickness_m": thickness }
            ] },
            "striker": { "mass_kg": mass, "speed_m_s": 1 },
            "contact": { "law": "linear-spring", "stiffness_n_m": stiffness },
            "location_m": 10, "modes": 20
        });
        let k = PI / (6.0 * thickness);
        let limit = k * k * (2e15 * thickness.powi(2) / (12.0 * 7.8e7)).sqrt();
        // |F|^2 of sin(pi t/T) from 0 to T, by the midpoint rule; int F^2 dt = T/2.
        let spectrum = |omega: f64| {
            let x = omega * duration;
            (2.0 * duration / PI * (0.5 * x).cos() / (1.0 - (x / PI).powi(2))).powi(2)
        };
        let steps = 100_000;
        let below: f64 = (0..steps).map(|i| spectrum((f64::from(i) + 0.5) * limit / f64::from(steps))).sum();
        let exact = 1.0 - below * limit / f64::from(steps) / (0.5 * PI * duration);
        let found = named(&checks(&scene).1, "spectrum").clone();
        println!("{} {exact} {}", found.value, limit * duration);
        assert!((found.value - exact).abs() < 2e-4 + 0.01 * exact, "{found:?} {exact}");
    }
}

/// The fastest relevant mode of chapter 3's impact is where Euler-Bernoulli's theory is doubtful, and well within Timoshenko's;
/// for a heavy soft striker everything is within the limits.
#[test]
fn short_waves_need_shear() {
    let wavelength = |theory: Option<&str>| {
        let mut scene = chapter_3();
        if let Some(theory) = theory {
            scene["structure"]["theory"] = json!(theory);
            scene["structure"]["segments"][0]["poissons_ratio"] = json!(0.3);
        }
        named(&checks(&scene).1, "wavelength").clone()
    };
    let (slender, thick) = (wavelength(None), wavelength(Some("timoshenko")));
    assert_eq!((slender.verdict, thick.verdict), (Verdict::Doubtful, Verdict::Within));
    // A mode of the beam: n half waves over its metre.
    let waves = 1.0 / (slender.value * 0.011323);
    assert!((waves - waves.round()).abs() < 1e-6 && (15.0..40.0).contains(&waves), "{waves}");
    let mut soft = chapter_3();
    soft["striker"] = json!({ "mass_kg": 10, "speed_m_s": 0.1 });
    soft["contact"] = json!({ "law": "linear-spring", "stiffness_n_m": 1e4 });
    let found = checks(&soft).1;
    assert_eq!(named(&found, "wavelength").verdict, Verdict::Within);
    assert_eq!(named(&found, "spectrum").verdict, Verdict::Within);
    assert!(found.iter().all(|check| !["ball", "pressure", "contact_radius"].contains(&check.check)));
}

#[test]
fn every_kind_of_result_ends_with_its_limits() {
    let mut scene = chapter_3();
    for (model, waves) in [("rigid", false), ("emoc", false), ("infinite-beam", true), ("modal", true)] {
        scene["model"] = json!(model);
        let fields = scene.as_object_mut().unwrap();
        fields.remove("modes");
        fields.remove("residual_compliance");
        let (result, found) = checks(&scene);
        let told: Vec<Check> =
            found.into_iter().filter(|check| ["wavelength", "spectrum"].contains(&check.check)).collect();
        // The infinite beam has a result without a history of its own.
        assert_eq!(!told.is_empty(), waves && model == "modal", "{model}: {told:?}");
        let listed = result["trust"].as_array().unwrap();
        assert!(listed.iter().any(|check| check["check"] == "contact_radius"), "{model}");
        for check in listed {
            assert!(["within", "doubtful", "outside"].contains(&check["verdict"].as_str().unwrap()));
            assert!(check["value"].is_f64() && check["says"].as_str().unwrap().len() > 20, "{check}");
        }
    }
    let infinite = json!({
        "structure": { "kind": "infinite-beam", "youngs_modulus_pa": 2e11, "density_kg_m3": 7800, "width_m": 0.028,
                       "thickness_m": 0.028 },
        "striker": { "density_kg_m3": 7800, "radius_m": 0.01, "speed_m_s": 0.5 },
        "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 }
    });
    assert!(named(&checks(&infinite).1, "spectrum").value > 0.1);
}

#[test]
fn a_yield_strength_out_of_range_is_named() {
    for value in [json!(0), json!(-1e9), json!("hard")] {
        let mut scene = chapter_3();
        scene["yield_strength_pa"] = value;
        let fault = Scene::from_value(&scene).and_then(|scene| scene.answer()).unwrap_err();
        assert!(fault.field == "yield_strength_pa" && fault.allowed.contains("greater than 0"), "{fault}");
    }
    for model in ["rigid", "emoc", "infinite-beam"] {
        let mut scene = chapter_3();
        scene["model"] = json!(model);
        scene["yield_strength_pa"] = json!(-1);
        assert_eq!(Scene::from_value(&scene).unwrap().simulate().err().unwrap().field, "yield_strength_pa", "{model}");
    }
}

/// The first contact on an infinite beam by Timoshenko's theory, found from the mobility, agrees with that on a finite beam by
/// its modes, which is so long that no wave returns in time.
#[test]
fn the_early_response_of_an_infinite_beam_is_that_of_a_long_one() {
    let section = json!({ "youngs_modulus_pa": 2e11, "density_kg_m3": 7800, "width_m": 0.02, "thickness_m": 0.02,
                          "poissons_ratio": 0.3 });
    let mut changes = Vec::new();
    for radius in [0.012, 0.016, 0.02, 0.024] {
        let mut scene = json!({
            "structure": section, "striker": { "density_kg_m3": 7800, "radius_m": radius, "speed_m_s": 1 },
            "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 }
        });
        scene["structure"]["kind"] = json!("infinite-beam");
        let (result, found) = checks(&scene);
        let early = named(&found, "early_response");
        let slender = result["infinite"]["first_rebound_ratio"].as_f64().unwrap();

        // No wave is faster than 5,064 m/s; a contact lasts less than 0.35 ms.
        let mut piece = section.clone();
        piece["length_m"] = json!(2.0);
        scene["structure"] =
            json!({ "kind": "beam", "theory": "timoshenko", "ends": ["pinned", "pinned"], "segments": [piece] });
        scene["location_m"] = json!(1.0);
        scene["modes"] = json!(800);
        scene["residual_compliance"] = json!(true);
        let (result, _) = checks(&scene);
        let impulse = result["sub_impacts"][0]["impulse_n_s"].as_f64().unwrap();
        let end = result["sub_impacts"][0]["end_s"].as_f64().unwrap();
        assert!(end < 2.0 / 5064.0, "{radius}: {end}");
        let momentum = 7800.0 * 4.0 / 3.0 * PI * f64::powi(radius, 3);
        let change = (impulse / momentum - 1.0 - slender).abs();
        assert!((early.value - change).abs() < 1e-4, "{radius}: {} {change}", early.value);
        changes.push(change);
    }
    assert!(changes.iter().any(|change| *change > 0.01), "{changes:?}");
}
