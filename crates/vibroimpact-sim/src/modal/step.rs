//! Collocation of the contact force on one step: the only unknowns of an impact.
//!
//! On a step the force is a polynomial. At each Gauss node the law must hold,
//! `F_i = law(xi_i, xi_dot_i)` with `xi = xi_free + (R - c) F`, `R` the structure's and the striker's exact response.

use super::legendre::{BASIS, Matrix, Nodal, Q, apply, dot};
use super::solution::Counts;
use contact_models::{Boundary, Branch, ContactLaw, Force};

/// More iterations than this mean that the step is too long.
const ITERATIONS_MAX: u32 = 16;
/// A ratio of successive changes above this asks for a new matrix.
const SLOW: f64 = 0.1;

/// How exact the compression behind a residual compliance is, relative to the gap: the force that it is computed from
/// is iterated so far, and its rate, a quotient of small differences, is trusted no further.
const BLUR: f64 = 1e-13;

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
    /// Whether the branch asks for the rate of compression.
    pub needs_rate: bool,
    /// How well the force is wanted (N).
    pub accuracy: f64,
}

/// A solved step.
#[derive(Clone, Copy)]
pub(crate) struct Collocated {
    /// Force (N), compression (m) and rate (m/s; zero unless asked for) at the nodes.
    pub force: Nodal,
    pub compression: Nodal,
    pub rate: Nodal,
}

/// Solves the law at the nodes; `None` if the iteration does not converge. Newton's matrix is kept from one iteration
/// to the next while that converges fast.
pub(crate) fn collocate<L: ContactLaw>(
    law: &L,
    branch: &Branch,
    given: &Given,
    guess: Nodal,
    counts: &mut Counts,
) -> Option<Collocated> {
    let basis = &*BASIS;
    let mut accuracy = given.accuracy;
    if given.needs_rate && given.residual_compliance > 0.0 {
        let gap = given.free.iter().fold(0.0f64, |a, b| a.max(b.abs()));
        accuracy = accuracy.min(BLUR * gap / given.residual_compliance);
    }
    let mut force = guess;
    let mut rate = [0.0; Q];
    let (mut newton, mut current) = (Newton { triangles: [[0.0; Q]; Q] }, false);
    let mut last_change = f64::INFINITY;
    for _ in 0..ITERATIONS_MAX {
        let mut compression = apply(given.response, &force);
        for i in 0..Q {
            compression[i] += given.free[i] - given.residual_compliance * force[i];
        }
        if given.needs_rate {
            for i in 0..Q {
                rate[i] = (basis.slope_from_start[i] * given.start_compression
                    + dot(&basis.slope_from_nodes[i], &compression))
                    / given.h;
            }
        }
        let values: [Force; Q] = std::array::from_fn(|i| law.force(branch, compression[i], rate[i]));
        counts.newton_iterations += 1;
        counts.law_evaluations += Q as u64;
        let defect: Nodal = std::array::from_fn(|i| values[i].force_n - force[i]);
        if !current {
            newton.factor(given, &values);
            current = true;
        }
        let change = newton.solve(defect);
        let (mut largest, mut size) = (0.0f64, 0.0f64);
        for i in 0..Q {
            force[i] += change[i];
            largest = largest.max(change[i].abs());
            size = size.max(force[i].abs());
        }
        // a sum passes on what is not a number, the maxima do not
        if !force.iter().sum::<f64>().is_finite() {
            return None;
        }
        // with the matrix kept, changes shrink by a steady ratio, which tells what is still missing
        let ratio = if last_change.is_finite() { largest / last_change } else { 1.0 };
        if ratio * largest <= accuracy || largest <= 1e-15 * size {
            return Some(Collocated { force, compression, rate });
        }
        let first = !last_change.is_finite();
        last_change = largest;
        if ratio > SLOW && !first {
            current = false;
        }
    }
    None
}

/// Newton's matrix `1 - F_xi (R - c) - F_rate D (R - c)`, factored. Its off-diagonal part is of the order of
/// `(h omega)^2` with `omega` the contact's own frequency, so that elimination needs no pivoting.
struct Newton {
    /// Unit lower and upper triangle in one, by columns, the diagonal inverted.
    triangles: Matrix,
}

