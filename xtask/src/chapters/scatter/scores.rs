//! Scores of the predictions for a beam that was left out.
//!
//! ```text
//! log score = -ln f(e),                                                                     (1)
//! CRPS = 2 int_0^1 (e - q(p)) (p - [e < q(p)]) dp                                           (2)
//! ```
//!
//! Both scores are proper: their means are smallest for the true distribution (Gneiting and Raftery 2007). The first one is a
//! measure of information. The second one has the unit of the restitution; for a prediction without scatter it is the absolute
//! error.

use super::models::Model;
use crate::chapters::chapter7::laws::Datum;
use tasks::Failure;

/// Levels of the intervals whose coverage is reported.
pub(super) const LEVELS: [f64; 3] = [0.5, 0.8, 0.95];

/// Scores for one beam, predicted by the fit to the others.
pub(super) struct LeftOut {
    pub parameters: Vec<f64>,
    pub count: usize,
    /// Means.
    pub log_score: f64,
    pub crps: f64,
    /// Root mean square difference of median and restitution.
    pub rms: f64,
    /// Share of the restitutions within each of [`LEVELS`].
    pub coverage: [f64; LEVELS.len()],
    /// Mean width of the widest interval.
    pub width: f64,
}

/// A model fitted to all beams, and with each beam left out in turn.
pub(super) struct Evidence {
    pub model: &'static Model,
    pub together: Vec<f64>,
    pub left_out: Vec<LeftOut>,
}

impl Evidence {
    pub fn new(model: &'static Model, beams: &[Vec<Datum>]) -> Result<Evidence, Failure> {
        let without = |out: usize| -> Vec<&[Datum]> {
            beams.iter().enumerate().filter(|(k, _)| *k != out).map(|(_, beam)| beam.as_slice()).collect()
        };
        let left_out = (0..beams.len())
            .map(|k| Ok(LeftOut::new(model, model.fit(&without(k))?, &beams[k])))
            .collect::<Result<Vec<_>, Failure>>()?;
        Ok(Evidence { model, together: model.fit(&without(beams.len()))?, left_out })
    }

    /// The mean of a score over all impacts of all beams.
    pub fn mean(&self, figure: impl Fn(&LeftOut) -> f64) -> f64 {
        let count: usize = self.left_out.iter().map(|beam| beam.count).sum();
        self.left_out.iter().map(|beam| beam.count as f64 * figure(beam)).sum::<f64>() / count as f64
    }
}

impl LeftOut {
    fn new(model: &Model, parameters: Vec<f64>, beam: &[Datum]) -> LeftOut {
        let mean = |figure: &dyn Fn(&Datum) -> f64| beam.iter().map(figure).sum::<f64>() / beam.len() as f64;
        let at = |datum: &Datum| model.predict(&parameters, datum);
        let within = |level: f64| {
            mean(&|datum| {
                let tail = 0.5 * (1.0 - level);
                f64::from(u8::from((tail..=1.0 - tail).contains(&at(datum).below(datum.observed))))
            })
        };
        LeftOut {
            count: beam.len(),
            log_score: mean(&|datum| -at(datum).log_density(datum.observed)),
            crps: mean(&|datum| at(datum).crps(datum.observed)),
            rms: mean(&|datum| (at(datum).quantile(0.5) - datum.observed).powi(2)).sqrt(),
            coverage: LEVELS.map(within),
            width: mean(&|datum| at(datum).quantile(0.975) - at(datum).quantile(0.025)),
            parameters,
        }
    }
}
