//! What can be wrong with a scene, and how it is told.

use std::fmt;
use std::path::PathBuf;

use super::json::number;
use super::told::{printable, shorten, shorten_path};

/// A field of a scene that cannot be used: where it stands, what it holds, and what would be allowed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InvalidInput {
    /// Path of the field, as in `structure.segments[0].length_m`.
    pub field: String,
    /// The value found there, as JSON text; `None` where the field is missing.
    pub value: Option<String>,
    /// What would be allowed.
    pub allowed: String,
}

impl InvalidInput {
    pub(crate) fn new(field: impl Into<String>, value: impl Into<String>, allowed: impl Into<String>) -> InvalidInput {
        InvalidInput { field: field.into(), value: Some(value.into()), allowed: allowed.into() }
    }

    pub(crate) fn missing(field: impl Into<String>, allowed: impl Into<String>) -> InvalidInput {
        InvalidInput { field: field.into(), value: None, allowed: allowed.into() }
    }

    /// Passes a finite number greater than zero.
    pub(crate) fn require_positive(field: &str, value: f64) -> Result<(), InvalidInput> {
        if value > 0.0 && value.is_finite() {
            Ok(())
        } else {
            Err(InvalidInput::new(field, number(value), "a finite number greater than 0"))
        }
    }

    /// The same fault, seen from an object that holds the field's object under the name `parent`.
    pub(crate) fn within(mut self, parent: &str) -> InvalidInput {
        let joint = if self.field.is_empty() || self.field.starts_with('[') { "" } else { "." };
        self.field = format!("{parent}{joint}{}", self.field);
        self
    }
}

/// The errors of the crates that check the numbers name fields as scenes do, from their own object on.
macro_rules! from_crate {
    ($($krate:ident),*) => {
        $(impl From<$krate::InvalidInput> for InvalidInput {
            fn from(fault: $krate::InvalidInput) -> InvalidInput {
                // a huge or tiny number is told by its power of ten, not by all its zeros
                let value = match fault.value.parse::<f64>() {
                    Ok(value) if fault.value.len() > 20 => number(value),
                    _ => fault.value,
                };
                InvalidInput::new(fault.field, value, fault.allowed)
            }
        })*
    };
}

from_crate!(beam_modes, contact_models, vibroimpact_sim);

impl From<emoc::InvalidInput> for InvalidInput {
    fn from(fault: emoc::InvalidInput) -> InvalidInput {
        let place = fault.index.map_or_else(String::new, |index| format!("[{index}]"));
        InvalidInput::new(format!("{}{place}", fault.field), number(fault.value), fault.allowed)
    }
}

impl fmt::Display for InvalidInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // names and values come from files and may hold anything
        let field = if self.field.is_empty() { "the scene".to_owned() } else { shorten_path(&printable(&self.field)) };
        let allowed = printable(&self.allowed);
        match &self.value {
            Some(value) => {
                // a field that has to go is told so; of any other it is told what would be allowed
                let verdict = if allowed.starts_with("left out") { "must be" } else { "is not allowed:" };
                write!(f, "{field} = {} {verdict} {allowed}", shorten(&printable(value)))
            }
            None => write!(f, "{field} is missing: {allowed}"),
        }
    }
}

impl std::error::Error for InvalidInput {}

/// Why a text or a file is not a scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file could not be read.
    #[error("cannot read {}: {source}", printable(&path.display().to_string()))]
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
        field: String,
        /// What was expected.
        reason: String,
    },
    /// A field cannot be used.
    #[error(transparent)]
    Invalid(#[from] InvalidInput),
}

fn within(field: &str) -> String {
    if field.is_empty() { String::new() } else { format!(", in {}", shorten_path(&printable(field))) }
}
