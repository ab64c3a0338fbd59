//! Dense linear algebra for the contact problem, on slices, row by row.

use crate::require::require;
use alloc::vec::Vec;
use invalid_input::InvalidInput;

/// Relative size below which a pivot or a residual counts as rounding.
const ROUNDING: f64 = 1e-10;

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Accepts a list of `length` finite numbers, none so large that products of two of them overflow.
pub(crate) fn require_finite(field: &'static str, values: &[f64], length: usize) -> Result<(), InvalidInput> {
    if values.len() != length {
        let allowed = "as long as the number of contact coordinates or velocities requires";
        return Err(InvalidInput::new(field, values.len(), allowed));
    }
    match values.iter().position(|value| value.is_nan() || value.abs() > 1e100) {
        Some(index) => {
            let allowed = "a number of magnitude up to 1e100";
            Err(InvalidInput::new((field, index), values[index], allowed))
        }
        None => Ok(()),
    }
}

/// Accepts a matrix symmetric up to rounding.
pub(crate) fn require_symmetric(field: &'static str, a: &[f64], n: usize) -> Result<(), InvalidInput> {
    let largest = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for i in 0..n {
        for j in 0..i {
            if (a[i * n + j] - a[j * n + i]).abs() > ROUNDING * largest {
                let allowed = "equal to the entry opposite to it, because the matrix is symmetric";
                return Err(InvalidInput::new((field, i * n + j), a[i * n + j], allowed));
            }
        }
    }
    Ok(())
}

/// `L D L^T` of a symmetric positive definite matrix; `D` on the diagonal, `L` below it.
pub(crate) fn factor_positive_definite(field: &'static str, a: &[f64], n: usize) -> Result<Vec<f64>, InvalidInput> {
    let mut f = a.to_vec();
    for j in 0..n {
        let mut d = f[j * n + j];
        for k in 0..j {
            d -= f[j * n + k] * f[j * n + k] * f[k * n + k];
        }
        require(d > f64::EPSILON * a[j * n + j].abs(), field, d, "a pivot of a positive definite matrix")?;
        f[j * n + j] = d;
        for i in j + 1..n {
            let mut l = f[i * n + j];
            for k in 0..j {
                l -= f[i * n + k] * f[j * n + k] * f[k * n + k];
            }
            f[i * n + j] = l / d;
        }
    }
    Ok(f)
}

/// Solves with a factor from [`factor_positive_definite`], in place.
pub(crate) fn solve_factored(f: &[f64], n: usize, x: &mut [f64]) {
    for i in 0..n {
        for k in 0..i {
            x[i] -= f[i * n + k] * x[k];
        }
    }
    for i in 0..n {
        x[i] /= f[i * n + i];
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            x[i] -= f[k * n + i] * x[k];
        }
    }
}

/// Checks that `W` is symmetric and positive semidefinite and that `v` is in its range, by elimination with the largest
/// diagonal entry as pivot until only rounding remains of `W`. The remainder of `v` must then be zero, or no larger than is
/// consistent with the remainder of `W`.
pub(crate) fn symmetric_consistent(w: &[f64], v: &[f64]) -> Result<(), InvalidInput> {
    let n = v.len();
    require_symmetric("inverse_inertia_per_kg", w, n)?;
    let largest = w.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let fastest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let (mut w, mut v) = (w.to_vec(), v.to_vec());
    let mut left: Vec<usize> = (0..n).collect();
    // `v.W^-1.v` of the eliminated part.
    let mut energy = 0.0;
    while !left.is_empty() {
        let mut place = 0;
        for k in 1..left.len() {
            if w[left[k] * n + left[k]] > w[left[place] * n + left[place]] {
                place = k;
            }
        }
        let p = left[place];
        let pivot = w[p * n + p];
        if pivot <= ROUNDING * largest {
            break;
        }
        left.swap_remove(place);
        energy += v[p] * v[p] / pivot;
        for &i in &left {
            let ratio = w[i * n + p] / pivot;
            for &j in &left {
                w[i * n + j] -= ratio * w[p * n + j];
            }
            v[i] -= ratio * v[p];
        }
    }
    for &i in &left {
        for &j in &left {
            if w[i * n + j].abs() > 100.0 * ROUNDING * largest {
                let allowed = "an entry of a positive semidefinite matrix";
                let field = "inverse_inertia_per_kg";
                return Err(InvalidInput::new((field, i * n + j), w[i * n + j], allowed));
            }
        }
        // With `W = B B^T` and `v = B u`, `v_i^2` is at most `W_ii u.u`, however small.
        let unexplained = v[i] * v[i] > 100.0 * w[i * n + i].max(0.0) * energy;
        if v[i].abs() > 100.0 * ROUNDING * fastest && unexplained {
            let allowed = "in the range of the matrix inverse_inertia_per_kg, because an immovable body does not move";
            return Err(InvalidInput::new(("velocity_m_s", i), v[i], allowed));
        }
    }
    Ok(())
}
