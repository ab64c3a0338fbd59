//! Where a branch begins at another one, and where it comes back to it.

use super::crossing::null_vectors;
use super::follower::{Follower, Origin, phase_part};
use super::special::{BranchPoint, Special};
use crate::assembly::orbit::Orbit;
use crate::assembly::problem::Assembly;
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use nalgebra::{DMatrix, DVector};

/// Largest distance of a special point from the chord between two orbits, if the branch, a parabola there, passes it between them; as a
/// part of the chord.
const NEAR_PARENT: f64 = 0.5;

impl<L, E, F> Follower<'_, F>
where
    L: ContactLaw + Clone,
    E: From<InvalidInput>,
    F: Fn(f64) -> Result<Assembly<L>, E>,
{
    /// How far an orbit on a branch of twice the period is from a repetition after half of it, scaled; no component on other
    /// branches. `None` if a run stops.
    pub(super) fn asymmetry(&self, point: &BranchPoint) -> Result<Option<DVector<f64>>, E> {
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

    /// The special point of the parent, of the kind at which the branch begins, that it passes between two orbits.
    pub(super) fn passed(&self, one: &BranchPoint, other: &BranchPoint) -> Result<Option<usize>, E> {
        let Some(Origin { parent, kind, .. }) = self.origin else { return Ok(None) };
        let (scales, chord) = (self.scales(one)?, self.chord(one, other)?);
        let start = self.scaled_point(one, &scales);
        for (i, point) in parent.iter().enumerate().filter(|(_, point)| point.kind == kind) {
            for state in self.states_here(point.parameter, &point.orbit)? {
                let beside = self.scaled(point.parameter, &state, &scales) - &start;
                let part = (beside.dot(&chord) / chord.norm_squared()).clamp(0.0, 1.0);
                if (beside - part * &chord).norm() < NEAR_PARENT * chord.norm() {
                    return Ok(Some(i));
                }
            }
        }
        Ok(None)
    }

    pub(super) fn begins_at_pitchfork(&self) -> bool {
        self.origin.as_ref().is_some_and(|origin| origin.kind == Special::Pitchfork)
    }

    /// The direction in which a branch begins at another one: the state changes along the eigenvector of the multiplier -1 at a period
    /// doubling, over the period of the parent, or of +1 at a pitchfork, and the parameter does not.
    pub(super) fn eigenvector(&self, state: &DVector<f64>, parameter: f64) -> Result<Option<DVector<f64>>, E> {
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
}
