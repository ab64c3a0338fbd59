//! The error.

use core::fmt::{self, Display, Formatter};

use crate::path::{Path, Step};
use crate::told::{LONGEST_VALUE, cut, printable};
use crate::value::{Text, Value};

/// Longest path that a message shows (characters).
const LONGEST_PATH: usize = 90;

/// An input that cannot be used: its path, its value, and what would be allowed. Its text is one sentence, such as
/// `mass_kg = -1 is not allowed; it must be a finite number greater than 0`.
#[derive(Debug, Clone, PartialEq)]
pub struct InvalidInput {
    /// The path of the input; empty if the whole input is meant. It can be compared with a text.
    pub field: Path,
    /// The value; `None` if the field is missing.
    pub value: Option<Value>,
    /// What would be allowed: the words that follow `it must be`. For a field that does not apply they begin with `left out`.
    pub allowed: Text,
    /// Whether the object has no field of this name; `allowed` then lists the fields that it has.
    pub is_unknown: bool,
}

impl InvalidInput {
    /// A value that is not allowed.
    pub fn new(field: impl Into<Path>, value: impl Into<Value>, allowed: impl Into<Text>) -> InvalidInput {
        InvalidInput { field: field.into(), value: Some(value.into()), allowed: allowed.into(), is_unknown: false }
    }

    /// A field that is missing.
    pub fn missing(field: impl Into<Path>, allowed: impl Into<Text>) -> InvalidInput {
        InvalidInput { field: field.into(), value: None, allowed: allowed.into(), is_unknown: false }
    }

    /// A field that its object does not have.
    pub fn unknown(field: impl Into<Path>, value: impl Into<Value>, allowed: impl Into<Text>) -> InvalidInput {
        InvalidInput { is_unknown: true, ..InvalidInput::new(field, value, allowed) }
    }

    /// Succeeds if `ok` holds, and otherwise reports the field.
    ///
    /// # Errors
    /// If `ok` does not hold.
    #[inline]
    pub fn unless(
        ok: bool,
        field: impl Into<Path>,
        value: impl Into<Value>,
        allowed: impl Into<Text>,
    ) -> Result<(), InvalidInput> {
        if ok { Ok(()) } else { Err(InvalidInput::new(field, value, allowed)) }
    }

    /// Accepts a finite number greater than zero.
    ///
    /// # Errors
    /// If it is anything else.
    #[inline]
    pub fn require_positive(field: impl Into<Path>, value: f64) -> Result<f64, InvalidInput> {
        let ok = value > 0.0 && value.is_finite();
        InvalidInput::unless(ok, field, value, "a finite number greater than 0").map(|()| value)
    }

    /// Accepts a finite number.
    ///
    /// # Errors
    /// If the number is not finite.
    #[inline]
    pub fn require_finite(field: impl Into<Path>, value: f64) -> Result<f64, InvalidInput> {
        InvalidInput::unless(value.is_finite(), field, value, "a finite number").map(|()| value)
    }

    /// The same error, for an object that contains the field's object at `parent`.
    #[must_use]
    pub fn within(self, parent: impl Into<Path>) -> InvalidInput {
        InvalidInput { field: self.field.within(parent), ..self }
    }

    /// The same error, for a list that contains the field's object at `index`.
    #[must_use]
    pub fn at(self, index: usize) -> InvalidInput {
        self.within(Step::Index(index))
    }

    /// The same error as seen from the object at the field `parent`, if the path begins there; the inverse of
    /// [`InvalidInput::within`].
    #[must_use]
    pub fn without(self, parent: &str) -> InvalidInput {
        if self.field.first() == Some(parent) {
            InvalidInput { field: self.field.steps()[1..].into(), ..self }
        } else {
            self
        }
    }

    /// The same error in a file, or in another place that is not a field.
    #[must_use]
    pub fn in_place(self, place: impl Into<Text>) -> InvalidInput {
        self.within(Step::Place(place.into()))
    }

    /// The same error in a line of a file or table, from 1.
    #[must_use]
    pub fn in_line(self, line: u64) -> InvalidInput {
        self.within(Step::Line(line))
    }

    /// The same error under another name of the field.
    #[must_use]
    pub fn under(self, field: impl Into<Path>) -> InvalidInput {
        InvalidInput { field: field.into(), ..self }
    }
}

impl Display for InvalidInput {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        // Names and values may come from files and contain any characters.
        if self.field.is_empty() {
            f.write_str("the input")?;
        } else {
            write!(f, "{}", cut(printable(&self.field), LONGEST_PATH))?;
        }
        if let Some(value) = &self.value {
            write!(f, " = {}", cut(printable(value), LONGEST_VALUE))?;
        }
        let verdict = match &self.value {
            None => "missing",
            Some(_) if self.is_unknown => "not a known field",
            Some(_) => "not allowed",
        };
        write!(f, " is {verdict}; it must be {}", printable(&self.allowed))
    }
}

impl core::error::Error for InvalidInput {}
