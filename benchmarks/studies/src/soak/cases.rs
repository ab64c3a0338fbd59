//! Random impacts: most of them far outside the usual range, some at the very limits of what the solvers accept.

use beam_modes::{MOST_REMAINDER_MODES, PointMode, remainder_from_trend};
use contact_models::{
    Felt, Flores, Hertz, HuntCrossley, Hysteretic, InvalidInput, KelvinVoigt, LankaraniNikravesh, Law, LinearSpring,
    Power, Thornton, Viscous,
};
use emoc::{Coefficients, Contact, Friction, Problem};
use fastrand::Rng;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::sync::LazyLock;
use vibroimpact_sim::dropped_rod::DroppedRod;
use vibroimpact_sim::infinite;
use vibroimpact_sim::modal::{Mode, Settings, Start, Striker, Structure};

/// One random impact.
#[derive(Debug, Clone)]
pub enum Case {
    /// A structure in modes.
    Modal(Box<Modal>),
    /// A tilted rod dropped on a surface.
    Rod(Box<Modal>),
    /// An impact that was rejected during construction, and the reason.
    Refused(String),
    /// A scene in the form of its file.
    Scene(Value),
    /// An infinite beam or plate.
    Infinite(infinite::Structure, f64),
    /// A net restitution without integration in time.
    Net(Problem),
    /// The net restitution of a single striker of 1 kg, with values at the limits of all ranges.
    Single(Vec<f64>, Coefficients<f64>),
}

/// An impact for the modal solver.
#[derive(Debug, Clone)]
pub struct Modal {
    pub structure: Structure,
    pub striker: Striker,
    pub law: Law,
    pub start: Option<Start>,
    pub settings: Settings,
}

