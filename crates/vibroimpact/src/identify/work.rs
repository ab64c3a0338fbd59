//! The search: residuals and Jacobian of all rows, fits, the estimate of the noise, profiles.

use std::sync::{Mutex, PoisonError};

use fitting::{
    Fit, FitError, Information, Method, Outcome, Parameter, Problem, Profile, Settings, Start, fit, profile,
};
use invalid_input::InvalidInput;

use super::derivative::{Derivatives, Prediction, derivatives, predict};
use super::forward::Model;
use super::gauge::FORCE;
use crate::scene::json::number;

/// Relative change of the sum of squares at which a search ends; its derivatives are differences.
const TOLERANCE: f64 = 1e-8;
const MOST_EVALUATIONS: usize = 400;
/// Number of evaluated points for each starting point of the search.
const CANDIDATES_PER_START: usize = 64;
/// Number of minima of the robust sum from which the sum of squares is minimised, and the distance, in the transformed coordinates,
/// within which two ends are one minimum.
const MOST_MINIMA: usize = 4;
const SAME_MINIMUM: f64 = 1e-3;
/// Largest distance of a parameter from its start, in its transformed coordinate: a factor of 20,000.
pub(super) const FURTHEST: f64 = 10.0;
/// Rounds of fit and estimate of the noise, and the relative change at which they agree.
const MOST_ROUNDS: usize = 12;
const AGREED: f64 = 1e-3;
/// Relative noise that determines the weights of the quantities in the first round, and the least that is estimated, which is about
/// that of the solver.
const FIRST_NOISE: f64 = 0.05;
const LEAST_NOISE: f64 = 1e-9;
/// Largest number of times that a profile may find a better minimum.
const MOST_RESTARTS: usize = 4;

/// The function of the residuals that is summed.
#[derive(Clone, Copy, PartialEq)]
enum Loss {
    /// Their squares.
    Squares,
    /// `ln(1 + r^2)`, in which outliers, such as rows whose contacts have split or joined, count little: parameters near the
    /// best ones are then recognised by the rows that fit.
    Robust,
}

impl Loss {
    /// The number whose square is summed in place of that of `r`.
    fn of(self, r: f64) -> f64 {
        match self {
            Loss::Squares => r,
            Loss::Robust => (r * r).ln_1p().sqrt().copysign(r),
        }
    }

    /// Its derivative.
    fn slope(self, r: f64) -> f64 {
        match self {
            Loss::Robust if r.abs() > 1e-8 => r / ((1.0 + r * r) * self.of(r)),
            _ => 1.0,
        }
    }
}

/// Derivatives of every row at some parameters; `None` for a row whose impact cannot be resolved nearby.
pub(super) struct Known {
    at: Vec<f64>,
    pub rows: Vec<Option<Derivatives>>,
}

/// A search in progress.
pub(super) struct Work<'a> {
    pub model: &'a Model<'a>,
    pub coordinates: Vec<Parameter>,
    /// Of each residual: the measured value, and which of `groups` it belongs to.
    pub measured: Vec<(f64, usize)>,
    /// A group of values with the same noise: a quantity, or the force.
    pub groups: Vec<&'static str>,
    /// Standard deviation of each residual.
    pub sd: Vec<f64>,
    pub freedom: usize,
    pub parameters: Vec<f64>,
    pub sum_of_squares: f64,
    /// Derivatives at the last parameters.
    pub known: Mutex<Option<Known>>,
}

