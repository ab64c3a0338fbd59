//! Statistics of a distribution with their sampling errors, by equations (1), (4) and (5).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::design::Draws;
use super::figure::{Estimate, mean, standard_deviation};
use super::indices::{SobolIndices, indices};

/// The orders of the reported quantiles.
pub(super) const SHARES: [f64; 7] = [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99];
/// Uncertainty of the share below a quantile between two draws, in draws, in equation (4).
const FRACTION_OF_A_DRAW: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Part of the interval of a quantile that a gap between neighbouring draws takes if the distribution jumps there.
const JUMP: f64 = 0.75;
/// Bars of the histogram.
const BARS: usize = 50;

/// A quantile and its sampling error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Quantile {
    /// The share of the draws below.
    pub share: f64,
    /// The output there.
    pub value: f64,
    /// Its standard error; null where some replicates have no such output, or where two standard errors of the share reach beyond
    /// all draws.
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
    /// Numbers of draws between the least and the greatest value. For outputs that are whole numbers, such as counts, the intervals
    /// are centred at whole numbers.
    pub histogram: Histogram,
    /// Indices of Sobol' by field; null if they were not requested, and for an output that does not vary beyond rounding errors.
    pub indices: Option<BTreeMap<String, SobolIndices>>,
    /// Number of groups of draws behind the indices: those in which every draw has the output. Null if no indices were requested.
    #[serde(default)]
    pub index_groups: Option<u64>,
    /// The requested standard error of the mean and of every quantile; null if none was requested.
    #[serde(default)]
    pub requested_error: Option<f64>,
    /// Whether the mean and every quantile have this standard error; null if none was requested.
    #[serde(default)]
    pub reached: Option<bool>,
}

