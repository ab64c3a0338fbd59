//! x
pub mod export;
pub mod impact;
pub mod measure;
