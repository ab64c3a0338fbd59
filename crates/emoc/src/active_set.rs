//! The last digits of a quadratic program: linear equations on an estimated active set, accepted only with proof.
//!
//! If the rows that are equalities at the minimum are known, the minimum solves linear equations,
//!
//! ```text
//! [ H  A^T ] [ x      ]   [ -linear ]
//! [ A   0  ] [ lambda ] = [  bound  ]
//! ```
//!
//! and `x` is *the* minimum if it satisfies the other rows and no `lambda` is negative, since the program is convex. An
//! estimate of the active set therefore costs little and cannot give a wrong result. It comes from an interior-point iterate
//! (which it completes to the last digits, even if the iteration stalled) or from the previous problem of a sequence.

use crate::program::Program;
use alloc::vec;
use alloc::vec::Vec;
use clarabel::algebra::CscMatrix;
use clarabel::qdldl::{QDLDLFactorisation, QDLDLSettings};

/// Relative tolerance on rows, signs of multipliers and the equations themselves.
const TOLERANCE: f64 = 1e-11;
/// Diagonal shift that makes the equations factorable for any estimate; iterative refinement removes its effect.
const SHIFT: f64 = 1e-8;
/// Terms below this share of the largest one are its rounding. In degenerate solutions the exact values are zero, and equations among
/// them have no other terms.
const ROUNDING: f64 = 1e-14;
/// Largest number of corrections of the estimate.
const CORRECTIONS: usize = 30;
const REFINEMENTS: usize = 30;

/// A proven minimiser and its active rows.
pub(crate) struct Proven {
    pub(crate) x: Vec<f64>,
    pub(crate) active: Vec<bool>,
}

/// Minimises from an estimate of the active rows; `None` if no proof was reached. The estimate is first corrected in all wrong
/// rows at once, which is a Newton method and quick, and then in the worst one only, which rarely cycles.
pub(crate) fn minimise(program: &Program, guess: &[bool]) -> Option<Proven> {
    let n = program.linear.len();
    let mut active = guess.to_vec();
    for correction in 0..CORRECTIONS {
        let places: Vec<usize> = (0..active.len()).filter(|&row| active[row]).collect();
        let solution = solve_equations(program, &places)?;
        let (x, lambda) = solution.split_at(n);
        let wrong = wrong_rows(program, &active, &places, x, lambda);
        if wrong.is_empty() {
            return Some(Proven { x: x.to_vec(), active });
        }
        let worst = wrong.iter().fold(0.0, |m: f64, &(_, by)| m.max(by));
        for (row, by) in wrong {
            if correction < CORRECTIONS / 2 || by == worst {
                active[row] = !active[row];
            }
        }
    }
    None
}

/// Rows outside the active set that are violated, relative to their largest term, and rows inside it with a negative
/// multiplier, relative to the largest multiplier. Rounding of the largest numbers does not count.
fn wrong_rows(program: &Program, active: &[bool], places: &[usize], x: &[f64], lambda: &[f64]) -> Vec<(usize, f64)> {
    let largest_of = |numbers: &[f64]| numbers.iter().fold(0.0_f64, |m, number| m.max(number.abs()));
    let mut excess: Vec<f64> = program.bounds.iter().map(|bound| -bound).collect();
    let mut size: Vec<f64> = vec![0.0; excess.len()];
    for &(row, column, a) in &program.rows {
        excess[row] += a * x[column];
        size[row] = f64::max(size[row], (a * x[column]).abs());
    }
    let rounding = ROUNDING * largest_of(&size);
    let beyond = |row: usize| excess[row] / size[row].max(program.bounds[row].abs());
    let violated = (0..active.len()).filter(|&row| !active[row] && excess[row] > rounding);
    let violated = violated.map(|row| (row, beyond(row)));
    let (largest, rounding) = (largest_of(lambda), ROUNDING * largest_of(&program.linear));
    let pulling = places.iter().zip(lambda).filter(|&(_, l)| -l > rounding).map(|(&row, l)| (row, -l / largest));
    violated.chain(pulling).filter(|&(_, by)| by > TOLERANCE).collect()
}

