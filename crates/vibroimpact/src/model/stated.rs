//! Stated modes, and the effect of the truncated ones.
//!
//! The impact is solved with the stated modes, and the solver estimates its error. The effect of the truncated modes is estimated
//! separately, from the same impact with more modes and remainder modes for all others, for two numbers of modes,
//!
//! ```text
//! u = |e - e_M| + max( 3 |e_M - e_(M/1.4)|, |e - e_M|/4 ) + d_c,
//! ```
//!
//! If the stated modes have remainder modes for the others, they are often as many as `M`, and nothing but the change from `M/1.4` is
//! left, which may be small by accident. It then counts four times, as where the program chooses the number of modes, and the
//! energy of the remainder modes, which detects most accidents, sets a lower bound (`left_out.rs`):
//!
//! ```text
//! u = |e - e_M| + max( 12 |e_M - e_(M/1.4)|, e_r, |e - e_M|/4 ) + d_c,
//! ```
//!
//! where `d_c` is the change if the static compliance is larger by its uncertainty, and `M` is the number that a loose tolerance is
//! expected to need, but not so large that this would cost more than the impact. For a structure that moves before the impact, as a
//! dropped rod does, that number is not known, and `M` is as large as the cost admits: the motion may need all stated modes, so that
//! `M/1.4` is at least their number, and a small change from so few further modes may be an accident. Of the further modes of a dropped
//! rod one half are bending modes and the other axial ones, because either kind alone may have hardly any part in the motion, and no
//! modes at all may be stated of it.
//!
//! The second formula holds for the largest forces of contacts, which converge more slowly, with any stated modes; `e_r` is then a share of
//! the largest force of the impact.
//!
//! It holds for any stated modes if the force jumps at first touch. Changes then decrease as slowly as `1/N`, and
//! nearly vanish for some numbers of modes (`left_out.rs`), so that a third number, `M/2`, is compared as well, and `|e_(M/1.4) -
//! e_(M/2)|` is another lower bound of the maximum. (If the structure moves before the impact, there is no third number.)
//!
//! More modes take more and shorter steps, or have further contacts, so that the impact with more modes may stop where the stated one
//! does not. `M` is then the number of the stated modes; if that stops as well, nothing is known about the truncated modes.
//!
//! Where the truncated modes respond as a spring, fewer modes show their effect (`static_tail.rs`).

use vibroimpact_sim::modal::{Settings, Solution};
use vibroimpact_sim::{StopReason, both};

use super::choice::{Choice, Conclusion};
use super::guess::fewer;
use super::left_out::{by_changes, energy_of_remainder, jumps, with_softer_remainder};
use super::other_modes::{moves_before, needed, solve, with_modes};
use super::quantity::Quantity;
use super::settle::LUCK;
use super::static_tail::StaticTail;
use super::uncertainty::{Known, Uncertainty, of_peaks};
use super::{Cost, DEFAULT_TOLERANCE, Kept, Modes};
use crate::impact::Impact;
use crate::scene::{InvalidInput, Scene, Structure, chooses_modes};
use crate::text::counted;

/// The comparison begins with the expected number of modes for this tolerance.
const LOOSE: f64 = 3e-3;
/// Least share of the change from the stated modes that counts as well: two richer impacts may agree by accident.
const LEAST_SHARE: f64 = 0.25;
/// The solver's tolerance in the comparison, and the factor of the number of modes at which it costs as much as the impact itself,
/// which is solved three times and far more accurately.
const SOLVER: f64 = 1e-6;
const RICHER: usize = 2;
/// Number of stated modes of a dropped rod below which the comparison costs as little as with this number.
const FEW: usize = 8;

