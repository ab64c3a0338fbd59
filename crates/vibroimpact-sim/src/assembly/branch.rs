//! Branches of periodic motions over one parameter.
//!
//! A branch is a curve in the space of the state `x` and a parameter `p`, each scaled by its size. It is followed by
//! pseudo-arclength, also round folds: a step along the tangent is followed by Newton's method for `P(x, p) = x` and for the
//! length of the step. The Floquet multipliers along the branch show where stability is lost or gained, and how:
//!
//! | point | what changes |
//! |---|---|
//! | fold | the parameter turns: a multiplier at +1 |
//! | period doubling | a multiplier at -1 |
//! | Neimark-Sacker | a pair of complex multipliers at size 1 |
//! | grazing | an interval of contact appears or disappears: the surfaces touch with zero speed |
//!
//! Each special point is located by bisection between the orbits on either side.

use super::orbit::{Orbit, OrbitOutcome, OrbitSettings, PeriodMap, find_orbit, refine};
use super::problem::Assembly;
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use nalgebra::{DMatrix, DVector};

/// Change of the parameter for finite differences, relative to its range.
const DIFFERENCE: f64 = 1e-6;
/// Newton iterations of a step along the branch.
const ITERATIONS_MAX: u32 = 8;
/// After a step with fewer iterations than this the next step is longer.
const QUICK: u32 = 4;
/// Number of bisections that locate a special point.
const HALVINGS: u32 = 20;

/// Settings for following a branch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BranchSettings {
    /// Settings for each periodic motion.
    pub orbit: OrbitSettings,
    /// The range of the parameter: the branch starts at the first value and goes towards the second.
    pub from: f64,
    /// See `from`.
    pub to: f64,
    /// First step, as a share of the range. Default 0.02.
    pub step: f64,
    /// Longest step, as a share of the range. Default 0.05.
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
        InvalidInput::unless(step, "step", self.step, "a positive part of the range, at most 0.5")?;
        let longest = self.longest_step >= self.step && self.longest_step <= 0.5;
        InvalidInput::unless(longest, "longest_step", self.longest_step, "from the first step to 0.5")?;
        InvalidInput::unless(self.max_orbits > 0, "max_orbits", self.max_orbits, "at least 1")
    }
}

/// Kind of a special point of a branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Special {
    /// The parameter turns.
    Fold,
    /// A multiplier passes -1.
    PeriodDoubling,
    /// A pair of complex multipliers passes the unit circle.
    NeimarkSacker,
    /// An interval of contact appears or disappears.
    Grazing,
}

invalid_input::names!(Special, "special", {
    Fold: "fold",
    PeriodDoubling: "period doubling",
    NeimarkSacker: "Neimark-Sacker",
    Grazing: "grazing",
});

/// An orbit of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct BranchPoint {
    /// The parameter.
    pub parameter: f64,
    /// The periodic motion there.
    pub orbit: Orbit,
}

/// A special point of a branch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpecialPoint {
    /// Its kind.
    pub kind: Special,
    /// The parameter.
    pub parameter: f64,
    /// Uncertainty of the parameter: half the distance of the two orbits on either side.
    pub uncertainty: f64,
    /// Number of the orbit of the branch after it.
    pub before_orbit: usize,
}

/// A branch of periodic motions.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Branch {
    /// The orbits in the order in which they were found.
    pub points: Vec<BranchPoint>,
    /// Where stability or the pattern of contacts changes.
    pub special: Vec<SpecialPoint>,
    /// Whether the branch was followed to an end of the range. If not, no orbit was found beyond the last one.
    pub complete: bool,
}

