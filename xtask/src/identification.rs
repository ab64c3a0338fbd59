//! Test of `identify` with random tables of synthetic measurements: how often its intervals contain the true parameters, how
//! often a wrong model is noticed, and how many starting points are needed for impacts with many contacts.

use std::fs::{self, File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use vibroimpact::Scene;
use vibroimpact::identify::{Data, Free, Identification, Request, identify};

use tasks::{Failure, Progress};

/// Tables fitted side by side before their rows are written.
const BATCH: usize = 32;
/// Largest relative error of parameters that count as near the true ones.
const NEAR: f64 = 0.02;
/// Numbers of starting points that are compared for impacts with many contacts.
const STARTS: [usize; 3] = [1, 4, 16];
const POINTS: [&str; 3] = ["tip", "middle", "quarter"];
const SPEEDS: [f64; 4] = [0.5, 1.0, 2.0, 4.0];
const NOISE: [f64; 2] = [0.004, 4e-7];
/// Locations along a beam. Impacts at the first ones have a single contact.
const PLACES: [f64; 8] = [0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 1.0];
const SINGLE: usize = 6;
/// Relative noise of peak forces.
const PEAK_NOISE: f64 = 0.01;
const FREE: [&str; 2] = ["contact.stiffness_n_m1_5", "striker.mass_kg"];

/// Options of the study of identification.
#[derive(clap::Args)]
pub struct Wanted {
    /// Number of tables of each kind
    #[arg(long, value_name = "COUNT", default_value_t = 2000)]
    tables: u64,
    /// Number of tables of impacts with many contacts
    #[arg(long, value_name = "COUNT", default_value_t = 40)]
    rough: u64,
    /// Resume from the results of an earlier run
    #[arg(long)]
    resume: bool,
    /// The folder to write to
    #[arg(long, value_name = "DIR", default_value = "out/study-identify")]
    out: PathBuf,
}

/// One table and the outcome of its fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Row {
    kind: Kind,
    number: u64,
    /// Numbers of parameters that lie in the intervals by covariance and by profile.
    by_covariance: usize,
    by_profile: usize,
    /// Whether a test of the misfit rejected the model.
    noticed: bool,
    /// For each number of starts, of a table with many contacts only: whether the fit is as good as the true parameters, and
    /// whether it is near them.
    fits: Vec<bool>,
    near: Vec<bool>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum Kind {
    /// With stated noise, or with noise that is estimated.
    Stated,
    Estimated,
    /// Fitted with the wrong law, or with the wrong damping.
    WrongLaw,
    WrongDamping,
    /// Many contacts at the tip: the restitution alone, the restitution and the peak force of the first contact, and both without
    /// the locations that have many contacts.
    Rough,
    RoughPeak,
    Smooth,
}

impl Kind {
    fn is_rough(self) -> bool {
        matches!(self, Kind::Rough | Kind::RoughPeak | Kind::Smooth)
    }
}

/// Runs the study, or the part that is missing, and summarises it.
pub fn run(wanted: &Wanted) -> Result<String, Failure> {
    let kinds =
        [Kind::Stated, Kind::Estimated, Kind::WrongLaw, Kind::WrongDamping, Kind::Rough, Kind::RoughPeak, Kind::Smooth];
    let count = |kind: Kind| if kind.is_rough() { wanted.rough } else { wanted.tables };
    let all: Vec<(Kind, u64)> = kinds.iter().flat_map(|&kind| (0..count(kind)).map(move |n| (kind, n))).collect();
    fs::create_dir_all(&wanted.out)?;
    let path = wanted.out.join("rows.jsonl");
    let mut rows: Vec<Row> = Vec::new();
    if wanted.resume && path.exists() {
        for line in BufReader::new(File::open(&path)?).lines() {
            rows.push(serde_json::from_str(&line?)?);
        }
    }
    let mut file =
        OpenOptions::new().create(true).write(true).append(wanted.resume).truncate(!wanted.resume).open(&path)?;
    let missing: Vec<(Kind, u64)> =
        all.iter().copied().filter(|(kind, n)| rows.iter().all(|row| (row.kind, row.number) != (*kind, *n))).collect();
    let mut progress = Progress::of("tables");
    progress.begin("", all.len() as u64, (all.len() - missing.len()) as u64);
    for batch in missing.chunks(BATCH) {
        let solve = |&(kind, number): &(Kind, u64)| {
            let found = row(kind, number).map_err(|fault| format!("{kind:?} {number}: {fault}"));
            progress.add(1);
            found
        };
        let found = batch.par_iter().map(solve).collect::<Result<Vec<Row>, String>>()?;
        let lines: Result<Vec<String>, _> = found.iter().map(serde_json::to_string).collect();
        writeln!(file, "{}", lines?.join("\n"))?;
        rows.extend(found);
    }
    progress.finish();
    rows.retain(|row| all.contains(&(row.kind, row.number)));
    let told = kinds.iter().map(|&kind| told(kind, &rows)).collect::<String>();
    fs::write(wanted.out.join("summary.txt"), &told)?;
    Ok(told)
}

/// The share of the rows of a kind for which a condition holds, and its standard error (%).
fn told(kind: Kind, rows: &[Row]) -> String {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.kind == kind).collect();
    let share = |held: usize, of: usize| {
        let p = held as f64 / of.max(1) as f64;
        format!("{:.2} +- {:.2} %", 100.0 * p, 100.0 * (p * (1.0 - p) / of.max(1) as f64).sqrt())
    };
    let parameters = FREE.len() * rows.len();
    let sum = |of: fn(&Row) -> usize| rows.iter().map(|row| of(row)).sum::<usize>();
    let noticed = share(sum(|row| usize::from(row.noticed)), rows.len());
    match kind {
        Kind::Stated | Kind::Estimated => format!(
            "{kind:?}: {} tables; intervals hold by covariance {}, by profile {}; noticed {noticed}\n",
            rows.len(),
            share(sum(|row| row.by_covariance), parameters),
            share(sum(|row| row.by_profile), parameters),
        ),
        Kind::WrongLaw | Kind::WrongDamping => format!("{kind:?}: {} tables; noticed {noticed}\n", rows.len()),
        Kind::Rough | Kind::RoughPeak | Kind::Smooth => {
            let of = |all: fn(&Row) -> &[bool], k: usize| {
                share(rows.iter().filter(|row| all(row).get(k) == Some(&true)).count(), rows.len())
            };
            let each = |(k, starts)| {
                let (fits, near) = (of(|row| &row.fits, k), of(|row| &row.near, k));
                format!("from {starts} starts {fits} fit as well as the truth and {near} are near it, ")
            };
            let each: String = STARTS.iter().enumerate().map(each).collect();
            let held = share(sum(|row| row.by_profile), parameters);
            format!("{kind:?}: {} tables; {each}intervals from the most starts hold by profile {held}\n", rows.len())
        }
    }
}

