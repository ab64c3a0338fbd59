//! Sums of sines and exponentials on a span, and the closed-form integrals of their products.
//!
//! Two waves with `u'' = alpha u` and `v'' = beta v` have `int u v dx = [u' v - u v']/(alpha - beta)`.

use crate::quadrature::gauss;
use crate::waves::cosine_and_sine;

/// The exponent of the second pair of waves.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Second {
    /// `kappa`.
    Decaying(f64),
    /// `mu`.
    Bounded(f64),
}

/// `a cos kx + b sin kx`.
#[derive(Debug, Clone, Copy)]
struct Oscillation {
    k: f64,
    a: f64,
    b: f64,
}

/// `c exp(-kappa x) + d exp(-kappa (l - x))`.
#[derive(Debug, Clone, Copy)]
struct Decay {
    kappa: f64,
    c: f64,
    d: f64,
}

/// `c C(x) + d S(x)`, with `C = cosh(sqrt(mu) x)` and `S = sinh(sqrt(mu) x)/sqrt(mu)`, nearly constant over the span.
#[derive(Debug, Clone, Copy)]
struct Slow {
    mu: f64,
    c: f64,
    d: f64,
}

/// Two pairs of waves.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Superposition {
    travelling: Oscillation,
    second: Pair,
}

#[derive(Debug, Clone, Copy)]
enum Pair {
    Travelling(Oscillation),
    Decaying(Decay),
    Slow(Slow),
}

impl Superposition {
    /// From the propagating pair `[k, a, b]` and the second one, whose amplitudes are `bounded(mu)`, those of
    /// `cosh(sqrt(mu) x)` and `sinh(sqrt(mu) x)/sqrt(mu)`, or `decaying`.
    pub fn new(
        [k, a, b]: [f64; 3],
        second: Second,
        length: f64,
        bounded: impl Fn(f64) -> [f64; 2],
        [c, d]: [f64; 2],
    ) -> Self {
        let second = match second {
            Second::Decaying(kappa) => Pair::Decaying(Decay { kappa, c, d }),
            Second::Bounded(mu) if mu * length * length < -1.0 => {
                let ([a, b], k) = (bounded(mu), (-mu).sqrt());
                Pair::Travelling(Oscillation { k, a, b: b / k })
            }
            Second::Bounded(mu) => {
                let [c, d] = bounded(mu);
                Pair::Slow(Slow { mu, c, d })
            }
        };
        Self { travelling: Oscillation { k, a, b }, second }
    }

    /// Integral of the product over `[0, length]`; `None` if `alpha - beta` may be too small to be divided by.
    pub fn product(&self, other: &Self, length: f64) -> Option<f64> {
        let (u, v) = (&self.travelling, &other.travelling);
        let first = u.product(v, length);
        Some(match (&self.second, &other.second) {
            (Pair::Decaying(p), Pair::Decaying(q)) => {
                first + q.mixed(u, length) + p.mixed(v, length) + p.product(q, length)
            }
            (Pair::Decaying(p), Pair::Travelling(q)) => {
                first + u.product(q, length) + p.mixed(v, length) + p.mixed(q, length)
            }
            (Pair::Travelling(p), Pair::Decaying(q)) => {
                first + p.product(v, length) + q.mixed(u, length) + q.mixed(p, length)
            }
            (Pair::Travelling(p), Pair::Travelling(q)) => {
                first + u.product(q, length) + p.product(v, length) + p.product(q, length)
            }
            (Pair::Slow(p), Pair::Slow(q)) => first + q.mixed(u, length)? + p.mixed(v, length)? + p.product(q, length),
            (Pair::Slow(p), Pair::Travelling(q)) => {
                first + u.product(q, length) + p.mixed(v, length)? + p.mixed(q, length)?
            }
            (Pair::Travelling(p), Pair::Slow(q)) => {
                first + p.product(v, length) + q.mixed(u, length)? + q.mixed(p, length)?
            }
            (Pair::Slow(_), Pair::Decaying(_)) | (Pair::Decaying(_), Pair::Slow(_)) => return None,
        })
    }
}

fn sinc(y: f64) -> f64 {
    if y.abs() < 1e-8 { 1.0 } else { y.sin() / y }
}

impl Oscillation {
    fn product(&self, other: &Self, length: f64) -> f64 {
        let (sum, difference) = (self.k + other.k, self.k - other.k);
        let (u, v) = ([self.a, self.b], [other.a, other.b]);
        // Integrals of cos(nu x) and sin(nu x).
        let cosine = |nu: f64| length * sinc(nu * length);
        let sine = |nu: f64| length * (0.5 * nu * length) * sinc(0.5 * nu * length).powi(2);
        0.5 * ((u[0] * v[0] + u[1] * v[1]) * cosine(difference)
            + (u[0] * v[0] - u[1] * v[1]) * cosine(sum)
            + (u[0] * v[1] + u[1] * v[0]) * sine(sum)
            + (u[1] * v[0] - u[0] * v[1]) * sine(difference))
    }
}