impl Newton {
    fn factor(&mut self, given: &Given, values: &[Force; Q]) {
        let a = &mut self.triangles;
        let stiffness = values.map(|value| value.per_compression_n_m);
        for j in 0..Q {
            for i in 0..Q {
                a[j][i] = -stiffness[i] * given.response[j][i];
            }
            a[j][j] += 1.0 + stiffness[j] * given.residual_compliance;
        }
        if values.iter().any(|value| value.per_rate_n_s_m != 0.0) {
            let drag = values.map(|value| value.per_rate_n_s_m / given.h);
            for j in 0..Q {
                for i in 0..Q {
                    a[j][i] -= drag[i] * dot(&BASIS.slope_from_nodes[i], &given.response[j]);
                    a[j][i] += drag[i] * BASIS.slope_from_nodes[i][j] * given.residual_compliance;
                }
            }
        }
        eliminate::<0>(a);
        eliminate::<{ Q / 2 }>(a);
    }

    fn solve(&self, mut b: Nodal) -> Nodal {
        let a = &self.triangles;
        for j in 0..Q {
            for i in j + 1..Q {
                b[i] -= a[j][i] * b[j];
            }
        }
        for j in (0..Q).rev() {
            b[j] *= a[j][j];
            for i in 0..j {
                b[i] -= a[j][i] * b[j];
            }
        }
        b
    }
}

/// Elimination with half of the pivots, on all rows from the first of them on: of constant number, for the vector
/// units.
fn eliminate<const FROM: usize>(a: &mut Matrix) {
    for pivot in FROM..FROM + Q / 2 {
        let inverse = 1.0 / a[pivot][pivot];
        let mut below = [0.0; Q];
        for i in pivot + 1..Q {
            below[i] = a[pivot][i] * inverse;
            a[pivot][i] = below[i];
        }
        for column in &mut a[pivot + 1..] {
            let factor = column[pivot];
            for i in FROM..Q {
                column[i] -= factor * below[i];
            }
        }
        a[pivot][pivot] = inverse;
    }
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
    residual_compliance: f64,
) -> Option<(usize, f64)> {
    let nodes = &BASIS.nodes;
    let mut first: Option<(usize, f64)> = None;
    for (which, boundary) in boundaries.iter().enumerate() {
        let at_nodes = || (0..Q).map(|i| (nodes[i], step.compression[i], step.rate[i]));
        let places = || at_nodes().chain(end.map(|(xi, rate)| (1.0, xi, rate)));
        if *boundary == Boundary::NEVER || places().all(|(_, xi, rate)| boundary.margin(xi, rate) >= 0.0) {
            continue;
        }
        // rounding of the interpolated rate must not look like a crossing where a branch begins on its boundary
        let size = step.compression.iter().fold(start.0.abs(), |a, b| a.max(b.abs()));
        let pressed = step.force.iter().fold(0.0f64, |a, b| a.max(b.abs())) * residual_compliance;
        let noise =
            (1e-15 * size + BLUR * pressed) * (boundary.per_compression.abs() + 50.0 * boundary.per_rate.abs() / h);
        let (mut before, mut inside) = (0.0, boundary.margin(start.0, start.1).max(0.0));
        for (at, xi, rate) in places() {
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::array;

    #[test]
    fn newtons_matrix_is_solved() {
        let response: Matrix = array::from_fn(|j| array::from_fn(|i| -0.3 / (1.0 + (2 * i + 3 * j) as f64)));
        let given = Given {
            h: 0.5,
            start_compression: 0.0,
            free: [0.0; Q],
            response: &response,
            residual_compliance: 0.01,
            needs_rate: true,
            accuracy: 0.0,
        };
        for drag in [0.0, 1e-3] {
            let value = |i| Force { force_n: 0.0, per_compression_n_m: 1.0 + i as f64, per_rate_n_s_m: drag };
            let values: [Force; Q] = array::from_fn(value);
            let b: Nodal = array::from_fn(|i| 1.0 / (1.0 + i as f64));
            let mut newton = Newton { triangles: [[0.0; Q]; Q] };
            newton.factor(&given, &values);
            let x = newton.solve(b);
            // x - F_xi y - F_rate D y with y = (R - c) x
            let mut y = apply(&response, &x);
            for i in 0..Q {
                y[i] -= given.residual_compliance * x[i];
            }
            for i in 0..Q {
                let slope = dot(&BASIS.slope_from_nodes[i], &y) / given.h;
                let left = x[i] - values[i].per_compression_n_m * y[i] - drag * slope;
                assert!((left - b[i]).abs() < 1e-13, "{drag} {i}: {left} {}", b[i]);
            }
        }
    }
}
