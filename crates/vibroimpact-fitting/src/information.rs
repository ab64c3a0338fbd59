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
use nalgebra::{DMatrix, SymmetricEigen};

/// Entries of `M` below this share of the largest count as rounding.
const ROUNDING: f64 = 1e-14;

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
        if let Some(entry) = rows.iter().find(|entry| entry.is_nan() || entry.abs() >= 1e150) {
            return Err(InvalidInput::new("rows", *entry, "a list of numbers of magnitude below 1e150"));
        }
        let jacobian = DMatrix::from_row_slice(rows.len() / n, n, rows);
        Ok(Information { matrix: jacobian.transpose() * jacobian })
    }

    /// The same with a normal prior on each coordinate, given by its standard deviation. Without a positive standard deviation
    /// there is no prior.
    #[must_use]
    pub fn with_prior(mut self, standard_deviations: &[f64]) -> Information {
        for (j, sd) in standard_deviations.iter().enumerate().take(self.matrix.nrows()) {
            if *sd > 0.0 {
                self.matrix[(j, j)] += sd.powi(-2);
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
    /// coordinates do not exist, or the others are not determined even if these were known.
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
        let alone = part(members, members);
        if others.is_empty() {
            return Some(Information { matrix: alone });
        }
        let both = part(&others, members);
        let known = part(&others, &others).cholesky()?.solve(&both);
        Some(Information { matrix: alone - both.transpose() * known })
    }

    /// The directions that the observations determine independently, the least certain first.
    pub fn directions(&self) -> Vec<Direction> {
        let eigen = SymmetricEigen::new(self.matrix.clone());
        let largest = eigen.eigenvalues.iter().fold(0.0f64, |most, value| most.max(*value));
        let mut found: Vec<Direction> = eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter())
            .map(|(&value, vector)| {
                let leading = vector.iter().copied().fold(0.0f64, |a, b| if b.abs() > a.abs() { b } else { a });
                let sign = if leading < 0.0 { -1.0 } else { 1.0 };
                let known = value > ROUNDING * largest && value > 0.0;
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
        let directions = self.directions();
        let of = |j: usize| -> f64 {
            // An undetermined direction affects the coordinates that have a component along it.
            let share = |d: &Direction| if d.vector[j].abs() > 1e-7 { d.vector[j] * d.standard_deviation } else { 0.0 };
            directions.iter().map(|d| share(d).powi(2)).sum::<f64>().sqrt()
        };
        (0..self.matrix.nrows()).map(of).collect()
    }

    /// Standard deviation of a linear prediction `row . u`.
    pub fn of_prediction(&self, row: &[f64]) -> f64 {
        let along = |d: &Direction| -> f64 {
            let part: f64 = d.vector.iter().zip(row).map(|(v, a)| v * a).sum();
            if part == 0.0 { 0.0 } else { (part * d.standard_deviation).powi(2) }
        };
        self.directions().iter().map(along).sum::<f64>().sqrt()
    }

    /// Logarithm of `sqrt(det M)`: the volume of the confidence region is its negative exponential.
    pub fn log_precision(&self) -> f64 {
        -self.directions().iter().map(|direction| direction.standard_deviation.ln()).sum::<f64>()
    }
}
