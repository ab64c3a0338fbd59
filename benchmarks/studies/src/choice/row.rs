//! One scene at one tolerance: the answer, its cost, and the true result.

use super::scenes;
use serde::{Deserialize, Serialize};
use tasks::Failure;
use vibroimpact::model::{Kept, Model, Modes};
use vibroimpact::vibroimpact_sim::modal::{Settings, Solution};
use vibroimpact::{Impact, Scene};

/// Tolerances at which every scene is answered.
pub(super) const TOLERANCES: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
/// The reference has this multiple of the modes of the finest answer (or all modes, if there are fewer), and at least this
/// many modes.
const RICHER: usize = 2;
const FEWEST_OF_REFERENCE: usize = 128;
/// The number of modes of the reference is doubled until its error is this many times smaller than the finest tolerance, or
/// until there are no more modes.
const KNOWN: f64 = 30.0;
/// Largest number of modes of a reference in a quick run.
const MOST_OF_QUICK: usize = 1500;
const REFERENCE_TOLERANCE: f64 = 1e-10;
/// The same if there are several contacts, each of which amplifies earlier errors.
const AFTER_SEVERAL: f64 = 1e-12;
/// Factor between successive numbers of modes, also of the reference.
const RAISE: f64 = std::f64::consts::SQRT_2;
/// The smallest number of modes that is tried for the cheapest model, and its tolerances as shares of the requested tolerance.
/// The first sufficient one is used.
const FEWEST: usize = 4;
const SHARES: [f64; 3] = [0.1, 3e-3, 1e-4];
/// Smaller errors are due to rounding.
const ROUNDING: f64 = 1e-11;
/// A reference counts if its error is this many times smaller than the tolerance.
const TIGHTER: f64 = 3.0;

#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Row {
    pub scene: u64,
    pub kind: String,
    pub law: String,
    pub damping_ratio: f64,
    pub tolerance: f64,
    pub model: Model,
    /// Whether the program chose the modes, so that it can report convergence.
    pub chosen: bool,
    pub modes: usize,
    pub sub_impacts: Option<usize>,
    pub outcome: String,
    pub restitution: Option<f64>,
    pub uncertainty: Option<f64>,
    pub settled: bool,
    pub reference_modes: usize,
    pub reference: Option<f64>,
    /// Difference of the reference from one with fewer modes, or the solver's uncertainty of the reference if that is larger.
    pub reference_change: Option<f64>,
    pub solves: u64,
    pub mode_steps: u64,
    /// Range of mode-steps that `plan` predicts, if it expects modes to be integrated.
    pub planned_least: Option<u64>,
    pub planned_most: Option<u64>,
    /// The smallest number of modes from which on the error stays below the tolerance, and the cost of one solution with them.
    pub cheapest_modes: Option<usize>,
    pub cheapest_mode_steps: Option<u64>,
}

impl Row {
    /// The rows of a scene, one per tolerance.
    pub fn of_scene(number: u64, quick: bool) -> Result<Vec<Row>, Failure> {
        let drawn = scenes::scene(number)?;
        let mut answers = Vec::new();
        for tolerance in TOLERANCES {
            let scene = Scene { tolerance: Some(tolerance), ..drawn.scene.clone() };
            answers.push(scene.answer_with(&mut Kept::default())?);
        }
        let most = answers.iter().map(|answer| answer.modes).max().unwrap_or_default();
        let at_most = if quick { drawn.most_modes.min(MOST_OF_QUICK) } else { drawn.most_modes };
        let truth = Truth::new(&drawn, RICHER * most, at_most.max(most))?;
        let chosen = drawn.scene.modes == Modes::Auto;
        let mut rows = Vec::new();
        for answer in answers {
            let plan = Scene { tolerance: Some(answer.tolerance), ..drawn.scene.clone() }.plan()?;
            let planned = plan.tiers.iter().find(|tier| tier.model == Model::Modal && plan.model == Model::Modal);
            let planned = planned.map(|tier| tier.mode_steps);
            let cheapest = if chosen { truth.cheapest(answer.tolerance)? } else { None };
            rows.push(Row {
                scene: number,
                kind: drawn.kind.to_owned(),
                law: drawn.scene.contact.law_name().to_owned(),
                damping_ratio: drawn.damping_ratio,
                tolerance: answer.tolerance,
                model: answer.model,
                chosen,
                modes: answer.modes,
                sub_impacts: answer.sub_impact_count,
                outcome: answer.outcome.to_owned(),
                restitution: answer.restitution,
                uncertainty: answer.restitution_uncertainty,
                settled: answer.settled && chosen,
                reference_modes: truth.modes,
                reference: truth.restitution,
                reference_change: truth.change,
                solves: answer.cost.solves,
                mode_steps: answer.cost.mode_steps,
                planned_least: planned.map(|[least, _]| least),
                planned_most: planned.map(|[_, most]| most),
                cheapest_modes: cheapest.map(|(modes, _)| modes),
                cheapest_mode_steps: cheapest.map(|(_, cost)| cost),
            });
        }
        Ok(rows)
    }

