//! Quadrature weights on equal steps: `integral_0^(nh) (nh-s)^(order-1) f(s) ds = h^order sum_j w_nj f_j`.

use super::fft::{product, reciprocal};
use libm::tgamma;
use nalgebra::{DMatrix, DVector};

/// Weights for a unit step: for `f_0` by step, for `f_1, f_2, ...` by distance, and corrections for the first few values.
#[derive(Debug, Clone)]
pub(crate) struct Weights {
    /// `start[n]` belongs to `f_0` in step `n`.
    pub start: Vec<f64>,
    /// `lag[k]` belongs to `f_(n-k)`, `n - k >= 1`.
    pub lag: Vec<f64>,
    /// `corrections[n * points + l]` is added for `f_l`; may be empty.
    pub corrections: Vec<f64>,
}

/// Coefficients of `(1 - z)^(-order)`, times `Gamma(order)` for a kernel without it (backward differences of order 1).
pub(crate) fn grunwald_letnikov(order: f64, steps: usize) -> Weights {
    let mut lag = vec![tgamma(order)];
    for k in 1..=steps {
        lag.push(lag[k - 1] * (k as f64 - 1.0 + order) / k as f64);
    }
    Weights { start: vec![0.0; steps + 1], lag, corrections: Vec::new() }
}

/// The inverse of the L1 formula for the fractional part of the order, after trapezoidal rules for its integer part.
///
/// L1: `D^a y_n = sum_k b_k (y_(n-k) - y_(n-k-1)) / Gamma(2-a)`, `b_k = (k+1)^(1-a) - k^(1-a)`; solved for `y`.
pub(crate) fn l1(order: f64, steps: usize) -> Weights {
    let count = steps + 1;
    let whole = order.floor();
    let a = order - whole;
    let mut lag = vec![0.0; count];
    lag[0] = 1.0;
    let mut start = vec![0.0; count];
    // (1/2 + z + z^2 + ...) is the trapezoidal rule on a sequence; the first value has weight 1/2 in every step.
    let mut trapezoid = vec![1.0; count];
    trapezoid[0] = 0.5;
    for i in 0..whole as usize {
        lag = product(&lag, &trapezoid, count);
        start = if i == 0 {
            (0..count).map(|n| if n == 0 { 0.0 } else { 0.5 }).collect()
        } else {
            product(&start, &trapezoid, count)
        };
    }
    if a > 0.0 {
        let p = 1.0 - a;
        let b: Vec<f64> = (0..count).map(|k| power_difference(k as f64, p) / tgamma(2.0 - a)).collect();
        let difference: Vec<f64> = (0..count).map(|k| if k == 0 { b[0] } else { b[k] - b[k - 1] }).collect();
        let inverse = reciprocal(&difference, count);
        lag = product(&lag, &inverse, count);
        start = product(&start, &inverse, count);
    }
    let gamma = tgamma(order);
    lag.iter_mut().chain(&mut start).for_each(|v| *v *= gamma);
    Weights { start, lag, corrections: Vec::new() }
}

/// `(k+1)^p - k^p` without cancellation.
fn power_difference(k: f64, p: f64) -> f64 {
    if k == 0.0 { 1.0 } else { k.powf(p) * (p * (1.0 / k).ln_1p()).exp_m1() }
}

/// Exact integrals of the piecewise linear interpolant of the density.
pub(crate) fn trapezoidal(order: f64, steps: usize) -> Weights {
    let p = order + 1.0;
    let scale = 1.0 / (order * p);
    let lag = (0..=steps).map(|k| if k == 0 { scale } else { scale * second_difference(k as f64, p) }).collect();
    let start = (0..=steps).map(|n| if n == 0 { 0.0 } else { scale * first_weight(n as f64, p) }).collect();
    Weights { start, lag, corrections: Vec::new() }
}

/// `(k+1)^p - 2 k^p + (k-1)^p`, by its series in `1/k` where the terms cancel.
fn second_difference(k: f64, p: f64) -> f64 {
    if k < 20.0 {
        return (k + 1.0).powf(p) - 2.0 * k.powf(p) + (k - 1.0).powf(p);
    }
    2.0 * k.powf(p) * binomial_tail(p, 1.0 / k, true)
}

/// `(n-1)^p - (n-p) n^(p-1)`, the weight of `f_0`.
fn first_weight(n: f64, p: f64) -> f64 {
    if n < 20.0 {
        return (n - 1.0).powf(p) - (n - p) * n.powf(p - 1.0);
    }
    n.powf(p) * binomial_tail(p, -1.0 / n, false)
}

/// `sum over i >= 2 of binomial(p, i) x^i`, or over even `i` only.
fn binomial_tail(p: f64, x: f64, even: bool) -> f64 {
    let (mut term, mut sum) = (p * x, 0.0);
    for i in 2..24 {
        term *= x * (p - f64::from(i) + 1.0) / f64::from(i);
        if !even || i % 2 == 0 {
            sum += term;
        }
    }
    sum
}

