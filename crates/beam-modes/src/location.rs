//! Locations on a structure.

use invalid_input::{InvalidInput, Path};

/// A sum of the lengths of segments is rounded: 0.7 m and 0.1 m are less than 0.8 m.
const ROUNDING: f64 = 1e-12;

/// Accepts a location on a structure of the given length. One beyond its end by rounding is the end.
pub(crate) fn require_on(field: impl Into<Path>, x_m: f64, length_m: f64) -> Result<f64, InvalidInput> {
    let on = x_m >= 0.0 && x_m <= length_m * (1.0 + ROUNDING);
    InvalidInput::unless(on, field, x_m, "a location on the structure, from 0 to its length")
        .map(|()| x_m.min(length_m))
}

#[cfg(test)]
mod tests {
    use super::require_on;

    #[test]
    fn the_end_of_a_structure_of_two_segments_is_on_it() {
        let length_m = 0.7 + 0.1;
        assert!(length_m < 0.8 && require_on("x_m", 0.8, length_m) == Ok(length_m));
        assert!(require_on("x_m", 0.8 + 1e-9, length_m).is_err());
        assert!([-1e-300, f64::NAN, f64::INFINITY].into_iter().all(|x_m| require_on("x_m", x_m, length_m).is_err()));
    }
}
