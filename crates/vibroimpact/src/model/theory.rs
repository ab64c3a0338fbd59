//! Uncertainty of the theory of bending, and choice of the theory for an impact.
//!
//! If a beam can be solved by Euler-Bernoulli's and by Timoshenko's theory, the impact is solved by both, and by Timoshenko's with
//! a shear coefficient 2 % smaller and larger, which covers the usual coefficients. With the four restitutions `e_v`, one of
//! which is `e` by the theory of the answer,
//!
//! ```text
//! u = max_v |e_v - e|.
//! ```
//!
//! All four have remainder modes, and twice the expected number of modes for the tolerance or the number of the answer. Where a number
//! is stated, they have the closest number to it that is between once and twice the expected one, but at most twice the stated one.
//! They are solved once at a loose tolerance, so that this costs no more than a few times the impact
//! itself. If a scene does not state the theory, the cheaper one is used if the two differ by less than half the tolerance.

use vibroimpact_sim::both;
use vibroimpact_sim::modal::Settings;

use super::other_modes::needed;
use super::uncertainty::Uncertainty;
use super::{Answer, Cost, DEFAULT_TOLERANCE, Kept, Model, Modes};
use crate::impact::Impact;
use crate::in_scene::in_scene;
use crate::scene::{Beam, BeamTheory, InvalidInput, Scene, Structure, chooses_modes};
use crate::text::small;

/// Tolerance that determines the number of modes, if the requested one is tighter.
const TOLERANCES: [f64; 2] = [1e-5, 3e-3];
/// Tolerance of the solver.
const SOLVER: f64 = 1e-6;
/// Factor of the expected number of modes, and largest factor of the stated number.
const RICHER: usize = 2;
/// The cheaper theory is used if the difference is below this share of the tolerance, of which it is one part.
const SHARE: f64 = 0.5;

/// What was found for the beams of one scene, so that the choice of the theory and its uncertainty do not solve an impact twice.
#[derive(Default)]
pub(super) struct Found {
    /// Expected number of modes by each theory; a slightly different shear coefficient needs as many.
    needed: Vec<(BeamTheory, Option<usize>)>,
    /// Restitutions, with the number of modes.
    restitutions: Vec<(Beam, usize, Option<f64>)>,
    /// Whether two impacts are solved at the same time.
    concurrent: bool,
}

/// The restitution on one beam.
struct Solved {
    theory: BeamTheory,
    needed: Option<usize>,
    beam: Beam,
    modes: usize,
    restitution: Option<f64>,
    cost: Cost,
}

/// Restitutions of one impact by both theories.
struct Theories {
    euler_bernoulli: f64,
    timoshenko: f64,
    /// By Timoshenko's with other shear coefficients.
    others: Vec<f64>,
}

impl Theories {
    /// For a scene whose beam can be solved by both; for an answer with its number of modes, and other coefficients. The inner
    /// `Err` states why it is not known.
    fn of(
        scene: &Scene,
        answer: Option<&Answer>,
        found: &mut Found,
        cost: &mut Cost,
    ) -> Result<Result<Theories, String>, InvalidInput> {
        let Structure::Beam(beam) = &scene.structure else { return Ok(Err("the structure is not a beam".to_owned())) };
        let in_structure = |fault: InvalidInput| fault.within("structure");
        let timoshenko = Beam { theory: Some(BeamTheory::Timoshenko), ..beam.clone() };
        let mut beams = vec![timoshenko.clone()];
        beams.extend(timoshenko.theory_variants().map_err(in_structure)?.into_iter().map(|(_, beam)| beam));
        beams.truncate(if answer.is_some() { 4 } else { 2 });
        let least = answer.map_or(0, |answer| answer.modes);
        let mut restitutions = Vec::new();
        for pair in beams.chunks(2) {
            let known = |beam: &Beam| found.known(scene, beam, least);
            let concurrent = found.concurrent && pair.iter().all(|beam| known(beam).is_none());
            let solve = |beam: &Beam| match known(beam) {
                Some(restitution) => Ok((restitution, None)),
                None => found.solve(scene, beam, least).map(|solved| (solved.restitution, Some(solved))),
            };
            let second = || pair.get(1).map(solve);
            let (second, first) = both(concurrent, second, || solve(&pair[0]));
            for solved in std::iter::once(first).chain(second) {
                let (restitution, solved) = solved?;
                if let Some(solved) = solved {
                    *cost += solved.cost;
                    found.add(solved);
                }
                restitutions.push(restitution);
            }
        }
        let Some(restitutions) = restitutions.into_iter().collect::<Option<Vec<f64>>>() else {
            return Ok(Err("by one of the theories the impact does not end in a rebound".to_owned()));
        };
        Ok(match restitutions[..] {
            [timoshenko, euler_bernoulli, ref others @ ..] => {
                Ok(Theories { euler_bernoulli, timoshenko, others: others.to_vec() })
            }
            _ => Err("there is no other theory to be compared with".to_owned()),
        })
    }

