//! vibroimpact

pub mod plot;
pub mod report;
pub mod scene;

pub use scene::{InvalidInput, Scene, SceneError};
