//! Sums of sines and exponentials on a span, and the closed-form integrals of their products.

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
}

impl Superposition {
    /// From the propagating pair `[k, a, b]` and the second one, whose amplitudes are `bounded(mu)`, those of
    /// `cosh(sqrt(mu) x)` and `sinh(sqrt(mu) x)/sqrt(mu)`, or `decaying`; `None` if it is nearly constant over the span.
    pub fn new(
        [k, a, b]: [f64; 3],
        second: Second,
        length: f64,
        bounded: impl Fn(f64) -> [f64; 2],
        [c, d]: [f64; 2],
    ) -> Option<Self> {
        let second = match second {
            Second::Decaying(kappa) => Pair::Decaying(Decay { kappa, c, d }),
            Second::Bounded(mu) if mu * length * length < -1.0 => {
                let ([a, b], k) = (bounded(mu), (-mu).sqrt());
                Pair::Travelling(Oscillation { k, a, b: b / k })
            }
            Second::Bounded(_) => return None,
        };
        Some(Self { travelling: Oscillation { k, a, b }, second })
    }

    /// Integral of the product over `[0, length]`.
    pub fn product(&self, other: &Self, length: f64) -> f64 {
        let (u, v) = (&self.travelling, &other.travelling);
        let first = u.product(v, length);
        match (&self.second, &other.second) {
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
        }
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
