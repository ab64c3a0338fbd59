//! The equations of one panel, and Newton's method for them.

use super::panel::hertz;
use super::problem::NODES;
use super::rule::dot;

/// `x_i + sum_j m_ij f(x_j) = known_i` with `f = x_+^(3/2)`, and memory for its solution, reused from panel to panel.
#[derive(Debug, Default)]
pub(super) struct Equations {
    /// `m`, a row for each node and one more for the end of the panel.
    pub matrix: Vec<f64>,
    /// Right-hand side at the nodes and at the end.
    pub known: Vec<f64>,
    lu: Vec<f64>,
    pivots: Vec<f64>,
    step: Vec<f64>,
    f: Vec<f64>,
}

impl Equations {
    /// Solves at the nodes from the guess in `x`, until the correction is below `rest` of the largest value or below rounding.
    /// Returns whether it converged.
    pub fn solve(&mut self, x: &mut [f64], rest: f64) -> bool {
        let p = x.len();
        self.step.resize(p, 0.0);
        let mut last = f64::INFINITY;
        let mut factors_serve = false;
        for _ in 0..60 {
            self.f.clear();
            self.f.extend(x.iter().map(|&x| hertz(x)));
            let mut scale = 0.0_f64;
            for (((step, row), &known), &x) in
                self.step.iter_mut().zip(self.matrix.chunks_exact(p)).zip(&self.known).zip(&*x)
            {
                *step = known - x - dot(row, &self.f);
                scale = scale.max(x.abs()).max(known.abs());
            }
            if !factors_serve && !self.factor(x) {
                return false;
            }
            self.substitute();
            let size = self.step.iter().fold(0.0_f64, |size, s| size.max(s.abs()));
            if !size.is_finite() {
                return false;
            }
            for (x, step) in x.iter_mut().zip(&self.step) {
                *x += step;
            }
            // the next correction at the present rate of convergence
            let next = if last.is_finite() { size * (size / last).min(1.0) } else { size };
            if next <= rest.max(1e-16) * scale || (size < 1e-13 * scale && size > 0.3 * last) {
                return true;
            }
            // close to the solution the factors are reused
            factors_serve = size < 0.1 * scale && size < 0.2 * last;
            last = size;
        }
        false
    }

    /// The solution at the end of the panel, from the forces at the nodes.
    pub fn end(&self, f: &[f64]) -> f64 {
        self.known[f.len()] - dot(&self.matrix[f.len() * f.len()..], f)
    }

    /// LU factors of the derivative at `x`, without exchange of rows: the identity plus a Volterra operator with
    /// positive kernel, whose pivots stay away from zero.
    fn factor(&mut self, x: &[f64]) -> bool {
        let p = x.len();
        self.f.clear();
        self.f.extend(x.iter().map(|&x| 1.5 * x.max(0.0).sqrt()));
        // rows in whole blocks, which the compiler can vectorise without a remainder
        let width = p.next_multiple_of(BLOCK);
        self.lu.clear();
        for (i, row) in self.matrix.chunks_exact(p).take(p).enumerate() {
            self.lu.extend(row.iter().zip(&self.f).map(|(m, slope)| m * slope));
            self.lu[i * width + i] += 1.0;
            self.lu.resize((i + 1) * width, 0.0);
        }
        self.pivots.clear();
        for k in 0..p {
            let (head, tail) = self.lu.split_at_mut((k + 1) * width);
            let pivot = head[k * width + k];
            if pivot.abs() < 1e-8 || pivot.is_nan() {
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
        let (b, p) = (&mut self.step, self.pivots.len());
        let rows = self.lu.chunks_exact(p.next_multiple_of(BLOCK));
        for (i, row) in rows.clone().enumerate() {
            b[i] -= dot(&row[..i], &b[..i]);
        }
        for (i, row) in rows.enumerate().rev() {
            b[i] = (b[i] - dot(&row[i + 1..p], &b[i + 1..])) * self.pivots[i];
        }
    }
}

/// Width of the pieces in which rows are treated.
const BLOCK: usize = 4;
