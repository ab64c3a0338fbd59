//! The methods and their settings.

use crate::collocation::Collocation;
use crate::convolution::Convolution;
use crate::exponential::{GalerkinStates, SumOfExponentials};
use crate::problem::Volterra;
use crate::solution::Solution;
use crate::system::System;
use invalid_input::InvalidInput;

/// A method with its settings; all solve the same [`Volterra`] problem. The crate root compares them.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Method {
    /// Gruenwald-Letnikov weights: first order, equal steps.
    GrunwaldLetnikov(Convolution),
    /// The inverse of the L1 formula of the Caputo derivative: first order, up to `2 - order` for smooth solutions.
    L1(Convolution),
    /// Product-integration trapezoidal rule (implicit fractional Adams) with starting corrections: second order.
    Trapezoidal(Convolution),
    /// Product-integration trapezoidal rule on a graded mesh, the past kept as a sum of exponentials: second order.
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

    pub(crate) fn run(&self, problem: &Volterra<'_>, t_end: f64) -> Result<Solution, InvalidInput> {
        use crate::convolution::Scheme;
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

/// Checks a number of steps, and that the samples of the solution and the density fit into a sensible memory.
pub(crate) fn require_steps(steps: usize, system: &System<'_, '_>) -> Result<usize, InvalidInput> {
    InvalidInput::unless((1..=1 << 22).contains(&steps), "steps", steps, "a number from 1 to 4194304")?;
    let samples = steps * (system.unknowns + system.densities);
    InvalidInput::unless(samples <= 1 << 28, "steps", steps, "few enough for 2^28 values of solution and density")
        .map(|()| steps)
}
