//! Scenes of bodies: a scene that is written is read back unchanged, the solver's problem agrees with the definitions, and
//! every field that cannot be used is rejected with its path.

use std::f64::consts::TAU;
use std::fs;

use crate::gallery::assemblies;
use serde_json::{Value, json};
use vibroimpact::assembly::{AnyScene, AssemblyScene};
use vibroimpact::vibroimpact_sim::assembly::{Force, Point};

/// A scene with every kind of part.
fn scene() -> Value {
    json!({
        "bodies": {
            "ball": { "kind": "mass", "mass_kg": 0.25, "position_m": 0.001, "velocity_m_s": -1 },
            "beam": { "kind": "beam", "ends": ["clamped", "free"], "damping_ratio": 0.02, "modes": 4,
                      "segments": [{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }] },
            "rod": { "kind": "rod", "ends": ["free", "free"], "modes": 3, "velocity_m_s": 2,
                     "segments": [{ "length_m": 0.5, "axial_rigidity_n": 8e7, "mass_per_length_kg_m": 4 }] },
            "rig": { "kind": "modal", "omega_rad_s": [0, 100], "points": { "tip": { "shape": [0.5, -1] } },
                     "gravity_participation_kg0_5": [2, 0.3] }
        },
        "contacts": [
            { "name": "c1", "between": [{ "body": "ball" }, { "body": "beam", "location_m": 0.4 }],
              "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3, "radius_m": 0.015 },
            { "name": "stop", "between": [{ "body": "rig", "location": "tip" }, "ground"], "gap_m": 1e-4,
              "two_sided": true, "law": "kelvin-voigt", "stiffness_n_m": 1e6, "restitution": 0.5, "reduced_mass_kg": 2 },
            { "name": "c2", "between": ["ground", { "body": "rod", "location_m": 0.5 }], "gap_m": -1e-6,
              "law": "hunt-crossley", "stiffness_n_m1_5": 1e9, "restitution": 0.8, "approach_speed_m_s": 1 }
        ],
        "gravity_m_s2": 9.81,
        "loads": [
            { "body": "beam", "location_m": 0.5, "force_n": 10, "frequency_hz": 40, "phase_deg": 90 },
            { "body": "ball", "force_n": 3 },
            { "body": "rig", "location": "tip", "times_s": [0, 0.1, 0.1], "forces_n": [0, 5, 0] }
        ],
        "ground_motion": { "displacement_m": 0.01, "frequency_hz": 5 },
        "end_s": 0.5
    })
}

fn pose(scene: &Value) -> Result<vibroimpact::assembly::Posed, vibroimpact::InvalidInput> {
    AssemblyScene::from_value(scene)?.pose()
}

#[test]
fn written_scenes_are_read_back_unchanged() {
    let mut scenes = vec![AssemblyScene::from_value(&scene()).unwrap()];
    scenes.extend(assemblies().into_iter().map(|(_, scene)| scene));
    for scene in scenes {
        assert_eq!(AssemblyScene::from_json(&scene.to_json()).unwrap(), scene);
        assert_eq!(AssemblyScene::from_toml(&scene.to_toml().unwrap()).unwrap(), scene);
        assert!(scene.pose().is_ok());
    }
}

#[test]
fn bodies_may_list_their_modes_in_any_order() {
    let start = |first: [f64; 2]| json!({ "amplitude_m_kg0_5": first, "moving_modes": [{ "mode": 2, "location": "tip", "velocity_m_s": 1 }] });
    let mut one = scene();
    one["bodies"]["rig"]["start"] = start([0.0, 1e-3]);
    let mut other = one.clone();
    let rig = &mut other["bodies"]["rig"];
    rig["omega_rad_s"] = json!([100, 0]);
    rig["points"]["tip"]["shape"] = json!([-1, 0.5]);
    rig["gravity_participation_kg0_5"] = json!([0.3, 2]);
    rig["start"] = start([1e-3, 0.0]);
    assert_eq!(pose(&one).unwrap(), pose(&other).unwrap());
}

#[test]
fn the_problem_of_the_solver_agrees_with_the_definitions() {
    let posed = pose(&scene()).unwrap();
    assert_eq!(posed.bodies, ["ball", "beam", "rig", "rod"]);
    assert_eq!(posed.contacts, ["c1", "stop+", "stop-", "c2"]);
    let assembly = &posed.assembly;
    // Position and velocity are displacements of the mass: u = a / sqrt(m).
    let ball = &assembly.bodies[0];
    assert!((ball.amplitude[0] / 0.5f64.recip() - 0.001 * 0.25).abs() < 1e-18 && ball.rate[0] == -0.5);
    // A free rod of 2 kg at 2 m/s has the energy m v^2 / 2 in its rigid mode alone.
    let rod = &assembly.bodies[3];
    assert!((rod.rate[0].powi(2) - 8.0).abs() < 1e-12 && rod.rate[1..].iter().all(|rate| *rate == 0.0));
    // A is first; the mirror contact of a two-sided one has its sides exchanged.
    let body = |point: &Point| match point {
        Point::Ground => None,
        Point::OfBody { body, shape } => Some((*body, shape.clone())),
    };
    let sides = |c: usize| [body(&assembly.contacts[c].sides[0]), body(&assembly.contacts[c].sides[1])];
    assert_eq!(sides(0)[0], Some((0, vec![2.0])));
    assert_eq!(sides(0)[1].as_ref().unwrap().1.len(), 4);
    assert_eq!(sides(1), [Some((2, vec![0.5, -1.0])), None]);
    assert_eq!(sides(2), [None, Some((2, vec![0.5, -1.0]))]);
    assert_eq!(sides(3)[0], None);
    assert_eq!([0, 1, 2, 3].map(|c| assembly.contacts[c].gap_m), [0.0, 1e-4, 1e-4, -1e-6]);
    // Loads as stated, then gravity and the inertial load of the ground on every body.
    let loads = &assembly.loads;
    assert_eq!(loads.len(), 3 + 4 + 4);
    let quarter = std::f64::consts::FRAC_PI_2;
    assert_eq!(loads[0].force, Force::Harmonic { force_n: 10.0, omega_rad_s: TAU * 40.0, phase_rad: quarter });
    assert_eq!((&loads[1].force, loads[1].body), (&Force::Constant { force_n: 3.0 }, 0));
    assert_eq!(loads[2].force, Force::Sampled { times_s: vec![0.0, 0.1, 0.1], forces_n: vec![0.0, 5.0, 0.0] });
    assert_eq!((&loads[3].shape, &loads[3].force), (&vec![0.5], &Force::Constant { force_n: -9.81 }));
    assert_eq!(loads[5].shape, [2.0, 0.3]);
    // y = A sin(w t) of the ground: the inertial load is m A w^2 sin(w t).
    let Force::Harmonic { force_n, .. } = loads[7].force else { panic!("{:?}", loads[7]) };
    assert!((force_n / (0.01 * (TAU * 5.0f64).powi(2)) - 1.0).abs() < 1e-14);
}

#[test]
fn a_static_start_is_the_deflection_under_the_constant_loads() {
    let mut scene = scene();
    scene["static_start"] = json!(true);
    scene.as_object_mut().unwrap().remove("ground_motion");
    let posed = pose(&scene).unwrap();
    let beam = &posed.assembly.bodies[1];
    // The static deflection at the tip of a cantilever is m g L^4 / (8 EI); four modes give it within 1e-4.
    let shapes = [2.0, -2.0, 2.0, -2.0];
    let sag: f64 = beam.amplitude.iter().zip(shapes).map(|(a, phi)| a * phi).sum();
    assert!((sag / (-9.81 / (8.0 * 274.0)) - 1.0).abs() < 1e-4, "{sag}");
    // Rigid-body motions are as stated, and so are masses.
    assert_eq!(posed.assembly.bodies[0], pose(&self::scene()).unwrap().assembly.bodies[0]);
    assert_eq!(posed.assembly.bodies[2].amplitude[0], 0.0);
}

#[test]
fn motion_of_single_modes_is_stated_where_it_is_visible() {
    let mut scene = scene();
    scene["bodies"]["rig"]["start"] = json!({ "amplitude_m_kg0_5": [0.1],
        "moving_modes": [{ "mode": 2, "location": "tip", "displacement_m": 0.001, "velocity_m_s": 3 }] });
    scene["bodies"]["beam"]["start"] = json!({ "moving_modes": [{ "mode": 1, "location_m": 1, "velocity_m_s": 4 }] });
    let posed = pose(&scene).unwrap();
    assert_eq!(posed.assembly.bodies[2].amplitude, [0.1, -0.001]);
    assert_eq!(posed.assembly.bodies[2].rate, [0.0, -3.0]);
    assert!((posed.assembly.bodies[1].rate[0] - 2.0).abs() < 1e-9);
}

#[test]
fn tables_are_read_from_the_folder_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("modes.csv", "tip,omega_rad_s\n0.5,0\n-1,100\n");
    write("push.csv", "force_n,time_s\n0,0\n5,0.1\n");
    write("quake.csv", "time_s,acceleration_m_s2\n0,0\n0.5,1\n1,0\n");
    let mut scene = scene();
    scene["bodies"]["rig"] =
        json!({ "kind": "modes-file", "file": "modes.csv", "gravity_participation_kg0_5": [2, 0] });
    scene["loads"] = json!([{ "body": "ball", "file": "push.csv" }]);
    scene["ground_motion"] = json!({ "file": "quake.csv" });
    write("scene.json", &scene.to_string());
    let AnyScene::Bodies(read) = AnyScene::read(&folder.path().join("scene.json")).unwrap() else { panic!() };
    let posed = read.pose().unwrap();
    assert_eq!(posed.assembly.loads[0].force, Force::Sampled { times_s: vec![0.0, 0.1], forces_n: vec![0.0, 5.0] });
    // The inertial load is opposite to the ground's acceleration.
    let quake = &posed.assembly.loads.last().unwrap().force;
    assert_eq!(*quake, Force::Sampled { times_s: vec![0.0, 0.5, 1.0], forces_n: vec![-0.0, -1.0, -0.0] });

    for (place, value, expected) in [
        ("/loads/0/file", json!("../push.csv"), "loads[0].file = \"../push.csv\" is not allowed"),
        ("/loads/0/file", json!("modes.csv"), "modes.csv, column time_s is missing"),
        ("/ground_motion/file", json!("/etc/passwd"), "ground_motion.file = \"/etc/passwd\""),
        ("/bodies/rig/file", json!("../modes.csv"), "bodies.rig.file = \"../modes.csv\""),
        ("/bodies/rig/file", json!("push.csv"), "push.csv, column omega_rad_s is missing"),
    ] {
        let mut spoilt = scene.clone();
        *spoilt.pointer_mut(place).unwrap() = value;
        write("scene.json", &spoilt.to_string());
        let message = AnyScene::read(&folder.path().join("scene.json")).unwrap_err().to_string();
        assert!(message.starts_with(expected), "{message}");
    }
}

