//! The choice of the model: the cheapest model that reaches the requested accuracy for a scene.
//!
//! | model | assumption | chosen if |
//! |---|---|---|
//! | [`Model::Rigid`] | the location cannot move | a bound on the energy that the structure can take up proves it |
//! | [`Model::InfiniteBeam`] | no wave returns from an end | the contact ends earlier, and the beam never meets the striker again |
//! | [`Model::Modal`] | some modes and remainder modes | all other cases; the number of modes is raised to convergence |
//! | [`Model::Emoc`] | no motion in time | it is requested, or the tolerance is as wide as the law's validated error |
//!
//! [`Scene::answer`] chooses and solves ([`Scene::answer_with`] is faster for many scenes of one beam), [`Scene::plan`] shows the
//! choice in advance, [`Scene::compare`] compares all models. All of it is deterministic.

mod attached;
mod choice;
mod choose;
mod compare;
mod draw;
mod emoc;
mod guess;
mod impact;
mod infinite;
mod kept;
mod left_out;
mod other_modes;
mod plan;
mod pose;
mod quantity;
mod rigid;
mod rung;
mod rungs;
mod settle;
mod stated;
mod static_tail;
mod text;
mod theory;
mod uncertainty;
mod wall;

use std::ops::AddAssign;

use serde::Serialize;
use vibroimpact_sim::StopReason;
use vibroimpact_sim::modal::Counts;

pub use attached::largest_share;
pub use choice::Choice;
pub use compare::{Comparison, Tier};
#[cfg(feature = "files")]
pub(crate) use draw::Draw;
pub use emoc::{VALIDATED, Validated, law as emoc_law};
pub(crate) use guess::more;
pub use infinite::{Reflection, reflection_bound};
pub use kept::Kept;
pub use plan::{Estimate, Plan};
#[cfg(feature = "files")]
pub(crate) use text::parts_in_words;
pub(crate) use text::wrapped;
pub use text::{answer_text, comparison_text, net_text, plan_text};
pub use uncertainty::Uncertainty;

#[cfg(doc)]
use crate::Scene;
use crate::scene::BeamTheory;
pub(crate) use crate::scene::chooses_modes;
pub use crate::scene::{Model, Modes};

/// Requested accuracy of the restitution if the program chooses the modes and the scene states no tolerance.
pub const DEFAULT_TOLERANCE: f64 = 1e-3;

/// The result of [`Scene::answer`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Answer {
    /// The model used; never `auto`.
    pub model: Model,
    /// The theory by which a beam was solved; null for other structures.
    pub theory: Option<BeamTheory>,
    /// `rebound`, `no contact`, `sustained` or `stopped`.
    pub outcome: &'static str,
    /// The reason why it stopped before the end of the impact, as a word of [`StopReason`]; null if it did not.
    #[serde(serialize_with = "crate::stop_word::word")]
    pub stopped_by: Option<StopReason>,
    /// Net restitution, 0 in sustained contact; null where the bodies did not approach each other or the computation stopped.
    pub restitution: Option<f64>,
    /// Estimated error of the restitution: the whole of what can be estimated, the sum of the parts in `uncertainty`; null if that
    /// of the solver is not known.
    pub restitution_uncertainty: Option<f64>,
    /// Its parts; null where a part cannot be known.
    pub uncertainty: Uncertainty,
    /// Why parts of the uncertainty are not known, a sentence each that begins with the part.
    pub not_known: Vec<String>,
    /// Requested accuracy.
    pub tolerance: f64,
    /// Number of separate contacts; null for a model that does not resolve them.
    pub sub_impact_count: Option<usize>,
    /// Number of modes retained.
    pub modes: usize,
    /// Number of additional remainder modes, which represent all others; 0 if there are none.
    pub remainder_modes: usize,
    /// Static compliance of the truncated modes, which the remainder modes have (m/N); 0 without them.
    pub residual_compliance_m_n: f64,
    /// Whether the tolerance was reached, by the theory used (for stated modes: whether the solver's part of the uncertainty is
    /// within ten times the tolerance, or within [`DEFAULT_TOLERANCE`] where the scene states none).
    pub settled: bool,
    /// If it was not: difference of the largest and smallest restitution over the last numbers of modes tried.
    pub spread: Option<f64>,
    /// The reason for this model, and the evidence that it holds.
    pub reason: String,
    /// The cost of the answer.
    pub cost: Cost,
}

impl Answer {
    /// A template of an answer: a rebound without resolved contacts.
    fn new(model: Model, tolerance: f64, known: uncertainty::Known, reason: String) -> Answer {
        Answer {
            model,
            theory: None,
            outcome: "rebound",
            stopped_by: None,
            restitution: None,
            restitution_uncertainty: known.uncertainty.whole(),
            uncertainty: known.uncertainty,
            not_known: known.not_known,
            tolerance,
            sub_impact_count: None,
            modes: 0,
            remainder_modes: 0,
            residual_compliance_m_n: 0.0,
            settled: known.uncertainty.whole().is_some_and(|whole| whole <= tolerance),
            spread: None,
            reason,
            cost: Cost::default(),
        }
    }
}

/// Deterministic counts of the work, summed over all solutions, including those that were discarded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Cost {
    /// Impacts solved.
    pub solves: u64,
    /// Modes computed, over all computations of modes.
    pub modes_computed: u64,
    /// Steps accepted in contact.
    pub contact_steps: u64,
    /// Rejected steps in contact.
    pub rejected_steps: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Evaluations of the contact law.
    pub law_evaluations: u64,
    /// Steps of the search for the next contact.
    pub flight_steps: u64,
    /// Steps of all kinds times modes, to which the time of the modal solver is roughly proportional.
    pub mode_steps: u64,
    /// Panels of the integral equation of the infinite beam.
    pub panels: u64,
}

impl AddAssign for Cost {
    fn add_assign(&mut self, other: Cost) {
        self.solves += other.solves;
        self.modes_computed += other.modes_computed;
        self.contact_steps += other.contact_steps;
        self.rejected_steps += other.rejected_steps;
        self.newton_iterations += other.newton_iterations;
        self.law_evaluations += other.law_evaluations;
        self.flight_steps += other.flight_steps;
        self.mode_steps += other.mode_steps;
        self.panels += other.panels;
    }
}

impl Cost {
    /// Adds a solution with this many modes.
    pub(crate) fn add(&mut self, counts: &Counts, modes: usize) {
        *self += Cost {
            solves: 1,
            modes_computed: 0,
            contact_steps: counts.contact_steps,
            rejected_steps: counts.rejected_steps,
            newton_iterations: counts.newton_iterations,
            law_evaluations: counts.law_evaluations,
            flight_steps: counts.flight_steps,
            mode_steps: counts.steps() * modes.max(1) as u64,
            panels: 0,
        };
    }
}
