//! The information of observations about parameters: covariance, undetermined directions, further observations.
//!
//! With `J` the Jacobian of residuals of unit variance in the coordinates `u`,
//!
//! ```text
//! M = J^T J,        C = M^-1,        M v_k = v_k / s_k^2.
//! ```
//!
//! Along the unit vector `v_k` the coordinates have the standard deviation `s_k`: if it is large, the observations do not
//! determine this combination. A further observation with the row `a` of its Jacobian gives `M + a^T a`, and the volume of the
//! confidence region shrinks by `sqrt(det M / det(M + a^T a))`.

use invalid_input::InvalidInput;
use nalgebra::DMatrix;

/// An information along a direction below this share of what the observations would contain if they measured each coordinate by itself
/// counts as rounding. The share does not depend on the units of the coordinates.
const ROUNDING: f64 = 1e-14;
/// Part of a unit vector, along a direction that is not determined, that counts as rounding.
const NO_PART: f64 = 1e-7;
/// Largest magnitude whose square is a number, and the inverse.
const LARGEST: f64 = 1e150;
/// Largest number of sweeps of Jacobi's method, which needs fewer than ten.
const SWEEPS: usize = 60;

/// The information `M = J^T J` of observations about coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Information {
    matrix: DMatrix<f64>,
}

/// A direction in the space of the coordinates, and how well the observations determine it.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Direction {
    /// Unit vector; its largest entry is positive.
    pub vector: Vec<f64>,
    /// Standard deviation along it; infinite if the observations contain no information.
    pub standard_deviation: f64,
}

impl Information {
    /// The information from the Jacobian of residuals of unit variance, row by row, in `n` coordinates.
    ///
    /// # Errors
    /// There is no coordinate, the rows are not a multiple of `n` numbers, or a number is not finite.
    ///
    /// ```
    /// // two readings of the sum of two coordinates contain no information about their difference
    /// let readings = fitting::Information::of(&[1.0, 1.0, 1.0, 1.0], 2)?;
    /// let directions = readings.directions();
    /// assert!(directions[0].standard_deviation.is_infinite());
    /// assert!((directions[1].standard_deviation - 0.5).abs() < 1e-12);
    /// assert!(readings.covariance().is_none());
    /// # Ok::<(), fitting::InvalidInput>(())
    /// ```
    pub fn of(rows: &[f64], n: usize) -> Result<Information, InvalidInput> {
        if n == 0 || !rows.len().is_multiple_of(n) {
            let allowed =
                "a number of entries that gives each row one number for each coordinate, with at least one coordinate";
            return Err(InvalidInput::new(["rows", "len()"], rows.len(), allowed));
        }
        if let Some(entry) = rows.iter().find(|entry| entry.is_nan() || entry.abs() >= LARGEST) {
            return Err(InvalidInput::new("rows", *entry, "a list of numbers of magnitude below 1e150"));
        }
        let jacobian = DMatrix::from_row_slice(rows.len() / n, n, rows);
        Ok(Information { matrix: jacobian.transpose() * jacobian })
    }

    /// The same with a normal prior on each coordinate, given by its standard deviation. Without a positive standard deviation
    /// there is no prior; one below 1e-150 counts as 1e-150.
    #[must_use]
    pub fn with_prior(mut self, standard_deviations: &[f64]) -> Information {
        for (j, sd) in standard_deviations.iter().enumerate().take(self.matrix.nrows()) {
            if *sd > 0.0 {
                self.matrix[(j, j)] += sd.max(LARGEST.recip()).powi(-2);
            }
        }
        self
    }

    /// The information with further rows, which must have as many numbers each.
    ///
    /// # Errors
    /// As [`Information::of`].
    pub fn with_rows(&self, rows: &[f64]) -> Result<Information, InvalidInput> {
        let further = Information::of(rows, self.matrix.nrows())?;
        Ok(Information { matrix: &self.matrix + further.matrix })
    }

    /// The information about some of the coordinates if the others are unknown too, `M_aa - M_ab M_bb^-1 M_ba`; `None` if these
    /// coordinates do not exist. Combinations of the others that the observations do not contain take no information away.
    ///
    /// ```
    /// // a reading of the sum of all three coordinates, and one of the third
    /// let readings = fitting::Information::of(&[1.0, 1.0, 1.0, 0.0, 0.0, 1.0], 3)?;
    /// let first_two = readings.about(&[0, 1]).unwrap();
    /// // their sum has a variance of 2, and along the unit vector half of it
    /// assert!((first_two.directions()[1].standard_deviation - 1.0).abs() < 1e-12);
    /// # Ok::<(), fitting::InvalidInput>(())
    /// ```
    pub fn about(&self, members: &[usize]) -> Option<Information> {
        let n = self.matrix.nrows();
        if members.is_empty() || members.iter().any(|member| *member >= n) {
            return None;
        }
        let others: Vec<usize> = (0..n).filter(|j| !members.contains(j)).collect();
        let part = |rows: &[usize], columns: &[usize]| self.matrix.select_rows(rows).select_columns(columns);
        let mut about = part(members, members);
        let both = part(members, &others);
        for direction in (Information { matrix: part(&others, &others) }).directions() {
            if direction.standard_deviation.is_finite() {
                let along = &both * DMatrix::from_vec(others.len(), 1, direction.vector) * direction.standard_deviation;
                about -= &along * along.transpose();
            }
        }
        Some(Information { matrix: about })
    }

