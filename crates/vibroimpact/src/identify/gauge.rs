//! Force histories, and the response of a gauge to a contact force.

use contact_models::Law;
use fitting::chi_square_tail;
use invalid_input::InvalidInput;
use vibroimpact_sim::modal::History;

use crate::export::HISTORY;
use crate::input::{Row, Table};
use crate::scene::json::number;

/// Column of a table of measurements with the names of the files of force histories.
pub(super) const FORCE_FILE: &str = "force_file";
/// The name of the measured force, in whose column of standard deviations its noise is stated.
pub(super) const FORCE: &str = "force_n";
/// Ending of the names of columns of standard deviations.
pub(super) const SD: &str = "_sd";

/// Most samples of a history, and least.
const MOST: usize = 100_000;
const LEAST: usize = 8;
/// Equal intervals in which the computed force is tabulated.
const INTERVALS: usize = 2000;
/// Number of shifts that are tried for the offset, and number of samples used.
const SHIFTS: usize = 1000;
const COARSE_SAMPLES: usize = 300;
/// Steps of Newton's method for the offset, and the change, as a share of the contact, at which it ends.
const MOST_STEPS: usize = 30;
const SETTLED: f64 = 1e-10;
const NEEDED: &str = "a table of comma-separated values with the columns time_s and force_n";

/// The force of an impact as recorded by a gauge.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceRecord {
    /// Name of the file.
    pub file: String,
    /// Times (s), ascending, from any origin.
    pub time_s: Vec<f64>,
    /// Forces (N).
    pub force_n: Vec<f64>,
}

impl ForceRecord {
    /// Reads a history from the bytes of a file.
    ///
    /// # Errors
    /// Missing or further columns, times that are not ascending, too few samples or too many.
    ///
    /// ```
    /// use vibroimpact::identify::ForceRecord;
    /// let fault = ForceRecord::parse("f.csv", b"time_s,force_n\n0,1\n0,2\n").unwrap_err();
    /// assert!(fault.to_string().starts_with("f.csv, line 3, time_s = 0.0 is not allowed"));
    /// ```
    pub fn parse(file: &str, bytes: &[u8]) -> Result<ForceRecord, InvalidInput> {
        let read = || -> Result<ForceRecord, InvalidInput> {
            let table = Table::parse(bytes, NEEDED)?;
            // a column that is passed over, such as one of standard deviations, would be taken for one that counts
            if let Some(other) = table.header.iter().find(|name| HISTORY.iter().all(|(known, _)| known != name)) {
                let known = HISTORY.map(|(name, _)| name).join(", ");
                let allowed = format!(
                    "left out: a force history has the columns time_s and {FORCE}, beside which only those of the \
                     history.csv of simulate are allowed ({known}); its noise is stated in the column {FORCE}{SD} beside \
                     {FORCE_FILE} in the table of measurements"
                );
                return Err(InvalidInput::new(format!("column {other}"), "1 column", allowed));
            }
            let column = |name: &str| -> Result<Vec<f64>, InvalidInput> {
                let place = table.needed_column(name, NEEDED)?;
                table.rows.iter().map(|row: &Row| row.number(place, name)).collect()
            };
            let (time_s, force_n) = (column("time_s")?, column(FORCE)?);
            if let Some(i) = (1..time_s.len()).find(|&i| time_s[i] <= time_s[i - 1]) {
                let fault = InvalidInput::new("time_s", number(time_s[i]), "a time after that of the line above");
                return Err(table.rows[i].fault(fault));
            }
            if !(LEAST..=MOST).contains(&time_s.len()) {
                let allowed = format!("a number from {LEAST} to {MOST}");
                return Err(InvalidInput::new("number of samples", time_s.len().to_string(), allowed));
            }
            Ok(ForceRecord { file: file.to_owned(), time_s, force_n })
        };
        read().map_err(|fault| fault.in_place(file))
    }

