//! Forces that begin or end on a panel as `t^(3/2)`, as Hertz's law has them.
//!
//! A polynomial of degree `Q - 1` through the nodes represents `s^(3/2)` to 1e-4 in the mean square only, however short the panel
//! is. So such a force is written `F(s) = w(s) P(s)`, `w = s^(3/2)` where it begins and `(1-s)^(3/2)` where it ends, with a
//! polynomial `P` through the nodes. The modes are moved by the polynomial of degree `Q - 1` that is closest to `F` in the mean
//! square: what is left out has no moments below degree `Q`, so that a mode that turns little on the panel hardly feels it. That
//! polynomial is linear in the nodal values of `F`, a constant matrix, and everything that acts on polynomials serves for it.

use super::legendre::{BASIS, Legendre, Matrix, Nodal, Q, apply, legendre};
use gauss_quad::legendre::GaussLegendre;
use gauss_quad::{FiniteAboveNegOneF64, GaussJacobi};
use std::f64::consts::FRAC_PI_2;
use std::num::NonZeroUsize;
use std::sync::LazyLock;

/// Exponent of the force at its beginning and at its end.
pub(crate) const EXPONENT: f64 = 1.5;

/// Whether a force begins on a panel, and ends on it, as `t^(3/2)`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Ends {
    pub at_start: bool,
    pub at_end: bool,
}

/// The constants of a weight `w`.
struct Weight {
    /// Nodal values of the force to those of the closest polynomial.
    acting: Matrix,
    /// `1/w` at the nodes.
    inverse: Nodal,
}

/// Gauss's rule on (0, 1) with the weight `s^(3/2)`: node and weight.
static BEGINNING: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    let [flat, rising] = [0.0, EXPONENT].map(|power| FiniteAboveNegOneF64::new(power).unwrap());
    let rule = GaussJacobi::new(const { NonZeroUsize::new(Q).unwrap() }, flat, rising);
    let scale = 0.5_f64.powf(EXPONENT + 1.0);
    rule.as_node_weight_pairs().iter().map(|(x, weight)| (0.5 * (1.0 + x), scale * weight)).collect()
});

static WEIGHTS: LazyLock<[Weight; 3]> = LazyLock::new(|| {
    [(true, false), (false, true), (true, true)].map(|(at_start, at_end)| Weight::new(Ends { at_start, at_end }))
});

impl Ends {
    /// A force without a singularity.
    pub const SMOOTH: Ends = Ends { at_start: false, at_end: false };

    pub fn is_smooth(self) -> bool {
        self == Ends::SMOOTH
    }

    fn weight(self) -> Option<&'static Weight> {
        match (self.at_start, self.at_end) {
            (false, false) => None,
            (true, false) => Some(&WEIGHTS[0]),
            (false, true) => Some(&WEIGHTS[1]),
            (true, true) => Some(&WEIGHTS[2]),
        }
    }

    /// `w(s)`.
    fn at(self, s: f64) -> f64 {
        let power = |has: bool, distance: f64| if has { distance.max(0.0).powf(EXPONENT) } else { 1.0 };
        power(self.at_start, s) * power(self.at_end, 1.0 - s)
    }

    /// The largest value of `w`.
    fn largest(self) -> f64 {
        self.at(if self.at_start == self.at_end { 0.5 } else { f64::from(u8::from(self.at_start)) })
    }

    /// Truncation estimate of the force, from `P`.
    pub fn truncation(self, quotient: &Legendre) -> f64 {
        self.largest() * quotient.truncation()
    }

    /// Nodal values of the polynomial that moves the modes, from those of the force.
    #[inline(always)]
    pub fn acting(self, force: &Nodal) -> Nodal {
        match self.weight() {
            None => *force,
            Some(weight) => apply(&weight.acting, force),
        }
    }

    /// A response to nodal values of that polynomial, as one to those of the force.
    #[inline(always)]
    pub fn response(self, response: &Matrix) -> Matrix {
        match self.weight() {
            None => *response,
            Some(weight) => {
                let mut product = [[0.0; Q]; Q];
                for j in 0..Q {
                    product[j] = apply(response, &weight.acting[j]);
                }
                product
            }
        }
    }

    /// `P`, from the nodal values of the force.
    pub fn quotient(self, force: &Nodal) -> Legendre {
        match self.weight() {
            None => Legendre::through(force),
            Some(weight) => Legendre::through(&std::array::from_fn(|i| weight.inverse[i] * force[i])),
        }
    }

    /// The force at `s`, from `P`.
    pub fn value(self, quotient: &Legendre, s: f64) -> f64 {
        if self.is_smooth() { quotient.at(s) } else { self.at(s) * quotient.at(s) }
    }

    /// Integral of the force times another function over `from < s < to`, from `P`. The rule has the force's beginning as its weight,
    /// but not its end.
    pub fn integral(self, quotient: &Legendre, factor: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
        let begins = self.at_start && from == 0.0;
        let rest = Ends { at_start: self.at_start && !begins, ..self };
        let part = |(node, weight): (f64, f64)| {
            let s = from + (to - from) * node;
            weight * rest.value(quotient, s) * factor(s)
        };
        if begins {
            to.powf(EXPONENT + 1.0) * BEGINNING.iter().copied().map(part).sum::<f64>()
        } else {
            (to - from) * BASIS.nodes.into_iter().zip(BASIS.weights).map(part).sum::<f64>()
        }
    }

    /// Place and value of the maximum of the force, from `P`.
    pub fn maximum(self, quotient: &Legendre) -> (f64, f64) {
        if self.is_smooth() {
            return quotient.maximum();
        }
        const GRID: u32 = 32;
        let at = |place: f64| (place, self.value(quotient, place));
        let higher = |best: (f64, f64), next: (f64, f64)| if next.1 > best.1 { next } else { best };
        let mut best = (0..=GRID).map(|i| at(f64::from(i) / f64::from(GRID))).fold((0.0, f64::NEG_INFINITY), higher);
        // F' = 0 where P' v + P u = 0, with v = s (1-s) and w' = w u/v; factors of ends that are smooth are left out
        let (slope, bend) = (quotient.derivative(), quotient.derivative().derivative());
        let (first, last) = (f64::from(u8::from(self.at_start)), f64::from(u8::from(self.at_end)));
        for _ in 0..8 {
            let s = best.0;
            let (from, to) = (if self.at_start { s } else { 1.0 }, if self.at_end { 1.0 - s } else { 1.0 });
            let (v, u) = (from * to, EXPONENT * (first * to - last * from));
            let (dv, du) = (first * to - last * from, -2.0 * EXPONENT * first * last);
            let [p, dp, ddp] = [quotient.at(s), slope.at(s), bend.at(s)];
            let next = s - (dp * v + p * u) / (ddp * v + dp * (dv + u) + p * du);
            if next == s || !((0.0..=1.0).contains(&next) && at(next).1 >= best.1) {
                break;
            }
            best = at(next);
        }
        best
    }
}