impl Decay {
    /// With an oscillation: the part that decays from the left and, after reflection, that from the right.
    fn mixed(&self, &Oscillation { k, a, b }: &Oscillation, length: f64) -> f64 {
        let Decay { kappa, c, d } = *self;
        let (sin, cos) = (k * length).sin_cos();
        let decay = (-kappa * length).exp();
        let with_cos = kappa + decay * (k * sin - kappa * cos);
        let with_sin = k - decay * (kappa * sin + k * cos);
        let (ar, br) = (a * cos + b * sin, a * sin - b * cos);
        (c * (a * with_cos + b * with_sin) + d * (ar * with_cos + br * with_sin)) / (k * k + kappa * kappa)
    }

    fn product(&self, other: &Self, length: f64) -> f64 {
        let (u, v, k, kappa) = ([self.c, self.d], [other.c, other.d], self.kappa, other.kappa);
        let sum = k + kappa;
        let same_end = -(-sum * length).exp_m1() / sum;
        let gap = (k - kappa).abs();
        let spread = if gap * length < 1e-8 { length } else { -(-gap * length).exp_m1() / gap };
        let opposite_ends = (-k.min(kappa) * length).exp() * spread;
        (u[0] * v[0] + u[1] * v[1]) * same_end + (u[0] * v[1] + u[1] * v[0]) * opposite_ends
    }
}

impl Slow {
    /// With an oscillation, if that is not nearly constant too.
    fn mixed(&self, &Oscillation { k, a, b }: &Oscillation, length: f64) -> Option<f64> {
        let Slow { mu, c, d } = *self;
        let difference = mu + k * k;
        let (sin, cos) = (k * length).sin_cos();
        let (even, odd) = cosine_and_sine(mu, length);
        let at_end = (a * cos + b * sin) * (c * mu * odd + d * even) - k * (b * cos - a * sin) * (c * even + d * odd);
        (difference * length * length > 1.0).then(|| (at_end - (a * d - k * b * c)) / difference)
    }

    fn product(&self, other: &Self, length: f64) -> f64 {
        let value = |slow: &Slow, x: f64| {
            let (even, odd) = cosine_and_sine(slow.mu, x);
            slow.c * even + slow.d * odd
        };
        gauss(length, |x| value(self, x) * value(other, x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Near the cutoff of a beam with shear the second pair of waves is nearly constant.
    #[test]
    fn products_with_a_slow_pair_are_their_quadratures() {
        let length = 1.3;
        for mu in [-0.9, -1e-3, 0.0, 1e-15, 0.3, 0.9].map(|angle| angle / (length * length)) {
            let slow = |k: f64, c: f64| {
                Superposition::new([k, 0.7, -0.4], Second::Bounded(mu), length, |_| [c, 1.1], [0.0; 2])
            };
            let fast = Superposition::new([40.0, 0.2, 0.9], Second::Bounded(-90.0), length, |_| [0.3, 5.0], [0.0; 2]);
            for (u, v) in [(slow(7.0, 0.5), slow(7.0, 0.5)), (slow(7.0, 0.5), slow(61.0, -2.0)), (slow(7.0, 0.5), fast)]
            {
                let at = |wave: &Superposition, x: f64| {
                    let turning = |Oscillation { k, a, b }: Oscillation| a * (k * x).cos() + b * (k * x).sin();
                    let second = match wave.second {
                        Pair::Travelling(oscillation) => turning(oscillation),
                        Pair::Decaying(_) => f64::NAN,
                        Pair::Slow(Slow { mu, c, d }) => {
                            let (even, odd) = cosine_and_sine(mu, x);
                            c * even + d * odd
                        }
                    };
                    turning(wave.travelling) + second
                };
                let panels = 60;
                let h = length / f64::from(panels);
                let panel = |i: i32| gauss(h, |x| at(&u, f64::from(i) * h + x) * at(&v, f64::from(i) * h + x));
                let known: f64 = (0..panels).map(panel).sum();
                let both_ways = [u.product(&v, length), v.product(&u, length)];
                assert!(
                    both_ways.iter().all(|found| (found.unwrap() - known).abs() < 1e-14),
                    "{mu}: {both_ways:?}, {known}"
                );
            }
        }
        // waves that may be equally fast have no such form
        let nearly = Superposition::new([0.5, 1.0, 1.0], Second::Bounded(0.1), length, |_| [1.0, 1.0], [0.0; 2]);
        assert_eq!(nearly.product(&nearly, length), None);
    }
}
