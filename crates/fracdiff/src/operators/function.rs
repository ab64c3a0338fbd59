//! Operators on a given function, by Gauss-Jacobi rules that represent the weak singularity.

use super::{require_order, start_terms};
use crate::quadrature::Rule;
use invalid_input::InvalidInput;
use libm::tgamma;

/// Rounding of a term, relative to it: of its value, weight and powers, and of the Gamma function.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Settings of the quadrature of functions.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Quadrature {
    /// Requested error, relative to the integral of the magnitude of the function; 1e-15 to 0.1, default 1e-13.
    pub tolerance: f64,
    /// Exponent `q` of the substitution `s = t x^q`, 1 to 12: 1 (default) for a smooth function, 2 for one that is
    /// smooth in the square root of `s`, and so on.
    pub mapping: u32,
}

impl Default for Quadrature {
    fn default() -> Self {
        Quadrature { tolerance: 1e-13, mapping: 1 }
    }
}

impl Quadrature {
    fn check(&self) -> Result<(), InvalidInput> {
        let ok = (1e-15..=0.1).contains(&self.tolerance);
        InvalidInput::unless(ok, "tolerance", self.tolerance, "a number from 1e-15 to 0.1")?;
        InvalidInput::unless((1..=12).contains(&self.mapping), "mapping", self.mapping, "a number from 1 to 12")?;
        Ok(())
    }
}

/// A value with its estimated error: the difference between two rules and the rounding of the values of the function, which are
/// taken to be correct to the last bit. Where the rules converge slowly, as for a function that is not smooth, the estimate follows
/// from how their differences decrease.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Estimated error.
    pub error: f64,
}

/// The Riemann-Liouville integral `I^order f(t)`, `t >= 0`.
///
/// ```
/// use fracdiff::operators::{Quadrature, integral};
/// // I^(1/2) of 1 is 2 sqrt(t/pi)
/// let half = integral(0.5, |_| 1.0, 4.0, &Quadrature::default())?;
/// assert!((half.value - 4.0 / std::f64::consts::PI.sqrt()).abs() < 1e-14);
/// # Ok::<(), fracdiff::InvalidInput>(())
/// ```
///
/// # Errors
///
/// [`InvalidInput`] for an order outside `0 < order <= 16`, a negative `t`, settings outside their ranges, a value
/// of `f` that is not finite, or a result that is too large for a number.
pub fn integral(order: f64, f: impl Fn(f64) -> f64, t: f64, settings: &Quadrature) -> Result<Estimate, InvalidInput> {
    require_order(order)?;
    let rule = |nodes| Rule::jacobi(nodes, order);
    let value = |s, _| finite(f(s), s).map(|value| (value, 0.0));
    weighted(order, rule, value, t, settings)?.scaled(1.0 / tgamma(order + 1.0), t)
}

/// The Caputo derivative of order `order` of a function, from its derivative `g` of order `order` rounded down: the function
/// itself below order 1, its first derivative from 1 to below 2.
///
/// With the fractional part `a`, the derivative of `g` is, after integration by parts, `[ (g(t)-g(0)) t^-a + a int_0^t
/// (g(t)-g(s)) (t-s)^(-a-1) ds ] / Gamma(1-a)`, which does not contain a derivative of `g`.
///
/// ```
/// use fracdiff::operators::{Quadrature, caputo};
/// // D^(3/2) t^2 = 4 sqrt(t/pi); the first derivative 2 t is given
/// let value = caputo(1.5, |s| 2.0 * s, 1.0, &Quadrature::default())?.value;
/// assert!((value - 4.0 / std::f64::consts::PI.sqrt()).abs() < 1e-13);
/// # Ok::<(), fracdiff::InvalidInput>(())
/// ```
///
/// # Errors
///
/// As for [`integral`].
pub fn caputo(order: f64, g: impl Fn(f64) -> f64, t: f64, settings: &Quadrature) -> Result<Estimate, InvalidInput> {
    require_order(order)?;
    settings.check()?;
    require_time(t)?;
    let a = order - order.floor();
    let end = finite(g(t), t)?;
    if a == 0.0 {
        return Ok(Estimate { value: end, error: 0.0 });
    }
    if t == 0.0 {
        return Ok(Estimate { value: 0.0, error: 0.0 });
    }
    // The difference quotient is smooth, and the weight (t-s)^(-a) remains. The rounding of its numerator grows towards t.
    let quotient = |s: f64, lag: f64| {
        let value = finite(g(s), s)?;
        // beyond t/2 this difference is exact, and that of the rounded s
        let lag = if s > 0.5 * t { t - s } else { lag };
        Ok(((end - value) / lag, f64::EPSILON * (end.abs() + value.abs()) / lag))
    };
    // The nodes of Gauss and Jacobi crowd at t if a is near 1.
    let rule = |nodes| if a > 0.9 { Rule::product(nodes, 1.0 - a) } else { Rule::jacobi(nodes, 1.0 - a) };
    let rest = weighted(1.0 - a, rule, quotient, t, settings)?;
    let start = finite(g(0.0), 0.0)?;
    let (boundary, rounding) = ((end - start) * t.powf(-a), f64::EPSILON * (end.abs() + start.abs()) * t.powf(-a));
    // the mean times 1/(1 - a) is the integral, and (1 - a) Gamma(1 - a) = Gamma(2 - a)
    let value = (1.0 - a) * boundary + a * rest.value;
    Estimate { value, error: (1.0 - a) * rounding + a * rest.error }.scaled(1.0 / tgamma(2.0 - a), t)
}

