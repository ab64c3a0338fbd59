//! One error for input that cannot be used: its path, its value, and what would be allowed.
//!
//! A function that checks a number knows its name; the caller that has the object with this number prepends the object's name.
//! The path of a field is therefore a list of typed [`Step`]s that grows from the inside out:
//!
//! ```
//! use invalid_input::InvalidInput;
//!
//! fn mass(mass_kg: f64) -> Result<f64, InvalidInput> {
//!     InvalidInput::require_positive("mass_kg", mass_kg)
//! }
//!
//! let fault = mass(f64::NAN).unwrap_err().at(2).within("strikers");
//! assert_eq!(fault.to_string(), "strikers[2].mass_kg = NaN is not allowed; it must be a finite number greater than 0");
//! ```
//!
//! Without the feature `alloc` the crate needs neither `std` nor an allocator. Names are then literals, and a path consists of
//! its three innermost steps.
#![no_std]
// Without an allocator a literal is a text already, and an error holds its path itself.
#![cfg_attr(not(feature = "alloc"), allow(clippy::useless_conversion, clippy::result_large_err))]

#[cfg(feature = "alloc")]
extern crate alloc;

mod error;
mod extreme;
#[cfg(feature = "alloc")]
mod names;
mod path;
mod told;
mod value;

pub use error::InvalidInput;
pub use extreme::most_extreme;
pub use path::{Path, Step};
pub use told::{LONGEST_VALUE, cut, printable};
pub use value::{Text, Value};