impl OutputDistribution {
    /// Computes the statistics of an output from all draws by their number, with NaN if a draw has none; `None` if no draw has one.
    /// `fields` are those of the indices, if these are requested, and `requested_error` is that of the mean and the quantiles.
    pub(super) fn new(
        outputs: &[f64],
        draws: Draws,
        fields: Option<&[String]>,
        requested_error: Option<f64>,
    ) -> Option<OutputDistribution> {
        let replicate = |number: usize| number / draws.impacts as usize % draws.replicates as usize;
        let mut parts = vec![Vec::new(); draws.replicates as usize];
        for (number, value) in outputs.iter().enumerate().filter(|(_, value)| !value.is_nan()) {
            parts[replicate(number)].push(*value);
        }
        let mut all: Vec<f64> = parts.concat();
        all.sort_by(f64::total_cmp);
        parts.iter_mut().for_each(|part| part.sort_by(f64::total_cmp));
        all.first()?;
        let of = |figure: &dyn Fn(&[f64]) -> f64| Estimate::new(figure(&all), parts.iter().map(|part| figure(part)));
        let quantiles = SHARES.map(|share| Located::new(&all, &parts, share));
        let [_, low, .., high, _] = &quantiles;
        let width = high.quantile.value - low.quantile.value;
        let widths = Estimate::new(width, high.shifts().zip(low.shifts()).map(|(high, low)| high - low));
        // of equation (4), the scatter is that of both shares together
        let resolution = FRACTION_OF_A_DRAW * high.rate.hypot(low.rate) / all.len() as f64;
        let (indices, index_groups) = fields.map(|fields| indices(outputs, draws, fields)).unzip();
        let mut found = OutputDistribution {
            draws: outputs.len() as u64,
            with_value: all.len() as u64,
            mean: of(&mean),
            standard_deviation: of(&standard_deviation),
            width_90: Estimate {
                standard_error: widths.standard_error.map(|scatter| scatter.hypot(resolution)),
                ..widths
            },
            quantiles: quantiles.iter().map(|located| located.quantile).collect(),
            histogram: Histogram::of(&all),
            indices: indices.flatten(),
            index_groups,
            requested_error,
            reached: None,
        };
        found.reached = requested_error.map(|requested| found.largest_error() <= requested);
        Some(found)
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

impl Histogram {
    /// Of sorted values, at least one.
    fn of(sorted: &[f64]) -> Histogram {
        let (least, most) = (sorted[0], sorted[sorted.len() - 1]);
        let whole = most - least < 1e9 && sorted.iter().all(|value| value.fract() == 0.0);
        let (from, to, bars) = if whole {
            let span = most - least + 1.0;
            let width = (span / BARS as f64).ceil();
            let bars = (span / width).ceil();
            (least - 0.5, least - 0.5 + width * bars, bars as usize)
        } else {
            (least, most, BARS)
        };
        let mut counts = vec![0; bars];
        for value in sorted {
            // a single value is in the first
            let place = (value - from) / (to - from) * bars as f64;
            counts[(place as usize).min(bars - 1)] += 1;
        }
        Histogram { from, to, counts }
    }

    /// Whether the intervals are centred at whole numbers.
    pub(super) fn is_of_whole_numbers(&self) -> bool {
        let width = (self.to - self.from) / self.counts.len() as f64;
        width.fract() == 0.0 && (self.from - 0.5).fract() == 0.0
    }
}

/// A quantile of all draws, and how the shares of the replicates below it scatter.
struct Located {
    quantile: Quantile,
    /// For each replicate the share of its draws below the quantile.
    shares: Vec<f64>,
    /// Change of the quantile with this share, over the standard error of the share; NaN where that of the quantile is unknown.
    rate: f64,
}

impl Located {
    /// Of all draws and those of each replicate, sorted.
    fn new(all: &[f64], parts: &[Vec<f64>], share: f64) -> Located {
        let value = quantile(all, share);
        let estimate = |shares: &[f64]| Estimate::new(share, shares.iter().copied()).standard_error;
        let shares = |below: &dyn Fn(&f64) -> bool| -> Vec<f64> {
            parts.iter().map(|part| part.partition_point(below) as f64 / part.len() as f64).collect()
        };
        // where several draws are equal, the share below them scatters less or more than that up to them
        let both = [shares(&|draw| *draw < value), shares(&|draw| *draw <= value)];
        let [least, most] = both.map(|shares| (estimate(&shares), shares));
        let (scatter, shares) = if least.0 > most.0 { least } else { most };
        // equation (4)
        let error = scatter.map(|scatter| scatter.hypot(FRACTION_OF_A_DRAW / all.len() as f64));
        let standard_error =
            error.and_then(|error| of_interval(all, value, [share - 2.0 * error, share + 2.0 * error]));
        let rate = standard_error.zip(error).map_or(f64::NAN, |(of, error)| of / error);
        Located { quantile: Quantile { share, value, standard_error }, shares, rate }
    }

    /// The shifts of the quantile by the replicates, to first order and up to a constant.
    fn shifts(&self) -> impl Iterator<Item = f64> {
        self.shares.iter().map(|share| -self.rate * share)
    }
}

/// The standard error of a quantile that may have any share in an interval of 95 %, by equation (5); `None` where the interval reaches
/// beyond the draws, unless these do not differ.
fn of_interval(sorted: &[f64], value: f64, shares: [f64; 2]) -> Option<f64> {
    if sorted.first() == sorted.last() {
        return Some(0.0);
    }
    if !shares.iter().all(|share| (0.0..=1.0).contains(share)) {
        return None;
    }
    let [low, high] = shares.map(|share| quantile(sorted, share));
    let last = sorted.len() - 1;
    let [first, beyond] = [shares[0] * last as f64, (shares[1] * last as f64).ceil()].map(|place| place as usize);
    let gaps = sorted[first..=beyond.min(last)].windows(2).map(|pair| pair[1].min(high) - pair[0].max(low));
    let jumps = gaps.fold(0.0, f64::max) > JUMP * (high - low);
    Some(if jumps { 0.5 * (high - value).max(value - low) } else { 0.25 * (high - low) })
}

/// Quantile of sorted values, with linear interpolation between neighbours; NaN if there are none.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share.clamp(0.0, 1.0) * sorted.len().saturating_sub(1) as f64;
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
        OutputDistribution::new(&values, uncertain.draws(), None, None).unwrap()
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

    /// The stated error of the 99 % quantile against its actual one, where the density falls by a factor of forty at the quantile or
    /// next to it. The scatter of the quantiles of the replicates is half the error there.
    #[test]
    fn stated_errors_of_quantiles_hold_at_bends_of_the_distribution() {
        for bend in [0.985, 0.9895, 0.99, 0.9905] {
            let of = |u: f64| if u < bend { u } else { bend + 40.0 * (u - bend) };
            let (mut actual, mut stated) = (0.0, 0.0);
            for seed in 0..200 {
                let fields =
                    ["x", "y"].map(|name| (FieldPath::parse(name).unwrap(), Distribution::Uniform([0.0, 1.0])));
                let sampling =
                    Sampling { seed, draws: 4096, sequence: Sequence::Sobol, replicates: 16, indices: false };
                let uncertain = Uncertain::new(fields.to_vec(), sampling);
                // the share of the square below a line, which is uniform
                let below = |t: f64| if t < 1.0 { 0.5 * t * t } else { 1.0 - 0.5 * (2.0 - t).powi(2) };
                let values: Vec<f64> = (0..4096).map(|number| of(below(uncertain.draw(number).iter().sum()))).collect();
                let found = OutputDistribution::new(&values, uncertain.draws(), None, None).unwrap();
                let quantile = found.quantile(0.99).unwrap();
                actual += (quantile.value - of(0.99)).powi(2);
                stated += quantile.standard_error.unwrap().powi(2);
            }
            let ratio = (stated / actual).sqrt();
            assert!((0.9..1.7).contains(&ratio), "bend at {bend}: {ratio}");
        }
    }

    /// How often two standard errors hold the quantile, for outputs with known quantiles `Q(p)`: smooth in one field, where all
    /// replicates have the same share below a quartile, and in two, with a jump at the median, and discrete. A grazing contact makes such
    /// jumps.
    #[test]
    fn two_standard_errors_hold_the_quantile_for_any_number_of_draws() {
        // the share of the square below a line, which is uniform
        let below = |t: f64| if t < 1.0 { 0.5 * t * t } else { 1.0 - 0.5 * (2.0 - t).powi(2) };
        let sum = |of: fn(f64) -> f64| move |x: &[f64]| of(below(x[0] + x[1]));
        let jump = |u: f64| if u < 0.497 { u } else { u + 3.0 };
        let count = |u: f64| 1.0 + f64::from(u > 0.27) + f64::from(u > 0.502) + f64::from(u > 0.988);
        type Case<'a> = (&'a str, &'a dyn Fn(&[f64]) -> f64, fn(f64) -> f64);
        let outputs: [Case; 4] = [
            ("of one field", &|x| x[0], |u| u),
            ("smooth", &sum(|u| u), |u| u),
            ("jump", &sum(jump), jump),
            ("discrete", &sum(count), count),
        ];
        for (name, output, known) in outputs {
            for draws in [32, 64, 512, 4096] {
                let (mut within, mut all) = ([0; SHARES.len()], [0; SHARES.len()]);
                for seed in 0..150 {
                    let fields =
                        ["x", "y"].map(|name| (FieldPath::parse(name).unwrap(), Distribution::Uniform([0.0, 1.0])));
                    let sampling = Sampling { seed, draws, sequence: Sequence::Sobol, replicates: 16, indices: false };
                    let uncertain = Uncertain::new(fields.to_vec(), sampling);
                    let values: Vec<f64> = (0..draws).map(|number| output(&uncertain.draw(number))).collect();
                    let found = OutputDistribution::new(&values, uncertain.draws(), None, None).unwrap();
                    for (number, quantile) in found.quantiles.iter().enumerate() {
                        let Some(error) = quantile.standard_error else { continue };
                        all[number] += 1;
                        within[number] += u32::from((quantile.value - known(quantile.share)).abs() <= 2.0 * error);
                    }
                }
                // 88 % of 150 is two and a half standard deviations of the binomial distribution below 94 %
                for (number, share) in SHARES.iter().enumerate() {
                    assert!(
                        f64::from(within[number]) >= 0.88 * f64::from(all[number]),
                        "{name}, {draws} draws: {share}"
                    );
                }
                // from the fifth to the seventh figure of 32 draws the interval reaches beyond them
                assert!(all[2..5] == [150; 3] && (draws < 512 || all[1..6] == [150; 5]), "{name}: {all:?}");
            }
        }
    }

    #[test]
    fn histograms_of_whole_numbers_have_bars_at_whole_numbers() {
        let found = Histogram::of(&[2.0, 3.0, 3.0, 7.0]);
        assert_eq!((found.from, found.to, found.counts), (1.5, 7.5, vec![1, 2, 0, 0, 0, 1]));
        let many: Vec<f64> = (0..=120).map(f64::from).collect();
        let found = Histogram::of(&many);
        assert_eq!((found.from, found.to, found.counts.len(), found.counts[0]), (-0.5, 122.5, 41, 3));
        assert_eq!(Histogram::of(&[0.5, 1.0]).counts.len(), BARS);
    }

    #[test]
    fn what_has_no_output_is_left_out_of_the_figures() {
        let draws = Draws { impacts: 1, replicates: 2, groups: 4 };
        let values = [0.1, f64::NAN, 0.3, f64::NAN, 0.2, f64::NAN, 0.4, f64::NAN];
        let found = OutputDistribution::new(&values, draws, None, Some(0.1)).unwrap();
        assert_eq!((found.draws, found.with_value), (8, 4));
        assert!((found.mean.value - 0.25).abs() < 1e-15);
        // the second replicate has none
        assert_eq!((found.mean.standard_error, found.indices.as_ref()), (None, None));
        assert_eq!(found.largest_error(), f64::INFINITY);
        assert_eq!(found.reached, Some(false));
        assert_eq!(OutputDistribution::new(&values[1..2], draws, None, None), None);
        let same = OutputDistribution::new(&[0.5; 8], draws, None, Some(0.1)).unwrap();
        assert_eq!(same.reached, Some(true));
        assert_eq!((same.histogram.counts[0], same.largest_error(), same.width_90.value), (8, 0.0, 0.0));
    }
}
