//! Convergence in the number of modes.
//!
//! The number of modes begins at a guess (`guess.rs`). One impact is enough to show that its modes are too few: its remainder
//! modes then have too much energy (`left_out.rs`), and the number is raised by a factor of about 1.4. If their energy is small,
//! the same impact with fewer modes, or the one solved before, shows the effect of the last modes.
//!
//! Restitutions may agree by accident while the histories of two impacts do not, and then differ again at the next number. The
//! striker's speed in every flight between two contacts is therefore compared as well, and after more than one contact a third
//! number of modes is required. So it is for plates, most of whose modes hardly move a given location: the modes between two numbers
//! may be such modes. And so it is where the force jumps at first touch: changes then decrease slowly, and vary by accident
//! (`left_out.rs`).
//!
//! In a fall, impacts may also agree by accident that a touch comes before or after the striker turns round (`quantity.rs`).
//!
//! Every contact amplifies earlier errors, the solver's among them, and a solver that is too coarse for an impact may find the
//! same wrong history with every number of modes. If there are several contacts, the solver's tolerance is therefore tightened
//! with every further number: its errors are part of the differences, and restitutions agree when both have become small. Once it is
//! as tight as possible, two impacts may have similar errors. The last is then solved again with a looser tolerance, and the change
//! counts as the solver's error.
//!
//! More modes take more and shorter steps. If an impact reaches the limit of steps, the answer comes from the number of modes before, or
//! from fewer modes if there was none before.
//!
//! Only a difference between two *different* numbers of modes contains information about the truncated modes. At the end of a
//! list of modes, the same modes with a tighter tolerance show the error of the solver alone.

use invalid_input::InvalidInput;
use vibroimpact_sim::modal::{Outcome, Recording, Settings, Solution};
use vibroimpact_sim::{StopReason, both};

use super::choice::Choice;
use super::guess::{fewer, guess, more, resolution_of};
use super::left_out::{
    at_the_end, by_changes, energy_of_remainder, jumps, still_growing, too_short, with_one_remainder_mode,
    with_softer_remainder,
};
use super::other_modes::solve;
use super::pose::{Pose, Source};
use super::quantity::{Change, Quantity};
use super::uncertainty::{Known, Uncertainty, of_peaks};
use super::{Answer, Cost, Model};
use crate::impact::Impact;
use crate::scene;
use crate::text::small;

/// The largest number of modes counts if it is this many times the one before; the change by a smaller step contains little
/// information about the rest.
const LEAST_RAISE: f64 = 1.25;
/// Only changes from at least this share of the number of modes are used to estimate the effect of further ones.
const NEAR: f64 = 0.5;
/// Tolerance of the solver with the first numbers of modes, as a share of the requested tolerance, and its range. Below it,
/// differences are dominated by rounding.
const SOLVER_SHARE: f64 = 0.1;
const SOLVER_RANGE: (f64, f64) = (1e-11, 1e-3);
/// Tolerance with the next number of modes, if there are several contacts, as a share of that with the number before.
const TIGHTER: f64 = 1.0 / 30.0;
/// The solver's part: this share of its tolerance, and of the change between runs whose tolerances differ by a factor of thirty.
const SOLVER_FLOOR: f64 = 0.5;
const SOLVER_CHANGE: f64 = 0.1;
/// Factor of the tolerance of another solution that shows the solver's error, if the last two numbers of modes share the tightest
/// tolerance.
const LOOSER: f64 = 16.0;
/// Beyond this many modes the number is raised after several contacts only while changes decrease: the last must be smaller than
/// this share of the one two steps before. A single contact amplifies nothing, so that more modes help.
const PATIENCE: usize = 400;
const FALLING: f64 = 0.5;
/// Two impacts may agree by accident, and small changes may add up. The stated uncertainty from the truncated modes is
/// therefore this factor times the estimate by which the restitution has converged, as far as the tolerance allows. Random
/// scenes show that converged results are within their tolerance (`cargo xtask study-auto`).
pub(super) const LUCK: f64 = 4.0;
/// Number of the last results that make up the spread if they do not converge.
const SPREAD: usize = 4;

/// The solver's settings for a requested tolerance, after this many tightenings.
fn settings(tolerance: f64, tightened: usize) -> Settings {
    let share = (0..tightened).fold(SOLVER_SHARE * tolerance, |share, _| TIGHTER * share);
    let tolerance = share.clamp(SOLVER_RANGE.0, SOLVER_RANGE.1);
    Settings { tolerance, estimate_uncertainty: false, ..Settings::default() }
}

