//! The choice of the model and its cost, before anything costly is solved.
//!
//! The cost of an impact depends on its contact history: on the number of contacts and on the fastest relevant mode. This history
//! has no closed form. The modal model is therefore tried once, at a loose tolerance and with few modes. With `s` the steps of
//! this pilot impact and `N` the expected number of modes, the mode-steps of the answer lie between
//!
//! ```text
//! low s N tau^-q   and   high s N tau^-q,
//! ```
//!
//! for 95 of 100 scenes, where `tau` is the tolerance. The constants are quantiles from `cargo xtask study-auto`.

use serde::Serialize;
use vibroimpact_sim::modal::Settings;

use super::choice::Choice;
use super::choose::{CHEAPER, Cheaper, forced_tier, refused};
use super::guess::{fewer, guess};
use super::pose::Pose;
use super::theory::Found;
use super::{Cost, Kept, Model};
use crate::impact::Impact;
use crate::scene::{InvalidInput, Scene, chooses_modes, modal_only};
use crate::text::small;

/// The pilot impact: its share of the expected number of modes, its smallest number of modes, and the solver's tolerance.
const PILOT_PART: usize = 2;
const PILOT_FEWEST: usize = 6;
const PILOT_TOLERANCE: f64 = 1e-4;
/// Smallest and largest mode-steps in terms of `s N`, and the power `q`: if the pilot finds one contact, if it finds several (each
/// of which may need more modes), and for stated modes.
const ONE_CONTACT: ([f64; 2], f64) = ([0.68, 36.0], 0.06);
const SEVERAL: ([f64; 2], f64) = ([1.1, 350.0], 0.06);
const STATED: ([f64; 2], f64) = ([4.2, 18.0], 0.0);
/// Rough time (s) of a mode-step on a computer of the 2020s, of a mode (its share of the tables), and of the rest.
const MODE_STEP_S: f64 = 2e-8;
const MODE_S: f64 = 8e-6;
const SOLVE_S: f64 = 6e-5;
/// Rough time of an impact on an infinite beam, and of a closed form (s).
const INFINITE_S: f64 = 1e-4;
const FORMULA_S: f64 = 3e-5;

/// The result of [`Scene::plan`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plan {
    /// The model that would be used.
    pub model: Model,
    /// Requested accuracy of the restitution.
    pub tolerance: f64,
    /// Duration of the first contact if the location were immovable (s); null for infinite structures.
    pub contact_duration_s: Option<f64>,
    /// Each model, the cheapest first.
    pub tiers: Vec<Estimate>,
}

/// Expectations for one model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Estimate {
    /// The model.
    pub model: Model,
    /// Whether it reaches the tolerance.
    pub applies: bool,
    /// The reason why it applies or does not.
    pub reason: String,
    /// Expected error of the restitution; null where nothing is known.
    pub expected_error: Option<f64>,
    /// Numbers of modes with which it would begin.
    pub modes: Vec<usize>,
    /// Smallest and largest number of steps times modes; for the modal model, 95 of 100 scenes lie between them.
    pub mode_steps: [u64; 2],
    /// The corresponding rough times (s).
    pub time_s: [f64; 2],
}

impl Estimate {
    /// For a model that was cheap enough to be tried.
    fn tried(model: Model, tried: Result<Choice, String>, time_s: f64) -> Estimate {
        let (applies, reason, expected_error) = match tried {
            Ok(choice) => (true, choice.answer.reason, choice.answer.restitution_uncertainty),
            Err(reason) => (false, reason, None),
        };
        Estimate { model, applies, reason, expected_error, modes: Vec::new(), mode_steps: [0; 2], time_s: [time_s; 2] }
    }

    /// For modal solutions that begin with these numbers of modes, from the steps of a pilot impact.
    fn of_solves(modes: Vec<usize>, steps: u64, tolerance: f64, range: ([f64; 2], f64), reason: String) -> Estimate {
        let most = modes.iter().copied().max().unwrap_or(0).max(1);
        let (factors, power) = range;
        let mode_steps = factors.map(|factor| factor * steps as f64 * most as f64 * tolerance.powf(-power));
        let besides_s = SOLVE_S * modes.len() as f64 + MODE_S * modes.iter().sum::<usize>() as f64;
        Estimate {
            model: Model::Modal,
            applies: true,
            reason,
            expected_error: Some(tolerance),
            mode_steps: mode_steps.map(|steps| steps as u64),
            time_s: mode_steps.map(|steps| besides_s + MODE_STEP_S * steps),
            modes,
        }
    }

    /// For an impact with stated modes.
    fn of_stated(impact: &Impact) -> Result<Estimate, InvalidInput> {
        let (count, tolerance) = (impact.kept_modes(), impact.settings.tolerance);
        let steps = Impact { settings: pilot(), ..impact.clone() }.solve()?.counts.steps();
        Ok(Estimate::of_solves(vec![count], steps, tolerance, STATED, format!("{count} modes, as stated")))
    }
}

