//! Cache from scene to scene: the modes of beams and the tables of solvers.

use std::collections::VecDeque;
use std::fmt;

use vibroimpact_sim::modal::{Recording, Solver, Structure};

use crate::in_scene::in_scene;
use crate::scene::{InvalidInput, KnownModes};

/// Largest total number of modes in cached tables; about 5 kB each.
const MOST_MODES: usize = 2000;

/// Cached modes and tables of the last scenes, for [`Scene::answer_with`](crate::Scene::answer_with). Scenes with the same beam
/// share its modes. Impacts at the same location share the tables of the solver, which cost about as much as an impact. Results do
/// not depend on the cache, to the last bit.
///
/// ```
/// use vibroimpact::{Scene, model::Kept};
///
/// let mut kept = Kept::default();
/// for mass_kg in [0.05, 0.1, 0.2] {
///     let scene = Scene::from_json(&format!(r#"{{
///         "structure": {{ "kind": "beam", "ends": ["clamped", "free"], "damping_ratio": 0.02,
///                        "segments": [{{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }}] }},
///         "striker": {{ "mass_kg": {mass_kg}, "speed_m_s": 1 }},
///         "contact": {{ "law": "hertz", "stiffness_n_m1_5": 1.8e10 }},
///         "location_m": 0.9
///     }}"#))?;
///     assert_eq!(scene.answer_with(&mut kept)?, scene.answer()?);
/// }
/// # Ok::<(), vibroimpact::SceneError>(())
/// ```
#[derive(Default)]
pub struct Kept {
    pub(crate) modes: KnownModes,
    solvers: VecDeque<(Structure, Solver)>,
    /// Whether locations of impact hardly ever recur.
    passing: bool,
    /// Whether there is one scene alone: motions are kept, and impacts that do not depend on each other are solved at the same time.
    alone: bool,
    /// The motion of the impact behind the last answer.
    motion: Option<(Structure, Recording)>,
}

/// Number of cached solvers if locations hardly ever recur: a group of draws for indices has two locations.
const PASSING: usize = 2;

impl fmt::Debug for Kept {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Kept").field("solvers", &self.solvers.len()).finish_non_exhaustive()
    }
}

impl Kept {
    /// A cache for scenes of one beam whose locations hardly ever recur: few tables are stored, and converted from location to
    /// location.
    pub(crate) fn passing() -> Kept {
        Kept { passing: true, ..Kept::default() }
    }

    /// A cache for one scene alone, whose motion is kept and whose impacts are solved at the same time where they do not depend on
    /// each other.
    pub(crate) fn alone() -> Kept {
        Kept { alone: true, ..Kept::default() }
    }

    /// Whether there is one scene alone.
    pub(crate) fn is_alone(&self) -> bool {
        self.alone
    }

    /// Keeps the motion of the impact behind an answer, on this structure.
    pub(crate) fn keep(&mut self, structure: &Structure, recording: Option<Recording>) {
        self.motion = recording.map(|recording| (structure.clone(), recording));
    }

    /// The motion of the impact behind the last answer, if it was on this structure.
    pub(crate) fn motion_on(&mut self, structure: &Structure) -> Option<Recording> {
        self.motion.take().filter(|(kept, _)| kept == structure).map(|(_, recording)| recording)
    }

    /// Empties the cache.
    pub(crate) fn clear(&mut self) {
        *self = Kept { passing: self.passing, alone: self.alone, ..Kept::default() };
    }

    /// A solver for a structure under gravity (m/s^2), with its cached tables.
    pub(crate) fn solver(&mut self, structure: &Structure, gravity_m_s2: f64) -> Result<&Solver, InvalidInput> {
        let known = self.solvers.iter().position(|(kept, _)| kept == structure);
        let (structure, solver) = match known.and_then(|place| self.solvers.remove(place)) {
            Some(known) => known,
            None => {
                let turns = self.passing && self.solvers.len() >= PASSING;
                let last = if turns { self.solvers.pop_back() } else { None };
                let solver = match last {
                    Some((_, mut solver)) => {
                        solver.turn_to(structure).map_err(in_scene)?;
                        solver
                    }
                    None => Solver::new(structure).map_err(in_scene)?,
                };
                (structure.clone(), solver)
            }
        };
        let solver = solver.under_gravity(gravity_m_s2).map_err(in_scene)?;
        let mut modes = structure.modes.len();
        self.solvers.push_front((structure, solver));
        // the most recently used ones, up to the limit
        let fit = self.solvers.iter().skip(1).take_while(|(structure, _)| {
            modes += structure.modes.len();
            modes <= MOST_MODES
        });
        let fit = fit.count();
        self.solvers.truncate(1 + fit);
        Ok(&self.solvers[0].1)
    }
}
