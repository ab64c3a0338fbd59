//! The point at which two solution branches of `F(z) = 0` cross, for `n` equations in `n + 1` unknowns.
//!
//! There the derivative has rank `n - 1`: beside the direction of one branch, that of the other is in its null space. On either branch
//! Newton's method converges slowly near it, or to the other branch. The Lyapunov-Schmidt reduction leaves only regular equations: with
//! the null vectors `v` and `w` of the square part of the derivative near the point,
//!
//! ```text
//! F(z) + beta w = 0
//! ```
//!
//! has exactly one solution `z, beta` for given `a = v . x` and parameter `p`, where `z = (x, p)`. The branches are the curves
//! `beta(a, p) = 0`, and they cross where both derivatives of `beta` vanish, a regular point of these two equations. Newton's method
//! finds it, with differences for the second derivatives (M. Golubitsky and D. G. Schaeffer, *Singularities and Groups in Bifurcation
//! Theory I*, Springer 1985, ch. VII).

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

/// Largest number of iterations for the crossing, and for a point of the reduced equation.
const ITERATIONS_MAX: u32 = 12;
/// Displacement for the second derivatives.
const DIFFERENCE: f64 = 1e-4;
/// The iterations end with a step below this, which is the accuracy of differences of first derivatives.
const NEAR: f64 = 1e-8;
/// A point of the reduced equation is reached with a correction below this.
const CLOSED: f64 = 1e-10;
/// Largest number of iterations of a singular value decomposition.
const SVD_ITERATIONS: usize = 10_000;

/// The right and left singular vector of the least singular value.
pub(super) fn null_vectors(matrix: DMatrix<f64>) -> Option<(DVector<f64>, DVector<f64>)> {
    let decomposed = matrix.try_svd(true, true, f64::EPSILON, SVD_ITERATIONS)?;
    let least = decomposed.singular_values.imin();
    let (left, right) = (decomposed.u?, decomposed.v_t?);
    Some((right.row(least).transpose(), left.column(least).into_owned()))
}

/// The value of the function at a point, and its derivative of `n` rows and `n + 1` columns.
pub(super) type Linearised = (DVector<f64>, DMatrix<f64>);
/// The function; `None` where it has no value.
type Function<'a, E> = dyn Fn(&DVector<f64>) -> Result<Option<Linearised>, E> + 'a;

/// The crossing and the last step to it, if it is found within a distance of a point near it. All is scaled to the size of 1.
pub(super) fn crossing<E>(
    linearised: &Function<'_, E>,
    near: &DVector<f64>,
    distance: f64,
) -> Result<Option<(DVector<f64>, f64)>, E> {
    let n = near.len() - 1;
    let Some((_, matrix)) = linearised(near)? else { return Ok(None) };
    let Some((v, w)) = null_vectors(matrix.columns(0, n).into_owned()) else { return Ok(None) };
    let reduced = |at| Reduced::at(linearised, (&v, &w), at);
    let mut at = near.clone();
    for _ in 0..ITERATIONS_MAX {
        let Some(here) = reduced(at)? else { return Ok(None) };
        let aside = |direction: &DVector<f64>| reduced(&here.z + DIFFERENCE * direction);
        let (Some(in_a), Some(in_p)) = (aside(&here.along_a)?, aside(&here.along_p)?) else { return Ok(None) };
        let columns = [in_a, in_p].map(|beside| (beside.slopes - here.slopes) / DIFFERENCE);
        let Some(step) = Matrix2::from_columns(&columns).lu().solve(&-here.slopes) else { return Ok(None) };
        at = &here.z + step[0] * &here.along_a + step[1] * &here.along_p;
        let apart = (&at - near).norm();
        if apart.is_nan() || apart > distance {
            return Ok(None);
        }
        if step.amax() < NEAR {
            return Ok(Some((at, step.amax())));
        }
    }
    Ok(None)
}

/// A solution of the reduced equation.
struct Reduced {
    z: DVector<f64>,
    /// Its derivatives with respect to `a` and `p`.
    along_a: DVector<f64>,
    along_p: DVector<f64>,
    /// Those of `beta`.
    slopes: Vector2<f64>,
}

impl Reduced {
    /// The solution with the `a` and `p` of a point near it.
    fn at<E>(
        linearised: &Function<'_, E>,
        (v, w): (&DVector<f64>, &DVector<f64>),
        mut z: DVector<f64>,
    ) -> Result<Option<Reduced>, E> {
        let n = v.len();
        let mut beta = 0.0;
        for _ in 0..ITERATIONS_MAX {
            let Some((value, matrix)) = linearised(&z)? else { return Ok(None) };
            let bordered = DMatrix::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
                (true, true) => matrix[(i, j)],
                (true, false) => w[i],
                (false, true) => v[j],
                (false, false) => 0.0,
            });
            let lu = bordered.lu();
            let defect = (value + beta * w).insert_row(n, 0.0);
            let along_a = DVector::zeros(n).insert_row(n, 1.0);
            let along_p = (-matrix.column(n)).insert_row(n, 0.0);
            let solved = (lu.solve(&-defect), lu.solve(&along_a), lu.solve(&along_p));
            let (Some(change), Some(along_a), Some(along_p)) = solved else { return Ok(None) };
            for i in 0..n {
                z[i] += change[i];
            }
            beta += change[n];
            if change.amax() < CLOSED {
                let slopes = Vector2::new(along_a[n], along_p[n]);
                let with = |mut along: DVector<f64>, parameter| {
                    along[n] = parameter;
                    along
                };
                return Ok(Some(Reduced { z, along_a: with(along_a, 0.0), along_p: with(along_p, 1.0), slopes }));
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `x = p`, and a pitchfork of `y` from it at `p = 0.3`, in coordinates that mix both: found from 0.1 away.
    #[test]
    fn a_pitchfork_in_a_bent_plane_is_found() {
        let of = |z: &DVector<f64>| {
            let (x, y, p) = (z[0], z[1] - z[0] * z[0], z[2]);
            let value = DVector::from_vec(vec![x - p, y * (p - 0.3) - y.powi(3) + y * (x - p)]);
            let by_y = p - 0.3 - 3.0 * y * y + x - p;
            let matrix = DMatrix::from_row_slice(2, 3, &[1.0, 0.0, -1.0, y - 2.0 * z[0] * by_y, by_y, 0.0]);
            Ok::<_, ()>(Some((value, matrix)))
        };
        let (found, step) = crossing(&of, &DVector::from_vec(vec![0.38, 0.2, 0.4]), 0.5).unwrap().unwrap();
        assert!((found - DVector::from_vec(vec![0.3, 0.09, 0.3])).amax() < 1e-9 && step < NEAR);
    }
}