    fn difference(&self) -> f64 {
        (self.euler_bernoulli - self.timoshenko).abs()
    }

    /// The largest change from what a theory gives.
    fn around(&self, theory: BeamTheory) -> f64 {
        let base = if theory == BeamTheory::Timoshenko { self.timoshenko } else { self.euler_bernoulli };
        self.others.iter().map(|e| (e - base).abs()).fold(self.difference(), f64::max)
    }
}

impl Found {
    /// Nothing yet; with `concurrent`, two impacts will be solved at the same time.
    pub fn new(concurrent: bool) -> Found {
        Found { concurrent, ..Found::default() }
    }

    /// The restitution of the scene on this beam, if it is known.
    fn known(&self, scene: &Scene, beam: &Beam, least: usize) -> Option<Option<f64>> {
        let theory = theory_of(&on(scene, beam));
        let (_, needed) = self.needed.iter().find(|(known, _)| *known == theory)?;
        let count = count(scene, *needed, least);
        let known = self.restitutions.iter().find(|(known, modes, _)| known == beam && *modes == count);
        known.map(|(.., restitution)| *restitution)
    }

    /// Solves the scene on this beam with the expected number of modes for the tolerance, with a lower limit, and remainder modes.
    fn solve(&self, scene: &Scene, beam: &Beam, least: usize) -> Result<Solved, InvalidInput> {
        // the modes of this beam must not replace those that are cached for the next scene
        let (kept, mut cost) = (&mut Kept::default(), Cost::default());
        let scene = on(scene, beam);
        let theory = theory_of(&scene);
        let needed = match self.needed.iter().find(|(known, _)| *known == theory) {
            Some((_, needed)) => *needed,
            None => {
                let tolerance = scene.tolerance.unwrap_or(DEFAULT_TOLERANCE).clamp(TOLERANCES[0], TOLERANCES[1]);
                needed(&scene, tolerance, kept, &mut cost)?
            }
        };
        let modes = count(&scene, needed, least);
        let scene = Scene { modes: Modes::Count(modes), residual_compliance: Some(true), ..scene };
        let impact = scene.impact_of(Some(modes), kept)?;
        let Impact { structure, striker, law, start, settings, .. } = &impact;
        let settings = Settings { tolerance: SOLVER, estimate_uncertainty: false, ..*settings };
        let solution = kept.solver(structure)?.solve(striker, law, start.as_ref(), &settings).map_err(in_scene)?;
        cost.add(&solution.counts, structure.modes.len());
        Ok(Solved { theory, needed, beam: beam.clone(), modes, restitution: solution.restitution, cost })
    }

    fn add(&mut self, Solved { theory, needed, beam, modes, restitution, .. }: Solved) {
        if self.needed.iter().all(|(known, _)| *known != theory) {
            self.needed.push((theory, needed));
        }
        self.restitutions.push((beam, modes, restitution));
    }
}

/// The scene on this beam.
fn on(scene: &Scene, beam: &Beam) -> Scene {
    Scene { structure: beam.clone().into(), ..scene.clone() }
}

