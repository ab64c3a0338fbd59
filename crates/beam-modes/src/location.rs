//! Locations on a structure.

use invalid_input::{InvalidInput, Path};

/// Accepts a location on a structure of the given length.
pub(crate) fn require_on(field: impl Into<Path>, x_m: f64, length_m: f64) -> Result<f64, InvalidInput> {
    let on = x_m >= 0.0 && x_m <= length_m;
    InvalidInput::unless(on, field, x_m, "a location on the structure, from 0 to its length").map(|()| x_m)
}
