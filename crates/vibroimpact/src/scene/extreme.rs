//! Errors of quantities that follow from several fields: they name the field that is the most extreme.

use invalid_input::{InvalidInput, Value, most_extreme};

use super::json::number;

/// A longer number is shown with a power of ten (characters).
const LONGEST_PLAIN: usize = 8;

/// Checks that a quantity which follows from several fields is finite and greater than zero.
pub(super) fn require_product(quantity: &str, found: f64, fields: &[(&str, f64)]) -> Result<(), InvalidInput> {
    if found > 0.0 && found.is_finite() {
        return Ok(());
    }
    Err(of_product(quantity, found, fields, "neither infinite nor zero"))
}

/// The error of a quantity that follows from several fields and is not as it is allowed to be, as that of the most extreme of them.
pub(super) fn of_product(quantity: &str, found: f64, fields: &[(&str, f64)], allowed: &str) -> InvalidInput {
    let (field, value) = most_extreme(fields.iter().copied()).unwrap_or_default();
    let all = fields.iter().map(|(field, _)| *field).collect::<Vec<_>>().join(", ");
    let allowed = such_that(&format!("the {quantity}"), &InvalidInput::new("", found, allowed));
    InvalidInput::new(field, number(value), format!("{allowed}; it follows from {all}"))
}

/// The values that a field is allowed to have so that a quantity which follows from it is allowed too: this error is that of the
/// quantity.
pub(crate) fn such_that(quantity: &str, fault: &InvalidInput) -> String {
    let found = match &fault.value {
        Some(Value::Number(found)) => first_digits(*found),
        Some(found) => found.to_string(),
        None => "missing".to_owned(),
    };
    format!("such that {quantity}, now {found}, is {}", fault.allowed)
}

/// As many digits as tell how far a number is out of range.
fn first_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    let plain = rounded.to_string();
    if plain.len() <= LONGEST_PLAIN { plain } else { format!("{rounded:e}") }
}
