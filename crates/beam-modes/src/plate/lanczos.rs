//! The largest eigenvalues of a symmetric matrix that is given by its products only.
//!
//! Block Lanczos iteration (G. H. Golub and R. Underwood, *Mathematical Software III* (1977) 361) with full orthogonalisation:
//! the space of the products of powers of the matrix with a few vectors, and the Rayleigh-Ritz eigenvectors in it. With blocks
//! of eight vectors, eigenvalues of multiplicity up to eight are found like simple ones. The eigenvalues `1/omega^2` of a plate
//! decrease so fast that a space of little more than twice the requested number of dimensions contains them to all digits. The
//! residual of every eigenvector is known without a product, and the space grows until it is small.

use crate::dense::{cholesky, eigen, product, solve_lower, subtract_product};
use faer::{Mat, MatMut};

/// Number of vectors in a block.
const WIDTH: usize = 8;
/// Largest residual of an eigenvector, relative to its eigenvalue.
const RESIDUAL: f64 = 1e-11;

/// The `wanted` largest eigenvalues, in descending order, and their orthonormal eigenvectors, of a symmetric matrix with `rows`
/// rows; `apply` replaces columns by their products with the matrix. `None` if an eigenvalue cannot be computed.
pub(super) fn largest(rows: usize, wanted: usize, apply: impl Fn(MatMut<'_, f64>)) -> Option<(Vec<f64>, Mat<f64>)> {
    let wanted = wanted.min(rows);
    let mut steps = (2 * wanted).div_ceil(WIDTH) + 8;
    let mut space = Space::new(rows);
    // A space of almost all dimensions costs more than one of all.
    while 4 * steps * WIDTH <= 3 * rows {
        if !space.grow(steps, &apply) {
            break;
        }
        if let Some(found) = space.eigenvectors(wanted) {
            return Some(found);
        }
        steps += steps / 4;
    }
    let mut matrix = Mat::identity(rows, rows);
    apply(matrix.as_mut());
    let (values, vectors) = eigen(matrix.as_ref())?;
    let largest = (0..wanted).map(|k| values[rows - 1 - k]).collect();
    Some((largest, Mat::from_fn(rows, wanted, |p, k| vectors[(p, rows - 1 - k)])))
}

/// The space built so far, and the matrix in it.
struct Space {
    /// Orthonormal vectors, block by block, one block more than has been multiplied.
    basis: Mat<f64>,
    /// The matrix in this basis: diagonal blocks, and those below them.
    diagonal: Vec<Mat<f64>>,
    below: Vec<Mat<f64>>,
}

impl Space {
    fn new(rows: usize) -> Space {
        // Any vectors are suitable in which no eigenvector is absent; they are the same each time (G. Steele et al.,
        // splitmix64).
        let mut state = 0_u64;
        let basis = Mat::from_fn(rows, WIDTH, |_, _| {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        });
        Space { basis, diagonal: Vec::new(), below: Vec::new() }
    }

    /// Multiplies until this many blocks are complete; `false` if no new direction is left.
    fn grow(&mut self, steps: usize, apply: impl Fn(MatMut<'_, f64>)) -> bool {
        let rows = self.basis.nrows();
        let have = self.basis.ncols();
        self.basis.resize_with(rows, (steps + 1) * WIDTH, |_, _| 0.0);
        if self.diagonal.is_empty() {
            for _ in 0..2 {
                if orthonormal(self.basis.as_mut().subcols_mut(0, WIDTH)).is_none() {
                    return false;
                }
            }
        }
        for step in have / WIDTH - 1..steps {
            let (known, next) = self.basis.as_mut().split_at_col_mut((step + 1) * WIDTH);
            let (known, mut next) = (known.as_ref(), next.subcols_mut(0, WIDTH));
            let last = known.subcols(step * WIDTH, WIDTH);
            next.copy_from(last);
            apply(next.as_mut());
            // First against the two blocks of the recurrence, then against all, because of rounding.
            let diagonal = product(last.transpose(), next.as_ref());
            subtract_product(next.as_mut(), last, diagonal.as_ref());
            if let Some(below) = self.below.last() {
                let before = known.subcols((step - 1) * WIDTH, WIDTH);
                subtract_product(next.as_mut(), before, below.transpose());
            }
            let Some(first) = orthonormal(next.as_mut()) else { return false };
            let rest = product(known.transpose(), next.as_ref());
            subtract_product(next.as_mut(), known, rest.as_ref());
            let Some(second) = orthonormal(next) else { return false };
            self.diagonal.push(diagonal);
            self.below.push(product(second.as_ref(), first.as_ref()));
        }
        true
    }

    /// The largest eigenvalues and their vectors, if all residuals are small.
    fn eigenvectors(&self, wanted: usize) -> Option<(Vec<f64>, Mat<f64>)> {
        let size = self.diagonal.len() * WIDTH;
        let mut matrix = Mat::zeros(size, size);
        for (step, (diagonal, below)) in self.diagonal.iter().zip(&self.below).enumerate() {
            matrix.as_mut().submatrix_mut(step * WIDTH, step * WIDTH, WIDTH, WIDTH).copy_from(diagonal);
            if (step + 1) * WIDTH < size {
                matrix.as_mut().submatrix_mut((step + 1) * WIDTH, step * WIDTH, WIDTH, WIDTH).copy_from(below);
            }
        }
        let (ascending, eigenvectors) = eigen(matrix.as_ref())?;
        let values: Vec<f64> = (0..wanted).map(|k| ascending[size - 1 - k]).collect();
        let vectors = Mat::from_fn(size, wanted, |p, k| eigenvectors[(p, size - 1 - k)]);
        let residuals = product(self.below.last()?.as_ref(), vectors.as_ref().subrows(size - WIDTH, WIDTH));
        let small = |k: usize| residuals.col(k).norm_l2() <= RESIDUAL * values[k];
        (0..wanted).all(small).then(|| (values, product(self.basis.as_ref().subcols(0, size), vectors.as_ref())))
    }
}

/// Makes the columns orthonormal, and returns the upper triangular `R` with the old columns = new columns times `R`; `None` if
/// they are linearly dependent.
fn orthonormal(mut columns: MatMut<'_, f64>) -> Option<Mat<f64>> {
    let gram = product(columns.as_ref().transpose(), columns.as_ref());
    let lower = cholesky(gram.as_ref())?;
    solve_lower(lower.as_ref(), columns.as_mut().transpose_mut());
    Some(lower.transpose().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A diagonal matrix with double eigenvalues, transformed by a reflection.
    #[test]
    fn eigenvalues_of_a_known_matrix() {
        let rows = 600;
        let exact: Vec<f64> = (0..rows).map(|p| 1.0 / ((2 + p / 2) as f64).powi(2)).collect();
        let mirror: Vec<f64> = (0..rows).map(|p| (0.3 * p as f64).sin()).collect();
        let norm: f64 = mirror.iter().map(|m| m * m).sum();
        let reflect = |x: &mut [f64]| {
            let inner: f64 = x.iter().zip(&mirror).map(|(x, m)| x * m).sum();
            x.iter_mut().zip(&mirror).for_each(|(x, m)| *x -= 2.0 * inner / norm * m);
        };
        let apply = |mut x: MatMut<'_, f64>| {
            for k in 0..x.ncols() {
                let mut column: Vec<f64> = (0..rows).map(|p| x[(p, k)]).collect();
                reflect(&mut column);
                column.iter_mut().zip(&exact).for_each(|(x, value)| *x *= value);
                reflect(&mut column);
                (0..rows).for_each(|p| x[(p, k)] = column[p]);
            }
        };
        // In a space of a part of the dimensions, and of all of them.
        for wanted in [1, 30, 150, 500, 600] {
            let (values, vectors) = largest(rows, wanted, apply).unwrap();
            assert!(values.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-14), "{wanted}");
            let mut product = vectors.clone();
            apply(product.as_mut());
            let gram = vectors.transpose() * &vectors;
            for k in 0..wanted {
                assert!((0..wanted).all(|j| (gram[(j, k)] - f64::from(j == k)).abs() < 1e-13));
                assert!((0..rows).all(|p| (product[(p, k)] - values[k] * vectors[(p, k)]).abs() < 1e-13));
            }
        }
    }

    /// If there is only one eigenspace, the second block has no direction of its own.
    #[test]
    fn the_identity_has_no_krylov_space() {
        let (values, vectors) = largest(400, 10, |_| ()).unwrap();
        assert!(values.iter().all(|value| (value - 1.0).abs() < 1e-15) && vectors.ncols() == 10);
    }
}
