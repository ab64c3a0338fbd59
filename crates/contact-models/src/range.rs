//! The range of parameters and motions that the laws compute with.

use invalid_input::InvalidInput;

/// Smallest positive parameter. With [`LARGEST`] it bounds every product a law forms, so that
/// no force overflows; both lie far outside any physics.
pub(crate) const SMALLEST: f64 = 1e-30;
/// Largest parameter that a law takes, and largest compression (m) and rate (m/s) that it computes with: beyond, its
/// force is the one at this bound.
pub const LARGEST: f64 = 1e30;

/// Passes a number greater than zero within the crate's range.
pub(crate) fn require_positive(field: &'static str, value: f64) -> Result<(), InvalidInput> {
    let holds = (SMALLEST..=LARGEST).contains(&value);
    InvalidInput::unless(holds, field, value, "a number greater than 0 (from 1e-30 to 1e30)")
}

/// Passes zero and any positive number up to the crate's limit.
pub(crate) fn require_not_negative(field: &'static str, value: f64) -> Result<(), InvalidInput> {
    InvalidInput::unless((0.0..=LARGEST).contains(&value), field, value, "a number from 0 to 1e30")
}

/// Passes a coefficient of restitution that a damped law can have.
pub(crate) fn require_restitution(field: &'static str, value: f64) -> Result<(), InvalidInput> {
    let holds = (0.001..=1.0).contains(&value);
    InvalidInput::unless(holds, field, value, "a coefficient of restitution from 0.001 to 1")
}

/// A compression or rate, held within what the laws compute with.
pub(crate) fn bounded(value: f64) -> f64 {
    value.clamp(-LARGEST, LARGEST)
}
