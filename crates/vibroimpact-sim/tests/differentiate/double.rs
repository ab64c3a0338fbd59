//! Numbers of some 32 digits: the unevaluated sum of two doubles (T. J. Dekker, *Numer. Math.* 18 (1971) 224).

use std::iter::Sum;
use std::ops::{Add, Div, Mul, Neg, Sub};

#[derive(Debug, Clone, Copy, Default)]
pub struct Double {
    /// The nearest double, and the remainder.
    pub near: f64,
    pub rest: f64,
}

impl Double {
    /// The exact sum of two doubles.
    #[inline(always)]
    pub fn sum(a: f64, b: f64) -> Double {
        let near = a + b;
        let of_b = near - a;
        Double { near, rest: (a - (near - of_b)) + (b - of_b) }
    }

    /// The same if `|b|` is small compared with `|a|`.
    #[inline(always)]
    fn renormalized(a: f64, b: f64) -> Double {
        let near = a + b;
        Double { near, rest: b - (near - a) }
    }

    pub fn sqrt(self) -> Double {
        let root = Double::from(self.near.sqrt());
        root + (self - root * root) / Double::from(2.0 * root.near)
    }

    /// `x^(2/5)`, by Newton's method on `y^5 = x^2`.
    pub fn two_fifths(self) -> Double {
        let square = self * self;
        (0..2).fold(Double::from(self.near.powf(0.4)), |y, _| {
            let fourth = (y * y) * (y * y);
            y - (fourth * y - square) / (Double::from(5.0) * fourth)
        })
    }
}

impl From<f64> for Double {
    #[inline(always)]
    fn from(near: f64) -> Double {
        Double { near, rest: 0.0 }
    }
}

impl Add for Double {
    type Output = Double;

    #[inline(always)]
    fn add(self, other: Double) -> Double {
        let near = Double::sum(self.near, other.near);
        let rest = Double::sum(self.rest, other.rest);
        let near = Double::renormalized(near.near, near.rest + rest.near);
        Double::renormalized(near.near, near.rest + rest.rest)
    }
}

impl Neg for Double {
    type Output = Double;

    #[inline(always)]
    fn neg(self) -> Double {
        Double { near: -self.near, rest: -self.rest }
    }
}

impl Sub for Double {
    type Output = Double;

    #[inline(always)]
    fn sub(self, other: Double) -> Double {
        self + -other
    }
}

impl Mul for Double {
    type Output = Double;

    #[inline(always)]
    fn mul(self, other: Double) -> Double {
        let near = self.near * other.near;
        let lost = self.near.mul_add(other.near, -near);
        Double::renormalized(near, lost + (self.near * other.rest + self.rest * other.near))
    }
}

impl Div for Double {
    type Output = Double;

    #[inline(always)]
    fn div(self, other: Double) -> Double {
        let near = Double::from(self.near / other.near);
        let next = Double::from((self - near * other).near / other.near);
        let last = Double::from((self - (near + next) * other).near / other.near);
        near + next + last
    }
}

impl Sum for Double {
    fn sum<I: Iterator<Item = Double>>(terms: I) -> Double {
        // partial sums, of which each waits for itself alone
        let mut sums = [Double::default(); 4];
        terms.enumerate().for_each(|(i, term)| sums[i % 4] = sums[i % 4] + term);
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }
}
