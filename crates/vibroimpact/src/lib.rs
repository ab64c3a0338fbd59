//! vibroimpact

mod impact;

pub mod export;
pub mod plot;
pub mod report;
pub mod scene;
pub mod summary;
pub mod text;

pub use impact::Impact;
pub use scene::{InvalidInput, Scene, SceneError};
