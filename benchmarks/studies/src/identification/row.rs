//! A random table of synthetic measurements, and the outcome of its fit.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use tasks::{Failure, Random};
use vibroimpact::Scene;
use vibroimpact::identify::{Data, Free, Identification, Request, identify};

/// Largest relative error of parameters that count as near the true ones.
const NEAR: f64 = 0.02;
/// Numbers of starting points that are compared for impacts with many contacts.
pub const STARTS: [usize; 3] = [1, 4, 16];
const POINTS: [&str; 3] = ["tip", "middle", "quarter"];
const SPEEDS: [f64; 4] = [0.5, 1.0, 2.0, 4.0];
const NOISE: [f64; 2] = [0.004, 4e-7];
/// Locations along a beam. Impacts at the first ones have a single contact.
const PLACES: [f64; 8] = [0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 1.0];
const SINGLE: usize = 6;
/// Relative noise of peak forces.
const PEAK_NOISE: f64 = 0.01;
/// Fields that are identified.
pub const FREE: [&str; 2] = ["contact.stiffness_n_m1_5", "striker.mass_kg"];

/// One table and the outcome of its fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub kind: Kind,
    pub number: u64,
    /// Numbers of parameters that lie in the intervals by covariance and by profile.
    pub by_covariance: usize,
    pub by_profile: usize,
    /// Whether a test of the misfit rejected the model.
    pub noticed: bool,
    /// For each number of starts, of a table with many contacts only: whether the fit is as good as the true parameters, and
    /// whether it is near them.
    pub fits: Vec<bool>,
    pub near: Vec<bool>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kind {
    /// With stated noise, or with noise that is estimated.
    Stated,
    Estimated,
    /// Fitted with the wrong law, or with the wrong damping.
    WrongLaw,
    WrongDamping,
    /// Every impact has several contacts: the restitution and the peak force of the first contact on the beam of chapter 3.
    Chaotic,
    /// Many contacts at the tip: the restitution alone, the restitution and the peak force of the first contact, and both without
    /// the locations that have many contacts.
    Rough,
    RoughPeak,
    Smooth,
}

impl Kind {
    /// All kinds, in the order of the summary.
    pub const ALL: [Kind; 8] = [
        Kind::Stated,
        Kind::Estimated,
        Kind::WrongLaw,
        Kind::WrongDamping,
        Kind::Rough,
        Kind::RoughPeak,
        Kind::Smooth,
        Kind::Chaotic,
    ];

    /// Whether its impacts have many contacts.
    pub fn is_rough(self) -> bool {
        matches!(self, Kind::Rough | Kind::RoughPeak | Kind::Smooth | Kind::Chaotic)
    }
}

/// Draws a table and fits it.
pub fn row(kind: Kind, number: u64) -> Result<Row, Failure> {
    let mut random = Random::new(number.wrapping_mul(0x9e37_79b9).wrapping_add(kind as u64));
    let mut row =
        Row { kind, number, by_covariance: 0, by_profile: 0, noticed: false, fits: Vec::new(), near: Vec::new() };
    if kind.is_rough() {
        return rough(row, &mut random);
    }
    let truth = [1.2e9 * factor(&mut random, 1.5), 0.05 * factor(&mut random, 1.5)];
    let mut guess = scene(truth[0] * factor(&mut random, 1.15), truth[1] * factor(&mut random, 1.15));
    match kind {
        Kind::WrongLaw => guess["contact"] = json!({ "law": "linear-spring", "stiffness_n_m": 1e7 }),
        Kind::WrongDamping => guess["structure"]["damping_ratios"] = json!([0.004, 0.005, 0.3, 0.3, 0.3, 0.3]),
        _ => {}
    }
    let stated = kind != Kind::Estimated;
    let data = table(&scene(truth[0], truth[1]), stated, &mut random)?;
    let free = if kind == Kind::WrongLaw { ["contact.stiffness_n_m", FREE[1]] } else { FREE };
    let found = fitted(&guess, &data, &free, 1)?;
    for (parameter, truth) in found.parameters.iter().zip(truth) {
        row.by_profile += usize::from(holds(parameter.profile_interval, truth));
        let ends = parameter.covariance_interval.map_or([None; 2], |ends| ends.map(Some));
        row.by_covariance += usize::from(holds(ends, truth));
    }
    row.noticed = found.lack_of_fit.iter().any(|test| test.noticed);
    Ok(row)
}

