//! Gain of a control variate from derivatives over plain draws of uncertain fields: the ratio of the standard errors of a
//! statistic without and with the control.
//!
//! The restitution `e` of a draw with the standard normal numbers `z` is compared with a polynomial `m(z)`. Mean and quantiles of
//! the polynomial are known exactly, so only the difference would have to be estimated by draws. The polynomial is the best fit
//! to the draws, found by projection on Hermite polynomials, which are orthogonal for normal `z`. A polynomial from derivatives
//! at one point cannot fit better. A statistic `f` of the draws in a replicate is then controlled by the same statistic `g` of
//! the polynomial: `f - b g` with the best `b`. This divides the standard deviation over the replicates by `1/sqrt(1 - r^2)`,
//! where `r` is the correlation of `f` and `g`.

use std::fs;
use std::path::PathBuf;

use rayon::prelude::*;
use serde_json::json;
use vibroimpact::assembly::AnyScene;
use vibroimpact::sweep::Sweep;

use tasks::{BadInput, Failure, Progress};

/// Radius (m) of the ball and uncertainty of its speed. The smallest ball has one contact, the others have several.
const BALLS: [(f64, f64); 3] = [(0.004, 0.01), (0.0124, 0.05), (0.015, 0.01)];
const SEQUENCES: [&str; 2] = ["sobol", "random"];
const LOCATION_M: [f64; 2] = [0.618_033_988_749_894_9, 0.001];
const DRAWS: usize = 16_384;
const REPLICATES: usize = 32;
/// Terms of the linear model among those of the quadratic one.
const LINEAR: usize = 2;
const SHARES: [f64; 3] = [0.05, 0.5, 0.95];

/// Options of the study of controls.
#[derive(clap::Args)]
pub struct Wanted {
    /// Number of draws of each impact; a power of two and at least 2,048
    #[arg(long, value_name = "COUNT", default_value_t = DRAWS)]
    draws: usize,
    /// The folder to write to
    #[arg(long, value_name = "DIR", default_value = "out/study-control")]
    out: PathBuf,
}

/// Runs the study and returns its table.
pub fn run(wanted: &Wanted) -> Result<String, Failure> {
    if !wanted.draws.is_power_of_two() || wanted.draws < 2048 {
        let fault = format!("--draws {} is not allowed; it must be a power of two of at least 2048", wanted.draws);
        return Err(BadInput(fault).into());
    }
    let mut table = "| ball, radius | contacts | draws | standard error of the mean | gain, linear | gain, quadratic | gain for 5, 50, 95 % \
                     quantiles, linear |\n|---|---|---|---|---|---|---|\n"
        .to_owned();
    let mut progress = Progress::of("impacts");
    progress.begin("", (BALLS.len() * SEQUENCES.len() * wanted.draws) as u64, 0);
    for (radius_m, blur) in BALLS {
        for sequence in SEQUENCES {
            let draws = draws(radius_m, blur, sequence, wanted.draws, &progress)?;
            table += &row(radius_m, sequence, &draws);
        }
    }
    progress.finish();
    fs::create_dir_all(&wanted.out)?;
    fs::write(wanted.out.join("table.md"), &table)?;
    Ok(table)
}

/// Restitution and number of contacts of a draw, and the terms of the model.
struct Draw {
    restitution: f64,
    contacts: usize,
    terms: [f64; 5],
}

/// Draws of the impact of chapter 3 with 40 modes and this ball. Successive draws belong to successive replicates.
fn draws(radius_m: f64, blur: f64, sequence: &str, count: usize, progress: &Progress) -> Result<Vec<Draw>, Failure> {
    let side = 0.011323;
    let sweep = json!({
        "scene": {
            "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.02,
                "segments": [{ "length_m": 1, "youngs_modulus_pa": 2e11, "density_kg_m3": 7800, "width_m": side, "thickness_m": side }] },
            "striker": { "density_kg_m3": 7800, "radius_m": radius_m, "speed_m_s": 1 },
            "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 },
            "location_m": LOCATION_M[0], "modes": 40
        },
        "uncertain": { "location_m": { "normal": LOCATION_M }, "striker.speed_m_s": { "lognormal": [1, blur] } },
        "sampling": { "draws": count, "replicates": REPLICATES, "sequence": sequence }
    });
    let sweep = Sweep::from_value(&sweep)?;
    let draw = |number: u64| {
        let values = sweep.values(number);
        let [location_m, speed_m_s] = [0, 1].map(|i| values[i].as_f64().unwrap_or(f64::NAN));
        let AnyScene::Impact(scene) = sweep.scene(number).map_err(|fault| fault.to_string())? else {
            return Err("a scene of one impact".to_owned());
        };
        let found = scene.impact().and_then(|impact| impact.solve()).map_err(|fault| fault.to_string())?;
        progress.add(1);
        let [x, y] = [(location_m - LOCATION_M[0]) / LOCATION_M[1], speed_m_s.ln() / blur];
        Ok(Draw {
            restitution: found.restitution.ok_or("no rebound")?,
            contacts: found.sub_impacts.len(),
            terms: [x, y, x * y, (x * x - 1.0) / 2f64.sqrt(), (y * y - 1.0) / 2f64.sqrt()],
        })
    };
    Ok((0..count as u64).into_par_iter().map(draw).collect::<Result<_, String>>()?)
}

