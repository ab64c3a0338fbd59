//! What can go wrong in a task, and how its program ends.

use std::error::Error;
use std::fmt;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

/// Any error of a run, such as bad parameters or a full disk.
pub type Failure = Box<dyn Error + Send + Sync>;

/// Invalid input. The message names the argument, its value and the allowed values.
#[derive(Debug)]
pub struct BadInput(pub String);

impl fmt::Display for BadInput {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl Error for BadInput {}

/// Writes the error of a task, and returns the exit code of the program: 2 for invalid input, as in `vibroimpact` itself.
pub fn ended(result: Result<(), Failure>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            if failure.is::<BadInput>() { ExitCode::from(2) } else { ExitCode::FAILURE }
        }
    }
}

/// Writes a line to the standard output.
///
/// # Errors
/// Errors of the output, except that a reader has closed it early.
pub fn say(text: &str) -> Result<(), Failure> {
    match writeln!(std::io::stdout(), "{text}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
