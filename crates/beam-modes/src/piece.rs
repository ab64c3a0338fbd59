//! A mode shape on one span: evaluation and exact integrals of products.
//!
//! Every solution on a span of length `l` has one of three forms:
//!
//! - long: `a cos kx + b sin kx` and a second pair of waves, `c exp(-kappa x) + d exp(-kappa (l - x))` if it decays,
//!   `c C(x) + d mu S(x)` with `C = cosh(sqrt(mu) x)`, `S = sinh(sqrt(mu) x)/sqrt(mu)` if it is bounded over the span or
//!   propagates (`mu < 0`); none of these overflows or cancels;
//! - short, for `w'''' = k^4 w` and `k l <= 1`: the four derivatives at the left end and the power series from there, because
//!   sines and exponentials would be nearly linearly dependent. A rigid-body motion is the short form with `k = 0`;
//! - series: the same for any short span, from the state at the left end (see `waves`).
//!
//! Axial modes use the long form with `c = d = 0` (and the short one for the rigid-body motion).

use crate::krylov::krylov;
use crate::quadrature::gauss;
use crate::superposition::{Second, Superposition};
use crate::waves::{Exponent, Form, State, Waves, cosine_and_sine};

#[derive(Debug, Clone, Copy)]
pub(crate) enum Piece {
    Long {
        k: f64,
        second: Second,
        length: f64,
        wave: [f64; 4],
        /// Rotation over displacement of either pair: the rotation is `t1 (b cos kx - a sin kx)` and
        /// `t2 (d exp(-kappa (l - x)) - c exp(-kappa x))` or `t2 (c S + d C)`.
        turns: [f64; 2],
    },
    Short {
        k: f64,
        length: f64,
        start: [f64; 4],
    },
    Series {
        waves: Waves,
        start: State,
    },
}

impl Piece {
    /// A wave of bending without shear, or an axial one: the rotation is the slope.
    pub fn slender(k: f64, length: f64, wave: [f64; 4]) -> Self {
        Piece::Long { k, second: Second::Decaying(k), length, wave, turns: [k, k] }
    }

    /// The solution with these amplitudes (long) or this left-end state (short), in units of its displacement.
    pub fn of_waves(waves: &Waves, amplitudes: [f64; 4]) -> Piece {
        let (k, length) = (waves.k, waves.length);
        let [a, b, c, d] = amplitudes;
        match waves.form {
            Form::Short if waves.plain => Piece::Short { k, length, start: [a, b * k, c * k * k, d * k * k * k] },
            Form::Short => Piece::Series { waves: *waves, start: amplitudes },
            Form::Long(pair) => {
                let [h1, h2] = pair.moments;
                let travelling = h1 / pair.travelling * k;
                let (second, wave, turn) = match pair.second {
                    Exponent::Decaying(kappa) => (Second::Decaying(k * kappa), [a, b, c, d], h2 / kappa * k),
                    // The odd function is mu sinh(sqrt(mu) x)/sqrt(mu) in x, not in k x.
                    Exponent::Bounded(mu) => (Second::Bounded(k * k * mu), [a, b, c, d / k], h2 * k * k),
                };
                Piece::Long { k: k * pair.travelling, second, length, wave, turns: [travelling, turn] }
            }
        }
    }

    /// The displacement at the distance `x` from the left end of the span.
    pub fn displacement(&self, x: f64) -> f64 {
        match *self {
            Piece::Long { k, second, length, wave: [a, b, c, d], .. } => {
                let (sin, cos) = (k * x).sin_cos();
                let rest = match second {
                    Second::Decaying(kappa) => c * (-kappa * x).exp() + d * (-kappa * (length - x)).exp(),
                    Second::Bounded(mu) => {
                        let (cosine, sine) = cosine_and_sine(mu, x);
                        c * cosine + d * mu * sine
                    }
                };
                (a * cos + b * sin) + rest
            }
            Piece::Short { k, start, .. } => short(k, &start, 0, x),
            Piece::Series { waves, start } => waves.series(&start, waves.k * x)[0],
        }
    }

    /// The slope of the displacement.
    pub fn slope(&self, x: f64) -> f64 {
        match *self {
            Piece::Long { k, second, length, wave: [a, b, c, d], .. } => {
                let (sin, cos) = (k * x).sin_cos();
                let rest = match second {
                    Second::Decaying(kappa) => kappa * (d * (-kappa * (length - x)).exp() - c * (-kappa * x).exp()),
                    Second::Bounded(mu) => {
                        let (cosine, sine) = cosine_and_sine(mu, x);
                        mu * (c * sine + d * cosine)
                    }
                };
                k * (b * cos - a * sin) + rest
            }
            Piece::Short { k, start, .. } => short(k, &start, 1, x),
            Piece::Series { waves, start } => waves.kinematics(&waves.series(&start, waves.k * x))[1],
        }
    }

