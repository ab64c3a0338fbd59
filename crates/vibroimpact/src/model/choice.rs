//! The result of trying a model.

use super::Answer;
use crate::impact::Impact;
use crate::scene::InvalidInput;

/// An answer, and the modal problem behind it if there is one.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The answer.
    pub answer: Answer,
    /// The modal problem last solved, to be recorded; `None` for the other models.
    pub impact: Option<Impact>,
}

/// The result of trying a model: an answer, or the reason why it does not apply.
pub(super) type Tried = Result<Result<Choice, String>, InvalidInput>;
