//! Collocation of the contact force on one step: the only unknowns of an impact.
//!
//! On a step the force is a polynomial. At each Gauss node the law must hold,
//! `F_i = law(xi_i, xi_dot_i)` with `xi = xi_free + (R - c) F`, `R` the structure's and the striker's exact response.
//!
//! The gap `g = xi + c F` is twice smoother than the force, where `xi` behind a compliance that is soft against the
//! contact is as rough as the force itself (`t^(2/3)` at first touch). A law that does not depend on the rate gives it
//! by `xi' = g' / (1 + c F_xi)`, which has the sign of `g'`: a polynomial through `xi` would see reversals that are none.

use super::legendre::{BASIS, Matrix, Nodal, Q, apply, dot, evaluate};
use super::solution::Counts;
use contact_models::{Boundary, Branch, ContactLaw, Force};

/// More iterations than this mean that the step is too long.
const ITERATIONS_MAX: u32 = 16;
/// A ratio of successive changes above this asks for a new matrix.
const SLOW: f64 = 0.1;

/// How exact the compression behind a residual compliance is, relative to the gap: the force that it is computed from
/// is iterated so far, and its rate, a quotient of small differences, is trusted no further.
pub(crate) const BLUR: f64 = 1e-13;

/// What is known before a step's force is.
pub(crate) struct Given<'a> {
    /// Length of the step (s).
    pub h: f64,
    /// Compression at the start (m), and the gap `xi + c F` there (m).
    pub start_compression: f64,
    pub start_gap: f64,
    /// Compression at the nodes if there were no force (m).
    pub free: Nodal,
    /// Compression at the nodes to unit nodal forces (m/N), without the residual compliance.
    pub response: &'a Matrix,
    /// Residual compliance (m/N).
    pub residual_compliance: f64,
    /// Whether the law, or an end of its branch, asks for the rate of compression.
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
    let rate_in_law = law.depends_on_rate();
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
        if rate_in_law {
            rate = slopes(given.start_compression, &compression, given.h);
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
            if given.needs_rate && !rate_in_law {
                let gap = std::array::from_fn(|i| compression[i] + given.residual_compliance * values[i].force_n);
                rate = slopes(given.start_gap, &gap, given.h);
                for i in 0..Q {
                    rate[i] /= 1.0 + given.residual_compliance * values[i].per_compression_n_m;
                }
            }
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

/// Rates at the nodes of a polynomial on a step of `h`, by its values at the start and at the nodes.
pub(crate) fn slopes(start: f64, nodal: &Nodal, h: f64) -> Nodal {
    let basis = &*BASIS;
    std::array::from_fn(|i| (basis.slope_from_start[i] * start + dot(&basis.slope_from_nodes[i], nodal)) / h)
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
        substitute(&self.triangles, &mut b);
        b
    }
}

/// Solves in place with a factored matrix: unit lower and upper triangle in one, by columns, the diagonal inverted.
pub(crate) fn substitute(a: &Matrix, b: &mut Nodal) {
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
}

