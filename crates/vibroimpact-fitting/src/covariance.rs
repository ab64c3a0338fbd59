//! The covariance of the coordinates from the residuals.

use crate::objective::Objective;
use nalgebra::DMatrix;

impl Objective<'_> {
    /// `s^2 (J^T J)^-1` in the transformed coordinates, with columns scaled to length one before the inversion.
    pub(crate) fn covariance(&self, u: &[f64], sum_of_squares: f64, weights: Option<&[f64]>) -> Option<Vec<f64>> {
        let (m, n) = (self.problem.count, u.len());
        let taking_part = weights.map_or(m, |weights| weights.iter().filter(|w| **w > 0.0).count());
        let freedom = taking_part.checked_sub(n).filter(|&f| f > 0)?;
        let mut rows = vec![0.0; m * n];
        self.jacobian(u, &mut rows);
        let jacobian = DMatrix::from_row_slice(m, n, &rows);
        let lengths: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
        if !lengths.iter().all(|length| *length > 0.0) {
            return None;
        }
        let scaled = DMatrix::from_fn(m, n, |i, j| jacobian[(i, j)] / lengths[j]);
        let factor = (scaled.transpose() * &scaled).cholesky()?;
        // The square of a pivot is the share of a column that is independent of the others.
        if factor.l_dirty().diagonal().iter().any(|pivot| pivot * pivot < 1e-12) {
            return None;
        }
        let inverse = factor.inverse();
        let variance = sum_of_squares / freedom as f64;
        Some((0..n * n).map(|k| variance * inverse[(k / n, k % n)] / (lengths[k / n] * lengths[k % n])).collect())
    }
}