/// Log-uniform from `1/most` to `most`.
fn factor(random: &mut Random, most: f64) -> f64 {
    most.powf(2.0 * random.share() - 1.0)
}

/// Whether an interval contains the true value. An unknown end is open.
fn holds([low, high]: [Option<f64>; 2], truth: f64) -> bool {
    low.is_none_or(|low| low <= truth) && high.is_none_or(|high| truth <= high)
}

/// Impacts of which many have several contacts.
struct Impacts {
    scene: Value,
    free: [&'static str; 2],
    truth: [f64; 2],
    /// Locations and speeds.
    at: Vec<(f64, f64)>,
}

impl Impacts {
    /// On a cantilever, at locations up to its tip or without the two next to it.
    fn on_cantilever(count: usize, random: &mut Random) -> Impacts {
        Impacts {
            scene: json!({
                "structure": { "kind": "beam", "ends": ["clamped", "free"], "damping_ratio": 0.02,
                    "segments": [{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }] },
                "striker": { "mass_kg": 0.06, "speed_m_s": 1 },
                "contact": { "law": "hertz", "stiffness_n_m1_5": 2e9 },
                "location_m": 0.9, "modes": 20, "residual_compliance": true
            }),
            free: FREE,
            truth: [2e9 * factor(random, 2.0), 0.06 * factor(random, 1.2)],
            at: PLACES[..count].iter().map(|place| (*place, 1.0)).collect(),
        }
    }

    /// On the beam of chapter 3, with three to nine contacts each.
    fn of_chapter_3(random: &mut Random) -> Impacts {
        let side_m = 0.011323;
        Impacts {
            scene: json!({
                "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.02,
                    "segments": [{ "length_m": 1, "youngs_modulus_pa": 2e11, "density_kg_m3": 7800,
                        "width_m": side_m, "thickness_m": side_m }] },
                "striker": { "density_kg_m3": 7800, "radius_m": 0.015, "speed_m_s": 1 },
                "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 },
                "location_m": 0.4, "modes": 40, "residual_compliance": true
            }),
            free: ["contact.youngs_modulus_pa", "structure.damping_ratio"],
            truth: [2e11 * factor(random, 1.6), 0.015 * factor(random, 2.0)],
            at: [0.15, 0.23, 0.31, 0.39, 0.47]
                .into_iter()
                .flat_map(|place| [0.5, 1.0, 2.0].map(|v| (place, v)))
                .collect(),
        }
    }

    fn scene(&self, values: [f64; 2]) -> Result<Value, Failure> {
        let mut tree = self.scene.clone();
        for (field, value) in self.free.iter().zip(values) {
            let pointer = format!("/{}", field.replace('.', "/"));
            *tree.pointer_mut(&pointer).ok_or("no such field")? = json!(value);
        }
        Ok(tree)
    }
}

