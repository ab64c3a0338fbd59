//! Random scenes: every structure with modes, every law, locations near supports and tips, and masses and speeds over several
//! orders of magnitude.

use serde_json::{Value, json};
use std::f64::consts::PI;
use tasks::{Failure, Random};
use vibroimpact::Scene;
use vibroimpact::model::Modes;

/// Steel, for structures and balls alike.
const MODULUS: f64 = 2e11;
const DENSITY: f64 = 7800.0;
const POISSON: f64 = 0.3;
/// Shares of undamped scenes and of beams with a step.
const UNDAMPED: f64 = 0.15;
const STEPPED: f64 = 0.3;
/// Share of scenes with a ball so light that a simpler model may be sufficient.
const LIGHT: f64 = 0.1;
/// Number of modes that a scene states if its structure moves before the impact.
const STATED: [f64; 2] = [20.0, 60.0];

/// Largest number of modes of a reference; smaller for a plate whose modes need large matrices.
const MOST_MODES: usize = 8000;
const RITZ: usize = 300;

/// The random numbers of a scene or a beam.
pub(super) fn random(number: u64) -> Random {
    Random::new(number.wrapping_mul(0x2545_F491_4F6C_DD1D))
}

/// A structure: its JSON, its length and its mass.
type Struck = (Value, f64, f64);

/// A beam of one or two segments.
pub(super) fn beam(random: &mut Random, ends: [&str; 2], damping_ratio: f64) -> Struck {
    let length = random.log(0.2, 3.0);
    let side = length * random.log(0.004, 0.04);
    let segment = |length: f64, thickness: f64| {
        json!({ "length_m": length, "youngs_modulus_pa": MODULUS, "density_kg_m3": DENSITY,
                "width_m": side, "thickness_m": thickness })
    };
    let (segments, mass) = if random.share() < STEPPED {
        let (cut, thinner) = (0.3 + 0.4 * random.share(), 0.4 + 0.6 * random.share());
        let mass = DENSITY * length * side * side * (cut + (1.0 - cut) * thinner);
        (vec![segment(cut * length, side), segment((1.0 - cut) * length, thinner * side)], mass)
    } else {
        (vec![segment(length, side)], DENSITY * length * side * side)
    };
    let beam = json!({ "kind": "beam", "ends": ends, "damping_ratio": damping_ratio, "segments": segments });
    (beam, length, mass)
}

/// The same beam with shear and rotary inertia.
fn with_shear((mut beam, length, mass): Struck) -> Struck {
    beam["theory"] = json!("timoshenko");
    for segment in beam["segments"].as_array_mut().into_iter().flatten() {
        segment["poissons_ratio"] = json!(POISSON);
    }
    (beam, length, mass)
}

fn string(random: &mut Random, damping_ratio: f64) -> Struck {
    let (length, mass_per_length) = (random.log(0.2, 2.0), random.log(1e-3, 0.1));
    let tension = random.log(20.0, 1000.0);
    let rigidity = if random.share() < 0.5 { 0.0 } else { tension * length * length * random.log(1e-6, 1e-3) };
    let string = json!({ "kind": "string", "length_m": length, "tension_n": tension, "damping_ratio": damping_ratio,
                         "mass_per_length_kg_m": mass_per_length, "flexural_rigidity_n_m2": rigidity });
    (string, length, length * mass_per_length)
}

/// A plate with a given length; the location is on its diagonal.
fn plate(random: &mut Random, damping_ratio: f64) -> Struck {
    let (length, width) = (random.log(0.1, 1.0), 0.5 + 0.5 * random.share());
    let thickness = length * random.log(0.005, 0.05);
    let edges = if random.share() < 0.8 { ["pinned"; 4] } else { ["clamped", "free", "free", "free"] };
    let plate = json!({ "kind": "plate", "length_m": length, "width_m": width * length, "thickness_m": thickness,
        "youngs_modulus_pa": MODULUS, "poissons_ratio": POISSON, "density_kg_m3": DENSITY, "edges": edges,
        "damping_ratio": damping_ratio });
    (plate, length, DENSITY * width * length * length * thickness)
}