/// The Riemann-Liouville derivative: [`caputo`] and the terms of the initial values `f(0), f'(0), ...`, as many as `order`
/// rounded up. Missing ones count as 0.
///
/// # Errors
///
/// As for [`integral`], and for `t = 0`, where the derivative is unbounded in general.
pub fn riemann_liouville(
    order: f64,
    g: impl Fn(f64) -> f64,
    initial: &[f64],
    t: f64,
    settings: &Quadrature,
) -> Result<Estimate, InvalidInput> {
    let caputo = caputo(order, g, t, settings)?;
    InvalidInput::require_positive("t", t)?;
    for (k, &value) in initial.iter().enumerate() {
        InvalidInput::require_finite(("initial", k), value)?;
    }
    let count = initial.len().min(order.ceil() as usize);
    let start = start_terms(order, &initial[..count], t);
    let error = caputo.error + ROUNDING * (caputo.value.abs() + start.abs());
    Estimate { value: caputo.value + start, error }.scaled(1.0, t)
}

impl Estimate {
    /// The result at `t`, which is a number if this one, and its product with the factor, are.
    fn scaled(self, factor: f64, t: f64) -> Result<Estimate, InvalidInput> {
        let scaled = Estimate { value: factor * self.value, error: (factor * self.error).abs() };
        let allowed = "a time at which the result is a finite number";
        InvalidInput::unless(scaled.value.is_finite() && scaled.error.is_finite(), "t", t, allowed).map(|()| scaled)
    }
}

fn require_time(t: f64) -> Result<f64, InvalidInput> {
    InvalidInput::unless(t.is_finite() && t >= 0.0, "t", t, "a finite number not less than 0").map(|()| t)
}

fn finite(value: f64, t: f64) -> Result<f64, InvalidInput> {
    if value.is_finite() { Ok(value) } else { Err(InvalidInput::new(format!("f({t})"), value, "a finite value")) }
}

/// `order int_0^t (t-s)^(order-1) f(s, t-s) ds` with rules of 8, 16, ... 256 nodes until two agree. `f` gives a value and its
/// rounding.
fn weighted(
    order: f64,
    rule: impl Fn(usize) -> Rule,
    f: impl Fn(f64, f64) -> Result<(f64, f64), InvalidInput>,
    t: f64,
    settings: &Quadrature,
) -> Result<Estimate, InvalidInput> {
    settings.check()?;
    require_time(t)?;
    if t == 0.0 {
        return Ok(Estimate { value: 0.0, error: 0.0 });
    }
    let (q, scale) = (settings.mapping, t.powf(order));
    let mut last: Option<f64> = None;
    let mut differences = Vec::new();
    let mut estimate = Estimate { value: 0.0, error: f64::INFINITY };
    for nodes in [8, 16, 32, 64, 128, 256] {
        let rule = rule(nodes);
        let (mut sum, mut magnitude, mut rounding) = (0.0, 0.0, 0.0);
        for (&u, &w) in rule.nodes.iter().zip(&rule.weights) {
            // s = t x^q with x = 1 - u, and 1 - x^q = u (1 + x + ... + x^(q-1))
            let x = 1.0 - u;
            let series = (0..q).fold(0.0, |sum, _| sum * x + 1.0);
            let s = t * x.powi(q as i32);
            let (value, uncertain) = f(s, t * u * series)?;
            let weight = w * series.powf(order - 1.0) * f64::from(q) * x.powi(q as i32 - 1);
            sum += weight * value;
            magnitude += (weight * value).abs();
            rounding += weight.abs() * uncertain + ROUNDING * (weight * value).abs();
        }
        if let Some(last) = last {
            let difference: f64 = (sum - last).abs();
            differences.push(difference);
            let error = scale * (remaining(&differences, magnitude) + rounding);
            estimate = Estimate { value: scale * sum, error };
            // More nodes would only add rounding.
            if difference <= rounding.max(settings.tolerance * magnitude) {
                break;
            }
        }
        last = Some(sum);
    }
    Ok(estimate)
}

