//! Branches of periodic motions over one parameter.
//!
//! A branch is a curve in the space of the state `x` and a parameter `p`, each scaled by its size. It is followed by
//! pseudo-arclength, also round folds: a step along the tangent is followed by Newton's method for `P(x, p) = x` and for the
//! length of the step. The Floquet multipliers along the branch show where stability is lost or gained, and how:
//!
//! | point | what changes |
//! |---|---|
//! | fold | the parameter turns: a multiplier at +1 |
//! | pitchfork | a symmetric motion loses its symmetry, or another branch crosses: a multiplier at +1, and the parameter does not turn |
//! | period doubling | a multiplier at -1 |
//! | Neimark-Sacker | a pair of complex multipliers at size 1 |
//! | grazing | an interval of contact appears or disappears: the surfaces touch with zero speed |
//!
//! Each special point is located by bisection between the orbits on either side, except for pitchforks, near which Newton's method for an
//! orbit fails (`crossing.rs`). For a fold the direction of the branch decides, which follows from the linearised map at an orbit.
//!
//! At a period doubling a branch of twice the period begins, and at a pitchfork one of the same period, both in the direction of the
//! multiplier's eigenvector ([`follow_beginning`]). It ends where it comes back to the first branch, there or at another such point of
//! it, or at the end of the range. Its other half contains the same motions half a period later, or their mirror images.

mod crossing;
mod follower;
mod locate;
mod parent;
mod settings;
mod special;

use super::orbit::{OrbitOutcome, refine};
use super::orbit_settings::OrbitSettings;
use super::problem::Assembly;
use super::search::find_orbit_until;
use contact_models::ContactLaw;
use follower::{Follower, Origin, Step};
use invalid_input::InvalidInput;
use nalgebra::DVector;
pub use settings::BranchSettings;
use special::differences;
pub use special::{Branch, BranchPoint, Special, SpecialPoint};

/// After a step with fewer iterations than this the next step is longer.
const QUICK: u32 = 4;
/// First step on a branch that begins at another one, as a part of the first step of the others.
const FIRST_FROM_PARENT: f64 = 0.125;
/// Largest distance of its first orbit from the start, in steps: within 45 degrees of the eigenvector.
const MOST_ASIDE: f64 = std::f64::consts::SQRT_2;
/// A step leads from a branch of twice the period onto its parent if its distance from it falls below this part of the one before.
const JOINED: f64 = 1e-3;

/// Follows the branch of periodic motions of `build(parameter)`. `stop` is called from time to time, and ends the branch
/// with the orbits so far.
///
/// # Errors
/// If settings are out of range or the input is invalid, and the errors of `build`.
pub fn follow_branch<L: ContactLaw + Clone, E: From<InvalidInput>>(
    build: impl Fn(f64) -> Result<Assembly<L>, E>,
    settings: &BranchSettings,
    stop: &dyn Fn() -> bool,
) -> Result<Branch, E> {
    settings.check()?;
    let first = match find_orbit_until(&build(settings.from)?, &settings.orbit, stop)? {
        OrbitOutcome::Found(first) => first,
        OrbitOutcome::Remembers { contact } => return Ok(Branch { remembers: Some(contact), ..Branch::default() }),
        _ => return Ok(Branch { interrupted: stop(), ..Branch::default() }),
    };
    let mut follower = Follower::new(build, settings, &first, stop);
    let start = BranchPoint { parameter: settings.from, orbit: *first };
    let tangent = follower.rising_tangent(&start)?;
    follower.follow(start, tangent)
}

/// Follows the branch that begins at a period doubling or a pitchfork of another one, `parent.special[special]`, otherwise as
/// [`follow_branch`].
///
/// # Errors
/// As [`follow_branch`], and if no branch begins at a point of that kind.
pub fn follow_beginning<L: ContactLaw + Clone, E: From<InvalidInput>>(
    build: impl Fn(f64) -> Result<Assembly<L>, E>,
    settings: &BranchSettings,
    parent: &Branch,
    special: usize,
    stop: &dyn Fn() -> bool,
) -> Result<Branch, E> {
    let allowed = "the index of a period doubling or a pitchfork among the special points of the parent";
    let begins = |point: &&SpecialPoint| point.kind.begins_a_branch();
    let Some(beginning) = parent.special.get(special).filter(begins) else {
        return Err(InvalidInput::new("special", special, allowed).into());
    };
    let of_parent = beginning.orbit.forcing_periods;
    let doubles = beginning.kind == Special::PeriodDoubling;
    let forcing_periods = if doubles { of_parent.saturating_mul(2) } else { of_parent };
    let settings = BranchSettings { orbit: OrbitSettings { forcing_periods, ..settings.orbit }, ..*settings };
    settings.check()?;
    let mut follower = Follower::new(build, &settings, &beginning.orbit, stop);
    follower.origin = Some(Origin { parent: &parent.special, kind: beginning.kind, of_parent });
    let state = DVector::from_column_slice(&beginning.orbit.state);
    let Some(tangent) = follower.eigenvector(&state, beginning.parameter)? else {
        return Ok(Branch { interrupted: stop(), ..Branch::default() });
    };
    let OrbitOutcome::Found(orbit) = refine(&follower.map(beginning.parameter)?, state, &settings.orbit)? else {
        return Ok(Branch { interrupted: stop(), ..Branch::default() });
    };
    follower.follow(BranchPoint { parameter: beginning.parameter, orbit: *orbit }, Some(tangent))
}

