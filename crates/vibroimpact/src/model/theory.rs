//! Uncertainty of the theory of bending, and choice of the theory for an impact.
//!
//! If a beam can be solved by Euler-Bernoulli's and by Timoshenko's theory, the impact is solved by both, and by Timoshenko's with
//! a shear coefficient 2 % smaller and larger. (The usual coefficients differ by up to 5 %.) With the four restitutions `e_v`, one
//! of which is `e` by the theory of the answer,
//!
//! ```text
//! u = max_v |e_v - e|.
//! ```
//!
//! The largest force of each contact that all four have changes in the same way.
//!
//! All four have remainder modes, and twice the expected number of modes for the tolerance. Where a number is stated, they have the
//! closest number to it that is between once and twice the expected one, but at most twice the stated one. They are solved once at a
//! loose tolerance, so that this costs no more than a few times the impact itself. If a scene does not state the theory, the cheaper
//! one is used if the two differ by less than half the tolerance. None of this depends on the answer, so that the last two impacts are
//! solved beside it.

use vibroimpact_sim::both;
use vibroimpact_sim::modal::{Settings, Solution};

use super::choice::Choice;
use super::other_modes::needed as needed_modes;
use super::quantity::Quantity;
use super::uncertainty::{Uncertainty, of_peaks};
use super::{Answer, Cost, DEFAULT_TOLERANCE, Kept, Model, Modes};
use crate::impact::Impact;
use crate::in_scene::in_scene;
use crate::scene::{Beam, BeamTheory, InvalidInput, KnownModes, Scene, Structure, chooses_modes};
use crate::text::small;

/// Range of the tolerance that determines the number of modes.
const TOLERANCES: [f64; 2] = [1e-5, 3e-3];
/// Tolerance of the solver as a share of that tolerance.
const SOLVER_SHARE: f64 = 0.1;
/// Factor of the expected number of modes, and largest factor of the stated number. For some impacts the expected number itself is too
/// small, which one solution by each theory does not show.
const RICHER: usize = 2;
/// The cheaper theory is used if the difference is below this share of the tolerance, of which it is one part.
const SHARE: f64 = 0.5;

/// The restitution itself, without the motion behind it.
const RESTITUTION: Quantity = Quantity::Restitution { per_impulse: 0.0, from: 1.0, per_time: 0.0, crossing_s: 0.0 };

/// The impacts on the beams of one scene that are solved so far, so that the choice of the theory and its uncertainty do not solve an
/// impact twice.
#[derive(Default)]
pub(super) struct Found {
    /// In the order of [`beams`].
    solved: Vec<Solved>,
    /// Whether two impacts are solved at the same time.
    concurrent: bool,
}

/// The impact on one beam.
pub(super) struct Solved {
    /// Expected number of modes.
    needed: Option<usize>,
    solution: Solution,
    cost: Cost,
    /// The modes of this beam that were computed.
    modes: KnownModes,
}

impl Found {
    /// Nothing yet; with `concurrent`, two impacts will be solved at the same time.
    pub fn new(concurrent: bool) -> Found {
        Found { concurrent, ..Found::default() }
    }

    /// Whether the theory was chosen by impacts with a rebound, so that its uncertainty will be wanted, and can be estimated beside the
    /// answer.
    pub fn goes_on(&self) -> bool {
        self.concurrent
            && !self.solved.is_empty()
            && self.solved.iter().all(|solved| solved.solution.restitution.is_some())
    }

    /// The impacts that are not solved yet.
    pub fn others(&self, scene: &Scene) -> Result<Vec<Solved>, InvalidInput> {
        self.up_to(scene, &beams(scene)?)
    }

    /// The same, of these beams.
    fn up_to(&self, scene: &Scene, beams: &[Beam]) -> Result<Vec<Solved>, InvalidInput> {
        let mut others: Vec<Solved> = Vec::new();
        for pair in beams[self.solved.len()..].chunks(2) {
            // the pair after the first differs from its first beam by the shear coefficient alone, and needs as many modes
            let needed = self.solved.first().or(others.first()).map(|solved| solved.needed);
            let solve = |beam: &Beam| solve(scene, beam, needed);
            let (second, first) = both(self.concurrent, || pair.get(1).map(solve), || solve(&pair[0]));
            others.push(first?);
            others.extend(second.transpose()?);
        }
        Ok(others)
    }

    /// Adds impacts, and their cost.
    pub fn add(&mut self, others: Vec<Solved>, cost: &mut Cost) {
        others.iter().for_each(|solved| *cost += solved.cost);
        self.solved.extend(others);
    }

    /// Solves the impact by the first two theories, or by all; the inner `Err` states why they cannot be compared.
    fn theories(&mut self, scene: &Scene, all: bool, cost: &mut Cost) -> Result<Result<(), String>, InvalidInput> {
        let beams = beams(scene)?;
        let wanted = if all { beams.len() } else { beams.len().min(2) };
        if self.solved.len() < wanted {
            let others = self.up_to(scene, &beams[..wanted])?;
            self.add(others, cost);
        }
        Ok(if !self.solved.iter().all(|solved| solved.solution.restitution.is_some()) {
            Err("by one of the theories the impact does not end in a rebound".to_owned())
        } else if self.solved.len() < 2 {
            Err("there is no other theory to be compared with".to_owned())
        } else {
            Ok(())
        })
    }

    /// The largest change of a quantity from what a theory gives; infinite if not all impacts have it.
    fn around(&self, theory: BeamTheory, of: &Quantity) -> f64 {
        let Some(base) = self.solved.get(place(Some(theory))) else { return f64::INFINITY };
        self.solved.iter().map(|other| of.change(&other.solution, &base.solution).itself).fold(0.0, f64::max)
    }

