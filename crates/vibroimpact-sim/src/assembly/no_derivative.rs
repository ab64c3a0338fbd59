//! Reasons why a run has no derivative.

use std::fmt;

/// The reason why a run has no derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum NoDerivative {
    /// It stopped early, or an impact did not end with a rebound.
    Outcome,
    /// A contact grazes with zero speed, and may disappear after a change.
    Graze {
        /// The contact, by its place in the list.
        contact: usize,
        /// When (s).
        time_s: f64,
    },
    /// The surfaces of a contact rest against each other without force. A change to one side presses them together, and one to the other
    /// side separates them.
    Rests {
        /// The contact, by its place in the list.
        contact: usize,
        /// Until when at least (s).
        time_s: f64,
    },
    /// A contact whose force jumps at first touch begins at the same time as another, and after a change at another time.
    Together {
        /// The contact, by its place in the list.
        contact: usize,
        /// When (s).
        time_s: f64,
    },
    /// The law of a contact may follow another branch after a change.
    Fork {
        /// The contact, by its place in the list.
        contact: usize,
        /// When (s).
        time_s: f64,
    },
    /// A contact begins, ends or changes its branch at the time of a break of a load.
    Break {
        /// When (s).
        time_s: f64,
    },
    /// Times at which loads jump or change their slope coincide, or one is that of the start, and after a change they do not.
    Split,
    /// The derivatives are not finite.
    Infinite,
}

impl fmt::Display for NoDerivative {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoDerivative::Outcome => f.write_str("the run stopped early, or the impact did not end with a rebound"),
            NoDerivative::Graze { contact, time_s } => {
                write!(f, "contact {contact} touches without speed at {time_s} s")
            }
            NoDerivative::Rests { contact, time_s } => {
                write!(f, "contact {contact} touches without speed and without force until {time_s} s")
            }
            NoDerivative::Together { contact, time_s } => {
                write!(f, "contact {contact} begins with a jump of its force beside another at {time_s} s")
            }
            NoDerivative::Fork { contact, time_s } => {
                write!(f, "the law of contact {contact} may follow either of two branches at {time_s} s")
            }
            NoDerivative::Break { time_s } => write!(f, "an event coincides with a break of a load at {time_s} s"),
            NoDerivative::Split => {
                f.write_str("a load jumps or begins with the run, so that the derivatives to both sides differ")
            }
            NoDerivative::Infinite => f.write_str("the derivatives are not finite"),
        }
    }
}
