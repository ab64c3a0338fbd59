//! One draw among many: the restitution without an uncertainty.

use vibroimpact_sim::StopReason;
use vibroimpact_sim::modal::Settings;

use super::{Answer, Cost, Kept, Model};
use crate::impact::Impact;
use crate::in_scene::in_scene;
use crate::scene::{InvalidInput, Scene, chooses_modes, modal_only};

/// Tolerance of the solver if the scene states none. No single draw is reported, and the scatter of a thousand draws is a hundred
/// times as large.
const TOLERANCE: f64 = 1e-4;

/// The result of one impact among many.
pub(crate) struct Draw {
    pub model: Model,
    pub outcome: &'static str,
    pub stopped_by: Option<StopReason>,
    pub restitution: Option<f64>,
    pub sub_impact_count: Option<usize>,
    pub cost: Cost,
}

impl From<Answer> for Draw {
    fn from(answer: Answer) -> Draw {
        let Answer { model, outcome, stopped_by, restitution, sub_impact_count, cost, .. } = answer;
        Draw { model, outcome, stopped_by, restitution, sub_impact_count, cost }
    }
}

impl Scene {
    /// Solves one draw of many. A scene with stated modes is solved once, at [`TOLERANCE`] if it states none; all other scenes are
    /// solved as usual.
    pub(crate) fn draw_with(&self, kept: &mut Kept) -> Result<Draw, InvalidInput> {
        let stated = modal_only(self).is_some() || !chooses_modes(self);
        if self.is_infinite() || !matches!(self.model, Model::Auto | Model::Modal) || !stated {
            return self.answer_with(kept).map(Draw::from);
        }
        let impact = self.impact_of(self.modes.count(), kept)?;
        let Impact { structure, striker, law, start, settings, .. } = &impact;
        let tolerance = self.tolerance.unwrap_or(TOLERANCE);
        let settings = Settings { tolerance, estimate_uncertainty: false, ..*settings };
        let solution = impact.solver_with(kept)?.solve(striker, law, start.as_ref(), &settings).map_err(in_scene)?;
        let mut cost = Cost::default();
        cost.add(&solution.counts, structure.modes.len());
        Ok(Draw {
            model: Model::Modal,
            outcome: solution.outcome.as_str(),
            stopped_by: solution.outcome.stopped_by(),
            restitution: solution.restitution,
            sub_impact_count: Some(solution.sub_impacts.len()),
            cost,
        })
    }
}
