//! The result of `simulate` for programs, with the same keys for every model.

use serde::Serialize;
use serde_json::Value;
use vibroimpact_sim::StopReason;
use vibroimpact_sim::infinite::{Scale, Solution};

use crate::export::{self, Failure};
use crate::infinite;
use crate::model::{Answer, Uncertainty};
use crate::scene::{InvalidInput, Scene, Structure};
use crate::simulate::Simulation;
use crate::stop_word::word;
use crate::summary::{Contact, Cost, Energy, RodMotion, Summary};
use crate::trust::Check;

/// The object of `simulate --json` and `result.json`. The keys are always the same; quantities that a model does not resolve are
/// null. Every name contains its unit.
///
/// ```
/// let scene = vibroimpact::Scene::from_json(r#"{
///     "structure": { "kind": "modal", "omega_rad_s": [100], "shape_at_location": [1] },
///     "striker": { "mass_kg": 1, "speed_m_s": 1 },
///     "contact": { "law": "hertz", "stiffness_n_m1_5": 1e10 }
/// }"#)?;
/// let result: serde_json::Value = serde_json::from_str(&scene.simulate()?.json(&scene).unwrap()).unwrap();
/// assert_eq!(result["outcome"], "rebound");
/// assert_eq!(result["scene"]["striker"]["mass_kg"], 1.0);
/// assert!(result["infinite"].is_null());
/// # Ok::<(), vibroimpact::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResultFile {
    /// Version of the program.
    pub vibroimpact: &'static str,
    /// The scene as it was solved: a table of modes is written out, and `version` is that of the format.
    pub scene: Value,
    /// As [`Summary::outcome`].
    pub outcome: &'static str,
    /// The reason why the computation stopped before the end of the impact, as a word of [`StopReason`]; null if it did not.
    #[serde(serialize_with = "word")]
    pub stopped_by: Option<StopReason>,
    /// Net restitution, 0 in sustained contact; null where the bodies did not approach each other or the computation stopped.
    pub restitution: Option<f64>,
    /// Estimated error of the restitution: the sum of what can be estimated; null where that of the solver cannot.
    pub restitution_uncertainty: Option<f64>,
    /// Its parts; null where a part cannot be known, which `choice.not_known` explains.
    pub uncertainty: Uncertainty,
    /// Number of separate contacts; null for a model that does not resolve them.
    pub sub_impact_count: Option<usize>,
    /// The contacts in order of time; null for a model that does not resolve them.
    pub sub_impacts: Option<Vec<SubImpact>>,
    /// Why parts of the uncertainty of largest forces are not known that are known of the restitution, a sentence each that begins with
    /// the part.
    pub peak_forces_not_known: Vec<String>,
    /// Velocity of the striker at the end, positive away from the structure (m/s).
    pub striker_velocity_m_s: Option<f64>,
    /// Motion of a dropped rod at the end; null for everything else.
    pub rod: Option<RodMotion>,
    /// Height to which a falling striker rises above the undeflected structure (m); null without gravity.
    pub rise_m: Option<f64>,
    /// Time of the last separation, or at which the computation stopped (s).
    pub end_s: Option<f64>,
    /// Number of modes retained.
    pub modes: usize,
    /// Number of remainder modes that represent all others; they come last in lists of modes.
    pub remainder_modes: usize,
    /// Static compliance of the truncated modes, which the remainder modes have (m/N); 0 without them.
    pub residual_compliance_m_n: f64,
    /// The energy balance; null for a model that does not resolve it.
    pub energy: Option<Energy>,
    /// The cost of the last solution; null for a model without integration in time. The total cost is that of `choice`.
    pub counts: Option<Cost>,
    /// The model, the reason for it, its accuracy compared with the tolerance, and the total cost.
    pub choice: Option<Answer>,
    /// How far the theories behind the result can be trusted, [`Scene::trust`]; empty if no check applies.
    pub trust: Vec<Check>,
    /// The solution for an infinite structure, as `infinite-beam --json` prints it; null for everything else.
    pub infinite: Option<infinite::Summary>,
}

/// One contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SubImpact {
    /// First touch (s).
    pub start_s: f64,
    /// Separation (s); null if the contact does not end.
    pub end_s: Option<f64>,
    /// Impulse of the contact force (N s); null if the contact does not end.
    pub impulse_n_s: Option<f64>,
    /// Largest force (N).
    pub peak_force_n: f64,
    /// Estimated error of the largest force: the sum of the known parts (N); null where one is not known that is known of the
    /// restitution.
    pub peak_force_uncertainty_n: Option<f64>,
    /// Its parts (N); null where a part cannot be known, which `peak_forces_not_known` or `choice.not_known` explains.
    pub peak_force_uncertainty_parts_n: Uncertainty,
    /// Largest compression (m).
    pub peak_compression_m: f64,
}

impl Simulation {
    /// The text of `simulate --json`; `scene` is the one that was solved.
    ///
    /// # Errors
    /// As [`Scene::simulate`], for a simulation of another scene.
    pub fn json(&self, scene: &Scene) -> Result<String, Failure> {
        let scene = &self.scene(scene);
        self.json_with(scene, scene.trust(self)?)
    }

