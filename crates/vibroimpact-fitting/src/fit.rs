//! The search over starting points.

use crate::error::FitError;
use crate::objective::Objective;
use crate::parameter::Parameter;
use crate::problem::{Fit, Method, Outcome, Problem, Settings, Start};
use crate::random::{Random, halton};
use crate::report::Residuals;
use crate::{gradient_method, simplex};

/// One in so many candidates is a point of the sequence; the others are drawn around the best.
const SHARE_OF_SEQUENCE: usize = 4;
/// Stages of these draws, the number of draws around each point, and the factor of their spread from stage to stage.
const STAGES: usize = 10;
const DRAWS_AROUND_EACH: usize = 4;
const SHRINKAGE: f64 = 0.6;
/// Seed of these draws.
const SEED: u64 = 5;

/// Fits the parameters. The same input gives the same result to the last bit.
///
/// ```
/// use fitting::{Parameter, Problem, Settings, fit};
/// let (t, y) = ([0.0, 1.0, 2.0, 3.0], [2.0, 1.21, 0.74, 0.45]);
/// let found = fit(
///     &Problem {
///         parameters: vec![
///             Parameter::positive("amplitude", 1.0, (0.1, 10.0)),
///             Parameter::positive("rate", 1.0, (0.1, 10.0)),
///         ],
///         count: 4,
///         residuals: &|p, r| (0..4).for_each(|i| r[i] = p[0] * (-p[1] * t[i]).exp() - y[i]),
///         jacobian: None,
///     },
///     &Settings::default(),
/// )?;
/// assert!((found.parameters[1] - 0.5).abs() < 0.01 && found.report.rms < 0.01);
/// # Ok::<(), fitting::FitError>(())
/// ```
///
/// # Errors
/// [`FitError::Invalid`] as [`Problem::validate`] and [`Settings::validate`]; [`FitError::NonFiniteModel`] if the model is not
/// finite at any starting point.
pub fn fit(problem: &Problem, settings: &Settings) -> Result<Fit, FitError> {
    problem.validate()?;
    settings.validate()?;
    fit_weighted(problem, settings, None)
}

/// The fit with a weight for each residual. Residuals of weight 0 count neither in the sum nor in the report.
pub(crate) fn fit_weighted(problem: &Problem, settings: &Settings, weights: Option<&[f64]>) -> Result<Fit, FitError> {
    let objective = Objective::new(problem, weights);
    let mut buffer = vec![0.0; problem.count];
    let mut starts = Vec::with_capacity(settings.starts);
    let mut best: Option<(Vec<f64>, f64, Outcome)> = None;
    // Few digits suffice to see where a start leads; only the best one is continued to the end.
    let scouting = Settings { tolerance: settings.tolerance.max(1e-5), ..*settings };
    for from in starting_points(&objective, settings, &mut buffer) {
        let (u, outcome) = search(&objective, &scouting, &from, &mut buffer);
        let value = objective.sum_of_squares(&u, &mut buffer);
        starts.push(Start {
            from: objective.parameters(&from),
            parameters: objective.parameters(&u),
            sum_of_squares: value,
            outcome,
        });
        if value.is_finite() && best.as_ref().is_none_or(|best| value < best.1) {
            best = Some((u, value, outcome));
        }
    }
    let Some((mut u, mut value, mut outcome)) = best else {
        return Err(FitError::NonFiniteModel { starts: settings.starts });
    };
    let (end, ended) = search(&objective, settings, &u, &mut buffer);
    let reached = objective.sum_of_squares(&end, &mut buffer);
    if reached <= value {
        (u, value, outcome) = (end, reached, ended);
    }
    if settings.method == Method::Both {
        let found = simplex_search(&objective, settings, &u, 0.1, &mut buffer);
        if found.value <= value {
            outcome = if found.converged { Outcome::Converged } else { Outcome::LimitReached };
            (u, value) = (found.u, found.value);
        }
    }
    let covariance = objective.covariance(&u, value, weights);
    let parameters = objective.parameters(&u);
    // Residuals without weights, of the points that took part.
    (problem.residuals)(&parameters, &mut buffer);
    let residuals: Vec<f64> = match weights {
        None => buffer,
        Some(weights) => buffer.iter().zip(weights).filter(|(_, w)| **w > 0.0).map(|(r, _)| *r).collect(),
    };
    Ok(Fit {
        parameters,
        sum_of_squares: value,
        outcome,
        report: Residuals::of(&residuals),
        residuals,
        starts,
        evaluations: objective.evaluations.get() + 1,
        jacobians: objective.jacobians.get(),
        covariance,
        transforms: problem.parameters.clone(),
    })
}