/// `x` and the multipliers of the rows at `places`; `None` unless the equations are satisfied.
fn solve_equations(program: &Program, places: &[usize]) -> Option<Vec<f64>> {
    let n = program.linear.len();
    let size = n + places.len();
    let mut place_of = vec![None; program.bounds.len()];
    for (place, &row) in places.iter().enumerate() {
        place_of[row] = Some(n + place);
    }
    let mut entries = program.hessian.clone();
    entries.extend(program.rows.iter().filter_map(|&(row, column, a)| Some((column, place_of[row]?, a))));
    entries.retain(|entry| entry.2 != 0.0);
    let mut right: Vec<f64> = program.linear.iter().map(|c| -c).collect();
    right.extend(places.iter().map(|&row| program.bounds[row]));

    let scale = equilibrate(&mut entries, size);
    for (r, s) in right.iter_mut().zip(&scale) {
        *r *= s;
    }
    let mut factor = factor(&entries, n, size)?;
    let mut solution = vec![0.0; size];
    let mut residual = right.clone();
    let mut best = f64::INFINITY;
    for refinement in 0..REFINEMENTS {
        factor.solve(&mut residual);
        let trial: Vec<f64> = solution.iter().zip(&residual).map(|(x, dx)| x + dx).collect();
        // Backward error: the residual of each equation over its largest term.
        residual.copy_from_slice(&right);
        let mut terms: Vec<f64> = right.iter().map(|r| r.abs()).collect();
        for &(i, j, a) in &entries {
            residual[i] -= a * trial[j];
            terms[i] = terms[i].max((a * trial[j]).abs());
            if i != j {
                residual[j] -= a * trial[i];
                terms[j] = terms[j].max((a * trial[i]).abs());
            }
        }
        let rounding = ROUNDING * terms.iter().fold(0.0_f64, |m, t| m.max(*t));
        let ratios = residual.iter().zip(&terms).map(|(r, t)| if *t > rounding { r.abs() / t } else { 0.0 });
        let error = ratios.fold(0.0, |m: f64, x| if x > m || x.is_nan() { x } else { m });
        // The first correction takes terms that should be zero down to rounding, which does not show in the error yet.
        if (error >= best && refinement > 1) || error.is_nan() {
            break;
        }
        (best, solution) = (error, trial);
        if best <= 1e-15 {
            break;
        }
    }
    let holds = best <= TOLERANCE;
    for (x, s) in solution.iter_mut().zip(&scale) {
        *x *= s;
    }
    (holds && solution.iter().all(|x| x.is_finite())).then_some(solution)
}

/// Scales rows and columns by the same factors until their largest entries are near 1 (Ruiz 2001), and returns the factors. It begins
/// from variables with a curvature of 1: a mode that the contacts hardly excite has a curvature of 1e-8 beside rows of order one, which
/// are left as they are otherwise, and [`SHIFT`] would hide it.
fn equilibrate(entries: &mut [(usize, usize, f64)], size: usize) -> Vec<f64> {
    let mut scale = vec![1.0; size];
    let mut apply = |entries: &mut [(usize, usize, f64)], sizes: &[f64]| {
        let step: Vec<f64> = sizes.iter().map(|size| if *size > 0.0 { 1.0 / size.sqrt() } else { 1.0 }).collect();
        for (i, j, a) in entries.iter_mut() {
            *a *= step[*i] * step[*j];
        }
        scale.iter_mut().zip(&step).for_each(|(s, step)| *s *= step);
    };
    let mut curvature = vec![0.0; size];
    for &(i, _, a) in entries.iter().filter(|(i, j, _)| i == j) {
        curvature[i] = a;
    }
    apply(entries, &curvature);
    for _ in 0..8 {
        let mut most = vec![0.0_f64; size];
        for &(i, j, a) in entries.iter() {
            most[i] = most[i].max(a.abs());
            most[j] = most[j].max(a.abs());
        }
        apply(entries, &most);
    }
    scale
}

/// `L D L^T` of the equations, shifted to be quasidefinite: positive in `x`, negative in the multipliers.
fn factor(entries: &[(usize, usize, f64)], n: usize, size: usize) -> Option<QDLDLFactorisation<f64>> {
    let mut shifted = entries.to_vec();
    shifted.extend((0..size).map(|i| (i, i, if i < n { SHIFT } else { -SHIFT })));
    shifted.sort_unstable_by_key(|&(row, column, _)| (column, row));
    shifted.dedup_by(|next, kept| {
        let same = (next.0, next.1) == (kept.0, kept.1);
        if same {
            kept.2 += next.2;
        }
        same
    });
    let mut starts = vec![0; size + 1];
    for &(_, column, _) in &shifted {
        starts[column + 1] += 1;
    }
    for j in 0..size {
        starts[j + 1] += starts[j];
    }
    let (rows, values) = shifted.iter().map(|entry| (entry.0, entry.2)).unzip();
    let matrix = CscMatrix::new(size, size, starts, rows, values);
    let signs = (0..size).map(|i| if i < n { 1 } else { -1 }).collect();
    let settings = QDLDLSettings { Dsigns: Some(signs), ..QDLDLSettings::default() };
    QDLDLFactorisation::new(&matrix, Some(settings)).ok()
}
