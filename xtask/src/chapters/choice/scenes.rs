//! Random scenes: every end, law and step, masses and speeds over decades.

use crate::chapters::Failure;
use serde_json::{Value, json};
use vibroimpact::Scene;

/// Steel, for beams and balls alike.
const MODULUS: f64 = 2e11;
const DENSITY: f64 = 7800.0;
/// Share of undamped scenes, and of beams with a step.
const UNDAMPED: f64 = 0.15;
const STEPPED: f64 = 0.3;
/// Share of scenes at a support or in the middle of a long beam under a light ball, where another model may do.
const SPECIAL: f64 = 0.1;

/// SplitMix64 (Steele, Lea and Flood 2014).
pub(super) struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(seed.wrapping_mul(0x2545_F491_4F6C_DD1D))
    }

    /// From 0 to 1.
    pub fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Between two numbers, evenly in their logarithm.
    pub fn log(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.share())
    }

    fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[((self.share() * list.len() as f64) as usize).min(list.len() - 1)]
    }
}

/// A beam of one or two segments: its JSON, its length, its mass.
pub(super) fn beam(random: &mut Random, ends: [&str; 2], damping_ratio: f64) -> (Value, f64, f64) {
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

/// A steel ball.
pub(super) fn ball(mass: f64, speed: f64) -> Value {
    let radius = (mass / DENSITY * 0.75 / std::f64::consts::PI).cbrt();
    json!({ "density_kg_m3": DENSITY, "radius_m": radius, "speed_m_s": speed })
}

pub(super) fn hertz() -> Value {
    json!({ "law": "hertz", "youngs_modulus_pa": MODULUS, "poissons_ratio": 0.3 })
}

/// Scene number `seed`: modes and model left to the program, a tolerance from 1e-5 to 1e-1.
pub(super) fn scene(seed: u64) -> Result<Scene, Failure> {
    let random = &mut Random::new(seed.wrapping_add(1));
    let special = random.share() < SPECIAL;
    let ends = [0, 1].map(|_| random.of(&["clamped", "pinned", "free", "guided"]));
    let damping_ratio = if random.share() < UNDAMPED { 0.0 } else { random.log(1e-3, 0.1) };
    let (structure, length, beam_mass) = beam(random, ends, damping_ratio);
    let mass = beam_mass * if special { random.log(1e-6, 1e-3) } else { random.log(1e-3, 3.0) };
    let speed = random.log(0.05, 5.0);
    let place = match (special, random.share()) {
        (true, share) if share < 0.5 => length * random.of(&[0.0, 1.0, 1e-4, 0.999]),
        (true, _) => 0.5 * length,
        (false, share) => share * length,
    };
    let striker = ball(mass, speed);
    let contact = match random.of(&["hertz", "hertz", "hertz", "viscous", "spring", "plastic"]) {
        "hertz" => hertz(),
        "viscous" => {
            json!({ "law": "viscous", "youngs_modulus_pa": MODULUS, "poissons_ratio": 0.3, "restitution": 0.8 })
        }
        "spring" => {
            // as long a contact at a wall as a ball of that mass would have, or up to ten times that
            let duration = 2e-3 * mass.cbrt() * speed.powf(-0.2) * random.log(0.1, 1.0);
            json!({ "law": "linear-spring", "stiffness_n_m": mass * (std::f64::consts::PI / duration).powi(2) })
        }
        _ => json!({ "law": "elastoplastic", "youngs_modulus_pa": MODULUS, "poissons_ratio": 0.3,
                     "yield_pressure_pa": 1.2e9 }),
    };
    let tolerance = random.log(1e-5, 1e-1);
    let scene = json!({ "structure": structure, "striker": striker, "contact": contact, "location_m": place,
                        "tolerance": tolerance });
    Ok(Scene::from_value(&scene)?)
}
