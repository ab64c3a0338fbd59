#![no_std]
#![forbid(unsafe_code)]
//! emoc
#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(feature = "qp")]
extern crate std;

#[cfg(feature = "qp")]
mod active_set;
mod closed_form;
mod error;
#[cfg(feature = "qp")]
mod general;
#[cfg(feature = "alloc")]
pub mod lcp;
#[cfg(feature = "alloc")]
mod matrix;
mod newton;
mod parameters;
#[cfg(feature = "alloc")]
mod problem;
#[cfg(feature = "qp")]
mod program;
mod real;
#[cfg(feature = "qp")]
mod scaled;
#[cfg(feature = "qp")]
mod single;

pub use closed_form::{Branch, CoefficientGradient, Coefficients, Rebound};
pub use error::InvalidInput;
pub use newton::newton_restitution;
pub use parameters::{Impact, ParameterGradient, Parameters, Site};
pub use real::Real;
#[cfg(feature = "alloc")]
pub use problem::{Contact, Friction, Mode, Outcome, Problem, Solution};
#[cfg(feature = "qp")]
pub use general::{SolveError, Solver};
#[cfg(feature = "qp")]
pub use single::{SingleImpact, SingleSolution};
