//! Newton's method for the implicit equations of a step, a starting block, or a collocation panel.

use crate::system::{Fault, Pair, System};
use nalgebra::{DMatrix, DVector, Dyn, LU};

const MOST_ITERATIONS: usize = 40;
const MOST_HALVINGS: usize = 8;

/// `points` coupled equations `y_i = rhs_i + sum over pairs and j of W_ij f(t_j, y_j)`.
pub(crate) struct Block<'b> {
    pub times: &'b [f64],
    /// `points x unknowns`.
    pub rhs: &'b [f64],
    /// One `points x points` matrix, row-major, per pair of the system.
    pub weights: &'b [Vec<f64>],
}

/// The values of the solution (`points x unknowns`) and the density (`points x densities`) at the points of a block.
#[derive(Debug, Clone)]
pub(crate) struct Stage {
    pub y: Vec<f64>,
    pub f: Vec<f64>,
}

/// Solves the block from the guess in `stage.y`.
///
/// The Jacobian is formed by differences and reused while each iteration reduces the step by a factor of ten or more.
pub(crate) fn solve(system: &mut System<'_, '_>, block: &Block<'_>, stage: &mut Stage) -> Result<(), Fault> {
    let at = block.times[block.times.len() - 1];
    densities(system, block.times, &stage.y, &mut stage.f)?;
    let mut residual = residual_of(system, block, stage);
    let mut factors: Option<LU<f64, Dyn, Dyn>> = None;
    let mut previous: Option<f64> = None;
    for _ in 0..MOST_ITERATIONS {
        system.newton_iterations += 1;
        if factors.is_none() {
            factors = Some(newton_matrix(system, block, stage)?.lu());
        }
        let step = factors.as_ref().and_then(|lu| lu.solve(&residual)).ok_or(Fault::NoConvergence { t: at })?;
        if !step.iter().all(|v| v.is_finite()) {
            return Err(Fault::NoConvergence { t: at });
        }
        residual = damped_step(system, block, stage, &step, residual.amax())?;
        let size = relative(step.as_slice(), [&stage.y, block.rhs], system.unknowns);
        // The first step contains no information about the contraction.
        let rate = previous.map_or(1.0, |before| size / before);
        // The errors of the differenced Jacobian are about 1e-8, so no faster contraction is assumed.
        let remaining = if rate < 0.5 { size * rate.max(1e-8) } else { size };
        if remaining <= 4.0 * f64::EPSILON {
            return Ok(());
        }
        // Rounding of the residual may keep the last step above the bound; the step then no longer decreases. An unknown may consist of
        // nothing but the rounding of others, so that the largest of all is the measure here.
        if previous.is_some() && rate >= 0.5 && step.amax() <= 1e-12 * magnitude(&stage.y).max(magnitude(block.rhs)) {
            return Ok(());
        }
        if previous.is_some() && rate > 0.1 {
            factors = None;
        }
        previous = Some(size);
    }
    Err(Fault::NoConvergence { t: at })
}

/// Moves along `step`, halving it while the residual grows or cannot be evaluated; returns the new residual.
fn damped_step(
    system: &mut System<'_, '_>,
    block: &Block<'_>,
    stage: &mut Stage,
    step: &DVector<f64>,
    size: f64,
) -> Result<DVector<f64>, Fault> {
    let start = stage.y.clone();
    let mut factor = 1.0;
    let mut outcome = Err(Fault::NoConvergence { t: block.times[0] });
    for _ in 0..MOST_HALVINGS {
        for ((y, y0), dy) in stage.y.iter_mut().zip(&start).zip(step.iter()) {
            *y = y0 - factor * dy;
        }
        outcome = densities(system, block.times, &stage.y, &mut stage.f);
        if outcome.is_ok() {
            let residual = residual_of(system, block, stage);
            let scale = stage.y.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
            if residual.amax() <= size.max(1e-13 * scale) || factor * 2f64.powi(MOST_HALVINGS as i32 - 1) <= 1.0 {
                return Ok(residual);
            }
        }
        factor *= 0.5;
    }
    outcome.map(|()| residual_of(system, block, stage))
}