/// Follows the branch of periodic motions of `build(parameter)`.
///
/// # Errors
/// If settings are out of range or the input is invalid, and the errors of `build`.
pub fn follow_branch<L: ContactLaw + Clone, E: From<InvalidInput>>(
    build: impl Fn(f64) -> Result<Assembly<L>, E>,
    settings: &BranchSettings,
    mut progress: impl FnMut(&BranchPoint) -> bool,
) -> Result<Branch, E> {
    settings.check()?;
    let OrbitOutcome::Found(first) = find_orbit(&build(settings.from)?, &settings.orbit)? else {
        return Ok(Branch::default());
    };
    let mut follower = Follower { build, settings, phase_part: first.phase_s / first.period_s };
    let mut branch = Branch::default();
    let mut current = BranchPoint { parameter: settings.from, orbit: *first };
    let Some(mut tangent) = follower.first_tangent(&current)? else { return Ok(branch) };
    let mut step = settings.step;
    if !progress(&current) {
        branch.points.push(current);
        return Ok(branch);
    }
    branch.points.push(current.clone());
    while branch.points.len() < settings.max_orbits {
        let Some((next, iterations)) = follower.step(&current, &tangent, step)? else {
            step *= 0.5;
            if step < 1e-5 * settings.step {
                return Ok(branch);
            }
            continue;
        };
        let next = follower.within_range(&current, next)?;
        let new_tangent = follower.between(&current, &next, &tangent);
        let turn = tangent[tangent.len() - 1] * new_tangent[tangent.len() - 1];
        let mut special = Vec::new();
        for kind in differences(&current.orbit, &next.orbit, turn) {
            let before_orbit = branch.points.len();
            let (parameter, uncertainty) = follower.locate(&current, &tangent, step, kind)?;
            special.push(SpecialPoint { kind, parameter, uncertainty, before_orbit });
        }
        let distance = |point: &SpecialPoint| (point.parameter - current.parameter).abs();
        special.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        branch.special.append(&mut special);
        (current, tangent) = (next, new_tangent);
        let goes_on = progress(&current);
        branch.points.push(current.clone());
        let (low, high) = settings.limits();
        if !(low < current.parameter && current.parameter < high) {
            branch.complete = true;
            break;
        }
        if !goes_on {
            break;
        }
        if iterations < QUICK {
            step = (1.5 * step).min(settings.longest_step);
        }
    }
    Ok(branch)
}

/// The special points between two neighbours on a branch; `turn` is negative if the parameter turns between them.
fn differences(one: &Orbit, other: &Orbit, turn: f64) -> Vec<Special> {
    let mut found = Vec::new();
    if turn < 0.0 {
        found.push(Special::Fold);
    }
    let flips = |orbit: &Orbit| orbit.floquet_multipliers.iter().filter(|m| m[1] == 0.0 && m[0] < -1.0).count();
    if flips(one) != flips(other) {
        found.push(Special::PeriodDoubling);
    }
    let spirals =
        |orbit: &Orbit| orbit.floquet_multipliers.iter().filter(|m| m[1] != 0.0 && m[0].hypot(m[1]) > 1.0).count();
    if spirals(one) != spirals(other) && flips(one) == flips(other) {
        found.push(Special::NeimarkSacker);
    }
    if one.intervals_per_period != other.intervals_per_period {
        found.push(Special::Grazing);
    }
    found
}

struct Follower<'a, F> {
    build: F,
    settings: &'a BranchSettings,
    /// The phase at which states are compared, as a part of the period; it is the same along the branch.
    phase_part: f64,
}

