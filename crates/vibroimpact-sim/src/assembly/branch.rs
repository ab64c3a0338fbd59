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
//! Each special point is located by bisection between the orbits on either side. For a fold the direction of the branch decides, which
//! follows from the linearised map at an orbit.
//!
//! At a period doubling a branch of twice the period begins, and at a pitchfork one of the same period, both in the direction of the
//! multiplier's eigenvector ([`follow_beginning`]). It ends where it comes back to the first branch, there or at another such point of
//! it, or at the end of the range. Its other half contains the same motions half a period later, or their mirror images.

use super::branch_point::{branch_point, null_vectors};
use super::orbit::{Orbit, OrbitOutcome, refine};
use super::orbit_settings::OrbitSettings;
use super::period_map::PeriodMap;
use super::problem::Assembly;
use super::search::find_orbit_until;
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeSet;

/// Change of the parameter for finite differences, relative to its range.
const DIFFERENCE: f64 = 1e-6;
/// Newton iterations of a step along the branch.
const ITERATIONS_MAX: u32 = 8;
/// After a step with fewer iterations than this the next step is longer.
const QUICK: u32 = 4;
/// Number of bisections that locate a special point.
const HALVINGS: u32 = 20;
/// They end where the parameters on both sides differ by less than this part of its range, or, at a fold, where the sides are as near
/// as this part of the step.
const NEAR: f64 = 1e-8;
const NEAR_FOLD: f64 = 1e-4;
/// First step on a branch that begins at another one, as a part of the first step of the others.
const FIRST_FROM_PARENT: f64 = 0.125;
/// Largest distance of its first orbit from the start, in steps: within 45 degrees of the eigenvector.
const MOST_ASIDE: f64 = std::f64::consts::SQRT_2;
/// A branch of twice the period has come back to its parent if its distance from it falls below this part of that of the orbit before.
const JOINED: f64 = 1e-3;
/// Largest distance of a pitchfork from a chord that passes it, as a part of the chord.
const NEAR_PITCHFORK: f64 = 0.5;

/// Settings for following a branch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BranchSettings {
    /// Settings for each periodic motion.
    pub orbit: OrbitSettings,
    /// Value of the parameter at which the branch starts.
    pub from: f64,
    /// Value towards which the branch is followed; it ends there.
    pub to: f64,
    /// First step, as a fraction of the range. Default 0.02.
    pub step: f64,
    /// Longest step, as a fraction of the range. Default 0.05.
    pub longest_step: f64,
    /// Largest number of orbits. Default 500.
    pub max_orbits: usize,
}

impl BranchSettings {
    /// The defaults, for this range.
    pub fn over(from: f64, to: f64) -> BranchSettings {
        let orbit = OrbitSettings::default();
        BranchSettings { orbit, from, to, step: 0.02, longest_step: 0.05, max_orbits: 500 }
    }

    /// The range in ascending order.
    fn limits(&self) -> (f64, f64) {
        (self.from.min(self.to), self.from.max(self.to))
    }

    fn check(&self) -> Result<(), InvalidInput> {
        self.orbit.check()?;
        let range = self.from.is_finite() && self.to.is_finite() && self.from != self.to;
        InvalidInput::unless(range, "to", self.to, "a finite number other than the start of the branch")?;
        let step = self.step > 0.0 && self.step <= 0.5;
        InvalidInput::unless(
            step,
            "step",
            self.step,
            "a fraction of the range, greater than 0 and not greater than 0.5",
        )?;
        let longest = self.longest_step >= self.step && self.longest_step <= 0.5;
        InvalidInput::unless(longest, "longest_step", self.longest_step, "a fraction of the range from step to 0.5")?;
        InvalidInput::unless(self.max_orbits > 0, "max_orbits", self.max_orbits, "at least 1")
    }
}

/// Kind of a special point of a branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Special {
    /// The branch turns back in the parameter.
    Fold,
    /// A multiplier passes +1 although the parameter does not turn. A symmetric motion loses its symmetry there, and two motions begin
    /// that are mirror images of each other. In rare cases another branch crosses instead, also among motions without symmetry.
    Pitchfork,
    /// A multiplier passes -1.
    PeriodDoubling,
    /// A pair of complex multipliers passes the unit circle.
    NeimarkSacker,
    /// An interval of contact appears or disappears.
    Grazing,
}

