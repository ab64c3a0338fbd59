//! Integrals along a branch.

use gauss_quad::GaussLegendre;
use std::num::NonZeroUsize;
use std::sync::LazyLock;

static RULE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(NonZeroUsize::MIN.saturating_add(11)));

/// `int_from^to f` by the 12-point Gauss-Legendre rule.
pub(crate) fn smooth(from: f64, to: f64, f: impl FnMut(f64) -> f64) -> f64 {
    RULE.integrate(from, to, f)
}

/// `int_0^1 u^(3/2) ((u + rho) / (1 + rho))^k du` to rounding, for `k, rho >= 0`.
///
/// Panels shrink geometrically towards the singularity at zero, and slowly enough that the power
/// is smooth on each; the sum ends when what is left cannot change it.
pub(crate) fn power_moment(rho: f64, k: f64) -> f64 {
    let power = |u: f64| ((u + rho) / (1.0 + rho)).powf(k);
    let shrink = (-std::f64::consts::LN_2 / (0.25 * k).max(1.0)).exp();
    let (mut sum, mut upper) = (0.0, 1.0_f64);
    while 0.4 * upper.powf(2.5) * power(upper) > 1e-17 * sum {
        let lower = shrink * upper;
        sum += smooth(lower, upper, |u| u * u.sqrt() * power(u));
        upper = lower;
    }
    sum
}