impl<L, E, F> Follower<'_, F>
where
    L: ContactLaw + Clone,
    E: From<InvalidInput>,
    F: Fn(f64) -> Result<Assembly<L>, E>,
{
    /// Follows the branch from an orbit along a tangent.
    fn follow(&mut self, start: BranchPoint, tangent: Option<DVector<f64>>) -> Result<Branch, E> {
        let settings = self.settings;
        let mut current = start.clone();
        let mut branch = Branch { points: vec![start], ..Branch::default() };
        let Some(mut tangent) = tangent else { return Ok(branch) };
        // the state changes fastest where a branch begins at another one
        let mut step = if self.origin.is_some() { FIRST_FROM_PARENT * settings.step } else { settings.step };
        let mut asymmetry: Option<DVector<f64>> = None;
        // there the linearised map gives the direction of the other one
        let mut rises = if self.origin.is_some() { None } else { Some(self.rises(&current, &tangent)?) };
        let mut turned = false;
        while branch.points.len() < settings.max_orbits {
            let found = self.step(&current, &tangent, step)?;
            let found = match found {
                Step::Found(next, iterations) => self.asymmetry(&next)?.map(|moved| (next, iterations, moved)),
                Step::Remembers(contact) if self.remembering.insert(contact) || !turned => {
                    turned = true;
                    if self.turn(&mut current, &mut tangent)? && asymmetry.is_some() {
                        asymmetry = self.asymmetry(&current)?;
                    }
                    continue;
                }
                Step::Remembers(_) | Step::None => None,
            };
            // through the parent, to the same orbits half a period later or to their mirror images
            let joins = |moved: &DVector<f64>| {
                asymmetry.as_ref().is_some_and(|before| before.dot(moved) < JOINED * before.norm_squared())
            };
            if let Some((next, _, moved)) = &found
                && (joins(moved) || rises.is_some() && self.begins_at_pitchfork())
                && let Some(special) = self.passed(&current, next)?
            {
                (branch.complete, branch.returns_to) = (true, Some(special));
                break;
            }
            // otherwise it does not come near its parent, and it begins along the eigenvector
            let found = found.filter(|(next, _, moved)| {
                let along = || self.chord(&current, next).is_ok_and(|chord| chord.norm() < MOST_ASIDE * step);
                !joins(moved) && (rises.is_some() || along())
            });
            if (self.stop)() {
                branch.interrupted = true;
                break;
            }
            let Some((next, iterations, moved)) = found else {
                step *= 0.5;
                if step < 1e-5 * settings.step {
                    return Ok(branch);
                }
                continue;
            };
            asymmetry = Some(moved);
            let next = self.within_range(&current, next)?;
            let new_tangent = self.between(&current, &next, &tangent);
            let rises_next = self.rises(&next, &new_tangent)?;
            let rises_here = rises.unwrap_or(new_tangent[new_tangent.len() - 1] > 0.0);
            let mut kinds = differences(&current.orbit, &next.orbit);
            let turns = rises_here != rises_next;
            // a branch that begins at another one does so with a multiplier at +1
            if turns || rises.is_none() {
                kinds.retain(|kind| *kind != Special::Pitchfork);
            }
            if turns {
                kinds.push(Special::Fold);
            }
            let mut special = Vec::new();
            for kind in kinds {
                let before_orbit = branch.points.len();
                special.extend(match kind {
                    Special::Pitchfork => self.locate_pitchfork((&current, &next), before_orbit)?,
                    _ => Some(self.locate((&current, rises_here), (&tangent, step), kind, before_orbit)?),
                });
            }
            if (self.stop)() {
                branch.interrupted = true;
                break;
            }
            let distance = |point: &SpecialPoint| (point.parameter - current.parameter).abs();
            special.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
            branch.special.append(&mut special);
            (current, tangent, rises, turned) = (next, new_tangent, Some(rises_next), false);
            branch.points.push(current.clone());
            let (low, high) = settings.limits();
            if !(low < current.parameter && current.parameter < high) {
                branch.complete = true;
                break;
            }
            if iterations < QUICK {
                step = (1.5 * step).min(settings.longest_step);
            }
        }
        Ok(branch)
    }
}