    /// The modes that were computed for the beam of this scene by its theory.
    pub fn modes_of(&mut self, scene: &Scene) -> KnownModes {
        let place = place(scene.structure.bending_theory());
        self.solved.get_mut(place).map_or_else(KnownModes::default, |solved| std::mem::take(&mut solved.modes))
    }
}

/// The place of a theory among the first two of [`beams`].
fn place(theory: Option<BeamTheory>) -> usize {
    usize::from(theory == Some(BeamTheory::EulerBernoulli))
}

/// The beam of a scene by Timoshenko's theory, by Euler-Bernoulli's, and by Timoshenko's with other shear coefficients; none if it
/// cannot be solved by both.
fn beams(scene: &Scene) -> Result<Vec<Beam>, InvalidInput> {
    let Structure::Beam(beam) = &scene.structure else { return Ok(Vec::new()) };
    let variants = |beam: &Beam| beam.theory_variants().map_err(|fault| fault.within("structure"));
    if variants(beam)?.is_empty() {
        return Ok(Vec::new());
    }
    let timoshenko = Beam { theory: Some(BeamTheory::Timoshenko), ..beam.clone() };
    let variants = variants(&timoshenko)?;
    let beams = std::iter::once(timoshenko).chain(variants.into_iter().map(|(_, beam)| beam));
    Ok(beams.collect())
}

/// Solves the scene on this beam with the expected number of modes for the tolerance, if that is known already, and remainder modes.
fn solve(scene: &Scene, beam: &Beam, needed: Option<Option<usize>>) -> Result<Solved, InvalidInput> {
    // the modes of this beam must not replace those that are cached for the next scene
    let (mut kept, mut cost) = (Kept::default(), Cost::default());
    let scene = Scene { structure: beam.clone().into(), ..scene.clone() };
    let tolerance = scene.tolerance.unwrap_or(DEFAULT_TOLERANCE).clamp(TOLERANCES[0], TOLERANCES[1]);
    let needed = match needed {
        Some(needed) => needed,
        None => needed_modes(&scene, tolerance, &mut kept, &mut cost)?,
    };
    let modes = count(&scene, needed);
    let scene = Scene { modes: Modes::Count(modes), residual_compliance: Some(true), ..scene };
    let impact = scene.impact_of(Some(modes), &mut kept)?;
    let Impact { structure, striker, law, start, settings, .. } = &impact;
    let settings = Settings { tolerance: SOLVER_SHARE * tolerance, estimate_uncertainty: false, ..*settings };
    let solution = impact.solver_with(&mut kept)?.solve(striker, law, start.as_ref(), &settings).map_err(in_scene)?;
    cost.add(&solution.counts, structure.modes.len());
    Ok(Solved { needed, solution, cost, modes: kept.modes })
}

/// The number of modes with which the theories are compared.
fn count(scene: &Scene, needed: Option<usize>) -> usize {
    match (needed, scene.modes.count()) {
        (Some(needed), Some(stated)) => stated.clamp(needed, RICHER * needed).min(RICHER * stated.max(1)),
        (Some(needed), None) => RICHER * needed,
        (None, stated) => stated.unwrap_or_default(),
    }
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
        let approaches = self.striker.speed_m_s > 0.0 || self.fall_from(0).is_some_and(|start| start.gap_m > 0.0);
        if !(open && asked && approaches && chooses_modes(self) && !beams(self)?.is_empty()) {
            return Ok(None);
        }
        let tolerance = self.tolerance.unwrap_or(DEFAULT_TOLERANCE);
        let difference = |found: &Found| found.around(BeamTheory::Timoshenko, &RESTITUTION);
        let (theory, why) = match found.theories(self, false, cost)? {
            Ok(()) if difference(found) <= SHARE * tolerance => {
                let difference = small(difference(found));
                let why =
                    format!("by Euler-Bernoulli's theory, from which Timoshenko's differs by some {difference} here");
                (BeamTheory::EulerBernoulli, why)
            }
            Ok(()) => {
                let difference = small(difference(found));
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
        choice: Choice,
        found: &mut Found,
        cost: &mut Cost,
    ) -> Result<Choice, InvalidInput> {
        let Choice { answer, impact, sub_impacts, peak_forces } = choice;
        let (Some(theory), Some(_), false) = (answer.theory, answer.restitution, beams(self)?.is_empty()) else {
            return Ok(Choice { answer, impact, sub_impacts, peak_forces });
        };
        const PART: &str = "beam theory: ";
        let mut not_known: Vec<String> =
            answer.not_known.iter().filter(|why| !why.starts_with(PART)).cloned().collect();
        let (beam_theory, peak_forces) = match found.theories(self, true, cost)? {
            Ok(()) => {
                let peaks = of_peaks(&sub_impacts, |i, of| Uncertainty {
                    beam_theory: Some(found.around(theory, of)),
                    ..peak_forces[i]
                });
                (Some(found.around(theory, &RESTITUTION).min(1.0)), peaks)
            }
            Err(why) => {
                not_known.push(format!("{PART}{why}"));
                (None, peak_forces)
            }
        };
        let uncertainty = Uncertainty { beam_theory, ..answer.uncertainty };
        let answer = Answer { restitution_uncertainty: uncertainty.whole(), uncertainty, not_known, ..answer };
        Ok(Choice { answer, impact, sub_impacts, peak_forces })
    }
}
