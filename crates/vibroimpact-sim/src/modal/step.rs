//! Collocation of the contact force on one step: the only unknowns of an impact.
//!
//! On a step the force is a polynomial. At each Gauss node the law must hold,
//! `F_i = law(xi_i, xi_dot_i)` with `xi = xi_free + (R - c) F`, `R` the structure's and the striker's exact response.

use super::legendre::{BASIS, Matrix, Nodal, Q, dot};
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
    let mut newton: Option<Newton> = None;
    let mut last_change = f64::INFINITY;
    for _ in 0..ITERATIONS_MAX {
        let mut compression = given.free;
        for i in 0..Q {
            compression[i] += dot(&given.response[i], &force) - given.residual_compliance * force[i];
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
        let change = newton.get_or_insert_with(|| Newton::new(given, &values)).solve(defect);
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
            newton = None;
        }
    }
    None
}

/// Newton's matrix `1 - F_xi (R - c) - F_rate D (R - c)`, factored. Its off-diagonal part is of the order of
/// `(h omega)^2` with `omega` the contact's own frequency, so that elimination needs no pivoting.
struct Newton {
    /// Unit lower and upper triangle in one, the diagonal inverted.
    triangles: Matrix,
}

impl Newton {
    fn new(given: &Given, values: &[Force; Q]) -> Newton {
        let mut a = [[0.0; Q]; Q];
        for i in 0..Q {
            let stiffness = values[i].per_compression_n_m;
            for j in 0..Q {
                a[i][j] = -stiffness * given.response[i][j];
            }
            a[i][i] += 1.0 + stiffness * given.residual_compliance;
            if values[i].per_rate_n_s_m != 0.0 {
                let drag = values[i].per_rate_n_s_m / given.h;
                for l in 0..Q {
                    let factor = drag * BASIS.slope_from_nodes[i][l];
                    for j in 0..Q {
                        a[i][j] -= factor * given.response[l][j];
                    }
                    a[i][l] += factor * given.residual_compliance;
                }
            }
        }
        for column in 0..Q {
            let inverse = 1.0 / a[column][column];
            let top = a[column];
            for row in column + 1..Q {
                let factor = a[row][column] * inverse;
                for j in column + 1..Q {
                    a[row][j] -= factor * top[j];
                }
                a[row][column] = factor;
            }
            a[column][column] = inverse;
        }
        Newton { triangles: a }
    }

    fn solve(&self, mut b: Nodal) -> Nodal {
        let a = &self.triangles;
        for row in 1..Q {
            for j in 0..row {
                b[row] -= a[row][j] * b[j];
            }
        }
        for row in (0..Q).rev() {
            for j in row + 1..Q {
                b[row] -= a[row][j] * b[j];
            }
            b[row] *= a[row][row];
        }
        b
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
        if *boundary == Boundary::NEVER {
            continue;
        }
        // rounding of the interpolated rate must not look like a crossing where a branch begins on its boundary
        let size = step.compression.iter().fold(start.0.abs(), |a, b| a.max(b.abs()));
        let pressed = step.force.iter().fold(0.0f64, |a, b| a.max(b.abs())) * residual_compliance;
        let noise =
            (1e-15 * size + BLUR * pressed) * (boundary.per_compression.abs() + 50.0 * boundary.per_rate.abs() / h);
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
