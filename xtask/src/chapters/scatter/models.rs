//! Models of the distribution of a restitution, and their fits.
//!
//! Each model predicts a median `m` and a scale `s` for an impact. Its parameters `p` maximise the likelihood,
//!
//! ```text
//! min sum_i -ln f(e_i; m_i(p), s_i(p)),                                                     (1)
//! ```
//!
//! and are found by least squares with the residuals `r_i^2 = C - ln f(e_i)`, where the constant `C` is larger than the logarithm
//! of any density that occurs. The scale found in this way describes the misfit on the beams of the fit. It is too small for
//! another beam, for which the error of the median is larger. The parameters `q` of the scale are therefore fitted again to the
//! predictions of each beam `b` from the other beams: with `p_b` the parameters (1) of the median without beam `b`,
//!
//! ```text
//! min sum_b sum_{i in b} -ln f(e_i; m_i(p_b), s_i(q)).                                      (2)
//! ```

use crate::chapters::chapter7::laws::{Datum, LAWS, Law};
use emoc::Scatter;
use fitting::{FitError, Method, Parameter, Problem, Settings, fit};

/// `C` of the residuals.
const MOST_LOG_DENSITY: f64 = 12.0;
/// Nodes of the integral over the share of draws below, for the score by equation (2) of `scores.rs`.
const NODES: u32 = 200;

/// Prediction of a model for one impact.
pub(super) enum Predicted {
    /// Logistic distribution of the logarithm of the odds.
    Odds(Scatter),
    /// Logistic distribution of the restitution itself: median and scale.
    Plain(f64, f64),
}

impl Predicted {
    pub fn log_density(&self, e: f64) -> f64 {
        match self {
            Predicted::Odds(scatter) => scatter.log_density(e),
            Predicted::Plain(median, scale) => {
                let t = (e - median).abs() / scale;
                -t - 2.0 * (-t).exp().ln_1p() - scale.ln()
            }
        }
    }

    /// Quantile: the restitution, from 0 to 1, below which this share of the draws lies.
    pub fn quantile(&self, share: f64) -> f64 {
        match self {
            // the share is one from 0 to 1
            Predicted::Odds(scatter) => scatter.draw(share).unwrap_or(f64::NAN),
            Predicted::Plain(median, scale) => (median + scale * (share / (1.0 - share)).ln()).clamp(0.0, 1.0),
        }
    }

    /// Share of the draws below.
    pub fn below(&self, e: f64) -> f64 {
        match self {
            Predicted::Odds(scatter) => scatter.probability_below(e).unwrap_or(f64::NAN),
            Predicted::Plain(median, scale) => 1.0 / (1.0 + ((median - e) / scale).exp()),
        }
    }

    /// The continuous ranked probability score: twice the mean over all shares of the pinball loss.
    pub fn crps(&self, e: f64) -> f64 {
        let loss = |node: u32| {
            let share = (f64::from(node) + 0.5) / f64::from(NODES);
            let over = e - self.quantile(share);
            if over > 0.0 { share * over } else { (share - 1.0) * over }
        };
        2.0 * (0..NODES).map(loss).sum::<f64>() / f64::from(NODES)
    }
}

