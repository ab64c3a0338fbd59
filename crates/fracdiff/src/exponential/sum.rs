//! Sums of exponentials that approximate a power.

use crate::quadrature::Rule;
use invalid_input::InvalidInput;
use libm::tgamma;

/// `sum of weights * exp(-rates * t)`, an approximation of a kernel.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ExponentialSum {
    /// Decay rates, not negative.
    pub rates: Vec<f64>,
    /// Factors.
    pub weights: Vec<f64>,
}

impl ExponentialSum {
    /// Approximates `t^(-exponent)`, `0 < exponent < 1`, for `t_min <= t <= t_max` with the relative error `tolerance`.
    ///
    /// The integral `t^-e = 1/Gamma(e) int_0^inf r^(e-1) exp(-r t) dr` is evaluated by a Gauss-Jacobi rule up to `1/t_max` and
    /// by Gauss-Legendre rules on octaves from there (Jiang, Zhang, Zhang & Zhang 2017), so that the number of terms grows as
    /// `log(t_max/t_min) log(1/tolerance)`.
    ///
    /// # Errors
    ///
    /// [`InvalidInput`] for values outside these ranges, or a tolerance outside 1e-14 to 0.1.
    pub fn power(exponent: f64, t_min: f64, t_max: f64, tolerance: f64) -> Result<ExponentialSum, InvalidInput> {
        InvalidInput::unless(exponent > 0.0 && exponent < 1.0, "exponent", exponent, "a number between 0 and 1")?;
        InvalidInput::require_positive("t_min", t_min)?;
        InvalidInput::require_positive("t_max", t_max)?;
        let ordered = t_max >= t_min && (t_max / t_min).is_finite() && (1.0 / t_max).is_finite();
        InvalidInput::unless(ordered, "t_max", t_max, "not less than t_min, with a finite ratio to it")?;
        let tolerance_ok = (1e-14..=0.1).contains(&tolerance);
        InvalidInput::unless(tolerance_ok, "tolerance", tolerance, "a number from 1e-14 to 0.1")?;
        let digits = -tolerance.log10();
        let nodes = (2.0 + 0.85 * digits).ceil() as usize;
        // 1/Gamma(e) is e/Gamma(1 + e), in which nothing overflows
        let scale = 1.0 / tgamma(1.0 + exponent);
        let (mut rates, mut weights) = (Vec::new(), Vec::new());
        let mut upper = 1.0 / t_max;
        let low = Rule::jacobi(nodes, exponent);
        for (&x, &w) in low.nodes.iter().zip(&low.weights) {
            rates.push(upper * x);
            weights.push(scale * w * upper.powf(exponent));
        }
        let rule = Rule::legendre(nodes);
        // Beyond this rate the rest of the integral is below the tolerance at t_min.
        let last = (3.0 - tolerance.ln()) / t_min;
        while upper < last {
            for (&x, &w) in rule.nodes.iter().zip(&rule.weights) {
                let rate = upper * (1.0 + x);
                rates.push(rate);
                weights.push(exponent * scale * w * upper * rate.powf(exponent - 1.0));
            }
            upper *= 2.0;
        }
        Ok(ExponentialSum { rates, weights })
    }

    /// The value at `t`.
    pub fn evaluate(&self, t: f64) -> f64 {
        self.rates.iter().zip(&self.weights).map(|(r, w)| w * (-r * t).exp()).sum()
    }
}

/// `integral_0^1 u^i exp(-z u) du` for `i = 0, 1, ..., out.len()-1`; returns `exp(-z)`.
pub(crate) fn moments(z: f64, out: &mut [f64]) -> f64 {
    let decay = (-z).exp();
    let count = out.len();
    if count == 0 {
        return decay;
    }
    if z > count as f64 {
        out[0] = (1.0 - decay) / z;
        for i in 1..count {
            out[i] = (i as f64 * out[i - 1] - decay) / z;
        }
    } else {
        // Downwards from the highest, by exp(-z) sum over k of z^k / ((i+1)(i+2)...(i+1+k)), in which all terms are positive.
        let top = count as f64;
        let (mut term, mut sum, mut k) = (1.0 / top, 0.0, 0.0);
        while term > 1e-18 * sum {
            sum += term;
            k += 1.0;
            term *= z / (top + k);
        }
        out[count - 1] = decay * sum;
        for i in (0..count - 1).rev() {
            out[i] = (z * out[i + 1] + decay) / (i as f64 + 1.0);
        }
    }
    decay
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_is_approximated_to_the_tolerance() {
        for exponent in [5e-324, 1e-10, 0.05, 0.5, 0.95] {
            for tolerance in [1e-3, 1e-6, 1e-9, 1e-12, 1e-13] {
                let sum = ExponentialSum::power(exponent, 1e-6, 1e3, tolerance).unwrap();
                for i in 0..=180 {
                    let t = 1e-6 * 10f64.powf(0.05 * f64::from(i));
                    let error = (sum.evaluate(t) * t.powf(exponent) - 1.0).abs();
                    assert!(error < tolerance, "{exponent} {tolerance} {t}: {error}");
                }
                assert!(sum.rates.len() < 550, "{}", sum.rates.len());
            }
        }
    }

    #[test]
    fn moments_against_quadrature() {
        let rule = Rule::legendre(40);
        for z in [0.0, 1e-9, 0.3, 2.0, 4.5, 30.0] {
            let mut got = [0.0; 4];
            moments(z, &mut got);
            for (i, value) in got.iter().enumerate() {
                let exact: f64 =
                    rule.nodes.iter().zip(&rule.weights).map(|(u, w)| w * u.powi(i as i32) * (-z * u).exp()).sum();
                assert!((value / exact - 1.0).abs() < 1e-13, "{z} {i}");
            }
        }
    }

    #[test]
    fn bad_input_is_refused() {
        assert!(ExponentialSum::power(1.0, 1.0, 2.0, 1e-6).is_err());
        assert!(ExponentialSum::power(0.5, 2.0, 1.0, 1e-6).is_err());
        assert!(ExponentialSum::power(0.5, 1e-300, 1e300, 1e-6).is_err());
        assert!(ExponentialSum::power(0.5, 1.0, 2.0, f64::NAN).is_err());
    }
}
