//! vibroimpact

pub mod plot;
