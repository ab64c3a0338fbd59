//! The equations of one panel, and Newton's method for them.

use super::law::{Force, Scaled};
use super::problem::NODES;
use super::rule::dot;
use contact_models::Branch;

/// Most steps of Newton's method.
const MOST_STEPS: usize = 60;
/// Width of the pieces in which rows are treated.
const BLOCK: usize = 4;
/// Below this size a pivot counts as zero.
const LEAST_PIVOT: f64 = 1e-8;

/// Why a panel has no solution.
pub(super) enum Fault {
    /// Newton's method did not converge: the panel is too long.
    NotConverged,
    /// The law gave no number.
    Law,
}

/// `known - weights f`, with a row for each node and a last one for the end of the panel.
#[derive(Debug, Default)]
pub(super) struct Affine {
    pub known: Vec<f64>,
    pub weights: Vec<f64>,
}

impl Affine {
    /// Sets the values under these forces. Returns their largest change, relative to the largest of the values and known terms.
    fn evaluate(&self, force: &[f64], values: &mut [f64]) -> f64 {
        let (mut change, mut scale) = (0.0_f64, f64::MIN_POSITIVE);
        let rows = self.weights.chunks_exact(force.len());
        for ((value, known), row) in values.iter_mut().zip(&self.known).zip(rows) {
            let new = known - dot(row, force);
            change = change.max((new - *value).abs());
            scale = scale.max(new.abs()).max(known.abs());
            *value = new;
        }
        change / scale
    }
}

/// The motion on a panel, at the nodes and, last, at its end.
#[derive(Debug, Default)]
pub(super) struct Nodal {
    /// Compression.
    pub x: Vec<f64>,
    /// Its rate; zeros where the law does not ask for it.
    pub rate: Vec<f64>,
    /// Force at the nodes.
    pub force: Vec<f64>,
}

/// `f = law(x, x')` with `x` and `x'` that are affine in the nodal forces, and memory for its solution, reused from panel to
/// panel.
#[derive(Debug, Default)]
pub(super) struct Equations {
    pub x: Affine,
    /// Empty if neither the force nor a boundary of the branch depends on the rate.
    pub rate: Affine,
    forces: Vec<Force>,
    change: Vec<f64>,
    lu: Vec<f64>,
    pivots: Vec<f64>,
}

impl Equations {
    /// Solves from a guess of `x` and `x'` in `nodal`, until the change of the motion that is still to come is below `rest` of its
    /// largest terms or below rounding. Close to the solution the factors of the matrix serve again.
    pub fn solve(&mut self, law: &Scaled<'_>, branch: &Branch, rest: f64, nodal: &mut Nodal) -> Result<(), Fault> {
        let p = nodal.force.len();
        let (mut last, mut factors_serve) = (f64::INFINITY, false);
        for step in 0..MOST_STEPS {
            self.forces.clear();
            self.forces.extend(nodal.x.iter().zip(&nodal.rate).take(p).map(|(&x, &rate)| law.force(branch, x, rate)));
            if !self.forces.iter().all(Force::is_finite) {
                return Err(Fault::Law);
            }
            if !factors_serve && !self.factor() {
                return Err(Fault::NotConverged);
            }
            self.change.clear();
            let residual = (0..p).map(|i| {
                let Force { force, stiffness, damping } = self.forces[i];
                match step {
                    // the guess need not be the motion under the forces before it
                    0 => {
                        let rate = self.rate.known.get(i).map_or(0.0, |known| damping * (known - nodal.rate[i]));
                        force + stiffness * (self.x.known[i] - nodal.x[i]) + rate
                    }
                    _ => force - nodal.force[i],
                }
            });
            self.change.extend(residual);
            self.substitute();
            nodal.force.iter_mut().zip(&self.change).for_each(|(force, step)| *force += step);
            if !nodal.force.iter().all(|force| force.is_finite()) {
                return Err(Fault::NotConverged);
            }
            let change =
                self.x.evaluate(&nodal.force, &mut nodal.x).max(self.rate.evaluate(&nodal.force, &mut nodal.rate));
            // the next change at the present rate of convergence
            let next = if last.is_finite() { change * (change / last).min(1.0) } else { change };
            // converged, or as far as rounding lets the steps shrink
            if next <= rest.max(1e-16) || (change < 1e-13 && change > 0.3 * last) {
                return Ok(());
            }
            factors_serve = change < 0.1 && change < 0.2 * last;
            last = change;
        }
        Err(Fault::NotConverged)
    }