/// A parameter and its starting value.
type Sought = (&'static str, f64);

/// A model.
pub(super) struct Model {
    pub name: &'static str,
    pub parameters: &'static [Sought],
    /// Number of parameters of the median, which come first.
    of_median: usize,
    /// Whether the scale is fitted to beams left out (2) or to the misfit (1).
    of_beams_left_out: bool,
    predict: fn(&[f64], &Datum) -> Predicted,
}

const LAW: &Law = &LAWS[0];
const ATTACHED: &Law = &LAWS[3];

/// The first is that of `emoc::ScatteredLaw`.
pub(super) const MODELS: [Model; 6] = [
    Model {
        name: "law with its scatter",
        parameters: &[("mu0", 0.3), ("alpha0", 2.5), ("alpha1", 0.5), SINGLE, REPEATED, ONSET],
        of_median: 3,
        of_beams_left_out: true,
        predict: |p, d| odds((LAW.restitution)(&p[..3], d), &p[3..], d),
    },
    Model {
        name: "the same, scale of the misfit",
        parameters: &[("mu0", 0.3), ("alpha0", 2.5), ("alpha1", 0.5), SINGLE, REPEATED, ONSET],
        of_median: 3,
        of_beams_left_out: false,
        predict: |p, d| odds((LAW.restitution)(&p[..3], d), &p[3..], d),
    },
    Model {
        name: "chapter 7's law ± a constant",
        parameters: &[("mu0", 0.3), ("alpha0", 2.5), ("alpha1", 0.5), ("scale", 0.05)],
        of_median: 3,
        of_beams_left_out: true,
        predict: |p, d| Predicted::Plain((LAW.restitution)(&p[..3], d), p[3]),
    },
    Model {
        name: "constant",
        parameters: &[("odds", 0.5), ("scale", 0.5)],
        of_median: 1,
        of_beams_left_out: true,
        predict: |p, _| Predicted::Odds(scatter(p[0] / (1.0 + p[0]), p[1])),
    },
    Model {
        name: "regression on Z and S₁",
        parameters: &[("a", 1.1), ("c", 1.1), ("d", 0.02), ("k", 0.5), SINGLE, REPEATED, ONSET],
        of_median: 4,
        of_beams_left_out: true,
        predict: |p, d| {
            let (z, s1) = (d.impact.z, d.impact.s1);
            // the rebound after one contact, and the part that returns later
            let first = 1.0 / (1.0 + p[0] * z + p[1] * z * z);
            let later = p[2] * z + p[3] * s1;
            odds(first + (1.0 - first) * later / (1.0 + later), &p[4..], d)
        },
    },
    Model {
        name: "attached modes (knows frequencies)",
        parameters: &[("c", 1.0), ("q", 1.0), SINGLE, REPEATED, ONSET],
        of_median: 2,
        of_beams_left_out: true,
        predict: |p, d| odds((ATTACHED.restitution)(&p[..2], d), &p[2..], d),
    },
];

const SINGLE: Sought = ("single", 0.05);
const REPEATED: Sought = ("repeated", 0.25);
const ONSET: Sought = ("onset", 1.5);

fn scatter(median_share: f64, scale: f64) -> Scatter {
    Scatter { median_share, scale, notional_restitution: 1.0 }
}

/// With the scale of `emoc`, by its equation (3).
fn odds(median: f64, p: &[f64], datum: &Datum) -> Predicted {
    let x = (p[2] * datum.impact.z).powi(2);
    Predicted::Odds(scatter(median, p[0] + p[1] * x / (1.0 + x)))
}

impl Model {
    pub fn predict(&self, parameters: &[f64], datum: &Datum) -> Predicted {
        (self.predict)(parameters, datum)
    }

    /// Fits the parameters to these beams.
    pub fn fit(&self, beams: &[&[Datum]]) -> Result<Vec<f64>, FitError> {
        let starts: Vec<f64> = self.parameters.iter().map(|(_, start)| *start).collect();
        let all = self.most_likely(beams, &starts, 3)?;
        if !self.of_beams_left_out {
            return Ok(all);
        }
        let (median, scale) = all.split_at(self.of_median);
        let without = |k: usize| {
            let others: Vec<&[Datum]> =
                beams.iter().enumerate().filter(|(j, _)| *j != k).map(|(_, beam)| *beam).collect();
            self.most_likely(&others, &all, 1)
        };
        let medians = (0..beams.len()).map(without).collect::<Result<Vec<_>, FitError>>()?;
        let predicted = |q: &[f64]| -> Vec<f64> {
            let of_beam = |(p, beam): (&Vec<f64>, &&[Datum])| {
                let p = [&p[..self.of_median], q].concat();
                beam.iter().map(|datum| self.predict(&p, datum).log_density(datum.observed)).collect::<Vec<f64>>()
            };
            medians.iter().zip(beams).flat_map(of_beam).collect()
        };
        let found = largest(&self.parameters[self.of_median..], scale, 1, beams, &predicted)?;
        Ok([median, &found].concat())
    }

    /// By equation (1).
    fn most_likely(&self, beams: &[&[Datum]], begin: &[f64], starts: usize) -> Result<Vec<f64>, FitError> {
        let predicted = |p: &[f64]| -> Vec<f64> {
            let data = beams.iter().copied().flatten();
            data.map(|datum| self.predict(p, datum).log_density(datum.observed)).collect()
        };
        largest(self.parameters, begin, starts, beams, &predicted)
    }
}

/// The parameters that maximise the sum of the logarithms of the densities.
fn largest(
    parameters: &[Sought],
    begin: &[f64],
    starts: usize,
    beams: &[&[Datum]],
    log_densities: &(dyn Fn(&[f64]) -> Vec<f64> + Sync),
) -> Result<Vec<f64>, FitError> {
    let residuals = |p: &[f64], r: &mut [f64]| {
        for (r, log_density) in r.iter_mut().zip(log_densities(p)) {
            *r = (MOST_LOG_DENSITY - log_density).max(0.0).sqrt();
        }
    };
    let parameter = |((name, _), begin): (&Sought, &f64)| Parameter::positive(name, *begin, (0.3 * begin, 3.0 * begin));
    let problem = Problem {
        parameters: parameters.iter().zip(begin).map(parameter).collect(),
        count: beams.iter().map(|beam| beam.len()).sum(),
        residuals: &residuals,
        jacobian: None,
    };
    let settings = Settings { method: Method::Simplex, starts, tolerance: 1e-8, ..Settings::default() };
    Ok(fit(&problem, &settings)?.parameters)
}