invalid_input::names!(Special, "special", {
    Fold: "fold",
    Pitchfork: "pitchfork",
    PeriodDoubling: "period doubling",
    NeimarkSacker: "Neimark-Sacker",
    Grazing: "grazing",
});

impl Special {
    /// Whether another branch begins at such a point, which [`follow_beginning`] follows.
    pub fn begins_a_branch(self) -> bool {
        matches!(self, Special::PeriodDoubling | Special::Pitchfork)
    }
}

/// An orbit of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct BranchPoint {
    /// The parameter.
    pub parameter: f64,
    /// The periodic motion there.
    pub orbit: Orbit,
}

/// A special point of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct SpecialPoint {
    /// Its kind.
    pub kind: Special,
    /// The parameter.
    pub parameter: f64,
    /// Uncertainty of the parameter: half the distance of the two orbits on either side; at a fold, the distance of a third one that
    /// is farther away.
    pub uncertainty: f64,
    /// Index of the first orbit of the branch after the point.
    pub before_orbit: usize,
    /// An orbit within the uncertainty.
    pub orbit: Orbit,
}

/// A branch of periodic motions.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Branch {
    /// The orbits in the order in which they were found.
    pub points: Vec<BranchPoint>,
    /// Points at which the stability or the pattern of contacts changes.
    pub special: Vec<SpecialPoint>,
    /// Whether the branch was followed to an end of the range, or back to that at which it begins. If not, no orbit was found beyond
    /// the last one.
    pub complete: bool,
    /// The index of the special point of that one at which it comes back. The same branch, or its mirror image, begins there.
    pub returns_to: Option<usize>,
    /// Whether it was interrupted.
    pub interrupted: bool,
    /// The contact that keeps something from earlier periods, if there is no first orbit for this reason
    /// ([`OrbitOutcome::Remembers`]).
    pub remembers: Option<usize>,
}

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

/// The special points between two neighbours on a branch. A multiplier that passes +1 counts as a pitchfork, which may be a fold.
fn differences(one: &Orbit, other: &Orbit) -> Vec<Special> {
    let mut found = Vec::new();
    let change = |beyond: fn(&[f64; 2]) -> bool| {
        let count = |orbit: &Orbit| orbit.floquet_multipliers.iter().filter(|m| beyond(m)).count();
        count(one).abs_diff(count(other))
    };
    // two real multipliers beyond the same end of the circle may become a pair there, which passes nothing
    let flips = change(|m| m[1] == 0.0 && m[0] < -1.0) % 2;
    let turns = change(|m| m[1] == 0.0 && m[0] > 1.0) % 2;
    if turns == 1 {
        found.push(Special::Pitchfork);
    }
    if flips == 1 {
        found.push(Special::PeriodDoubling);
    }
    if change(|m| m[0].hypot(m[1]) > 1.0) >= flips + turns + 2 {
        found.push(Special::NeimarkSacker);
    }
    if one.intervals_per_period != other.intervals_per_period {
        found.push(Special::Grazing);
    }
    found
}

/// The phase at which its state is given, as a part of a period of the loads.
fn phase_part(orbit: &Orbit) -> f64 {
    orbit.phase_s * f64::from(orbit.forcing_periods) / orbit.period_s
}

/// The multiplier nearest to +1.
fn nearest_to_one(orbit: &Orbit) -> f64 {
    let distance = |m: &&[f64; 2]| (m[0] - 1.0).hypot(m[1]);
    let nearest = orbit.floquet_multipliers.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.map_or(0.0, |m| m[0])
}

/// A step along a branch.
enum Step {
    /// The next orbit, and the number of iterations.
    Found(BranchPoint, u32),
    /// At this contact the motion depends on more than the states that are compared ([`OrbitOutcome::Remembers`]).
    Remembers(usize),
    None,
}

impl Step {
    fn found(self) -> Option<BranchPoint> {
        match self {
            Step::Found(point, _) => Some(point),
            Step::Remembers(_) | Step::None => None,
        }
    }
}

