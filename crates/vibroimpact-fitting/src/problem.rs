//! The problem, the settings of a search, and the fit.

use crate::parameter::Parameter;
use crate::report::Residuals;
use invalid_input::InvalidInput;
use std::fmt;

/// Residuals as a function of the parameters: reads the parameters and writes every residual.
pub type ResidualsFn<'a> = dyn Fn(&[f64], &mut [f64]) + 'a;

/// Least squares for a closure: find the parameters that minimise the sum of squared residuals.
///
/// A residual that is NaN, infinite or beyond 1e100 marks parameters at which the model does not exist; the search avoids them.
#[derive(Clone)]
pub struct Problem<'a> {
    /// The parameters, in the order that the closures use.
    pub parameters: Vec<Parameter>,
    /// Number of residuals `m`, at least as many as parameters.
    pub count: usize,
    /// Writes the `m` residuals at the given parameters (in their own units, not transformed).
    pub residuals: &'a ResidualsFn<'a>,
    /// Writes the derivative of residual `i` with respect to parameter `j` at `i * n + j`; central differences if absent.
    pub jacobian: Option<&'a ResidualsFn<'a>>,
}

impl fmt::Debug for Problem<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Problem")
            .field("parameters", &self.parameters)
            .field("count", &self.count)
            .finish_non_exhaustive()
    }
}

/// The method of the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Method {
    /// Levenberg-Marquardt from every start: fast and precise where residuals are smooth.
    LevenbergMarquardt,
    /// The simplex method from every start: needs no derivative, slow, for few parameters.
    Simplex,
    /// Levenberg-Marquardt from every start, then the simplex method from the best point, for residuals with kinks: the first
    /// can stop at a kink, the second continues along it.
    Both,
}

invalid_input::names!(Method, "method", {
    LevenbergMarquardt: "levenberg-marquardt",
    Simplex: "simplex",
    Both: "both",
});

/// Settings of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Settings {
    /// Default [`Method::Both`].
    pub method: Method,
    /// Number of starting points: the parameters' own, then a Halton sequence over their search intervals (in the
    /// transformed coordinates). Default 8.
    pub starts: usize,
    /// Number of points at which the sum of squares is evaluated to choose as starting points the best that are apart from each
    /// other. A quarter of them are points of the sequence, the others are drawn around the best so far, in stages with a
    /// shrinking spread. Default 0: the first points of the sequence are used. More is useful if an evaluation costs little
    /// compared with a search and the sum of squares has many minima.
    pub candidates: usize,
    /// Relative change of the sum of squares and of the parameters at which a search ends, from 1e-15 to 0.1. Default 1e-10.
    /// The search from each start ends at 1e-5 already, and the best one is continued.
    pub tolerance: f64,
    /// Largest number of evaluations of the residuals in one search, without those for differences. Default 2000.
    pub max_evaluations: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { method: Method::Both, starts: 8, candidates: 0, tolerance: 1e-10, max_evaluations: 2000 }
    }
}

/// How a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Outcome {
    /// At a minimum, by the method's own tests.
    Converged,
    /// At the limit of evaluations; the parameters are the best found.
    #[cfg_attr(feature = "serde", serde(rename = "limit reached"))]
    LimitReached,
    /// The model was not finite at the starting point, so that there was no search.
    #[cfg_attr(feature = "serde", serde(rename = "not finite"))]
    NonFinite,
}

invalid_input::names!(Outcome, "outcome", {
    Converged: "converged",
    LimitReached: "limit reached",
    NonFinite: "not finite",
});

/// One starting point and the end of its search.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Start {
    /// The starting point.
    pub from: Vec<f64>,
    /// The end of its search, to about five digits.
    pub parameters: Vec<f64>,
    /// Sum of squares there.
    pub sum_of_squares: f64,
    /// Reason for the end.
    pub outcome: Outcome,
}

/// A fit.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Fit {
    /// The parameters found, in their own units.
    pub parameters: Vec<f64>,
    /// Sum of squared residuals.
    pub sum_of_squares: f64,
    /// How the search that found them ended.
    pub outcome: Outcome,
    /// The residuals.
    pub residuals: Vec<f64>,
    /// Their summary.
    pub report: Residuals,
    /// Every starting point. The number of them that end at the same place shows how reliable the minimum is.
    pub starts: Vec<Start>,
    /// Total number of evaluations of the residuals.
    pub evaluations: usize,
    /// Total number of evaluations of the Jacobian.
    pub jacobians: usize,
    /// Covariance of the transformed coordinates, row by row; see [`Fit::intervals`].
    pub(crate) covariance: Option<Vec<f64>>,
    pub(crate) transforms: Vec<Parameter>,
}

impl Problem<'_> {
    /// Checks the parameters and the number of residuals.
    ///
    /// # Errors
    /// [`InvalidInput`] for no parameter or more than 100, fewer residuals than parameters, more than fit into the memory, or a parameter
    /// that [`Parameter::validate`] rejects.
    pub fn validate(&self) -> Result<(), InvalidInput> {
        let n = self.parameters.len();
        if n == 0 || n > 100 {
            return Err(InvalidInput::new(["parameters", "len()"], n, "a number from 1 to 100"));
        }
        if self.count < n {
            return Err(InvalidInput::new("count", self.count, "at least the number of parameters"));
        }
        if Vec::<f64>::new().try_reserve_exact(self.count.saturating_mul(n)).is_err() {
            let allowed = "a number of residuals whose derivatives fit into the memory";
            return Err(InvalidInput::new("count", self.count, allowed));
        }
        self.parameters.iter().try_for_each(Parameter::validate)
    }
}

impl Settings {
    /// Checks the ranges.
    ///
    /// # Errors
    /// [`InvalidInput`] names the first setting out of range.
    pub fn validate(&self) -> Result<(), InvalidInput> {
        if !(1e-15..=0.1).contains(&self.tolerance) {
            return Err(InvalidInput::new("tolerance", self.tolerance, "a number from 1e-15 to 0.1"));
        }
        if !(1..=100_000).contains(&self.starts) {
            return Err(InvalidInput::new("starts", self.starts, "a number of starting points from 1 to 100000"));
        }
        if self.candidates > 1_000_000 {
            return Err(InvalidInput::new("candidates", self.candidates, "a number of points from 0 to 1000000"));
        }
        if !(1..=100_000_000).contains(&self.max_evaluations) {
            return Err(InvalidInput::new(
                "max_evaluations",
                self.max_evaluations,
                "a number of evaluations from 1 to 1e8",
            ));
        }
        Ok(())
    }
}
