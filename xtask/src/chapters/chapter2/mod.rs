//! Chapter 2: a ball strikes an infinite beam. One number `S` determines all contacts.

mod first_contact;
mod invariance;
mod map;
mod methods;
mod motion;
mod relatives;
mod sustained;

use super::Failure;
use super::study::Study;
use serde::{Deserialize, Serialize};
use vibroimpact::infinite::Sample;
use vibroimpact_sim::infinite::{Settings, Solution, Structure, solve};

const INTRODUCTION: &str = "A body strikes an infinite Euler-Bernoulli beam; contact is Hertzian, and the beam answers \
an impulse P at once and for ever with the displacement P C √t. One number, S = C¹⁰ k² m⁸ v, decides everything: one \
contact and a rebound, some separations and then sustained contact, or sustained contact from the first touch. All \
quantities are dimensionless, in the thesis's units T of time, F of force and D of displacement (Eqs. 2.9 to 2.11), \
unless a name says otherwise; displacements are positive upwards, towards the striker. Figures carry the numbers of the \
thesis. Turning points and the critical S are given with an uncertainty: the scatter of three resolutions. \
`timings.csv`, `timings-methods.csv` and `timings-methods.svg` hold what was measured with a clock and therefore \
differs from run to run.";

/// The parameter file, which explains its entries.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    #[serde(rename = "about")]
    _about: String,
    motion: Vec<Motion>,
    table_2_1: Vec<Steel>,
    table_a_1: Vec<Units>,
    table_a_1_s: String,
    first_contact: Vec<FirstContact>,
    semi_analytical_until: f64,
    sustained: Vec<Motion>,
    turning_points: Vec<String>,
    critical_s: String,
    our_choice: Choice,
}

/// An impact whose motion is plotted.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Motion {
    s: f64,
    separations: usize,
    until: f64,
}

/// A row of Table 2.1; the result as printed.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Steel {
    side_m: f64,
    radius_m: f64,
    speed_m_s: f64,
    s: String,
}

/// A row of Table A.1, in any consistent units; the results as printed.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Units {
    impulse_response: f64,
    stiffness: f64,
    mass: f64,
    speed: f64,
    force: String,
    time: String,
}

/// A pair of Fig. 2.6; the mass as printed.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FirstContact {
    speed: f64,
    mass: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Choice {
    #[serde(rename = "about")]
    _about: String,
    map_values: usize,
    map_from: f64,
    map_closest: f64,
    map_to: f64,
    turning_points: usize,
    functions: Vec<usize>,
    asymptotic_until: f64,
}

/// Motion in the thesis's units, displacements positive upwards.
struct Course {
    time: Vec<f64>,
    beam: Vec<f64>,
    body: Vec<f64>,
    /// `y - z`.
    compression: Vec<f64>,
    force: Vec<f64>,
}

#[derive(Serialize)]
struct CourseRow {
    time: f64,
    beam_displacement: f64,
    body_displacement: f64,
    compression: f64,
    force: f64,
}

impl Course {
    fn new(s: f64, samples: &[Sample]) -> Course {
        let unit = s.cbrt();
        let column = |of: fn(&Sample) -> f64, factor: f64| samples.iter().map(|sample| factor * of(sample)).collect();
        Course {
            time: column(|sample| sample.time, 1.0),
            beam: column(|sample| sample.state.structure_displacement, unit),
            body: column(|sample| sample.state.striker_displacement, unit),
            compression: column(|sample| sample.state.compression, unit),
            force: column(|sample| sample.state.force, 1.0),
        }
    }

    fn rows(&self) -> Vec<CourseRow> {
        let row = |i: usize| CourseRow {
            time: self.time[i],
            beam_displacement: self.beam[i],
            body_displacement: self.body[i],
            compression: self.compression[i],
            force: self.force[i],
        };
        (0..self.time.len()).map(row).collect()
    }
}

/// Solves with the default accuracy, without error estimate, up to `horizon` in sustained contact.
fn solved(s: f64, horizon: f64) -> Result<Solution, Failure> {
    Ok(solve(Structure::Beam, s, &Settings { horizon, estimate_uncertainty: false, ..Settings::default() })?)
}

/// `count` numbers from `low` to `high` in equal ratios.
fn in_ratio(low: f64, high: f64, count: usize) -> Vec<f64> {
    let step = (high / low).ln() / count.saturating_sub(1).max(1) as f64;
    (0..count).map(|i| low * (step * i as f64).exp()).collect()
}

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let parameters: Parameters = serde_json::from_str(include_str!("../../../../datasets/chapter2.json"))?;
    invariance::run(study, &parameters)?;
    motion::run(study, &parameters)?;
    first_contact::run(study, &parameters)?;
    sustained::run(study, &parameters)?;
    map::run(study, &parameters)?;
    relatives::run(study)?;
    methods::run(study)?;
    Ok(INTRODUCTION)
}
