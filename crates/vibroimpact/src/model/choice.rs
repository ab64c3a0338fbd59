//! The result of trying a model.

use vibroimpact_sim::modal::{Solution, SubImpact};

use super::uncertainty::Known;
use super::{Answer, Model, Uncertainty};
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

/// The uncertainty of an answer, and the choice of its modes.
pub(super) struct Conclusion {
    pub known: Known,
    /// Of the largest force of each contact.
    pub peaks: Vec<Uncertainty>,
    pub settled: bool,
    pub spread: Option<f64>,
    pub reason: String,
}

impl Choice {
    /// That of an impact in modes.
    pub(super) fn modal(tolerance: f64, impact: Impact, solution: Solution, conclusion: Conclusion) -> Choice {
        let Conclusion { known, peaks, settled, spread, reason } = conclusion;
        let answer = Answer {
            outcome: solution.outcome.as_str(),
            stopped_by: solution.outcome.stopped_by(),
            restitution: solution.restitution,
            sub_impact_count: Some(solution.sub_impacts.len()),
            modes: impact.kept_modes(),
            remainder_modes: impact.remainder_modes,
            residual_compliance_m_n: impact.residual_compliance_m_n(),
            settled,
            spread,
            ..Answer::new(Model::Modal, tolerance, known.of(solution.restitution), reason)
        };
        Choice { answer, impact: Some(impact), sub_impacts: solution.sub_impacts, peak_forces: peaks }
    }
}
