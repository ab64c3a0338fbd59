//! One impact of a compact body on a vibrating structure, fully resolved.
//!
//! [`modal`] solves impacts on structures described by their modes; [`dropped_rod`] poses the drop of a tilted rod on
//! an immovable surface as one of them. [`infinite`] solves impacts on an infinite beam or plate, which carry the
//! energy away as waves.

pub mod dropped_rod;
mod error;
pub mod infinite;
pub mod modal;

pub use error::InvalidInput;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
