//! The motion to which a run has converged at its end: the number of common periods of the loads after which it repeats itself, and
//! the number of intervals of contact in them.
//!
//! With `T` the common period of the loads, the displacements `u(t)` of both sides of every contact are compared at moments `T/8`
//! apart. The motion has converged to `n` periods if over the last `n T` they differ from those of the `n T` before by at most
//! a thousandth of their range.

use std::collections::VecDeque;

use serde::Serialize;
use vibroimpact_sim::assembly::Motion;

/// Largest number of periods of the loads after which a repetition is detected.
const MOST_PERIODS: usize = 16;
/// Moments within a period.
const MOMENTS: usize = 8;
/// Moments that are kept: two stretches of the longest motion.
const KEPT: usize = 2 * MOST_PERIODS * MOMENTS + 1;
/// Tolerance of differences, relative to the range of the motion and to the displacements themselves.
const SAME: f64 = 1e-3;
const ROUNDING: f64 = 1e-12;

/// A motion that repeats itself after `periods` of the loads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct SteadyMotion {
    /// Periods of the load, at most 16; of several loads, their common periods.
    pub periods: u64,
    /// Intervals of contact that end within them, of all contacts together.
    pub intervals: u64,
}

/// The end of a run, moment by moment.
pub(super) struct Moments {
    step_s: f64,
    next: u64,
    kept: VecDeque<Moment>,
    ended: u64,
}

struct Moment {
    displacement_m: Vec<f64>,
    /// Intervals that have ended.
    ended: u64,
}

impl Moments {
    pub fn new(period_s: f64) -> Moments {
        Moments { step_s: period_s / MOMENTS as f64, next: 0, kept: VecDeque::new(), ended: 0 }
    }

    /// Records an interval that has ended.
    pub fn end_interval(&mut self) {
        self.ended += 1;
    }

    pub fn add(&mut self, panel: &dyn Motion, contacts: usize) {
        let time_s = |number: u64| number as f64 * self.step_s;
        // of a panel with many periods only the stored moments are needed
        let last = (panel.end_s() / self.step_s) as u64;
        self.next = self.next.max(last.saturating_sub(KEPT as u64));
        while time_s(self.next) < panel.end_s() {
            let time_s = time_s(self.next).max(panel.start_s());
            let displacement_m = (0..contacts).flat_map(|c| panel.contact(c, time_s).displacement_m).collect();
            if self.kept.len() == KEPT {
                self.kept.pop_front();
            }
            self.kept.push_back(Moment { displacement_m, ended: self.ended });
            self.next += 1;
        }
    }

    /// The motion with the fewest periods, if there is one.
    pub fn steady(&self) -> Option<SteadyMotion> {
        let sides = self.kept.front()?.displacement_m.len();
        let extent = |side: usize| {
            let of = |moment: &Moment| moment.displacement_m[side];
            let ends = |(low, high): (f64, f64), moment| (of(moment).min(low), of(moment).max(high));
            let (low, high) = self.kept.iter().fold((f64::INFINITY, f64::NEG_INFINITY), ends);
            (high - low, low.abs().max(high.abs()))
        };
        let same =
            (0..sides).map(extent).fold(0.0, |same, (range, size)| f64::max(same, SAME * range + ROUNDING * size));
        let repeats =
            |a: &Moment, b: &Moment| a.displacement_m.iter().zip(&b.displacement_m).all(|(a, b)| (a - b).abs() <= same);
        (1..=MOST_PERIODS).find_map(|periods| {
            let shift = periods * MOMENTS;
            let begin = self.kept.len().checked_sub(2 * shift + 1)?;
            let last = self.kept.back()?;
            let repeated = (begin..=begin + shift).all(|i| repeats(&self.kept[i], &self.kept[i + shift]));
            let intervals = last.ended - self.kept[begin + shift].ended;
            repeated.then_some(SteadyMotion { periods: periods as u64, intervals })
        })
    }
}
