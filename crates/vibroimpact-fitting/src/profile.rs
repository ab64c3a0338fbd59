//! The likelihood profile: how far one parameter can change if the others are adjusted.
//!
//! `S_j(u)` is the smallest sum of squares with the coordinate `u_j` fixed at `u`. For normal errors of unit variance the
//! interval `S_j(u) <= S + z^2` contains the parameter with the probability of `|normal| <= z`, to a higher order than the
//! interval from the covariance and in any coordinate (Bates and Watts 1988, ch. 6). `zeta = sqrt(S_j - S)` is linear in `u`
//! for a linear model, so that a secant finds the ends in few steps.
//!
//! Each search for `S_j` starts next to the last point that lies within the interval, from the better of two starts: the other
//! parameters as they are there, or moved along the direction that the profile has had so far, which is at first that of the
//! linearised problem. A search from further away may stop in another minimum, whose `zeta` is too large. An end is therefore a
//! point of the contour `zeta = z`. Where `zeta` jumps across the contour, as it does where the residuals jump, the end is the
//! jump, once a simplex search from the point before it has found no way around.

use crate::objective::{HUGE, Objective};
use crate::parameter::{Parameter, Range};
use crate::problem::{Method, Problem, ResidualsFn, Settings};
use crate::{gradient_method, simplex};
use invalid_input::InvalidInput;
use nalgebra::{DMatrix, DVector};

/// Largest number of searches for an end.
const MOST_SEARCHES: usize = 40;
/// An end beyond this change of a transformed coordinate, a factor of 3000, counts as open: models far out cost much and have
/// little meaning. Towards the search interval of a parameter that is outside it, the change counts from there. The same holds
/// for this many first steps of a coordinate that is not transformed.
const FURTHEST: f64 = 8.0;
const FURTHEST_IN_STEPS: f64 = 64.0;
/// Relative distance of `zeta` from its limit at which a point lies on the contour.
const NEAR: f64 = 3e-3;
/// A bracket that is this narrow, relative to its distance from the minimum or to the square of this times the first step,
/// contains a jump. In a transformed coordinate the distance counts as 1 at most: far from the minimum `zeta` may rise steeply
/// without a jump, and this is a factor.
const CLOSE: f64 = 1e-2;
/// After a way around a jump has been found, the next step is this many times the width of the bracket.
const ONWARD: f64 = 8.0;

/// The profile of one parameter.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Profile {
    /// Values of the parameter, ascending, with the smallest sum of squares for each.
    pub points: Vec<(f64, f64)>,
    /// Lower end of the interval; `None` if the sum of squares does not rise enough within a factor of 3000 (64 first steps of a
    /// parameter without limits), or as far as the model exists. If the parameter is above its search interval, the factor counts
    /// from there.
    pub low: Option<f64>,
    /// Upper end, likewise.
    pub high: Option<f64>,
    /// The parameters with the smallest sum of squares that was met, if it is below that of the fit: the fit is then not a minimum.
    pub better: Option<Vec<f64>>,
}

/// Follows the profile of parameter number `j` from a minimum at `parameters` with the sum of squares `least` until it has
/// risen by `rise`. `step` is the first step in the transformed coordinate, about the half-width that the covariance suggests.
/// The settings give tolerance and limit of the searches.
///
/// # Errors
/// A problem that cannot be fitted, a parameter number out of range, a parameter that is not finite, a sum of squares that is negative, a
/// rise or step that is not positive, or one of these from 1e100 on.
///
/// ```
/// use fitting::{Parameter, Problem, Settings, profile};
/// // r = (p - 2, q + p): S_p = (p - 2)^2, for q follows
/// let problem = Problem {
///     parameters: vec![Parameter::free("p", 0.0, (-9.0, 9.0)), Parameter::free("q", 0.0, (-9.0, 9.0))],
///     count: 2,
///     residuals: &|p, r| { r[0] = p[0] - 2.0; r[1] = p[1] + p[0]; },
///     jacobian: None,
/// };
/// let found = profile(&problem, &Settings::default(), &[2.0, -2.0], 0.0, 0, 4.0, 1.5)?;
/// assert!((found.low.unwrap() - 0.0).abs() < 0.02 && (found.high.unwrap() - 4.0).abs() < 0.02);
/// # Ok::<(), fitting::InvalidInput>(())
/// ```
pub fn profile(
    problem: &Problem,
    settings: &Settings,
    parameters: &[f64],
    least: f64,
    j: usize,
    rise: f64,
    step: f64,
) -> Result<Profile, InvalidInput> {
    problem.validate()?;
    settings.validate()?;
    let n = problem.parameters.len();
    if j >= n || parameters.len() != n {
        return Err(InvalidInput::new("j", j, "the index of a parameter; there must be a value for every parameter"));
    }
    for (k, value) in parameters.iter().enumerate() {
        InvalidInput::require_finite(("parameters", k), *value)?;
    }
    InvalidInput::unless((0.0..HUGE).contains(&least), "least", least, "a number from 0 to below 1e100")?;
    for (field, value) in [("rise", rise), ("step", step)] {
        InvalidInput::unless(value > 0.0 && value < HUGE, field, value, "a number above 0 and below 1e100")?;
    }
    let objective = Objective::new(problem, None);
    let centre: Vec<f64> = problem.parameters.iter().zip(parameters).map(|(p, value)| p.inward(*value)).collect();
    let tangent = tangent(&objective, &centre, j);
    let points = vec![(parameters[j], least)];
    let mut walk = Walk { problem, settings, j, least, centre, tangent, points, better: None };
    let low = walk.end(rise.sqrt(), -step);
    let high = walk.end(rise.sqrt(), step);
    let Walk { mut points, better, .. } = walk;
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(Profile { points, low, high, better: better.map(|(parameters, _)| parameters) })
}

