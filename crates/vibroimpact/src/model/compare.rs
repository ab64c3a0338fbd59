//! Comparison of all models.

use serde::Serialize;

use super::choose::forced_tier;
use super::pose::Pose;
use super::{Answer, Cost, Kept, Model};
use crate::scene::{InvalidInput, Scene, modal_only};

/// The result of [`Scene::compare`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// The answer of the automatic choice.
    pub chosen: Answer,
    /// The model with the smallest uncertainty, with which the others are compared.
    pub best: Model,
    /// Each model.
    pub tiers: Vec<Tier>,
}

impl Comparison {
    /// Whether the effect of the truncated modes in the best model is unknown.
    pub(super) fn best_leaves_modes_out(&self) -> bool {
        let best = self.tiers.iter().filter(|tier| tier.model == self.best);
        best.filter_map(|tier| tier.answer.as_ref()).any(|answer| answer.uncertainty.modes_left_out.is_none())
    }
}

/// One model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tier {
    /// The model.
    pub model: Model,
    /// Its answer; null if it is not available.
    pub answer: Option<Answer>,
    /// The reason why it is not available.
    pub refused: Option<String>,
    /// Its restitution minus that of the best model.
    pub difference: Option<f64>,
}

impl Scene {
    /// Solves the scene with every model, whichever it requests.
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
            // the models accept a wider range of scenes if they are requested
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