/// The starting point of the parameters, then points of the sequence: the first ones, or the most promising candidates.
fn starting_points(objective: &Objective, settings: &Settings, buffer: &mut [f64]) -> Vec<Vec<f64>> {
    let more = settings.starts - 1;
    if settings.candidates <= more {
        return (0..settings.starts).map(|index| starting_point(objective.problem, index)).collect();
    }
    let own = starting_point(objective.problem, 0);
    std::iter::once(own).chain(promising(objective, settings.candidates, more, buffer)).collect()
}

/// The `more` best of some candidates that are apart from each other. A quarter of the candidates are points of the sequence. The
/// others are drawn in stages around the best so far, with a spread that shrinks from stage to stage: where the sum of squares
/// has many minima, those near the least are mostly low themselves, and points of the sequence alone are too far apart.
fn promising(objective: &Objective, candidates: usize, more: usize, buffer: &mut [f64]) -> Vec<Vec<f64>> {
    let parameters = &objective.problem.parameters;
    let widths: Vec<f64> = parameters.iter().map(|p| p.inward(p.search.1) - p.inward(p.search.0)).collect();
    let first = (candidates / SHARE_OF_SEQUENCE).max(more);
    let mut tried = |u: Vec<f64>| (objective.sum_of_squares(&u, buffer), u);
    let mut found: Vec<(f64, Vec<f64>)> =
        (1..=first).map(|index| tried(starting_point(objective.problem, index))).collect();
    let drawn = candidates - first;
    let mut random = Random::new(SEED);
    // the distance between points of the sequence, as a share of each interval
    let mut spread = (first as f64).powf(-1.0 / widths.len() as f64);
    for stage in 0..STAGES {
        let count = drawn * (stage + 1) / STAGES - drawn * stage / STAGES;
        let around = apart(&mut found, count.div_ceil(DRAWS_AROUND_EACH), spread, &widths);
        let draws = around.iter().cycle().take(count).map(|centre| {
            centre.iter().zip(&widths).map(|(u, width)| u + spread * width * random.normal()).collect::<Vec<f64>>()
        });
        let draws: Vec<_> = draws.map(&mut tried).collect();
        found.extend(draws);
        spread *= SHRINKAGE;
    }
    apart(&mut found, more, spread, &widths)
}

/// The best `count` points, of which none is within half the `spread` of a better one in all coordinates, as far as there are so
/// many; then the best of the others. Sorts the points.
fn apart(found: &mut [(f64, Vec<f64>)], count: usize, spread: f64, widths: &[f64]) -> Vec<Vec<f64>> {
    // the sort is stable: among equal points the first is used
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut chosen, mut others): (Vec<&Vec<f64>>, Vec<&Vec<f64>>) = (Vec::new(), Vec::new());
    for (_, u) in found.iter() {
        if chosen.len() == count {
            break;
        }
        let near = |better: &&Vec<f64>| {
            better.iter().zip(u).zip(widths).all(|((a, b), width)| (a - b).abs() <= 0.5 * spread * width)
        };
        if chosen.iter().any(near) { others.push(u) } else { chosen.push(u) }
    }
    chosen.into_iter().chain(others).take(count).cloned().collect()
}

/// The starting point of the parameters, then Halton's points over the search intervals.
fn starting_point(problem: &Problem, index: usize) -> Vec<f64> {
    let place = |(dimension, parameter): (usize, &Parameter)| {
        if index == 0 {
            return parameter.inward(parameter.start);
        }
        let (low, high) = (parameter.inward(parameter.search.0), parameter.inward(parameter.search.1));
        low + (high - low) * halton(index, dimension)
    };
    problem.parameters.iter().enumerate().map(place).collect()
}

fn search(objective: &Objective, settings: &Settings, from: &[f64], buffer: &mut [f64]) -> (Vec<f64>, Outcome) {
    if !objective.residuals(from, buffer) {
        return (from.to_vec(), Outcome::NonFinite);
    }
    let (u, converged) = match settings.method {
        Method::LevenbergMarquardt | Method::Both => gradient_method::minimise(objective, from, settings),
        Method::Simplex => {
            let found = simplex_search(objective, settings, from, 0.25, buffer);
            (found.u, found.converged)
        }
    };
    (u, if converged { Outcome::Converged } else { Outcome::LimitReached })
}

/// The simplex method with first steps of this `share` of each search interval.
fn simplex_search(
    objective: &Objective,
    settings: &Settings,
    from: &[f64],
    share: f64,
    buffer: &mut [f64],
) -> simplex::Found {
    let step = |(parameter, u): (&Parameter, &f64)| {
        let length = parameter.inward(parameter.search.1) - parameter.inward(parameter.search.0);
        share * if length > 0.0 { length } else { u.abs().max(1.0) }
    };
    let steps: Vec<f64> = objective.problem.parameters.iter().zip(from).map(step).collect();
    let mut value = |u: &[f64]| objective.sum_of_squares(u, buffer);
    simplex::minimise(&mut value, from, &steps, &objective.units(), settings.tolerance, settings.max_evaluations)
}