/// One number of modes and its result.
struct Rung {
    /// Number of modes from the lowest, including those that are not excited.
    count: usize,
    impact: Impact,
    solution: Solution,
    /// Its motion, if motions are kept and no later number was tried.
    recording: Option<Recording>,
    /// Frequency of the last mode relative to the contact, `R(N)` (`guess.rs`).
    resolution: f64,
    /// Possible error of the remainder modes, from their energy.
    energy: f64,
    /// Errors that other numbers of modes do not show; computed once everything else has converged.
    unseen: Option<Unseen>,
}

/// Impacts with the same number of modes that show errors which changes between numbers of modes do not show.
#[derive(Default)]
struct Unseen {
    /// With a looser tolerance, if the number of modes before had the same tolerance.
    solver: Option<Solution>,
    /// With another shape of the remainder modes, if theirs is assumed.
    shape: Option<Solution>,
    /// With a static compliance larger by its uncertainty.
    compliance: Option<Solution>,
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

    fn solved(self, solution: Solution, recording: Option<Recording>) -> Rung {
        let Posed { count, impact, resolution } = self;
        let energy = energy_of_remainder(&impact, &solution) * too_short(resolution);
        Rung { count, impact, solution, recording, resolution, energy, unseen: None }
    }
}

impl Rung {
    fn new(pose: &mut Pose, count: usize, settings: Settings, cost: &mut Cost) -> Result<Rung, InvalidInput> {
        let posed = Posed::new(pose, count, settings, cost)?;
        let (solution, recording) = solve(&posed.impact, pose.kept, cost)?;
        Ok(posed.solved(solution, recording))
    }

    /// One with this number of modes and, if impacts are solved at the same time, the one with fewer modes that it will most likely
    /// be compared with. Where that one fails, it has not been solved.
    fn with_the_one_before(
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
        let (of_before, solved) = both(before.is_some(), solve_before, || solve(&posed.impact, pose.kept, cost));
        let (solution, recording) = solved?;
        let before = before.zip(of_before).map(|(before, solution)| before.solved(solution, None));
        Ok((posed.solved(solution, recording), before))
    }

    /// Solves the impact with other remainder modes and, if it is wanted, with a looser tolerance.
    fn find_unseen(&mut self, pose: &mut Pose, with_solver: bool, cost: &mut Cost) -> Result<(), InvalidInput> {
        let listed = matches!(pose.source, Source::Listed { .. });
        let wanted = pose.scene.residual_compliance != Some(false);
        let uncertain_m_n = if wanted { pose.source.uncertain_m_n() } else { 0.0 };
        let mut changed = |other: Impact| Ok::<_, InvalidInput>(Some(solve(&other, pose.kept, cost)?.0));
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

    fn has_several_contacts(&self) -> bool {
        self.solution.sub_impacts.len() > 1
    }

    /// Whether it reached the limit of steps, which the impact with fewer modes may not reach.
    fn takes_too_many_steps(&self) -> bool {
        matches!(self.solution.outcome, Outcome::Stopped(StopReason::Steps))
    }
}

/// The numbers of modes tried so far.
struct Rungs {
    earlier: Vec<Rung>,
    last: Rung,
    restitution: Quantity<'static>,
    /// Whether the contact force jumps at first touch.
    jumps: bool,
    /// The number of modes, if there is one, that makes up the whole static compliance.
    complete: Option<usize>,
    /// The number of modes with which the impact reached a limit of steps.
    too_many: Option<usize>,
}

impl Rungs {
    fn push(&mut self, next: Rung) {
        let last = std::mem::replace(&mut self.last, next);
        self.add_earlier(last);
    }

    /// Adds one before the last.
    fn add_earlier(&mut self, rung: Rung) {
        self.earlier.push(Rung { recording: None, ..rung });
    }

    /// All, the latest first.
    fn all(&self) -> impl Iterator<Item = &Rung> {
        std::iter::once(&self.last).chain(self.earlier.iter().rev())
    }

    /// The latest ones, latest first, with similar numbers of modes. Of the impacts with one number only the latest counts, which
    /// has the tightest tolerance: the same modes again contain no further information about the truncated ones. If there are
    /// none, every impact counts.
    fn near(&self) -> impl Iterator<Item = &Rung> {
        let again = |i: usize, count| self.all().take(i).any(|later| later.count == count);
        let distinct = self.all().enumerate().filter(move |(i, rung)| self.is_complete() || !again(*i, rung.count));
        let mut last = self.last.count;
        distinct.map(|(_, rung)| rung).take_while(move |rung| {
            let before = std::mem::replace(&mut last, rung.count);
            (1 + rung.count.min(before)) as f64 >= NEAR * (1 + rung.count.max(before)) as f64
        })
    }

