//! A scene solved in the way that its structure asks for.

use contact_models::Law;
use vibroimpact_sim::infinite::{self, Groups};
use vibroimpact_sim::modal::History;

use crate::export::{self, Failure, Table};
use crate::impact::Impact;
use crate::infinite as infinite_structure;
use crate::model::Answer;
use crate::scene::{InvalidInput, Scene};
use crate::summary::Summary;

/// What [`Scene::simulate`] found.
pub enum Simulation {
    /// An impact on a structure with modes.
    Modal(Box<Resolved>),
    /// An impact on an infinite beam or plate.
    Infinite {
        /// The units of the solution.
        groups: Groups,
        /// The result, which can be asked for the motion.
        solution: infinite::Solution,
    },
    /// An answer of a model that does not resolve the course in time.
    Net(Answer),
}

/// An impact with its course in time.
pub struct Resolved {
    /// What was solved.
    pub impact: Impact,
    /// The result.
    pub summary: Summary,
    /// The whole motion.
    pub history: History<Law>,
}

impl Scene {
    /// Solves the impact by the model that the scene asks for, or that [`Scene::choose`] chooses, and keeps its motion.
    ///
    /// # Errors
    /// A value out of range, or fields of which too few or too many are given.
    ///
    /// ```
    /// let scene = vibroimpact::Scene::from_json(r#"{
    ///     "structure": { "kind": "modal", "omega_rad_s": [100, 400], "shape_at_location": [1, 1] },
    ///     "striker": { "mass_kg": 1, "speed_m_s": 1 },
    ///     "contact": { "law": "hertz", "stiffness_n_m1_5": 1e10 }
    /// }"#)?;
    /// let found = scene.simulate()?;
    /// assert!(found.json().unwrap().contains(r#""outcome": "rebound""#));
    /// assert_eq!(found.history().unwrap().columns[0].0, "time_s");
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn simulate(&self) -> Result<Simulation, InvalidInput> {
        if self.is_infinite() {
            let (groups, solution) = self.solve_infinite()?;
            return Ok(Simulation::Infinite { groups, solution });
        }
        let choice = self.choose()?;
        let Some(impact) = choice.impact else {
            return Ok(Simulation::Net(choice.answer));
        };
        let (solution, history) = impact.record()?;
        let residual_m_n = impact.structure.residual_compliance_m_n;
        let summary = Summary::new(&solution, history.energy_ledger(), residual_m_n).chosen(choice.answer);
        Ok(Simulation::Modal(Box::new(Resolved { impact, summary, history })))
    }

    /// Solves the impact on an infinite beam or plate; the groups hold the units of the solution.
    ///
    /// # Errors
    /// As [`Scene::infinite_impact`], or groups that are out of range.
    pub fn solve_infinite(&self) -> Result<(Groups, infinite::Solution), InvalidInput> {
        let impact = self.infinite_impact()?;
        let groups = impact.groups()?;
        let solution = infinite::solve(impact.structure, groups.s, &infinite::Settings::default())?;
        Ok((groups, solution))
    }
}

impl Simulation {
    /// What `simulate --json` prints.
    ///
    /// # Errors
    /// None that an impact could cause.
    pub fn json(&self) -> Result<String, Failure> {
        match self {
            Simulation::Modal(found) => export::json(&found.summary),
            Simulation::Infinite { groups, solution } => {
                export::json(&infinite_structure::Summary::new(solution, Some(groups)))
            }
            Simulation::Net(answer) => export::json(answer),
        }
    }

    /// Motion and force over time, the table `history.csv`, if the model resolves them.
    pub fn history(&self) -> Option<Table> {
        match self {
            Simulation::Modal(found) => Some(export::history(&found.history)),
            Simulation::Infinite { groups, solution } => Some(infinite_structure::history(solution, Some(groups))),
            Simulation::Net(_) => None,
        }
    }

    /// The energy of each mode over time, the table `modal_energies.csv`, if there are modes.
    pub fn modal_energies(&self) -> Option<Table> {
        match self {
            Simulation::Modal(found) => Some(export::modal_energies(&found.history)),
            Simulation::Infinite { .. } | Simulation::Net(_) => None,
        }
    }
}