impl<'a> Work<'a> {
    pub fn new(model: &'a Model<'a>, coordinates: Vec<Parameter>) -> Result<Work<'a>, InvalidInput> {
        let mut measured: Vec<(f64, usize)> = Vec::new();
        let mut groups: Vec<&'static str> = Vec::new();
        let mut sd: Vec<Option<f64>> = Vec::new();
        let mut group = |name: &'static str| {
            groups.iter().position(|known| *known == name).unwrap_or_else(|| {
                groups.push(name);
                groups.len() - 1
            })
        };
        let mut records = 0;
        for row in &model.data.rows {
            for (quantity, value, stated) in &row.measured {
                measured.push((*value, group(quantity.name())));
                sd.push(*stated);
            }
            if let Some((record, stated)) = &row.force {
                let place = group(FORCE);
                measured.extend(record.force_n.iter().map(|force| (*force, place)));
                sd.extend(record.force_n.iter().map(|_| *stated));
                records += 1;
            }
        }
        // quantities without stated noise begin with the same share of their size
        let first: Vec<f64> =
            (0..groups.len()).map(|place| (FIRST_NOISE * size(&measured, place)).max(1e-30)).collect();
        let sd = sd.into_iter().zip(&measured).map(|(stated, (_, place))| stated.unwrap_or(first[*place])).collect();
        let freedom = measured.len() - coordinates.len() - records;
        let parameters: Vec<f64> = coordinates.iter().map(|parameter| parameter.start).collect();
        let known = Mutex::new(None);
        let work =
            Work { model, coordinates, measured, groups, sd, freedom, parameters, sum_of_squares: f64::NAN, known };
        work.require_predictions()?;
        Ok(work)
    }

    /// Checks that the measured quantities exist at the start of the search.
    fn require_predictions(&self) -> Result<(), InvalidInput> {
        for (row, prediction) in self.model.data.rows.iter().zip(self.predictions(&self.parameters)) {
            let values = prediction.map(|found| found.values).unwrap_or_default();
            for (k, (quantity, measured, _)) in row.measured.iter().enumerate() {
                if !values.get(k).is_some_and(|value| value.is_finite()) {
                    let field = format!("line {}, {}", row.line, quantity.name());
                    let allowed = "a quantity that the impact has with the scene's values, because this impact does not end in \
                                   a rebound, or has no contact";
                    return Err(InvalidInput::new(field, number(*measured), allowed));
                }
            }
        }
        Ok(())
    }

    pub fn predictions(&self, parameters: &[f64]) -> Vec<Option<Prediction>> {
        self.model.for_rows(|_, row, kept| predict(self.model, row, parameters, None, kept))
    }

    /// Writes the residuals, Eq. (1); NaN if an impact cannot be resolved.
    pub fn residuals(&self, parameters: &[f64], residuals: &mut [f64]) {
        let far = |(c, p): (&Parameter, &f64)| (c.inward(*p) - c.inward(c.start)).abs() > FURTHEST;
        if self.coordinates.iter().zip(parameters).any(far) {
            return residuals.fill(f64::NAN);
        }
        let mut place = 0;
        for (row, prediction) in self.model.data.rows.iter().zip(self.predictions(parameters)) {
            let count = row.measured.len() + row.force.as_ref().map_or(0, |(record, _)| record.time_s.len());
            for k in place..place + count {
                let value = prediction.as_ref().and_then(|found| found.values.get(k - place));
                residuals[k] = value.map_or(f64::NAN, |value| (value - self.measured[k].0) / self.sd[k]);
            }
            place += count;
        }
    }

    /// Writes the Jacobian in the transformed coordinates, row by row, with the offsets of gauges eliminated.
    fn jacobian(&self, parameters: &[f64], rows: &mut [f64]) {
        let n = self.coordinates.len();
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if known.as_ref().is_none_or(|known| known.at != parameters) {
            let of_row = |_, row: &_, kept: &mut _| derivatives(self.model, row, &self.coordinates, parameters, kept);
            *known = Some(Known { at: parameters.to_vec(), rows: self.model.for_rows(of_row) });
        }
        rows.fill(f64::NAN);
        let mut place = 0;
        for (row, found) in self.model.data.rows.iter().zip(known.iter().flat_map(|known| &known.rows)) {
            let scalars = row.measured.len();
            let count = scalars + row.force.as_ref().map_or(0, |(record, _)| record.time_s.len());
            if let Some(found) = found {
                let part = &mut rows[place * n..(place + count) * n];
                for ((entry, value), k) in part.iter_mut().zip(&found.rows).zip(0..) {
                    *entry = value / self.sd[place + k / n];
                }
                let q: Vec<f64> =
                    found.in_offset.iter().zip(&self.sd[place + scalars..]).map(|(rate, sd)| rate / sd).collect();
                project_out(&mut part[scalars * n..], &q, n);
            }
            place += count;
        }
    }

    fn with_problem<R>(&self, loss: Loss, start: &[f64], work: impl FnOnce(&Problem) -> R) -> R {
        let begun = |(parameter, start): (&Parameter, &f64)| Parameter { start: *start, ..parameter.clone() };
        work(&Problem {
            parameters: self.coordinates.iter().zip(start).map(begun).collect(),
            count: self.measured.len(),
            residuals: &|p, r| {
                self.residuals(p, r);
                r.iter_mut().for_each(|r| *r = loss.of(*r));
            },
            jacobian: Some(&|p, rows| {
                self.jacobian(p, rows);
                // the crate `fitting` needs derivatives with respect to the parameters themselves
                let slopes: Vec<f64> = self.coordinates.iter().zip(p).map(|(c, p)| c.slope(*p)).collect();
                rows.iter_mut().zip(slopes.iter().cycle()).for_each(|(entry, slope)| *entry /= slope);
                if loss == Loss::Robust {
                    let mut r = vec![0.0; self.measured.len()];
                    self.residuals(p, &mut r);
                    for (row, r) in rows.chunks_exact_mut(slopes.len()).zip(r) {
                        row.iter_mut().for_each(|entry| *entry *= loss.slope(r));
                    }
                }
            }),
        })
    }

    /// The starting points, and the best minima of the robust sum to which they lead.
    fn scout(&self, starts: usize) -> Option<(Vec<Start>, Vec<Vec<f64>>)> {
        let settings = Settings { starts, candidates: CANDIDATES_PER_START * (starts - 1), ..settings() };
        let found = self.with_problem(Loss::Robust, &self.parameters, |problem| fit(problem, &settings)).ok()?;
        let mut ends: Vec<&Start> = found.starts.iter().filter(|start| start.sum_of_squares.is_finite()).collect();
        ends.sort_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares));
        let mut minima = vec![found.parameters.clone()];
        for end in ends {
            let inward = |of: &[f64], j: usize| self.coordinates[j].inward(of[j]);
            let same = |other: &Vec<f64>| {
                (0..other.len()).all(|j| (inward(other, j) - inward(&end.parameters, j)).abs() < SAME_MINIMUM)
            };
            if minima.len() < MOST_MINIMA && !minima.iter().any(same) {
                minima.push(end.parameters.clone());
            }
        }
        Some((found.starts, minima))
    }

    /// Fits from the best minima of the robust search and from the present parameters, and estimates the noise if it is not stated. Returns
    /// the starts, and whether the search converged.
    pub fn search(&mut self, starts: usize) -> Result<(Vec<Start>, bool), InvalidInput> {
        let (told, scouted) = if starts > 1 { self.scout(starts) } else { None }.unzip();
        let mut begin = vec![self.parameters.clone()];
        begin.extend(scouted.into_iter().flatten());
        let mut agreed = false;
        let mut outcome = Outcome::Converged;
        for _ in 0..MOST_ROUNDS {
            let settings = Settings { starts: 1, ..settings() };
            let fits =
                begin.iter().map(|start| self.with_problem(Loss::Squares, start, |problem| fit(problem, &settings)));
            let fits: Vec<_> = fits.collect();
            let sum =
                |found: &Result<Fit, FitError>| found.as_ref().map_or(f64::INFINITY, |found| found.sum_of_squares);
            let best = fits.into_iter().min_by(|a, b| sum(a).total_cmp(&sum(b)));
            let found = best.unwrap_or(Err(FitError::NonFiniteModel { starts })).map_err(|fault| {
                let allowed = format!("such that the model can be fitted to them ({fault})");
                InvalidInput::new("number of measured values", self.measured.len().to_string(), allowed)
            })?;
            self.parameters.clone_from(&found.parameters);
            self.sum_of_squares = found.sum_of_squares;
            outcome = found.outcome;
            begin = vec![found.parameters];
            agreed = self.model.data.stated || self.estimate_noise(&found.residuals);
            if agreed {
                break;
            }
        }
        Ok((told.unwrap_or_default(), agreed && outcome == Outcome::Converged))
    }

    /// Estimates the noise of each group from residuals. Returns whether the estimates have converged.
    fn estimate_noise(&mut self, residuals: &[f64]) -> bool {
        let mut settled = true;
        for (place, freedom) in self.freedom_of_groups().into_iter().enumerate() {
            let of_group = |k: &usize| self.measured[*k].1 == place;
            let members: Vec<usize> = (0..self.measured.len()).filter(of_group).collect();
            let squares: f64 = members.iter().map(|&k| residuals[k].powi(2)).sum();
            let factor = (squares / freedom).sqrt();
            if factor.is_nan() {
                continue;
            }
            // the residuals of exact data are rounding errors, and their noise is that of the solver
            let least = (LEAST_NOISE * size(&self.measured, place)).max(1e-30);
            for k in members {
                let estimated = (factor * self.sd[k]).max(least);
                settled &= (estimated / self.sd[k] - 1.0).abs() < AGREED;
                self.sd[k] = estimated;
            }
        }
        settled
    }

    /// Degrees of freedom `f_q` of the noise of each group, Eq. (4): the number of its values minus their leverage, at least one.
    pub fn freedom_of_groups(&self) -> Vec<f64> {
        let (n, m) = (self.coordinates.len(), self.measured.len());
        let known = self.information().ok().and_then(|(rows, information)| Some((rows, information.covariance()?)));
        let mut left = vec![0.0; self.groups.len()];
        for (k, (_, group)) in self.measured.iter().enumerate() {
            let leverage = known.as_ref().map_or(n as f64 / m as f64, |(rows, covariance)| {
                let row = &rows[k * n..(k + 1) * n];
                let along = |of: &[f64]| of.iter().zip(row).map(|(c, a)| c * a).sum::<f64>();
                covariance.chunks_exact(n).map(along).zip(row).map(|(along, a)| along * a).sum()
            });
            left[*group] += 1.0 - leverage;
        }
        // offsets of gauges are parameters too
        let share = self.freedom as f64 / m.saturating_sub(n).max(1) as f64;
        left.into_iter().map(|left| (share * left).max(1.0)).collect()
    }

    /// The Jacobian at the estimated parameters, row by row, and its information.
    pub fn information(&self) -> Result<(Vec<f64>, Information), InvalidInput> {
        let n = self.coordinates.len();
        let mut rows = vec![0.0; self.measured.len() * n];
        self.jacobian(&self.parameters, &mut rows);
        rows.iter_mut().filter(|entry| entry.is_nan() || entry.abs() >= 1e100).for_each(|entry| *entry = 0.0);
        let information = Information::of(&rows, n)?;
        Ok((rows, information))
    }

    /// The profile of each parameter. A better minimum that is found on the way replaces the fit.
    pub fn profiles(&mut self, z: &[f64]) -> Result<Vec<Profile>, InvalidInput> {
        let settings = Settings { tolerance: 1e-5, ..settings() };
        let mut restarts = 0;
        'again: loop {
            let sds = self.information()?.1.standard_deviations();
            let mut profiles = Vec::new();
            for j in 0..self.coordinates.len() {
                // without information from the data the first step is small
                let step = z[j] * if sds[j].is_finite() { sds[j].clamp(1e-9, 1.0) } else { 1.0 };
                let found = self.with_problem(Loss::Squares, &self.parameters, |problem| {
                    profile(problem, &settings, &self.parameters, self.sum_of_squares, j, z[j] * z[j], step)
                });
                let found = found?;
                if let (Some(better), true) = (&found.better, restarts < MOST_RESTARTS) {
                    restarts += 1;
                    self.parameters.clone_from(better);
                    self.search(1)?;
                    continue 'again;
                }
                profiles.push(found);
            }
            return Ok(profiles);
        }
    }
}

/// Size of the largest of the measured values of a group.
fn size(measured: &[(f64, usize)], group: usize) -> f64 {
    measured.iter().filter(|(_, of)| *of == group).map(|(value, _)| value.abs()).fold(0.0, f64::max)
}

fn settings() -> Settings {
    Settings {
        method: Method::LevenbergMarquardt,
        tolerance: TOLERANCE,
        max_evaluations: MOST_EVALUATIONS,
        ..Settings::default()
    }
}

/// `J - q q^T J` for the direction of `q`, which need not be a unit vector; `rows` has a row for each entry of `q`.
pub(super) fn project_out(rows: &mut [f64], q: &[f64], n: usize) {
    let square: f64 = q.iter().map(|q| q * q).sum();
    if square <= 0.0 {
        return;
    }
    for j in 0..n {
        let along: f64 = rows.iter().skip(j).step_by(n).zip(q).map(|(entry, q)| entry * q).sum::<f64>() / square;
        rows.iter_mut().skip(j).step_by(n).zip(q).for_each(|(entry, q)| *entry -= along * q);
    }
}