/// Fits impacts with many contacts from a poor initial guess.
fn rough(mut row: Row, random: &mut Random) -> Result<Row, Failure> {
    let (impacts, wrong) = match row.kind {
        Kind::Chaotic => (Impacts::of_chapter_3(random), [1.8, 0.6]),
        Kind::Smooth => (Impacts::on_cantilever(SINGLE, random), [1.8, 1.3]),
        _ => (Impacts::on_cantilever(PLACES.len(), random), [1.8, 1.3]),
    };
    let truth = impacts.truth;
    let with_peak = row.kind != Kind::Rough;
    let peak_columns = if with_peak { ",first_peak_force_n,first_peak_force_n_sd" } else { "" };
    let mut text = format!("location_m,striker.speed_m_s,restitution,restitution_sd{peak_columns}\n");
    // the sum of squares for the true parameters
    let mut of_truth = 0.0;
    let mut noise = |sd: f64| {
        let normal = random.normal();
        of_truth += normal * normal;
        sd * normal
    };
    for (place, speed) in &impacts.at {
        let mut tree = impacts.scene(truth)?;
        tree["location_m"] = json!(place);
        tree["striker"]["speed_m_s"] = json!(speed);
        let found = Scene::from_value(&tree)?.impact()?.solve()?;
        let e = found.restitution.ok_or("no rebound")? + noise(NOISE[0]);
        text += &format!("{place:?},{speed:?},{e:?},{:?}", NOISE[0]);
        if with_peak {
            let peak = found.sub_impacts.first().ok_or("no contact")?.peak_force_n;
            let sd = PEAK_NOISE * peak;
            text += &format!(",{:?},{sd:?}", peak + noise(sd));
        }
        text += "\n";
    }
    let data = parsed(&text)?;
    let guess = impacts.scene(std::array::from_fn(|j| truth[j] * wrong[j]))?;
    for starts in STARTS {
        let found = fitted(&guess, &data, &impacts.free, starts)?;
        let beside = || found.parameters.iter().zip(truth);
        row.fits.push(found.sum_of_squares <= of_truth);
        row.near.push(beside().all(|(parameter, truth)| (parameter.value / truth - 1.0).abs() < NEAR));
        row.by_profile = beside().filter(|(parameter, truth)| holds(parameter.profile_interval, *truth)).count();
    }
    Ok(row)
}

fn fitted(scene: &Value, data: &Data, free: &[&str], starts: usize) -> Result<Identification, Failure> {
    let free = free.iter().map(|field| Free::parse(field)).collect::<Result<Vec<_>, _>>()?;
    Ok(identify(&Scene::from_value(scene)?, data, &free, &Request { starts, ..Request::default() })?)
}

fn parsed(text: &str) -> Result<Data, Failure> {
    // these tables name no force history
    Ok(Data::parse(text.as_bytes(), &|_| Ok(Vec::new()))?)
}

/// Six modes of a cantilever.
fn scene(stiffness: f64, mass: f64) -> Value {
    json!({
        "structure": {
            "kind": "modal", "omega_rad_s": [58.2, 364.7, 1021.2, 2001.1, 3308.0, 4941.6],
            "damping_ratios": [0.004, 0.005, 0.006, 0.008, 0.01, 0.012],
            "points": {
                "tip": { "shape": [1.86, -1.52, 1.22, -0.91, 0.60, -0.31] },
                "middle": { "shape": [0.68, 1.43, 0.04, -1.40, -0.30, 1.2] },
                "quarter": { "shape": [0.19, 0.82, 1.30, 0.80, -0.6, -1.1] }
            }
        },
        "striker": { "mass_kg": mass, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": stiffness },
        "location": "tip"
    })
}

fn table(truth: &Value, stated: bool, random: &mut Random) -> Result<Data, Failure> {
    let sds = if stated { ",restitution_sd,first_contact_s_sd" } else { "" };
    let mut text = format!("location,striker.speed_m_s,restitution,first_contact_s{sds}\n");
    for point in POINTS {
        for speed in SPEEDS {
            let mut tree = truth.clone();
            tree["location"] = json!(point);
            tree["striker"]["speed_m_s"] = json!(speed);
            let found = Scene::from_value(&tree)?.impact()?.solve()?;
            let first = found.sub_impacts.first().ok_or("no contact")?;
            let e = found.restitution.ok_or("no rebound")? + NOISE[0] * random.normal();
            let contact = first.end_s - first.start_s + NOISE[1] * random.normal();
            let sds = if stated { format!(",{:?},{:?}", NOISE[0], NOISE[1]) } else { String::new() };
            text += &format!("{point},{speed:?},{e:?},{contact:?}{sds}\n");
        }
    }
    parsed(&text)
}
