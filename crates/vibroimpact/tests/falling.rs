//! The rebound of a striker that falls on the structure.

use std::f64::consts::PI;

use serde_json::{Value, json};
use vibroimpact::Scene;
use vibroimpact::assembly::AssemblyScene;
use vibroimpact::model::Model;
use vibroimpact::simulate::Simulation;
use vibroimpact::summary::Summary;
use vibroimpact::text;
use vibroimpact_sim::modal::Striker;

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
        "gravity_m_s2": GRAVITY_M_S2
    })
}

fn solved(scene: &Value) -> Summary {
    match Scene::from_value(scene).unwrap().simulate().unwrap() {
        Simulation::Modal(found) => found.summary,
        other => panic!("{other:?}"),
    }
}

/// The same bodies under gravity, which does not act on the structure, as it hangs in its own weight already. After each contact the
/// height to which the ball rises follows from where it is, and how fast.
#[test]
fn the_height_is_that_of_bodies_under_gravity() {
    let scene = scene(14, 0.01);
    let found = solved(&scene);
    let rise_m = found.rise_m.unwrap();
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
    assert!((last / rise_m - 1.0).abs() < 1e-7, "{last} {found:?}");
    assert!(before.len() > 2 && before.iter().all(|rise| *rise < least), "{before:?}");
    assert!((found.restitution.unwrap().powi(2) * 0.5 / GRAVITY_M_S2 / rise_m - 1.0).abs() < 1e-12);
}

#[test]
fn a_striker_that_hardly_rises_stays() {
    // without gravity it leaves with 0.31 of its speed, from far below
    let mut soft = scene(1, 0.5);
    (soft["structure"]["omega_rad_s"], soft["striker"]["mass_kg"]) = (json!([60]), json!(2));
    soft["structure"]["shape_at_location"] = json!([1]);
    let found = solved(&soft);
    assert_eq!((found.outcome, found.restitution, found.rise_m), ("sustained", Some(0.0), Some(0.0)));
    // the compressed contact holds energy in the end
    assert!(!found.energy.contact_conserves && found.energy.contact_j > 0.0, "{found:?}");
    assert!(found.energy.residual_j.abs() < 1e-9 * found.energy.initial_j, "{found:?}");
    soft["gravity_m_s2"] = json!(0);
    let found = solved(&soft);
    assert!(found.restitution.unwrap() > 0.3 && found.rise_m.is_none(), "{found:?}");
}

/// The program chooses theory and number of modes, and each part of the uncertainty is that of the fall.
#[test]
fn a_fall_on_a_beam_has_all_parts_of_its_uncertainty() {
    let beam = |gravity_m_s2: f64| {
        json!({
            "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.01,
                           "segments": [{ "length_m": 1, "width_m": 0.012, "thickness_m": 0.012, "material": "steel" }] },
            "striker": { "material": "steel", "radius_m": 0.02, "speed_m_s": 1 },
            "contact": { "law": "hertz", "material": "steel" }, "location_m": 0.3, "gravity_m_s2": gravity_m_s2
        })
    };
    let (without, with) = (solved(&beam(0.0)), solved(&beam(9.81)));
    assert!(with.restitution.unwrap() > without.restitution.unwrap() + 0.05, "{with:?}");
    let parts = with.uncertainty;
    assert!(parts.solver.is_some() && parts.modes_left_out.is_some() && parts.beam_theory.is_some(), "{parts:?}");
    // half as many modes more, and as many theories, give what is stated
    let mut other = beam(9.81);
    (other["structure"]["theory"], other["modes"], other["residual_compliance"]) =
        (json!("euler-bernoulli"), json!(60), json!(true));
    let other = solved(&other).restitution.unwrap();
    let stated = with.restitution_uncertainty.unwrap();
    assert!((other - with.restitution.unwrap()).abs() <= 1.05 * stated, "{other} {with:?}");
    // energy, with that of the height
    let energy = &with.energy;
    assert!((energy.striker_j / energy.initial_j - with.restitution.unwrap().powi(2)).abs() < 1e-9, "{energy:?}");
    assert!(energy.residual_j.abs() < 1e-9 * energy.initial_j, "{energy:?}");
}