    /// The directions that the observations determine independently, the least certain first.
    pub fn directions(&self) -> Vec<Direction> {
        let n = self.matrix.nrows();
        let (values, vectors) = eigen(&self.matrix);
        let mut found: Vec<Direction> = values
            .into_iter()
            .zip(vectors)
            .map(|(value, vector)| {
                let leading = vector.iter().copied().fold(0.0f64, |a, b| if b.abs() > a.abs() { b } else { a });
                let sign = if leading < 0.0 { -1.0 } else { 1.0 };
                let by_themselves: f64 = (0..n).map(|j| vector[j] * vector[j] * self.matrix[(j, j)]).sum();
                let known = value > ROUNDING * by_themselves && value > 0.0;
                let standard_deviation = if known { value.sqrt().recip() } else { f64::INFINITY };
                Direction { vector: vector.iter().map(|entry| sign * entry).collect(), standard_deviation }
            })
            .collect();
        found.sort_by(|a, b| b.standard_deviation.total_cmp(&a.standard_deviation));
        found
    }

    /// The covariance `C`, row by row; `None` if a direction is not determined.
    pub fn covariance(&self) -> Option<Vec<f64>> {
        let directions = self.directions();
        if directions.iter().any(|direction| direction.standard_deviation.is_infinite()) {
            return None;
        }
        let n = self.matrix.nrows();
        let entry = |i: usize, j: usize| -> f64 {
            directions.iter().map(|d| d.standard_deviation.powi(2) * d.vector[i] * d.vector[j]).sum()
        };
        Some((0..n * n).map(|k| entry(k / n, k % n)).collect())
    }

    /// Standard deviation of each coordinate if the others are unknown too; infinite if it is not determined.
    pub fn standard_deviations(&self) -> Vec<f64> {
        let n = self.matrix.nrows();
        let directions = self.directions();
        (0..n).map(|j| spread(&directions, |direction| direction.vector[j], 1.0)).collect()
    }

    /// Standard deviation of a linear prediction `row . u`; infinite if it is not determined.
    ///
    /// ```
    /// // the sum that was read is known, although neither coordinate is
    /// let readings = fitting::Information::of(&[0.1, 0.3, 0.1, 0.3], 2)?;
    /// assert!((readings.of_prediction(&[0.1, 0.3]) - 0.5f64.sqrt()).abs() < 1e-12);
    /// assert!(readings.of_prediction(&[1.0, 0.0]).is_infinite());
    /// # Ok::<(), fitting::InvalidInput>(())
    /// ```
    pub fn of_prediction(&self, row: &[f64]) -> f64 {
        let size = row.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
        spread(&self.directions(), |d| d.vector.iter().zip(row).map(|(v, a)| v * a).sum(), size)
    }

    /// Logarithm of `sqrt(det M)`: the volume of the confidence region is its negative exponential.
    pub fn log_precision(&self) -> f64 {
        -self.directions().iter().map(|direction| direction.standard_deviation.ln()).sum::<f64>()
    }
}

/// Standard deviation of a prediction of this size, from its part along each direction.
fn spread(directions: &[Direction], part: impl Fn(&Direction) -> f64, size: f64) -> f64 {
    let along = |direction: &Direction| {
        let part = part(direction);
        let is_rounding = direction.standard_deviation.is_infinite() && part.abs() <= NO_PART * size;
        if is_rounding { 0.0 } else { part * direction.standard_deviation }
    };
    directions.iter().map(|direction| along(direction).powi(2)).sum::<f64>().sqrt()
}

/// Eigenvalues and eigenvectors of a symmetric positive semidefinite matrix by Jacobi's rotations, which keep the relative accuracy of
/// small eigenvalues where coordinates have different units (Demmel and Veselic 1992). The reduction to a tridiagonal matrix, as in
/// `nalgebra`, does not.
fn eigen(matrix: &DMatrix<f64>) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = matrix.nrows();
    let (mut a, mut v) = (matrix.clone(), DMatrix::<f64>::identity(n, n));
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..n {
            for q in p + 1..n {
                let (app, aqq, apq) = (a[(p, p)], a[(q, q)], a[(p, q)]);
                if apq.abs() <= f64::EPSILON * app.max(0.0).sqrt() * aqq.max(0.0).sqrt() {
                    continue;
                }
                rotated = true;
                let theta = 0.5 * (aqq - app) / apq;
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = t.hypot(1.0).recip();
                let s = t * c;
                for k in 0..n {
                    let (kp, kq) = (a[(k, p)], a[(k, q)]);
                    (a[(k, p)], a[(k, q)]) = (c * kp - s * kq, s * kp + c * kq);
                    let (kp, kq) = (v[(k, p)], v[(k, q)]);
                    (v[(k, p)], v[(k, q)]) = (c * kp - s * kq, s * kp + c * kq);
                }
                for k in 0..n {
                    (a[(p, k)], a[(q, k)]) = (a[(k, p)], a[(k, q)]);
                }
                (a[(p, p)], a[(q, q)]) = (app - t * apq, aqq + t * apq);
                (a[(p, q)], a[(q, p)]) = (0.0, 0.0);
            }
        }
        if !rotated {
            break;
        }
    }
    let vectors = v.column_iter().map(|column| column.iter().copied().collect()).collect();
    (a.diagonal().iter().copied().collect(), vectors)
}
