//! A statistic of a distribution with its sampling error, by equation (1).

use serde::{Deserialize, Serialize};

/// A statistic and its sampling error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The statistic, from all draws.
    pub value: f64,
    /// Its standard error, from the scatter over the replicates; null if some replicates do not have it.
    pub standard_error: Option<f64>,
}

impl Estimate {
    /// From the statistic of all draws and those of the replicates.
    pub(super) fn new(value: f64, replicates: impl Iterator<Item = f64>) -> Estimate {
        let found: Vec<f64> = replicates.collect();
        let squared = standard_deviation(&found).powi(2) / (found.len() as f64 - 1.0);
        Estimate { value, standard_error: Some(squared.sqrt()).filter(|error| error.is_finite()) }
    }
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

pub(super) fn standard_deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}
