//! The linear complementarity baseline for simultaneous impacts.

use crate::matrix;
use crate::matrix::require_finite;
use crate::problem::{Outcome, Problem, Solution};
use alloc::vec;
use alloc::vec::Vec;
use invalid_input::InvalidInput;

/// Sweeps over the matrix after which its rows and columns count as balanced.
const SWEEPS: usize = 8;

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
/// [`InvalidInput`] for a matrix whose size does not fit `q`, a number beyond 1e100 in magnitude, or a solution too large for a
/// number.
pub fn solve(m: &[f64], q: &[f64]) -> Result<Lcp, InvalidInput> {
    let n = q.len();
    require_finite("q", q, n)?;
    require_finite("m", m, n * n)?;
    if q.iter().all(|&x| x >= 0.0) {
        return Ok(Lcp::Solved(vec![0.0; n]));
    }
    let found = Tableau::new(m, q).run();
    if let Lcp::Solved(z) = &found
        && let Some(i) = z.iter().position(|z| !z.is_finite())
    {
        return Err(InvalidInput::new(("q", i), q[i], "small enough that the solution is a finite number"));
    }
    Ok(found)
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

/// Dictionary `[ B^-1 | -B^-1 M | -B^-1 d | B^-1 q ]` of `w - M z - d z_0 = q`: columns `0..n` belong to `w`,
/// `n..2n` to `z`, `2n` to the covering variable `z_0`, `2n + 1` to the right-hand side.
///
/// The problem is that of `D M D` and `D q / unit`, whose solution is `D^-1 z / unit`: with a heavy and a light body an entry of
/// `M` may be far smaller than others and still decide whether there is a solution. The covering vector `d` is of the size of `q`,
/// so that no entry of `q` is lost in the sum `q + d z_0`.
struct Tableau {
    n: usize,
    rows: Vec<Vec<f64>>,
    /// The largest term of each entry, of which the entry may be the rounding.
    terms: Vec<Vec<f64>>,
    basis: Vec<usize>,
    /// The diagonal of `D`.
    scale: Vec<f64>,
    /// The magnitude of the most negative entry of `D q`.
    unit: f64,
}

impl Tableau {
    fn new(m: &[f64], q: &[f64]) -> Tableau {
        let n = q.len();
        let scale = balance(m, n);
        let q: Vec<f64> = q.iter().zip(&scale).map(|(q, scale)| q * scale).collect();
        let unit = q.iter().fold(0.0, |most, q| f64::max(most, -q));
        let q: Vec<f64> = q.iter().map(|q| q / unit).collect();
        let least = q.iter().filter(|q| **q < 0.0).fold(1.0, |least, q| f64::min(least, -q));
        let rows: Vec<Vec<f64>> = (0..n)
            .map(|i| {
                let mut row = vec![0.0; 2 * n + 2];
                row[i] = 1.0;
                for j in 0..n {
                    row[n + j] = -scale[i] * m[i * n + j] * scale[j];
                }
                // z_0 enters in the row of the most negative q. In the others d is larger, by factors that differ from row to row,
                // so that the entries of q + d z_0 are not all zero at once.
                let beyond = if q[i] == -1.0 { 1.0 } else { 1.5 + (0.618 * i as f64) % 1.0 };
                row[2 * n] = -beyond * q[i].abs().clamp(least, 1.0);
                row[2 * n + 1] = q[i];
                row
            })
            .collect();
        let terms = rows.iter().map(|row| row.iter().map(|x| x.abs()).collect()).collect();
        Tableau { n, rows, terms, basis: (0..n).collect(), scale, unit }
    }

    fn run(mut self) -> Lcp {
        let n = self.n;
        // z_0 enters and makes every right-hand side non-negative.
        let mut leaving = 0;
        let needed = |row: &[f64]| row[2 * n + 1] / -row[2 * n];
        for i in 1..n {
            if needed(&self.rows[i]) < needed(&self.rows[leaving]) {
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
            if self.rows[i][entering] <= 1e-11 * self.terms[i][entering] {
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
        self.rows[row].iter_mut().for_each(|x| *x /= pivot);
        self.terms[row].iter_mut().for_each(|term| *term /= pivot.abs());
        let (pivot_row, pivot_terms) = (self.rows[row].clone(), self.terms[row].clone());
        for (i, (other, terms)) in self.rows.iter_mut().zip(&mut self.terms).enumerate() {
            let factor = other[column];
            if i != row && factor != 0.0 {
                for (x, p) in other.iter_mut().zip(&pivot_row) {
                    *x -= factor * p;
                }
                for (term, p) in terms.iter_mut().zip(&pivot_terms) {
                    *term = term.max((factor * p).abs());
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
                z[variable - n] = (self.scale[variable - n] * (self.unit * row[2 * n + 1])).max(0.0);
            }
        }
        z
    }
}

/// Factors `D` by which the largest entry of each row and column of `D M D` is near 1 (Ruiz 2001), as powers of 2, which round
/// nothing. A row and column of zeros keep theirs.
fn balance(m: &[f64], n: usize) -> Vec<f64> {
    let mut scale = vec![1.0; n];
    for _ in 0..SWEEPS {
        let largest = |i: usize| {
            let pairs = (0..n).flat_map(|j| [(i, j), (j, i)]);
            pairs.fold(0.0_f64, |most, (i, j)| most.max((scale[i] * m[i * n + j] * scale[j]).abs()))
        };
        let most: Vec<f64> = (0..n).map(largest).collect();
        for (scale, most) in scale.iter_mut().zip(most).filter(|(_, most)| *most > 0.0) {
            // 2^-(e/2) for a number from 2^e to below 2^(e+1); there is no square root without `std`
            let exponent = (most.to_bits() >> 52) as i64 - 1023;
            *scale *= f64::from_bits(((1023 - exponent.div_euclid(2)).unsigned_abs()) << 52);
        }
    }
    scale
}
