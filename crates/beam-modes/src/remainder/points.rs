//! One set of remainder modes for several points of a body: block Gauss quadrature with one block.

use super::{ASYMPTOTIC_MEAN, highest, require_mode};
use crate::dense::{eigen, product};
use faer::Mat;
use invalid_input::InvalidInput;

/// A mode at several points of a structure.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct PointsMode {
    /// Natural frequency, rad/s.
    pub omega_rad_s: f64,
    /// Mass-normalised shape at each of the points, kg^(-1/2).
    pub shapes: Vec<f64>,
}

/// Directions with less than this share of the largest eigenvalue of the scaled residual compliance are rounding: points that
/// coincide, or that move together in the tail.
const DEPENDENT: f64 = 1e-11;

/// Points whose shapes are smaller than this, relative to those of the point that moves most, are at rest to rounding.
const NODE: f64 = 1e-13;

/// Remainder modes of the truncated modes at several points of one body: at most one per point, fewer if points coincide or are
/// nodes of all shapes of the tail.
///
/// They match the first two moments `M_j = sum_{k > N} phi_k phi_k^T / omega_k^(2 j)`, `j = 1, 2`, which are matrices over the
/// points, so that the response at every point to a force at every other is correct. With `M_2 u = x M_1 u` and
/// `u^T M_1 u = 1`, each solution is a mode `omega = x^(-1/2)` with the shape `omega M_1 u`.
///
/// `tail` contains the modes that were computed but are truncated, all with the same number of shapes; `static_rest_m_n`, row
/// by row, is the contribution of the modes beyond to the static Green's function between the points, as for
/// [`remainder_modes`](super::remainder_modes).
///
/// # Errors
/// [`InvalidInput`] as for [`remainder_modes`](super::remainder_modes), for different numbers of shapes, and for a
/// `static_rest_m_n` that is not a matrix over the points.
pub fn remainder_at_points(tail: &[PointsMode], static_rest_m_n: &[f64]) -> Result<Vec<PointsMode>, InvalidInput> {
    let points = tail.first().map_or(0, |mode| mode.shapes.len());
    for (k, mode) in tail.iter().enumerate() {
        require_mode(mode.omega_rad_s, &mode.shapes).map_err(|fault| fault.at(k).within("tail"))?;
        if mode.shapes.len() != points {
            return Err(InvalidInput::new(
                ("tail", k, "shapes"),
                format!("{} values", mode.shapes.len()),
                "a list with one value for each point, as long as that of every other mode",
            ));
        }
    }
    if static_rest_m_n.len() != points * points {
        let given = format!("{} values", static_rest_m_n.len());
        return Err(InvalidInput::new("static_rest_m_n", given, "a square matrix with one row for each point"));
    }
    if let Some(entry) = static_rest_m_n.iter().find(|entry| entry.is_nan() || entry.abs() > 1e60) {
        return Err(InvalidInput::new("static_rest_m_n", *entry, "a matrix of numbers of at most 1e60 in size"));
    }
    let Some(highest) = highest(tail.iter().map(|mode| mode.omega_rad_s)) else {
        return Ok(Vec::new());
    };

    // Moments with x in units of 1/highest^2.
    let moment = |i: usize, j: usize, order: i32| {
        let rest = 0.5 * (static_rest_m_n[i * points + j] + static_rest_m_n[j * points + i]);
        let term = |mode: &PointsMode| {
            let [p, q] = [i, j].map(|point| mode.shapes[point] / mode.omega_rad_s);
            p * q * (highest / mode.omega_rad_s).powi(2 * (order - 1))
        };
        tail.iter().map(term).sum::<f64>() + rest * ASYMPTOTIC_MEAN.powi(order - 1)
    };
    // Every point is scaled by its own compliance, so that one that hardly moves counts like the others.
    let size: Vec<f64> = (0..points).map(|i| moment(i, i, 1).max(0.0).sqrt()).collect();
    let floor = NODE * size.iter().copied().fold(0.0, f64::max);
    let scale: Vec<f64> = size.iter().map(|&size| if size > floor { size } else { 0.0 }).collect();
    let over = |value: f64, i: usize, j: usize| {
        let size = scale[i] * scale[j];
        if size > 0.0 { value / size } else { 0.0 }
    };
    let first = Mat::from_fn(points, points, |i, j| over(moment(i, j, 1), i, j));
    let second = Mat::from_fn(points, points, |i, j| over(moment(i, j, 2), i, j));
    let unsolved =
        || InvalidInput::new("tail", "as given", "a list of modes whose moments double precision can resolve");
    let (values, vectors) = eigen(first.as_ref()).ok_or_else(unsolved)?;
    let largest = values.iter().copied().fold(0.0, f64::max);
    let kept: Vec<usize> = (0..points).filter(|&r| values[r] > DEPENDENT * largest).collect();
    // Columns Q D^(-1/2) of the part of M_1 that is not singular.
    let whiten = Mat::from_fn(points, kept.len(), |i, r| vectors[(i, kept[r])] / values[kept[r]].sqrt());
    let reduced = product(product(whiten.transpose(), second.as_ref()).as_ref(), whiten.as_ref());
    let (poles, directions) = eigen(reduced.as_ref()).ok_or_else(unsolved)?;
    let shapes = product(product(first.as_ref(), whiten.as_ref()).as_ref(), directions.as_ref());

    let mode = |r: usize| {
        let omega_rad_s = highest / poles[r].sqrt();
        let shapes = (0..points).map(|i| omega_rad_s * scale[i] * shapes[(i, r)]).collect();
        PointsMode { omega_rad_s, shapes }
    };
    // x > 0 except for rounding in directions of little weight.
    Ok((0..kept.len()).rev().filter(|&r| poles[r] > 0.0).map(mode).collect())
}
