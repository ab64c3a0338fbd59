//! How an impact ends.

use crate::StopReason;
use std::fmt;

/// Outcome of an impact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// The striker left, and it is certain that the structure can never catch it again. Under gravity, its first flight of some height
    /// has begun ([`Solver::under_gravity`](crate::modal::Solver::under_gravity)).
    Rebound,
    /// The bodies never met.
    NoContact,
    /// The bodies stay in contact: the motion has decayed, or the remaining motion cannot separate them (for example a structure
    /// that is pressed against an immovable stop). Under gravity, no flight has reached that height for a long
    /// time. How this is decided on an infinite beam stands in [`infinite`](crate::infinite).
    Sustained,
    /// The computation stopped before the impact had ended; the solution holds what was found until then, which is valid.
    Stopped(StopReason),
}

impl Outcome {
    /// The outcome as a word for tables and files.
    pub fn as_str(self) -> &'static str {
        match self {
            Outcome::Rebound => "rebound",
            Outcome::NoContact => "no contact",
            Outcome::Sustained => "sustained",
            Outcome::Stopped(_) => "stopped",
        }
    }

    /// The reason why the computation stopped before the end of the impact, if it did.
    pub fn stopped_by(self) -> Option<StopReason> {
        match self {
            Outcome::Stopped(reason) => Some(reason),
            _ => None,
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Outcome::Stopped(reason) => write!(f, "stopped: {reason}"),
            ended => f.pad(ended.as_str()),
        }
    }
}