/// Elimination with half of the pivots, on all rows from the first of them on: of constant number, for the vector
/// units.
pub(crate) fn eliminate<const FROM: usize>(a: &mut Matrix) {
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

/// The first place on a step where a branch ends, by a straight line through the neighbouring points. Compression and
/// rate are looked at at the nodes, between them, and at the end of the step where that is given. Compressions are known
/// to `noise_m`, asked for where that matters, and what lies within is no crossing.
pub(crate) fn first_crossing(
    boundaries: &[Boundary; 2],
    step: &Collocated,
    start: (f64, f64),
    end: Option<(f64, f64)>,
    h: f64,
    noise_m: impl Fn() -> f64,
) -> Option<(usize, f64)> {
    let basis = &*BASIS;
    let mut first: Option<(usize, f64)> = None;
    for (which, boundary) in boundaries.iter().enumerate() {
        if *boundary == Boundary::NEVER {
            continue;
        }
        // rounding of the interpolated rate must not look like a crossing where a branch begins on its boundary
        let noise = || noise_m() * (boundary.per_compression.abs() + 50.0 * boundary.per_rate.abs() / h);
        let (mut before, mut inside) = (0.0, boundary.margin(start.0, start.1).max(0.0));
        let margins: Nodal = std::array::from_fn(|i| boundary.margin(step.compression[i], step.rate[i]));
        let at_nodes = (0..Q).map(|i| (basis.nodes[i], margins[i]));
        let at_end = end.map(|(xi, rate)| (1.0, boundary.margin(xi, rate)));
        let met = at_nodes.chain(at_end).find_map(|(at, margin)| {
            let place = before + (at - before) * inside / (inside - margin);
            (before, inside) = (at, margin.max(0.0));
            (margin < 0.0 && margin < -noise()).then_some(place)
        });
        if let Some(place) = met.or_else(|| dip(&margins, noise))
            && first.is_none_or(|(_, earlier)| place < earlier)
        {
            first = Some((which, place));
        }
    }
    first
}

/// What a polynomial may be missing: its next two coefficients, if they fall as the last two do against the two before.
/// Pairs, because a single coefficient vanishes by accident.
pub(crate) fn truncation(coefficients: &Nodal) -> f64 {
    let last = coefficients[Q - 1].abs().max(coefficients[Q - 2].abs());
    let before = coefficients[Q - 3].abs().max(coefficients[Q - 4].abs());
    if last < before { last * (last / before) } else { last }
}

/// Where a polynomial that is positive at the nodes falls below `-noise()` between them, if it does: the place of the first
/// such dip's least value, by the parabola through three neighbours among nodes and middles.
fn dip(margins: &Nodal, noise: impl Fn() -> f64) -> Option<f64> {
    let range = |(low, high): (f64, f64), margin: &f64| (low.min(*margin), high.max(*margin));
    let (least, largest) = margins.iter().fold((f64::INFINITY, f64::NEG_INFINITY), range);
    // between nodes a polynomial goes beyond its values there by less than their range
    if least > largest - least {
        return None;
    }
    let coefficients = BASIS.coefficients(margins);
    // a Legendre polynomial is 1 at most
    if coefficients[0] > coefficients[1..].iter().map(|c| c.abs()).sum() {
        return None;
    }
    let (nodes, value) = (&BASIS.nodes, |s: f64| (s, evaluate(&coefficients, s)));
    // the ends of the step, the nodes, and the middles between all of them
    let points: [(f64, f64); 2 * Q + 3] = std::array::from_fn(|i| match i {
        0 => value(0.0),
        1 => value(0.5 * nodes[0]),
        i if i == 2 * Q + 1 => value(0.5 * (1.0 + nodes[Q - 1])),
        i if i == 2 * Q + 2 => value(1.0),
        i if i % 2 == 0 => (nodes[i / 2 - 1], margins[i / 2 - 1]),
        i => value(0.5 * (nodes[i / 2 - 1] + nodes[i / 2])),
    });
    points.windows(3).find_map(|three| {
        let [(a, left), (b, middle), (c, right)] = [three[0], three[1], three[2]];
        if !(middle <= left && middle < right) {
            return None;
        }
        // divided differences, and the vertex of the parabola
        let (fall, rise) = ((middle - left) / (b - a), (right - middle) / (c - b));
        let bend = (rise - fall) / (c - a);
        let slope = fall + bend * (b - a);
        let place = b - slope / (2.0 * bend);
        let least = middle - slope * slope / (4.0 * bend);
        (least < 0.0 && least < -noise()).then_some(place)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::array;

    #[test]
    fn a_dip_between_the_nodes_is_seen() {
        // a parabola times a factor that varies, a little above or below zero
        for lowest in [0.3, 0.47, 0.71] {
            let polynomial = |s: f64, at: f64| ((s - lowest) * (s - lowest) + at) * (1.0 + s);
            let above = BASIS.nodes.map(|s| polynomial(s, 3e-4));
            assert_eq!(dip(&above, || 0.0), None);
            let below = BASIS.nodes.map(|s| polynomial(s, -3e-4));
            if below.iter().all(|margin| *margin > 0.0) {
                let place = dip(&below, || 0.0).unwrap();
                assert!((place - lowest).abs() < 0.02, "{place}");
                assert_eq!(dip(&below, || 1e-2), None);
            }
        }
        // falling to the end and rising from the start are no dips
        assert_eq!(dip(&BASIS.nodes, || 0.0), None);
        assert_eq!(dip(&BASIS.nodes.map(|s| 1.0 - s), || 0.0), None);
    }

    #[test]
    fn newtons_matrix_is_solved() {
        let response: Matrix = array::from_fn(|j| array::from_fn(|i| -0.3 / (1.0 + (2 * i + 3 * j) as f64)));
        let given = Given {
            h: 0.5,
            start_compression: 0.0,
            start_gap: 0.0,
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
