//! The choice of the model for a scene.

use vibroimpact_sim::both;

use super::choice::{Choice, Tried};
use super::pose::Pose;
use super::theory::Found;
use super::{Answer, Cost, Kept, Model, Modes, infinite, rigid, settle, stated};
use crate::impact::Impact;
use crate::scene::{InvalidInput, MOST_MODES, Scene, Structure, chooses_modes, modal_only};

impl Scene {
    /// Chooses the model and solves the scene. The answer states the restitution, its uncertainty, the reason for the model, and
    /// the cost.
    ///
    /// # Errors
    /// A value out of range, too few or too many fields, or a `model` that is not available for the structure or the law.
    ///
    /// ```
    /// use vibroimpact::{Scene, model::Model};
    ///
    /// let scene = |place: f64| Scene::from_json(&format!(r#"{{
    ///     "structure": {{ "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.02,
    ///                    "segments": [{{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }}] }},
    ///     "striker": {{ "mass_kg": 0.1, "speed_m_s": 1 }},
    ///     "contact": {{ "law": "hertz", "stiffness_n_m1_5": 1.8e10 }},
    ///     "location_m": {place}, "tolerance": 1e-3
    /// }}"#));
    /// let answer = scene(0.4)?.answer()?;
    /// assert_eq!(answer.model, Model::Modal);
    /// assert!(answer.settled && answer.restitution_uncertainty.unwrap() <= 1e-3);
    /// // on the support itself
    /// let answer = scene(0.0)?.answer()?;
    /// assert_eq!((answer.model, answer.restitution), (Model::Rigid, Some(1.0)));
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn answer(&self) -> Result<Answer, InvalidInput> {
        Ok(self.choose()?.answer)
    }

    /// As [`Scene::answer`], with the modal problem behind the answer.
    ///
    /// # Errors
    /// As [`Scene::answer`].
    pub fn choose(&self) -> Result<Choice, InvalidInput> {
        Ok(self.choose_and(&mut Kept::default(), |_, _| Ok(()))?.0)
    }

    /// The same with cached data, and what `go_on` makes of the choice before the effect of the theory of bending is known.
    pub(crate) fn choose_and<T>(
        &self,
        kept: &mut Kept,
        go_on: impl FnOnce(&Choice, &mut Kept) -> Result<T, InvalidInput>,
    ) -> Result<(Choice, T), InvalidInput> {
        let mut found = Found::new(kept.is_alone());
        let mut cost = Cost::default();
        let open = self.with_theory(&mut found, &mut cost)?;
        if let (Some((scene, _)), true) = (&open, kept.is_alone()) {
            kept.modes = found.modes_of(scene);
        }
        let answered = || {
            let choice = self.choose_by(open, kept, cost)?;
            let more = go_on(&choice, kept)?;
            Ok((choice, more))
        };
        let beside = found.goes_on();
        let (others, answered) = both(beside, || if beside { found.others(self) } else { Ok(Vec::new()) }, answered);
        let (choice, more) = answered?;
        let mut cost = choice.answer.cost;
        found.add(others?, &mut cost);
        let choice = self.judge_theory(choice, &mut found, &mut cost)?;
        Ok((Choice { answer: Answer { cost, ..choice.answer }, ..choice }, more))
    }

    /// As [`Scene::answer`], with cached data of earlier scenes: the same answer to the last bit in less time. The uncertainty of
    /// the theory of bending is not estimated, since that takes further impacts.
    ///
    /// # Errors
    /// As [`Scene::answer`].
    pub fn answer_with(&self, kept: &mut Kept) -> Result<Answer, InvalidInput> {
        let mut cost = Cost::default();
        let open = self.with_theory(&mut Found::default(), &mut cost)?;
        Ok(self.choose_by(open, kept, cost)?.answer)
    }

    /// The choice, with this theory of bending if it was open, and with this cost of choosing it.
    fn choose_by(
        &self,
        open: Option<(Scene, String)>,
        kept: &mut Kept,
        mut cost: Cost,
    ) -> Result<Choice, InvalidInput> {
        if self.is_infinite() {
            return infinite::of_infinite_structure(self);
        }
        let scene = open.as_ref().map_or(self, |(scene, _)| scene);
        let mut choice = match (scene.model, modal_only(scene)) {
            (Model::Auto | Model::Modal, Some(_)) => stated::stated(scene, kept, &mut cost)?,
            (forced, Some(why)) => return Err(refused(forced, format!("auto or modal, because {why}"))),
            (Model::Auto, None) => auto(&mut Pose::new(scene, kept)?, &mut cost)?,
            (forced, None) => forced_tier(forced, &mut Pose::new(scene, kept)?, &mut cost)?
                .map_err(|reason| refused(forced, format!("another model, because {reason}")))?,
        };
        if let Some((_, why)) = &open {
            choice.answer.reason += &format!("; {why}");
        }
        choice.answer.theory = scene.structure.bending_theory();
        choice.answer.cost = cost;
        Ok(choice)
    }
}

/// The error for a model that was requested and is not available.
pub(super) fn refused(model: Model, allowed: String) -> InvalidInput {
    InvalidInput::new("model", format!("\"{}\"", model.as_str()), allowed)
}

