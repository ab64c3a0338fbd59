//! Panels of `h = 2^-j` units of time, whose tables can be cached.

use super::oscillator::{BodyMode, Propagator, propagate};
use super::rows::Rows;
use super::vector::{change_each, vectorized};
use std::array;
use std::f64::consts::FRAC_1_SQRT_2;
use std::ops::Range;
use std::sync::OnceLock;

/// Coarsest and finest step: `2^J_MIN` to `2^J_MAX` parts of the unit of time.
pub(crate) const J_MIN: i32 = -120;
pub(crate) const J_MAX: i32 = 200;

/// The step lengths of a run: parts of a unit of time. Runs of different tolerances share many steps, and with them a part of their
/// errors, if the unit is the same; in another unit no step is the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Steps {
    unit_s: f64,
}

impl Steps {
    /// Parts of a second.
    pub const OF_SECOND: Steps = Steps { unit_s: 1.0 };
    /// Parts of `1/sqrt(2)` s, each halfway between two parts of a second on a logarithmic scale.
    pub const HALFWAY: Steps = Steps { unit_s: FRAC_1_SQRT_2 };
    /// Parts of `2^(-1/4)` s, a quarter of the way.
    pub const QUARTER_WAY: Steps = Steps { unit_s: 0.840_896_415_253_714_5 };

    /// Step length (s) for a step exponent.
    #[inline]
    pub fn step_s(self, j: i32) -> f64 {
        self.unit_s * f64::from_bits(((1023 - j) as u64) << 52)
    }

    /// Step exponent of the longest step that is not longer than `t` (s), a positive number.
    #[inline]
    pub fn level_within(self, t: f64) -> i32 {
        let exponent = (((t / self.unit_s).to_bits() >> 52) & 0x7ff) as i32 - 1023;
        let level = (-exponent).clamp(J_MIN, J_MAX);
        // the quotient may have been rounded up to a power of two
        if self.step_s(level) > t { (level + 1).min(J_MAX) } else { level }
    }

    /// Step exponent of a panel of this length (s), if it is a step.
    #[inline]
    pub fn level_of(self, h: f64) -> Option<i32> {
        let level = self.level_within(h);
        (self.step_s(level) == h).then_some(level)
    }
}

/// Number of neighbouring step exponents in a group: a run needs a few neighbouring ones.
const GROUP: usize = 32;
/// Number of groups for all step exponents and one more, for half of the shortest step.
const GROUPS: usize = (J_MAX + 1 - J_MIN) as usize / GROUP + 1;

type Group<T> = [OnceLock<Box<T>>; GROUP];

/// A value for each step exponent, computed at first use.
pub(crate) struct Levels<T> {
    groups: [OnceLock<Box<Group<T>>>; GROUPS],
}

impl<T> Default for Levels<T> {
    fn default() -> Levels<T> {
        Levels { groups: array::from_fn(|_| OnceLock::new()) }
    }
}

impl<T> Levels<T> {
    /// The value for the step exponent `j`, if it exists.
    pub fn get(&self, j: i32) -> Option<&T> {
        let (group, place) = Self::place(j);
        self.groups[group].get()?[place].get().map(|found| &**found)
    }

    /// The value for the step exponent `j`, which is computed if it is missing.
    pub fn get_or_init(&self, j: i32, make: impl FnOnce() -> T) -> &T {
        let (group, place) = Self::place(j);
        let group = self.groups[group].get_or_init(|| Box::new(array::from_fn(|_| OnceLock::new())));
        group[place].get_or_init(|| Box::new(make()))
    }

    /// The value for the step exponent `j`, mutable.
    pub fn get_mut(&mut self, j: i32) -> Option<&mut T> {
        let (group, place) = Self::place(j);
        self.groups[group].get_mut()?[place].get_mut().map(|found| &mut **found)
    }

    /// All existing values.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        let groups = self.groups.iter_mut().filter_map(OnceLock::get_mut);
        groups.flat_map(|group| group.iter_mut().filter_map(OnceLock::get_mut)).map(|found| &mut **found)
    }

    /// Group of a step exponent, and its position there.
    fn place(j: i32) -> (usize, usize) {
        let i = (j - J_MIN) as usize;
        (i / GROUP, i % GROUP)
    }
}

/// Free motion over one panel, mode by mode: the rows `p11 - 1`, `p12`, `p21`, `p22` of the propagators.
pub(crate) struct Rotation {
    rows: Rows<4>,
}

impl Rotation {
    pub fn new(modes: &[BodyMode], h: f64) -> Rotation {
        let mut rows = Rows::new(modes.len());
        for (k, mode) in modes.iter().enumerate() {
            let p = propagate(mode, h);
            rows.set(k, [p.p11_less_1, p.p12, p.p21, p.p22]);
        }
        Rotation { rows }
    }

    /// Moves all modes freely.
    pub fn apply(&self, amplitude: &mut [f64], rate: &mut [f64]) {
        let rows = self.of_modes(0..amplitude.len());
        vectorized(
            #[inline(always)]
            || {
                change_each(
                    [amplitude, rate],
                    rows,
                    #[inline(always)]
                    |[a, b], [less, p12, p21, p22]| [a + (less * a + p12 * b), p21 * a + p22 * b],
                );
            },
        );
    }

    /// The rows of these modes.
    #[inline(always)]
    pub fn of_modes(&self, modes: Range<usize>) -> [&[f64]; 4] {
        self.rows.part(modes.start, modes.len())
    }

    /// Free motion of one mode.
    pub fn of(&self, k: usize) -> Propagator {
        let [p11_less_1, p12, p21, p22] = self.rows.at(k);
        Propagator { p11_less_1, p12, p21, p22 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_the_powers_of_two_that_fit() {
        for steps in [Steps::OF_SECOND, Steps::HALFWAY, Steps::QUARTER_WAY] {
            let before = (-100..100).map(|j| steps.step_s(j).next_down());
            for t in [1.0, 0.7, 0.5, 1e-9, 3.3e-20, 1e20].into_iter().chain(before) {
                let h = steps.step_s(steps.level_within(t));
                assert!(h <= t && 2.0 * h > t, "{steps:?} {t}");
            }
            assert!((-100..100).all(|j| steps.level_of(steps.step_s(j)) == Some(j)), "{steps:?}");
            assert_eq!((steps.level_within(1e300), steps.level_within(1e-300)), (J_MIN, J_MAX));
        }
    }
}
