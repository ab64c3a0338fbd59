//! The integral of a Legendre series against a square root, in closed form.

use super::problem::NODES;

/// `int_-1^1 sqrt(z - u) sum_k c_k P_k(u) du` as a function of `z >= 1`.
///
/// From the generating function of the Legendre polynomials, with `z = (r + 1/r)/2`, `r <= 1`:
/// `int P_k(u) / sqrt(z - u) du = 2 sqrt(2 r) r^k / (2 k + 1)`; integration by parts then gives
/// `int P_k sqrt(z - u) du = sqrt(2 r)/(2k+1) [r^(k+1)/(2k+3) - r^(k-1)/(2k-1)]` for `k > 0`.
#[derive(Debug, Clone, Default)]
pub(super) struct RootSum {
    mean: f64,
    /// Coefficients of the powers of `r`.
    powers: Vec<f64>,
    /// Logarithm of what is negligible, relative to the largest of them.
    negligible: f64,
    /// Coefficients of the powers of `r` in its derivative.
    slopes: Vec<f64>,
}

impl RootSum {
    pub fn new(coefficients: &[f64]) -> RootSum {
        let mut powers = vec![0.0; coefficients.len() + 1];
        for ((k, c), (raised, lowered)) in coefficients.iter().enumerate().zip(ROOT_FACTORS).skip(1) {
            powers[k + 1] += c * raised;
            powers[k - 1] -= c * lowered;
        }
        let mean = coefficients[0];
        let largest = powers.iter().fold(0.0_f64, |a, c| a.max(c.abs()));
        let slopes = coefficients.iter().enumerate().map(|(k, c)| c / (2 * k + 1) as f64).collect();
        RootSum { mean, powers, negligible: (1e-18 * mean.abs() / largest).max(1e-300).ln(), slopes }
    }

    /// Adds `factor` times the derivative of the function at each `z = 1 + scale * beyond` to its sum.
    pub fn add_slope(&self, factor: f64, scale: f64, beyond: &[f64], sums: &mut [f64]) {
        for (beyond, sums) in beyond.chunks(LANES).zip(sums.chunks_mut(LANES)) {
            let mut r = [0.0; LANES];
            for (r, beyond) in r.iter_mut().zip(beyond) {
                let y = scale * beyond;
                *r = 1.0 / (1.0 + y + (y * (y + 2.0)).sqrt());
            }
            let mut series = [0.0; LANES];
            for &c in self.slopes.iter().rev() {
                for (series, r) in series.iter_mut().zip(r) {
                    *series = *series * r + c;
                }
            }
            for ((sum, series), r) in sums.iter_mut().zip(series).zip(r) {
                *sum += factor * ((2.0 * r).sqrt() * series);
            }
        }
    }

    /// Adds `factor` times the function at each `z = 1 + scale * beyond` to its sum.
    pub fn add(&self, factor: f64, scale: f64, beyond: &[f64], sums: &mut [f64]) {
        for (beyond, sums) in beyond.chunks(LANES).zip(sums.chunks_mut(LANES)) {
            let mut y = [0.0; LANES];
            y.iter_mut().zip(beyond).for_each(|(y, beyond)| *y = scale * beyond);
            let y = y;
            let r = y.map(|y| 1.0 / (1.0 + y + (y * (y + 2.0)).sqrt()));
            // powers beyond which nothing is left of any lane
            let nearest = r[..beyond.len()].iter().fold(0.0_f64, |a, &b| a.max(b));
            let count =
                if nearest < 0.9 { (self.negligible / nearest.ln()).ceil() as usize } else { self.powers.len() };
            let mut series = [0.0; LANES];
            for &c in self.powers[..count.min(self.powers.len())].iter().rev() {
                for (series, r) in series.iter_mut().zip(r) {
                    *series = *series * r + c;
                }
            }
            for (i, sum) in sums.iter_mut().enumerate() {
                let (far, near) = ((y[i] + 2.0).sqrt(), y[i].sqrt());
                // (2/3) (far^3 - near^3), as far^2 - near^2 = 2
                let first = 4.0 / 3.0 * (far * far + far * near + near * near) / (far + near);
                *sum += factor * (self.mean * first + (2.0 * r[i]).sqrt() * series[i]);
            }
        }
    }
}

/// Times that are treated together, for the vector units.
const LANES: usize = 8;

const MOST_NODES: usize = *NODES.end();

/// `1 / ((2k+1)(2k+3))` and `1 / ((2k+1)(2k-1))`.
const ROOT_FACTORS: [(f64, f64); MOST_NODES] = {
    let mut factors = [(0.0, 0.0); MOST_NODES];
    let mut k = 1;
    while k < MOST_NODES {
        let n = (2 * k) as f64;
        factors[k] = (1.0 / ((n + 1.0) * (n + 3.0)), 1.0 / ((n + 1.0) * (n - 1.0)));
        k += 1;
    }
    factors
};
