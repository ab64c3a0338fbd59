//! fracdiff

mod collocation;
mod convolution;
mod dense;
mod error;
mod exponential;
mod implicit;
mod ivp;
mod method;
pub mod operators;
mod power;
mod problem;
mod quadrature;
mod recorder;
mod solution;
mod system;
pub mod test_problems;

pub use collocation::Collocation;
pub use convolution::Convolution;
pub use error::InvalidInput;
pub use exponential::{DasChatterjee, ExponentialSum, GalerkinStates, SumOfExponentials};
pub use ivp::{Equation, InitialValueProblem};
pub use method::Method;
pub use problem::{Density, Direction, Event, Forcing, Term, Volterra};
pub use solution::{Counts, EventHit, Solution, Stop};
