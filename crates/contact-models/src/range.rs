//! The range of the parameters and motions of the laws.

use invalid_input::InvalidInput;

/// Smallest positive parameter. Together with [`LARGEST`] it limits every product in a law, so that no force overflows; both
/// are far outside any physical range.
pub(crate) const SMALLEST: f64 = 1e-30;
/// Largest parameter of a law, and largest compression (m) and rate (m/s) at which it is evaluated: beyond this value the force
/// is constant.
pub const LARGEST: f64 = 1e30;

/// Accepts a number greater than zero within the crate's range.
pub(crate) fn require_positive(field: &'static str, value: f64) -> Result<(), InvalidInput> {
    let holds = (SMALLEST..=LARGEST).contains(&value);
    InvalidInput::unless(holds, field, value, "a number greater than 0 (from 1e-30 to 1e30)")
}

/// Accepts zero and any positive number up to the crate's limit.
pub(crate) fn require_not_negative(field: &'static str, value: f64) -> Result<(), InvalidInput> {
    InvalidInput::unless((0.0..=LARGEST).contains(&value), field, value, "a number from 0 to 1e30")
}

/// Accepts a coefficient of restitution that a damped law can have.
pub(crate) fn require_restitution(field: &'static str, value: f64) -> Result<(), InvalidInput> {
    let holds = (0.001..=1.0).contains(&value);
    InvalidInput::unless(holds, field, value, "a coefficient of restitution from 0.001 to 1")
}

/// Limits a compression or rate to the range of the laws.
pub(crate) fn bounded(value: f64) -> f64 {
    value.clamp(-LARGEST, LARGEST)
}