    pub fn planned(&self) -> Option<[u64; 2]> {
        Some([self.planned_least?, self.planned_most?])
    }

    /// Whether the reference is known well enough for this tolerance.
    pub fn counts(&self) -> bool {
        self.reference_change.is_some_and(|change| change * TIGHTER <= self.tolerance)
    }

    pub fn error(&self) -> Option<f64> {
        self.restitution.zip(self.reference).map(|(e, reference)| (e - reference).abs())
    }

    pub fn meets(&self) -> bool {
        self.error().is_some_and(|error| error <= self.tolerance)
    }

    /// Ratio of the actual error to the reported uncertainty. A difference within the uncertainty of the reference is not an error.
    pub fn overrun(&self) -> Option<f64> {
        let error = self.error()? - self.reference_change?;
        Some(if error > ROUNDING { error / self.uncertainty? } else { 0.0 })
    }
}

/// The true result of a scene, with its uncertainty.
struct Truth<'a> {
    scene: &'a Scene,
    modes: usize,
    restitution: Option<f64>,
    change: Option<f64>,
    /// Increasing numbers of modes, and the error of each.
    errors: Vec<(usize, f64)>,
}

impl<'a> Truth<'a> {
    /// Computes the reference with at least this many modes, or with all modes if there are fewer.
    fn new(drawn: &'a scenes::Drawn, at_least: usize, at_most: usize) -> Result<Truth<'a>, Failure> {
        let exact = |scene: &Scene, modes| Ok::<_, Failure>(solve(scene, modes, REFERENCE_TOLERANCE)?.restitution);
        let counts = |most: usize| {
            let counts = std::iter::successors(Some(FEWEST as f64), |count| Some(count * RAISE));
            counts.map(|count| count.round() as usize).take_while(move |count| *count < most)
        };
        let finest = TOLERANCES.into_iter().fold(f64::INFINITY, f64::min);
        let difference = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| (a - b).abs());
        let mut modes = at_least.clamp(FEWEST_OF_REFERENCE, at_most);
        let several = solve(&drawn.whole, modes, REFERENCE_TOLERANCE)?.sub_impacts.len() > 1;
        let tolerance = if several { AFTER_SEVERAL } else { REFERENCE_TOLERANCE };
        let reference = |modes| Ok::<_, Failure>(solve(&drawn.whole, modes, tolerance)?.restitution);
        let (restitution, change) = loop {
            let restitution = reference(modes)?;
            let change = difference(reference((modes as f64 / RAISE) as usize)?, restitution);
            if modes >= at_most || change.is_none_or(|change| KNOWN * change <= finest) {
                break (restitution, change);
            }
            modes = (2 * modes).min(at_most);
        };
        let impact = impact(&drawn.whole, modes, tolerance)?;
        let settings = Settings { estimate_uncertainty: true, ..impact.settings };
        let uncertainty = Impact { settings, ..impact }.solve()?.restitution_uncertainty;
        let change = change.zip(uncertainty).map(|(change, uncertainty)| change.max(uncertainty));
        let off = |e: Option<f64>| difference(e, restitution);
        let listed = drawn.scene.structure != drawn.whole.structure;
        let most = if listed { drawn.scene.mode_shapes(usize::MAX).map_or(0, |modes| modes.len()) } else { modes };
        let mut errors = Vec::new();
        for count in counts(most) {
            errors.push((count, off(exact(&drawn.scene, count)?).unwrap_or(1.0)));
        }
        Ok(Truth { scene: &drawn.scene, modes, restitution, change, errors })
    }

    /// The smallest number of modes that is sure to meet a tolerance, and the cost of one solution.
    fn cheapest(&self, tolerance: f64) -> Result<Option<(usize, u64)>, Failure> {
        let enough = self.errors.iter().rev().take_while(|(_, error)| *error <= tolerance).last();
        let Some(((modes, _), reference)) = enough.zip(self.restitution) else { return Ok(None) };
        for share in SHARES {
            let solution = solve(self.scene, *modes, share * tolerance)?;
            if solution.restitution.is_some_and(|e| (e - reference).abs() <= tolerance) {
                return Ok(Some((*modes, solution.counts.steps() * solution.amplitude.len().max(1) as u64)));
            }
        }
        Ok(None)
    }
}

/// The impact with this many modes and remainder modes for all others.
fn impact(scene: &Scene, modes: usize, tolerance: f64) -> Result<Impact, Failure> {
    let impact = Scene { modes: Modes::Count(modes), residual_compliance: Some(true), ..scene.clone() }.impact()?;
    let settings = Settings { tolerance, estimate_uncertainty: false, ..impact.settings };
    Ok(Impact { settings, ..impact })
}

/// Solves it once.
fn solve(scene: &Scene, modes: usize, tolerance: f64) -> Result<Solution, Failure> {
    Ok(impact(scene, modes, tolerance)?.solve()?)
}
