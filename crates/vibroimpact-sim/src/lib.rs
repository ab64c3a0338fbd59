//! vibroimpact-sim

mod error;
pub mod infinite;

pub use error::InvalidInput;