impl Scene {
    /// Finds the errors of [`Scene::answer`] that can be found without solving a modal impact. Other models cost little, and are
    /// solved.
    pub(crate) fn check(&self) -> Result<(), InvalidInput> {
        if self.is_infinite() || !matches!(self.model, Model::Auto | Model::Modal) {
            return self.answer().map(drop);
        }
        let kept = &mut Kept::default();
        if modal_only(self).is_none() {
            Pose::new(self, kept)?;
        }
        // where the program chooses the modes there are enough of them
        self.impact_of(if chooses_modes(self) { Some(0) } else { self.modes.count() }, kept).map(drop)
    }
}

impl Scene {
    /// The scene with the program's choices stated: the theory of bending and, in place of a tolerance for the whole restitution,
    /// as many modes as the restitution needs to converge, with remainder modes for the others.
    pub(crate) fn settled(&self) -> Result<Scene, InvalidInput> {
        if !chooses_modes(self) {
            return Ok(Scene { model: Model::Auto, ..self.clone() });
        }
        let open = self.with_theory(&mut Found::default(), &mut Cost::default())?;
        let mut scene = open.map_or_else(|| self.clone(), |(scene, _)| scene);
        let impact = settled_impact(&scene)?;
        let kept = impact.kept_modes();
        let fastest = impact.structure.modes[..kept].last().map_or(0.0, |mode| mode.omega_rad_s);
        // the count does not include slow modes that are hardly excited
        let mut asked = (2 * kept.max(8)).min(MOST_MODES);
        let count = loop {
            let known = scene.mode_shapes(asked)?;
            let found = known.iter().take_while(|mode| mode.omega_rad_s <= fastest).count();
            if found < asked || asked == MOST_MODES {
                break found.max(kept);
            }
            asked = (2 * asked).min(MOST_MODES);
        };
        if let Structure::Beam(beam) = &mut scene.structure {
            beam.as_the_thesis();
        }
        Ok(Scene {
            model: Model::Auto,
            modes: Modes::Count(count),
            residual_compliance: Some(impact.remainder_modes > 0),
            tolerance: None,
            ..scene
        })
    }
}

/// The cheapest model that is certain to reach the tolerance.
fn auto(pose: &mut Pose, cost: &mut Cost) -> Result<Choice, InvalidInput> {
    if !chooses_modes(pose.scene) {
        return stated::stated(pose.scene, pose.kept, cost);
    }
    for cheaper in CHEAPER {
        if let Ok(choice) = cheaper.certified(pose, cost)? {
            return Ok(choice);
        }
    }
    modal(pose, cost)
}

/// Tries a model; the inner `Err` states why it is not available.
type Try = fn(&mut Pose, &mut Cost) -> Tried;

/// A model that costs less than the modal one.
pub(super) struct Cheaper {
    pub model: Model,
    /// Where it is certain to reach the tolerance.
    certified: Try,
    /// Where it was requested.
    forced: Try,
}

/// The cheapest first.
pub(super) const CHEAPER: [Cheaper; 3] = [
    Cheaper { model: Model::Rigid, certified: rigid::certified, forced: rigid::forced },
    Cheaper { model: Model::Emoc, certified: super::emoc::certified, forced: super::emoc::forced },
    Cheaper { model: Model::InfiniteBeam, certified: infinite::certified, forced: infinite::forced },
];

impl Cheaper {
    /// Tries the model where it is certain to reach the tolerance.
    pub fn certified(&self, pose: &mut Pose, cost: &mut Cost) -> Tried {
        tried(self.certified, pose, cost)
    }
}

/// Tries a cheaper model, none of which considers gravity.
fn tried(model: Try, pose: &mut Pose, cost: &mut Cost) -> Tried {
    if pose.scene.falls() {
        return Ok(Err("gravity_m_s2 is stated, and this model leaves gravity out".to_owned()));
    }
    model(pose, cost)
}

/// The modal problem with as many modes as the restitution needs to converge.
pub(super) fn settled_impact(scene: &Scene) -> Result<Impact, InvalidInput> {
    let kept = &mut Kept::default();
    let open = scene.with_theory(&mut Found::default(), &mut Cost::default())?;
    let scene = open.as_ref().map_or(scene, |(scene, _)| scene);
    let choice = modal(&mut Pose::new(scene, kept)?, &mut Cost::default())?;
    // the modal model always has one
    choice.impact.map_or_else(|| scene.impact_of(Some(0), kept), Ok)
}

/// The modal model.
pub(super) fn modal(pose: &mut Pose, cost: &mut Cost) -> Result<Choice, InvalidInput> {
    if chooses_modes(pose.scene) && pose.approaches() {
        settle::settle(pose, cost)
    } else {
        stated::stated(pose.scene, pose.kept, cost)
    }
}

/// A model that was requested; the inner `Err` states why it is not available.
pub(super) fn forced_tier(model: Model, pose: &mut Pose, cost: &mut Cost) -> Tried {
    match CHEAPER.into_iter().find(|cheaper| cheaper.model == model) {
        Some(cheaper) => tried(cheaper.forced, pose, cost),
        None => modal(pose, cost).map(Ok),
    }
}
