//! From a scene to the part of a row that is its result. This is the one place where sweeps and solvers meet.

use std::panic::{AssertUnwindSafe, catch_unwind};

use vibroimpact_sim::infinite;
use vibroimpact_sim::modal::Counts;

use crate::infinite::Summary;
use crate::scene::{InvalidInput, Scene, Structure};

/// What became of one scene.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Answer {
    /// `rebound`, `no contact`, `sustained` or `limit reached`; empty if the scene could not be solved.
    pub outcome: &'static str,
    /// Net restitution, if there is one.
    pub restitution: Option<f64>,
    /// Estimated error of the restitution.
    pub restitution_uncertainty: Option<f64>,
    /// Number of separate contacts.
    pub sub_impact_count: Option<usize>,
    /// `modal`, `infinite-beam` or `infinite-plate`; empty if the scene could not be solved.
    pub model: &'static str,
    /// Modes of the structure; none if it is infinite.
    pub modes: Option<usize>,
    /// What the computation cost. On an infinite structure, steps are panels.
    pub counts: Counts,
    /// Why the scene could not be solved; empty if it could.
    pub error: String,
}

/// Whether a scene can be solved, as far as can be told without solving it.
pub(super) fn check(scene: &Scene) -> Result<(), InvalidInput> {
    if scene.is_infinite() { scene.infinite_impact().map(drop) } else { scene.impact().map(drop) }
}

/// Solves a scene. Whatever goes wrong becomes the answer's `error`.
pub(super) fn evaluate(scene: Result<Scene, InvalidInput>) -> Answer {
    guarded(|| {
        let scene = scene?;
        if scene.is_infinite() { on_infinite(&scene) } else { on_modes(&scene) }
    })
}

fn guarded(solve: impl FnOnce() -> Result<Answer, InvalidInput>) -> Answer {
    let failed = |error: String| Answer { error, ..Answer::default() };
    match catch_unwind(AssertUnwindSafe(solve)) {
        Ok(Ok(answer)) => answer,
        Ok(Err(fault)) => failed(fault.to_string()),
        Err(panic) => {
            let said = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
            let said = said.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
            failed(format!("the solver failed: {said}"))
        }
    }
}

fn on_modes(scene: &Scene) -> Result<Answer, InvalidInput> {
    let impact = scene.impact()?;
    let solution = impact.solve()?;
    Ok(Answer {
        outcome: solution.outcome.as_str(),
        restitution: solution.restitution,
        restitution_uncertainty: solution.restitution_uncertainty,
        sub_impact_count: Some(solution.sub_impacts.len()),
        model: "modal",
        modes: Some(impact.structure.modes.len()),
        counts: solution.counts,
        error: String::new(),
    })
}

fn on_infinite(scene: &Scene) -> Result<Answer, InvalidInput> {
    let impact = scene.infinite_impact()?;
    let groups = impact.groups()?;
    let solution = infinite::solve(impact.structure, groups.s, &infinite::Settings::default())?;
    let summary = Summary::new(&solution, None);
    Ok(Answer {
        outcome: summary.outcome,
        restitution: summary.rebound_ratio,
        restitution_uncertainty: summary.rebound_ratio.zip(summary.relative_error).map(|(ratio, error)| error * ratio),
        sub_impact_count: Some(solution.contacts.len()),
        model: if matches!(scene.structure, Structure::InfiniteBeam(_)) { "infinite-beam" } else { "infinite-plate" },
        modes: None,
        counts: Counts {
            contact_steps: solution.panels as u64,
            rejected_steps: solution.panels_tried.saturating_sub(solution.panels) as u64,
            ..Counts::default()
        },
        error: String::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_in_a_solver_is_an_answer() {
        let answer = guarded(|| panic!("no root in {}", 3));
        assert_eq!(answer.error, "the solver failed: no root in 3");
        assert_eq!(answer.outcome, "");
        let answer = guarded(|| Err(InvalidInput::new("a", "1", "2")));
        assert_eq!(answer.error, "a = 1 is not allowed: 2");
    }
}