/// A steel ball.
pub(super) fn ball(mass: f64, speed: f64) -> Value {
    let radius = (mass / DENSITY * 0.75 / PI).cbrt();
    json!({ "density_kg_m3": DENSITY, "radius_m": radius, "speed_m_s": speed })
}

pub(super) fn hertz() -> Value {
    json!({ "law": "hertz", "youngs_modulus_pa": MODULUS, "poissons_ratio": POISSON })
}

/// A random contact law for a striker of that mass and speed: Hertz's law with probability 1/3, otherwise each law with the
/// same probability. Strikers on a string are soft.
fn contact(random: &mut Random, kind: &str, mass: f64, speed: f64) -> Value {
    // duration of contact on a wall: that of a steel ball of this mass, or up to ten times that
    let softer = if kind == "string" { 10.0 } else { 1.0 };
    let duration = softer * 2e-3 * mass.cbrt() * speed.powf(-0.2) * random.log(0.1, 1.0);
    let stiffness = mass * (PI / duration).powi(2);
    // the compression of a spring of this stiffness, and the stiffness of a power law with the same force at that compression
    let compression = speed * duration / PI;
    let power = |exponent: f64| stiffness * compression.powf(1.0 - exponent);
    let restitution = 0.3 + 0.65 * random.share();
    let exponent = 2.0 + 2.0 * random.share();
    let (law, more) = match random.of(&[0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10]) {
        0 => ("hertz", json!({})),
        1 => ("viscous", json!({ "restitution": restitution })),
        2 => ("hysteretic", json!({ "theta_m": 1.6, "beta": 1.4, "k_bar": 0.4, "epsilon_m": 0.0 })),
        3 => ("hunt-crossley", json!({ "restitution": restitution })),
        4 => ("lankarani-nikravesh", json!({ "restitution": restitution })),
        5 => ("flores", json!({ "restitution": restitution })),
        6 => ("elastoplastic", json!({ "yield_pressure_pa": 1.2e9 })),
        7 => return json!({ "law": "linear-spring", "stiffness_n_m": stiffness }),
        8 => return json!({ "law": "kelvin-voigt", "stiffness_n_m": stiffness, "restitution": restitution }),
        9 => return json!({ "law": "power", "stiffness_n_m_n": power(exponent), "exponent": exponent }),
        _ => {
            return json!({ "law": "felt", "stiffness_n_m_n": power(exponent), "exponent": exponent,
                           "retardation_time_s": duration * random.log(0.01, 1.0) });
        }
    };
    let mut law = json!({ "law": law, "youngs_modulus_pa": MODULUS, "poissons_ratio": POISSON });
    for (field, value) in more.as_object().into_iter().flatten() {
        law[field] = value.clone();
    }
    law
}

/// A random scene, without a tolerance.
pub(super) struct Drawn {
    /// Short name of the structure.
    pub kind: &'static str,
    pub damping_ratio: f64,
    /// The scene that the program solves.
    pub scene: Scene,
    /// The same impact on a structure whose modes can all be computed.
    pub whole: Scene,
    /// Largest number of modes of a reference.
    pub most_modes: usize,
}

