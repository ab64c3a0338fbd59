//! The solution: values at any time, events, the reason for stopping, and the cost.

use crate::dense::Dense;
use invalid_input::InvalidInput;
use std::fmt;

/// What ended a run.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Stop {
    /// The final time was reached.
    EndReached,
    /// The terminal event with this index occurred.
    Event {
        /// Index into the problem's events.
        index: usize,
    },
    /// A function of the problem returned a value that is not finite at this time, and smaller steps did not help.
    NonFinite {
        /// Time of the evaluation.
        t: f64,
    },
    /// Newton's method found no solution of a step's equations at this time.
    NoConvergence {
        /// Time of the step.
        t: f64,
    },
    /// Solution or density vary faster after this time than the shortest panel resolves, as next to a start like `t^0.01`.
    Unresolved {
        /// Start of the panel.
        t: f64,
    },
    /// The largest number of panels was used up before the final time.
    PanelLimit {
        /// Time reached.
        t: f64,
    },
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Stop::EndReached => f.pad("end reached"),
            Stop::Event { index } => write!(f, "terminal event {index}"),
            Stop::NonFinite { t } => write!(f, "a function is not finite at t = {t}"),
            Stop::NoConvergence { t } => write!(f, "Newton's method does not converge at t = {t}"),
            Stop::Unresolved { t } => write!(f, "the shortest panel does not resolve the solution at t = {t}"),
            Stop::PanelLimit { t } => write!(f, "the limit of panels was reached at t = {t}"),
        }
    }
}

/// A located sign change of an event function.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct EventHit {
    /// Index into the problem's events.
    pub event: usize,
    /// Time of the sign change.
    pub t: f64,
    /// The solution there.
    pub y: Vec<f64>,
    /// Whether the function changed from negative to positive.
    pub rising: bool,
}

/// The cost of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Counts {
    /// Evaluations of the density.
    pub evaluations: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Steps or panels taken.
    pub steps: u64,
    /// Panels that were tried and were too long.
    pub rejected: u64,
    /// Number of values that represent the past at the end of the run (not counting the solution's own samples).
    pub history_values: u64,
}

/// A computed solution.
#[derive(Debug, Clone)]
pub struct Solution {
    pub(crate) dense: Dense,
    /// What ended the run.
    pub stop: Stop,
    /// The sign changes found, in the order of time.
    pub events: Vec<EventHit>,
    /// What the run cost.
    pub counts: Counts,
}

impl Solution {
    /// The solution at a time in `[0, end_time]`. Where it jumps (at a break of the forcing), this is the value before the
    /// jump.
    ///
    /// # Errors
    ///
    /// [`InvalidInput`] for a time outside the solution.
    pub fn at(&self, t: f64) -> Result<Vec<f64>, InvalidInput> {
        let mut y = vec![0.0; self.unknowns()];
        if self.dense.eval(t, &mut y) {
            Ok(y)
        } else {
            Err(InvalidInput::new("t", t, "a time between 0 and the end of the solution"))
        }
    }

    /// Ends of the steps or panels, ascending from 0; a break point appears twice, with the values of its two sides.
    pub fn times(&self) -> &[f64] {
        self.dense.times()
    }

    /// The values at [`times`](Self::times), in the same order, `unknowns` numbers each.
    pub fn values(&self) -> &[f64] {
        self.dense.values()
    }

    /// Number of components of the solution.
    pub fn unknowns(&self) -> usize {
        self.dense.unknowns()
    }

    /// The time reached: the requested final time, unless the run stopped before.
    pub fn end_time(&self) -> f64 {
        self.dense.times().last().copied().unwrap_or(0.0)
    }
}