    fn is_complete(&self) -> bool {
        self.complete == Some(self.last.count)
    }

    /// Changes between neighbours with different numbers of modes, the latest first.
    fn changes(&self, of: &Quantity) -> impl Iterator<Item = (Change, [usize; 2])> {
        let pairs = self.near().zip(self.near().skip(1)).filter(|(next, last)| next.count != last.count);
        pairs.map(|(next, last)| (of.change(&last.solution, &next.solution), [last.count, next.count]))
    }

    /// Their sizes.
    fn sizes(&self, of: &Quantity) -> Vec<f64> {
        self.changes(of).map(|(change, _)| change.size()).collect()
    }

    /// Change of the last by one of the impacts with the same number of modes; 0 if that is not needed.
    fn unseen(&self, of: &Quantity, which: fn(&Unseen) -> &Option<Solution>) -> f64 {
        let other = self.last.unseen.as_ref().and_then(|unseen| which(unseen).as_ref());
        other.map_or(0.0, |other| of.change(other, &self.last.solution).size())
    }

    /// Whether changes decrease as the number of modes rises, if there are enough of them.
    fn falls(&self) -> bool {
        let sizes = self.sizes(&self.restitution);
        sizes.len() < 3 || sizes[0] < FALLING * sizes[2]
    }

    /// Estimated change by the truncated modes, if it is known.
    fn left_out(&self, of: &Quantity) -> f64 {
        let changes: Vec<(f64, usize)> = self.changes(of).map(|(change, [_, to])| (change.size(), to)).collect();
        if self.is_complete() {
            return 0.0;
        }
        let changed = by_changes(&changes, self.jumps, of.scale()).max(of.scale() * self.last.energy);
        self.with_unseen(of, changed)
    }

    /// The same where the numbers of modes end before the restitution has converged.
    fn left_out_at_the_end(&self, of: &Quantity) -> f64 {
        let changed = at_the_end(&self.sizes(of), of.scale(), self.last.energy, self.last.resolution);
        self.with_unseen(of, changed)
    }

    /// An estimate with what remainder modes of another shape and the uncertainty of the compliance change.
    fn with_unseen(&self, of: &Quantity, changed: f64) -> f64 {
        changed.max(self.unseen(of, |unseen| &unseen.shape)) + self.unseen(of, |unseen| &unseen.compliance)
    }

    /// Whether the last two had the tightest tolerance, so that their change may not show the solver's error.
    fn share_tightest_tolerance(&self) -> bool {
        self.all().take(2).all(|rung| rung.impact.settings.tolerance <= SOLVER_RANGE.0)
    }

    /// Possible error of the solver with the last number of modes.
    fn solver(&self, of: &Quantity) -> f64 {
        let wider = self.earlier.iter().rev().find(|rung| rung.count == self.last.count);
        let change = match wider {
            Some(wider) => of.change(&wider.solution, &self.last.solution).size(),
            None if self.near().count() > 2 => self.sizes(of).first().copied().unwrap_or(of.scale()),
            None => 0.0,
        };
        let floor = SOLVER_FLOOR * self.last.impact.settings.tolerance * of.scale();
        floor + (SOLVER_CHANGE * change).max(self.unseen(of, |unseen| &unseen.solver))
    }

    /// Possible error of the restitution.
    fn error(&self) -> f64 {
        self.solver(&self.restitution) + self.left_out(&self.restitution)
    }

    fn counts(&self) -> String {
        let mut counts: Vec<usize> = self.all().map(|rung| rung.count).collect();
        counts.sort_unstable();
        counts.dedup();
        counts.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
    }

    /// Difference of the largest and smallest of the last values of a quantity, and their number.
    fn spread(&self, of: &Quantity) -> Option<(f64, usize)> {
        let values: Vec<f64> = self.near().take(SPREAD).filter_map(|rung| of.value(&rung.solution)).collect();
        let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), e| (l.min(*e), h.max(*e)));
        (values.len() > 1).then_some((high - low, values.len()))
    }
}