    /// LU factors of the derivative at the present forces, without exchange of rows: the identity plus a Volterra operator, with
    /// positive kernel unless the law is falling, whose pivots stay away from zero on a short panel.
    fn factor(&mut self) -> bool {
        let p = self.forces.len();
        // rows in whole blocks, which the compiler can vectorise without a remainder
        let width = p.next_multiple_of(BLOCK);
        self.lu.clear();
        for (i, (force, row)) in self.forces.iter().zip(self.x.weights.chunks_exact(p)).enumerate() {
            self.lu.extend(row.iter().map(|w| force.stiffness * w));
            if let Some(row) = self.rate.weights.chunks_exact(p).nth(i) {
                self.lu[i * width..].iter_mut().zip(row).for_each(|(sum, w)| *sum += force.damping * w);
            }
            self.lu[i * width + i] += 1.0;
            self.lu.resize((i + 1) * width, 0.0);
        }
        self.pivots.clear();
        for k in 0..p {
            let (head, tail) = self.lu.split_at_mut((k + 1) * width);
            let pivot = head[k * width + k];
            if pivot.abs() < LEAST_PIVOT || !pivot.is_finite() {
                return false;
            }
            let inverse = 1.0 / pivot;
            self.pivots.push(inverse);
            // the row right of the pivot, with zeros before it that fill a whole block
            let from = (k + 1) / BLOCK * BLOCK;
            let mut row = [0.0; *NODES.end()];
            row[k + 1..p].copy_from_slice(&head[k * width + k + 1..k * width + p]);
            let row = &row[from..width];
            for below in tail.chunks_exact_mut(width) {
                let l = below[k] * inverse;
                below[k] = l;
                for (b, r) in below[from..].as_chunks_mut::<BLOCK>().0.iter_mut().zip(row.as_chunks::<BLOCK>().0) {
                    *b = std::array::from_fn(|i| b[i] - l * r[i]);
                }
            }
        }
        true
    }

    fn substitute(&mut self) {
        let (b, p) = (&mut self.change, self.pivots.len());
        let rows = self.lu.chunks_exact(p.next_multiple_of(BLOCK));
        for (i, row) in rows.clone().enumerate() {
            b[i] -= dot(&row[..i], &b[..i]);
        }
        for (i, row) in rows.enumerate().rev() {
            b[i] = (b[i] - dot(&row[i + 1..p], &b[i + 1..])) * self.pivots[i];
        }
    }

    /// The largest stiffness met in the last solution.
    pub fn stiffness(&self) -> f64 {
        self.forces.iter().fold(0.0, |largest, force| largest.max(force.stiffness.abs()))
    }

    /// What independent errors of compression and rate at each node make of a sum of the forces that were solved last, with
    /// these weights.
    pub fn rounding(&self, weights: &[f64], [x, rate]: [f64; 2]) -> f64 {
        let p = self.pivots.len();
        let mut share = [0.0; *NODES.end()];
        let share = &mut share[..p];
        share.copy_from_slice(weights);
        // the transposed equations, by the same factors
        let rows = self.lu.chunks_exact(p.next_multiple_of(BLOCK));
        for (i, row) in rows.clone().enumerate() {
            share[i] *= self.pivots[i];
            for j in i + 1..p {
                share[j] -= row[j] * share[i];
            }
        }
        for (i, row) in rows.enumerate().rev() {
            for j in 0..i {
                share[j] -= row[j] * share[i];
            }
        }
        let error = |(share, force): (&f64, &Force)| share * (force.stiffness.abs() * x + force.damping.abs() * rate);
        share.iter().zip(&self.forces).map(error).fold(0.0, f64::hypot)
    }
}