    /// The rotation of the sections, which is the slope if there is no shear.
    pub fn rotation(&self, x: f64) -> f64 {
        match *self {
            Piece::Long { k, second, length, wave: [a, b, c, d], turns } => {
                let (sin, cos) = (k * x).sin_cos();
                let rest = match second {
                    Second::Decaying(kappa) => d * (-kappa * (length - x)).exp() - c * (-kappa * x).exp(),
                    Second::Bounded(mu) => {
                        let (cosine, sine) = cosine_and_sine(mu, x);
                        c * sine + d * cosine
                    }
                };
                turns[0] * (b * cos - a * sin) + turns[1] * rest
            }
            Piece::Short { k, start, .. } => short(k, &start, 1, x),
            Piece::Series { waves, start } => waves.kinematics(&waves.series(&start, waves.k * x))[2],
        }
    }

    /// The derivative of the rotation: bending moment over rigidity.
    pub fn curvature(&self, x: f64) -> f64 {
        match *self {
            Piece::Long { k, second, length, wave: [a, b, c, d], turns } => {
                let (sin, cos) = (k * x).sin_cos();
                let rest = match second {
                    Second::Decaying(kappa) => kappa * (c * (-kappa * x).exp() + d * (-kappa * (length - x)).exp()),
                    Second::Bounded(mu) => {
                        let (cosine, sine) = cosine_and_sine(mu, x);
                        c * cosine + d * mu * sine
                    }
                };
                turns[1] * rest - turns[0] * k * (a * cos + b * sin)
            }
            Piece::Short { k, start, .. } => short(k, &start, 2, x),
            Piece::Series { waves, start } => waves.kinematics(&waves.series(&start, waves.k * x))[3],
        }
    }

    fn values_mut(&mut self) -> &mut [f64; 4] {
        let (Piece::Long { wave: values, .. }
        | Piece::Short { start: values, .. }
        | Piece::Series { start: values, .. }) = self;
        values
    }

    /// Largest of the four coefficients of the piece.
    pub fn size(&self) -> f64 {
        let mut copy = *self;
        copy.values_mut().iter().fold(0.0, |size, v| v.abs().max(size))
    }

    pub fn scaled(mut self, factor: f64) -> Self {
        self.values_mut().iter_mut().for_each(|v| *v *= factor);
        self
    }

    /// `self + factor * other` for two pieces whose wave numbers may differ in the last digits.
    pub fn plus(self, factor: f64, other: &Self) -> Self {
        let (mut sum, mut other) = self.alike(*other);
        sum.values_mut().iter_mut().zip(other.values_mut()).for_each(|(v, o)| *v += factor * *o);
        sum
    }

    /// Both pieces in one form, if one is just below and the other just above the limit between two forms.
    fn alike(self, other: Self) -> (Self, Self) {
        match (self, other) {
            (Piece::Long { second: u, .. }, Piece::Long { second: v, .. })
                if std::mem::discriminant(&u) != std::mem::discriminant(&v) =>
            {
                (self.bounded(), other.bounded())
            }
            (Piece::Short { .. }, Piece::Long { .. }) | (Piece::Long { .. }, Piece::Short { .. }) => {
                (self.shortened(), other.shortened())
            }
            (Piece::Series { waves, .. }, Piece::Long { .. }) => (self, other.as_series(waves)),
            (Piece::Long { .. }, Piece::Series { waves, .. }) => (self.as_series(waves), other),
            _ => (self, other),
        }
    }

    /// The same piece in short form, for bending without shear.
    fn shortened(self) -> Self {
        match self {
            Piece::Long { k, length, wave: [a, b, c, d], .. } => {
                let far = d * (-k * length).exp();
                let (even, odd) = (c + far, far - c);
                let start = [a + even, k * (b + odd), k * k * (even - a), k * k * k * (odd - b)];
                Piece::Short { k, length, start }
            }
            other => other,
        }
    }

    /// The same piece with a decaying pair in the form of a bounded one.
    fn bounded(self) -> Self {
        match self {
            Piece::Long { k, second: Second::Decaying(kappa), length, wave: [a, b, c, d], turns } => {
                let far = d * (-kappa * length).exp();
                let wave = [a, b, c + far, (far - c) / kappa];
                Piece::Long {
                    k,
                    second: Second::Bounded(kappa * kappa),
                    length,
                    wave,
                    turns: [turns[0], turns[1] * kappa],
                }
            }
            other => other,
        }
    }

    /// The same piece from its state at the left end.
    fn as_series(self, waves: Waves) -> Self {
        match self.bounded() {
            Piece::Long { k, wave: [_, b, _, d], .. } => {
                // The shear force is the integral of the displacement.
                let integral = d - b / k;
                let start = waves.state(self.displacement(0.0), self.rotation(0.0), self.curvature(0.0), integral);
                Piece::Series { waves, start }
            }
            other => other,
        }
    }

