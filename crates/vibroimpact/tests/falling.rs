//! The rebound of a striker that falls on the structure.

use std::f64::consts::PI;

use serde_json::{Value, json};
use vibroimpact::Scene;
use vibroimpact::assembly::AssemblyScene;
use vibroimpact::simulate::Simulation;
use vibroimpact::summary::Falling;

const GRAVITY_M_S2: f64 = 9.80665;

/// A ball on a pinned bar of steel, by its modes.
fn scene(modes: usize, damping_ratio: f64) -> Value {
    let numbers = 1..=modes;
    let shape: Vec<f64> = numbers.clone().map(|n| (2.0f64 / 1.13).sqrt() * (0.3 * PI * n as f64).sin()).collect();
    json!({
        "structure": { "kind": "modal", "omega_rad_s": numbers.map(|n| 177.0 * (n * n) as f64).collect::<Vec<f64>>(),
                       "damping_ratios": vec![damping_ratio; modes], "shape_at_location": shape },
        "striker": { "mass_kg": 0.263, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": 2.17e10 },
        "model": "modal"
    })
}

fn falling(scene: &Value) -> Option<Falling> {
    let found = Scene::from_value(scene).unwrap().simulate().unwrap();
    match found {
        Simulation::Modal(found) => found.summary.falling,
        _ => None,
    }
}

/// The same bodies under gravity, which does not act on the structure, as it hangs in its own weight already. After each contact the
/// height to which the ball rises follows from where it is, and how fast.
#[test]
fn the_height_is_that_of_bodies_under_gravity() {
    let scene = scene(14, 0.01);
    let found = falling(&scene).unwrap();
    let structure = &scene["structure"];
    let bodies = |end_s: f64| {
        AssemblyScene::from_value(&json!({
            "bodies": {
                "ball": { "kind": "mass", "mass_kg": 0.263, "velocity_m_s": -1 },
                "bar": { "kind": "modal", "omega_rad_s": structure["omega_rad_s"], "damping_ratios": structure["damping_ratios"],
                         "points": { "struck": { "shape": structure["shape_at_location"] } },
                         "gravity_participation_kg0_5": vec![0.0; 14] }
            },
            "contacts": [{ "name": "contact", "between": [{ "body": "ball" }, { "body": "bar", "location": "struck" }],
                           "law": "hertz", "stiffness_n_m1_5": 2.17e10 }],
            "gravity_m_s2": GRAVITY_M_S2, "end_s": end_s, "tolerance": 1e-10
        }))
        .unwrap()
        .simulate()
        .unwrap()
    };
    let contacts = bodies(0.2).intervals.concat();
    let rises = contacts.windows(2).map(|pair| {
        let end_s = pair[0].end_s.unwrap();
        let end = &bodies(end_s).run.contacts[0];
        let ([height_m, _], [rate_m_s, _]) = (end.displacement_m, end.velocity_m_s);
        // it may be struck again before it is highest
        let is_highest = rate_m_s > 0.0 && end_s + rate_m_s / GRAVITY_M_S2 < pair[1].start_s;
        if is_highest { height_m + rate_m_s.powi(2) / (2.0 * GRAVITY_M_S2) } else { 0.0 }
    });
    let least = 0.01 / (2.0 * GRAVITY_M_S2);
    let rises: Vec<f64> = rises.take(found.sub_impact_count).collect();
    let (last, before) = rises.split_last().unwrap();
    assert!((last / found.rise_m - 1.0).abs() < 1e-3, "{last} {found:?}");
    assert!(before.len() > 2 && before.iter().all(|rise| *rise < least), "{before:?}");
    assert!((found.restitution.powi(2) * 0.5 / GRAVITY_M_S2 / found.rise_m - 1.0).abs() < 1e-12);
}

#[test]
fn a_striker_that_hardly_rises_stays() {
    // without gravity it leaves with 0.31 of its speed, from far below
    let mut soft = scene(1, 0.5);
    (soft["structure"]["omega_rad_s"], soft["striker"]["mass_kg"]) = (json!([60]), json!(2));
    soft["structure"]["shape_at_location"] = json!([1]);
    let found = falling(&soft).unwrap();
    assert_eq!((found.restitution, found.rise_m), (0.0, 0.0));
}

#[test]
fn gravity_is_considered_only_where_it_matters() {
    let mut fast = scene(14, 0.01);
    fast["striker"]["speed_m_s"] = json!(100);
    assert_eq!(falling(&fast), None);
    // the structure falls as well
    let mut free = scene(14, 0.01);
    free["structure"]["omega_rad_s"][0] = json!(0);
    assert_eq!(falling(&free), None);
    // a single short contact
    let mut single = scene(1, 0.01);
    single["structure"]["omega_rad_s"] = json!([1e5]);
    assert_eq!(falling(&single), None);
}
