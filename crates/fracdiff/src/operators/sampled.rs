//! Operators on samples.

use super::{require_order, start_terms};
use crate::convolution::product;
use invalid_input::InvalidInput;
use libm::tgamma;

/// Points of the polynomials that differentiate samples.
const STENCIL: usize = 5;

/// The Riemann-Liouville integral `I^order` at every sample, from the start of the samples.
///
/// The samples are joined by straight lines, which are integrated exactly: second order in the spacing, which need not be
/// equal. The cost is `O(n^2)`.
///
/// # Errors
///
/// [`InvalidInput`] for an order outside `0 < order <= 16`, fewer than 2 samples, times and values of different
/// number, times that do not ascend, a number that is not finite, or samples whose result is too large for a number.
pub fn integral_sampled(order: f64, times: &[f64], values: &[f64]) -> Result<Vec<f64>, InvalidInput> {
    require_order(order)?;
    require_samples(times, values, 2)?;
    let scale = 1.0 / tgamma(order + 1.0);
    let mut out = vec![0.0];
    for n in 1..times.len() {
        let mut sum = 0.0;
        for j in 0..n {
            let (far, near) = (times[n] - times[j], times[n] - times[j + 1]);
            let zeroth = power_integral(far, near, order);
            // of (u - near), u from near to far
            let first = ramp_integral(far, near, order);
            let slope = (values[j] - values[j + 1]) / (far - near);
            sum += values[j + 1] * zeroth + slope * first;
        }
        out.push(scale * sum);
    }
    require_representable(&out, values, 0)?;
    Ok(out)
}

/// The Caputo derivative at every sample by the L1 formula: the samples (for orders above 1 their derivatives by polynomials
/// through five points) are joined by straight lines, whose derivative is integrated exactly.
///
/// For smooth functions the order in the spacing is `2 - a`, with `a` the fractional part of the order; the spacing need not be
/// equal. An integer order gives the ordinary derivative. The first value is 0 unless the order is an integer. The cost is
/// `O(n^2)`.
///
/// ```
/// use fracdiff::operators::caputo_sampled;
/// let times: Vec<f64> = (0..=10).map(|i| 0.01 * f64::from(i * i)).collect();
/// // exact for a straight line: D^(1/2) t = 2 sqrt(t/pi)
/// let half = caputo_sampled(0.5, &times, &times)?;
/// assert!((half[10] - 2.0 / std::f64::consts::PI.sqrt()).abs() < 1e-13);
/// # Ok::<(), fracdiff::InvalidInput>(())
/// ```
///
/// # Errors
///
/// As for [`integral_sampled`]; for orders of 1 and above at least 5 samples.
pub fn caputo_sampled(order: f64, times: &[f64], values: &[f64]) -> Result<Vec<f64>, InvalidInput> {
    require_order(order)?;
    let whole = order.floor();
    require_samples(times, values, if whole > 0.0 { STENCIL } else { 2 })?;
    let mut samples = values.to_vec();
    for _ in 0..whole as usize {
        samples = differentiated(times, &samples);
    }
    let a = order - whole;
    if a == 0.0 {
        require_representable(&samples, values, 0)?;
        return Ok(samples);
    }
    let scale = 1.0 / tgamma(2.0 - a);
    let mut out = vec![0.0];
    for n in 1..times.len() {
        let slope = |j: usize| (samples[j + 1] - samples[j]) / (times[j + 1] - times[j]);
        let weight = |j: usize| power_integral(times[n] - times[j], times[n] - times[j + 1], 1.0 - a);
        out.push(scale * (0..n).map(|j| slope(j) * weight(j)).sum::<f64>());
    }
    require_representable(&out, values, 0)?;
    Ok(out)
}

