//! Operators on a given function, by Gauss-Jacobi rules that represent the weak singularity.

use super::{require_order, start_terms};
use crate::quadrature::Rule;
use invalid_input::InvalidInput;
use libm::tgamma;

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

/// A value, and the difference between the last two rules, which is a bound on the error for smooth functions.
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
    weighted(order, |s, _| f(s), t, settings)?.scaled(1.0 / tgamma(order + 1.0), t)
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
    // The difference quotient is smooth, and the weight (t-s)^(-a) remains.
    let quotient = |s: f64, lag: f64| (end - g(s)) / lag;
    let rest = weighted(1.0 - a, quotient, t, settings)?;
    let boundary = (end - finite(g(0.0), 0.0)?) * t.powf(-a);
    // the mean times 1/(1 - a) is the integral, and (1 - a) Gamma(1 - a) = Gamma(2 - a)
    let value = (1.0 - a) * boundary + a * rest.value;
    Estimate { value, error: a * rest.error }.scaled(1.0 / tgamma(2.0 - a), t)
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
    Estimate { value: caputo.value + start_terms(order, &initial[..count], t), ..caputo }.scaled(1.0, t)
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

/// `order int_0^t (t-s)^(order-1) f(s, t-s) ds` with rules of 8, 16, ... 256 nodes until two agree.
fn weighted(order: f64, f: impl Fn(f64, f64) -> f64, t: f64, settings: &Quadrature) -> Result<Estimate, InvalidInput> {
    settings.check()?;
    require_time(t)?;
    if t == 0.0 {
        return Ok(Estimate { value: 0.0, error: 0.0 });
    }
    let q = settings.mapping;
    let mut last: Option<f64> = None;
    let mut estimate = Estimate { value: 0.0, error: f64::INFINITY };
    for nodes in [8, 16, 32, 64, 128, 256] {
        let rule = Rule::jacobi(nodes, order);
        let (mut sum, mut magnitude) = (0.0, 0.0);
        for (&u, &w) in rule.nodes.iter().zip(&rule.weights) {
            // s = t x^q with x = 1 - u, and 1 - x^q = u (1 + x + ... + x^(q-1))
            let x = 1.0 - u;
            let series = (0..q).fold(0.0, |sum, _| sum * x + 1.0);
            let s = t * x.powi(q as i32);
            let value = finite(f(s, t * u * series), s)?;
            let term = w * series.powf(order - 1.0) * f64::from(q) * x.powi(q as i32 - 1) * value;
            sum += term;
            magnitude += term.abs();
        }
        let scale = t.powf(order);
        if let Some(last) = last {
            let error = scale * (sum - last).abs();
            // If the difference no longer decreases, it is rounding, which more nodes near the singularity would increase.
            if error > 0.5 * estimate.error && error <= 1e-8 * scale * magnitude {
                break;
            }
            estimate = Estimate { value: scale * sum, error };
            if error <= settings.tolerance * scale * magnitude {
                break;
            }
        }
        last = Some(sum);
    }
    Ok(estimate)
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
        assert!((plain.value - exact).abs() > 1e-9 && (plain.value - exact).abs() < 10.0 * plain.error);
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
