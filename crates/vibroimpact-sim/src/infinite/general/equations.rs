//! The equations of one panel, and Newton's method for them.

use super::kernel::Matrices;
use super::law::{Force, Scaled};
use crate::infinite::rule::dot;
use contact_models::Branch;
use nalgebra::{DMatrix, DVector, Dyn, LU};

/// Most steps of Newton's method.
const MOST_STEPS: usize = 40;

/// Compression and rate at the nodes and, last, at the end of a panel; the forces at the nodes.
pub(super) struct Nodal {
    pub x: Vec<f64>,
    pub rate: Vec<f64>,
    pub force: Vec<f64>,
    /// The largest stiffness met.
    pub stiffness: f64,
}

/// Why a panel has no solution.
pub(super) enum Fault {
    /// Newton's method did not converge: the panel is too long.
    NotConverged,
    /// The law gave no number.
    Law,
}

/// Solves `f = law(x, x')` with `x = known_x - A f`, `x' = known_rate - B f`, from a guess of `x` and `x'` in `nodal`, until the
/// forces change by less than their rounding. Close to the solution the factors of a matrix serve again.
pub(super) fn solve(
    law: &Scaled<'_>,
    branch: &Branch,
    matrices: &Matrices,
    known: &[Vec<f64>; 2],
    mut nodal: Nodal,
) -> Result<Nodal, Fault> {
    let p = nodal.force.len();
    let (mut last, mut kept) = (f64::INFINITY, None::<LU<f64, Dyn, Dyn>>);
    for step in 0..MOST_STEPS {
        let forces: Vec<Force> = (0..p).map(|i| law.force(branch, nodal.x[i], nodal.rate[i])).collect();
        nodal.stiffness = forces.iter().fold(0.0_f64, |largest, f| largest.max(f.stiffness.abs()));
        if forces.iter().any(|f| !(f.force.is_finite() && f.stiffness.is_finite() && f.damping.is_finite())) {
            return Err(Fault::Law);
        }
        let fresh = kept.is_none();
        let factors = kept.get_or_insert_with(|| {
            let jacobian = DMatrix::from_fn(p, p, |i, j| {
                let delta = if i == j { 1.0 } else { 0.0 };
                let at = i * p + j;
                delta + forces[i].stiffness * matrices.compression[at] + forces[i].damping * matrices.rate[at]
            });
            jacobian.lu()
        });
        // the guess need not be the motion under the forces before it
        let mut change = DVector::from_fn(p, |i, _| {
            let Force { force, stiffness, damping } = forces[i];
            match step {
                0 => force + stiffness * (known[0][i] - nodal.x[i]) + damping * (known[1][i] - nodal.rate[i]),
                _ => force - nodal.force[i],
            }
        });
        if !factors.solve_mut(&mut change) {
            return Err(Fault::NotConverged);
        }
        nodal.force.iter_mut().zip(&change).for_each(|(force, change)| *force += change);
        let largest = nodal.force.iter().fold(0.0_f64, |largest, f| largest.max(f.abs()));
        let change = change.amax();
        if !(largest.is_finite() && change.is_finite()) {
            return Err(Fault::NotConverged);
        }
        for i in 0..=p {
            let row = i * p..(i + 1) * p;
            nodal.x[i] = known[0][i] - dot(&matrices.compression[row.clone()], &nodal.force);
            nodal.rate[i] = known[1][i] - dot(&matrices.rate[row], &nodal.force);
        }
        // converged, or as far as rounding lets the steps shrink; with old factors they shrink slowly before that
        let stalled = fresh && change <= 1e-11 * largest && change > 0.1 * last;
        if change <= 1e-15 * largest || stalled || largest == 0.0 {
            return Ok(nodal);
        }
        if !(change < 0.1 * largest && change < 0.2 * last) {
            kept = None;
        }
        last = change;
    }
    Err(Fault::NotConverged)
}