/// Case number `index` of the sequence with this seed. The case depends on nothing else.
pub fn case(seed: u64, index: u64) -> Case {
    // the index is spread over all bits, so that neighbouring cases are unrelated
    let mut random = Rng::with_seed(seed ^ index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    match random.u32(0..100) {
        0..64 => Case::Modal(Box::new(modal(&mut random))),
        64..70 => rod(&mut random),
        70..80 => Case::Scene(scene(&mut random)),
        80..88 => infinite(&mut random),
        88..97 => Case::Net(net(&mut random)),
        _ => single(&mut random),
    }
}

/// Log-uniform from `10^from` to `10^to`; each end is drawn with probability 1/50.
fn decades(random: &mut Rng, from: f64, to: f64) -> f64 {
    10f64.powf(match random.u32(0..50) {
        0 => from,
        1 => to,
        _ => from + (to - from) * random.f64(),
    })
}

/// True with probability `1/n`.
fn once_in(random: &mut Rng, n: u32) -> bool {
    random.u32(0..n) == 0
}

fn signed(random: &mut Rng) -> f64 {
    2.0 * random.f64() - 1.0
}

fn modal(random: &mut Rng) -> Modal {
    let extreme = once_in(random, 20);
    let structure = structure(random, extreme);
    let mass_kg = if extreme { decades(random, -30.0, 30.0) } else { decades(random, -6.0, 6.0) };
    let mut speed_m_s = if extreme { decades(random, -30.0, 30.0) } else { decades(random, -6.0, 3.0) };
    let start = once_in(random, 4).then(|| start(random, &structure, speed_m_s));
    if start.is_some() && once_in(random, 4) {
        // the structure moves towards the striker, or follows it
        speed_m_s *= if once_in(random, 2) { 0.0 } else { -random.f64() };
    }
    // impacts that never end are included, but should not take most of the time
    let max_steps = if once_in(random, 50) { 20_000 } else { 2_000 };
    let settings =
        Settings { tolerance: decades(random, -11.0, -4.0), max_steps, max_sub_impacts: 500, ..Settings::default() };
    Modal { structure, striker: Striker { mass_kg, speed_m_s }, law: law(random, extreme), start, settings }
}

fn structure(random: &mut Rng, extreme: bool) -> Structure {
    let n = match random.u32(0..20) {
        0 => 0,
        1 => 1,
        2 => random.usize(40..120),
        _ => random.usize(1..40),
    };
    let place = match random.u32(0..20) {
        0 => 0.0,
        1 => 0.5,
        2 => 1e-6,
        _ => random.f64(),
    };
    let damping = match random.u32(0..10) {
        0..3 => 0.0,
        3 => decades(random, -1.0, 6.0),
        _ => decades(random, -4.0, -1.0),
    };
    let (first, power) = (decades(random, 0.0, 5.0), random.i32(0..3));
    let weight = decades(random, -2.0, 2.0);
    let mut modes: Vec<Mode> = (1..=n)
        .map(|k| {
            if extreme {
                return Mode {
                    omega_rad_s: decades(random, -3.0, 15.0),
                    damping_ratio: if once_in(random, 3) { 0.0 } else { decades(random, -12.0, 6.0) },
                    shape: signed(random) * decades(random, -30.0, 20.0),
                };
            }
            // powers of k: equal frequencies, equally spaced ones, or those of a beam; sometimes two frequencies are nearly equal
            let split = if once_in(random, 10) { 1.0 + decades(random, -16.0, -3.0) } else { 1.0 };
            Mode {
                omega_rad_s: first * split * (k as f64).powi(power),
                damping_ratio: damping,
                shape: weight * (PI * k as f64 * place).sin(),
            }
        })
        .collect();
    if once_in(random, 20) {
        // a stiff contact and a light structure: the compression oscillates within a contact, and a hysteresis has many small loops
        modes.push(Mode {
            omega_rad_s: decades(random, 4.0, 7.0),
            damping_ratio: 0.0,
            shape: weight * decades(random, -2.0, 1.0),
        });
    }
    for _ in 0..random.u32(0..6).saturating_sub(3) {
        modes.push(Mode { omega_rad_s: 0.0, damping_ratio: 0.0, shape: decades(random, -2.0, 1.0) });
    }
    if once_in(random, 5) {
        // no remainder modes can be added if frequencies and compliances have no recognisable trend
        let seen = |mode: &Mode| PointMode { omega_rad_s: mode.omega_rad_s, shape: mode.shape };
        let kept: Vec<PointMode> = modes.iter().map(seen).collect();
        let remainder =
            remainder_from_trend(&kept, decades(random, -14.0, -5.0), random.usize(1..=MOST_REMAINDER_MODES));
        let fit = |mode: &PointMode| mode.omega_rad_s <= 1e15 && mode.shape <= 1e30;
        modes.extend(remainder.unwrap_or_default().iter().filter(|mode| fit(mode)).map(|mode| Mode {
            omega_rad_s: mode.omega_rad_s,
            damping_ratio: damping,
            shape: mode.shape,
        }));
    }
    Structure { modes }
}

fn start(random: &mut Rng, structure: &Structure, speed_m_s: f64) -> Start {
    let n = structure.modes.len();
    // modal velocities that move the contact point at speeds similar to that of the striker
    let size = speed_m_s * decades(random, -3.0, 1.0) / (n.max(1) as f64).sqrt();
    let (mut amplitude, mut rate) = (Vec::with_capacity(n), Vec::with_capacity(n));
    for mode in &structure.modes {
        let modal = (size / mode.shape.abs().max(1e-3)).min(1e30);
        rate.push(modal * signed(random));
        amplitude.push((modal * signed(random) / mode.omega_rad_s.max(1e-3)).clamp(-1e30, 1e30));
    }
    let gap_m = if once_in(random, 3) { 0.0 } else { (speed_m_s * decades(random, -6.0, -1.0)).min(1e30) };
    Start { amplitude, rate, gap_m }
}

fn law(random: &mut Rng, extreme: bool) -> Law {
    let k = if extreme { decades(random, -10.0, 25.0) } else { decades(random, 2.0, 14.0) };
    let found: Result<Law, InvalidInput> = match random.u32(0..14) {
        0 => Viscous::new(k, decades(random, -4.0, 2.0)).map(Law::from),
        1 => Hysteretic {
            stiffness_n_m1_5: k,
            theta_m: 1.6,
            beta: 1.4,
            k_bar: 0.4,
            epsilon_m: decades(random, -10.0, -3.0),
        }
        .validated()
        .map(Law::from),
        2 => Hysteretic { stiffness_n_m1_5: k, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m: 0.0 }
            .validated()
            .map(Law::from),
        3 => LinearSpring::new(k).map(Law::from),
        4 => KelvinVoigt::new(k, decades(random, -3.0, 5.0)).map(Law::from),
        5 => HuntCrossley::new(k, 1.0 + 2.0 * random.f64(), decades(random, -3.0, 2.0)).map(Law::from),
        6 => LankaraniNikravesh::new(k, 0.01 + 0.99 * random.f64()).map(Law::from),
        7 => Flores::new(k, 0.05 + 0.95 * random.f64()).map(Law::from),
        8 => {
            let (modulus, radius) = (decades(random, 6.0, 12.0), decades(random, -3.0, 0.0));
            Thornton::new(modulus, radius, decades(random, 5.0, 10.0)).map(Law::from)
        }
        9 => Power::new(k, 1.0 + 4.0 * random.f64()).map(Law::from),
        10 => Felt::new(k, 2.0 + 3.0 * random.f64(), decades(random, -6.0, -1.0)).map(Law::from),
        _ => Hertz::new(k).map(Law::from),
    };
    found.unwrap_or(Law::Hertz(Hertz { stiffness_n_m1_5: 1e10 }))
}

fn rod(random: &mut Rng) -> Case {
    let length_m = decades(random, -2.0, 1.0);
    let inclination_rad = match random.u32(0..6) {
        0 => 0.0,
        1 => 0.5 * PI,
        2 => 0.5 * PI - decades(random, -12.0, -3.0),
        _ => 0.5 * PI * random.f64(),
    };
    let rod = DroppedRod {
        length_m,
        diameter_m: length_m * decades(random, -3.0, -1.0),
        youngs_modulus_pa: decades(random, 6.0, 12.0),
        density_kg_m3: decades(random, 2.0, 4.3),
        poissons_ratio: 0.5 * random.f64(),
        inclination_rad,
        bending_modes: random.usize(0..30),
        axial_modes: random.usize(0..30),
        damping_ratio: if once_in(random, 2) { 0.0 } else { decades(random, -4.0, 0.0) },
    };
    let speed_m_s = decades(random, -6.0, 3.0);
    let settings = Settings {
        tolerance: decades(random, -11.0, -4.0),
        max_steps: 2_000,
        max_sub_impacts: 500,
        ..Settings::default()
    };
    match rod.drop(speed_m_s) {
        Ok(drop) => Case::Rod(Box::new(Modal {
            structure: drop.structure,
            striker: drop.surface,
            law: drop.law.into(),
            start: Some(drop.start),
            settings,
        })),
        // a valid rod must not be rejected, which is reported when the case is checked
        Err(fault) => Case::Refused(fault.to_string()),
    }
}

fn scene(random: &mut Rng) -> Value {
    let ends = ["clamped", "pinned", "free", "guided"];
    let segments: Vec<Value> = (0..random.usize(1..4))
        .map(|_| {
            json!({
                "length_m": decades(random, -2.0, 1.0),
                "flexural_rigidity_n_m2": decades(random, -2.0, 6.0),
                "mass_per_length_kg_m": decades(random, -3.0, 3.0),
            })
        })
        .collect();
    let length: f64 = segments.iter().filter_map(|segment| segment["length_m"].as_f64()).sum();
    let share = match random.u32(0..6) {
        0 => 0.0,
        1 => 1.0,
        2 => 1e-6,
        _ => random.f64(),
    };
    // sometimes the location is a step
    let location = if once_in(random, 5) { segments[0]["length_m"].as_f64().unwrap_or(0.0) } else { share * length };
    let contact = match random.u32(0..4) {
        0 => json!({ "law": "hysteretic", "stiffness_n_m1_5": decades(random, 5.0, 12.0), "theta_m": 1.6, "beta": 1.4,
                     "k_bar": 0.4, "epsilon_m": decades(random, -9.0, -6.0) }),
        1 => json!({ "law": "viscous", "stiffness_n_m1_5": decades(random, 5.0, 12.0),
                     "restitution": 0.1 + 0.9 * random.f64() }),
        2 => json!({ "law": "kelvin-voigt", "stiffness_n_m": decades(random, 3.0, 9.0),
                     "restitution": 0.1 + 0.9 * random.f64() }),
        _ => json!({ "law": "hertz", "stiffness_n_m1_5": decades(random, 5.0, 12.0) }),
    };
    json!({
        "structure": {
            "kind": "beam", "ends": [ends[random.usize(0..4)], ends[random.usize(0..4)]], "segments": segments,
            "damping_ratio": if once_in(random, 3) { 0.0 } else { decades(random, -4.0, 0.0) },
        },
        "striker": { "mass_kg": decades(random, -4.0, 3.0), "speed_m_s": decades(random, -4.0, 2.0) },
        "contact": contact,
        "location_m": location,
        "modes": random.usize(0..40),
        "residual_compliance": once_in(random, 2),
        "tolerance": 1e-7,
    })
}

/// The critical `S`, and the first turning points.
static CHANGES: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let turning = infinite::turning_points(6).unwrap_or_default();
    [infinite::critical_s().s].into_iter().chain(turning.iter().map(|point| point.s)).collect()
});

