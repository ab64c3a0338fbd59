//! One panel of time: the force on it as a polynomial, and the exact motion of a vibrating mode.

pub(crate) mod by_damping;
pub(crate) mod dyadic;
pub(crate) mod ends;
pub(crate) mod forcing;
pub(crate) mod interpolant;
pub(crate) mod lanes;
pub(crate) mod legendre;
pub(crate) mod oscillator;
pub(crate) mod peak;
mod polynomial;
pub(crate) mod root;
pub(crate) mod rows;
pub(crate) mod vector;
