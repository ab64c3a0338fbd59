//! What can be wrong with a scene, and how it is told.

use std::path::PathBuf;

use invalid_input::{InvalidInput, Path, Value, cut, printable};

use super::told::number;

/// Longest path of a field that a message shows (characters).
const LONGEST_PATH: usize = 90;

/// Passes a finite number greater than zero; another is shown as JSON has it.
pub(crate) fn require_positive(field: impl Into<Path>, value: f64) -> Result<(), InvalidInput> {
    InvalidInput::require_positive(field, value).map(|_| ()).map_err(as_json)
}

/// A fault whose number is shown as JSON has it.
pub(crate) fn as_json(fault: InvalidInput) -> InvalidInput {
    match fault.value {
        Some(Value::Number(value)) => InvalidInput { value: Some(number(value).into()), ..fault },
        _ => fault,
    }
}

/// Why a text or a file is not a scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file could not be read.
    #[error("cannot read {}: {source}", printable(path.display()))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The text is not JSON, or ends too early.
    #[error("line {line}, column {column}{}: {}", within(field), printable(reason))]
    Syntax {
        /// Line of the fault, from 1.
        line: usize,
        /// Column of the fault.
        column: usize,
        /// Path of the field in which the fault stands; empty at the top.
        field: Path,
        /// What was expected.
        reason: String,
    },
    /// A field cannot be used.
    #[error(transparent)]
    Invalid(#[from] InvalidInput),
}

fn within(field: &Path) -> String {
    if field.is_empty() { String::new() } else { format!(", in {}", cut(printable(field), LONGEST_PATH)) }
}
