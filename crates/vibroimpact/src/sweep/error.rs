//! Errors of sweeps.

use std::io;
use std::path::{Path, PathBuf};

use crate::scene::{InvalidInput, SceneError};

/// The reason why a sweep, or a merge of its parts, did not finish.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// The sweep file or the base scene cannot be read.
    #[error(transparent)]
    File(#[from] SceneError),
    /// A field of the sweep or of its base scene is invalid.
    #[error(transparent)]
    Invalid(#[from] InvalidInput),
    /// The folder cannot be used for this sweep, or the parts do not form a sweep; the text states the reason and advice.
    #[error("{0}")]
    Refused(String),
    /// The program was interrupted; finished rows are kept.
    #[error("stopped with {done} of {points} points done; the same command continues from there")]
    Stopped {
        /// Points whose rows are in the folder.
        done: u64,
        /// Points of the sweep, or of the part.
        points: u64,
    },
    /// A file or folder cannot be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
}

impl SweepError {
    /// Adds the name of the file to an error of the system.
    pub(super) fn io(path: &Path) -> impl FnOnce(io::Error) -> SweepError + '_ {
        move |source| SweepError::Io { path: path.to_owned(), source }
    }

    /// Whether the cause is the user's input and not the machine.
    pub fn is_of_input(&self) -> bool {
        matches!(self, SweepError::File(_) | SweepError::Invalid(_) | SweepError::Refused(_))
    }
}
