//! What development tasks share: errors and exit codes, progress, and the folder of a study.

mod failure;
mod progress;
mod study;

pub use failure::{BadInput, Failure, ended, say};
pub use progress::Progress;
pub use study::{Finished, Study, targets};
