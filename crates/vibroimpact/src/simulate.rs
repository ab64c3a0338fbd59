//! Solves a scene by the solver for its structure.

use std::f64::consts::TAU;

use contact_models::Law;
use vibroimpact_sim::infinite::{self, Scale};
use vibroimpact_sim::modal::{History, Settings, Structure};

use crate::export::{self, Table};
use crate::impact::Impact;
use crate::infinite as infinite_structure;
use crate::model::{Answer, Kept, Model};
use crate::scene::{self, InvalidInput, Scene};
use crate::summary::{RodMotion, Summary};

/// The result of [`Scene::simulate`].
#[derive(Debug, Clone)]
pub enum Simulation {
    /// An impact on a structure with modes.
    Modal(Box<Resolved>),
    /// An impact on an infinite beam or plate.
    Infinite {
        /// The units of the solution.
        scale: Scale,
        /// The result, which can evaluate the motion.
        solution: infinite::Solution,
    },
    /// An answer of a model that does not resolve the motion in time.
    Net(Answer),
}

/// An impact with its motion in time.
#[derive(Debug, Clone)]
pub struct Resolved {
    /// The solved problem.
    pub impact: Impact,
    /// The result.
    pub summary: Summary,
    /// The whole motion.
    pub history: History<Law>,
}

impl Scene {
    /// Solves the impact by the model that the scene names, or that [`Scene::choose`] chooses, and records its motion.
    ///
    /// # Errors
    /// A value out of range, or too few or too many fields.
    ///
    /// ```
    /// let scene = vibroimpact::Scene::from_json(r#"{
    ///     "structure": { "kind": "modal", "omega_rad_s": [100, 400], "shape_at_location": [1, 1] },
    ///     "striker": { "mass_kg": 1, "speed_m_s": 1 },
    ///     "contact": { "law": "hertz", "stiffness_n_m1_5": 1e10 }
    /// }"#)?;
    /// let found = scene.simulate()?;
    /// assert!(found.json(&scene).unwrap().contains(r#""outcome": "rebound""#));
    /// assert_eq!(found.history(None).unwrap().columns[0].0, "time_s");
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn simulate(&self) -> Result<Simulation, InvalidInput> {
        if self.is_infinite() {
            self.require_infinite_model()?;
            let (scale, solution) = self.solve_infinite()?;
            return Ok(Simulation::Infinite { scale, solution });
        }
        let kept = &mut Kept::alone();
        let (choice, recorded) = self.choose_and(kept, |choice, kept| {
            let impact = match &choice.impact {
                Some(impact) => impact.clone(),
                None if choice.answer.model == Model::Rigid => self.at_a_wall()?,
                None => return Ok(None),
            };
            let recorded = impact.record_with(kept)?;
            Ok(Some((impact, recorded)))
        })?;
        let Some((impact, (solution, history))) = recorded else { return Ok(Simulation::Net(choice.answer)) };
        let rod = match &self.structure {
            scene::Structure::DroppedRod(rod) => RodMotion::new(rod.length_m, &impact.structure.modes, &solution.rate),
            _ => None,
        };
        let summary = Summary::new(&solution, history.energy_ledger(), &impact).chosen(choice);
        let summary = Summary { rod, ..summary };
        Ok(Simulation::Modal(Box::new(Resolved { impact, summary, history })))
    }

    /// The contact with an immovable structure.
    pub(crate) fn at_a_wall(&self) -> Result<Impact, InvalidInput> {
        let impact = self.impact_of(Some(0), &mut Kept::default())?;
        // a tolerance that includes truncation may be looser than the solver allows
        Ok(Impact {
            structure: Structure::default(),
            remainder_modes: 0,
            start: None,
            settings: Settings::default(),
            ..impact
        })
    }

    /// Solves the impact on an infinite beam or plate; the scale holds the units of the solution.
    ///
    /// # Errors
    /// As [`Scene::posed_on_infinite`], or numbers out of the range of the solver.
    pub fn solve_infinite(&self) -> Result<(Scale, infinite::Solution), InvalidInput> {
        let posed = self.posed_on_infinite()?;
        posed.solve(&infinite::Settings::default()).map_err(|fault| self.of_extreme_field(fault))
    }
}

impl Simulation {
    /// The scene as it was solved: with the theory of bending that was used, if `scene` does not state it.
    pub fn scene(&self, scene: &Scene) -> Scene {
        scene.as_answered(match self {
            Simulation::Modal(found) => found.summary.choice.as_ref(),
            Simulation::Infinite { .. } => None,
            Simulation::Net(answer) => Some(answer),
        })
    }

    /// Motion and force over time, the table `history.csv`, if the model resolves them: until `until_s`, or until shortly after the
    /// last contact. An impact that does not end is known only up to the end of the computation.
    pub fn history(&self, until_s: Option<f64>) -> Option<Table> {
        match self {
            Simulation::Modal(found) => Some(export::history(&found.history, found.until_s(until_s))),
            Simulation::Infinite { scale, solution } => {
                let until = until_s.map(|until_s| until_s / scale.time_s);
                Some(infinite_structure::history(solution, Some(scale), until))
            }
            Simulation::Net(_) => None,
        }
    }

    /// The energy of each mode over time, the table `modal_energies.csv`, if there are modes; the end is that of
    /// [`Simulation::history`].
    pub fn modal_energies(&self, until_s: Option<f64>) -> Option<Table> {
        match self {
            Simulation::Modal(found) => Some(export::modal_energies(&found.history, found.until_s(until_s))),
            Simulation::Infinite { .. } | Simulation::Net(_) => None,
        }
    }
}

impl Resolved {
    /// End of tables and figures (s), with the requested end `wanted` or the default. After the bodies have separated for good
    /// their motion is free and known for all times; after a computation that stopped, or in sustained contact, it is not. If the
    /// bodies never meet, the default is a period of the slowest vibration, because the computation may show so at the start.
    pub fn until_s(&self, wanted: Option<f64>) -> f64 {
        let known_s = self.history.duration_s();
        match (self.summary.outcome, wanted) {
            ("rebound" | "no contact", Some(wanted)) => wanted.min(self.history.known_until_s()),
            ("rebound", None) => (known_s * (1.0 + AFTERMATH)).min(self.history.known_until_s()),
            ("no contact", None) => known_s.max(self.longest_period_s().unwrap_or(AT_REST_S)),
            (_, wanted) => wanted.map_or(known_s, |wanted| wanted.min(known_s)),
        }
    }

    /// The longest period of the modes that vibrate at the start (s); `None` if none does.
    fn longest_period_s(&self) -> Option<f64> {
        let modes = self.impact.structure.modes.iter().zip(self.history.modal_energies_j(0.0));
        let vibrates = modes.filter(|(mode, energy_j)| mode.omega_rad_s > 0.0 && *energy_j > 0.0);
        vibrates.map(|(mode, _)| TAU / mode.omega_rad_s).max_by(f64::total_cmp)
    }
}

/// Extent of tables and figures after the last separation, as a share of the time until then.
const AFTERMATH: f64 = 0.1;
/// The same if nothing vibrates and the bodies never meet (s).
const AT_REST_S: f64 = 1.0;
