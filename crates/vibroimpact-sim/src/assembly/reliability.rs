//! The time up to which the events of a run are certain, from a second run.
//!
//! Step lengths are powers of two, so that two runs of similar tolerances share many steps, and with them their errors. A run
//! with a thousandth of the tolerance takes shorter steps, and the difference between the two is the error of the first run.

use super::problem::FINEST_TOLERANCE;
use super::solution::{Interval, Observer};

/// Factor of the tolerance of the second run.
const FINER: f64 = 1e-3;
/// The same where rounding leaves no room for a finer run.
const COARSER: f64 = 32.0;

/// The tolerance of the second run, and the largest difference allowed in the time of an event, relative to the time since the
/// start.
pub(crate) fn second_run(tolerance: f64) -> (f64, f64) {
    let finer = FINER * tolerance;
    if finer >= FINEST_TOLERANCE { (finer, tolerance) } else { (COARSER * tolerance, COARSER * tolerance) }
}

/// Compares the intervals of a run with those of another as they are found.
pub(crate) struct Comparison<'a> {
    known: &'a [Vec<Interval>],
    seen: Vec<usize>,
    tolerance: f64,
    end_s: f64,
    /// The first event that differs (s).
    differs_at: f64,
    stop: &'a mut dyn FnMut() -> bool,
    stopped: bool,
}

impl<'a> Comparison<'a> {
    pub fn new(
        known: &'a [Vec<Interval>],
        tolerance: f64,
        end_s: f64,
        stop: &'a mut dyn FnMut() -> bool,
    ) -> Comparison<'a> {
        let (seen, differs_at) = (vec![0; known.len()], f64::INFINITY);
        Comparison { known, seen, tolerance, end_s, differs_at, stop, stopped: false }
    }

    /// The time up to which every event was found again; `None` if the second run was stopped before it was known.
    pub fn certain_until(&self) -> Option<f64> {
        if self.stopped {
            return None;
        }
        // an interval that the second run did not find at all
        let missed = self.known.iter().zip(&self.seen).filter_map(|(known, seen)| known.get(*seen));
        Some(missed.map(|interval| interval.start_s).fold(self.differs_at, f64::min).min(self.end_s))
    }

    fn differ(&self, one: Option<f64>, other: Option<f64>) -> bool {
        match (one, other) {
            (Some(one), Some(other)) => (one - other).abs() > self.tolerance * one.max(other),
            // still closed at the end in one of them, and released there in the other
            (Some(time), None) | (None, Some(time)) => (self.end_s - time).abs() > self.tolerance * self.end_s,
            (None, None) => false,
        }
    }
}

impl Observer for Comparison<'_> {
    fn interval(&mut self, contact: usize, interval: &Interval) {
        let Some(known) = self.known.get(contact).and_then(|known| known.get(self.seen[contact])) else {
            self.differs_at = self.differs_at.min(interval.start_s);
            return;
        };
        self.seen[contact] += 1;
        if self.differ(Some(known.start_s), Some(interval.start_s)) {
            self.differs_at = self.differs_at.min(known.start_s).min(interval.start_s);
        } else if self.differ(known.end_s, interval.end_s) {
            let ends = [known.end_s, interval.end_s].into_iter().flatten();
            self.differs_at = ends.fold(self.differs_at, f64::min);
        }
    }

    fn interrupts(&mut self) -> bool {
        // events after a difference do not count
        let differs = self.differs_at < f64::INFINITY;
        self.stopped |= !differs && (self.stop)();
        differs || self.stopped
    }
}
