//! Distributions of uncertain fields.

use puruspe::inverfc;
use schemars::JsonSchema;
use serde::Deserialize;

/// A distribution with its two numbers, the first of which is the lower end, the mean or the median.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Distribution {
    /// Uniform from the first number to the second, which is greater.
    Uniform([f64; 2]),
    /// Uniform in the logarithm; both numbers are positive.
    LogUniform([f64; 2]),
    /// Normal, by mean and standard deviation.
    Normal([f64; 2]),
    /// Lognormal, by the median and the standard deviation of the natural logarithm; both numbers are positive.
    Lognormal([f64; 2]),
}

impl Distribution {
    /// The error of the numbers, if there is one.
    pub(super) fn fault(&self) -> Option<&'static str> {
        let finite = |numbers: &[f64; 2]| numbers.iter().all(|number| number.is_finite());
        let (fits, allowed) = match self {
            Distribution::Uniform([a, b]) => (a < b, "stated by two finite numbers, the first below the second"),
            Distribution::LogUniform([a, b]) => {
                (0.0 < *a && a < b, "stated by two positive numbers, the first below the second")
            }
            Distribution::Normal([_, sd]) => (*sd > 0.0, "stated by a finite mean and a positive standard deviation"),
            Distribution::Lognormal([median, sd]) => (
                *median > 0.0 && *sd > 0.0,
                "stated by a positive median and a positive standard deviation of the logarithm",
            ),
        };
        let (Distribution::Uniform(n)
        | Distribution::LogUniform(n)
        | Distribution::Normal(n)
        | Distribution::Lognormal(n)) = self;
        (!(fits && finite(n))).then_some(allowed)
    }

    /// The value below which a share of all values lies, for a share strictly between 0 and 1.
    pub(super) fn quantile(&self, share: f64) -> f64 {
        match *self {
            // neither form can overflow within the interval
            Distribution::Uniform([a, b]) => a * (1.0 - share) + b * share,
            Distribution::LogUniform([a, b]) => a.powf(1.0 - share) * b.powf(share),
            Distribution::Normal([mean, sd]) => mean + sd * standard_normal(share),
            Distribution::Lognormal([median, sd]) => median * (sd * standard_normal(share)).exp(),
        }
    }

    /// Combines a drawn number with the value of a grid: added or, for a distribution of the logarithm, multiplied.
    pub(in crate::sweep) fn about(&self, value: f64, drawn: f64) -> f64 {
        match self {
            Distribution::Uniform(_) | Distribution::Normal(_) => value + drawn,
            Distribution::LogUniform(_) | Distribution::Lognormal(_) => value * drawn,
        }
    }

    /// Description of the distribution as text.
    pub(in crate::sweep) fn text(&self) -> String {
        match self {
            Distribution::Uniform([a, b]) => format!("uniform from {a} to {b}"),
            Distribution::LogUniform([a, b]) => format!("log-uniform from {a} to {b}"),
            Distribution::Normal([mean, sd]) => format!("normal, mean {mean}, standard deviation {sd}"),
            Distribution::Lognormal([median, sd]) => {
                format!("lognormal, median {median}, standard deviation of the logarithm {sd}")
            }
        }
    }
}

/// The quantile of the standard normal distribution.
fn standard_normal(share: f64) -> f64 {
    -std::f64::consts::SQRT_2 * inverfc(2.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        // Abramowitz and Stegun, table 26.5
        for (share, x) in
            [(0.5, 0.0), (0.975, 1.959_963_984_540), (0.999, 3.090_232_306_168), (0.1, -1.281_551_565_545)]
        {
            let found = Distribution::Normal([2.0, 3.0]).quantile(share);
            assert!((found - (2.0 + 3.0 * x)).abs() < 1e-10, "{found}");
            let found = Distribution::Lognormal([2.0, 0.1]).quantile(share);
            assert!((found / (2.0 * (0.1f64 * x).exp()) - 1.0).abs() < 1e-11, "{found}");
        }
        assert_eq!(Distribution::Uniform([-1.0, 3.0]).quantile(0.25), 0.0);
        assert!((Distribution::LogUniform([0.01, 1.0]).quantile(0.25) / 10f64.powf(-1.5) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_ends_of_the_sequence_are_finite() {
        for share in [0.5f64.powi(53), 1.0 - 0.5f64.powi(53)] {
            let x = Distribution::Normal([0.0, 1.0]).quantile(share);
            assert!((8.0..8.4).contains(&x.abs()), "{x}");
        }
    }
}
