//! Panels of `h = 2^-j` s, whose tables can be kept.

use super::oscillator::{BodyMode, Propagator, propagate};
use super::vector::vectorized;

/// Coarsest and finest step: `2^J_MIN` to `2^J_MAX` parts of a second.
pub(crate) const J_MIN: i32 = -120;
pub(crate) const J_MAX: i32 = 200;

/// Step length of a level (s): the number with just this exponent.
pub(crate) fn step_s(j: i32) -> f64 {
    f64::from_bits(((1023 - j) as u64) << 52)
}

/// The coarsest level whose step is not longer than `t` (s), a positive number.
pub(crate) fn level_within(t: f64) -> i32 {
    let exponent = ((t.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    (-exponent).clamp(J_MIN, J_MAX)
}

/// Free motion over one panel, mode by mode.
pub(crate) struct Rotation {
    pub p11_less_1: Vec<f64>,
    pub p12: Vec<f64>,
    pub p21: Vec<f64>,
    pub p22: Vec<f64>,
}

impl Rotation {
    pub fn new(modes: &[BodyMode], h: f64) -> Rotation {
        let [mut p11_less_1, mut p12, mut p21, mut p22] = [(); 4].map(|()| Vec::with_capacity(modes.len()));
        for mode in modes {
            let p = propagate(mode, h);
            p11_less_1.push(p.p11_less_1);
            p12.push(p.p12);
            p21.push(p.p21);
            p22.push(p.p22);
        }
        Rotation { p11_less_1, p12, p21, p22 }
    }

    /// Moves all modes freely.
    pub fn apply(&self, amplitude: &mut [f64], rate: &mut [f64]) {
        let n = amplitude.len();
        let (less, p12) = (&self.p11_less_1[..n], &self.p12[..n]);
        let (p21, p22, rate) = (&self.p21[..n], &self.p22[..n], &mut rate[..n]);
        vectorized(
            #[inline(always)]
            || {
                for k in 0..n {
                    let (a, b) = (amplitude[k], rate[k]);
                    amplitude[k] = a + (less[k] * a + p12[k] * b);
                    rate[k] = p21[k] * a + p22[k] * b;
                }
            },
        );
    }

    /// Free motion of one mode.
    pub fn of(&self, k: usize) -> Propagator {
        Propagator { p11_less_1: self.p11_less_1[k], p12: self.p12[k], p21: self.p21[k], p22: self.p22[k] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_the_powers_of_two_that_fit() {
        for t in [1.0, 0.7, 0.5, 1e-9, 3.3e-20, 1e20] {
            let h = step_s(level_within(t));
            assert!(h <= t && 2.0 * h > t, "{t}");
        }
        assert_eq!((level_within(1e300), level_within(1e-300)), (J_MIN, J_MAX));
    }
}
