//! Every tier side by side.

use serde::Serialize;

use super::choose::forced_tier;
use super::pose::Pose;
use super::{Answer, Cost, Kept, Model};
use crate::scene::{InvalidInput, Scene, modal_only};

/// What [`Scene::compare`] found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// What the automatic choice answers.
    pub chosen: Answer,
    /// The tier with the smallest uncertainty, against which the others are set.
    pub best: Model,
    /// Each tier.
    pub tiers: Vec<Tier>,
}

impl Comparison {
    /// Whether it is not known what the truncated modes change in the best tier.
    pub(super) fn best_leaves_modes_out(&self) -> bool {
        let best = self.tiers.iter().filter(|tier| tier.model == self.best);
        best.filter_map(|tier| tier.answer.as_ref()).any(|answer| answer.uncertainty.modes_left_out.is_none())
    }
}

/// One tier.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tier {
    /// The tier.
    pub model: Model,
    /// What it answers; null if it cannot be had.
    pub answer: Option<Answer>,
    /// Why it cannot be had.
    pub refused: Option<String>,
    /// Its restitution less that of the best tier.
    pub difference: Option<f64>,
}

impl Scene {
    /// Answers the scene by every model, whatever it asks for.
    ///
    /// # Errors
    /// As [`Scene::answer`], for the scene with `"model": "auto"`.
    pub fn compare(&self) -> Result<Comparison, InvalidInput> {
        let scene = Scene { model: Model::Auto, ..self.clone() };
        let chosen = scene.answer()?;
        // the others by the same theory
        let this = self.as_answered(Some(&chosen));
        let (mut tiers, mut kept) = (Vec::new(), Kept::default());
        for model in [Model::Rigid, Model::Emoc, Model::InfiniteBeam, Model::Modal] {
            // the tiers see what was requested, because being asked for widens what they accept
            let scene = Scene { model, ..this.clone() };
            let found = match (scene.is_infinite(), modal_only(&scene)) {
                (true, _) if model == Model::InfiniteBeam => Ok(chosen.clone()),
                (true, _) => Err("the structure has no ends".to_owned()),
                (false, Some(_)) if model == Model::Modal => Ok(chosen.clone()),
                (false, Some(why)) => Err(why.to_owned()),
                (false, None) => {
                    let mut cost = Cost::default();
                    let tried = forced_tier(model, &mut Pose::new(&scene, &mut kept)?, &mut cost)?;
                    tried.map(|choice| Answer { cost, theory: chosen.theory, ..choice.answer })
                }
            };
            let (answer, refused) = match found {
                Ok(answer) => (Some(answer), None),
                Err(reason) => (None, Some(reason)),
            };
            tiers.push(Tier { model, answer, refused, difference: None });
        }
        let known = |tier: &&Tier| tier.answer.as_ref().and_then(|a| a.restitution.and(a.restitution_uncertainty));
        let best = tiers.iter().filter(|tier| known(tier).is_some());
        let best = best.min_by(|a, b| known(a).unwrap_or(1.0).total_cmp(&known(b).unwrap_or(1.0)));
        let (model, value) = match best.map(|tier| (tier.model, tier.answer.as_ref().and_then(|a| a.restitution))) {
            Some((model, value)) => (model, value),
            None => (chosen.model, chosen.restitution),
        };
        for tier in &mut tiers {
            tier.difference = tier.answer.as_ref().and_then(|a| a.restitution).zip(value).map(|(e, best)| e - best);
        }
        Ok(Comparison { chosen, best: model, tiers })
    }
}
