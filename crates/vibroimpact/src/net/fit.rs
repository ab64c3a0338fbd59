//! The three parameters of the law from observed restitutions.

use emoc::{Impact, Parameters};
use fitting::{Fit, FitError, Information, Outcome, Parameter, Problem, Settings};
use invalid_input::InvalidInput;
use serde::Serialize;

/// Range of the starting points; a fit may leave it.
const SEARCH: (f64, f64) = (1e-3, 1e3);
/// A parameter outside these limits is not determined: the law has reached its limit, and the sum of squares does not change any
/// more.
const DETERMINED: std::ops::RangeInclusive<f64> = 1e-6..=1e6;
/// Starting points. The sum of squares has several minima, because `ebar` treats small and large `Z` alike. The most promising of many
/// candidates would be no better: they lie beside each other at a minimum that is wide and not the least.
const STARTS: usize = 100;

/// Impacts and the restitution that each was observed to have.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Observations {
    /// Inputs of the law.
    pub impacts: Vec<Impact>,
    /// Their net restitutions, one for each impact; further ones are ignored.
    pub restitution: Vec<f64>,
}

impl Observations {
    /// Number of different inputs of the law, up to `most`; repeated impacts count once.
    pub fn distinct(&self, most: usize) -> usize {
        let mut seen: Vec<&Impact> = Vec::new();
        for impact in self.impacts.iter().take(self.count()) {
            if seen.len() < most && !seen.contains(&impact) {
                seen.push(impact);
            }
        }
        seen.len()
    }

    /// Number of observations.
    pub fn count(&self) -> usize {
        self.impacts.len().min(self.restitution.len())
    }

    /// `mu_0`, `alpha_0`, `alpha_1` as parameters of the search: positive, starting at 1.
    pub fn parameters() -> Vec<Parameter> {
        ["mu0", "alpha0", "alpha1"].map(|name| Parameter::positive(name, 1.0, SEARCH)).into()
    }

    /// Settings with which the least of the minima is found.
    pub fn settings() -> Settings {
        Settings { starts: STARTS, ..Settings::default() }
    }

    /// Writes the difference of the law's and the observed restitution for each impact. NaN for invalid parameters.
    pub fn residuals(&self, parameters: &[f64], residuals: &mut [f64]) {
        let law = law(parameters);
        for ((r, impact), observed) in residuals.iter_mut().zip(&self.impacts).zip(&self.restitution) {
            *r = law.rebound(impact).map_or(f64::NAN, |rebound| rebound.restitution - observed);
        }
    }

    /// Writes the derivatives of the residuals with respect to the three parameters, row by row.
    pub fn jacobian(&self, parameters: &[f64], rows: &mut [f64]) {
        let law = law(parameters);
        for (row, impact) in rows.chunks_exact_mut(3).zip(&self.impacts) {
            if let Ok((_, gradient)) = law.rebound_with_gradient(impact) {
                row.copy_from_slice(&[gradient.per_mu0, gradient.per_alpha0, gradient.per_alpha1]);
            }
        }
    }

    /// Calls `work` with the least-squares problem.
    pub fn with_problem<R>(&self, work: impl FnOnce(&Problem) -> R) -> R {
        work(&Problem {
            parameters: Observations::parameters(),
            count: self.count(),
            residuals: &|p, r| self.residuals(p, r),
            jacobian: Some(&|p, rows| self.jacobian(p, rows)),
        })
    }

    /// Whether the observations contain information about each of the three parameters, if the others are unknown too.
    fn determine(&self, parameters: &[f64]) -> [bool; 3] {
        let mut rows = vec![0.0; 3 * self.count()];
        self.jacobian(parameters, &mut rows);
        // by the logarithms of the parameters
        for (entry, parameter) in rows.iter_mut().zip(parameters.iter().cycle()) {
            *entry *= parameter;
        }
        let sds =
            Information::of(&rows, 3).map_or_else(|_| Vec::new(), |information| information.standard_deviations());
        [0, 1, 2].map(|k| sds.get(k).is_some_and(|sd| sd.is_finite()))
    }

