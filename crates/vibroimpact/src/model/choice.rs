//! The result of trying a model.

use vibroimpact_sim::modal::SubImpact;

use super::{Answer, Uncertainty};
use crate::impact::Impact;
use crate::scene::InvalidInput;

/// An answer, and the modal problem behind it if there is one.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The answer.
    pub answer: Answer,
    /// The modal problem last solved, to be recorded; `None` for the other models.
    pub impact: Option<Impact>,
    /// Its intervals of contact; none for the other models.
    pub sub_impacts: Vec<SubImpact>,
    /// The uncertainty of the largest force of each (N).
    pub peak_forces: Vec<Uncertainty>,
}

/// An answer without a modal problem.
impl From<Answer> for Choice {
    fn from(answer: Answer) -> Choice {
        Choice { answer, impact: None, sub_impacts: Vec::new(), peak_forces: Vec::new() }
    }
}

/// The result of trying a model: an answer, or the reason why it does not apply.
pub(super) type Tried = Result<Result<Choice, String>, InvalidInput>;