/// The Riemann-Liouville derivative at every sample: [`caputo_sampled`] and the terms of the initial values,
/// whose derivatives come from polynomials through the first five samples.
///
/// At the start the derivative is infinite unless the samples start at 0 (and for orders above 1 with slope 0, and so on). The
/// first value is then an infinity of the same sign.
///
/// # Errors
///
/// As for [`caputo_sampled`].
pub fn riemann_liouville_sampled(order: f64, times: &[f64], values: &[f64]) -> Result<Vec<f64>, InvalidInput> {
    let mut out = caputo_sampled(order, times, values)?;
    let mut initial = Vec::new();
    let mut samples = values.to_vec();
    for _ in 0..order.ceil() as usize {
        initial.push(samples[0]);
        if initial.len() < order.ceil() as usize {
            samples = differentiated(times, &samples);
        }
    }
    // If opposite infinities meet at the start, the lowest derivative that is not 0 dominates.
    let lowest: Vec<f64> = initial
        .iter()
        .scan(false, |seen, &v| {
            let keep = if *seen { 0.0 } else { v };
            *seen |= v != 0.0;
            Some(keep)
        })
        .collect();
    for (n, value) in out.iter_mut().enumerate() {
        *value += start_terms(order, if n == 0 { &lowest } else { &initial }, times[n] - times[0]);
    }
    require_representable(&out, values, 1)?;
    Ok(out)
}

/// The Gruenwald-Letnikov derivative of equally spaced samples, `h^-order sum_k (-1)^k binomial(order, k) f_(n-k)`; a negative
/// order is an integral. It is of first order in the spacing and converges to the Riemann-Liouville derivative. The cost is
/// `O(n log n)`.
///
/// # Errors
///
/// [`InvalidInput`] for an order that is 0 or beyond 16 in magnitude, a step that is not positive, a value that is
/// not finite, or values whose result is too large for a number.
pub fn grunwald_letnikov(order: f64, step: f64, values: &[f64]) -> Result<Vec<f64>, InvalidInput> {
    let ok = order != 0.0 && order.abs() <= super::LARGEST_ORDER;
    InvalidInput::unless(ok, "order", order, "a number from -16 to 16 other than 0")?;
    InvalidInput::require_positive("step", step)?;
    require_finite("values", values)?;
    if values.is_empty() {
        return Ok(Vec::new());
    }
    let scale = step.powf(-order);
    let mut out = product(&binomial_series(order, values.len()), values, values.len());
    out.iter_mut().for_each(|v| *v *= scale);
    require_representable(&out, values, 0)?;
    Ok(out)
}

/// `(1 - z)^order`.
fn binomial_series(order: f64, count: usize) -> Vec<f64> {
    let mut series = vec![1.0];
    for k in 1..count {
        series.push(series[k - 1] * (k as f64 - 1.0 - order) / k as f64);
    }
    series
}

/// `p int_near^far u^(p-1) du`, without cancellation for a short interval far away.
fn power_integral(far: f64, near: f64, p: f64) -> f64 {
    let ratio = (far - near) / far;
    if near <= 0.0 { far.powf(p) } else { -far.powf(p) * (p * (-ratio).ln_1p()).exp_m1() }
}

/// `p int_near^far u^(p-1) (u - near) du`.
fn ramp_integral(far: f64, near: f64, p: f64) -> f64 {
    let h = far - near;
    if near > 20.0 * h {
        // Far away the two terms below cancel: the binomial series of (1 + v/near)^(p-1) with v = u - near, integrated term by
        // term.
        let (mut coefficient, mut sum, mut k) = (1.0, 0.0, 0.0);
        while f64::abs(coefficient) > 1e-17 {
            sum += coefficient / (k + 2.0);
            coefficient *= (p - 1.0 - k) / (k + 1.0) * (h / near);
            k += 1.0;
        }
        return p * near.powf(p - 1.0) * h * h * sum;
    }
    p / (p + 1.0) * power_integral(far, near, p + 1.0) - near * power_integral(far, near, p)
}

/// Derivatives at the samples by the polynomial through the five nearest.
fn differentiated(times: &[f64], values: &[f64]) -> Vec<f64> {
    let n = times.len();
    (0..n)
        .map(|i| {
            let start = i.saturating_sub(STENCIL / 2).min(n - STENCIL);
            let points = start..start + STENCIL;
            // derivative of the Lagrange basis at one of its own nodes
            let mut sum = 0.0;
            let mut own = 0.0;
            for j in points.clone().filter(|&j| j != i) {
                let others = points.clone().filter(|&k| k != i && k != j);
                let ratio: f64 = others.map(|k| (times[i] - times[k]) / (times[j] - times[k])).product();
                let weight = ratio / (times[j] - times[i]);
                sum += weight * values[j];
                own += weight;
            }
            sum - own * values[i]
        })
        .collect()
}

