//! The net law with two parameters: fitted to impacts on random beams, and tested on beams left out of the fit.

use super::scenes::{self, ball, beam, hertz};
use contact_models::Law;
use fitting::{Method, Parameter, Problem, Settings, cross_validate, fit};
use serde::Serialize;
use serde_json::json;
use tasks::{Failure, Study};
use vibroimpact::Scene;
use vibroimpact::model::{VALIDATED, largest_share};
use vibroimpact::report::{Comparison, significant};

/// Number of beams, and of impacts on each; a quick run has fewer of both.
const BEAMS: (u64, u64) = (40, 8);
const IMPACTS: (usize, usize) = (25, 10);
/// Modes that the law sums over.
const MODES: usize = 120;
/// Tolerance of the restitutions to which the law is fitted.
const TOLERANCE: f64 = 3e-3;

/// Inputs of the law for one impact, and its restitution.
#[derive(Serialize)]
struct Datum {
    beam: u64,
    mass_ratio: f64,
    damping_ratio: f64,
    speed_m_s: f64,
    largest_share: f64,
    observed: f64,
    /// `(omega_k tau)^2` and `m phi_k^2`.
    #[serde(skip)]
    answers: Vec<[f64; 2]>,
}

impl Datum {
    fn restitution(&self, p: &[f64]) -> f64 {
        let z: f64 = self.answers.iter().map(|[x, weight]| weight * (-(p[0] * p[0] * x)).exp()).sum();
        let first = (-p[1] * z).exp();
        first + (1.0 - first) * self.largest_share
    }
}

/// The impacts on one random supported beam, without those that do not converge.
fn on_beam(number: u64, impacts: usize) -> Result<Vec<Datum>, Failure> {
    const HELD: [[&str; 2]; 6] = [
        ["clamped", "free"],
        ["pinned", "pinned"],
        ["clamped", "clamped"],
        ["clamped", "pinned"],
        ["clamped", "guided"],
        ["pinned", "guided"],
    ];
    let random = &mut scenes::random(1_000_000 + number);
    let damping_ratio = random.log(VALIDATED.damping_ratios[0], VALIDATED.damping_ratios[1]);
    let (structure, length, beam_mass) = beam(random, HELD[number as usize % HELD.len()], damping_ratio);
    let mut data = Vec::new();
    for _ in 0..impacts {
        let mass_ratio = random.log(VALIDATED.mass_ratios[0], VALIDATED.mass_ratios[1]);
        let speed_m_s = random.log(VALIDATED.speeds_m_s[0], VALIDATED.speeds_m_s[1]);
        let mass_kg = mass_ratio * beam_mass;
        let scene = Scene::from_value(&json!({ "structure": structure, "striker": ball(mass_kg, speed_m_s),
            "contact": hertz(), "location_m": length * random.share(), "model": "modal", "tolerance": TOLERANCE }))?;
        let choice = scene.choose()?;
        let Some((impact, observed)) = choice.impact.zip(choice.answer.restitution.filter(|_| choice.answer.settled))
        else {
            continue;
        };
        let Law::Hertz(law) = impact.law else { continue };
        // duration by Hertz: 2.9432 times the largest compression divided by the speed
        let compression_m = (1.25 * mass_kg * speed_m_s.powi(2) / law.stiffness_n_m1_5).powf(0.4);
        let duration_s = 2.9432 * compression_m / speed_m_s;
        let modes = scene.mode_shapes(MODES)?;
        data.push(Datum {
            beam: number,
            mass_ratio,
            damping_ratio,
            speed_m_s,
            largest_share: largest_share(mass_kg, &modes),
            observed,
            answers: modes.iter().map(|m| [(m.omega_rad_s * duration_s).powi(2), mass_kg * m.shape.powi(2)]).collect(),
        });
    }
    Ok(data)
}

pub(super) fn run(study: &mut Study) -> Result<(), Failure> {
    study.section("The net law");
    let (beams, impacts) = if study.quick { (BEAMS.1, IMPACTS.1) } else { (BEAMS.0, IMPACTS.0) };
    let numbers: Vec<u64> = (0..beams).collect();
    let data: Vec<Datum> =
        study.sweep(&numbers, impacts, |&number| on_beam(number, impacts))?.into_iter().flatten().collect();
    let labels: Vec<usize> = data.iter().map(|datum| datum.beam as usize).collect();
    let problem = Problem {
        parameters: ["c", "q"].map(|name| Parameter::positive(name, 1.0, (0.03, 30.0))).into(),
        count: data.len(),
        residuals: &|p, r| r.iter_mut().zip(&data).for_each(|(r, datum)| *r = datum.restitution(p) - datum.observed),
        jacobian: None,
    };
    let settings = Settings { method: Method::LevenbergMarquardt, tolerance: 1e-7, starts: 6, ..Settings::default() };
    let together = fit(&problem, &settings)?;
    let predicted = cross_validate(&problem, &settings, &labels)?.report;
    study.text(&format!(
        "{} converged impacts on {beams} beams with Hertz contact. One set of parameters for all: c = {}, q = {}, rms {}. \
         Each beam predicted by the fit to the others: rms {}, 95 of 100 within {}, largest {}. The choice uses the law \
         only where it is requested or the tolerance is no tighter than {}.",
        data.len(),
        significant(together.parameters[0], 4),
        significant(together.parameters[1], 4),
        significant(together.report.rms, 3),
        significant(predicted.rms, 3),
        significant(predicted.p95_abs, 3),
        significant(predicted.max_abs, 3),
        significant(VALIDATED.error_95, 3)
    ));
    study.csv("net-law.csv", &data)?;
    if !study.quick {
        let carried = [
            ("c", VALIDATED.c, 0.01, together.parameters[0]),
            ("q", VALIDATED.q, 0.01, together.parameters[1]),
            ("95 % error of a prediction", VALIDATED.error_95, 0.01, predicted.p95_abs),
            ("largest error of a prediction", VALIDATED.largest_error, 0.01, predicted.max_abs),
        ];
        for (what, value, tolerance, ours) in carried {
            let name = format!("net law: {what}");
            study.state(Comparison::about(
                name,
                "carried by the program",
                &significant(value, 3),
                value,
                tolerance,
                ours,
            ));
        }
    }
    Ok(())
}
