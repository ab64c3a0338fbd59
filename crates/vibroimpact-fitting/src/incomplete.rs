//! Incomplete gamma and beta functions, for degrees of freedom of any number. Those of `puruspe` are not numbers for `a` from 100 on if
//! `x < a - 1`, and wrong if both parameters of the beta function exceed 3000.

use puruspe::{erfc, ln_gamma};
use std::f64::consts::PI;

/// Terms of a series or of a continued fraction: near its steepest point they are some multiple of the root of the parameters.
const MOST_TERMS: usize = 1_000_000;
/// Parameter of the gamma function from which on an expansion about the normal distribution is exact to rounding; the logarithms of
/// larger factors lose digits.
const MANY: f64 = 1e6;
/// The smallest number by which a continued fraction divides.
const LEAST: f64 = 1e-300;

/// `Q(a, x)`, the integral of `t^(a-1) exp(-t)` from `x > 0` to infinity over that from 0.
pub(crate) fn upper_gamma(a: f64, x: f64) -> f64 {
    if a >= MANY {
        // Temme (1979): eta^2/2 = mu - ln(1 + mu) with the sign of mu = x/a - 1
        let mu = (x - a) / a;
        let series = |mu: f64| (2..=9).rev().fold(0.0, |sum, n| 1.0 / f64::from(n) - mu * sum) * mu * mu;
        let half_square = if mu.abs() < 0.01 { series(mu) } else { mu - mu.ln_1p() };
        let eta = (2.0 * half_square).sqrt().copysign(mu);
        let rest =
            (-a * half_square).exp() / (2.0 * PI * a).sqrt() * (-1.0 / 3.0 + eta * (1.0 / 12.0 - eta * 2.0 / 135.0));
        return (0.5 * erfc(eta * (0.5 * a).sqrt()) + rest).clamp(0.0, 1.0);
    }
    let factor = (a * x.ln() - x - ln_gamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum) = (1.0 / a, 1.0 / a);
        for n in 1..MOST_TERMS {
            term *= x / (a + n as f64);
            sum += term;
            if term <= f64::EPSILON * sum {
                break;
            }
        }
        return (1.0 - factor * sum).clamp(0.0, 1.0);
    }
    let first = x + 1.0 - a;
    let rest = |n: f64| (-n * (n - a), first + 2.0 * n);
    (factor / continued(first, rest)).clamp(0.0, 1.0)
}

/// `I_x(a, b)`, the integral of `t^(a-1) (1-t)^(b-1)` from 0 to `x` (0 to 1) over that to 1. Its argument `rest` is `1 - x`, which
/// has more digits than the difference if `x` is near 1.
pub(crate) fn lower_beta(a: f64, b: f64, x: f64, rest: f64) -> f64 {
    if x <= 0.0 || rest <= 0.0 {
        return x;
    }
    let of_gamma = ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b);
    let log = |x: f64, rest: f64| if x < 0.5 { x.ln() } else { (-rest).ln_1p() };
    let factor = (a * log(x, rest) + b * log(rest, x) + of_gamma).exp();
    // the fraction converges fast below the mean
    let below = |a: f64, b: f64, x: f64| {
        let rest = |n: f64| {
            let m = (0.5 * n).floor();
            let numerator = if n > 2.0 * m { -(a + m) * (a + b + m) } else { m * (b - m) };
            (numerator * x / ((a + n - 1.0) * (a + n)), 1.0)
        };
        (factor / (a * continued(1.0, rest))).clamp(0.0, 1.0)
    };
    if x <= (a + 1.0) / (a + b + 2.0) { below(a, b, x) } else { 1.0 - below(b, a, rest) }
}

/// `first + p_1/(q_1 + p_2/(q_2 + ...))` with `(p_n, q_n) = rest(n)`, by Lentz's method.
fn continued(first: f64, rest: impl Fn(f64) -> (f64, f64)) -> f64 {
    let nonzero = |value: f64| if value.abs() < LEAST { LEAST } else { value };
    let mut value = nonzero(first);
    let (mut c, mut d) = (value, 0.0);
    for n in 1..MOST_TERMS {
        let (p, q) = rest(n as f64);
        d = 1.0 / nonzero(q + p * d);
        c = nonzero(q + p / c);
        value *= c * d;
        if (c * d - 1.0).abs() <= f64::EPSILON {
            break;
        }
    }
    value
}
