//! A polynomial on a panel. Its values at the nodes are a [`Nodal`], its coefficients a [`Legendre`]: two types, so that one cannot
//! be taken for the other.

use super::vector::vectorized;

/// Number of nodes on a step. The force on a step is a polynomial of degree `Q - 1`.
pub(crate) const Q: usize = 8;
/// Values at the nodes, or a row of as many numbers; the coefficients of a polynomial are a [`Legendre`].
pub(crate) type Nodal = [f64; Q];

/// Of the recurrence `(n+1) P_{n+1} = (2n+1) x P_n - n P_{n-1}`.
const FACTORS: [(f64, f64); Q] = {
    let mut factors = [(0.0, 0.0); Q];
    let mut n = 1;
    while n < Q {
        factors[n] = ((2 * n + 1) as f64 / (n + 1) as f64, n as f64 / (n + 1) as f64);
        n += 1;
    }
    factors
};

/// `P_0 .. P_{Q-1}` of `2 s - 1`.
pub(crate) fn legendre(s: f64) -> Nodal {
    let x = 2.0 * s - 1.0;
    let mut p = [1.0; Q];
    p[1] = x;
    for n in 1..Q - 1 {
        p[n + 1] = FACTORS[n].0 * x * p[n] - FACTORS[n].1 * p[n - 1];
    }
    p
}

/// `P_Q`, from these.
pub(crate) fn next_legendre(s: f64, p: &Nodal) -> f64 {
    let (with, without) = FACTORS[Q - 1];
    with * (2.0 * s - 1.0) * p[Q - 1] - without * p[Q - 2]
}

/// Inner product of two short vectors.
pub(crate) fn dot(a: &Nodal, b: &Nodal) -> f64 {
    let mut sum = 0.0;
    for i in 0..Q {
        sum += a[i] * b[i];
    }
    sum
}

/// Coefficients of the Legendre polynomials `P_n(2s - 1)`, `n = 0, 1, ...`, in a power of `s` that is no whole number.
#[cfg(test)]
pub(crate) fn coefficients(power: f64) -> impl Iterator<Item = f64> {
    let first = 1.0 / (power + 1.0);
    let next = move |coefficient: &mut f64, n: u32| {
        let n = f64::from(n);
        *coefficient *= (2.0 * n + 1.0) / (2.0 * n - 1.0) * (power + 1.0 - n) / (power + 1.0 + n);
        Some(*coefficient)
    };
    std::iter::once(first).chain((1..).scan(first, next))
}

/// A polynomial of degree `Q - 1` on [0, 1], `sum_n c_n P_n(2s-1)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Legendre(pub [f64; Q]);

/// Intervals of the grid from which a maximum is searched.
const GRID: usize = 16;

impl Legendre {
    /// Its value at `s`.
    pub fn at(&self, s: f64) -> f64 {
        dot(&self.0, &legendre(s))
    }

    /// Its values at 0 and at 1.
    pub fn at_ends(&self) -> [f64; 2] {
        let (mut even, mut odd) = (0.0, 0.0);
        for pair in self.0.chunks_exact(2) {
            even += pair[0];
            odd += pair[1];
        }
        [even - odd, even + odd]
    }

    /// Its slopes at 0 and at 1.
    pub fn slopes_at_ends(&self) -> [f64; 2] {
        // P_n' is n (n+1) at 1, of this sign or the other at 0
        let slopes = Legendre(std::array::from_fn(|n| (n * (n + 1)) as f64 * self.0[n]));
        let [at_start, at_end] = slopes.at_ends();
        [-at_start, at_end]
    }

    /// Its values at as many places as there are nodes.
    pub fn at_each(&self, places: &[f64; Q]) -> [f64; Q] {
        let Legendre(coefficients) = self;
        vectorized(
            #[inline(always)]
            || {
                let mut x = [0.0; Q];
                for i in 0..Q {
                    x[i] = 2.0 * places[i] - 1.0;
                }
                let (mut before, mut last) = ([1.0; Q], x);
                let mut sum = [0.0; Q];
                for i in 0..Q {
                    sum[i] = coefficients[0] + coefficients[1] * x[i];
                }
                for n in 1..Q - 1 {
                    let (with, without) = FACTORS[n];
                    for i in 0..Q {
                        let next = with * x[i] * last[i] - without * before[i];
                        sum[i] += coefficients[n + 1] * next;
                        (before[i], last[i]) = (last[i], next);
                    }
                }
                sum
            },
        )
    }

    /// Its mean over [0, 1].
    pub fn mean(&self) -> f64 {
        self.0[0]
    }

    /// Its derivative.
    pub fn derivative(&self) -> Legendre {
        // d/ds P_n(2s-1) = 2 (2m+1) P_m summed over m = n-1, n-3, ..
        let mut slope = [0.0; Q];
        for n in 0..Q {
            for m in (0..n).rev().step_by(2) {
                slope[m] += 2.0 * (2 * m + 1) as f64 * self.0[n];
            }
        }
        Legendre(slope)
    }

    /// Truncation estimate: its next two coefficients, extrapolated from the last two and the two before. Pairs are used because
    /// a single coefficient may vanish by accident.
    pub fn truncation(&self) -> f64 {
        let Legendre(coefficients) = self;
        let last = coefficients[Q - 1].abs().max(coefficients[Q - 2].abs());
        let before = coefficients[Q - 3].abs().max(coefficients[Q - 4].abs());
        if last < before { last * (last / before) } else { last }
    }

    /// Place and value of its maximum on [0, 1].
    pub fn maximum(&self) -> (f64, f64) {
        let mut best = (0.0, self.at(0.0));
        for first in [1, GRID / 2 + 1] {
            let places = std::array::from_fn(|i| (first + i) as f64 / GRID as f64);
            for (place, value) in places.into_iter().zip(self.at_each(&places)) {
                if value > best.1 {
                    best = (place, value);
                }
            }
        }
        let slope = self.derivative();
        let bend = slope.derivative();
        for _ in 0..8 {
            let (place, value) = best;
            let next = place - slope.at(place) / bend.at(place);
            let there = self.at(next);
            if next == place || !((0.0..=1.0).contains(&next) && there >= value) {
                break;
            }
            best = (next, there);
        }
        best
    }
}