/// Raises the number of modes until the restitution has converged, or there are no more.
pub(super) fn settle(pose: &mut Pose, cost: &mut Cost) -> Result<Choice, InvalidInput> {
    let (most, tolerance) = (pose.source.most(), pose.tolerance);
    let expected = guess(pose, cost)?;
    let listed = matches!(pose.source, Source::Listed { .. });
    let is_plate = matches!(pose.scene.structure, scene::Structure::Plate(_));
    let complete = (listed && pose.is_complete()).then_some(most);
    let mut tightened = 0;
    let (first, mut before) = Rung::with_the_one_before(pose, expected, settings(tolerance, tightened), cost)?;
    let restitution = Quantity::restitution(&first.impact);
    let jumps = jumps(&pose.law);
    let mut rungs = Rungs { last: first, earlier: Vec::new(), restitution, jumps, complete, too_many: None };
    loop {
        let count = rungs.last.count;
        if rungs.last.takes_too_many_steps() && (count > 1 || !rungs.earlier.is_empty()) {
            rungs.too_many = Some(count);
            rungs.last = match rungs.earlier.pop() {
                Some(before) => before,
                None => Rung::new(pose, fewer(fewer(count)).max(1), settings(tolerance, tightened), cost)?,
            };
            continue;
        }
        let several_contacts = rungs.last.has_several_contacts();
        let ends = LEAST_RAISE * count as f64 > most as f64 || rungs.too_many.is_some();
        // the energy of one impact shows that its modes are too few; otherwise a change has to
        let may_settle = rungs.last.energy <= tolerance && rungs.last.solution.restitution.is_some();
        if (may_settle || ends) && rungs.near().count() < 2 && !rungs.is_complete() {
            let before = match before.take().filter(|before| before.count == fewer(count)) {
                Some(solved) => {
                    cost.add(&solved.solution.counts, solved.impact.structure.modes.len());
                    solved
                }
                None => Rung::new(pose, fewer(count), settings(tolerance, tightened), cost)?,
            };
            rungs.add_earlier(before);
        }
        if (is_plate || jumps) && rungs.near().count() == 2 && rungs.error() <= tolerance && !several_contacts {
            // the smallest of three
            let before = rungs.earlier.len() - 1;
            let third = Rung::new(pose, fewer(rungs.earlier[before].count), settings(tolerance, tightened), cost)?;
            rungs.earlier.insert(before, Rung { recording: None, ..third });
        }
        if rungs.error() <= tolerance && rungs.last.unseen.is_none() {
            rungs.last.find_unseen(pose, several_contacts && rungs.share_tightest_tolerance(), cost)?;
        }
        let (solver, left_out) = (rungs.solver(&rungs.restitution), rungs.left_out(&rungs.restitution));
        let both_end = rungs.near().take(2).all(|rung| rung.solution.restitution.is_some());
        // after several contacts, two impacts may agree although both miss the same contact: a third one is required
        let several = several_contacts && rungs.near().count() < 3;
        let settled = solver + left_out <= tolerance && both_end && !several && !rungs.earlier.is_empty();
        let limit = matches!(rungs.last.solution.outcome, Outcome::Stopped(_));
        if settled || limit {
            return finish(pose, rungs, settled, cost);
        }
        let tighter = rungs.last.impact.settings.tolerance > SOLVER_RANGE.0;
        let next = if count >= PATIENCE && several_contacts && !rungs.falls() {
            return finish(pose, rungs, false, cost);
        } else if !ends {
            let raised = more(count);
            tightened += usize::from(several_contacts);
            if LEAST_RAISE * raised as f64 > most as f64 { most } else { raised }
        } else if listed
            && tighter
            && rungs.too_many.is_none()
            && (several || !both_end || 4.0 * solver > left_out.min(tolerance))
        {
            // the list is at its end, and the solver's error may be part of the change
            tightened += 1;
            if !rungs.is_complete() {
                rungs.push(Rung::new(pose, fewer(most), settings(tolerance, tightened), cost)?);
            }
            most
        } else {
            return finish(pose, rungs, false, cost);
        };
        rungs.push(Rung::new(pose, next, settings(tolerance, tightened), cost)?);
    }
}

