//! Statistics of a distribution with their sampling errors, by equation (1).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::design::Draws;
use super::figure::{Estimate, mean, standard_deviation};
use super::indices::{SobolIndices, indices};

/// The orders of the reported quantiles.
pub(super) const SHARES: [f64; 7] = [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99];
/// Bars of the histogram.
const BARS: usize = 50;

/// A quantile and its sampling error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Quantile {
    /// The share of the draws below.
    pub share: f64,
    /// The output there.
    pub value: f64,
    /// Its standard error; null where some replicates have no such output.
    pub standard_error: Option<f64>,
}

/// Numbers of draws in intervals of equal width.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Histogram {
    /// Where the first interval begins.
    pub from: f64,
    /// Where the last one ends.
    pub to: f64,
    /// Draws in each.
    pub counts: Vec<u64>,
}

/// The distribution of an output for uncertain fields.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OutputDistribution {
    /// Scenes solved, of all replicates.
    pub draws: u64,
    /// Number of scenes that have the output.
    pub with_value: u64,
    /// Mean.
    pub mean: Estimate,
    /// Standard deviation.
    pub standard_deviation: Estimate,
    /// The interval that holds nine draws of ten: from the 5 % quantile to the 95 % one.
    pub width_90: Estimate,
    /// Quantiles in ascending order.
    pub quantiles: Vec<Quantile>,
    /// Numbers of draws between the least and the greatest value.
    pub histogram: Histogram,
    /// Indices of Sobol' by field, if they were requested, every draw has the output, and it varies.
    pub indices: Option<BTreeMap<String, SobolIndices>>,
}

impl OutputDistribution {
    /// Computes the statistics of an output from all draws by their number, with NaN if a draw has none; `None` if no draw has one.
    /// `fields` are those of the indices, if these are requested.
    pub(super) fn new(outputs: &[f64], draws: Draws, fields: Option<&[String]>) -> Option<OutputDistribution> {
        let replicate = |number: usize| number / draws.impacts as usize % draws.replicates as usize;
        let mut parts = vec![Vec::new(); draws.replicates as usize];
        for (number, value) in outputs.iter().enumerate().filter(|(_, value)| !value.is_nan()) {
            parts[replicate(number)].push(*value);
        }
        let mut all: Vec<f64> = parts.concat();
        all.sort_by(f64::total_cmp);
        parts.iter_mut().for_each(|part| part.sort_by(f64::total_cmp));
        let (from, to) = (*all.first()?, *all.last()?);
        let of = |figure: &dyn Fn(&[f64]) -> f64| Estimate::new(figure(&all), parts.iter().map(|part| figure(part)));
        let mut counts = vec![0; BARS];
        for value in &all {
            let place = (value - from) / (to - from) * BARS as f64;
            // a single value is in the first
            counts[(place as usize).min(BARS - 1)] += 1;
        }
        let quantiles = SHARES.map(|share| {
            let Estimate { value, standard_error } = of(&|part| quantile(part, share));
            Quantile { share, value, standard_error }
        });
        let complete = all.len() == outputs.len();
        Some(OutputDistribution {
            draws: outputs.len() as u64,
            with_value: all.len() as u64,
            mean: of(&mean),
            standard_deviation: of(&standard_deviation),
            width_90: of(&|part| quantile(part, 0.95) - quantile(part, 0.05)),
            quantiles: quantiles.to_vec(),
            histogram: Histogram { from, to, counts },
            indices: fields.filter(|_| complete).and_then(|fields| indices(outputs, draws, fields)),
        })
    }

    /// The largest standard error of the mean and the quantiles; infinite if one is not known.
    pub fn largest_error(&self) -> f64 {
        let errors = self.quantiles.iter().map(|quantile| quantile.standard_error).chain([self.mean.standard_error]);
        errors.map(|error| error.unwrap_or(f64::INFINITY)).fold(0.0, f64::max)
    }

    /// A reported quantile.
    pub(super) fn quantile(&self, share: f64) -> Option<&Quantile> {
        self.quantiles.iter().find(|quantile| quantile.share == share)
    }
}

/// Quantile of sorted values, with linear interpolation between neighbours; NaN if there are none.
pub(super) fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * sorted.len().saturating_sub(1) as f64;
    match sorted.get(place as usize..) {
        Some([low, high, ..]) => low + place.fract() * (high - low),
        Some([last]) => *last,
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::FieldPath;
    use crate::sweep::uncertain::{Distribution, Sampling, Sequence, Uncertain};

    /// The sum of two numbers, normal with standard deviations 0.6 and 0.8, which is standard normal.
    fn of_sum(sequence: Sequence, seed: u64) -> OutputDistribution {
        let field = |name: &str, sd| (FieldPath::parse(name).unwrap(), Distribution::Normal([0.0, sd]));
        let sampling = Sampling { seed, draws: 4096, sequence, replicates: 16, indices: false };
        let uncertain = Uncertain::new(vec![field("x", 0.6), field("y", 0.8)], sampling);
        let values: Vec<f64> = (0..4096).map(|number| uncertain.draw(number).iter().sum()).collect();
        OutputDistribution::new(&values, uncertain.draws(), None).unwrap()
    }

    #[test]
    fn stated_errors_cover_what_is_known_and_sobol_points_err_less() {
        let mut errors = Vec::new();
        for sequence in [Sequence::Sobol, Sequence::Random] {
            let (mut within, mut all, mut median_error) = (0, 0, 0.0);
            for seed in 0..100 {
                let found = of_sum(sequence, seed);
                for quantile in &found.quantiles[1..6] {
                    let known = Distribution::Normal([0.0, 1.0]).quantile(quantile.share);
                    all += 1;
                    // Student's 97.5 % quantile of 15 degrees of freedom
                    within += u32::from((quantile.value - known).abs() <= 2.131 * quantile.standard_error.unwrap());
                }
                median_error += found.quantile(0.5).unwrap().standard_error.unwrap() / 100.0;
            }
            // 95 % within three standard deviations of the binomial distribution, were the quantiles of one sample independent
            let share = f64::from(within) / f64::from(all);
            assert!((0.92..=0.98).contains(&share), "{sequence:?}: {share}");
            errors.push(median_error);
        }
        // plain Monte Carlo: sqrt(pi/2) / sqrt(4096)
        assert!((errors[1] / 0.0196 - 1.0).abs() < 0.1, "{errors:?}");
        assert!(errors[0] < 0.25 * errors[1], "{errors:?}");
    }

    #[test]
    fn what_has_no_output_is_left_out_of_the_figures() {
        let draws = Draws { impacts: 1, replicates: 2, groups: 4 };
        let values = [0.1, f64::NAN, 0.3, f64::NAN, 0.2, f64::NAN, 0.4, f64::NAN];
        let found = OutputDistribution::new(&values, draws, Some(&["x".to_owned()])).unwrap();
        assert_eq!((found.draws, found.with_value), (8, 4));
        assert!((found.mean.value - 0.25).abs() < 1e-15);
        // the second replicate has none
        assert_eq!((found.mean.standard_error, found.indices.as_ref()), (None, None));
        assert_eq!(found.largest_error(), f64::INFINITY);
        assert_eq!(OutputDistribution::new(&values[1..2], draws, None), None);
        let same = OutputDistribution::new(&[0.5; 8], draws, None).unwrap();
        assert_eq!((same.histogram.counts[0], same.largest_error(), same.width_90.value), (8, 0.0, 0.0));
    }
}