impl Scene {
    /// Shows which model [`Scene::answer`] would use, and the cost of each. Closed forms and the infinite beam are evaluated. Only
    /// one modal impact is solved, at a loose tolerance, to estimate the cost, and two more if the theory of bending has to be
    /// chosen.
    ///
    /// # Errors
    /// As [`Scene::answer`].
    pub fn plan(&self) -> Result<Plan, InvalidInput> {
        if self.is_infinite() {
            let answer = self.answer()?;
            let estimate = Estimate {
                model: answer.model,
                applies: true,
                reason: answer.reason,
                expected_error: answer.restitution_uncertainty,
                modes: Vec::new(),
                mode_steps: [0; 2],
                time_s: [2.0 * INFINITE_S; 2],
            };
            let tolerance = answer.tolerance;
            return Ok(Plan { model: answer.model, tolerance, contact_duration_s: None, tiers: vec![estimate] });
        }
        if let Some(why) = modal_only(self) {
            return self.plan_of_modes(why);
        }
        let (mut kept, cost) = (Kept::default(), &mut Cost::default());
        let open = self.with_theory(&mut Found::default(), cost)?;
        let (scene, why) = open.as_ref().map_or((self, None), |(scene, why)| (scene, Some(why)));
        let mut pose = Pose::new(scene, &mut kept)?;
        let mut tiers = Vec::new();
        for cheaper in CHEAPER {
            let time_s = if cheaper.model == Model::InfiniteBeam { INFINITE_S } else { FORMULA_S };
            tiers.push(Estimate::tried(cheaper.model, cheaper.certified(&mut pose, cost)?, time_s));
        }
        let mut of_modes = modal(&mut pose, cost)?;
        if let Some(why) = why {
            of_modes.reason += &format!("; {why}");
        }
        tiers.push(of_modes);
        let model = match self.model {
            Model::Auto if chooses_modes(self) => {
                tiers.iter().find(|tier| tier.applies).map_or(Model::Modal, |tier| tier.model)
            }
            Model::Auto => Model::Modal,
            forced => {
                forced_tier_applies(forced, &mut pose, cost)?;
                forced
            }
        };
        let contact_duration_s = Some(pose.wall.duration_s).filter(|duration| duration.is_finite());
        Ok(Plan { model, tolerance: pose.tolerance, contact_duration_s, tiers })
    }

    /// The plan if there is no choice.
    fn plan_of_modes(&self, why: &str) -> Result<Plan, InvalidInput> {
        if !matches!(self.model, Model::Auto | Model::Modal) {
            return Err(refused(self.model, format!("auto or modal, because {why}")));
        }
        let impact = self.impact_of(self.modes.count(), &mut Kept::default())?;
        let without = |cheaper: Cheaper| Estimate::tried(cheaper.model, Err(why.to_owned()), FORMULA_S);
        let mut tiers: Vec<Estimate> = CHEAPER.map(without).into();
        tiers.push(Estimate::of_stated(&impact)?);
        Ok(Plan { model: Model::Modal, tolerance: impact.settings.tolerance, contact_duration_s: None, tiers })
    }
}

/// Settings of the pilot impact.
fn pilot() -> Settings {
    Settings { tolerance: PILOT_TOLERANCE, estimate_uncertainty: false, ..Settings::default() }
}

/// Rejects a model that was requested and is not available, as [`Scene::answer`] does.
fn forced_tier_applies(model: Model, pose: &mut Pose, cost: &mut Cost) -> Result<(), InvalidInput> {
    if model != Model::Modal {
        forced_tier(model, pose, cost)?.map_err(|reason| refused(model, format!("another model, because {reason}")))?;
    }
    Ok(())
}

fn modal(pose: &mut Pose, cost: &mut Cost) -> Result<Estimate, InvalidInput> {
    if !(chooses_modes(pose.scene) && pose.approaches()) {
        let count = if chooses_modes(pose.scene) { Some(0) } else { pose.scene.modes.count() };
        return Estimate::of_stated(&pose.scene.impact_of(count, pose.kept)?);
    }
    let second = guess(pose, cost)?;
    let first = fewer(second);
    let reason = format!(
        "begins with {second} modes, which it compares with {first}, and raises their number until the restitution converges \
         within {}",
        small(pose.tolerance)
    );
    let (structure, remainder_modes) = pose.structure((second / PILOT_PART).max(PILOT_FEWEST), cost)?;
    let tried = pose.impact(structure, remainder_modes, pilot()).solve_with(pose.kept)?;
    let range = if tried.sub_impacts.len() > 1 { SEVERAL } else { ONE_CONTACT };
    Ok(Estimate::of_solves(vec![first, second], tried.counts.steps(), pose.tolerance, range, reason))
}
