//! A mode shape on one span: evaluation and exact integrals of products.
//!
//! Every solution of `w'''' = k^4 w` on a span of length `l` is held in one of two forms:
//!
//! - long (`k l > 1`): `a cos kx + b sin kx + c exp(-kx) + d exp(-k(l-x))`, which neither overflows nor cancels;
//! - short: the four derivatives at the left end and the power series that continue them. Here sines and
//!   exponentials would be nearly dependent. A rigid-body motion is the short form with `k = 0`.
//!
//! Axial modes use the long form with `c = d = 0` (and the short one for the rigid motion).

/// Up to this value of `k l` a span is short.
pub(crate) const SHORT: f64 = 1.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Piece {
    Long { k: f64, length: f64, wave: [f64; 4] },
    Short { k: f64, length: f64, start: [f64; 4] },
}

/// `[1/m!, 1/(m+4)!, 1/(m+8)!, ...]` for m = 0..4.
const TAYLOR: [[f64; 6]; 4] = {
    let mut table = [[0.0; 6]; 4];
    let (mut n, mut inverse_factorial) = (0, 1.0);
    while n < 24 {
        table[n % 4][n / 4] = inverse_factorial;
        n += 1;
        inverse_factorial /= n as f64;
    }
    table
};

/// `sum_i (y^4)^i / (4i+m)!` for m = 0..4: times `y^m`, these are the functions of Krylov, `(cosh y + cos y)/2` and on.
pub(crate) fn krylov(y: f64) -> [f64; 4] {
    let y4 = (y * y) * (y * y);
    TAYLOR.map(|row| row.iter().rev().fold(0.0, |sum, coefficient| sum * y4 + coefficient))
}