fn magnitude(values: &[f64]) -> f64 {
    values.iter().fold(f64::MIN_POSITIVE, |a, v| a.max(v.abs()))
}

/// The largest magnitude of one of the unknowns at several points.
fn largest(values: &[f64], unknown: usize, unknowns: usize) -> f64 {
    values.iter().skip(unknown).step_by(unknowns).fold(0.0, |a, v| a.max(v.abs()))
}

/// The largest step of an unknown relative to its own values, since unknowns may have different units, or to those of all if it is 0
/// everywhere.
fn relative(step: &[f64], values: [&[f64]; 2], unknowns: usize) -> f64 {
    let mut size = 0.0_f64;
    for unknown in 0..unknowns {
        let [a, b] = values.map(|values| largest(values, unknown, unknowns));
        let own = a.max(b);
        let own = if own > 0.0 { own } else { magnitude(values[0]).max(magnitude(values[1])) };
        size = size.max(largest(step, unknown, unknowns) / own);
    }
    size
}

fn densities(system: &mut System<'_, '_>, times: &[f64], y: &[f64], f: &mut [f64]) -> Result<(), Fault> {
    let (d, m) = (system.unknowns, system.densities);
    for (i, &t) in times.iter().enumerate() {
        system.density(t, &y[i * d..(i + 1) * d], &mut f[i * m..(i + 1) * m])?;
    }
    Ok(())
}

fn residual_of(system: &System<'_, '_>, block: &Block<'_>, stage: &Stage) -> DVector<f64> {
    let (d, m, points) = (system.unknowns, system.densities, block.times.len());
    let mut residual = DVector::from_fn(points * d, |r, _| stage.y[r] - block.rhs[r]);
    for (Pair { unknown, density, .. }, w) in system.pairs.iter().zip(block.weights) {
        for i in 0..points {
            let sum: f64 = (0..points).map(|j| w[i * points + j] * stage.f[j * m + density]).sum();
            residual[i * d + unknown] -= sum;
        }
    }
    residual
}

/// `I - W df/dy`.
fn newton_matrix(system: &mut System<'_, '_>, block: &Block<'_>, stage: &Stage) -> Result<DMatrix<f64>, Fault> {
    let (d, m, points) = (system.unknowns, system.densities, block.times.len());
    let mut matrix = DMatrix::identity(points * d, points * d);
    let of_all = magnitude(&stage.y);
    let mut shifted = vec![0.0; d];
    let mut moved = vec![0.0; m];
    for c in 0..d {
        // Relative to the unknown itself a density could not see the step in a difference from a larger unknown, and relative to the
        // larger one the step would not be small. The mean is as far from either.
        let own = largest(&stage.y, c, d);
        let typical = if own > 0.0 { own.sqrt() * of_all.sqrt() } else { of_all };
        for j in 0..points {
            let (y, f) = (&stage.y[j * d..(j + 1) * d], &stage.f[j * m..(j + 1) * m]);
            shifted.copy_from_slice(y);
            let h = f64::EPSILON.sqrt() * y[c].abs().max(1e-3 * typical).max(1e-100);
            shifted[c] = y[c] + h;
            let mut h = shifted[c] - y[c];
            if system.density(block.times[j], &shifted, &mut moved).is_err() {
                // The domain of the density may lie on the other side.
                shifted[c] = y[c] - h;
                h = shifted[c] - y[c];
                system.density(block.times[j], &shifted, &mut moved)?;
            }
            for (Pair { unknown, density, .. }, w) in system.pairs.iter().zip(block.weights) {
                let slope = (moved[*density] - f[*density]) / h;
                if slope != 0.0 {
                    for i in 0..points {
                        matrix[(i * d + unknown, j * d + c)] -= w[i * points + j] * slope;
                    }
                }
            }
        }
    }
    Ok(matrix)
}
