//! Collocation of the contact force on one step: the only unknowns of an impact.
//!
//! On a step the force is a polynomial. At each Gauss node the law must hold,
//! `F_i = law(xi_i, xi_dot_i)` with `xi = xi_free + (R - c) F`, `R` the structure's and the striker's exact response.

use super::legendre::{BASIS, Matrix, Nodal, Q, dot};
use contact_models::{Boundary, Branch, ContactLaw};

/// More iterations than this mean that the step is too long.
const NEWTON_MAX: u32 = 12;

/// What is known before a step's force is.
pub(crate) struct Given<'a> {
    /// Length of the step (s).
    pub h: f64,
    /// Compression at the start (m).
    pub start_compression: f64,
    /// Compression at the nodes if there were no force (m).
    pub free: Nodal,
    /// Compression at the nodes to unit nodal forces (m/N), without the residual compliance.
    pub response: &'a Matrix,
    /// Residual compliance (m/N).
    pub residual_compliance: f64,
}

/// A solved step.
#[derive(Clone, Copy)]
pub(crate) struct Collocated {
    /// Force (N), compression (m) and rate (m/s; zero unless asked for) at the nodes.
    pub force: Nodal,
    pub compression: Nodal,
    pub rate: Nodal,
}

/// Solves the law at the nodes by Newton's method; `None` if it does not converge. Adds to `evaluations` and
/// `iterations`.
pub(crate) fn collocate<L: ContactLaw>(
    law: &L,
    branch: &Branch,
    given: &Given,
    needs_rate: bool,
    guess: Nodal,
    counts: &mut super::solution::Counts,
) -> Option<Collocated> {
    let basis = &*BASIS;
    let mut response = *given.response;
    for i in 0..Q {
        response[i][i] -= given.residual_compliance;
    }
    let mut force = guess;
    let mut rate = [0.0; Q];
    for _ in 0..NEWTON_MAX {
        let mut compression = given.free;
        for i in 0..Q {
            compression[i] += dot(&response[i], &force);
        }
        if needs_rate {
            for i in 0..Q {
                rate[i] = (basis.slope_from_start[i] * given.start_compression
                    + dot(&basis.slope_from_nodes[i], &compression))
                    / given.h;
            }
        }
        let mut jacobian = [[0.0; Q]; Q];
        let mut defect = [0.0; Q];
        for i in 0..Q {
            let value = law.force(branch, compression[i], rate[i]);
            defect[i] = value.force_n - force[i];
            for j in 0..Q {
                jacobian[i][j] = -value.per_compression_n_m * response[i][j];
            }
            if value.per_rate_n_s_m != 0.0 {
                let drag = value.per_rate_n_s_m / given.h;
                for l in 0..Q {
                    let factor = drag * basis.slope_from_nodes[i][l];
                    for j in 0..Q {
                        jacobian[i][j] -= factor * response[l][j];
                    }
                }
            }
            jacobian[i][i] += 1.0;
        }
        counts.newton_iterations += 1;
        counts.law_evaluations += Q as u64;
        let change = solve(jacobian, defect)?;
        let (mut largest, mut size) = (0.0f64, 0.0f64);
        for i in 0..Q {
            force[i] += change[i];
            largest = largest.max(change[i].abs());
            size = size.max(force[i].abs());
        }
        if !largest.is_finite() {
            return None;
        }
        // quadratic convergence: a change of 1e-8 leaves an error near 1e-16
        if largest <= 1e-8 * size || size < f64::MIN_POSITIVE {
            let mut compression = given.free;
            for i in 0..Q {
                compression[i] += dot(&response[i], &force);
            }
            return Some(Collocated { force, compression, rate });
        }
    }
    None
}

/// Solves a small dense system by elimination with row pivoting; `None` if it is singular.
fn solve(mut a: Matrix, mut b: Nodal) -> Option<Nodal> {
    for column in 0..Q {
        let mut pivot = column;
        for row in column + 1..Q {
            if a[row][column].abs() > a[pivot][column].abs() {
                pivot = row;
            }
        }
        if !(a[pivot][column].abs() > 0.0) {
            return None;
        }
        a.swap(column, pivot);
        b.swap(column, pivot);
        let (upper, lower) = a.split_at_mut(column + 1);
        let top = &upper[column];
        let inverse = 1.0 / top[column];
        for (offset, row) in lower.iter_mut().enumerate() {
            let factor = row[column] * inverse;
            for j in column + 1..Q {
                row[j] -= factor * top[j];
            }
            b[column + 1 + offset] -= factor * b[column];
        }
    }
    for row in (0..Q).rev() {
        let mut value = b[row];
        for j in row + 1..Q {
            value -= a[row][j] * b[j];
        }
        b[row] = value / a[row][row];
    }
    Some(b)
}

/// The first place on a step where a branch ends: which of its boundaries, and the fraction of the step at which a
/// straight line through the neighbouring points puts it. Compression and rate are looked at at the nodes, and at the
/// end of the step where that is given.
pub(crate) fn first_crossing(
    boundaries: &[Boundary; 2],
    step: &Collocated,
    start: (f64, f64),
    end: Option<(f64, f64)>,
    h: f64,
) -> Option<(usize, f64)> {
    let nodes = &BASIS.nodes;
    let mut first: Option<(usize, f64)> = None;
    for (which, boundary) in boundaries.iter().enumerate() {
        if *boundary == Boundary::NEVER {
            continue;
        }
        // rounding of the interpolated rate must not look like a crossing where a branch begins on its boundary
        let size = step.compression.iter().fold(start.0.abs(), |a, b| a.max(b.abs()));
        let noise = 1e-15 * size * (boundary.per_compression.abs() + 50.0 * boundary.per_rate.abs() / h);
        let (mut before, mut inside) = (0.0, boundary.margin(start.0, start.1).max(0.0));
        let at_nodes = (0..Q).map(|i| (nodes[i], step.compression[i], step.rate[i]));
        for (at, xi, rate) in at_nodes.chain(end.map(|(xi, rate)| (1.0, xi, rate))) {
            let margin = boundary.margin(xi, rate);
            if margin < -noise {
                let place = before + (at - before) * inside / (inside - margin);
                if first.is_none_or(|(_, earlier)| place < earlier) {
                    first = Some((which, place));
                }
                break;
            }
            (before, inside) = (at, margin.max(0.0));
        }
    }
    first
}