fn infinite(random: &mut Rng) -> Case {
    if once_in(random, 4) {
        return Case::Infinite(infinite::Structure::Plate, decades(random, -12.0, 8.0));
    }
    // every fourth beam is close to a value where the contact history changes, on either side
    let s = if once_in(random, 4) {
        CHANGES[random.usize(0..CHANGES.len())] * (1.0 + signed(random) * decades(random, -12.0, -0.3))
    } else {
        decades(random, -12.0, 8.0)
    };
    Case::Infinite(infinite::Structure::Beam, s)
}

fn single(random: &mut Rng) -> Case {
    let n = random.usize(0..30);
    let size = if once_in(random, 5) { 0.0 } else { decades(random, -6.0, 6.0) / (n.max(1) as f64).sqrt() };
    let beta0 = if once_in(random, 5) { decades(random, -12.0, 12.0) } else { fraction(random) };
    let coefficients = Coefficients { ebar: fraction(random), beta0, beta1: fraction(random) };
    Case::Single((0..n).map(|_| size * signed(random)).collect(), coefficients)
}

fn net(random: &mut Rng) -> Problem {
    let contacts: Vec<Contact> = (0..random.usize(1..5))
        .map(|_| Contact {
            friction: match random.u32(0..3) {
                0 => Friction::None,
                1 => Friction::Planar { coefficient: 1.5 * random.f64() },
                _ => Friction::Spatial { coefficient: 1.5 * random.f64(), facets: random.usize(3..11) },
            },
            coefficients: Coefficients { ebar: fraction(random), beta0: fraction(random), beta1: fraction(random) },
        })
        .collect();
    let d: usize = contacts.iter().map(|contact| contact.friction.coordinates()).sum();
    let n = random.usize(1..9);
    // W = J J^T and v = J q are consistent whatever the rank of J
    let jacobian: Vec<f64> = (0..d * n).map(|_| signed(random)).collect();
    let (weight, velocity) = (decades(random, -3.0, 3.0), (0..n).map(|_| signed(random)).collect::<Vec<f64>>());
    let row = |i: usize| &jacobian[i * n..(i + 1) * n];
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let vibrates = f64::from(random.u8(0..2));
    Problem {
        inverse_inertia_per_kg: (0..d * d).map(|at| weight * dot(row(at / d), row(at % d))).collect(),
        velocity_m_s: (0..d).map(|i| dot(row(i), &velocity)).collect(),
        modes: (0..random.usize(0..9))
            .map(|_| emoc::Mode {
                rate: vibrates * signed(random),
                shape: (0..d).map(|_| weight.sqrt() * 2.0 * signed(random)).collect(),
            })
            .collect(),
        contacts,
    }
}

/// Uniform from 0 to 1; each end is drawn with probability 1/10.
fn fraction(random: &mut Rng) -> f64 {
    match random.u32(0..10) {
        0 => 0.0,
        1 => 1.0,
        _ => random.f64(),
    }
}
