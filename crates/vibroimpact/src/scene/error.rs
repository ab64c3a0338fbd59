//! Errors of scenes and their messages.

use std::path::PathBuf;

use invalid_input::{InvalidInput, Path, Value, cut, printable};

use super::told::number;

/// Longest path of a field that a message shows (characters).
const LONGEST_PATH: usize = 90;

/// Checks that a number is finite and greater than zero; the error shows the number as in JSON.
pub(crate) fn require_positive(field: impl Into<Path>, value: f64) -> Result<(), InvalidInput> {
    InvalidInput::require_positive(field, value).map(|_| ()).map_err(as_json)
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