/// Scene number `seed`.
pub(super) fn scene(seed: u64) -> Result<Drawn, Failure> {
    let random = &mut random(seed.wrapping_add(1));
    let kind = random.of(&[
        "beam",
        "beam",
        "beam",
        "beam",
        "beam",
        "beam",
        "timoshenko",
        "timoshenko",
        "timoshenko",
        "list",
        "list",
        "plate",
        "plate",
        "string",
        "string",
        "moving",
        "moving",
        "stop",
    ]);
    let damping_ratio = if random.share() < UNDAMPED { 0.0 } else { random.log(1e-3, 0.1) };
    let ends = [0, 1].map(|_| random.of(&["clamped", "pinned", "free", "guided"]));
    // on a moving structure the restitution is that of the striker alone; with a stop the whole structure has to move
    let held = ["pinned", if kind == "stop" { "free" } else { random.of(&["clamped", "pinned", "guided"]) }];
    let (structure, length, structure_mass) = match kind {
        "string" => string(random, damping_ratio),
        "plate" => plate(random, damping_ratio),
        "timoshenko" => with_shear(beam(random, ends, damping_ratio)),
        "moving" | "stop" => beam(random, held, damping_ratio),
        _ => beam(random, ends, damping_ratio),
    };
    let light = random.share() < LIGHT;
    let mass = structure_mass * if light { random.log(1e-6, 1e-3) } else { random.log(1e-3, 3.0) };
    let speed = random.log(0.05, 5.0);
    let share = match random.share() {
        near if near < 0.15 => random.log(1e-4, 0.1),
        near if near < 0.3 => 1.0 - random.log(1e-4, 0.1),
        near if near < 0.36 => random.of(&[0.0, 0.5, 1.0]),
        _ => random.share(),
    };
    // at its held end the structure never meets a stop
    let share = if kind == "stop" && share == 0.0 { 0.5 } else { share };
    let place = match kind {
        "plate" => {
            let width = structure["width_m"].as_f64().unwrap_or(0.0);
            json!([share * length, (0.2 + 0.6 * share) * width])
        }
        _ => json!(share * length),
    };
    let mut value = json!({ "structure": structure, "striker": ball(mass, speed),
        "contact": contact(random, kind, mass, speed), "location_m": place });
    if kind == "moving" || kind == "stop" {
        let rate = speed * random.log(0.1, 2.0);
        value["modes"] = json!(random.log(STATED[0], STATED[1]) as usize);
        value["residual_compliance"] = json!(random.share() < 0.5);
        value["start"] = json!({ "gap_m": speed * random.log(1e-5, 1e-2),
            "moving_modes": [{ "mode": if kind == "stop" { 1 } else { random.of(&[1, 2, 3]) },
                               "velocity_m_s": rate, "location_m": 0.37 * length }] });
    }
    if kind == "stop" {
        value["striker"] = json!({ "immovable": true, "speed_m_s": 0 });
        value["contact"] = json!({ "law": "linear-spring", "stiffness_n_m": mass * random.log(1e4, 1e8) });
    }
    let whole = Scene::from_value(&value)?;
    let scene =
        if kind == "list" { listed(value.clone(), &whole, random.log(8.0, 200.0) as usize)? } else { whole.clone() };
    let ritz = value["structure"]["edges"].as_array().is_some_and(|edges| edges.iter().any(|edge| edge != "pinned"));
    let most_modes = if ritz { RITZ } else { MOST_MODES };
    Ok(Drawn { kind, damping_ratio, scene, whole, most_modes })
}

/// The scene with its structure given as this many modes and the static compliance.
fn listed(mut value: Value, whole: &Scene, count: usize) -> Result<Scene, Failure> {
    let all = Scene { modes: Modes::Count(count), residual_compliance: Some(true), ..whole.clone() }.structure()?;
    let modes = &all.modes[..count];
    let compliance: f64 = all
        .modes
        .iter()
        .filter(|mode| mode.omega_rad_s > 0.0)
        .map(|mode| (mode.shape / mode.omega_rad_s).powi(2))
        .sum();
    let of = |part: fn(&vibroimpact::vibroimpact_sim::modal::Mode) -> f64| modes.iter().map(part).collect::<Vec<f64>>();
    value["structure"] = json!({ "kind": "modal", "omega_rad_s": of(|mode| mode.omega_rad_s),
        "shape_at_location": of(|mode| mode.shape), "damping_ratios": of(|mode| mode.damping_ratio),
        "static_compliance_m_n": compliance });
    value.as_object_mut().map(|fields| fields.remove("location_m"));
    Ok(Scene::from_value(&value)?)
}