impl Weight {
    fn new(ends: Ends) -> Weight {
        let basis = &*BASIS;
        let inverse = basis.nodes.map(|s| 1.0 / ends.at(s));
        // Legendre coefficients of w times each nodal polynomial; s = sin^2 makes the integrand smooth
        let mut coefficients = [[0.0; Q]; Q];
        for (x, weight) in GaussLegendre::new(const { NonZeroUsize::new(40).unwrap() }).iter() {
            let (sin, cos) = (0.5 * FRAC_PI_2 * (1.0 + x)).sin_cos();
            let s = sin * sin;
            let part = FRAC_PI_2 * weight * sin * cos * ends.at(s);
            let p = legendre(s);
            for j in 0..Q {
                let nodal: f64 = (0..Q).map(|n| basis.to_coefficients[j][n] * p[n]).sum();
                for n in 0..Q {
                    coefficients[j][n] += part * (2 * n + 1) as f64 * p[n] * inverse[j] * nodal;
                }
            }
        }
        Weight { acting: coefficients.map(|column| Legendre(column).nodal()), inverse }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::legendre::dot;

    const ALL: [Ends; 3] = [
        Ends { at_start: true, at_end: false },
        Ends { at_start: false, at_end: true },
        Ends { at_start: true, at_end: true },
    ];

    fn smooth(s: f64) -> f64 {
        2.0 - s + 0.7 * s * s
    }

    fn force(ends: Ends) -> Nodal {
        BASIS.nodes.map(|s| ends.at(s) * smooth(s))
    }

    /// The moments of `w P` below degree `Q` are those of the polynomial that acts, against a fine midpoint rule.
    #[test]
    fn the_polynomial_that_acts_has_the_moments_of_the_force() {
        for ends in ALL {
            let Legendre(found) = Legendre::through(&ends.acting(&force(ends)));
            let n = 200_000;
            let mut exact = [0.0; Q];
            for i in 0..n {
                let s = (f64::from(i) + 0.5) / f64::from(n);
                let p = legendre(s);
                for m in 0..Q {
                    exact[m] += (2 * m + 1) as f64 * p[m] * ends.at(s) * smooth(s) / f64::from(n);
                }
            }
            for m in 0..Q {
                assert!((found[m] - exact[m]).abs() < 1e-8, "{ends:?} {m}: {:e}", found[m] - exact[m]);
            }
        }
    }

    #[test]
    fn the_quotient_and_the_maximum_are_those_of_the_force() {
        for ends in ALL {
            let quotient = ends.quotient(&force(ends));
            assert!((dot(&quotient.0, &legendre(0.3)) - smooth(0.3)).abs() < 1e-13);
            assert!(quotient.truncation() < 1e-14);
            let (place, value) = ends.maximum(&quotient);
            let at = |s: f64| ends.at(s) * smooth(s);
            let finest = (0..=100_000).map(|i| at(f64::from(i) / 1e5)).fold(0.0, f64::max);
            assert!(
                (value - finest).abs() < 1e-9 && (at(place) - value).abs() < 1e-14,
                "{ends:?} {place} {value} {finest}"
            );
        }
        for (ends, largest) in ALL.into_iter().zip([1.0, 1.0, 0.125]) {
            assert!((ends.largest() - largest).abs() < 1e-15);
        }
    }
}
