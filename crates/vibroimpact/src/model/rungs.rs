//! The impacts with different numbers of modes, and the errors of the last that they show.

use vibroimpact_sim::modal::Solution;

use super::left_out::{at_the_end, by_changes};
use super::quantity::{Change, Quantity};
use super::rung::{Rung, Unseen};

/// Only changes from at least this share of the number of modes are used to estimate the effect of further ones.
const NEAR: f64 = 0.5;
/// The solver's part: this share of its tolerance, and of the change between runs whose tolerances differ by a factor of thirty.
const SOLVER_FLOOR: f64 = 0.5;
const SOLVER_CHANGE: f64 = 0.1;
/// Changes decrease if the last is smaller than this share of the one two steps before.
const FALLING: f64 = 0.5;
/// Number of the last results that make up the spread if they do not converge.
const SPREAD: usize = 4;

/// The numbers of modes tried so far.
pub(super) struct Rungs {
    pub earlier: Vec<Rung>,
    pub last: Rung,
    pub restitution: Quantity<'static>,
    /// Whether the contact force jumps at first touch.
    pub jumps: bool,
    /// The number of modes, if there is one, that makes up the whole static compliance.
    pub complete: Option<usize>,
    /// The number of modes with which the impact reached a limit of steps.
    pub too_many: Option<usize>,
}

impl Rungs {
    /// The last is not the answer. Its motion, of every mode at every step, may take hundreds of megabytes, and is not needed while
    /// the next one is solved.
    pub fn forget_motion(&mut self) {
        self.last.recording = None;
    }

    pub fn push(&mut self, next: Rung) {
        self.forget_motion();
        self.earlier.push(std::mem::replace(&mut self.last, next));
    }

    /// All, the latest first.
    fn all(&self) -> impl Iterator<Item = &Rung> {
        std::iter::once(&self.last).chain(self.earlier.iter().rev())
    }

    /// The latest ones, latest first, with similar numbers of modes. Of the impacts with one number only the latest counts, which
    /// has the tightest tolerance: the same modes again contain no further information about the truncated ones. If there are
    /// none, every impact counts.
    pub fn near(&self) -> impl Iterator<Item = &Rung> {
        let again = |i: usize, count| self.all().take(i).any(|later| later.count == count);
        let distinct = self.all().enumerate().filter(move |(i, rung)| self.is_complete() || !again(*i, rung.count));
        let mut last = self.last.count;
        distinct.map(|(_, rung)| rung).take_while(move |rung| {
            let before = std::mem::replace(&mut last, rung.count);
            (1 + rung.count.min(before)) as f64 >= NEAR * (1 + rung.count.max(before)) as f64
        })
    }

    pub fn is_complete(&self) -> bool {
        self.complete == Some(self.last.count)
    }

    /// Changes between neighbours with different numbers of modes, the latest first.
    pub fn changes(&self, of: &Quantity) -> impl Iterator<Item = (Change, [usize; 2])> {
        let pairs = self.near().zip(self.near().skip(1)).filter(|(next, last)| next.count != last.count);
        pairs.map(|(next, last)| (of.change(&last.solution, &next.solution), [last.count, next.count]))
    }

    /// Their sizes.
    fn sizes(&self, of: &Quantity) -> Vec<f64> {
        self.changes(of).map(|(change, _)| change.size()).collect()
    }

    /// Change of the last by one of the impacts with the same number of modes; 0 if that is not needed.
    fn unseen(&self, of: &Quantity, which: fn(&Unseen) -> &Option<Solution>) -> f64 {
        let other = self.last.unseen.as_ref().and_then(|unseen| which(unseen).as_ref());
        other.map_or(0.0, |other| of.change(other, &self.last.solution).size())
    }

    /// Whether changes decrease as the number of modes rises, if there are enough of them.
    pub fn falls(&self) -> bool {
        let sizes = self.sizes(&self.restitution);
        sizes.len() < 3 || sizes[0] < FALLING * sizes[2]
    }

    /// Estimated change by the truncated modes, if it is known.
    pub fn left_out(&self, of: &Quantity) -> f64 {
        let changes: Vec<(f64, usize)> = self.changes(of).map(|(change, [_, to])| (change.size(), to)).collect();
        if self.is_complete() {
            return 0.0;
        }
        let changed = by_changes(&changes, self.jumps, of.scale()).max(of.scale() * self.last.energy);
        self.with_unseen(of, changed)
    }

    /// The same where the numbers of modes end before the restitution has converged.
    pub fn left_out_at_the_end(&self, of: &Quantity) -> f64 {
        let changed = at_the_end(&self.sizes(of), of.scale(), self.last.energy, self.last.resolution);
        self.with_unseen(of, changed)
    }

    /// An estimate with what remainder modes of another shape and the uncertainty of the compliance change.
    fn with_unseen(&self, of: &Quantity, changed: f64) -> f64 {
        changed.max(self.unseen(of, |unseen| &unseen.shape)) + self.unseen(of, |unseen| &unseen.compliance)
    }

    /// Whether the last two had the tightest tolerance, so that their change may not show the solver's error.
    pub fn share_tightest_tolerance(&self) -> bool {
        self.all().take(2).all(|rung| rung.has_tightest_tolerance())
    }

    /// Possible error of the solver with the last number of modes.
    pub fn solver(&self, of: &Quantity) -> f64 {
        let wider = self.earlier.iter().rev().find(|rung| rung.count == self.last.count);
        let change = match wider {
            Some(wider) => of.change(&wider.solution, &self.last.solution).size(),
            None if self.near().count() > 2 => self.sizes(of).first().copied().unwrap_or(of.scale()),
            None => 0.0,
        };
        let floor = SOLVER_FLOOR * self.last.impact.settings.tolerance * of.scale();
        floor + (SOLVER_CHANGE * change).max(self.unseen(of, |unseen| &unseen.solver))
    }

    /// Possible error of the restitution.
    pub fn error(&self) -> f64 {
        self.solver(&self.restitution) + self.left_out(&self.restitution)
    }

    pub fn counts(&self) -> String {
        let mut counts: Vec<usize> = self.all().map(|rung| rung.count).collect();
        counts.sort_unstable();
        counts.dedup();
        counts.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
    }

    /// Difference of the largest and smallest of the last values of a quantity, and their number.
    pub fn spread(&self, of: &Quantity) -> Option<(f64, usize)> {
        let values: Vec<f64> = self.near().take(SPREAD).filter_map(|rung| of.value(&rung.solution)).collect();
        let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), e| (l.min(*e), h.max(*e)));
        (values.len() > 1).then_some((high - low, values.len()))
    }
}
