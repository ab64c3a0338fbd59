//! One impact of a compact body on a vibrating structure, fully resolved.
//!
//! [`modal`] solves impacts on structures described by their modes.

mod error;
pub mod modal;

pub use error::InvalidInput;
