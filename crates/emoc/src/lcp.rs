//! The linear complementarity baseline for simultaneous impacts.

use crate::matrix;
use crate::matrix::require_finite;
use crate::problem::{Outcome, Problem, Solution};
use alloc::vec;
use alloc::vec::Vec;
use invalid_input::InvalidInput;

/// The result of Lemke's method.
#[derive(Debug, Clone, PartialEq)]
pub enum Lcp {
    /// `z >= 0` with `w = M z + q >= 0` and `z . w = 0`.
    Solved(Vec<f64>),
    /// The method ended on a ray. For a positive semidefinite `M` this proves that no solution exists.
    Ray,
    /// There was no end after `50 (n + 1)` pivots, which only rounding can cause.
    PivotLimit,
}

impl core::fmt::Display for Lcp {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Lcp::Solved(_) => "solved",
            Lcp::Ray => "a ray, so that a positive semidefinite matrix has no solution",
            Lcp::PivotLimit => "no end within the limit of pivots",
        })
    }
}

/// Solves the linear complementarity problem `w = M z + q`, `w, z >= 0`, `z . w = 0`, for an `n` by `n` matrix
/// `M` (row by row) by Lemke's method with lexicographic pivoting (Cottle, Pang and Stone, *The Linear
/// Complementarity Problem*, 1992, section 4.4 and 4.9). It ends for every positive semidefinite `M`.
///
/// ```
/// use emoc::lcp::{Lcp, solve};
/// let z = solve(&[2.0, 1.0, 1.0, 2.0], &[-5.0, -6.0])?;
/// let Lcp::Solved(z) = z else { panic!() };
/// assert!((z[0] - 4.0 / 3.0).abs() < 1e-14 && (z[1] - 7.0 / 3.0).abs() < 1e-14);
/// # Ok::<(), emoc::InvalidInput>(())
/// ```
///
/// # Errors
/// [`InvalidInput`] for a matrix whose size does not fit `q`, or a number beyond 1e100 in magnitude.
pub fn solve(m: &[f64], q: &[f64]) -> Result<Lcp, InvalidInput> {
    let n = q.len();
    require_finite("q", q, n)?;
    require_finite("m", m, n * n)?;
    if q.iter().all(|&x| x >= 0.0) {
        return Ok(Lcp::Solved(vec![0.0; n]));
    }
    Ok(Tableau::new(m, q).run())
}

/// Impulses that open every contact at no less than `ebar` times its speed of approach, with equality if there is an impulse
/// (thesis 5.2.1): Newton's restitution for simultaneous impacts as a linear complementarity problem. Friction is neglected,
/// and the modes take up the impulse instantaneously.
///
/// With unequal `ebar` the energy can grow; [`Solution::energy_change_j`] shows it. `Ok(None)` if the demands
/// contradict each other, as between two walls.
///
/// # Errors
/// [`InvalidInput`] as [`Problem::validate`].
pub fn newton_impact(problem: &Problem) -> Result<Option<Solution>, InvalidInput> {
    problem.validate()?;
    let (d, normals) = (problem.coordinates(), problem.normals());
    let opening = problem.opening(&problem.velocity_m_s, problem.modes.iter().map(|mode| mode.rate));
    let combined = problem.combined_inverse_inertia();
    let n = normals.len();
    let mut m = vec![0.0; n * n];
    let mut q = vec![0.0; n];
    for (a, &i) in normals.iter().enumerate() {
        q[a] = opening[i] - problem.contacts[a].coefficients.ebar * (-opening[i]).max(0.0);
        for (b, &j) in normals.iter().enumerate() {
            m[a * n + b] = combined[i * d + j];
        }
    }
    // q is the opening velocity before any impulse minus the demanded one.
    let Lcp::Solved(p) = solve(&m, &q)? else { return Ok(None) };
    let mut impulse = vec![0.0; d];
    for (&i, p) in normals.iter().zip(&p) {
        impulse[i] = *p;
    }
    let outcome = if matrix::dot(&p, &p) > 0.0 { Outcome::Solved } else { Outcome::NoImpact };
    let rate_changes = problem.struck_changes(&impulse);
    Ok(Some(problem.solution(outcome, impulse, &rate_changes)))
}

