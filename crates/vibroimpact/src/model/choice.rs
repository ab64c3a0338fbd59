//! What became of a tier.

use super::Answer;
use crate::impact::Impact;
use crate::scene::InvalidInput;

/// An answer, and the modal problem that it came from if it came from one.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// What was found, by what.
    pub answer: Answer,
    /// The modal problem last solved, to be recorded; `None` for the other models.
    pub impact: Option<Impact>,
}

/// What became of a tier: an answer, or why it does not apply.
pub(super) type Tried = Result<Result<Choice, String>, InvalidInput>;
