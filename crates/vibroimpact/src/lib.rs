//! vibroimpact

mod impact;

pub mod plot;
pub mod report;
pub mod scene;

pub use impact::Impact;
pub use scene::{InvalidInput, Scene, SceneError};