/// Dropped from a height, thrown down, or thrown up: what counts is the speed with which it arrives, also for a contact law that follows
/// from a restitution. The program chooses theory and modes for each.
#[test]
fn a_height_of_the_fall_is_worth_its_speed() {
    let scene = |contact: &Value, speed_m_s: f64, gap_m: f64| {
        json!({
            "structure": { "kind": "beam", "ends": ["clamped", "free"], "damping_ratio": 0.02,
                           "segments": [{ "length_m": 0.4, "width_m": 0.02, "thickness_m": 0.01, "material": "steel" }] },
            "striker": { "material": "steel", "radius_m": 0.015, "speed_m_s": speed_m_s },
            "contact": contact, "location_m": 0.31, "gravity_m_s2": GRAVITY_M_S2, "start": { "gap_m": gap_m }
        })
    };
    let viscous = json!({ "law": "viscous", "material": "steel", "restitution": 0.7 });
    for contact in [json!({ "law": "hertz", "material": "steel" }), viscous] {
        let height_m = |speed_m_s: f64| (0.8f64.powi(2) - speed_m_s * speed_m_s) / (2.0 * GRAVITY_M_S2);
        let known = solved(&scene(&contact, 0.8, 0.0));
        for speed_m_s in [0.0, 0.5, -0.3] {
            let found = solved(&scene(&contact, speed_m_s, height_m(speed_m_s)));
            assert_eq!(found.sub_impact_count, known.sub_impact_count, "{found:?}");
            let error = (found.restitution.unwrap() - known.restitution.unwrap()).abs();
            let solver = found.uncertainty.solver.unwrap() + known.uncertainty.solver.unwrap();
            assert!(error <= solver && solver < 1e-3, "{error} {found:?}");
            let falls_s = (0.8 - speed_m_s) / GRAVITY_M_S2;
            let begins_s = found.sub_impacts[0].start_s;
            assert!((begins_s - falls_s).abs() < 1e-9, "{begins_s} {falls_s}");
        }
    }
    let hertz = json!({ "law": "hertz", "material": "steel" });
    for (speed_m_s, says) in [(0.0, "dropped from 50.00 mm on a"), (0.5, "falling at 500.0 mm/s from 50.00 mm on a")] {
        let scene = Scene::from_value(&scene(&hertz, speed_m_s, 0.05)).unwrap();
        let headline = text::headline(&scene, &Striker { mass_kg: 0.1, speed_m_s });
        assert!(headline.contains(says), "{headline}");
    }
    // a structure that moves has the modes that are stated
    let mut moving = scene(&hertz, 0.5, 0.01);
    moving["start"]["moving_modes"] = json!([{ "mode": 1, "velocity_m_s": 0.1 }]);
    let fault = Scene::from_value(&moving).unwrap().simulate().unwrap_err();
    assert_eq!(fault.field.to_string(), "modes", "{fault}");
}

/// A beam touches a heavy ball again two microseconds before the ball turns round. With fewer than six modes it does so after that time,
/// and the restitution is four times as large. That four and five modes agree then says nothing.
#[test]
fn a_touch_close_to_the_highest_point_is_not_left_to_chance() {
    let mut scene = json!({
        "structure": { "kind": "beam", "ends": ["guided", "pinned"], "damping_ratio": 0.0011976064224963434, "theory": "timoshenko",
                       "segments": [{ "length_m": 1.3212230508014635, "width_m": 0.10389291716784262,
                                      "thickness_m": 0.043345281745092376, "material": "steel" }] },
        "striker": { "material": "steel", "radius_m": 0.5649069342092855, "speed_m_s": 0.05652379250645728 },
        "contact": { "law": "hertz", "material": "steel" }, "location_m": 1.0843547020235835, "gravity_m_s2": 9.81
    });
    let found = solved(&scene);
    (scene["modes"], scene["residual_compliance"], scene["tolerance"]) = (json!(5), json!(true), json!(1e-9));
    let few = solved(&scene).restitution.unwrap();
    scene["modes"] = json!(60);
    let many = solved(&scene).restitution.unwrap();
    let error = (found.restitution.unwrap() - many).abs();
    assert!(
        few - many > 0.5 && error <= found.uncertainty.modes_left_out.unwrap() && error < 1e-3,
        "{few} {many} {found:?}"
    );
}

/// A slow ball that stays on the beam stays with every number of modes, however much its small flights differ.
#[test]
fn it_is_known_that_a_striker_stays() {
    let found = solved(&json!({
        "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.2,
                       "segments": [{ "length_m": 1, "width_m": 0.03, "thickness_m": 0.02, "material": "steel" }] },
        "striker": { "material": "steel", "radius_m": 0.06, "speed_m_s": 0.002 },
        "contact": { "law": "hertz", "material": "steel" }, "location_m": 0.4, "gravity_m_s2": 9.81
    }));
    assert_eq!((found.outcome, found.restitution), ("sustained", Some(0.0)));
    assert!(found.restitution_uncertainty.unwrap() < 2e-3 && found.modes < 20, "{found:?}");
}

