//! One number of modes and its impact: posed, solved, and solved again with what other numbers of modes do not change.

use invalid_input::InvalidInput;
use vibroimpact_sim::modal::{Outcome, Recording, Settings, Solution};
use vibroimpact_sim::{StopReason, both};

use super::Cost;
use super::guess::{fewer, resolution_of};
use super::left_out::{energy_of_remainder, too_short, with_one_remainder_mode, with_softer_remainder};
use super::other_modes::solve;
use super::pose::{Pose, Source};
use crate::impact::Impact;

/// Tolerance of the solver with the first numbers of modes, as a share of the requested tolerance, and its range. Below it,
/// differences are dominated by rounding.
const SOLVER_SHARE: f64 = 0.1;
const SOLVER_RANGE: (f64, f64) = (1e-11, 1e-3);
/// Tolerance with the next number of modes, if there are several contacts, as a share of that with the number before.
const TIGHTER: f64 = 1.0 / 30.0;
/// Factor of the tolerance of another solution that shows the solver's error, if the last two numbers of modes share the tightest
/// tolerance.
const LOOSER: f64 = 16.0;

/// The solver's settings for a requested tolerance, after this many tightenings.
pub(super) fn settings(tolerance: f64, tightened: usize) -> Settings {
    let share = (0..tightened).fold(SOLVER_SHARE * tolerance, |share, _| TIGHTER * share);
    let tolerance = share.clamp(SOLVER_RANGE.0, SOLVER_RANGE.1);
    Settings { tolerance, estimate_uncertainty: false, ..Settings::default() }
}

/// One number of modes and its result.
pub(super) struct Rung {
    /// Number of modes from the lowest, including those that are not excited.
    pub count: usize,
    pub impact: Impact,
    pub solution: Solution,
    /// Its motion, if motions are kept and it may be the last.
    pub recording: Option<Recording>,
    /// Frequency of the last mode relative to the contact, `R(N)` (`guess.rs`).
    pub resolution: f64,
    /// Possible error of the remainder modes, from their energy.
    pub energy: f64,
    /// Errors that other numbers of modes do not show; computed once everything else has converged.
    pub unseen: Option<Unseen>,
}

/// Impacts with the same number of modes that show errors which changes between numbers of modes do not show.
#[derive(Default)]
pub(super) struct Unseen {
    /// With a looser tolerance, if the number of modes before had the same tolerance.
    pub solver: Option<Solution>,
    /// With another shape of the remainder modes, if theirs is assumed.
    pub shape: Option<Solution>,
    /// With a static compliance larger by its uncertainty.
    pub compliance: Option<Solution>,
}

/// An impact with a number of modes, to be solved.
struct Posed {
    count: usize,
    impact: Impact,
    resolution: f64,
}

impl Posed {
    fn new(pose: &mut Pose, count: usize, settings: Settings, cost: &mut Cost) -> Result<Posed, InvalidInput> {
        let (structure, remainder_modes) = pose.structure(count, cost)?;
        let remainder = &structure.modes[structure.modes.len() - remainder_modes..];
        let resolution = resolution_of(pose, count, remainder, cost)?;
        Ok(Posed { count, impact: pose.impact(structure, remainder_modes, settings), resolution })
    }

    /// Solved, with its motion if motions are kept.
    fn kept(self, pose: &mut Pose, cost: &mut Cost) -> Result<Rung, InvalidInput> {
        let (solution, recording) = self.impact.keep_with(pose.kept)?;
        cost.add(&solution.counts, self.impact.structure.modes.len());
        Ok(self.solved(solution, recording))
    }

    fn solved(self, solution: Solution, recording: Option<Recording>) -> Rung {
        let Posed { count, impact, resolution } = self;
        let energy = energy_of_remainder(&impact, &solution) * too_short(resolution);
        Rung { count, impact, solution, recording, resolution, energy, unseen: None }
    }
}

impl Rung {
    /// One that may be the last.
    pub fn new(pose: &mut Pose, count: usize, settings: Settings, cost: &mut Cost) -> Result<Rung, InvalidInput> {
        Posed::new(pose, count, settings, cost)?.kept(pose, cost)
    }

    /// One to compare with the last.
    pub fn beside(pose: &mut Pose, count: usize, settings: Settings, cost: &mut Cost) -> Result<Rung, InvalidInput> {
        let posed = Posed::new(pose, count, settings, cost)?;
        let solution = solve(&posed.impact, pose.kept, cost)?;
        Ok(posed.solved(solution, None))
    }

    /// One with this number of modes and, if impacts are solved at the same time, the one with fewer modes that it will most likely
    /// be compared with. Where that one fails, it has not been solved.
    pub fn with_the_one_before(
        pose: &mut Pose,
        count: usize,
        settings: Settings,
        cost: &mut Cost,
    ) -> Result<(Rung, Option<Rung>), InvalidInput> {
        if !pose.kept.is_alone() || pose.is_complete() {
            return Ok((Rung::new(pose, count, settings, cost)?, None));
        }
        let posed = Posed::new(pose, count, settings, cost)?;
        let before = Posed::new(pose, fewer(count), settings, cost).ok();
        let solve_before = || before.as_ref()?.impact.solve().ok();
        let (of_before, rung) = both(before.is_some(), solve_before, || posed.kept(pose, cost));
        let before = before.zip(of_before).map(|(before, solution)| before.solved(solution, None));
        Ok((rung?, before))
    }

    /// Solves the impact with other remainder modes and, if it is wanted, with a looser tolerance.
    pub fn find_unseen(&mut self, pose: &mut Pose, with_solver: bool, cost: &mut Cost) -> Result<(), InvalidInput> {
        let listed = matches!(pose.source, Source::Listed { .. });
        let wanted = pose.scene.residual_compliance != Some(false);
        let uncertain_m_n = if wanted { pose.source.uncertain_m_n() } else { 0.0 };
        let mut changed = |other: Impact| Ok::<_, InvalidInput>(Some(solve(&other, pose.kept, cost)?));
        let mut unseen = Unseen::default();
        let Impact { structure, remainder_modes, settings, .. } = &self.impact;
        if with_solver {
            let settings = Settings { tolerance: LOOSER * settings.tolerance, ..*settings };
            unseen.solver = changed(Impact { settings, ..self.impact.clone() })?;
        }
        if listed && *remainder_modes > 1 {
            // for a list the shape of the tail is an assumption, whose effect another shape shows
            unseen.shape = changed(self.impact.on(with_one_remainder_mode(structure, *remainder_modes)))?;
        }
        if uncertain_m_n > 0.0 {
            unseen.compliance =
                changed(self.impact.on(with_softer_remainder(structure, *remainder_modes, uncertain_m_n)))?;
        }
        self.unseen = Some(unseen);
        Ok(())
    }

    pub fn has_several_contacts(&self) -> bool {
        self.solution.sub_impacts.len() > 1
    }

    /// Whether no tighter tolerance of the solver is left.
    pub fn has_tightest_tolerance(&self) -> bool {
        self.impact.settings.tolerance <= SOLVER_RANGE.0
    }

    /// Whether it reached the limit of steps, which the impact with fewer modes may not reach.
    pub fn takes_too_many_steps(&self) -> bool {
        matches!(self.solution.outcome, Outcome::Stopped(StopReason::Steps))
    }
}