#[test]
fn every_field_that_cannot_be_used_is_named_by_its_path() {
    let round = |modulus: f64, density: f64| json!({ "length_m": 0.25, "youngs_modulus_pa": modulus, "density_kg_m3": density, "diameter_m": 0.01 });
    // For each pointer and value, the path that is rejected.
    let cases = [
        ("/bodies", json!({}), "bodies"),
        ("/bodies", json!([]), "bodies"),
        ("/bodies/ground", json!({ "kind": "mass", "mass_kg": 1 }), "bodies"),
        ("/bodies/ball", json!(1), "bodies.ball"),
        ("/bodies/ball/kind", json!("balloon"), "bodies.ball.kind"),
        ("/bodies/ball/kind", json!(7), "bodies.ball.kind"),
        ("/bodies/ball/mass_kg", json!(0), "bodies.ball.mass_kg"),
        ("/bodies/ball/mass_kg", json!(-1), "bodies.ball.mass_kg"),
        ("/bodies/ball/mass_kg", json!("heavy"), "bodies.ball.mass_kg"),
        ("/bodies/ball/mass_kg", json!(1e40), "bodies.ball.mass_kg"),
        ("/bodies/ball/mass_kg", json!(1e-308), "bodies.ball.mass_kg"),
        ("/bodies/ball/velocity_m_s", json!(1e31), "bodies.ball.velocity_m_s"),
        ("/bodies/ball/position_m", json!(1e31), "bodies.ball.position_m"),
        ("/bodies/ball/velocity_m_s", json!(-1e31), "bodies.ball.velocity_m_s"),
        ("/bodies/ball/speed_m_s", json!(1), "bodies.ball.speed_m_s"),
        ("/bodies/beam/kind", json!("infinite-beam"), "bodies.beam.kind"),
        ("/bodies/beam/kind", json!("dropped-rod"), "bodies.beam.kind"),
        ("/bodies/beam/gravity_participation_kg0_5", json!([1]), "bodies.beam.gravity_participation_kg0_5"),
        ("/bodies/beam/modes", json!(-1), "bodies.beam.modes"),
        ("/bodies/beam/modes", json!(null), "bodies.beam.modes"),
        ("/bodies/beam/modes", json!(10_001), "bodies.beam.modes"),
        ("/bodies/beam/modes", json!("auto"), "bodies.beam.modes"),
        ("/bodies/beam/residual_compliance", json!("yes"), "bodies.beam.residual_compliance"),
        ("/bodies/rod/residual_compliance", json!(true), "bodies.rod.residual_compliance"),
        ("/bodies/rig/residual_compliance", json!(true), "bodies.rig.residual_compliance"),
        ("/bodies/beam/velocity_m_s", json!(1), "bodies.beam.velocity_m_s"),
        ("/bodies/beam/damping_ratio", json!(-0.1), "bodies.beam.damping_ratio"),
        ("/bodies/beam/colour", json!("red"), "bodies.beam.colour"),
        ("/bodies/beam/ends/0", json!("welded"), "bodies.beam.ends[0]"),
        ("/bodies/beam/segments/0/length_m", json!(-1), "bodies.beam.segments[0].length_m"),
        ("/bodies/beam/gravity_participation_kg0_5", json!([1]), "bodies.beam.gravity_participation_kg0_5"),
        ("/bodies/beam/start", json!({ "gap_m": 1 }), "bodies.beam.start.gap_m"),
        ("/bodies/beam/start", json!({ "amplitude_m_kg0_5": [1, 2, 3, 4, 5] }), "bodies.beam.start.amplitude_m_kg0_5"),
        ("/bodies/beam/start", json!({ "rate_m_kg0_5_s": [1e31] }), "bodies.beam.start.rate_m_kg0_5_s[0]"),
        (
            "/bodies/beam/start",
            json!({ "moving_modes": [{ "mode": 1 }] }),
            "bodies.beam.start.moving_modes[0].location_m",
        ),
        (
            "/bodies/beam/start",
            json!({ "moving_modes": [{ "mode": 9, "location_m": 1 }] }),
            "bodies.beam.start.moving_modes[0].mode",
        ),
        ("/bodies/rod/ends/1", json!("pinned"), "bodies.rod.ends[1]"),
        ("/bodies/rod/modes", json!(null), "bodies.rod.modes"),
        ("/bodies/rod/damping_ratio", json!(-1), "bodies.rod.damping_ratio"),
        ("/bodies/rod/segments/0/area_m2", json!(1), "bodies.rod.segments[0].area_m2"),
        ("/bodies/rod/segments/0/axial_rigidity_n", json!(0), "bodies.rod.segments[0].axial_rigidity_n"),
        // a product that is zero or too different is reported as the field from which it follows
        ("/bodies/rod/segments", json!([round(5e-324, 7800.0)]), "bodies.rod.segments[0].youngs_modulus_pa"),
        ("/bodies/rod/segments", json!([round(2e11, 5e-324)]), "bodies.rod.segments[0].density_kg_m3"),
        (
            "/bodies/rod/segments",
            json!([round(2e11, 7800.0), round(2e-2, 7800.0)]),
            "bodies.rod.segments[1].youngs_modulus_pa",
        ),
        ("/bodies/rig/omega_rad_s/1", json!(-1), "bodies.rig.omega_rad_s[1]"),
        ("/bodies/rig/points/tip/shape", json!([1]), "bodies.rig.points.tip.shape"),
        ("/bodies/rig/modes", json!(3), "bodies.rig.modes"),
        ("/bodies/rig/gravity_participation_kg0_5", json!([1]), "bodies.rig.gravity_participation_kg0_5"),
        ("/bodies/rig/gravity_participation_kg0_5", json!([]), "bodies.rig.gravity_participation_kg0_5"),
        ("/bodies/rig/gravity_participation_kg0_5", json!([1, 2, 3]), "bodies.rig.gravity_participation_kg0_5"),
        ("/contacts/0/between", json!([{ "body": "ball" }, { "body": "ball" }]), "contacts[0].between[1].body"),
        ("/bodies/rig/gravity_participation_kg0_5", json!([1, 1e31]), "bodies.rig.gravity_participation_kg0_5[1]"),
        ("/contacts", json!({}), "contacts"),
        ("/contacts/0", json!(3), "contacts[0]"),
        ("/contacts/0/name", json!(""), "contacts[0].name"),
        ("/contacts/0/name", json!("stop-"), "contacts[1].name"),
        ("/contacts/2/name", json!("c1"), "contacts[2].name"),
        ("/contacts/0/name", json!(null), "contacts[0].name"),
        ("/contacts/0/between", json!([{ "body": "ball" }]), "contacts[0].between"),
        ("/contacts/0/between", json!("ball"), "contacts[0].between"),
        ("/contacts/0/between/0", json!("floor"), "contacts[0].between[0]"),
        ("/contacts/0/between/0", json!({}), "contacts[0].between[0].body"),
        ("/contacts/0/between/0/body", json!("bal"), "contacts[0].between[0].body"),
        ("/contacts/0/between/0/location_m", json!(0), "contacts[0].between[0].location_m"),
        ("/contacts/0/between/1/location_m", json!(1.5), "contacts[0].between[1].location_m"),
        ("/contacts/0/between/1/location_m", json!(null), "contacts[0].between[1].location_m"),
        ("/contacts/0/between/1/location", json!("tip"), "contacts[0].between[1].location"),
        ("/contacts/0/between/1/side", json!(1), "contacts[0].between[1].side"),
        ("/contacts/1/between/0/location", json!("top"), "contacts[1].between[0].location"),
        ("/contacts/1/between/0/location", json!(null), "contacts[1].between[0].location"),
        ("/contacts/1/between/0", json!("ground"), "contacts[1].between[1]"),
        ("/contacts/2/between/1/location_m", json!(0.6), "contacts[2].between[1].location_m"),
        ("/contacts/0/gap_m", json!("wide"), "contacts[0].gap_m"),
        ("/contacts/0/gap_m", json!(1e31), "contacts[0].gap_m"),
        ("/contacts/0/two_sided", json!(1), "contacts[0].two_sided"),
        ("/contacts/0/law", json!("herz"), "contacts[0].law"),
        ("/contacts/0/colour", json!(1), "contacts[0].colour"),
        ("/contacts/0/radius_m", json!(null), "contacts[0].radius_m"),
        ("/contacts/0/radius_m", json!(-1), "contacts[0].radius_m"),
        ("/contacts/0/poissons_ratio", json!(0.7), "contacts[0].poissons_ratio"),
        ("/contacts/0/poissons_ratio", json!(null), "contacts[0].poissons_ratio"),
        ("/contacts/1/reduced_mass_kg", json!(null), "contacts[1].reduced_mass_kg"),
        ("/contacts/1/restitution", json!(1.5), "contacts[1].restitution"),
        ("/contacts/1/stiffness_n_m", json!(0), "contacts[1].stiffness_n_m"),
        ("/contacts/2/approach_speed_m_s", json!(null), "contacts[2].approach_speed_m_s"),
        ("/contacts/2/approach_speed_m_s", json!(0), "contacts[2].approach_speed_m_s"),
        ("/gravity_m_s2", json!(-9.81), "gravity_m_s2"),
        ("/gravity_m_s2", json!("down"), "gravity_m_s2"),
        ("/loads", json!({}), "loads"),
        ("/loads/0/body", json!("bridge"), "loads[0].body"),
        ("/loads/0/location_m", json!(-0.1), "loads[0].location_m"),
        ("/loads/1/location_m", json!(0), "loads[1].location_m"),
        ("/loads/0/force_n", json!(null), "loads[0].force_n"),
        ("/loads/0/force_n", json!(1e31), "loads[0].force_n"),
        ("/loads/0/frequency_hz", json!(0), "loads[0].frequency_hz"),
        ("/loads/1/frequency_hz", json!(1e-5), "loads[1].frequency_hz"),
        ("/loads/0/frequency_hz", json!(null), "loads[0].phase_deg"),
        ("/loads/0/phase_deg", json!("late"), "loads[0].phase_deg"),
        ("/loads/0/times_s", json!([0, 1]), "loads[0].force_n"),
        ("/loads/2/times_s", json!([0, 0.1]), "loads[2].forces_n"),
        ("/loads/2/times_s", json!([0]), "loads[2].times_s"),
        ("/loads/2/times_s", json!([0, 0.2, 0.1]), "loads[2].times_s[2]"),
        ("/loads/2/forces_n/1", json!(1e31), "loads[2].forces_n[1]"),
        ("/loads/2/file", json!("x.csv"), "loads[2].file"),
        ("/loads/2/mass_kg", json!(1), "loads[2].mass_kg"),
        ("/ground_motion", json!(3), "ground_motion"),
        ("/ground_motion", json!({}), "ground_motion.acceleration_m_s2"),
        ("/ground_motion/frequency_hz", json!(null), "ground_motion.frequency_hz"),
        ("/ground_motion/frequency_hz", json!(-5), "ground_motion.frequency_hz"),
        ("/ground_motion/displacement_m", json!(1e7), "ground_motion.frequency_hz"),
        ("/ground_motion/acceleration_m_s2", json!(1), "ground_motion.acceleration_m_s2"),
        ("/ground_motion/velocity_m_s", json!(1), "ground_motion.velocity_m_s"),
        ("/ground_motion/times_s", json!([0, 1]), "ground_motion.displacement_m"),
        ("/static_start", json!(1), "static_start"),
        ("/end_s", json!(null), "end_s"),
        ("/end_s", json!(0), "end_s"),
        ("/end_s", json!(-1), "end_s"),
        ("/end_s", json!(1e13), "end_s"),
        ("/statistics_from_s", json!("late"), "statistics_from_s"),
        ("/statistics_from_s", json!(-1), "statistics_from_s"),
        ("/statistics_from_s", json!(0.5), "statistics_from_s"),
        ("/tolerance", json!(0), "tolerance"),
        ("/tolerance", json!(0.5), "tolerance"),
        ("/version", json!(2), "version"),
        ("/description", json!(1), "description"),
        ("/structure", json!({}), "structure"),
    ];
    // With remainder modes, the error for a location outside the beam still names the contact.
    let mut off = scene();
    off["bodies"]["beam"]["residual_compliance"] = json!(true);
    off["contacts"][0]["between"][1]["location_m"] = json!(1.5);
    assert_eq!(pose(&off).unwrap_err().field, "contacts[0].between[1].location_m");
    for (place, value, expected) in cases {
        let mut spoilt = scene();
        let (holder, key) = place.rsplit_once('/').unwrap();
        match spoilt.pointer_mut(holder).unwrap() {
            Value::Array(items) => items[key.parse::<usize>().unwrap()] = value.clone(),
            Value::Object(entries) if value.is_null() => drop(entries.remove(key)),
            Value::Object(entries) => drop(entries.insert(key.to_owned(), value.clone())),
            other => panic!("{other}"),
        }
        let fault = pose(&spoilt).expect_err(&format!("{place} = {value}"));
        assert_eq!(fault.field, expected, "{place} = {value}: {fault}");
        assert!(!fault.allowed.is_empty() && !fault.allowed.contains("\"auto\""), "{fault}");
    }
}

