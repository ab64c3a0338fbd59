//! Models of the distribution of a restitution, beside each other, and their fits.
//!
//! Each has a median `m` and a scale `s` for an impact. Parameters `p` are those of the largest likelihood,
//!
//! ```text
//! min sum_i -ln f(e_i; m_i(p), s_i(p)),                                                     (1)
//! ```
//!
//! which the search for least squares finds with residuals `r_i^2 = C - ln f(e_i)`: the constant `C` is larger than any
//! logarithm of a density that occurs.

use crate::chapters::chapter7::laws::{Datum, LAWS, Law};
use emoc::Scatter;
use fitting::{FitError, Method, Parameter, Problem, Settings, fit};

/// `C` of the residuals.
const MOST_LOG_DENSITY: f64 = 12.0;
/// Nodes of the integral over the share of draws below, for the score by equation (2) of `scores.rs`.
const NODES: u32 = 200;

/// What a model predicts for one impact.
pub(super) enum Predicted {
    /// Logistic in the logarithm of the odds.
    Odds(Scatter),
    /// Logistic in the restitution itself: median and scale.
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

    /// The restitution below which a share of the draws lies, within 0 and 1.
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

/// A parameter with the value from which it is sought.
type Sought = (&'static str, f64);

/// A model.
pub(super) struct Model {
    pub name: &'static str,
    pub parameters: &'static [Sought],
    predict: fn(&[f64], &Datum) -> Predicted,
}

const LAW: &Law = &LAWS[0];
const ATTACHED: &Law = &LAWS[3];

/// The first is that of `emoc::ScatteredLaw`.
pub(super) const MODELS: [Model; 5] = [
    Model {
        name: "law with its scatter",
        parameters: &[("mu0", 0.3), ("alpha0", 2.5), ("alpha1", 0.5), SINGLE, REPEATED, ONSET],
        predict: |p, d| odds((LAW.restitution)(&p[..3], d), &p[3..], d),
    },
    Model {
        name: "chapter 7's law ± a constant",
        parameters: &[("mu0", 0.3), ("alpha0", 2.5), ("alpha1", 0.5), ("scale", 0.05)],
        predict: |p, d| Predicted::Plain((LAW.restitution)(&p[..3], d), p[3]),
    },
    Model {
        name: "constant",
        parameters: &[("odds", 0.5), ("scale", 0.5)],
        predict: |p, _| Predicted::Odds(scatter(p[0] / (1.0 + p[0]), p[1])),
    },
    Model {
        name: "regression on Z and S₁",
        parameters: &[("a", 1.1), ("c", 1.1), ("d", 0.02), ("k", 0.5), SINGLE, REPEATED, ONSET],
        predict: |p, d| {
            let (z, s1) = (d.impact.z, d.impact.s1);
            // one contact, and what comes back later
            let first = 1.0 / (1.0 + p[0] * z + p[1] * z * z);
            let later = p[2] * z + p[3] * s1;
            odds(first + (1.0 - first) * later / (1.0 + later), &p[4..], d)
        },
    },
    Model {
        name: "attached modes (knows frequencies)",
        parameters: &[("c", 1.0), ("q", 1.0), SINGLE, REPEATED, ONSET],
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

    /// The parameters of the largest likelihood.
    pub fn fit(&self, data: &[&Datum]) -> Result<Vec<f64>, FitError> {
        let residuals = |p: &[f64], r: &mut [f64]| {
            for (r, datum) in r.iter_mut().zip(data) {
                *r = (MOST_LOG_DENSITY - self.predict(p, datum).log_density(datum.observed)).max(0.0).sqrt();
            }
        };
        let parameter = |(name, start): &Sought| Parameter::positive(name, *start, (0.3 * start, 3.0 * start));
        let problem = Problem {
            parameters: self.parameters.iter().map(parameter).collect(),
            count: data.len(),
            residuals: &residuals,
            jacobian: None,
        };
        let settings = Settings { method: Method::Simplex, starts: 3, tolerance: 1e-8, ..Settings::default() };
        Ok(fit(&problem, &settings)?.parameters)
    }
}
