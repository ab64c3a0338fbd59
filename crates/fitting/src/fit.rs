//! The problem, the fit, and the search over starting points.

use crate::intervals::covariance;
use crate::objective::Objective;
use crate::random::halton;
use crate::{FitError, Parameter, Residuals, gradient_method, simplex};
use invalid_input::InvalidInput;

/// Residuals as a function of the parameters: reads the parameters, writes every residual.
pub type ResidualsFn<'a> = dyn Fn(&[f64], &mut [f64]) + 'a;

/// Least squares over a closure: find the parameters that make the sum of squared residuals least.
///
/// A residual that is NaN, infinite or beyond 1e100 marks parameters at which the model does not exist; the search
/// stays away from them.
pub struct Problem<'a> {
    /// The parameters, in the order in which the closures take them.
    pub parameters: Vec<Parameter>,
    /// Number of residuals `m`, at least as many as parameters.
    pub count: usize,
    /// Writes the `m` residuals at the given parameters (in their own units, not transformed).
    pub residuals: &'a ResidualsFn<'a>,
    /// Writes the derivative of residual `i` in parameter `j` at `i * n + j`; central differences if absent.
    pub jacobian: Option<&'a ResidualsFn<'a>>,
}

/// How to search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Levenberg-Marquardt from every start: fast and precise where residuals are smooth.
    LevenbergMarquardt,
    /// The simplex method from every start: needs no derivative, slow, for few parameters.
    Simplex,
    /// Levenberg-Marquardt from every start, then the simplex method from the best point, for residuals with
    /// kinks: the first can stop at a kink, the second goes on along it.
    Both,
}

/// Settings of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Default [`Method::Both`].
    pub method: Method,
    /// Number of starting points: the parameters' own, then a Halton sequence over their search intervals (in the
    /// transformed coordinates). Default 8.
    pub starts: usize,
    /// Points of the sequence at which the sum of squares is evaluated to choose the starting points from: those where it
    /// is least. Default 0: the first of the sequence, whatever they are worth. Worth it where evaluating costs little
    /// beside searching, and the sum of squares has many minima.
    pub candidates: usize,
    /// Relative change in the sum of squares and in the parameters at which a search ends, from 1e-15 to 0.1.
    /// Default 1e-10. The search from each start ends at 1e-5 already, and the best goes on from there.
    pub tolerance: f64,
    /// Evaluations of the residuals that one search may take, those for differences aside. Default 2000.
    pub max_evaluations: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { method: Method::Both, starts: 8, candidates: 0, tolerance: 1e-10, max_evaluations: 2000 }
    }
}

/// How a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// At a minimum, by the method's own tests.
    Converged,
    /// At the limit of evaluations; the parameters are the best seen.
    LimitReached,
    /// The model was not finite at the starting point, so that nothing was searched.
    NonFinite,
}

/// One starting point and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    /// The starting point.
    pub from: Vec<f64>,
    /// Where its search ended, to about five digits.
    pub parameters: Vec<f64>,
    /// Sum of squares there.
    pub sum_of_squares: f64,
    /// How it ended.
    pub outcome: Outcome,
}

/// A fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The parameters found, in their own units.
    pub parameters: Vec<f64>,
    /// Sum of squared residuals.
    pub sum_of_squares: f64,
    /// How the search ended that found them.
    pub outcome: Outcome,
    /// The residuals.
    pub residuals: Vec<f64>,
    /// Their summary.
    pub report: Residuals,
    /// Every starting point. How many end at the same place tells how much the minimum can be trusted.
    pub starts: Vec<Start>,
    /// Evaluations of the residuals in all.
    pub evaluations: usize,
    /// Evaluations of the Jacobian in all.
    pub jacobians: usize,
    /// Covariance of the transformed coordinates, row by row; see [`Fit::intervals`].
    pub(crate) covariance: Option<Vec<f64>>,
    pub(crate) transforms: Vec<Parameter>,
}

impl Problem<'_> {
    /// Checks the parameters and the number of residuals.
    pub fn validate(&self) -> Result<(), InvalidInput> {
        let n = self.parameters.len();
        if n == 0 || n > 100 {
            return Err(InvalidInput::new(["parameters", "len()"], n, "1 to 100 parameters"));
        }
        if self.count < n {
            return Err(InvalidInput::new("count", self.count, "at least as many residuals as parameters"));
        }
        self.parameters.iter().try_for_each(Parameter::validate)
    }
}

impl Settings {
    /// Checks the ranges.
    pub fn validate(&self) -> Result<(), InvalidInput> {
        if !(1e-15..=0.1).contains(&self.tolerance) {
            return Err(InvalidInput::new("tolerance", self.tolerance, "a number from 1e-15 to 0.1"));
        }
        if !(1..=100_000).contains(&self.starts) {
            return Err(InvalidInput::new("starts", self.starts, "1 to 100000 starting points"));
        }
        if self.candidates > 1_000_000 {
            return Err(InvalidInput::new("candidates", self.candidates, "0 to 1000000 points"));
        }
        if !(1..=100_000_000).contains(&self.max_evaluations) {
            return Err(InvalidInput::new("max_evaluations", self.max_evaluations, "1 to 1e8 evaluations"));
        }
        Ok(())
    }
}

/// Fits the parameters. The same input gives the same bits.
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
pub fn fit(problem: &Problem, settings: &Settings) -> Result<Fit, FitError> {
    problem.validate()?;
    settings.validate()?;
    fit_weighted(problem, settings, None)
}

/// The fit with a weight for each residual; those of weight 0 count neither in the sum nor in the report.
pub(crate) fn fit_weighted(problem: &Problem, settings: &Settings, weights: Option<&[f64]>) -> Result<Fit, FitError> {
    let objective = Objective::new(problem, weights);
    let mut buffer = vec![0.0; problem.count];
    let mut starts = Vec::with_capacity(settings.starts);
    let mut best: Option<(Vec<f64>, f64, Outcome)> = None;
    // where a start leads needs few digits; the best one is then followed to the end
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
    let covariance = covariance(&objective, &u, value, weights);
    let parameters = objective.parameters(&u);
    // residuals without weights, of the points that took part
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

/// The parameters' own start, then points of the sequence: the first, or of the candidates those with the least sum.
fn starting_points(objective: &Objective, settings: &Settings, buffer: &mut [f64]) -> Vec<Vec<f64>> {
    let point = |index| starting_point(objective.problem, index);
    let more = settings.starts - 1;
    if settings.candidates <= more {
        return (0..settings.starts).map(point).collect();
    }
    let mut candidates: Vec<(f64, Vec<f64>)> =
        (1..=settings.candidates).map(point).map(|u| (objective.sum_of_squares(&u, buffer), u)).collect();
    // the sort is stable: of equal ones the first of the sequence
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    std::iter::once(point(0)).chain(candidates.into_iter().take(more).map(|(_, u)| u)).collect()
}

/// The parameters' own start, then Halton's points over the search intervals.
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

/// The simplex method with first steps of a `share` of each search interval.
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
    simplex::minimise(&mut value, from, &steps, settings.tolerance, settings.max_evaluations)
}
