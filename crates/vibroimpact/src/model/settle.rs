//! Convergence in the number of modes.
//!
//! The number of modes begins at a guess (`guess.rs`). One impact is enough to show that its modes are too few: its remainder
//! modes then have too much energy (`left_out.rs`), and the number is raised by a factor of about 1.4. If their energy is small,
//! the same impact with fewer modes, or the one solved before, shows the effect of the last modes.
//!
//! Restitutions may agree by accident while the histories of two impacts do not, and then differ again at the next number. The
//! striker's speed in every flight between two contacts is therefore compared as well (`quantity.rs`), and after more than one contact a
//! third number of modes is required. So it is for plates, most of whose modes hardly move a given location: the modes between two
//! numbers may be such modes. And so it is where the force jumps at first touch: changes then decrease slowly, and vary by accident
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
use vibroimpact_sim::modal::Outcome;

use super::Cost;
use super::choice::{Choice, Conclusion};
use super::guess::{fewer, guess, more};
use super::left_out::{jumps, still_growing};
use super::pose::{Pose, Source};
use super::quantity::Quantity;
use super::rung::{Rung, settings};
use super::rungs::Rungs;
use super::uncertainty::{Known, Uncertainty, of_peaks};
use crate::scene;
use crate::text::small;

/// The largest number of modes counts if it is this many times the one before; the change by a smaller step contains little
/// information about the rest.
const LEAST_RAISE: f64 = 1.25;
/// Beyond this many modes the number is raised after several contacts only while changes decrease. A single contact amplifies nothing,
/// so that more modes help.
const PATIENCE: usize = 400;
/// Two impacts may agree by accident, and small changes may add up. The stated uncertainty from the truncated modes is
/// therefore this factor times the estimate by which the restitution has converged, as far as the tolerance allows. Random
/// scenes show that converged results are within their tolerance (`cargo xtask study-auto`).
pub(super) const LUCK: f64 = 4.0;

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
            rungs.forget_motion();
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
                None => Rung::beside(pose, fewer(count), settings(tolerance, tightened), cost)?,
            };
            rungs.earlier.push(before);
        }
        if (is_plate || jumps) && rungs.near().count() == 2 && rungs.error() <= tolerance && !several_contacts {
            // the smallest of three
            let before = rungs.earlier.len() - 1;
            let third = Rung::beside(pose, fewer(rungs.earlier[before].count), settings(tolerance, tightened), cost)?;
            rungs.earlier.insert(before, third);
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
        let tighter = !rungs.last.has_tightest_tolerance();
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
                rungs.push(Rung::beside(pose, fewer(most), settings(tolerance, tightened), cost)?);
            }
            most
        } else {
            return finish(pose, rungs, false, cost);
        };
        rungs.forget_motion();
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
             most {} of the speed of impact (short flights count less)",
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