/// The modes as they are stated, or all that a list has.
pub(super) fn stated(scene: &Scene, kept: &mut Kept, cost: &mut Cost) -> Result<Choice, InvalidInput> {
    let chosen = chooses_modes(scene);
    // without an approach the number of modes does not matter
    let impact = scene.impact_of(if chosen { Some(0) } else { scene.modes.count() }, kept)?;
    let (solution, beside) = if kept.is_alone() {
        let compare = || {
            let mut cost = Cost::default();
            (compare(scene, &mut Kept::default(), &impact, &mut cost), cost)
        };
        let (beside, solved) = both(true, compare, || impact.keep_with(kept));
        let (solution, recording) = solved?;
        kept.keep(&impact.structure, recording);
        (solution, Some(beside))
    } else {
        (impact.solve_with(kept)?, None)
    };
    cost.add(&solution.counts, impact.structure.modes.len());
    let modes = counted(impact.kept_modes() as u64, "mode", "modes");
    let reason = match scene.modes {
        Modes::Count(_) => format!("modal: the {modes} stated"),
        Modes::Auto if chosen => "modal: the striker does not approach".to_owned(),
        Modes::Auto if impact.remainder_modes > 0 => {
            format!("modal: the {modes} listed, and {} for the others", impact.remainder_modes)
        }
        Modes::Auto => format!("modal: the {modes} listed"),
    };
    let tolerance = impact.settings.tolerance;
    let solver = solution.restitution_uncertainty;
    let mut peaks = of_peaks(&solution.sub_impacts, |_, _| Uncertainty::default());
    let known = if solution.restitution.is_some() {
        let compared = match beside {
            Some((compared, added)) => {
                *cost += added;
                compared?
            }
            None => compare(scene, kept, &impact, cost)?,
        };
        let restitution = Quantity::restitution(&impact);
        let compared = match compared {
            Comparison::Fewer(tail, counts) if !tail.left_out(&restitution, &solution).1 => {
                Comparison::More(compare_with_more(scene, kept, &impact, counts, cost)?)
            }
            compared => compared,
        };
        let left_out = |of: &Quantity| match &compared {
            Comparison::Fewer(tail, _) => Ok(tail.left_out(of, &solution).0),
            Comparison::More(Ok(more)) => Ok(more.left_out(of, &impact, &solution)),
            Comparison::More(Err(why)) => Err(why.clone()),
        };
        peaks = of_peaks(&solution.sub_impacts, |i, of| Uncertainty {
            solver: solution.sub_impacts[i].peak_force_uncertainty_n,
            modes_left_out: left_out(of).ok(),
            beam_theory: None,
        });
        let solver = solver.ok_or("the same impact with a coarser tolerance stopped before it ended");
        Known::new(scene, solver, left_out(&restitution).map(|left_out| left_out.min(1.0)))
    } else {
        Known::default()
    };
    let wanted = scene.tolerance.map_or(DEFAULT_TOLERANCE, |tolerance| 10.0 * tolerance);
    let settled = solver.is_some_and(|u| u <= wanted);
    let conclusion = Conclusion { known, peaks, settled, spread: solver.filter(|_| !settled), reason };
    Ok(Choice::modal(tolerance, impact, solution, conclusion))
}

/// The same impact with other modes.
struct Compared {
    richer: Other,
    /// How many modes that is.
    count: usize,
    /// With fewer modes than that, and again fewer if the force jumps at first touch; empty if the structure has no more.
    fewer: Vec<(usize, Other)>,
    /// As the richer one, with the compliance larger by its uncertainty.
    softer: Option<Solution>,
}

/// The impact with another number of modes, or the impact itself.
enum Other {
    Itself,
    /// With the possible error of its remainder modes, from their energy.
    Solved(Box<Solution>, f64),
}

impl Other {
    fn or<'a>(&'a self, itself: &'a Solution) -> &'a Solution {
        match self {
            Other::Itself => itself,
            Other::Solved(other, _) => other,
        }
    }

    /// Why it stopped before its end, if it did; the impact itself has not.
    fn stopped_by(&self) -> Option<StopReason> {
        match self {
            Other::Itself => None,
            Other::Solved(other, _) => other.outcome.stopped_by(),
        }
    }
}

impl Compared {
    /// Effect of the truncated modes on a quantity of the solution of the impact.
    fn left_out(&self, of: &Quantity, impact: &Impact, solution: &Solution) -> f64 {
        let change = |other: &Solution| of.change(other, self.richer.or(solution));
        let stated = change(solution).itself;
        let energy = match &self.richer {
            Other::Itself => energy_of_remainder(impact, solution),
            Other::Solved(_, energy) => *energy,
        };
        let mut from = (self.count, &self.richer);
        let mut changes = Vec::new();
        for (count, fewer) in &self.fewer {
            let changed = of.change(fewer.or(solution), from.1.or(solution));
            changes.push((changed.size(), from.0));
            from = (*count, fewer);
        }
        let further = changes.get(..1).map_or(0.0, |latest| {
            let jumps = jumps(&impact.law);
            let accident = (LUCK * by_changes(latest, false, of.scale())).max(of.scale() * energy);
            let may_agree = impact.remainder_modes > 0 || jumps || of.is_of_an_instant();
            let accident = if may_agree { accident } else { 0.0 };
            by_changes(&changes, jumps, of.scale()).max(accident).max(LEAST_SHARE * stated)
        });
        let softer = self.softer.as_ref().map_or(0.0, |softer| change(softer).size());
        stated + further + softer
    }
}

/// Other impacts that show the effect of the truncated modes.
enum Comparison {
    /// With fewer modes, if the truncated ones respond as a spring; and the numbers of modes of the comparison with more.
    Fewer(StaticTail, [usize; 3]),
    /// With more modes, or why that is not known.
    More(Result<Compared, String>),
}

