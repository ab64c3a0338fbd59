//! The exact waves of one span at one frequency, by either theory of bending.
//!
//! Every span satisfies one linear system for displacement `w`, rotation `t`, moment `M` and shear force `V`:
//!
//! ```text
//! w' = t + s V,    t' = M / EI,    M' = -V - j t,    V' = -p w,
//! p = m omega^2 - foundation,    j = rho I omega^2 - tension,    s = 1/(kappa G A).
//! ```
//!
//! Euler-Bernoulli's beam has `s = 0` and `rho I = 0`; Timoshenko's has neither tension nor foundation here. With the scaling
//! wave number `k`, `k^4 EI = max(p, foundation)`, the state `z = sqrt(EI k^3) (w, t/k, M/(EI k^2), -V/(EI k^3))` depends on
//! `xi = k x` by
//!
//! ```text
//! z0' = z1 - S z3,    z1' = z2,    z2' = z3 - J z1,    z3' = P z0,      S = s EI k^2,   J = j/(EI k^2),   P = p/(EI k^4).
//! ```
//!
//! For `P = 1` its exponents are `+-i kappa_1`, `kappa_1^2 = (S + J + D)/2`, and `+-sqrt(mu)`, `mu = (D - S - J)/2`, with
//! `D^2 = (S - J)^2 + 4`: a wave that propagates, and a pair that decays below Timoshenko's cut-off `S J = 1` and propagates
//! above it (the second spectrum). Their product `kappa_1^2 mu = 1 - S J` is free of cancellation. Without shear, rotary
//! inertia and tension both are 1, and every product with them is exact.

use crate::krylov::krylov;
use crate::span::Span;

pub(crate) type State = [f64; 4];

