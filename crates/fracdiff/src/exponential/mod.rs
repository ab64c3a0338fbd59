//! Methods whose memory is a fixed number of exponentially decaying states.

mod das_chatterjee;
mod march;
mod sum;

pub use das_chatterjee::DasChatterjee;
pub use sum::ExponentialSum;

use crate::problem::Volterra;
use crate::solution::Solution;
use crate::system::{System, require_steps};
use das_chatterjee::ALPHA;
use invalid_input::InvalidInput;
use march::{Kernel, Mesh};

/// Settings of the sum of exponentials.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct SumOfExponentials {
    /// Number of steps, distributed over the segments between breaks, at least 8 each if there are several; 1 to 4194304,
    /// default 1000.
    pub steps: usize,
    /// Exponent of the mesh `t_j = t0 + length (j/n)^grading` of each segment, 1 to 8; default 2, which keeps the
    /// second order for solutions that start like `sqrt(t)`.
    pub grading: f64,
    /// Relative error of the kernel, 1e-14 to 0.1; default 1e-10.
    pub tolerance: f64,
}

impl Default for SumOfExponentials {
    fn default() -> Self {
        SumOfExponentials { steps: 1000, grading: 2.0, tolerance: 1e-10 }
    }
}

impl SumOfExponentials {
    pub(crate) fn run(&self, problem: &Volterra<'_>, t_end: f64) -> Result<Solution, InvalidInput> {
        let mut system = System::new(problem, t_end)?;
        let mesh = Mesh::new(&system.segments, require_steps(self.steps, &system)?, self.grading)?;
        let shortest = mesh.shortest_step();
        let kernels = system
            .orders
            .iter()
            .map(|&order| {
                let (whole, fraction) = split(order);
                let sum = if fraction == 1.0 {
                    constant()
                } else {
                    ExponentialSum::power(1.0 - fraction, shortest, t_end, self.tolerance)?
                };
                Ok(Kernel { order, whole, sum, local_exact: true })
            })
            .collect::<Result<Vec<Kernel>, InvalidInput>>()?;
        Ok(march::run(&mut system, &mesh, &kernels))
    }
}

/// Settings of the Galerkin internal states, see [`DasChatterjee`].
///
/// A kernel `t^(order-1)`, `order = m + 1 - alpha`, is `t^m` times the sum of exponentials of the states; `alpha` must be
/// between 0.05 and 0.95 (or 0, which needs no states).
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct GalerkinStates {
    /// Internal states for each order; default 50 (thesis A.1).
    pub states: usize,
    /// Logarithm of the lowest breakpoint in `xi`; default -2.4 (thesis A.1).
    pub beta1: f64,
    /// Logarithm of the highest breakpoint in `xi`; default 1.2 (thesis A.1).
    pub beta2: f64,
    /// Number of steps, distributed over the segments between breaks, at least 8 each if there are several; 1 to 4194304,
    /// default 1000.
    pub steps: usize,
    /// Exponent of the graded mesh of each segment, 1 to 8; default 2.
    pub grading: f64,
}

impl Default for GalerkinStates {
    fn default() -> Self {
        GalerkinStates { states: 50, beta1: -2.4, beta2: 1.2, steps: 1000, grading: 2.0 }
    }
}

impl GalerkinStates {
    pub(crate) fn run(&self, problem: &Volterra<'_>, t_end: f64) -> Result<Solution, InvalidInput> {
        let mut system = System::new(problem, t_end)?;
        let mesh = Mesh::new(&system.segments, require_steps(self.steps, &system)?, self.grading)?;
        let kernels = system
            .orders
            .iter()
            .map(|&order| {
                let (whole, fraction) = split(order);
                if fraction == 1.0 {
                    return Ok(Kernel { order, whole, sum: constant(), local_exact: false });
                }
                // The recipe itself cannot name the term in its error.
                let term = problem.terms.iter().position(|term| term.order == order).unwrap_or_default();
                let allowed = "an integer, or a number with a fractional part from 0.05 to 0.95, for Galerkin states";
                InvalidInput::unless(ALPHA.contains(&(1.0 - fraction)), ("terms", term, "order"), order, allowed)?;
                let recipe = DasChatterjee::new(1.0 - fraction, self.states, self.beta1, self.beta2)?;
                let mut sum = recipe.kernel().ok_or_else(|| {
                    InvalidInput::new(
                        "states",
                        self.states,
                        "smaller, so that the matrix A is positive definite to rounding",
                    )
                })?;
                // The kernel of the method contains 1/Gamma(fraction).
                sum.weights.iter_mut().for_each(|w| *w *= libm::tgamma(fraction));
                Ok(Kernel { order, whole, sum, local_exact: false })
            })
            .collect::<Result<Vec<Kernel>, InvalidInput>>()?;
        Ok(march::run(&mut system, &mesh, &kernels))
    }
}

/// `order = whole + fraction` with `0 < fraction <= 1`.
fn split(order: f64) -> (usize, f64) {
    let whole = order.ceil() - 1.0;
    (whole as usize, order - whole)
}

/// The constant 1, the kernel of order 1.
fn constant() -> ExponentialSum {
    ExponentialSum { rates: vec![0.0], weights: vec![1.0] }
}
