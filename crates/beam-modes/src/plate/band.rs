//! Cholesky factorisation of a block tridiagonal matrix.
//!
//! With diagonal blocks `D_t` and the blocks `E_t` below them, `D_t - F_(t-1) F_(t-1)^T = L_t L_t^T` and `F_t = E_t L_t^(-T)`.
//! All operations are products of small dense matrices.

use crate::dense::{cholesky, solve_lower, solve_upper, subtract_product};
use faer::{Mat, MatMut};

/// The factor `L` of `A = L L^T`.
pub(super) struct Factor {
    /// Start of each block, and the size of the matrix.
    starts: Vec<usize>,
    diagonal: Vec<Mat<f64>>,
    below: Vec<Mat<f64>>,
}

impl Factor {
    /// The factor of the matrix with these entries, each given as row, column and value; entries outside of the blocks and
    /// above the diagonal ones are ignored. `None` if the matrix is not positive definite.
    pub fn new(starts: Vec<usize>, entries: impl Iterator<Item = (usize, usize, f64)>) -> Option<Factor> {
        let sizes: Vec<usize> = starts.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let group: Vec<usize> = sizes.iter().enumerate().flat_map(|(t, size)| vec![t; *size]).collect();
        let mut diagonal: Vec<Mat<f64>> = sizes.iter().map(|size| Mat::zeros(*size, *size)).collect();
        let mut below: Vec<Mat<f64>> = sizes.windows(2).map(|pair| Mat::zeros(pair[1], pair[0])).collect();
        for (p, q, value) in entries {
            let (s, t) = (group[p], group[q]);
            if s == t {
                diagonal[t][(p - starts[t], q - starts[t])] += value;
            } else if s == t + 1 {
                below[t][(p - starts[s], q - starts[t])] += value;
            }
        }
        for t in 0..sizes.len() {
            diagonal[t] = cholesky(diagonal[t].as_ref())?;
            if t < below.len() {
                let mut turned = below[t].transpose().to_owned();
                solve_lower(diagonal[t].as_ref(), turned.as_mut());
                below[t] = turned.transpose().to_owned();
                let (here, next) = (&below[t], diagonal[t + 1].as_mut());
                subtract_product(next, here.as_ref(), here.transpose());
            }
        }
        Some(Factor { starts, diagonal, below })
    }

    /// Replaces every column `x` by `L^(-1) x`.
    pub fn solve(&self, mut x: MatMut<'_, f64>) {
        for t in 0..self.diagonal.len() {
            let (before, after) = x.as_mut().split_at_row_mut(self.starts[t]);
            let mut here = after.subrows_mut(0, self.starts[t + 1] - self.starts[t]);
            if t > 0 {
                let last = before.as_ref().subrows(self.starts[t - 1], self.starts[t] - self.starts[t - 1]);
                subtract_product(here.as_mut(), self.below[t - 1].as_ref(), last);
            }
            solve_lower(self.diagonal[t].as_ref(), here);
        }
    }

    /// Replaces every column `x` by `L^(-T) x`.
    pub fn solve_transposed(&self, mut x: MatMut<'_, f64>) {
        for t in (0..self.diagonal.len()).rev() {
            let (before, after) = x.as_mut().split_at_row_mut(self.starts[t + 1]);
            let mut here = before.subrows_mut(self.starts[t], self.starts[t + 1] - self.starts[t]);
            if t < self.below.len() {
                let next = after.as_ref().subrows(0, self.starts[t + 2] - self.starts[t + 1]);
                subtract_product(here.as_mut(), self.below[t].transpose(), next);
            }
            solve_upper(self.diagonal[t].transpose(), here);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares `A x` with the right-hand side, for a matrix with blocks of three sizes.
    #[test]
    fn a_solution_solves() {
        let entry = |p: usize, q: usize| if p == q { 4.0 + p as f64 } else { 1.0 / (1.0 + p as f64 + q as f64) };
        let starts = vec![0, 1, 4, 6];
        let group = |p: usize| starts.iter().filter(|start| **start <= p).count();
        let within = |p: usize, q: usize| group(p).abs_diff(group(q)) <= 1;
        let pairs = (0..6).flat_map(|p| (0..6).map(move |q| (p, q))).filter(|(p, q)| within(*p, *q));
        let entries: Vec<(usize, usize, f64)> = pairs.map(|(p, q)| (p, q, entry(p, q))).collect();
        let factor = Factor::new(starts.clone(), entries.iter().copied()).unwrap();
        let right = Mat::from_fn(6, 2, |p, k| (p * p) as f64 - 3.0 * k as f64);
        let mut x = right.clone();
        factor.solve(x.as_mut());
        factor.solve_transposed(x.as_mut());
        for k in 0..2 {
            for p in 0..6 {
                let sum: f64 =
                    entries.iter().filter(|(row, ..)| *row == p).map(|(_, q, value)| value * x[(*q, k)]).sum();
                assert!((sum - right[(p, k)]).abs() < 1e-13, "{p} {k}: {sum}");
            }
        }
    }

    #[test]
    fn an_indefinite_matrix_has_no_factor() {
        assert!(Factor::new(vec![0, 1, 2], [(0, 0, 1.0), (1, 0, 2.0), (1, 1, 1.0)].into_iter()).is_none());
    }
}