/// Fields whose allowed values differ from those of a field of the same name, or of the whole scene.
#[test]
fn the_allowed_values_are_those_of_the_very_field() {
    for (place, value, field, allowed) in [
        ("/bodies/rod/ends/1", json!("pinned"), "bodies.rod.ends[1]", "one of fixed, free"),
        ("/bodies/rod/ends/1", json!("fixd"), "bodies.rod.ends[1]", "one of fixed, free; did you mean fixed?"),
        (
            "/bodies/rod/ends",
            json!(1),
            "bodies.rod.ends",
            "a list of two, the left and the right end, each one of fixed, free",
        ),
        ("/bodies/rod/damping_ratio", json!(2e6), "bodies.rod.damping_ratio", "a number from 0 to 1e6"),
        (
            "/bodies/beam/start",
            json!(1),
            "bodies.beam.start",
            "an object with gap_m, moving_modes, amplitude_m_kg0_5, rate_m_kg0_5_s, any of which may be left out",
        ),
        (
            "/ground_motion",
            json!(1),
            "ground_motion",
            "an object with displacement_m or acceleration_m_s2 and frequency_hz, or a measured acceleration",
        ),
    ] {
        let mut spoilt = scene();
        spoilt["bodies"]["beam"]["start"] = json!({});
        spoilt["bodies"]["rod"]["damping_ratio"] = json!(0);
        *spoilt.pointer_mut(place).unwrap() = value;
        let fault = pose(&spoilt).unwrap_err();
        assert_eq!((fault.field.to_string().as_str(), fault.allowed.as_ref()), (field, allowed), "{fault}");
    }
}

#[test]
fn a_load_at_an_undamped_frequency_is_refused_with_the_reason() {
    let mut scene = scene();
    scene["loads"][2] = json!({ "body": "rig", "location": "tip", "force_n": 1, "frequency_hz": 100.0 / TAU });
    let fault = pose(&scene).unwrap_err();
    assert_eq!(fault.field, "loads[2].frequency_hz");
    assert!(fault.allowed.contains("undamped mode"), "{fault}");
    let shown: f64 = fault.value.unwrap().to_string().parse().unwrap();
    assert!((shown - 100.0 / TAU).abs() < 1e-9);
    // At a node of that mode, or with damping, the load is accepted.
    scene["bodies"]["rig"]["damping_ratios"] = json!([0, 0.01]);
    assert!(pose(&scene).is_ok());
}