struct Walk<'a> {
    problem: &'a Problem<'a>,
    settings: &'a Settings,
    j: usize,
    least: f64,
    /// The coordinates of the minimum, and the direction of the profile there.
    centre: Vec<f64>,
    tangent: Vec<f64>,
    points: Vec<(f64, f64)>,
    better: Option<(Vec<f64>, f64)>,
}

/// A point of the profile.
struct Point {
    /// Distance of the fixed coordinate from the minimum.
    reach: f64,
    zeta: f64,
    u: Vec<f64>,
}

impl Walk<'_> {
    /// The end of the interval in the direction of `step`.
    fn end(&mut self, limit: f64, step: f64) -> Option<f64> {
        let parameter = &self.problem.parameters[self.j];
        let origin = self.centre[self.j];
        let (furthest, widest) = if parameter.range == Range::Free {
            (FURTHEST_IN_STEPS * step.abs(), f64::INFINITY)
        } else {
            // A search that the data did not stop, as of a factor that is best at zero, may have left its interval far behind.
            let (low, high) = parameter.search;
            let outside = if step > 0.0 { parameter.inward(low) - origin } else { origin - parameter.inward(high) };
            (FURTHEST + outside.max(0.0), 1.0)
        };
        let end = |point: &Point| Some(parameter.outward(origin + point.reach));
        let mut inside = Point { reach: 0.0, zeta: 0.0, u: self.centre.clone() };
        let (mut along, mut stride) = (self.tangent.clone(), step);
        let mut outside: Option<Point> = None;
        for _ in 0..MOST_SEARCHES {
            let (reach, jumps) = match &outside {
                None if inside.reach.abs() >= furthest => return None,
                None => ((inside.reach + stride).clamp(-furthest, furthest), false),
                Some(beyond) => {
                    let width = beyond.reach - inside.reach;
                    // The secant if zeta is a number on both sides, halfway otherwise; not too near to either.
                    let share = (limit - inside.zeta) / (beyond.zeta - inside.zeta);
                    let share = if beyond.zeta.is_finite() { share.clamp(0.2, 0.95) } else { 0.5 };
                    let jumps = width.abs() <= CLOSE * beyond.reach.abs().min(widest).max(CLOSE * step.abs());
                    (if jumps { beyond.reach } else { inside.reach + share * width }, jumps)
                }
            };
            let point = self.least_at(reach, &inside, &along, jumps);
            let ends = (point.zeta - limit).abs() <= NEAR * limit || (jumps && point.zeta > limit);
            if ends || point.zeta < limit {
                self.points.push((parameter.outward(origin + reach), self.least + point.zeta * point.zeta));
            }
            if ends {
                // The model may not exist beyond the jump.
                return end(&point).filter(|_| point.zeta.is_finite());
            }
            if point.zeta > limit {
                outside = Some(point);
                continue;
            }
            let width = reach - inside.reach;
            if width.abs() >= CLOSE * step.abs() {
                along = point.u.iter().zip(&inside.u).map(|(new, old)| (new - old) / width).collect();
            }
            if jumps {
                (outside, stride) = (None, ONWARD * width);
            } else {
                stride = 2.0 * width;
                // The point beyond is not to be trusted if zeta is far smaller here than the secant has promised.
                outside = outside.filter(|_| point.zeta > 0.5 * limit);
            }
            inside = point;
        }
        outside.filter(|beyond| beyond.zeta.is_finite()).as_ref().and_then(end)
    }

    /// The point of the profile at this distance, searched from a point near it or, if that is better, from there along a
    /// direction; by the simplex method too if the search is to be `thorough`. `zeta` is infinite if the model does not exist.
    fn least_at(&mut self, reach: f64, from: &Point, along: &[f64], thorough: bool) -> Point {
        let (j, problem) = (self.j, self.problem);
        let held = self.centre[j] + reach;
        let value = problem.parameters[j].outward(held);
        let whole = |others: &[f64], at_j: f64| {
            let mut all = others.to_vec();
            all.insert(j, at_j);
            all
        };
        let without = |all: &[f64]| -> Vec<f64> {
            all.iter().enumerate().filter(|(k, _)| *k != j).map(|(_, entry)| *entry).collect()
        };
        let n = problem.parameters.len();
        let residuals = |others: &[f64], r: &mut [f64]| (problem.residuals)(&whole(others, value), r);
        let jacobian = |others: &[f64], rows: &mut [f64]| {
            let Some(full) = problem.jacobian else { return };
            let mut all = vec![f64::NAN; problem.count * n];
            full(&whole(others, value), &mut all);
            for (row, reduced) in all.chunks_exact(n).zip(rows.chunks_exact_mut(n - 1)) {
                reduced.copy_from_slice(&without(row));
            }
        };
        let parameters: Vec<Parameter> =
            problem.parameters.iter().enumerate().filter(|(k, _)| *k != j).map(|(_, p)| p.clone()).collect();
        let reduced = Problem {
            parameters,
            count: problem.count,
            residuals: &residuals,
            jacobian: problem.jacobian.is_some().then_some(&jacobian as &ResidualsFn),
        };
        let objective = Objective::new(&reduced, None);
        let mut buffer = vec![0.0; problem.count];
        let mut sum = |u: &[f64]| objective.sum_of_squares(u, &mut buffer);
        let mut tried = |u: Vec<f64>| (sum(&u), u);
        let lower = |a: (f64, Vec<f64>), b: (f64, Vec<f64>)| if b.0 < a.0 { b } else { a };
        let width = reach - from.reach;
        let mut best = tried(without(&from.u));
        // Without other parameters there is nothing to search.
        if n > 1 {
            let ahead: Vec<f64> = from.u.iter().zip(along).map(|(u, rate)| u + width * rate).collect();
            best = lower(best, tried(without(&ahead)));
        }
        if n > 1 && best.0.is_finite() {
            let start = best.1.clone();
            let settings = Settings { method: Method::LevenbergMarquardt, ..*self.settings };
            best = lower(best, tried(gradient_method::minimise(&objective, &start, &settings).0));
            if thorough {
                let steps: Vec<f64> = without(along).iter().map(|rate| width.abs() * rate.abs().max(1.0)).collect();
                let found = simplex::minimise(
                    &mut sum,
                    &start,
                    &steps,
                    &objective.units(),
                    settings.tolerance,
                    settings.max_evaluations,
                );
                best = lower(best, (found.value, found.u));
            }
        }
        let (least, others) = best;
        let u = whole(&others, held);
        // A fit may be improved by rounding within its tolerance.
        let known = self.better.as_ref().map_or(self.least - 1e-3 - 1e-6 * self.least, |(_, known)| *known);
        if least < known {
            self.better = Some((whole(&objective.parameters(&others), value), least));
        }
        Point { reach, zeta: (least - self.least).max(0.0).sqrt(), u }
    }
}

/// The direction in which the minimum moves with coordinate `j`, by the linearised problem: the change of each coordinate for a
/// change of `u_j` by 1.
fn tangent(objective: &Objective, u: &[f64], j: usize) -> Vec<f64> {
    let (m, n) = (objective.problem.count, u.len());
    if n == 1 {
        return vec![1.0];
    }
    let mut rows = vec![0.0; m * n];
    objective.jacobian(u, &mut rows);
    let jacobian = DMatrix::from_row_slice(m, n, &rows);
    let by_j = DVector::from_column_slice(jacobian.column(j).as_slice());
    let svd = jacobian.remove_column(j).svd(true, true);
    // Combinations that the data do not determine stay as they are.
    let others = svd.solve(&-by_j, 1e-8 * svd.singular_values.max());
    let mut change = others.map_or_else(|_| vec![0.0; n - 1], |found| found.as_slice().to_vec());
    change.insert(j, 1.0);
    change
}
