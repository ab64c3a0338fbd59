//! What can keep a sweep from its end.

use std::io;
use std::path::{Path, PathBuf};

use crate::scene::{InvalidInput, SceneError};

/// Why a sweep, or a merge of its parts, did not come to its end.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// The sweep file or the base scene cannot be read.
    #[error(transparent)]
    File(#[from] SceneError),
    /// A field of the sweep or of its base scene cannot be used.
    #[error(transparent)]
    Invalid(#[from] InvalidInput),
    /// The folder cannot take this sweep, or the parts do not make one; the text says why and what would help.
    #[error("{0}")]
    Refused(String),
    /// The program was asked to stop; what was finished is kept.
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
        /// What the system said.
        source: io::Error,
    },
}

impl SweepError {
    /// Puts the name of the file to what the system said.
    pub(super) fn io(path: &Path) -> impl FnOnce(io::Error) -> SweepError + '_ {
        move |source| SweepError::Io { path: path.to_owned(), source }
    }

    /// Whether the cause is what the user gave, not the machine.
    pub fn is_of_input(&self) -> bool {
        matches!(self, SweepError::File(_) | SweepError::Invalid(_) | SweepError::Refused(_))
    }
}