/// The error of a rule as the differences of one rule from the next let expect, the last of which is its own.
fn remaining(differences: &[f64], magnitude: f64) -> f64 {
    let [.., first, second, third, last] = differences else {
        return differences.last().copied().unwrap_or(f64::INFINITY);
    };
    let ratios = [second / first, third / second, last / third];
    let (lowest, highest) = (ratios.into_iter().fold(f64::INFINITY, f64::min), ratios.into_iter().fold(0.0, f64::max));
    if ratios[1] < 0.5 && ratios[2] < 0.1 {
        // fast, as for a smooth function
        return *last;
    }
    if highest < 0.95 && highest < 1.5 * lowest {
        // like a power of the number of nodes, so that the differences to come are a geometric series
        return 2.0 * last * (highest / (1.0 - highest)).max(1.0);
    }
    // not resolved, and any of the differences may be small by accident
    magnitude.min(8.0 * second.max(third.max(*last)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_and_integrals_of_the_exponential() {
        // By the power series: I^a exp = sum t^(k+a)/Gamma(k+1+a); negative a gives Riemann-Liouville derivatives.
        let series = |a: f64, t: f64, from: i32| -> f64 {
            (from..60)
                .filter(|&k| (f64::from(k) + 1.0 + a) > 0.0 || a.fract() != 0.0)
                .map(|k| t.powf(f64::from(k) + a) / tgamma(f64::from(k) + 1.0 + a))
                .sum()
        };
        let set = Quadrature::default();
        for t in [0.01, 0.7, 5.0] {
            for order in [0.2, 0.5, 0.9, 1.0, 1.3, 2.5, 3.7] {
                let got = integral(order, f64::exp, t, &set).unwrap().value;
                assert!((got / series(order, t, 0) - 1.0).abs() < 2e-13, "I {order} {t}");
                let n = order.ceil() as i32;
                let caputo_value = caputo(order, f64::exp, t, &set).unwrap().value;
                // Differences of values near 1 have a rounding error that grows as the fraction approaches 1.
                let rounding = 1e-13 * t.powf(order.floor() - order);
                let exact = series(-order, t, n);
                assert!(
                    (caputo_value - exact).abs() < 1e-13 * exact + rounding,
                    "C {order} {t}: {caputo_value} {exact}"
                );
                let rl = riemann_liouville(order, f64::exp, &[1.0; 4], t, &set).unwrap().value;
                let exact = series(-order, t, 0);
                assert!((rl - exact).abs() < 1e-13 * exact.abs() + rounding, "R {order} {t}: {rl} {exact}");
            }
        }
    }

    /// `I^a` of `1 + t` is `t^a/Gamma(1 + a) (1 + t/(1 + a))`, and its derivative of the order `a` that of `t`, `t^(1-a)/Gamma(2-a)`.
    #[test]
    fn small_orders_lose_no_digits() {
        let set = Quadrature::default();
        for order in [5e-324, 1e-310, 1e-17, 1e-10, 1e-3] {
            let got = integral(order, |s| 1.0 + s, 3.0, &set).unwrap().value;
            let exact = 3f64.powf(order) / tgamma(1.0 + order) * (1.0 + 3.0 / (1.0 + order));
            assert!((got / exact - 1.0).abs() < 1e-14, "I {order}: {got} {exact}");
            let got = caputo(order, |s| 1.0 + s, 3.0, &set).unwrap().value;
            let exact = 3f64.powf(1.0 - order) / tgamma(2.0 - order);
            assert!((got / exact - 1.0).abs() < 1e-14, "C {order}: {got} {exact}");
        }
    }

    #[test]
    fn mapping_restores_accuracy_for_roots() {
        let exact = tgamma(1.5) / tgamma(2.0) * 3.0;
        let plain = integral(0.5, f64::sqrt, 3.0, &Quadrature::default()).unwrap();
        let mapped = integral(0.5, f64::sqrt, 3.0, &Quadrature { mapping: 2, ..Default::default() }).unwrap();
        assert!((mapped.value - exact).abs() < 1e-14 * exact);
        assert!((plain.value - exact).abs() > 1e-9 && (plain.value - exact).abs() < plain.error);
    }

    /// By the power series, which converges for these times.
    #[test]
    fn orders_just_below_an_integer_keep_their_digits() {
        for order in [0.9_f64, 0.99, 0.999999, 1.0 - 1e-9, 1.0 - 1e-12, 1.0 - 1e-15, 1.999999, 5.999999] {
            let n = order.ceil() as i32;
            for t in [1e-8, 0.1, 1.0, 7.0] {
                let found = caputo(order, f64::exp, t, &Quadrature::default()).unwrap();
                let terms = (n..80).map(f64::from).map(|k| t.powf(k - order) / tgamma(k + 1.0 - order));
                let (exact, error) = (terms.sum::<f64>(), 1e-15 * t.exp());
                assert!((found.value - exact).abs() <= found.error + error, "{order} {t}: {found:?} {exact}");
                // the differences of values near 1 over 1e-8 have no more digits
                assert!(found.error < 1e-12 * exact.max(1.0) / t.min(1.0), "{order} {t}: {found:?}");
            }
        }
    }

    /// 256 nodes are too few for 800 periods, and for a function that is infinite at the start.
    #[test]
    fn what_is_not_resolved_is_not_claimed() {
        let covers = |found: Estimate, exact: f64| {
            assert!((found.value - exact).abs() < found.error && found.error > 1e-3 * exact, "{found:?} {exact}");
        };
        let (set, frequency) = (Quadrature::default(), 1600.0 * std::f64::consts::PI);
        covers(integral(2.0, |s| (frequency * s).sin(), 1.0, &set).unwrap(), 1.0 / frequency);
        covers(integral(2.7, |s| s.powf(-0.9), 1.0, &set).unwrap(), tgamma(0.1) / tgamma(2.8));
        // a power, a fast decrease, and one by accident
        assert_eq!(remaining(&[16.0, 8.0, 4.0, 2.0, 1.0], 1e9), 2.0);
        assert_eq!(remaining(&[1.0, 1e-2, 1e-5, 1e-9], 1e9), 1e-9);
        assert_eq!(remaining(&[1.0, 0.7, 0.9, 1e-6], 1e9), 7.2);
        assert_eq!(remaining(&[1.0, 0.7, 0.9, 1e-6], 2.0), 2.0);
    }

    #[test]
    fn bad_input_is_refused() {
        let set = Quadrature::default();
        assert!(integral(0.0, |_| 1.0, 1.0, &set).is_err());
        assert!(integral(0.5, |_| 1.0, -1.0, &set).is_err());
        assert!(integral(0.5, |_| f64::NAN, 1.0, &set).is_err());
        assert!(caputo(0.5, |s| 1.0 / s, 1.0, &set).is_err());
        assert!(caputo(f64::NAN, |_| 1.0, 1.0, &set).is_err());
        assert!(riemann_liouville(0.5, |_| 1.0, &[1.0], 0.0, &set).is_err());
        assert!(integral(0.5, |_| 1.0, 1.0, &Quadrature { mapping: 0, tolerance: 1e-9 }).is_err());
        assert!(integral(2.0, |_| 1e300, 1e9, &set).is_err());
        assert!(caputo(0.999, |s| s / 5e-324, 5e-324, &set).is_err());
        assert!(riemann_liouville(1.5, |_| 1.0, &[1.0], 5e-324, &set).is_err());
    }
}
