//! Dense linear algebra in one thread.
//!
//! The operators and solvers of faer use all threads if any package of a build turns on its feature `rayon`, and the rounding
//! depends on the number of threads. The functions here always use one thread, so that modes have the same bits in every build.

use faer::diag::{Diag, DiagMut, DiagRef};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::evd::{
    ComputeEigenvectors, EvdError, self_adjoint_evd, self_adjoint_evd_scratch, tridiagonal_self_adjoint_evd,
};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::linalg::zip::Diag as Diagonal;
use faer::{Accum, Mat, MatMut, MatRef, Par};

/// Cholesky's factor `L` of a symmetric matrix, of which the lower triangle is read; `None` if it is not positive definite.
pub(crate) fn cholesky(matrix: MatRef<'_, f64>) -> Option<Mat<f64>> {
    let n = matrix.nrows();
    let mut lower = Mat::zeros(n, n);
    lower.copy_from_triangular_lower(matrix);
    let mut buffer = MemBuffer::new(cholesky_in_place_scratch::<f64>(n, Par::Seq, Default::default()));
    let stack = MemStack::new(&mut buffer);
    cholesky_in_place(lower.as_mut(), Default::default(), Par::Seq, stack, Default::default()).ok()?;
    faer::zip!(lower.as_mut()).for_each_triangular_upper(Diagonal::Skip, |faer::unzip!(above)| *above = 0.0);
    Some(lower)
}

/// The eigenvalues of a symmetric matrix in ascending order, and its orthonormal eigenvectors as columns; the lower triangle
/// is read. `None` if they cannot be computed.
pub(crate) fn eigen(matrix: MatRef<'_, f64>) -> Option<(Vec<f64>, Mat<f64>)> {
    decompose(matrix.nrows(), |values, vectors, stack| {
        self_adjoint_evd(matrix, values, Some(vectors), Par::Seq, stack, Default::default())
    })
}

/// The same of a tridiagonal matrix, from its diagonal and the entries beside it, without the products of matrices by which a full one is
/// made tridiagonal.
pub(crate) fn eigen_tridiagonal(diagonal: &[f64], off_diagonal: &[f64]) -> Option<(Vec<f64>, Mat<f64>)> {
    decompose(diagonal.len(), |values, vectors, stack| {
        let [diagonal, beside] = [diagonal, off_diagonal].map(DiagRef::from_slice);
        tridiagonal_self_adjoint_evd(diagonal, beside, values, Some(vectors), Par::Seq, stack, Default::default())
    })
}

/// Eigenvalues and eigenvectors by one of faer's solvers. The one for tridiagonal matrices does not state how much memory it needs. It is
/// a part of the one for full matrices, whose memory suffices.
fn decompose(
    n: usize,
    solve: impl FnOnce(DiagMut<'_, f64>, MatMut<'_, f64>, &mut MemStack) -> Result<(), EvdError>,
) -> Option<(Vec<f64>, Mat<f64>)> {
    let (mut values, mut vectors) = (Diag::zeros(n), Mat::zeros(n, n));
    let scratch = self_adjoint_evd_scratch::<f64>(n, ComputeEigenvectors::Yes, Par::Seq, Default::default());
    let mut buffer = MemBuffer::new(scratch);
    solve(values.as_mut(), vectors.as_mut(), MemStack::new(&mut buffer)).ok()?;
    Some((values.column_vector().iter().copied().collect(), vectors))
}

/// `A B`.
pub(crate) fn product(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    let mut product = Mat::zeros(a.nrows(), b.ncols());
    matmul(product.as_mut(), Accum::Replace, a, b, 1.0, Par::Seq);
    product
}

/// Takes `A B` off `from`.
pub(crate) fn subtract_product(from: MatMut<'_, f64>, a: MatRef<'_, f64>, b: MatRef<'_, f64>) {
    matmul(from, Accum::Add, a, b, -1.0, Par::Seq);
}

/// `L^(-1) x` in place of every column `x`.
pub(crate) fn solve_lower(lower: MatRef<'_, f64>, columns: MatMut<'_, f64>) {
    solve_lower_triangular_in_place(lower, columns, Par::Seq);
}

/// `U^(-1) x` in place of every column `x`.
pub(crate) fn solve_upper(upper: MatRef<'_, f64>, columns: MatMut<'_, f64>) {
    solve_upper_triangular_in_place(upper, columns, Par::Seq);
}