fn theory_of(scene: &Scene) -> BeamTheory {
    scene.structure.bending_theory().unwrap_or(BeamTheory::Auto)
}

/// The number of modes with which the theories are compared.
fn count(scene: &Scene, needed: Option<usize>, least: usize) -> usize {
    match (needed, scene.modes.count()) {
        (Some(needed), Some(stated)) => stated.clamp(needed, RICHER * needed).min(RICHER * stated.max(1)),
        (Some(needed), None) => (RICHER * needed).max(least),
        (None, stated) => stated.unwrap_or_default(),
    }
}

/// Whether the beam of a scene can be solved by both theories.
fn has_both(scene: &Scene) -> Result<bool, InvalidInput> {
    let Structure::Beam(beam) = &scene.structure else { return Ok(false) };
    Ok(!beam.theory_variants().map_err(|fault| fault.within("structure"))?.is_empty())
}

impl Scene {
    /// The scene with the cheapest theory of bending that the tolerance allows, and the reason, if the scene does not state one.
    pub(super) fn with_theory(
        &self,
        found: &mut Found,
        cost: &mut Cost,
    ) -> Result<Option<(Scene, String)>, InvalidInput> {
        let Structure::Beam(beam) = &self.structure else { return Ok(None) };
        let open = matches!(beam.theory, None | Some(BeamTheory::Auto));
        let asked = self.model == Model::Auto || self.model == Model::Modal;
        // without an approach nothing depends on the theory
        let approaches = self.striker.speed_m_s > 0.0;
        if !(open && asked && approaches && chooses_modes(self) && has_both(self)?) {
            return Ok(None);
        }
        let tolerance = self.tolerance.unwrap_or(DEFAULT_TOLERANCE);
        let (theory, why) = match Theories::of(self, None, found, cost)? {
            Ok(theories) if theories.difference() <= SHARE * tolerance => {
                let difference = small(theories.difference());
                let why =
                    format!("by Euler-Bernoulli's theory, from which Timoshenko's differs by some {difference} here");
                (BeamTheory::EulerBernoulli, why)
            }
            Ok(theories) => {
                let difference = small(theories.difference());
                let why =
                    format!("by Timoshenko's theory, from which Euler-Bernoulli's differs by some {difference} here");
                (BeamTheory::Timoshenko, why)
            }
            Err(why) => (BeamTheory::Timoshenko, format!("by Timoshenko's theory: {why}")),
        };
        let structure = Beam { theory: Some(theory), ..beam.clone() }.into();
        Ok(Some((Scene { structure, ..self.clone() }, why)))
    }

    /// The scene with the theory of bending by which it was answered.
    pub(crate) fn as_answered(&self, answer: Option<&Answer>) -> Scene {
        match (&self.structure, answer.and_then(|answer| answer.theory)) {
            (Structure::Beam(beam), Some(theory)) if matches!(beam.theory, None | Some(BeamTheory::Auto)) => {
                let structure = Beam { theory: Some(theory), ..beam.clone() }.into();
                Scene { structure, ..self.clone() }
            }
            _ => self.clone(),
        }
    }

    /// The change of an answer by another theory of bending, as a part of its uncertainty.
    pub(super) fn judge_theory(
        &self,
        answer: Answer,
        found: &mut Found,
        cost: &mut Cost,
    ) -> Result<Answer, InvalidInput> {
        let (Some(theory), true) = (answer.theory, answer.restitution.is_some() && has_both(self)?) else {
            return Ok(answer);
        };
        const PART: &str = "beam theory: ";
        let mut not_known: Vec<String> =
            answer.not_known.iter().filter(|why| !why.starts_with(PART)).cloned().collect();
        let beam_theory = match Theories::of(self, Some(&answer), found, cost)? {
            Ok(theories) => Some(theories.around(theory).min(1.0)),
            Err(why) => {
                not_known.push(format!("{PART}{why}"));
                None
            }
        };
        let uncertainty = Uncertainty { beam_theory, ..answer.uncertainty };
        Ok(Answer { restitution_uncertainty: uncertainty.whole(), uncertainty, not_known, ..answer })
    }
}
