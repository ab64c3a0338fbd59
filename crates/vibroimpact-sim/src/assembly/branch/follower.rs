//! Steps along a branch.

use super::crossing::Linearised;
use super::settings::BranchSettings;
use super::special::{BranchPoint, Special, SpecialPoint};
use crate::assembly::orbit::{Orbit, OrbitOutcome, refine};
use crate::assembly::orbit_settings::OrbitSettings;
use crate::assembly::period_map::PeriodMap;
use crate::assembly::problem::Assembly;
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeSet;

/// Change of the parameter for finite differences, relative to its range.
const DIFFERENCE: f64 = 1e-6;
/// Newton iterations of a step along the branch.
const ITERATIONS_MAX: u32 = 8;

/// A step along a branch.
pub(super) enum Step {
    /// The next orbit, and the number of iterations.
    Found(BranchPoint, u32),
    /// At this contact the motion depends on more than the states that are compared ([`OrbitOutcome::Remembers`]).
    Remembers(usize),
    None,
}

impl Step {
    pub(super) fn found(self) -> Option<BranchPoint> {
        match self {
            Step::Found(point, _) => Some(point),
            Step::Remembers(_) | Step::None => None,
        }
    }
}

/// Where a branch begins at another one, its parent. It ends where it comes back to it.
pub(super) struct Origin<'a> {
    /// The special points of the parent.
    pub(super) parent: &'a [SpecialPoint],
    /// Kind of the one at which the branch begins.
    pub(super) kind: Special,
    /// Periods of the loads after which the motion of the parent repeats itself.
    pub(super) of_parent: u32,
}

/// The phase at which its state is given, as a part of a period of the loads.
pub(super) fn phase_part(orbit: &Orbit) -> f64 {
    orbit.phase_s * f64::from(orbit.forcing_periods) / orbit.period_s
}

pub(super) struct Follower<'a, F> {
    pub(super) build: F,
    pub(super) settings: &'a BranchSettings,
    /// The phase at which states are compared, as a part of the period of the loads. It is the same along the branch as long as the
    /// contacts with internal variables are open then.
    pub(super) phase_part: f64,
    /// Those that were closed, at the latest phase or an earlier one.
    pub(super) remembering: BTreeSet<usize>,
    /// Where the branch begins, if that is a point of another branch.
    pub(super) origin: Option<Origin<'a>>,
    pub(super) stop: &'a dyn Fn() -> bool,
}

