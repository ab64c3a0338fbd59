//! What development tasks share: errors and exit codes, progress, rows that outlast an interruption, random numbers, and the
//! folder of a study.

mod failure;
mod journal;
mod progress;
mod random;
mod study;

pub use failure::{BadInput, Failure, ended, say};
pub use journal::Journal;
pub use progress::Progress;
pub use random::Random;
pub use study::{Finished, Study, targets};
