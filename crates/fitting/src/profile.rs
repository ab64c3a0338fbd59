//! The likelihood profile: how far one parameter can change if the others are adjusted.
//!
//! `S_j(u)` is the smallest sum of squares with the coordinate `u_j` fixed at `u`. For normal errors of unit variance the
//! interval `S_j(u) <= S + z^2` contains the parameter with the probability of `|normal| <= z`, to a higher order than the
//! interval from the covariance and in any coordinate (Bates and Watts 1988, ch. 6). `zeta = sqrt(S_j - S)` is linear in `u`
//! for a linear model, so that a secant finds the ends in few steps.

use crate::gradient_method;
use crate::objective::{HUGE, Objective};
use crate::parameter::{Parameter, Range};
use crate::problem::{Method, Problem, ResidualsFn, Settings};
use invalid_input::InvalidInput;

/// Number of doublings of the step after which an end counts as open.
const MOST_DOUBLINGS: usize = 6;
/// An end beyond this change of a transformed coordinate, a factor of 3000, also counts as open: models far out cost much and
/// have little meaning.
const FURTHEST: f64 = 8.0;
/// Steps of the secant towards an end, and the relative distance of `zeta` from its limit at which it ends.
const MOST_SECANTS: usize = 12;
const NEAR: f64 = 3e-3;

/// The profile of one parameter.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Profile {
    /// Values of the parameter, ascending, with the smallest sum of squares for each.
    pub points: Vec<(f64, f64)>,
    /// Lower end of the interval; `None` if the sum of squares does not rise enough as far as the model exists.
    pub low: Option<f64>,
    /// Upper end, likewise.
    pub high: Option<f64>,
    /// Parameters with a smaller sum of squares than those of the fit, if the search found any: the fit is then not a minimum,
    /// and the profile ends where they were found.
    pub better: Option<Vec<f64>>,
}

/// Follows the profile of parameter number `j` from a minimum at `parameters` with the sum of squares `least` until it has
/// risen by `rise`. `step` is the first step in the transformed coordinate, about the half-width that the covariance suggests.
/// The settings give tolerance and limit of the searches, which start where the last one ended.
///
/// # Errors
/// A problem that cannot be fitted, a parameter number out of range, a rise or step that is not positive.
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
        return Err(InvalidInput::new("j", j, "the number of a parameter, with a value for every parameter"));
    }
    if !(rise > 0.0 && rise < HUGE && step > 0.0 && step < HUGE && least >= 0.0) {
        return Err(InvalidInput::new("rise, step", format!("{rise}, {step}"), "positive numbers"));
    }
    let mut walk = Walk { problem, settings, j, least, better: None, points: vec![(parameters[j], least)] };
    let low = walk.end(parameters, rise.sqrt(), -step);
    let high = walk.end(parameters, rise.sqrt(), step);
    let Walk { mut points, better, .. } = walk;
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(Profile { points, low, high, better })
}

struct Walk<'a> {
    problem: &'a Problem<'a>,
    settings: &'a Settings,
    j: usize,
    least: f64,
    points: Vec<(f64, f64)>,
    better: Option<Vec<f64>>,
}

impl Walk<'_> {
    /// The end of the interval in the direction of `step`.
    fn end(&mut self, parameters: &[f64], limit: f64, step: f64) -> Option<f64> {
        let parameter = &self.problem.parameters[self.j];
        let origin = parameter.inward(parameters[self.j]);
        let mut at = parameters.to_vec();
        // (distance, zeta) on both sides of the limit.
        let (mut inside, mut reach) = ((0.0, 0.0), step);
        let mut outside = None;
        for _ in 0..=MOST_DOUBLINGS {
            if parameter.range != Range::Free && reach.abs() > FURTHEST {
                return None;
            }
            let zeta = self.zeta(&mut at, origin + reach)?;
            if zeta.is_infinite() {
                // The sum of squares has not risen enough as far as the model exists.
                return None;
            }
            if zeta >= limit {
                outside = Some((reach, zeta));
                break;
            }
            inside = (reach, zeta);
            reach *= 2.0;
        }
        let mut outside = outside?;
        for _ in 0..MOST_SECANTS {
            if (outside.1 - limit).abs() <= NEAR * limit {
                break;
            }
            // The secant if zeta is a number on both sides, halfway otherwise.
            let share = (limit - inside.1) / (outside.1 - inside.1);
            let share = if outside.1.is_finite() { share.clamp(0.05, 0.95) } else { 0.5 };
            let reach = inside.0 + share * (outside.0 - inside.0);
            let zeta = self.zeta(&mut at, origin + reach)?;
            if (zeta - limit).abs() <= NEAR * limit {
                outside = (reach, zeta);
            } else if zeta < limit {
                inside = (reach, zeta);
            } else {
                outside = (reach, zeta);
            }
        }
        Some(parameter.outward(origin + outside.0))
    }

    /// `zeta` with the coordinate fixed at `u`. The others start at `at`, and `at` returns their end. Infinite if the model
    /// does not exist; `None` after a sum of squares below `least` has been found.
    fn zeta(&mut self, at: &mut [f64], u: f64) -> Option<f64> {
        let (j, problem) = (self.j, self.problem);
        at[j] = problem.parameters[j].outward(u);
        let held = at[j];
        let whole = |others: &[f64]| {
            let mut all = others.to_vec();
            all.insert(j, held);
            all
        };
        let without = |all: &[f64]| -> Vec<f64> {
            all.iter().enumerate().filter(|(k, _)| *k != j).map(|(_, value)| *value).collect()
        };
        let n = problem.parameters.len();
        let residuals = |others: &[f64], r: &mut [f64]| (problem.residuals)(&whole(others), r);
        let jacobian = |others: &[f64], rows: &mut [f64]| {
            let Some(full) = problem.jacobian else { return };
            let mut all = vec![f64::NAN; problem.count * n];
            full(&whole(others), &mut all);
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
        let start: Vec<f64> = reduced.parameters.iter().zip(without(at)).map(|(p, value)| p.inward(value)).collect();
        let settings = Settings { method: Method::LevenbergMarquardt, ..*self.settings };
        let there = objective.sum_of_squares(&start, &mut buffer);
        let (end, value) = if start.is_empty() || !there.is_finite() {
            (start, there)
        } else {
            let (end, _) = gradient_method::minimise(&objective, &start, &settings);
            let value = objective.sum_of_squares(&end, &mut buffer);
            if value <= there { (end, value) } else { (start, there) }
        };
        if !value.is_finite() {
            return Some(f64::INFINITY);
        }
        at.copy_from_slice(&whole(&objective.parameters(&end)));
        self.points.push((held, value));
        // A fit may be improved by rounding within its tolerance.
        if value < self.least - 1e-3 - 1e-6 * self.least {
            self.better = Some(at.to_vec());
            return None;
        }
        Some((value - self.least).max(0.0).sqrt())
    }
}