impl<'a, L, E, F> Follower<'a, F>
where
    L: ContactLaw + Clone,
    E: From<InvalidInput>,
    F: Fn(f64) -> Result<Assembly<L>, E>,
{
    pub(super) fn new(
        build: F,
        settings: &'a BranchSettings,
        first: &Orbit,
        stop: &'a dyn Fn() -> bool,
    ) -> Follower<'a, F> {
        Follower { build, settings, phase_part: phase_part(first), remembering: BTreeSet::new(), origin: None, stop }
    }

    pub(super) fn range(&self) -> f64 {
        self.settings.to - self.settings.from
    }

    pub(super) fn map(&self, parameter: f64) -> Result<PeriodMap<'a, L>, E> {
        self.map_over(parameter, self.settings.orbit.forcing_periods)
    }

    pub(super) fn map_over(&self, parameter: f64, forcing_periods: u32) -> Result<PeriodMap<'a, L>, E> {
        let settings = OrbitSettings { forcing_periods, ..self.settings.orbit };
        let map = PeriodMap::new((self.build)(parameter)?, &settings, self.stop)?;
        let phase = self.phase_part * map.period_s() / f64::from(forcing_periods);
        Ok(map.at_phase(phase))
    }

    pub(super) fn state(orbit: &Orbit) -> DVector<f64> {
        DVector::from_column_slice(&orbit.state)
    }

    /// State and parameter, scaled by their sizes.
    pub(super) fn scaled(&self, parameter: f64, state: &DVector<f64>, scales: &DVector<f64>) -> DVector<f64> {
        state.component_div(scales).insert_row(state.len(), parameter / self.range())
    }

    pub(super) fn scaled_point(&self, point: &BranchPoint, scales: &DVector<f64>) -> DVector<f64> {
        self.scaled(point.parameter, &Self::state(&point.orbit), scales)
    }

    /// The state and the parameter that were scaled.
    pub(super) fn unscaled(&self, at: &DVector<f64>, scales: &DVector<f64>) -> (DVector<f64>, f64) {
        let n = scales.len();
        (at.rows(0, n).component_mul(scales), at[n] * self.range())
    }

    /// The difference of two orbits, scaled.
    pub(super) fn chord(&self, one: &BranchPoint, other: &BranchPoint) -> Result<DVector<f64>, E> {
        let scales = self.scales(one)?;
        Ok(self.scaled_point(other, &scales) - self.scaled_point(one, &scales))
    }

    pub(super) fn scales(&self, point: &BranchPoint) -> Result<DVector<f64>, E> {
        let state = Self::state(&point.orbit);
        Ok(self.map(point.parameter)?.scales(&state, &state))
    }

    /// The state a period later at another parameter; `None` where the parameter is not allowed or a run stops.
    pub(super) fn image(&self, parameter: f64, state: &DVector<f64>) -> Option<DVector<f64>> {
        self.map(parameter).ok()?.apply(state).ok()?.ok()
    }

    /// `DP - 1` and `dP/dp`, scaled; `None` where a run stops. At the edge of what the parameter may be, the difference is taken
    /// from one side.
    pub(super) fn linearised(
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

    /// `P(x, p) - x` and its derivatives at a scaled point, all scaled; `None` where a run stops.
    pub(super) fn equations(&self, at: &DVector<f64>, scales: &DVector<f64>) -> Result<Option<Linearised>, E> {
        let (state, parameter) = self.unscaled(at, scales);
        let Some(image) = self.image(parameter, &state) else { return Ok(None) };
        let defect = (image - &state).component_div(scales);
        Ok(self.linearised(&state, parameter, scales)?.map(|matrix| (defect, matrix)))
    }

    /// The unit vector along the branch, with the parameter towards the end of its range.
    pub(super) fn rising_tangent(&self, point: &BranchPoint) -> Result<Option<DVector<f64>>, E> {
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
    pub(super) fn rises(&self, point: &BranchPoint, direction: &DVector<f64>) -> Result<bool, E> {
        let along = self.rising_tangent(point)?;
        Ok(along.map_or(direction[direction.len() - 1], |along| along.dot(direction)) > 0.0)
    }

    /// The unit vector from one orbit to the next, along the branch.
    pub(super) fn between(&self, one: &BranchPoint, other: &BranchPoint, before: &DVector<f64>) -> DVector<f64> {
        let Ok(chord) = self.chord(one, other) else { return before.clone() };
        let size = chord.norm();
        if size > 0.0 { chord / size } else { before.clone() }
    }

    /// Compares states at the middle of the longest time at which the remembering contacts are open; `false` where that fails.
    pub(super) fn turn(&mut self, current: &mut BranchPoint, tangent: &mut DVector<f64>) -> Result<bool, E> {
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
    pub(super) fn step(&self, from: &BranchPoint, tangent: &DVector<f64>, step: f64) -> Result<Step, E> {
        let scales = self.scales(from)?;
        let base = self.scaled_point(from, &scales);
        let n = scales.len();
        let mut at = &base + step * tangent;
        for iteration in 1..=ITERATIONS_MAX {
            let Some((defect, matrix)) = self.equations(&at, &scales)? else { return Ok(Step::None) };
            let made = (&at - &base).dot(tangent) - step;
            let whole = DMatrix::from_fn(n + 1, n + 1, |i, j| if i < n { matrix[(i, j)] } else { tangent[j] });
            let right = DVector::from_fn(n + 1, |i, _| if i < n { -defect[i] } else { -made });
            let Some(change) = whole.lu().solve(&right) else { return Ok(Step::None) };
            if change.norm() > 10.0 * step + 1e-3 {
                return Ok(Step::None);
            }
            at += &change;
            if change.amax() < self.settings.orbit.closure.sqrt() * 1e-2 {
                let (state, parameter) = self.unscaled(&at, &scales);
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
    pub(super) fn within_range(&self, from: &BranchPoint, next: BranchPoint) -> Result<BranchPoint, E> {
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
}