/// Adds weights on the first `exponents.len()` values that make the rule exact for `s^gamma`, `gamma` in `exponents`
/// (Lubich's starting weights); the rule must be exact already for the exponents 0 and 1.
pub(crate) fn add_corrections(weights: &mut Weights, order: f64, exponents: &[f64]) {
    let (points, steps) = (exponents.len(), weights.lag.len());
    let system = DMatrix::from_fn(points, points, |g, l| (l as f64).powf(exponents[g]));
    let Some(inverse) = system.try_inverse() else { return };
    let mut defects = vec![vec![0.0; steps]; points];
    for (defect, &gamma) in defects.iter_mut().zip(exponents) {
        if gamma == 0.0 || gamma == 1.0 {
            continue;
        }
        let sample: Vec<f64> = (0..steps).map(|j| (j as f64).powf(gamma)).collect();
        let sums = product(&weights.lag, &sample, steps);
        let beta = tgamma(order) * tgamma(gamma + 1.0) / tgamma(order + gamma + 1.0);
        for (n, d) in defect.iter_mut().enumerate() {
            *d = (n as f64).powf(order + gamma) * beta - sums[n];
        }
    }
    weights.corrections = vec![0.0; steps * points];
    for n in 1..steps {
        let solved = &inverse * DVector::from_fn(points, |g, _| defects[g][n]);
        weights.corrections[n * points..(n + 1) * points].copy_from_slice(solved.as_slice());
    }
}

/// Weights for the first values, in units of the step, that correct the trapezoidal rule for `s^gamma` in a segment that is
/// entirely in the past. The integral minus the rule is `-zeta(-gamma) h^(1+gamma)` times the kernel at the start of the segment
/// (Euler-Maclaurin formula of Navot), and vanishes to this order for the exponents 0 and 1.
pub(crate) fn start_corrections(exponents: &[f64]) -> Vec<f64> {
    let points = exponents.len();
    let system = DMatrix::from_fn(points, points, |g, l| (l as f64).powf(exponents[g]));
    let defects = DVector::from_fn(points, |g, _| {
        let gamma = exponents[g];
        if gamma == 0.0 || gamma == 1.0 { 0.0 } else { -zeta_of_minus(gamma) }
    });
    system.lu().solve(&defects).map_or_else(Vec::new, |w| w.as_slice().to_vec())
}

/// Riemann's `zeta(-gamma)`, `0 < gamma < 1`, from a sum of `j^gamma` and its Euler-Maclaurin formula.
fn zeta_of_minus(gamma: f64) -> f64 {
    let n = 200.0_f64;
    let sum: f64 = (1..200).map(|j| f64::from(j).powf(gamma)).sum::<f64>() + 0.5 * n.powf(gamma);
    let slope = gamma * n.powf(gamma - 1.0);
    let third = slope * (gamma - 1.0) * (gamma - 2.0) / (n * n);
    sum - n.powf(gamma + 1.0) / (gamma + 1.0) - slope / 12.0 + third / 720.0
}

/// The exponents below 1 that the density of a smooth problem may have at the start of a segment, which are sums of the orders,
/// together with 0 and 1, ascending. There are at most eight, since the corrections become ill-conditioned with their number.
pub(crate) fn start_exponents(orders: &[f64]) -> Vec<f64> {
    let mut exponents = vec![0.0];
    let mut i = 0;
    while i < exponents.len() && exponents.len() < 64 {
        for order in orders {
            let sum = exponents[i] + order;
            if sum < 1.0 - 1e-9 && exponents.iter().all(|e| (e - sum).abs() > 1e-9) {
                exponents.push(sum);
            }
        }
        i += 1;
    }
    exponents.sort_by(f64::total_cmp);
    exponents.truncate(7);
    exponents.push(1.0);
    exponents
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apply(w: &Weights, n: usize, points: usize, f: impl Fn(f64) -> f64) -> f64 {
        let mut sum = w.start[n] * f(0.0);
        for j in 1..=n {
            sum += w.lag[n - j] * f(j as f64);
        }
        for l in 0..points.min(w.corrections.len()) {
            sum += w.corrections[n * points + l] * f(l as f64);
        }
        sum
    }

    #[test]
    fn trapezoidal_is_exact_for_lines_and_with_corrections_for_roots() {
        for order in [0.3, 0.5, 1.0, 1.5, 2.0, 3.2] {
            let mut w = trapezoidal(order, 400);
            let exponents = start_exponents(&[0.5]);
            assert_eq!(exponents, [0.0, 0.5, 1.0]);
            add_corrections(&mut w, order, &exponents);
            for n in [1usize, 2, 7, 19, 21, 400] {
                let t = n as f64;
                let line = t.powf(order) / order + t.powf(order + 1.0) / (order * (order + 1.0));
                assert!((apply(&w, n, 3, |s| 1.0 + s) / line - 1.0).abs() < 1e-12, "{order} {n}");
                let root = t.powf(order + 0.5) * tgamma(order) * tgamma(1.5) / tgamma(order + 1.5);
                // The transform rounds relative to the largest sum, that of the last step.
                let rounding = 1e-14 * 400f64.powf(order + 0.5);
                assert!((apply(&w, n, 3, f64::sqrt) - root).abs() < 1e-13 * root + rounding, "{order} {n}");
            }
        }
    }

    #[test]
    fn zeta_of_negative_arguments() {
        assert!((zeta_of_minus(0.5) + 0.207_886_224_977_354_57).abs() < 1e-12);
    }

    #[test]
    fn l1_inverts_the_l1_formula() {
        // I^1/2 of the L1 derivative of t is t again: D^1/2 t = 2 sqrt(t/pi) exactly under L1
        let w = l1(0.5, 200);
        for n in [1, 2, 50, 200] {
            let value = apply(&w, n, 0, |s| 2.0 * (s / std::f64::consts::PI).sqrt()) / tgamma(0.5);
            assert!((value / n as f64 - 1.0).abs() < 1e-12);
        }
        // order 2 is the trapezoidal rule twice: exact for constants
        let w = l1(2.0, 50);
        assert!((apply(&w, 50, 0, |_| 1.0) / 1250.0 - 1.0).abs() < 1e-12);
    }
}
