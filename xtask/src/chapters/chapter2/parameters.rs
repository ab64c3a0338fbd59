//! The chapter's parameters, and what its sections share.

use serde::{Deserialize, Serialize};
use tasks::Failure;
use vibroimpact::infinite::Sample;
use vibroimpact_sim::infinite::{Settings, Solution, Structure, solve};

/// The parameter file, which explains its entries.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    #[serde(rename = "about")]
    _about: String,
    pub motion: Vec<Motion>,
    pub table_2_1: Vec<Steel>,
    pub table_a_1: Vec<Units>,
    pub table_a_1_s: String,
    pub first_contact: Vec<FirstContact>,
    pub semi_analytical_until: f64,
    pub sustained: Vec<Motion>,
    pub turning_points: Vec<String>,
    pub critical_s: String,
    pub our_choice: Choice,
}

/// An impact whose motion is plotted.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    pub s: f64,
    pub separations: usize,
    pub until: f64,
}

/// A row of Table 2.1; the result as printed.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Steel {
    pub side_m: f64,
    pub radius_m: f64,
    pub speed_m_s: f64,
    pub s: String,
}

/// A row of Table A.1, in any consistent units; the results as printed.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Units {
    pub impulse_response: f64,
    pub stiffness: f64,
    pub mass: f64,
    pub speed: f64,
    pub force: String,
    pub time: String,
}

/// A pair of Fig. 2.6; the mass as printed.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FirstContact {
    pub speed: f64,
    pub mass: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    #[serde(rename = "about")]
    _about: String,
    pub map_values: usize,
    pub map_from: f64,
    pub map_closest: f64,
    pub map_to: f64,
    pub turning_points: usize,
    pub functions: Vec<usize>,
    pub asymptotic_until: f64,
}

/// Motion in the thesis's units, displacements positive upwards.
pub struct Course {
    pub time: Vec<f64>,
    pub beam: Vec<f64>,
    pub body: Vec<f64>,
    /// `y - z`.
    pub compression: Vec<f64>,
    pub force: Vec<f64>,
}

#[derive(Serialize)]
pub struct CourseRow {
    pub time: f64,
    pub beam_displacement: f64,
    pub body_displacement: f64,
    pub compression: f64,
    pub force: f64,
}

impl Course {
    pub fn new(s: f64, samples: &[Sample]) -> Course {
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

    pub fn rows(&self) -> Vec<CourseRow> {
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
pub fn solved(s: f64, horizon: f64) -> Result<Solution, Failure> {
    Ok(solve(Structure::Beam, s, &Settings { horizon, estimate_uncertainty: false, ..Settings::default() })?)
}

/// `count` numbers from `low` to `high` in equal ratios.
pub fn in_ratio(low: f64, high: f64, count: usize) -> Vec<f64> {
    let step = (high / low).ln() / count.saturating_sub(1).max(1) as f64;
    (0..count).map(|i| low * (step * i as f64).exp()).collect()
}
