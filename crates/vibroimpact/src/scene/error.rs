//! Errors of scenes and their messages.

use std::path::PathBuf;

use invalid_input::{InvalidInput, Path, Value, cut, most_extreme, printable};

use super::told::number;

/// Longest path of a field that a message shows (characters).
const LONGEST_PATH: usize = 90;

/// Checks that a number is finite and greater than zero; the error shows the number as in JSON.
pub(crate) fn require_positive(field: impl Into<Path>, value: f64) -> Result<(), InvalidInput> {
    InvalidInput::require_positive(field, value).map(|_| ()).map_err(as_json)
}

/// Checks that a quantity which follows from several fields is finite and greater than zero.
pub(crate) fn require_product(quantity: &str, value: f64, fields: &[(&str, f64)]) -> Result<(), InvalidInput> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(of_product(quantity, fields, "neither infinite nor zero"))
}

/// The error of a quantity that follows from several fields and is not as it is allowed to be: it names the most extreme of them.
pub(crate) fn of_product(quantity: &str, fields: &[(&str, f64)], allowed: &str) -> InvalidInput {
    let (field, extreme) = most_extreme(fields.iter().copied()).unwrap_or_default();
    let all = fields.iter().map(|(field, _)| *field).collect::<Vec<_>>().join(", ");
    let allowed = format!("such that the {quantity}, which follows from {all}, is {allowed}");
    InvalidInput::new(field, number(extreme), allowed)
}

/// The values that a field is allowed to have so that this quantity, which follows from it and is out of range, is allowed too.
pub(crate) fn such_that(quantity: &str, fault: InvalidInput) -> String {
    let found = fault.value.map_or_else(String::new, |found| found.to_string());
    format!("such that {quantity}, now {found}, is {}", fault.allowed)
}

/// An error that shows its number as in JSON.
pub(crate) fn as_json(fault: InvalidInput) -> InvalidInput {
    match fault.value {
        Some(Value::Number(value)) => InvalidInput { value: Some(number(value).into()), ..fault },
        _ => fault,
    }
}

/// The reason why a text or a file is not a scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file could not be read.
    #[error("cannot read {}: {source}", printable(path.display()))]
    Read {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// The text is not JSON, or ends too early.
    #[error("line {line}, column {column}{}: {}", within(field), printable(reason))]
    Syntax {
        /// Line of the fault, from 1.
        line: usize,
        /// Column of the fault.
        column: usize,
        /// Path of the field with the error; empty at the top.
        field: Path,
        /// The expected text.
        reason: String,
    },
    /// A field is invalid.
    #[error(transparent)]
    Invalid(#[from] InvalidInput),
}

fn within(field: &Path) -> String {
    if field.is_empty() { String::new() } else { format!(", in {}", cut(printable(field), LONGEST_PATH)) }
}
