//! What can go wrong in a task.

use std::error::Error;
use std::fmt;

/// Any error of a run, such as bad parameters or a full disk.
pub type Failure = Box<dyn Error + Send + Sync>;

/// Invalid input. The message names the argument, its value and the allowed values.
#[derive(Debug)]
pub struct BadInput(pub String);

impl BadInput {
    /// The error for a chapter that does not exist.
    pub fn chapter(found: &str) -> BadInput {
        BadInput(format!("chapter = {found} is not allowed: 2, 3, 4, 5, 6, 7, 8, ensemble, theories or all"))
    }
}

impl fmt::Display for BadInput {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl Error for BadInput {}