    /// Fits the three parameters.
    ///
    /// # Errors
    /// Fewer than three observations.
    pub fn fit(&self) -> Result<Fit, FitError> {
        self.with_problem(|problem| fitting::fit(problem, &Observations::settings()))
    }
}

/// The law with these three parameters; the notional restitution is 1 (thesis 7.1).
pub fn law(parameters: &[f64]) -> Parameters {
    let at = |k: usize| parameters.get(k).copied().unwrap_or(f64::NAN);
    Parameters { mu0: at(0), alpha0: at(1), alpha1: at(2), notional_restitution: 1.0 }
}

/// Probability with which the intervals of [`FitSummary`] hold their parameter.
const LEVEL: f64 = 0.95;

/// The object that `vibroimpact fit` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FitSummary {
    /// Moderated mass ratio coefficient (Eq. 7.4).
    pub mu0: f64,
    /// Modal richness coefficient (Eq. 7.6).
    pub alpha0: f64,
    /// Slow response coefficient (Eq. 7.7).
    pub alpha1: f64,
    /// Root mean square difference of law and observation.
    pub rms: f64,
    /// Largest difference.
    pub max_error: f64,
    /// Number of observations.
    pub count: usize,
    /// Number of modes in the law.
    pub modes: usize,
    /// 95 % intervals of the three; null where the observations do not determine them.
    pub intervals: Option<[[f64; 2]; 3]>,
    /// Whether the search ended at a minimum that depends on all three parameters, and not at its limit or where the sum of squares
    /// no longer changes.
    pub converged: bool,
    /// The names of the parameters that the observations do not determine. Those below 1e-6 or above 1e6 are only known to be very small
    /// or very large; on the others the restitutions of these impacts do not depend, alone or in some combination.
    pub undetermined: Vec<&'static str>,
}

impl FitSummary {
    /// Fits the parameters to the observations and summarises the result.
    ///
    /// # Errors
    /// Fewer than three different impacts, or impacts for which the law is not finite.
    pub fn new(observations: &Observations, modes: usize) -> Result<FitSummary, InvalidInput> {
        let lines = observations.count();
        let needed = Observations::parameters().len();
        let fault = |allowed: String| InvalidInput::new("lines of data", lines.to_string(), allowed);
        if lines < needed {
            return Err(fault(format!("at least {needed}, one for each parameter")));
        }
        let distinct = observations.distinct(needed);
        if distinct < needed {
            let allowed = format!("at least {needed}, one for each parameter; a repeated line counts once");
            return Err(InvalidInput::new(
                "lines of data that differ in mass or location",
                distinct.to_string(),
                allowed,
            ));
        }
        let fit = observations.fit().map_err(|error| fault(format!("such as can be fitted ({error})")))?;
        let [mu0, alpha0, alpha1] = [0, 1, 2].map(|k| fit.parameters.get(k).copied().unwrap_or(f64::NAN));
        let known = observations.determine(&fit.parameters);
        let named = [("mu0", mu0), ("alpha0", alpha0), ("alpha1", alpha1)].into_iter().zip(known);
        let undetermined: Vec<&str> = named
            .filter(|((_, value), known)| !known || !DETERMINED.contains(value))
            .map(|((name, _), _)| name)
            .collect();
        let intervals = fit.intervals(LEVEL).ok().flatten().filter(|_| undetermined.is_empty());
        let ends = |k: usize| intervals.as_ref().and_then(|all| all.get(k)).map(|found| [found.low, found.high]);
        Ok(FitSummary {
            mu0,
            alpha0,
            alpha1,
            rms: fit.report.rms,
            max_error: fit.report.max_abs,
            count: fit.report.count,
            modes,
            intervals: ends(0).zip(ends(1)).zip(ends(2)).map(|((a, b), c)| [a, b, c]),
            converged: fit.outcome == Outcome::Converged && undetermined.is_empty(),
            undetermined,
        })
    }
}
