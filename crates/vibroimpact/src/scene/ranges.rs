//! Ranges of numbers, for messages and for the schema.

pub(crate) const POSITIVE: &str = "a finite number greater than 0";
pub(crate) const NOT_NEGATIVE: &str = "a finite number not less than 0";
/// A damping ratio; the largest is that of the solver.
pub(crate) const DAMPING: &str = "a number from 0 to 1e6";
pub(crate) const MOST_DAMPING: f64 = 1e6;