    /// The same shape from the other end of the span.
    pub fn reflected(self) -> Self {
        match self {
            Piece::Long { k, second, length, wave: [a, b, c, d], turns } => {
                let (sin, cos) = (k * length).sin_cos();
                let [c, d] = match second {
                    Second::Decaying(_) => [d, c],
                    Second::Bounded(mu) => {
                        let (cosine, sine) = cosine_and_sine(mu, length);
                        [c * cosine + d * mu * sine, -(c * sine + d * cosine)]
                    }
                };
                Piece::Long { k, second, length, wave: [a * cos + b * sin, a * sin - b * cos, c, d], turns }
            }
            Piece::Short { k, length, start } => {
                let at_end = [0, 1, 2, 3].map(|order| short(k, &start, order, length));
                Piece::Short { k, length, start: [at_end[0], -at_end[1], at_end[2], -at_end[3]] }
            }
            Piece::Series { waves, start } => {
                let [w, t, m, v] = waves.series(&start, waves.k * waves.length);
                Piece::Series { waves, start: [w, -t, m, -v] }
            }
        }
    }

    /// Integral of the displacement over the span, in closed form for a long piece.
    pub fn integral(&self) -> f64 {
        match *self {
            Piece::Long { k, second, length, wave: [a, b, c, d], .. } => {
                let (half_sin, half_cos) = (0.5 * k * length).sin_cos();
                let oscillation = 2.0 * half_sin * (a * half_cos + b * half_sin);
                match second {
                    Second::Decaying(kappa) if kappa == k => (oscillation - (c + d) * (-k * length).exp_m1()) / k,
                    Second::Decaying(kappa) => oscillation / k - (c + d) * (-kappa * length).exp_m1() / kappa,
                    Second::Bounded(mu) => {
                        let (_, sine) = cosine_and_sine(mu, length);
                        let (_, half) = cosine_and_sine(mu, 0.5 * length);
                        oscillation / k + c * sine + d * 2.0 * mu * half * half
                    }
                }
            }
            Piece::Short { length, .. } => gauss(length, |x| self.displacement(x)),
            Piece::Series { waves, .. } => gauss(waves.length, |x| self.displacement(x)),
        }
    }

    /// Integral of the product of the displacements over the span: closed form for two long pieces; Gauss's rule of degree 19
    /// on panels of a few radians otherwise, and if two pairs of waves are nearly constant over the span.
    pub fn product(&self, other: &Self) -> f64 {
        let closed = |u: Superposition| u.product(&other.displacement_waves()?, self.length());
        self.displacement_waves()
            .and_then(closed)
            .unwrap_or_else(|| self.quadrature(other, |piece, x| piece.displacement(x)))
    }

    /// Integral of the product of the rotations.
    pub fn rotation_product(&self, other: &Self) -> f64 {
        let closed = |u: Superposition| u.product(&other.rotation_waves()?, self.length());
        self.rotation_waves().and_then(closed).unwrap_or_else(|| self.quadrature(other, |piece, x| piece.rotation(x)))
    }

    fn quadrature(&self, other: &Self, value: impl Fn(&Self, f64) -> f64) -> f64 {
        let length = self.length();
        let phase = |piece: &Self| match *piece {
            Piece::Long { k, .. } => k * length,
            Piece::Short { .. } | Piece::Series { .. } => 0.0,
        };
        let panels = ((phase(self) + phase(other)) / 6.0).ceil().max(1.0);
        let h = length / panels;
        let panel = |i: usize| gauss(h, |x| value(self, i as f64 * h + x) * value(other, i as f64 * h + x));
        (0..panels as usize).map(panel).sum()
    }

    fn length(&self) -> f64 {
        match self {
            Piece::Long { length, .. } | Piece::Short { length, .. } => *length,
            Piece::Series { waves, .. } => waves.length,
        }
    }

    fn displacement_waves(&self) -> Option<Superposition> {
        let Piece::Long { k, second, length, wave: [a, b, c, d], .. } = *self else { return None };
        Some(Superposition::new([k, a, b], second, length, |mu| [c, d * mu], [c, d]))
    }

    fn rotation_waves(&self) -> Option<Superposition> {
        let Piece::Long { k, second, length, wave: [a, b, c, d], turns: [t1, t2] } = *self else { return None };
        Some(Superposition::new([k, t1 * b, -t1 * a], second, length, |_| [t2 * d, t2 * c], [-t2 * c, t2 * d]))
    }
}

/// The derivative of the given order (0 to 3) of a solution of `w'''' = k^4 w`, from those at `x = 0`.
fn short(k: f64, start: &[f64; 4], order: usize, x: f64) -> f64 {
    let series = krylov(k * x);
    let k4 = k.powi(4);
    let term = |j: usize| {
        if j >= order {
            start[j] * series[j - order] * x.powi((j - order) as i32)
        } else {
            start[j] * series[4 + j - order] * x.powi((4 + j - order) as i32) * k4
        }
    };
    term(0) + term(1) + term(2) + term(3)
}