impl Piece {
    /// The derivative of the given order (0 to 3) at the distance `x` from the left end of the span.
    pub fn derivative(&self, order: usize, x: f64) -> f64 {
        match *self {
            Piece::Long { k, length, wave: [a, b, c, d] } => {
                let (sin, cos) = (k * x).sin_cos();
                let (oscillation, parity) = match order % 4 {
                    0 => (a * cos + b * sin, 1.0),
                    1 => (b * cos - a * sin, -1.0),
                    2 => (-a * cos - b * sin, 1.0),
                    _ => (a * sin - b * cos, -1.0),
                };
                let evanescent = parity * c * (-k * x).exp() + d * (-k * (length - x)).exp();
                (oscillation + evanescent) * k.powi(order as i32)
            }
            Piece::Short { k, start, .. } => {
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
        }
    }

    /// Largest of the four numbers that make up the piece.
    pub fn size(&self) -> f64 {
        let (Piece::Long { wave: values, .. } | Piece::Short { start: values, .. }) = self;
        values.iter().fold(0.0, |size, v| v.abs().max(size))
    }

    pub fn scaled(mut self, factor: f64) -> Self {
        let (Piece::Long { wave: values, .. } | Piece::Short { start: values, .. }) = &mut self;
        values.iter_mut().for_each(|v| *v *= factor);
        self
    }

    /// `self + factor * other` for two pieces whose wave numbers may differ in the last digits.
    pub fn plus(mut self, factor: f64, other: &Self) -> Self {
        if std::mem::discriminant(&self) != std::mem::discriminant(other) {
            // one just below, one just above the limit between the forms
            return self.shortened().plus(factor, &other.shortened());
        }
        let (Piece::Long { wave: values, .. } | Piece::Short { start: values, .. }) = &mut self;
        let (Piece::Long { wave: others, .. } | Piece::Short { start: others, .. }) = other;
        values.iter_mut().zip(others).for_each(|(v, o)| *v += factor * o);
        self
    }

    /// The same piece in short form.
    fn shortened(&self) -> Self {
        let (Piece::Long { k, length, .. } | Piece::Short { k, length, .. }) = *self;
        Piece::Short { k, length, start: [0, 1, 2, 3].map(|order| self.derivative(order, 0.0)) }
    }

    /// The same shape seen from the other end of the span.
    pub fn reflected(self) -> Self {
        match self {
            Piece::Long { k, length, wave: [a, b, c, d] } => {
                let (sin, cos) = (k * length).sin_cos();
                Piece::Long { k, length, wave: [a * cos + b * sin, a * sin - b * cos, d, c] }
            }
            Piece::Short { k, length, .. } => {
                let at_end = [0, 1, 2, 3].map(|order| self.derivative(order, length));
                Piece::Short { k, length, start: [at_end[0], -at_end[1], at_end[2], -at_end[3]] }
            }
        }
    }

    /// Integral over the span, in closed form for a long piece.
    pub fn integral(&self) -> f64 {
        match *self {
            Piece::Long { k, length, wave: [a, b, c, d] } => {
                let (half_sin, half_cos) = (0.5 * k * length).sin_cos();
                let oscillation = 2.0 * half_sin * (a * half_cos + b * half_sin);
                (oscillation - (c + d) * (-k * length).exp_m1()) / k
            }
            Piece::Short { length, .. } => gauss(length, |x| self.derivative(0, x)),
        }
    }

    /// Integral of the product over the span. Two long pieces: closed form. Otherwise, `k l` is at most about 1 and
    /// Gauss's rule, of degree 19, is exact to rounding.
    pub fn product(&self, other: &Self) -> f64 {
        match (*self, *other) {
            (Piece::Long { k, length, wave: u }, Piece::Long { k: kappa, wave: v, .. }) => {
                long_product(k, kappa, length, u, v)
            }
            (Piece::Short { length, .. }, _) | (_, Piece::Short { length, .. }) => {
                gauss(length, |x| self.derivative(0, x) * other.derivative(0, x))
            }
        }
    }
}

/// Positive nodes and weights of Gauss's rule with ten points (Abramowitz and Stegun, table 25.4).
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_22, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// Gauss's rule with ten points on `[0, length]`: exact for polynomials up to degree 19.
pub(crate) fn gauss(length: f64, f: impl Fn(f64) -> f64) -> f64 {
    let half = 0.5 * length;
    GAUSS.iter().map(|(node, weight)| half * weight * (f(half * (1.0 + node)) + f(half * (1.0 - node)))).sum()
}

fn sinc(y: f64) -> f64 {
    if y.abs() < 1e-8 { 1.0 } else { y.sin() / y }
}

fn long_product(k: f64, kappa: f64, length: f64, u: [f64; 4], v: [f64; 4]) -> f64 {
    let (sum, difference) = (k + kappa, k - kappa);
    // integrals of cos(nu x) and sin(nu x)
    let cosine = |nu: f64| length * sinc(nu * length);
    let sine = |nu: f64| length * (0.5 * nu * length) * sinc(0.5 * nu * length).powi(2);
    let oscillations = 0.5
        * ((u[0] * v[0] + u[1] * v[1]) * cosine(difference)
            + (u[0] * v[0] - u[1] * v[1]) * cosine(sum)
            + (u[0] * v[1] + u[1] * v[0]) * sine(sum)
            + (u[1] * v[0] - u[0] * v[1]) * sine(difference));

    // an oscillation of one with an exponential of the other, decaying from the left and, after reflection, from the right
    let mixed = |k: f64, [a, b, _, _]: [f64; 4], kappa: f64, [_, _, c, d]: [f64; 4]| {
        let (sin, cos) = (k * length).sin_cos();
        let decay = (-kappa * length).exp();
        let with_cos = kappa + decay * (k * sin - kappa * cos);
        let with_sin = k - decay * (kappa * sin + k * cos);
        let (ar, br) = (a * cos + b * sin, a * sin - b * cos);
        (c * (a * with_cos + b * with_sin) + d * (ar * with_cos + br * with_sin)) / (k * k + kappa * kappa)
    };

    let same_end = -(-sum * length).exp_m1() / sum;
    let gap = difference.abs();
    let spread = if gap * length < 1e-8 { length } else { -(-gap * length).exp_m1() / gap };
    let opposite_ends = (-k.min(kappa) * length).exp() * spread;
    let exponentials = (u[2] * v[2] + u[3] * v[3]) * same_end + (u[2] * v[3] + u[3] * v[2]) * opposite_ends;

    oscillations + mixed(k, u, kappa, v) + mixed(kappa, v, k, u) + exponentials
}