fn row(radius_m: f64, sequence: &str, draws: &[Draw]) -> String {
    let restitutions: Vec<f64> = draws.iter().map(|draw| draw.restitution).collect();
    let centre = mean(&restitutions);
    let model = |terms: usize| -> Vec<f64> {
        // the mean is subtracted, since its product with the scatter of a term would hide a small slope
        let product = |k: usize, draw: &Draw| draw.terms[k] * (draw.restitution - centre);
        let project = |k: usize| draws.iter().map(|draw| product(k, draw)).sum::<f64>() / draws.len() as f64;
        let weights: Vec<f64> = (0..terms).map(project).collect();
        draws.iter().map(|draw| weights.iter().zip(&draw.terms).map(|(weight, term)| weight * term).sum()).collect()
    };
    let (linear, quadratic) = (model(LINEAR), model(5));
    let means = by_replicate(&restitutions, mean);
    let gain_of = |of: &[f64], figure: &dyn Fn(&[f64]) -> f64| {
        gain(&by_replicate(&restitutions, figure), &by_replicate(of, figure))
    };
    let at_shares = SHARES.map(|share| format!("{:.2}", gain_of(&linear, &|values| quantile(values, share))));
    let contacts = draws.iter().map(|draw| draw.contacts);
    let (least, most) = (contacts.clone().min().unwrap_or(0), contacts.max().unwrap_or(0));
    let contacts = if least == most { least.to_string() } else { format!("{least} to {most}") };
    let name = if sequence == "sobol" { "Sobol'" } else { sequence };
    format!(
        "| {} mm | {contacts} | {name} | {:.1e} | {:.2} | {:.2} | {} |\n",
        1e3 * radius_m,
        variance(&means).sqrt() / (REPLICATES as f64).sqrt(),
        gain_of(&linear, &mean),
        gain_of(&quadratic, &mean),
        at_shares.join(", "),
    )
}

/// A statistic of the draws of each replicate.
fn by_replicate(values: &[f64], figure: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    let of = |first: usize| values.iter().skip(first).step_by(REPLICATES).copied().collect::<Vec<f64>>();
    (0..REPLICATES).map(|first| figure(&of(first))).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[((share * sorted.len() as f64) as usize).min(sorted.len() - 1)]
}

fn variance(values: &[f64]) -> f64 {
    let centre = mean(values);
    values.iter().map(|value| (value - centre).powi(2)).sum::<f64>() / (values.len() - 1) as f64
}

/// `1/sqrt(1 - r^2)`, where `r` is the correlation of a statistic and its control. It is corrected for the two degrees of
/// freedom of `b` and of the mean.
fn gain(figure: &[f64], control: &[f64]) -> f64 {
    let (f, g) = (mean(figure), mean(control));
    let joint = figure.iter().zip(control).map(|(a, b)| (a - f) * (b - g)).sum::<f64>();
    let count = figure.len() as f64;
    let own = variance(control) * (count - 1.0);
    let explained = if own > 0.0 { joint * joint / own } else { 0.0 };
    let left = (variance(figure) * (count - 1.0) - explained) / (count - 2.0);
    (variance(figure) / left).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The gain is about ten for a statistic that equals its control plus noise of a tenth, and one for an unrelated statistic.
    #[test]
    fn the_gain_is_that_of_the_correlation() {
        let wave = |k: usize, turn: f64| (k as f64 * turn).sin();
        let control: Vec<f64> = (0..3200).map(|k| wave(k, 1.0)).collect();
        let figure: Vec<f64> = (0..3200).map(|k| 3.0 + 2.0 * wave(k, 1.0) + 0.2 * wave(k, 2.7)).collect();
        let other: Vec<f64> = (0..3200).map(|k| wave(k, 2.7)).collect();
        assert!((gain(&figure, &control) - 101f64.sqrt()).abs() < 0.1);
        assert!((gain(&other, &control) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_ball_that_touches_once_gains_by_its_derivatives() {
        let draws = draws(BALLS[0].0, BALLS[0].1, "random", 512, &Progress::of("impacts")).unwrap();
        assert!(draws.iter().all(|draw| draw.contacts == 1));
        let row = row(BALLS[0].0, "random", &draws);
        let gain: f64 = row.split('|').nth(5).unwrap().trim().parse().unwrap();
        assert!(gain > 5.0, "{row}");
    }
}
