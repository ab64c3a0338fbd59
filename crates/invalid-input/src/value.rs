//! The value of an input.

use core::fmt::{self, Display, Formatter, Write};

use crate::told;

/// A text: a literal, or with the feature `alloc` one made at run time.
#[cfg(feature = "alloc")]
pub type Text = alloc::string::String;
/// A text: a literal, or with the feature `alloc` one made at run time.
#[cfg(not(feature = "alloc"))]
pub type Text = &'static str;

/// A decimal number longer than this is shown with a power of ten.
const LONGEST_DECIMAL: usize = 20;

/// A value that cannot be used.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Value {
    /// A number. A very large or small one is shown with its power of ten, not with all its zeros.
    Number(f64),
    /// A whole number.
    Count(u64),
    /// Anything else, as the text that a message shows.
    Text(Text),
}

impl Display for Value {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Value::Number(number) => {
                let size = number.abs();
                match told::count(number) > LONGEST_DECIMAL {
                    true if size < 1e-5 => write!(f, "{number:e}"),
                    true if size >= 1e16 => write!(Signed(f), "{number:e}"),
                    _ => write!(f, "{number}"),
                }
            }
            Value::Count(count) => write!(f, "{count}"),
            Value::Text(text) => f.write_str(text),
        }
    }
}

/// Writes the sign of a positive exponent too, as in JSON.
struct Signed<'a, 'b>(&'a mut Formatter<'b>);

impl Write for Signed<'_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        match text.split_once('e') {
            Some((mantissa, exponent)) => write!(self.0, "{mantissa}e+{exponent}"),
            None => self.0.write_str(text),
        }
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Value {
        Value::Number(number)
    }
}

macro_rules! whole {
    ($($kind:ty),*) => {
        $(impl From<$kind> for Value {
            fn from(count: $kind) -> Value {
                Value::Count(count as u64)
            }
        })*
    };
}

whole!(u32, u64, usize);

impl From<Text> for Value {
    fn from(text: Text) -> Value {
        Value::Text(text)
    }
}

#[cfg(feature = "alloc")]
impl From<&str> for Value {
    fn from(text: &str) -> Value {
        Value::Text(text.into())
    }
}