/// Where a branch begins at another one, its parent. It ends where it comes back to it.
struct Origin<'a> {
    /// The special points of the parent.
    parent: &'a [SpecialPoint],
    /// Kind of the one at which the branch begins.
    kind: Special,
    /// Periods of the loads after which the motion of the parent repeats itself.
    of_parent: u32,
}

struct Follower<'a, F> {
    build: F,
    settings: &'a BranchSettings,
    /// The phase at which states are compared, as a part of the period of the loads. It is the same along the branch as long as the
    /// contacts with internal variables are open then.
    phase_part: f64,
    /// Those that were closed, at the latest phase or an earlier one.
    remembering: BTreeSet<usize>,
    /// Where the branch begins, if that is a point of another branch.
    origin: Option<Origin<'a>>,
    stop: &'a dyn Fn() -> bool,
}

impl<'a, L, E, F> Follower<'a, F>
where
    L: ContactLaw + Clone,
    E: From<InvalidInput>,
    F: Fn(f64) -> Result<Assembly<L>, E>,
{
    fn new(build: F, settings: &'a BranchSettings, first: &Orbit, stop: &'a dyn Fn() -> bool) -> Follower<'a, F> {
        Follower { build, settings, phase_part: phase_part(first), remembering: BTreeSet::new(), origin: None, stop }
    }

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
            // a branch begins along the eigenvector, and not along its parent
            let found = found.filter(|(next, ..)| {
                rises.is_some() || self.chord(&current, next).is_ok_and(|chord| chord.norm() < MOST_ASIDE * step)
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
            // through the parent, to the same orbits half a period later or to their mirror images
            let joined = |before: DVector<f64>| before.dot(&moved) < JOINED * before.norm_squared();
            if asymmetry.is_some_and(joined) || rises.is_some() && self.passes_pitchfork(&current, &next)? {
                branch.complete = true;
                branch.returns_to = self.nearest_of_parent(&current, &next)?.map(|(special, _)| special);
                break;
            }
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

    fn range(&self) -> f64 {
        self.settings.to - self.settings.from
    }

    fn map(&self, parameter: f64) -> Result<PeriodMap<'a, L>, E> {
        self.map_over(parameter, self.settings.orbit.forcing_periods)
    }

    fn map_over(&self, parameter: f64, forcing_periods: u32) -> Result<PeriodMap<'a, L>, E> {
        let settings = OrbitSettings { forcing_periods, ..self.settings.orbit };
        let map = PeriodMap::new((self.build)(parameter)?, &settings, self.stop)?;
        let phase = self.phase_part * map.period_s() / f64::from(forcing_periods);
        Ok(map.at_phase(phase))
    }

    /// How far an orbit on a branch of twice the period is from a repetition after half of it, scaled; no component on other
    /// branches. `None` if a run stops.
    fn asymmetry(&self, point: &BranchPoint) -> Result<Option<DVector<f64>>, E> {
        let doubles = |origin: &&Origin| origin.kind == Special::PeriodDoubling;
        let Some(origin) = self.origin.as_ref().filter(doubles) else { return Ok(Some(DVector::zeros(0))) };
        let state = Self::state(&point.orbit);
        let Ok(image) = self.map_over(point.parameter, origin.of_parent)?.apply(&state)? else { return Ok(None) };
        Ok(Some((image - &state).component_div(&self.scales(point)?)))
    }

    /// The states of an orbit of any phase at that of this branch, one for each period of the loads; none if a run stops.
    fn states_here(&self, parameter: f64, orbit: &Orbit) -> Result<Vec<DVector<f64>>, E> {
        let mut by = (self.phase_part - phase_part(orbit)).rem_euclid(1.0);
        let mut map = self.map_over(parameter, 1)?.at_phase(orbit.phase_s);
        let (mut states, mut state) = (Vec::new(), Self::state(orbit));
        for _ in 0..orbit.forcing_periods {
            let Ok(turned) = map.turn(state, by)? else { break };
            states.push(turned.clone());
            (state, by) = (turned, 1.0);
        }
        Ok(states)
    }

    /// The special point of the parent, of the kind at which the branch begins, that is nearest to the chord from an orbit to the next
    /// one, and its distance as a part of the chord.
    fn nearest_of_parent(&self, one: &BranchPoint, other: &BranchPoint) -> Result<Option<(usize, f64)>, E> {
        let Some(Origin { parent, kind, .. }) = self.origin else { return Ok(None) };
        let (scales, chord) = (self.scales(one)?, self.chord(one, other)?);
        let start = self.scaled(one.parameter, &Self::state(&one.orbit), &scales);
        let mut nearest: Option<(usize, f64)> = None;
        for (i, point) in parent.iter().enumerate().filter(|(_, point)| point.kind == kind) {
            for state in self.states_here(point.parameter, &point.orbit)? {
                let beside = self.scaled(point.parameter, &state, &scales) - &start;
                let part = (beside.dot(&chord) / chord.norm_squared()).clamp(0.0, 1.0);
                let distance = (beside - part * &chord).norm() / chord.norm();
                if nearest.is_none_or(|(_, least)| distance < least) {
                    nearest = Some((i, distance));
                }
            }
        }
        Ok(nearest)
    }

    /// Whether the branch passes a pitchfork of its parent, where it is a parabola, between two orbits.
    fn passes_pitchfork(&self, one: &BranchPoint, other: &BranchPoint) -> Result<bool, E> {
        let begins = self.origin.as_ref().is_some_and(|origin| origin.kind == Special::Pitchfork);
        Ok(begins && self.nearest_of_parent(one, other)?.is_some_and(|(_, distance)| distance < NEAR_PITCHFORK))
    }

    /// The direction in which a branch begins at another one: the state changes along the eigenvector of the multiplier -1 at a period
    /// doubling, over the period of the parent, or of +1 at a pitchfork, and the parameter does not.
    fn eigenvector(&self, state: &DVector<f64>, parameter: f64) -> Result<Option<DVector<f64>>, E> {
        let Some(origin) = &self.origin else { return Ok(None) };
        let map = self.map_over(parameter, origin.of_parent)?;
        let multiplier = if origin.kind == Special::PeriodDoubling { -1.0 } else { 1.0 };
        let scales = map.scales(state, state);
        let Ok(jacobian) = map.derivative(state, &scales)? else { return Ok(None) };
        let n = state.len();
        let singular = DMatrix::from_fn(n, n, |i, j| {
            jacobian[(i, j)] * scales[j] / scales[i] - if i == j { multiplier } else { 0.0 }
        });
        Ok(null_vectors(singular).map(|(along, _)| along.insert_row(n, 0.0)))
    }

    fn state(orbit: &Orbit) -> DVector<f64> {
        DVector::from_column_slice(&orbit.state)
    }

    /// State and parameter, scaled by their sizes.
    fn scaled(&self, parameter: f64, state: &DVector<f64>, scales: &DVector<f64>) -> DVector<f64> {
        state.component_div(scales).insert_row(state.len(), parameter / self.range())
    }

    /// The difference of two orbits, scaled.
    fn chord(&self, one: &BranchPoint, other: &BranchPoint) -> Result<DVector<f64>, E> {
        let scales = self.scales(one)?;
        let scaled = |point: &BranchPoint| self.scaled(point.parameter, &Self::state(&point.orbit), &scales);
        Ok(scaled(other) - scaled(one))
    }

    fn scales(&self, point: &BranchPoint) -> Result<DVector<f64>, E> {
        let state = Self::state(&point.orbit);
        Ok(self.map(point.parameter)?.scales(&state, &state))
    }

    /// The state a period later at another parameter; `None` where the parameter is not allowed or a run stops.
    fn image(&self, parameter: f64, state: &DVector<f64>) -> Option<DVector<f64>> {
        self.map(parameter).ok()?.apply(state).ok()?.ok()
    }

    /// `DP - 1` and `dP/dp`, scaled; `None` where a run stops. At the edge of what the parameter may be, the difference is taken
    /// from one side.
    fn linearised(
        &self,
        state: &DVector<f64>,
        parameter: f64,
        scales: &DVector<f64>,
    ) -> Result<Option<DMatrix<f64>>, E> {
        let n = state.len();
        let map = self.map(parameter)?;
        let Ok(jacobian) = map.derivative(state, scales)? else { return Ok(None) };
        let step = DIFFERENCE * self.range();
        let slope = match (self.image(parameter + step, state), self.image(parameter - step, state)) {
            (Some(above), Some(below)) => (above - below) / (2.0 * DIFFERENCE),
            (above, below) => {
                let Ok(here) = map.apply(state)? else { return Ok(None) };
                match (above, below) {
                    (Some(above), _) => (above - here) / DIFFERENCE,
                    (_, Some(below)) => (here - below) / DIFFERENCE,
                    _ => return Ok(None),
                }
            }
        };
        Ok(Some(DMatrix::from_fn(n, n + 1, |i, j| {
            if j == n {
                slope[i] / scales[i]
            } else {
                (jacobian[(i, j)] - f64::from(u8::from(i == j))) * scales[j] / scales[i]
            }
        })))
    }

    /// The unit vector along the branch, with the parameter towards the end of its range.
    fn rising_tangent(&self, point: &BranchPoint) -> Result<Option<DVector<f64>>, E> {
        let scales = self.scales(point)?;
        let state = Self::state(&point.orbit);
        let n = state.len();
        let Some(matrix) = self.linearised(&state, point.parameter, &scales)? else { return Ok(None) };
        let square = matrix.columns(0, n).into_owned();
        let Some(moved) = square.lu().solve(&(-matrix.column(n))) else { return Ok(None) };
        let tangent = moved.insert_row(n, 1.0);
        Ok(Some(&tangent / tangent.norm()))
    }

    /// Whether the parameter moves towards the end of its range where the branch passes an orbit in this direction, which is roughly
    /// that of the branch. From one orbit to the next it may still rise although it has turned between them.
    fn rises(&self, point: &BranchPoint, direction: &DVector<f64>) -> Result<bool, E> {
        let along = self.rising_tangent(point)?;
        Ok(along.map_or(direction[direction.len() - 1], |along| along.dot(direction)) > 0.0)
    }

    /// The unit vector from one orbit to the next, along the branch.
    fn between(&self, one: &BranchPoint, other: &BranchPoint, before: &DVector<f64>) -> DVector<f64> {
        let Ok(chord) = self.chord(one, other) else { return before.clone() };
        let size = chord.norm();
        if size > 0.0 { chord / size } else { before.clone() }
    }

    /// Compares states at the middle of the longest time at which the remembering contacts are open; `false` where that fails.
    fn turn(&mut self, current: &mut BranchPoint, tangent: &mut DVector<f64>) -> Result<bool, E> {
        let scales = self.scales(current)?;
        let state = Self::state(&current.orbit);
        let n = state.len();
        let mut map = self.map(current.parameter)?;
        let Ok(part) = map.to_opening(&state, &self.remembering)? else { return Ok(false) };
        // the tangent turns as the difference from a neighbour does
        let ahead = DIFFERENCE * &*tangent;
        let beside = &state + ahead.rows(0, n).component_mul(&scales);
        let parameter = current.parameter + ahead[n] * self.range();
        let Ok(mut map_beside) = self.map(parameter) else { return Ok(false) };
        let (Ok(state), Ok(beside)) = (map.turn(state, part)?, map_beside.turn(beside, part)?) else {
            return Ok(false);
        };
        let OrbitOutcome::Found(orbit) = refine(&map, state.clone(), &self.settings.orbit)? else { return Ok(false) };
        self.phase_part = (self.phase_part + part) % 1.0;
        current.orbit = *orbit;
        let moved = (beside - state).component_div(&self.scales(current)?) / DIFFERENCE;
        let turned = moved.insert_row(n, tangent[n]);
        *tangent = &turned / turned.norm();
        Ok(true)
    }

    /// The next orbit along the tangent, and the number of iterations.
    fn step(&self, from: &BranchPoint, tangent: &DVector<f64>, step: f64) -> Result<Step, E> {
        let scales = self.scales(from)?;
        let base = self.scaled(from.parameter, &Self::state(&from.orbit), &scales);
        let n = scales.len();
        let mut at = &base + step * tangent;
        for iteration in 1..=ITERATIONS_MAX {
            let state = at.rows(0, n).component_mul(&scales);
            let parameter = at[n] * self.range();
            let Ok(map) = self.map(parameter) else { return Ok(Step::None) };
            let Ok(image) = map.apply(&state)? else { return Ok(Step::None) };
            let Some(matrix) = self.linearised(&state, parameter, &scales)? else { return Ok(Step::None) };
            let defect = (&image - &state).component_div(&scales);
            let made = (&at - &base).dot(tangent) - step;
            let whole = DMatrix::from_fn(n + 1, n + 1, |i, j| if i < n { matrix[(i, j)] } else { tangent[j] });
            let right = DVector::from_fn(n + 1, |i, _| if i < n { -defect[i] } else { -made });
            let Some(change) = whole.lu().solve(&right) else { return Ok(Step::None) };
            if change.norm() > 10.0 * step + 1e-3 {
                return Ok(Step::None);
            }
            at += &change;
            if change.amax() < self.settings.orbit.closure.sqrt() * 1e-2 {
                let parameter = at[n] * self.range();
                let state = at.rows(0, n).component_mul(&scales);
                let Ok(map) = self.map(parameter) else { return Ok(Step::None) };
                return Ok(match refine(&map, state, &self.settings.orbit)? {
                    OrbitOutcome::Found(orbit) => Step::Found(BranchPoint { parameter, orbit: *orbit }, iteration),
                    OrbitOutcome::Remembers { contact } => Step::Remembers(contact),
                    _ => Step::None,
                });
            }
        }
        Ok(Step::None)
    }

    /// The orbit at the end of the range, if the next one lies beyond it and this one is found; otherwise the next one.
    fn within_range(&self, from: &BranchPoint, next: BranchPoint) -> Result<BranchPoint, E> {
        let (low, high) = self.settings.limits();
        let parameter = next.parameter.clamp(low, high);
        if parameter == next.parameter {
            return Ok(next);
        }
        let part = (parameter - from.parameter) / (next.parameter - from.parameter);
        let (one, other) = (Self::state(&from.orbit), Self::state(&next.orbit));
        let state = &one + part * (other - &one);
        Ok(match refine(&self.map(parameter)?, state, &self.settings.orbit)? {
            OrbitOutcome::Found(orbit) => BranchPoint { parameter, orbit: *orbit },
            _ => next,
        })
    }

    /// The pitchfork between two neighbours, from where the multiplier between theirs is +1. `None` where there is none: at a graze
    /// multipliers jump.
    fn locate_pitchfork(
        &self,
        (one, other): (&BranchPoint, &BranchPoint),
        before_orbit: usize,
    ) -> Result<Option<SpecialPoint>, E> {
        let (scales, chord) = (self.scales(one)?, self.chord(one, other)?);
        let n = scales.len();
        let beyond = [one, other].map(|point| nearest_to_one(&point.orbit) - 1.0);
        let part = (beyond[0] / (beyond[0] - beyond[1])).clamp(0.0, 1.0);
        let start = self.scaled(one.parameter, &Self::state(&one.orbit), &scales) + part * &chord;
        let unscaled = |z: &DVector<f64>| (z.rows(0, n).component_mul(&scales), z[n] * self.range());
        let linearised = |z: &DVector<f64>| {
            let (state, parameter) = unscaled(z);
            let Some(image) = self.image(parameter, &state) else { return Ok(None) };
            let defect = (image - &state).component_div(&scales);
            Ok::<_, E>(self.linearised(&state, parameter, &scales)?.map(|matrix| (defect, matrix)))
        };
        let Some((found, last_step)) = branch_point(&linearised, &start, chord.norm())? else { return Ok(None) };
        let (state, parameter) = unscaled(&found);
        Ok(match refine(&self.map(parameter)?, state, &self.settings.orbit)? {
            OrbitOutcome::Found(orbit) => {
                let uncertainty = last_step * self.range().abs();
                Some(SpecialPoint { kind: Special::Pitchfork, parameter, uncertainty, before_orbit, orbit: *orbit })
            }
            _ => None,
        })
    }

    /// A special point within a step from an orbit, at which the parameter rises or falls; it comes before the orbit of this number.
    fn locate(
        &self,
        (from, rises): (&BranchPoint, bool),
        (tangent, step): (&DVector<f64>, f64),
        mut kind: Special,
        before_orbit: usize,
    ) -> Result<SpecialPoint, E> {
        let at = |step: f64| self.step(from, tangent, step).map(Step::found);
        let (mut low, mut high) = (0.0, step);
        let (mut below, mut above, mut outside) = (from.parameter, f64::NAN, f64::NAN);
        let mut orbit = from.orbit.clone();
        let (mut before, mut after) = (from.orbit.clone(), None);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let Some(point) = at(middle)? else { break };
            let passed = if kind == Special::Fold {
                self.rises(&point, tangent)? != rises
            } else {
                differences(&from.orbit, &point.orbit).contains(&kind)
            };
            orbit = point.orbit;
            if passed {
                (high, outside, above, after) = (middle, above, point.parameter, Some(orbit.clone()));
            } else {
                (low, outside, below, before) = (middle, below, point.parameter, orbit.clone());
            }
            // at a fold the parameters on both sides may agree by accident, but differ from it by the square of the distance
            let is_near = if kind == Special::Fold {
                high - low <= NEAR_FOLD * step
            } else {
                (above - below).abs() <= NEAR * self.range().abs()
            };
            if is_near {
                break;
            }
        }
        if above.is_nan() {
            above = at(high)?.map_or(below, |point| point.parameter);
        }
        // two multipliers that pass -1 one after the other count as a pair until the second of them is located
        let doubles = |after: &Orbit| differences(&before, after).iter().all(|kind| *kind == Special::PeriodDoubling);
        if kind == Special::NeimarkSacker && after.as_ref().is_some_and(doubles) {
            kind = Special::PeriodDoubling;
        }
        let (parameter, mut uncertainty) = (0.5 * (below + above), 0.5 * (above - below).abs());
        if kind == Special::Fold {
            uncertainty = uncertainty.max((outside - parameter).abs());
        }
        Ok(SpecialPoint { kind, parameter, uncertainty, before_orbit, orbit })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(one: &[[f64; 2]], other: &[[f64; 2]]) -> Vec<Special> {
        let orbit = |multipliers: &[[f64; 2]]| Orbit {
            period_s: 1.0,
            forcing_periods: 1,
            phase_s: 0.0,
            state: Vec::new(),
            closure: 0.0,
            floquet_multipliers: multipliers.to_vec(),
            stable: false,
            intervals_per_period: vec![1],
            sides: Vec::new(),
            section_m: Vec::new(),
            iterations: 0,
        };
        differences(&orbit(one), &orbit(other))
    }

    /// Multipliers that meet beyond the unit circle, or leave the real axis there, pass nothing.
    #[test]
    fn only_multipliers_that_pass_the_unit_circle_make_a_special_point() {
        const INSIDE: [f64; 2] = [0.2, 0.0];
        let pair = |re: f64, im: f64| vec![[re, im], [re, -im], INSIDE];
        let real = |one: f64, other: f64| vec![[one, 0.0], [other, 0.0], INSIDE];
        let cases = [
            (pair(-1.551, 0.394), real(-1.605, -1.539), vec![]),
            (pair(1.5, 0.1), real(1.6, 1.4), vec![]),
            (pair(-0.9, 0.1), real(-0.9, -0.8), vec![]),
            (real(-0.9, -0.8), real(-1.1, -0.8), vec![Special::PeriodDoubling]),
            // a pair becomes two beyond -1, one of which then enters the circle
            (pair(-1.19, 0.28), real(-2.05, -0.88), vec![Special::PeriodDoubling]),
            (pair(-0.6, 0.7), pair(-0.6, 0.9), vec![Special::NeimarkSacker]),
            // a pair leaves the circle and becomes two real ones
            (pair(-0.9, 0.1), real(-1.2, -1.1), vec![Special::NeimarkSacker]),
            (real(1.1, 0.5), real(0.9, 0.5), vec![Special::Pitchfork]),
        ];
        for (one, other, expected) in cases {
            assert_eq!(between(&one, &other), expected, "{one:?} {other:?}");
            assert_eq!(between(&other, &one), expected, "{other:?} {one:?}");
        }
    }
}
