//! Integrals along a branch.

use gauss_quad::GaussLegendre;
use std::num::NonZeroUsize;
use std::sync::LazyLock;

static RULE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(NonZeroUsize::MIN.saturating_add(11)));

/// `int_from^to f`, where `f` may begin or end like a power 3/2, as contact forces do: the substitution
/// `from + (to - from) s^2 (3 - 2 s)` makes it a smooth function of `s`.
pub(crate) fn between_events(from: f64, to: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let length = to - from;
    RULE.integrate(0.0, 1.0, |s| 6.0 * s * (1.0 - s) * f(from + length * s * s * (3.0 - 2.0 * s))) * length
}

/// `int_0^1 u^(3/2) ((u + rho) / (1 + rho))^k du` to rounding (times `k` where that is large), for
/// `k, rho >= 0`.
///
/// Panels shrink geometrically towards the singularity at zero, slowly enough that the power is smooth on each; the sum ends
/// when the remainder cannot change it.
pub(crate) fn power_moment(rho: f64, k: f64) -> f64 {
    let power = |u: f64| ((u + rho) / (1.0 + rho)).powf(k);
    let shrink = (-std::f64::consts::LN_2 / (0.25 * k).max(1.0)).exp();
    let (mut sum, mut upper) = (0.0, 1.0_f64);
    while 0.4 * upper.powf(2.5) * power(upper) > 1e-17 * sum {
        let lower = shrink * upper;
        sum += RULE.integrate(lower, upper, |u| u * u.sqrt() * power(u));
        upper = lower;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::power_moment;

    #[test]
    fn moments_with_a_closed_form() {
        for rho in [0.0, 1e-12, 1e-3, 1.0, 1e6, 1e30] {
            let expected = [
                (0.0, 0.4),
                (1.0, (1.0 / 3.5 + rho / 2.5) / (1.0 + rho)),
                (2.0, (1.0 / 4.5 + rho * (2.0 / 3.5 + rho / 2.5)) / (1.0 + rho) / (1.0 + rho)),
            ];
            for (k, moment) in expected {
                assert!((power_moment(rho, k) / moment - 1.0).abs() < 1e-14, "{rho} {k}");
            }
        }
        for k in [0.01, 0.4, 4.0, 37.0, 1000.0] {
            // A power k multiplies the rounding of its base by k.
            assert!((power_moment(0.0, k) * (2.5 + k) - 1.0).abs() < 1e-15 * (10.0 + k), "{k}");
        }
    }
}