fn row(kind: Kind, number: u64) -> Result<Row, Failure> {
    let mut random = Random(number.wrapping_mul(0x9e37_79b9).wrapping_add(kind as u64));
    let mut row =
        Row { kind, number, by_covariance: 0, by_profile: 0, noticed: false, fits: Vec::new(), near: Vec::new() };
    if kind.is_rough() {
        return rough(row, &mut random);
    }
    let truth = [1.2e9 * random.factor(1.5), 0.05 * random.factor(1.5)];
    let mut guess = scene(truth[0] * random.factor(1.15), truth[1] * random.factor(1.15));
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

/// Whether an interval contains the true value. An unknown end is open.
fn holds([low, high]: [Option<f64>; 2], truth: f64) -> bool {
    low.is_none_or(|low| low <= truth) && high.is_none_or(|high| truth <= high)
}

/// A cantilever with locations up to its tip, where impacts have many contacts, and a poor initial guess.
fn rough(mut row: Row, random: &mut Random) -> Result<Row, Failure> {
    let truth = [2e9 * random.factor(2.0), 0.06 * random.factor(1.2)];
    let beam = |stiffness: f64, mass: f64| {
        json!({
            "structure": { "kind": "beam", "ends": ["clamped", "free"], "damping_ratio": 0.02,
                "segments": [{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }] },
            "striker": { "mass_kg": mass, "speed_m_s": 1 },
            "contact": { "law": "hertz", "stiffness_n_m1_5": stiffness },
            "location_m": 0.9, "modes": 20, "residual_compliance": true
        })
    };
    let with_peak = row.kind != Kind::Rough;
    let peak_columns = if with_peak { ",first_peak_force_n,first_peak_force_n_sd" } else { "" };
    let mut text = format!("location_m,restitution,restitution_sd{peak_columns}\n");
    // the sum of squares for the true parameters
    let mut of_truth = 0.0;
    let mut noise = |sd: f64| {
        let normal = random.normal();
        of_truth += normal * normal;
        sd * normal
    };
    let count = if row.kind == Kind::Smooth { SINGLE } else { PLACES.len() };
    for place in &PLACES[..count] {
        let mut tree = beam(truth[0], truth[1]);
        tree["location_m"] = json!(place);
        let found = Scene::from_value(&tree)?.impact()?.solve()?;
        let e = found.restitution.ok_or("no rebound")? + noise(NOISE[0]);
        text += &format!("{place:?},{e:?},{:?}", NOISE[0]);
        if with_peak {
            let peak = found.sub_impacts.first().ok_or("no contact")?.peak_force_n;
            let sd = PEAK_NOISE * peak;
            text += &format!(",{:?},{sd:?}", peak + noise(sd));
        }
        text += "\n";
    }
    let data = parsed(&text)?;
    let guess = beam(truth[0] * 1.8, truth[1] * 1.3);
    for starts in STARTS {
        let found = fitted(&guess, &data, &FREE, starts)?;
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

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A standard normal number by the method of Box and Muller.
    fn normal(&mut self) -> f64 {
        let (a, b) = (1.0 - self.uniform(), self.uniform());
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }

    /// Log-uniform from `1/most` to `most`.
    fn factor(&mut self, most: f64) -> f64 {
        most.powf(2.0 * self.uniform() - 1.0)
    }
}