impl<L, E, F> Follower<'_, F>
where
    L: ContactLaw + Clone,
    E: From<InvalidInput>,
    F: Fn(f64) -> Result<Assembly<L>, E>,
{
    fn range(&self) -> f64 {
        self.settings.to - self.settings.from
    }

    fn map(&self, parameter: f64) -> Result<PeriodMap<'static, L>, E> {
        let map = PeriodMap::new((self.build)(parameter)?, &self.settings.orbit, &|| false)?;
        let phase = self.phase_part * map.period_s();
        Ok(map.at_phase(phase))
    }

    fn state(orbit: &Orbit) -> DVector<f64> {
        DVector::from_column_slice(&orbit.state)
    }

    /// State and parameter, scaled by their sizes.
    fn scaled(&self, point: &BranchPoint, scales: &DVector<f64>) -> DVector<f64> {
        let state = Self::state(&point.orbit).component_div(scales);
        let n = state.len();
        state.insert_row(n, point.parameter / self.range())
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
    fn first_tangent(&self, point: &BranchPoint) -> Result<Option<DVector<f64>>, E> {
        let scales = self.scales(point)?;
        let state = Self::state(&point.orbit);
        let n = state.len();
        let Some(matrix) = self.linearised(&state, point.parameter, &scales)? else { return Ok(None) };
        let square = matrix.columns(0, n).into_owned();
        let Some(moved) = square.lu().solve(&(-matrix.column(n))) else { return Ok(None) };
        let tangent = moved.insert_row(n, 1.0);
        Ok(Some(&tangent / tangent.norm()))
    }

    /// The unit vector from one orbit to the next, along the branch.
    fn between(&self, one: &BranchPoint, other: &BranchPoint, before: &DVector<f64>) -> DVector<f64> {
        let Ok(scales) = self.scales(one) else { return before.clone() };
        let difference = self.scaled(other, &scales) - self.scaled(one, &scales);
        let size = difference.norm();
        if size > 0.0 { difference / size } else { before.clone() }
    }

    /// The next orbit along the tangent, and the number of iterations; `None` if none was found.
    fn step(&self, from: &BranchPoint, tangent: &DVector<f64>, step: f64) -> Result<Option<(BranchPoint, u32)>, E> {
        let scales = self.scales(from)?;
        let base = self.scaled(from, &scales);
        let n = scales.len();
        let mut at = &base + step * tangent;
        for iteration in 1..=ITERATIONS_MAX {
            let state = at.rows(0, n).component_mul(&scales);
            let parameter = at[n] * self.range();
            let Ok(map) = self.map(parameter) else { return Ok(None) };
            let Ok(image) = map.apply(&state)? else { return Ok(None) };
            let Some(matrix) = self.linearised(&state, parameter, &scales)? else { return Ok(None) };
            let defect = (&image - &state).component_div(&scales);
            let made = (&at - &base).dot(tangent) - step;
            let whole = DMatrix::from_fn(n + 1, n + 1, |i, j| if i < n { matrix[(i, j)] } else { tangent[j] });
            let right = DVector::from_fn(n + 1, |i, _| if i < n { -defect[i] } else { -made });
            let Some(change) = whole.lu().solve(&right) else { return Ok(None) };
            if change.norm() > 10.0 * step + 1e-3 {
                return Ok(None);
            }
            at += &change;
            if change.amax() < self.settings.orbit.closure.sqrt() * 1e-2 {
                let parameter = at[n] * self.range();
                let state = at.rows(0, n).component_mul(&scales);
                let Ok(map) = self.map(parameter) else { return Ok(None) };
                return Ok(match refine(&map, state, &self.settings.orbit)? {
                    OrbitOutcome::Found(orbit) => Some((BranchPoint { parameter, orbit: *orbit }, iteration)),
                    _ => None,
                });
            }
        }
        Ok(None)
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

    /// The parameter of a special point within a step, and its uncertainty.
    fn locate(
        &mut self,
        from: &BranchPoint,
        tangent: &DVector<f64>,
        step: f64,
        kind: Special,
    ) -> Result<(f64, f64), E> {
        let (mut low, mut high) = (0.0, step);
        let (mut below, mut above) = (from.parameter, f64::NAN);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let Some((point, _)) = self.step(from, tangent, middle)? else { break };
            // a fold is the extremum of the parameter
            let passed = if kind == Special::Fold {
                let Some((beyond, _)) = self.step(from, tangent, middle + 1e-3 * (high - low))? else { break };
                (beyond.parameter - point.parameter) * tangent[tangent.len() - 1] * self.range() < 0.0
            } else {
                differences(&from.orbit, &point.orbit, 1.0).contains(&kind)
            };
            if passed {
                (high, above) = (middle, point.parameter);
            } else {
                (low, below) = (middle, point.parameter);
            }
            if (above - below).abs() <= 1e-8 * self.range().abs() {
                break;
            }
        }
        if above.is_nan() {
            above = self.step(from, tangent, high)?.map_or(below, |(point, _)| point.parameter);
        }
        Ok((0.5 * (below + above), 0.5 * (above - below).abs()))
    }
}