    /// The offset `d` (s) for which the computed output, `signal(t - d)`, is closest to the record: the best of many shifts,
    /// improved by the Gauss-Newton method.
    pub(super) fn offset_s(&self, signal: &Signal) -> f64 {
        let (first, last) = (self.time_s[0], self.time_s[self.time_s.len() - 1]);
        let stride = self.time_s.len().div_ceil(COARSE_SAMPLES);
        let misfit = |offset: f64, stride: usize| -> f64 {
            let samples = self.time_s.iter().zip(&self.force_n).step_by(stride);
            samples.map(|(t, force)| (signal.at(t - offset) - force).powi(2)).sum()
        };
        let (low, high) = (first - signal.end_s(), last);
        let coarse = (0..=SHIFTS).map(|k| low + (high - low) * k as f64 / SHIFTS as f64);
        let nearest = coarse.map(|offset| (misfit(offset, stride), offset)).min_by(|a, b| a.0.total_cmp(&b.0));
        let mut offset = nearest.map_or(low, |(_, offset)| offset);
        let mut value = misfit(offset, 1);
        for _ in 0..MOST_STEPS {
            let (mut slope, mut curvature) = (0.0, 0.0);
            for (t, force) in self.time_s.iter().zip(&self.force_n) {
                let rate = -signal.rate_at(t - offset);
                slope += rate * (signal.at(t - offset) - force);
                curvature += rate * rate;
            }
            let mut step = if curvature > 0.0 { -slope / curvature } else { 0.0 };
            // halve the step until the misfit falls
            while step.abs() > SETTLED * signal.end_s() {
                let there = misfit(offset + step, 1);
                if there < value {
                    (offset, value) = (offset + step, there);
                    break;
                }
                step *= 0.5;
            }
            if step.abs() <= SETTLED * signal.end_s() {
                break;
            }
        }
        offset
    }
}

/// Tabulated response of a gauge to a force: Eq. (2) without offset and noise.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Signal {
    spacing_s: f64,
    values: Vec<f64>,
    /// Time constant of the decay after the last separation (s).
    time_constant_s: f64,
}

impl Signal {
    /// Computes the response from the history of an impact; a time constant of 0 is a gauge without delay.
    pub fn new(history: &History<Law>, time_constant_s: f64) -> Signal {
        let spacing_s = history.duration_s().max(f64::MIN_POSITIVE) / INTERVALS as f64;
        let force: Vec<f64> = (0..=INTERVALS).map(|k| history.at(spacing_s * k as f64).force_n).collect();
        Signal { spacing_s, values: filtered(force, spacing_s, time_constant_s), time_constant_s }
    }

    /// Time of the last separation (s).
    pub fn end_s(&self) -> f64 {
        self.spacing_s * INTERVALS as f64
    }

    /// The output at a time (N), by cubic interpolation.
    pub fn at(&self, time_s: f64) -> f64 {
        self.cubic(time_s, |w| {
            [
                -w * (w - 1.0) * (w - 2.0) / 6.0,
                (w + 1.0) * (w - 1.0) * (w - 2.0) / 2.0,
                -(w + 1.0) * w * (w - 2.0) / 2.0,
                (w + 1.0) * w * (w - 1.0) / 6.0,
            ]
        })
    }

    /// Its rate (N/s).
    pub fn rate_at(&self, time_s: f64) -> f64 {
        if time_s >= self.end_s() {
            return if self.time_constant_s > 0.0 { -self.at(time_s) / self.time_constant_s } else { 0.0 };
        }
        self.cubic(time_s, |w| {
            [
                -(3.0 * w * w - 6.0 * w + 2.0) / 6.0,
                (3.0 * w * w - 4.0 * w - 1.0) / 2.0,
                -(3.0 * w * w - 2.0 * w - 2.0) / 2.0,
                (3.0 * w * w - 1.0) / 6.0,
            ]
        }) / self.spacing_s
    }

    /// Lagrange's polynomial through the four points about a time, by its weights at the share `w` of the interval.
    fn cubic(&self, time_s: f64, weights: impl Fn(f64) -> [f64; 4]) -> f64 {
        if time_s <= 0.0 || time_s.is_nan() {
            return 0.0;
        }
        if time_s >= self.end_s() {
            let decayed = (-(time_s - self.end_s()) / self.time_constant_s).exp();
            return if self.time_constant_s > 0.0 { self.values[INTERVALS] * decayed } else { 0.0 };
        }
        let place = ((time_s / self.spacing_s) as usize).clamp(1, INTERVALS - 2);
        let w = time_s / self.spacing_s - place as f64;
        weights(w).iter().zip(&self.values[place - 1..]).map(|(weight, value)| weight * value).sum()
    }
}

