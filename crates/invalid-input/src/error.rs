//! The error itself.

use core::fmt::{self, Display, Formatter};

use crate::path::{Path, Step};
use crate::told::{LONGEST_VALUE, cut, printable};
use crate::value::{Text, Value};

/// Longest path that a message shows (characters).
const LONGEST_PATH: usize = 90;

/// An input that cannot be used: where it stands, the value found there, and what would be allowed.
#[derive(Debug, Clone, PartialEq)]
pub struct InvalidInput {
    /// Where it stands; empty where the whole is meant. It can be compared with a text.
    pub field: Path,
    /// The value found there; `None` where the field is missing.
    pub value: Option<Value>,
    /// What would be allowed. A field that has no place where it stands is told to be `left out`.
    pub allowed: Text,
}

impl InvalidInput {
    /// A value that is not allowed.
    pub fn new(field: impl Into<Path>, value: impl Into<Value>, allowed: impl Into<Text>) -> InvalidInput {
        InvalidInput { field: field.into(), value: Some(value.into()), allowed: allowed.into() }
    }

    /// A field that is missing.
    pub fn missing(field: impl Into<Path>, allowed: impl Into<Text>) -> InvalidInput {
        InvalidInput { field: field.into(), value: None, allowed: allowed.into() }
    }

    /// Passes when `ok` holds, and reports the field otherwise.
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

    /// Passes a finite number greater than zero.
    ///
    /// # Errors
    /// If it is anything else.
    #[inline]
    pub fn require_positive(field: impl Into<Path>, value: f64) -> Result<f64, InvalidInput> {
        let ok = value > 0.0 && value.is_finite();
        InvalidInput::unless(ok, field, value, "a finite number greater than 0").map(|()| value)
    }

    /// Passes a finite number.
    ///
    /// # Errors
    /// If it is anything else.
    #[inline]
    pub fn require_finite(field: impl Into<Path>, value: f64) -> Result<f64, InvalidInput> {
        InvalidInput::unless(value.is_finite(), field, value, "a finite number").map(|()| value)
    }

    /// The same fault, seen from an object that holds the field's object at `parent`.
    #[must_use]
    pub fn within(self, parent: impl Into<Path>) -> InvalidInput {
        InvalidInput { field: self.field.within(parent), ..self }
    }

    /// The same fault, seen from a list that holds the field's object at `index`.
    #[must_use]
    pub fn at(self, index: usize) -> InvalidInput {
        self.within(Step::Index(index))
    }

    /// The same fault seen from the object at the field `parent`, if it stands there: the inverse of
    /// [`InvalidInput::within`].
    #[must_use]
    pub fn without(self, parent: &str) -> InvalidInput {
        if self.field.first() == Some(parent) {
            InvalidInput { field: self.field.steps()[1..].into(), ..self }
        } else {
            self
        }
    }

    /// The same fault in a file, or in another place that is no field.
    #[must_use]
    pub fn in_place(self, place: impl Into<Text>) -> InvalidInput {
        self.within(Step::Place(place.into()))
    }

    /// The same fault in a line of a file or table, from 1.
    #[must_use]
    pub fn in_line(self, line: u64) -> InvalidInput {
        self.within(Step::Line(line))
    }

    /// The same fault under another name.
    #[must_use]
    pub fn under(self, field: impl Into<Path>) -> InvalidInput {
        InvalidInput { field: field.into(), ..self }
    }
}

impl Display for InvalidInput {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        // names and values may come from files and hold anything
        if self.field.is_empty() {
            f.write_str("the input")?;
        } else {
            write!(f, "{}", cut(printable(&self.field), LONGEST_PATH))?;
        }
        let allowed = printable(&self.allowed);
        match &self.value {
            Some(value) => {
                // a field that has to go is told so; of any other it is told what would be allowed
                let verdict = if self.allowed.starts_with("left out") { "must be" } else { "is not allowed:" };
                write!(f, " = {} {verdict} {allowed}", cut(printable(value), LONGEST_VALUE))
            }
            None => write!(f, " is missing: {allowed}"),
        }
    }
}

impl core::error::Error for InvalidInput {}