/// Solves the impact with other modes.
fn compare(scene: &Scene, kept: &mut Kept, impact: &Impact, cost: &mut Cost) -> Result<Comparison, InvalidInput> {
    let (count, most) = match &scene.structure {
        Structure::Beam(_) => (impact.kept_modes(), usize::MAX),
        computed if computed.is_computed() => {
            let count = impact.kept_modes();
            (count, computed.most_modes().max(count))
        }
        Structure::DroppedRod(rod) => (rod.bending_modes + rod.axial_modes, usize::MAX),
        Structure::Modal(listed) if listed.gives_compliance(scene.location.as_deref()) => {
            (impact.kept_modes(), listed.omega_rad_s.len())
        }
        _ => {
            let why = "the static compliance of the structure is not stated";
            return Ok(Comparison::More(Err(why.to_owned())));
        }
    };
    let fewest = if matches!(scene.structure, Structure::DroppedRod(_)) { FEW } else { 1 };
    let affordable = RICHER * count.max(fewest);
    let needed = if moves_before(scene) { affordable } else { needed(scene, LOOSE, kept, cost)?.unwrap_or(count) };
    let counts = [count, needed.clamp(count, affordable).min(most), most];
    Ok(match StaticTail::of(scene, impact, needed, kept, cost)? {
        Some(tail) => Comparison::Fewer(tail, counts),
        None => Comparison::More(compare_with_more(scene, kept, impact, counts, cost)?),
    })
}

/// Solves the impact with `more` modes in place of the stated `count`, of the `most` that there are; the inner `Err` states why the
/// effect of the truncated modes is not known.
fn compare_with_more(
    scene: &Scene,
    kept: &mut Kept,
    impact: &Impact,
    [count, more, most]: [usize; 3],
    cost: &mut Cost,
) -> Result<Result<Compared, String>, InvalidInput> {
    match compare_with(scene, kept, impact, [count, more, most], cost)? {
        // with a motion before the impact, a comparison with as many modes shows nothing
        Err(_) if more > count && !moves_before(scene) => compare_with(scene, kept, impact, [count, count, most], cost),
        compared => Ok(compared),
    }
}

/// As [`compare_with_more`], with no other number of modes if that stops.
fn compare_with(
    scene: &Scene,
    kept: &mut Kept,
    impact: &Impact,
    [count, more, most]: [usize; 3],
    cost: &mut Cost,
) -> Result<Result<Compared, String>, InvalidInput> {
    // the motion before the impact may need all stated modes
    let second = if moves_before(scene) && count < most { fewer(more).max(count) } else { fewer(more) };
    let third = (!moves_before(scene) && jumps(&impact.law)).then(|| fewer(second));
    let whole = scene.residual_compliance == Some(true) || matches!(scene.structure, Structure::DroppedRod(_));
    let settings = Settings { tolerance: SOLVER, estimate_uncertainty: false, ..impact.settings };
    let complete = |of: &Impact| of.remainder_modes == 0;
    let mut with = |modes: usize| -> Result<(Other, bool), InvalidInput> {
        if whole && modes == count {
            return Ok((Other::Itself, complete(impact)));
        }
        let other = Impact { settings, ..with_modes(scene, count, modes, kept)? };
        let solution = solve(&other, kept, cost)?;
        let energy = energy_of_remainder(&other, &solution);
        Ok((Other::Solved(Box::new(solution), energy), complete(&other)))
    };
    let (richer, nothing_left) = with(more)?;
    if let Some(reason) = richer.stopped_by() {
        return Ok(Err(not_compared(more, reason)));
    }
    if nothing_left {
        return Ok(Ok(Compared { richer, count: more, fewer: Vec::new(), softer: None }));
    }
    let mut others = Vec::new();
    for fewer in [second].into_iter().chain(third) {
        let Ok((other, _)) = with(fewer) else {
            return Ok(Err("the motion before the impact needs every mode that there is".to_owned()));
        };
        if let Some(reason) = other.stopped_by() {
            return Ok(Err(not_compared(fewer, reason)));
        }
        others.push((fewer, other));
    }
    let uncertain_m_n = match &scene.structure {
        Structure::Plate(_) => scene.structure.static_compliance_with_uncertainty_m_n(scene.place())?.1,
        _ => 0.0,
    };
    let softer = if uncertain_m_n > 0.0 {
        let other = with_modes(scene, count, more, kept)?;
        let structure = with_softer_remainder(&other.structure, other.remainder_modes, uncertain_m_n);
        let solution = solve(&Impact { structure, settings, ..other }, kept, cost)?;
        if let Some(reason) = solution.outcome.stopped_by() {
            return Ok(Err(not_compared(more, reason)));
        }
        Some(solution)
    } else {
        None
    };
    Ok(Ok(Compared { richer, count: more, fewer: others, softer }))
}

/// Why the effect of the truncated modes is not known if the impact with this many modes stops.
fn not_compared(modes: usize, reason: StopReason) -> String {
    let (modes, reason) = (counted(modes as u64, "mode", "modes"), reason.as_str());
    format!("the impact with {modes}, and remainder modes for the others, stopped before it ended ({reason})")
}