/// The response `f` of `T f' + f = F`, exactly for a force that is linear between its samples.
fn filtered(force: Vec<f64>, spacing_s: f64, time_constant_s: f64) -> Vec<f64> {
    if time_constant_s <= 0.0 {
        return force;
    }
    let x = spacing_s / time_constant_s;
    let decay = (-x).exp();
    // (1 - e^-x)/x, whose difference from 1 is the weight of the newer sample
    let mean = -(-x).exp_m1() / x;
    let mut shown = Vec::with_capacity(force.len());
    let mut value = 0.0;
    shown.push(value);
    for pair in force.windows(2) {
        value = decay * value + pair[0] * (mean - decay) + pair[1] * (1.0 - mean);
        shown.push(value);
    }
    shown
}

/// Correlation of neighbouring residuals, and the probability that white noise has one as large. Residuals of a wrong model are
/// correlated with their neighbours.
pub(super) fn lag_one(residuals: &[f64]) -> (f64, f64) {
    let squares: f64 = residuals.iter().map(|r| r * r).sum();
    let products: f64 = residuals.windows(2).map(|pair| pair[0] * pair[1]).sum();
    let correlation = if squares > 0.0 { products / squares } else { 0.0 };
    (correlation, chi_square_tail(residuals.len() as f64 * correlation * correlation, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A half sine of 1 ms.
    fn half_sine(time_constant_s: f64) -> Signal {
        let spacing_s = 1e-3 / INTERVALS as f64;
        let force = (0..=INTERVALS).map(|k| (std::f64::consts::PI * k as f64 / INTERVALS as f64).sin()).collect();
        Signal { spacing_s, values: filtered(force, spacing_s, time_constant_s), time_constant_s }
    }

    #[test]
    fn the_filter_is_the_solution_of_its_equation() {
        // T f' + f = sin(w t), f(0) = 0, in closed form
        let (t_c, w) = (3e-4, std::f64::consts::PI / 1e-3);
        let exact =
            |t: f64| ((w * t).sin() - w * t_c * (w * t).cos() + w * t_c * (-t / t_c).exp()) / (1.0 + (w * t_c).powi(2));
        let signal = half_sine(t_c);
        for k in 1..50 {
            let t = 2e-5 * f64::from(k);
            assert!((signal.at(t) - exact(t)).abs() < 1e-6, "{t}");
            let slope = (exact(t + 1e-8) - exact(t - 1e-8)) / 2e-8;
            assert!((signal.rate_at(t) - slope).abs() < 1e-4 / t_c, "{t}");
        }
        assert!((signal.at(2e-3) - exact(1e-3) * (-1e-3 / t_c).exp()).abs() < 1e-6);
    }

    #[test]
    fn an_offset_is_found_from_anywhere() {
        let signal = half_sine(2e-5);
        for offset in [-0.7, 0.0, 3.1e-4, 12.0] {
            let time_s: Vec<f64> = (0..400).map(|k| offset - 5e-4 + 5e-6 * f64::from(k)).collect();
            let force_n = time_s.iter().map(|t| signal.at(t - offset)).collect();
            let record = ForceRecord { file: String::new(), time_s, force_n };
            assert!((record.offset_s(&signal) - offset).abs() < 1e-9, "{offset}: {}", record.offset_s(&signal));
        }
    }

    #[test]
    fn residuals_that_resemble_their_neighbours_are_noticed() {
        let wave: Vec<f64> = (0..100).map(|k| (0.2 * f64::from(k)).sin()).collect();
        assert!(lag_one(&wave).1 < 1e-10);
        // a full period of four: neighbours are at right angles
        let turning: Vec<f64> = (0..100).map(|k| [1.0, 1.0, -1.0, -1.0][k % 4]).collect();
        assert!(lag_one(&turning).1 > 0.5);
    }
}
