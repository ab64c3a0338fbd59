//! One damping ratio for all modes.

use invalid_input::InvalidInput;

use super::fields;
use super::told::number;

/// Checks the damping ratio of all modes of a structure or rod.
pub(crate) fn require_damping(damping_ratio: f64) -> Result<(), InvalidInput> {
    if (0.0..=fields::MOST_DAMPING).contains(&damping_ratio) {
        return Ok(());
    }
    let allowed = fields::allowed("damping_ratio").unwrap_or_default();
    Err(InvalidInput::new("damping_ratio", number(damping_ratio), allowed))
}
