//! vibroimpact

pub mod plot;
pub mod report;