    /// The same from the scene as it was solved, [`Simulation::scene`], and its checks, [`Scene::trust`].
    ///
    /// # Errors
    /// As [`Simulation::json`].
    pub fn json_with(&self, scene: &Scene, trust: Vec<Check>) -> Result<String, Failure> {
        let result = match self {
            Simulation::Modal(found) => ResultFile::of_modes(scene, &found.summary),
            Simulation::Infinite { scale, solution } => ResultFile::of_infinite(scene, scale, solution)?,
            Simulation::Net(answer) => ResultFile::of_answer(scene, answer),
        };
        export::json(&ResultFile { trust, ..result })
    }
}

impl ResultFile {
    /// A resolved impact on a structure with modes.
    pub fn of_modes(scene: &Scene, summary: &Summary) -> ResultFile {
        let Summary {
            outcome,
            stopped_by,
            restitution,
            restitution_uncertainty,
            uncertainty,
            sub_impact_count,
            sub_impacts,
            peak_forces_not_known,
            striker_velocity_m_s,
            rod,
            rise_m,
            end_s,
            modes,
            remainder_modes,
            residual_compliance_m_n,
            energy,
            counts,
            choice,
        } = summary.clone();
        let contact = |contact: Contact| SubImpact {
            start_s: contact.start_s,
            end_s: Some(contact.end_s),
            impulse_n_s: Some(contact.impulse_n_s),
            peak_force_n: contact.peak_force_n,
            peak_force_uncertainty_n: contact.peak_force_uncertainty_n,
            peak_force_uncertainty_parts_n: contact.peak_force_uncertainty_parts_n,
            peak_compression_m: contact.peak_compression_m,
        };
        ResultFile {
            vibroimpact: env!("CARGO_PKG_VERSION"),
            scene: scene.tree(),
            outcome,
            stopped_by,
            restitution,
            restitution_uncertainty,
            uncertainty,
            sub_impact_count: Some(sub_impact_count),
            sub_impacts: Some(sub_impacts.into_iter().map(contact).collect()),
            peak_forces_not_known,
            striker_velocity_m_s: Some(striker_velocity_m_s),
            rod,
            rise_m,
            end_s: Some(end_s),
            modes,
            remainder_modes,
            residual_compliance_m_n,
            energy: Some(energy),
            counts: Some(counts),
            choice,
            trust: Vec::new(),
            infinite: None,
        }
    }

    /// An answer of a model that does not resolve the motion in time.
    pub fn of_answer(scene: &Scene, answer: &Answer) -> ResultFile {
        ResultFile {
            vibroimpact: env!("CARGO_PKG_VERSION"),
            scene: scene.tree(),
            outcome: answer.outcome,
            stopped_by: answer.stopped_by,
            restitution: answer.restitution,
            restitution_uncertainty: answer.restitution_uncertainty,
            uncertainty: answer.uncertainty,
            sub_impact_count: answer.sub_impact_count,
            sub_impacts: None,
            peak_forces_not_known: Vec::new(),
            // the structure is at rest before the impact, and the restitution is the striker's
            striker_velocity_m_s: match scene.structure {
                Structure::DroppedRod(_) => None,
                _ => answer.restitution.map(|e| e * scene.striker.speed_m_s),
            },
            rod: None,
            rise_m: None,
            end_s: None,
            modes: answer.modes,
            remainder_modes: answer.remainder_modes,
            residual_compliance_m_n: answer.residual_compliance_m_n,
            energy: None,
            counts: None,
            choice: Some(answer.clone()),
            trust: Vec::new(),
            infinite: None,
        }
    }

    /// An impact on an infinite beam or plate.
    ///
    /// # Errors
    /// As [`Scene::posed_on_infinite`].
    pub fn of_infinite(scene: &Scene, scale: &Scale, solution: &Solution) -> Result<ResultFile, InvalidInput> {
        let answer = scene.infinite_answer(solution);
        let found = infinite::Summary::new(solution, Some(scale));
        let momentum = scene.posed_on_infinite()?.striker.mass_kg * scale.speed_m_s;
        let mut compression = vec![0.0_f64; solution.sub_impacts.len()];
        for extremum in &solution.extrema {
            if let Some(peak) = compression.get_mut(extremum.contact) {
                *peak = peak.max(extremum.compression);
            }
        }
        let contacts = solution.sub_impacts.iter().zip(&found.contacts).zip(compression);
        let contacts = contacts.map(|((contact, told), compression)| SubImpact {
            start_s: scale.time_s * contact.start,
            end_s: contact.end.map(|end| scale.time_s * end),
            impulse_n_s: contact
                .striker_velocity_at_end
                .map(|end| momentum * (end - contact.striker_velocity_at_start)),
            peak_force_n: scale.force_n * told.peak_force,
            peak_force_uncertainty_n: None,
            peak_force_uncertainty_parts_n: Uncertainty::default(),
            peak_compression_m: scale.displacement_m * compression,
        });
        Ok(ResultFile {
            sub_impacts: Some(contacts.collect()),
            peak_forces_not_known: vec!["no part: not estimated for infinite structures".to_owned()],
            end_s: solution.sub_impacts.last().and_then(|contact| contact.end).map(|end| scale.time_s * end),
            infinite: Some(found),
            ..ResultFile::of_answer(scene, &answer)
        })
    }
}
