//! Special points between two neighbours on a branch.

use super::crossing::crossing;
use super::follower::{Follower, Step};
use super::special::{BranchPoint, Special, SpecialPoint, differences, nearest_to_one};
use crate::assembly::orbit::{Orbit, OrbitOutcome, refine};
use crate::assembly::problem::Assembly;
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use nalgebra::DVector;

/// Number of bisections that locate a special point.
const HALVINGS: u32 = 20;
/// They end where the parameters on both sides differ by less than this part of its range, or, at a fold, where the sides are as near
/// as this part of the step.
const NEAR: f64 = 1e-8;
const NEAR_FOLD: f64 = 1e-4;

impl<L, E, F> Follower<'_, F>
where
    L: ContactLaw + Clone,
    E: From<InvalidInput>,
    F: Fn(f64) -> Result<Assembly<L>, E>,
{
    /// The pitchfork between two neighbours, from where the multiplier between theirs is +1. `None` where there is none: at a graze
    /// multipliers jump.
    pub(super) fn locate_pitchfork(
        &self,
        (one, other): (&BranchPoint, &BranchPoint),
        before_orbit: usize,
    ) -> Result<Option<SpecialPoint>, E> {
        let (scales, chord) = (self.scales(one)?, self.chord(one, other)?);
        let beyond = [one, other].map(|point| nearest_to_one(&point.orbit) - 1.0);
        let part = (beyond[0] / (beyond[0] - beyond[1])).clamp(0.0, 1.0);
        let start = self.scaled_point(one, &scales) + part * &chord;
        let equations = |at: &DVector<f64>| self.equations(at, &scales);
        let Some((found, last_step)) = crossing(&equations, &start, chord.norm())? else { return Ok(None) };
        let (state, parameter) = self.unscaled(&found, &scales);
        Ok(match refine(&self.map(parameter)?, state, &self.settings.orbit)? {
            OrbitOutcome::Found(orbit) => {
                let uncertainty = last_step * self.range().abs();
                Some(SpecialPoint { kind: Special::Pitchfork, parameter, uncertainty, before_orbit, orbit: *orbit })
            }
            _ => None,
        })
    }

    /// A special point within a step from an orbit, at which the parameter rises or falls; it comes before the orbit of this number.
    pub(super) fn locate(
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