fn require_samples(times: &[f64], values: &[f64], least: usize) -> Result<(), InvalidInput> {
    let allowed = "at least 2, and at least 5 for orders of 1 and above";
    InvalidInput::unless(times.len() >= least, ["times", "len()"], times.len(), allowed)?;
    InvalidInput::unless(values.len() == times.len(), ["values", "len()"], values.len(), "the number of times")?;
    require_finite("times", times)?;
    require_finite("values", values)?;
    match times.windows(2).position(|w| w[1] <= w[0]) {
        Some(i) => Err(InvalidInput::new(("times", i + 1), times[i + 1], "greater than the time before")),
        None => Ok(()),
    }
}

/// Results at the samples from the number `from` on, which overflow for values that are too large or times that are too close.
fn require_representable(results: &[f64], values: &[f64], from: usize) -> Result<(), InvalidInput> {
    let allowed = "a value with which the result at its time is a finite number";
    match results.iter().skip(from).position(|v| !v.is_finite()) {
        Some(i) => Err(InvalidInput::new(("values", from + i), values[from + i], allowed)),
        None => Ok(()),
    }
}

fn require_finite(field: &'static str, values: &[f64]) -> Result<(), InvalidInput> {
    match values.iter().position(|v| !v.is_finite()) {
        Some(i) => Err(InvalidInput::new((field, i), values[i], "a finite number")),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `D^a t^p` (or the integral for negative `a`).
    fn of_power(a: f64, p: f64, t: f64) -> f64 {
        tgamma(p + 1.0) / tgamma(p + 1.0 - a) * t.powf(p - a)
    }

    fn graded(n: usize) -> Vec<f64> {
        (0..=n).map(|i| 2.0 * (i as f64 / n as f64).powf(1.5)).collect()
    }

    /// Ratio of the errors at the end for `n` and `2n` samples, as an order.
    fn order_of(f: impl Fn(&[f64]) -> f64, exact: f64) -> f64 {
        let error = |n| (f(&graded(n)) - exact).abs();
        (error(200) / error(400)).log2()
    }

    #[test]
    fn orders_of_convergence() {
        let cube = |times: &[f64]| times.iter().map(|t| t.powi(3)).collect::<Vec<f64>>();
        for a in [0.3, 0.5, 0.8] {
            let integral = order_of(|t| integral_sampled(a, t, &cube(t)).unwrap()[t.len() - 1], of_power(-a, 3.0, 2.0));
            assert!((integral - 2.0).abs() < 0.1, "integral {a}: {integral}");
            let caputo = order_of(|t| caputo_sampled(a, t, &cube(t)).unwrap()[t.len() - 1], of_power(a, 3.0, 2.0));
            assert!((caputo - (2.0 - a)).abs() < 0.1, "caputo {a}: {caputo}");
            let above =
                order_of(|t| caputo_sampled(1.0 + a, t, &cube(t)).unwrap()[t.len() - 1], of_power(1.0 + a, 3.0, 2.0));
            assert!((above - (2.0 - a)).abs() < 0.1, "caputo {}: {above}", 1.0 + a);
        }
    }

    #[test]
    fn riemann_liouville_sees_initial_values() {
        let times = graded(400);
        let values: Vec<f64> = times.iter().map(|t| 1.0 + 2.0 * t).collect();
        let got = riemann_liouville_sampled(1.5, &times, &values).unwrap();
        let exact = of_power(1.5, 0.0, 2.0) + 2.0 * of_power(1.5, 1.0, 2.0);
        assert!((got[400] / exact - 1.0).abs() < 1e-10);
        // t^-1.5/Gamma(-1/2) with Gamma(-1/2) < 0
        assert_eq!(got[0], f64::NEG_INFINITY);
        assert_eq!(caputo_sampled(0.5, &times, &values).unwrap()[0], 0.0);
    }

    #[test]
    fn grunwald_letnikov_is_first_order_and_inverts() {
        let error = |n: usize| {
            let h = 1.0 / n as f64;
            let values: Vec<f64> = (0..=n).map(|i| (i as f64 * h).powi(2)).collect();
            (grunwald_letnikov(0.5, h, &values).unwrap()[n] - of_power(0.5, 2.0, 1.0)).abs()
        };
        let order = (error(300) / error(600)).log2();
        assert!((order - 1.0).abs() < 0.02, "{order}");
        let values: Vec<f64> = (0..200).map(|i| (0.1 * f64::from(i)).sin()).collect();
        for order in [0.5, 1.0, 2.0, 1.7] {
            let there = grunwald_letnikov(order, 0.1, &values).unwrap();
            let back = grunwald_letnikov(-order, 0.1, &there).unwrap();
            assert!(values.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-9), "{order}");
        }
    }

    #[test]
    fn small_orders_lose_no_digits() {
        let times = graded(40);
        let values: Vec<f64> = times.iter().map(|t| 1.0 + t).collect();
        for a in [5e-324, 1e-310, 1e-17, 1e-10, 1e-3] {
            let near = |got: f64, exact: f64| assert!((got / exact - 1.0).abs() < 1e-13, "{a}: {got} {exact}");
            near(integral_sampled(a, &times, &values).unwrap()[40], of_power(-a, 0.0, 2.0) + of_power(-a, 1.0, 2.0));
            near(caputo_sampled(a, &times, &values).unwrap()[40], of_power(a, 1.0, 2.0));
            let both = riemann_liouville_sampled(a, &times, &values).unwrap();
            assert_eq!(both[0], f64::INFINITY);
            near(both[40], of_power(a, 0.0, 2.0) + of_power(a, 1.0, 2.0));
        }
    }

    #[test]
    fn straight_lines_are_integrated_exactly() {
        for n in [10, 30, 200] {
            let times = graded(n);
            let values: Vec<f64> = times.iter().map(|t| 1.0 + 3.0 * t).collect();
            for order in [0.01, 0.5, 1.0, 2.7, 5.0, 8.0, 12.3, 16.0] {
                for (t, got) in times.iter().zip(integral_sampled(order, &times, &values).unwrap()).skip(1) {
                    let exact = of_power(-order, 0.0, *t) + 3.0 * of_power(-order, 1.0, *t);
                    assert!((got / exact - 1.0).abs() < 3e-13, "{n} {order} {t}: {got} {exact}");
                }
            }
        }
    }

    #[test]
    fn results_that_are_no_numbers_are_refused() {
        let told = |result: Result<Vec<f64>, InvalidInput>| result.unwrap_err().to_string();
        let why =
            "values[1] = 1 is not allowed; it must be a value with which the result at its time is a finite number";
        for order in [0.5, 0.999] {
            assert_eq!(told(caputo_sampled(order, &[0.0, 5e-324, 1.0], &[0.0, 1.0, 2.0])), why);
            assert_eq!(told(riemann_liouville_sampled(order, &[0.0, 5e-324, 1.0], &[0.0, 1.0, 2.0])), why);
        }
        let close: Vec<f64> = (0..6).map(|i| 1e-310 * f64::from(i)).collect();
        assert!(told(caputo_sampled(1.0, &close, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0])).starts_with("values[0] = 0 "));
        assert!(told(integral_sampled(1.0, &[0.0, 1e300], &[1e300; 2])).starts_with("values[1]"));
        assert!(told(grunwald_letnikov(2.0, 1e-300, &[0.0, 1.0])).starts_with("values["));
    }

    #[test]
    fn bad_samples_are_refused() {
        assert!(integral_sampled(0.5, &[0.0], &[1.0]).is_err());
        assert!(integral_sampled(0.5, &[0.0, 1.0], &[1.0]).is_err());
        assert!(integral_sampled(0.5, &[0.0, 0.0], &[1.0, 2.0]).is_err());
        assert!(caputo_sampled(1.5, &[0.0, 1.0], &[1.0, 2.0]).is_err());
        assert!(caputo_sampled(0.5, &[0.0, f64::NAN], &[1.0, 2.0]).is_err());
        assert!(grunwald_letnikov(0.0, 1.0, &[1.0]).is_err());
        assert!(grunwald_letnikov(0.5, 0.0, &[1.0]).is_err());
        assert_eq!(grunwald_letnikov(0.5, 1.0, &[]).unwrap(), Vec::<f64>::new());
    }
}