fn finish(pose: &mut Pose, mut rungs: Rungs, settled: bool, cost: &mut Cost) -> Result<Choice, InvalidInput> {
    if rungs.last.unseen.is_none() && rungs.last.solution.restitution.is_some() {
        rungs.last.find_unseen(pose, false, cost)?;
    }
    let exhausted = matches!(pose.source, Source::Listed { .. }) && rungs.last.count == pose.source.most();
    let growing = match &pose.source {
        Source::Listed { modes, .. } => still_growing(modes),
        Source::Beam { .. } | Source::Computed { .. } => 1.0,
    };
    let spread = rungs.spread(&rungs.restitution).filter(|_| !settled);
    let reason = reason(pose, &rungs, settled, exhausted, spread);
    let spread = spread.map(|(spread, _)| spread);
    let left_out = |of: &Quantity| match rungs.spread(of).filter(|_| !settled) {
        _ if rungs.is_complete() => 0.0,
        Some((spread, _)) if exhausted => growing * rungs.left_out_at_the_end(of).max(spread),
        Some((spread, _)) => rungs.left_out(of).max(rungs.left_out_at_the_end(of)).max(spread),
        None => rungs.left_out(of),
    };
    let (solver, converged) = (rungs.solver(&rungs.restitution), left_out(&rungs.restitution));
    let stated = if settled { converged.max((LUCK * converged).min(pose.tolerance - solver)) } else { converged };
    let peaks = of_peaks(&rungs.last.solution.sub_impacts, |_, of| Uncertainty {
        solver: Some(rungs.solver(of)),
        modes_left_out: Some(if settled { LUCK * left_out(of) } else { left_out(of) }),
        beam_theory: None,
    });
    let Rung { impact, solution, recording, .. } = rungs.last;
    pose.kept.keep(&impact.structure, recording);
    let known = Known::new(pose.scene, Ok(solver.min(1.0)), Ok(stated.min(1.0)));
    Ok(Choice::modal(pose.tolerance, impact, solution, Conclusion { known, peaks, settled, spread, reason }))
}

/// The numbers of modes that were tried, and the result, in words.
fn reason(pose: &Pose, rungs: &Rungs, settled: bool, exhausted: bool, spread: Option<(f64, usize)>) -> String {
    let counts = rungs.counts();
    let reached = rungs.last.count;
    let (wanted, damping) = (small(pose.tolerance), lightly_damped(pose));
    let changed = match rungs.changes(&rungs.restitution).next() {
        _ if rungs.is_complete() => "they make up the whole static compliance".to_owned(),
        Some((change, [from, to])) => format!(
            "from {from} to {to} modes the restitution changes by {}, and the relative speed of a flight between contacts by at \
             most {} of the speed of impact",
            small(change.itself),
            small(change.motion)
        ),
        None => "the effect of further modes is not known".to_owned(),
    };
    let changed = match rungs.too_many {
        Some(count) => format!("{changed}; with {count} modes the impact takes more steps than are allowed"),
        None => changed,
    };
    match spread {
        _ if settled => format!("modal: the restitution has converged with {counts} modes; {changed}"),
        Some(_) if exhausted => format!(
            "modal: the list of {reached} modes ends before the restitution converges within {wanted}{damping}; {changed}"
        ),
        Some((spread, size)) => format!(
            "modal: the restitution does not converge within {wanted} with {counts} modes{damping}; {changed}; its spread \
             over the last {size} numbers of modes is {}",
            small(spread)
        ),
        None => format!("modal: the computation reached its limit of steps with {counts} modes"),
    }
}

fn lightly_damped(pose: &Pose) -> &'static str {
    let modes = match &pose.source {
        Source::Beam { modes, .. } | Source::Computed { modes, .. } | Source::Listed { modes, .. } => modes,
    };
    match modes.iter().map(|mode| mode.damping_ratio).fold(0.0, f64::max) {
        0.0 => " (nothing damps the structure)",
        damping if damping < 0.01 => " (the structure is lightly damped)",
        _ => "",
    }
}

/// The uncertainty of an answer, and the choice of its modes.
pub(super) struct Conclusion {
    pub known: Known,
    /// Of the largest force of each contact.
    pub peaks: Vec<Uncertainty>,
    pub settled: bool,
    pub spread: Option<f64>,
    pub reason: String,
}

impl Choice {
    pub(super) fn modal(tolerance: f64, impact: Impact, solution: Solution, conclusion: Conclusion) -> Choice {
        let Conclusion { known, peaks, settled, spread, reason } = conclusion;
        let answer = Answer {
            outcome: solution.outcome.as_str(),
            stopped_by: solution.outcome.stopped_by(),
            restitution: solution.restitution,
            sub_impact_count: Some(solution.sub_impacts.len()),
            modes: impact.kept_modes(),
            remainder_modes: impact.remainder_modes,
            residual_compliance_m_n: impact.residual_compliance_m_n(),
            settled,
            spread,
            ..Answer::new(Model::Modal, tolerance, known.of(solution.restitution), reason)
        };
        Choice { answer, impact: Some(impact), sub_impacts: solution.sub_impacts, peak_forces: peaks }
    }
}