/// Up to this value of `k l` (and of the exponents times `l`) a span is short: sines and exponentials would be nearly
/// dependent, and power series replace them.
pub(crate) const SHORT: f64 = 1.0;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Waves {
    /// The scaling wave number.
    pub k: f64,
    pub length: f64,
    shear: f64,
    rotary: f64,
    inertia: f64,
    /// Whether there is neither shear nor rotary inertia nor tension nor foundation.
    pub plain: bool,
    pub form: Form,
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum Form {
    Short,
    Long(Pair),
}

/// The two pairs of waves of a long span.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pair {
    /// `kappa_1`.
    pub travelling: f64,
    pub second: Exponent,
    /// `kappa_1^2 - S` and `mu + S`: moment over displacement of either pair; their sum is `D`.
    pub moments: [f64; 2],
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum Exponent {
    /// `sqrt(mu)` of a pair that decays from both ends.
    Decaying(f64),
    /// `mu` of a pair that has a similar size over the whole span.
    Bounded(f64),
}

/// `cosh(sqrt(mu) x)` and `sinh(sqrt(mu) x)/sqrt(mu)` for `mu` of either sign.
pub(crate) fn cosine_and_sine(mu: f64, x: f64) -> (f64, f64) {
    let root = mu.abs().sqrt();
    let y = root * x;
    if y < 1e-9 {
        (1.0, x)
    } else if mu > 0.0 {
        (y.cosh(), y.sinh() / root)
    } else {
        let (sin, cos) = y.sin_cos();
        (cos, sin / root)
    }
}

impl Waves {
    /// The waves at `omega = q^2`.
    pub fn new(span: &Span, k: f64, q: f64) -> Self {
        let length = span.length;
        if span.is_plain() {
            let pair = Pair { travelling: 1.0, second: Exponent::Decaying(1.0), moments: [1.0, 1.0] };
            let form = if k * length <= SHORT { Form::Short } else { Form::Long(pair) };
            return Self { k, length, shear: 0.0, rotary: 0.0, inertia: 1.0, plain: true, form };
        }
        let omega2 = (q * q) * (q * q);
        let unit = span.rigidity * k * k;
        let shear = span.shear * unit;
        let rotary = (span.rotary * omega2 - span.tension) / unit;
        let load = span.mass * omega2 - span.foundation;
        let inertia = if load >= span.foundation { 1.0 } else { load / (unit * k * k) };
        let (sum, difference) = (shear + rotary, shear - rotary);
        let root = difference.hypot(2.0);
        // The larger of the two by addition, the smaller by the product.
        let product = 1.0 - shear * rotary;
        let (squared, mu) = if sum > 0.0 {
            (0.5 * (sum + root), 2.0 * product / (sum + root))
        } else {
            (2.0 * product / (root - sum), 0.5 * (root - sum))
        };
        // The product of the two is 1.
        let moments = if difference > 0.0 {
            [2.0 / (root + difference), 0.5 * (root + difference)]
        } else {
            [0.5 * (root - difference), 2.0 / (root - difference)]
        };
        let y = k * length;
        let series = inertia != 1.0 || squared.max(mu.abs()) * y * y <= SHORT;
        let form = if series {
            Form::Short
        } else {
            let second =
                if mu.max(0.0).sqrt() * y > SHORT { Exponent::Decaying(mu.sqrt()) } else { Exponent::Bounded(mu) };
            Form::Long(Pair { travelling: squared.sqrt(), second, moments })
        };
        Self { k, length, shear, rotary, inertia, plain: false, form }
    }

    /// Half waves on the span, for estimates.
    pub fn half_waves(&self) -> f64 {
        let y = self.k * self.length;
        let waves = match self.form {
            Form::Short => y,
            Form::Long(Pair { travelling, second: Exponent::Bounded(mu), .. }) if mu < 0.0 => {
                (travelling + (-mu).sqrt()) * y
            }
            Form::Long(Pair { travelling, .. }) => travelling * y,
        };
        waves / std::f64::consts::PI
    }

    /// Propagates a state by `xi`, by power series; for short spans.
    pub fn series(&self, z: &State, xi: f64) -> State {
        if self.plain {
            let [c0, c1, c2, c3] = krylov(xi);
            let (c1, c2, c3) = (c1 * xi, c2 * xi * xi, c3 * xi * xi * xi);
            return [
                c0 * z[0] + c1 * z[1] + c2 * z[2] + c3 * z[3],
                c3 * z[0] + c0 * z[1] + c1 * z[2] + c2 * z[3],
                c2 * z[0] + c3 * z[1] + c0 * z[2] + c1 * z[3],
                c1 * z[0] + c2 * z[1] + c3 * z[2] + c0 * z[3],
            ];
        }
        let (mut sum, mut term) = (*z, *z);
        for n in 1..=40 {
            let [a, b, c, d] = term;
            let h = xi / f64::from(n);
            term = [h * (b - self.shear * d), h * c, h * (d - self.rotary * b), h * self.inertia * a];
            (0..4).for_each(|i| sum[i] += term[i]);
            if (0..4).all(|i| term[i].abs() <= 1e-18 * sum[i].abs()) {
                break;
            }
        }
        sum
    }

    /// Displacement, slope, rotation and curvature (the derivative of the rotation) of a state, in units of its displacement.
    pub fn kinematics(&self, z: &State) -> [f64; 4] {
        [z[0], self.k * (z[1] - self.shear * z[3]), self.k * z[1], self.k * self.k * z[2]]
    }
}

impl Waves {
    /// The state of a short span, from displacement, rotation, curvature and the integral of the displacement.
    pub fn state(&self, displacement: f64, rotation: f64, curvature: f64, integral: f64) -> State {
        [displacement, rotation / self.k, curvature / (self.k * self.k), self.inertia * self.k * integral]
    }
}

impl Pair {
    fn total(&self) -> f64 {
        self.moments[0] + self.moments[1]
    }

    /// `sqrt(mu)` of a decaying pair.
    pub fn decay(&self) -> Option<f64> {
        match self.second {
            Exponent::Decaying(kappa) => Some(kappa),
            Exponent::Bounded(_) => None,
        }
    }

    /// Amplitudes `a, b` of the propagating pair, and those of the second one: from the left and from the right if it decays,
    /// of its even and odd function if it is bounded.
    pub fn to_waves(self, z: &State) -> [f64; 4] {
        let ([h1, h2], total) = (self.moments, self.total());
        let even = (h2 * z[0] - z[2]) / total;
        let odd = self.travelling * ((z[1] - h2 * z[3]) / total);
        let (p, q) = ((z[2] + h1 * z[0]) / total, (z[1] + h1 * z[3]) / total);
        match self.second {
            Exponent::Decaying(kappa) => [even, odd, 0.5 * (p - kappa * q), 0.5 * (p + kappa * q)],
            Exponent::Bounded(_) => [even, odd, p, q],
        }
    }

    /// The state at the left end of the span, with the growing exponential normalised there.
    pub fn to_state(self, [a, b, c, d]: [f64; 4]) -> State {
        let ([h1, h2], k1) = (self.moments, self.travelling);
        match self.second {
            Exponent::Decaying(kappa) => {
                let (even, odd) = (c + d, d - c);
                [a + even, h1 / k1 * b + h2 / kappa * odd, h2 * even - h1 * a, odd / kappa - b / k1]
            }
            Exponent::Bounded(_) => [a + c, h1 / k1 * b + h2 * d, h2 * c - h1 * a, d - b / k1],
        }
    }

    /// Amplitudes with respect to a location `y = k x` further on; `factor` is common to all but the growing exponential, which
    /// is normalised at that location.
    pub fn carry(&self, [a, b, c, d]: [f64; 4], y: f64, factor: f64) -> [f64; 4] {
        let (sin, cos) = (self.travelling * y).sin_cos();
        let (even, odd) = (factor * (a * cos + b * sin), factor * (b * cos - a * sin));
        match self.second {
            Exponent::Decaying(kappa) => [even, odd, factor * decay(kappa * y) * c, d],
            Exponent::Bounded(mu) => {
                let (cosine, sine) = cosine_and_sine(mu, y);
                [even, odd, factor * (c * cosine + d * mu * sine), factor * (c * sine + d * cosine)]
            }
        }
    }
}

/// Below `exp(-600)` an exponential is negligible; this limit keeps every quotient finite.
pub(crate) fn decay(y: f64) -> f64 {
    (-y.min(600.0)).exp()
}

impl Waves {
    /// The span with its far end clamped: the number of its doubly clamped frequencies below the trial value, and its stiffness
    /// matrix at the near end, `[ww, wt, tt]` over the last number.
    ///
    /// For long spans, the stiffness is the mean of those for a symmetric and an antisymmetric motion of both ends, and the
    /// count is that of the pinned span, whose waves are sines, minus the negative eigenvalues of its stiffness against
    /// rotations of its ends (Wittrick and Williams).
    pub fn clamped(&self) -> (usize, [f64; 3], f64) {
        let y = self.k * self.length;
        let Form::Long(pair) = self.form else {
            let column = |i: usize| {
                let mut unit = [0.0; 4];
                unit[i] = 1.0;
                self.series(&unit, y)
            };
            let [u, v, m, n] = [0, 1, 2, 3].map(column);
            // Displacement and rotation vanish at the far end: solve for z_2, z_3 in terms of z_0, z_1.
            let stiffness = [m[1] * u[0] - m[0] * u[1], m[1] * v[0] - m[0] * v[1], v[0] * n[1] - v[1] * n[0]];
            return (0, stiffness, m[0] * n[1] - m[1] * n[0]);
        };
        let ([h1, h2], k1, total) = (pair.moments, pair.travelling, pair.total());
        let half = 0.5 * y;
        let (sin, cos) = (k1 * half).sin_cos();
        // Even and odd function of the second pair at the end, with respect to the middle; the odd one also times mu.
        let (even, odd, mu_odd, inside) = match pair.second {
            Exponent::Decaying(kappa) => {
                let far = decay(kappa * y);
                let (even, odd) = (0.5 * (1.0 + far), 0.5 * (1.0 - far));
                (even, odd / kappa, odd * kappa, 0.0)
            }
            Exponent::Bounded(mu) => {
                let (even, odd) = cosine_and_sine(mu, half);
                let travelling = if mu < 0.0 { ((-mu).sqrt() * y / std::f64::consts::PI).floor() + 1.0 } else { 0.0 };
                (even, odd, mu * odd, travelling)
            }
        };
        let symmetric = h2 * cos * odd + h1 / k1 * even * sin;
        let antisymmetric = h2 * even * sin - h1 / k1 * mu_odd * cos;
        let pinned = (k1 * y / std::f64::consts::PI).floor() + inside;
        let negative = usize::from((cos * even < 0.0) != (symmetric < 0.0))
            + usize::from((mu_odd * sin < 0.0) != (antisymmetric < 0.0));
        let count = (pinned as usize).saturating_sub(negative);
        // The two numerators over their common denominator; the sign of the mixed entry is that at the left end.
        let mean = |s: f64, a: f64| s * antisymmetric + a * symmetric;
        let stiffness = [
            mean(-total / k1 * sin * odd, total / k1 * cos * even),
            -mean(sin * even / k1 - odd * cos, -(cos * mu_odd / k1 + even * sin)),
            mean(total * cos * even, total * mu_odd * sin),
        ];
        (count, stiffness, 2.0 * symmetric * antisymmetric)
    }
}
