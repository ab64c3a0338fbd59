//! The equations of one panel, and Newton's method for them.

use super::kernel::Matrices;
use super::law::{Force, Scaled};
use crate::infinite::rule::dot;
use contact_models::Branch;
use nalgebra::{DMatrix, DVector};

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

/// Solves `f = law(x, x')` with `x = known_x - A f`, `x' = known_rate - B f`, from a guess in `nodal`, until the forces
/// change by less than their rounding.
pub(super) fn solve(
    law: &Scaled<'_>,
    branch: &Branch,
    matrices: &Matrices,
    known: &[Vec<f64>; 2],
    mut nodal: Nodal,
) -> Result<Nodal, Fault> {
    let p = nodal.force.len();
    let mut last = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let forces: Vec<Force> = (0..p).map(|i| law.force(branch, nodal.x[i], nodal.rate[i])).collect();
        nodal.stiffness = forces.iter().fold(0.0_f64, |largest, f| largest.max(f.stiffness.abs()));
        if forces.iter().any(|f| !(f.force.is_finite() && f.stiffness.is_finite() && f.damping.is_finite())) {
            return Err(Fault::Law);
        }
        let jacobian = DMatrix::from_fn(p, p, |i, j| {
            let delta = if i == j { 1.0 } else { 0.0 };
            let at = i * p + j;
            delta + forces[i].stiffness * matrices.compression[at] + forces[i].damping * matrices.rate[at]
        });
        let right = DVector::from_fn(p, |i, _| {
            forces[i].force
                + forces[i].stiffness * (known[0][i] - nodal.x[i])
                + forces[i].damping * (known[1][i] - nodal.rate[i])
        });
        let Some(force) = jacobian.lu().solve(&right) else { return Err(Fault::NotConverged) };
        let largest = force.amax();
        let change = force.iter().zip(&nodal.force).fold(0.0_f64, |change, (a, b)| change.max((a - b).abs()));
        if !(largest.is_finite() && change.is_finite()) {
            return Err(Fault::NotConverged);
        }
        nodal.force.copy_from_slice(force.as_slice());
        for i in 0..=p {
            let row = i * p..(i + 1) * p;
            nodal.x[i] = known[0][i] - dot(&matrices.compression[row.clone()], &nodal.force);
            nodal.rate[i] = known[1][i] - dot(&matrices.rate[row], &nodal.force);
        }
        // converged, or as far as rounding lets the steps shrink
        if change <= 1e-15 * largest || (change <= 1e-11 * largest && change > 0.1 * last) || largest == 0.0 {
            return Ok(nodal);
        }
        last = change;
    }
    Err(Fault::NotConverged)
}