/// Without gravity a bar of 0.3 m across would be a rigid wall.
#[test]
fn models_that_leave_gravity_out_are_neither_chosen_nor_planned() {
    let mut scene = json!({
        "structure": { "kind": "beam", "ends": ["clamped", "clamped"], "damping_ratio": 0.01,
                       "segments": [{ "length_m": 1, "width_m": 0.3, "thickness_m": 0.3, "youngs_modulus_pa": 2.1e11, "density_kg_m3": 7850 }] },
        "striker": { "density_kg_m3": 7850, "radius_m": 0.005, "speed_m_s": 0.1 },
        "contact": { "law": "hertz", "youngs_modulus_pa": 2.1e11, "poissons_ratio": 0.3 }, "location_m": 0.05, "tolerance": 0.05
    });
    for (gravity_m_s2, expected) in [(0.0, Model::Rigid), (9.81, Model::Modal)] {
        scene["gravity_m_s2"] = json!(gravity_m_s2);
        let scene = Scene::from_value(&scene).unwrap();
        let (answer, plan) = (scene.answer().unwrap(), scene.plan().unwrap());
        assert_eq!((answer.model, plan.model), (expected, expected), "{answer:?}");
    }
}

/// A ball that is dropped, by differences of impacts.
#[test]
fn the_rebound_of_a_fall_has_derivatives() {
    let mut scene = scene(6, 0.01);
    scene["striker"]["speed_m_s"] = json!(0);
    scene["start"] = json!({ "gap_m": 0.05 });
    scene["tolerance"] = json!(1e-11);
    let fields = ["gravity_m_s2", "start.gap_m", "striker.mass_kg", "contact.stiffness_n_m1_5"];
    let found = Scene::from_value(&scene).unwrap().sensitivity(&fields.map(str::to_owned)).unwrap();
    for field in fields {
        let pointer = format!("/{}", field.replace('.', "/"));
        let value = scene.pointer(&pointer).unwrap().as_f64().unwrap();
        let near = |part: f64| {
            let mut scene = scene.clone();
            *scene.pointer_mut(&pointer).unwrap() = json!(value * (1.0 + part));
            solved(&scene).restitution.unwrap()
        };
        let slope = (8.0 * (near(1e-5) - near(-1e-5)) - (near(2e-5) - near(-2e-5))) / 12e-5;
        let by = found.of("restitution", field).unwrap();
        let error = (by.value * value - slope).abs();
        assert!(slope.abs() > 1e-3 && error < 1e-5 * slope.abs(), "{field}: {by:?} {slope}");
        assert!(by.uncertainty.unwrap() < 1e-5 * by.value.abs(), "{field}: {by:?}");
    }
}

#[test]
fn gravity_is_refused_where_it_has_no_meaning() {
    let refused = |scene: &Value| {
        let fault = Scene::from_value(scene).unwrap().simulate().unwrap_err();
        assert_eq!(fault.field.to_string(), "gravity_m_s2", "{fault}");
        fault.to_string()
    };
    let with = |pointer: &str, value: Value| {
        let mut scene = scene(3, 0.01);
        *scene.pointer_mut(pointer).unwrap() = value;
        scene
    };
    assert!(refused(&with("/gravity_m_s2", json!(-9.81))).contains("not less than 0"));
    assert!(refused(&with("/structure/omega_rad_s/0", json!(0))).contains("not held"));
    assert!(refused(&with("/striker/speed_m_s", json!(0))).contains("touches"));
    let plate = json!({ "kind": "infinite-plate", "material": "glass", "thickness_m": 0.01 });
    assert!(refused(&with("/structure", plate)).contains("infinite"));
    let mut rigid = scene(3, 0.01);
    rigid["model"] = json!("emoc");
    let fault = Scene::from_value(&rigid).unwrap().simulate().unwrap_err();
    assert!(fault.field == "model" && fault.to_string().contains("gravity_m_s2"), "{fault}");
    let scene = Scene::from_value(&scene(3, 0.01)).unwrap();
    assert_eq!(scene.emoc(&Default::default(), None).unwrap_err().field.to_string(), "gravity_m_s2");
}
