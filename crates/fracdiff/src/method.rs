//! The methods and their settings.

use crate::collocation::Collocation;
use crate::convolution::{Convolution, Scheme};
use crate::exponential::{GalerkinStates, SumOfExponentials};
use crate::problem::Volterra;
use crate::solution::Solution;
use invalid_input::InvalidInput;
use std::fmt;

/// A method with its settings. All methods solve the same [`Volterra`] problem; the documentation of the crate compares them.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Method {
    /// Gruenwald-Letnikov weights: first order, equal steps.
    GrunwaldLetnikov(Convolution),
    /// The inverse of the L1 formula of the Caputo derivative: first order, up to `2 - order` for smooth solutions.
    L1(Convolution),
    /// Product-integration trapezoidal rule (implicit fractional Adams) with starting corrections: second order.
    Trapezoidal(Convolution),
    /// Product-integration trapezoidal rule on a graded mesh, with the past as a sum of exponentials: second order.
    SumOfExponentials(SumOfExponentials),
    /// Galerkin internal states of Das and Chatterjee in place of the kernel.
    GalerkinStates(GalerkinStates),
    /// Spectral collocation on mapped panels of adaptive length.
    Collocation(Collocation),
}

impl Method {
    /// The usual name of the method.
    pub fn name(&self) -> &'static str {
        match self {
            Method::GrunwaldLetnikov(_) => "Gruenwald-Letnikov",
            Method::L1(_) => "L1",
            Method::Trapezoidal(_) => "trapezoidal",
            Method::SumOfExponentials(_) => "sum of exponentials",
            Method::GalerkinStates(_) => "Galerkin states",
            Method::Collocation(_) => "collocation",
        }
    }

    fn run(&self, problem: &Volterra<'_>, t_end: f64) -> Result<Solution, InvalidInput> {
        match self {
            Method::GrunwaldLetnikov(settings) => {
                crate::convolution::run(problem, Scheme::GrunwaldLetnikov, settings, t_end)
            }
            Method::L1(settings) => crate::convolution::run(problem, Scheme::L1, settings, t_end),
            Method::Trapezoidal(settings) => crate::convolution::run(problem, Scheme::Trapezoidal, settings, t_end),
            Method::SumOfExponentials(settings) => settings.run(problem, t_end),
            Method::GalerkinStates(settings) => settings.run(problem, t_end),
            Method::Collocation(settings) => settings.run(problem, t_end),
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl Volterra<'_> {
    /// Solves the problem on `[0, t_end]` and ends exactly at `t_end`.
    ///
    /// If a run ends early (at a terminal event, at a value that is not finite, or at a limit), the [`stop`](Solution::stop) of
    /// the solution states the reason, and the solution reaches as far as it could be computed.
    ///
    /// # Errors
    ///
    /// [`InvalidInput`] for a problem or settings that no run can start from.
    pub fn solve(&self, method: &Method, t_end: f64) -> Result<Solution, InvalidInput> {
        method.run(self, t_end)
    }
}