/// Dictionary `[ B^-1 | -B^-1 M | -B^-1 1 | B^-1 q ]` of `w - M z - 1 z_0 = q`: columns `0..n` belong to `w`,
/// `n..2n` to `z`, `2n` to the covering variable `z_0`, `2n + 1` to the right-hand side.
struct Tableau {
    n: usize,
    rows: Vec<Vec<f64>>,
    basis: Vec<usize>,
    scale: f64,
}

impl Tableau {
    fn new(m: &[f64], q: &[f64]) -> Tableau {
        let n = q.len();
        let scale = m.iter().fold(0.0_f64, |s, x| s.max(x.abs())).max(f64::MIN_POSITIVE);
        let rows = (0..n)
            .map(|i| {
                let mut row = vec![0.0; 2 * n + 2];
                row[i] = 1.0;
                for j in 0..n {
                    row[n + j] = -m[i * n + j] / scale;
                }
                row[2 * n] = -1.0;
                row[2 * n + 1] = q[i];
                row
            })
            .collect();
        Tableau { n, rows, basis: (0..n).collect(), scale }
    }

    fn run(mut self) -> Lcp {
        let n = self.n;
        // z_0 enters for the most negative q, which makes every right-hand side non-negative.
        let mut leaving = 0;
        for i in 1..n {
            if self.rows[i][2 * n + 1] < self.rows[leaving][2 * n + 1] {
                leaving = i;
            }
        }
        let mut entering = 2 * n;
        for _ in 0..50 * (n + 1) {
            let left = self.basis[leaving];
            self.pivot(leaving, entering);
            if left == 2 * n {
                return Lcp::Solved(self.solution());
            }
            // The complement of the leaving variable must enter.
            entering = if left < n { left + n } else { left - n };
            match self.ratio_test(entering) {
                Some(row) => leaving = row,
                None => return Lcp::Ray,
            }
        }
        Lcp::PivotLimit
    }

    /// The row that limits the entering variable; ties are broken lexicographically in `B^-1`, but `z_0` leaves
    /// as soon as it can.
    fn ratio_test(&self, entering: usize) -> Option<usize> {
        let n = self.n;
        let mut best: Option<usize> = None;
        for i in 0..n {
            if self.rows[i][entering] <= 1e-11 {
                continue;
            }
            best = match best {
                Some(b) if !self.precedes(i, b, entering) => Some(b),
                _ => Some(i),
            };
        }
        best
    }

    fn precedes(&self, i: usize, b: usize, entering: usize) -> bool {
        let n = self.n;
        let (ri, rb) = (&self.rows[i], &self.rows[b]);
        let difference = |column: usize| ri[column] / ri[entering] - rb[column] / rb[entering];
        let first = difference(2 * n + 1);
        let size = (ri[2 * n + 1] / ri[entering]).abs() + (rb[2 * n + 1] / rb[entering]).abs();
        if first.abs() > 1e-13 * size {
            return first < 0.0;
        }
        if self.basis[i] == 2 * n || self.basis[b] == 2 * n {
            return self.basis[i] == 2 * n;
        }
        (0..n).map(difference).find(|x| x.abs() > 1e-13).is_some_and(|x| x < 0.0)
    }

    fn pivot(&mut self, row: usize, column: usize) {
        let pivot = self.rows[row][column];
        for x in &mut self.rows[row] {
            *x /= pivot;
        }
        let pivot_row = self.rows[row].clone();
        for (i, other) in self.rows.iter_mut().enumerate() {
            let factor = other[column];
            if i != row && factor != 0.0 {
                for (x, p) in other.iter_mut().zip(&pivot_row) {
                    *x -= factor * p;
                }
                other[column] = 0.0;
            }
        }
        self.basis[row] = column;
    }

    fn solution(&self) -> Vec<f64> {
        let n = self.n;
        let mut z = vec![0.0; n];
        for (row, &variable) in self.rows.iter().zip(&self.basis) {
            if (n..2 * n).contains(&variable) {
                z[variable - n] = (row[2 * n + 1] / self.scale).max(0.0);
            }
        }
        z
    }
}
