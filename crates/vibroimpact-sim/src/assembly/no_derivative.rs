//! Why a run has no derivative.

/// Why a run has no derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum NoDerivative {
    /// It stopped early, or an impact did not end with a rebound.
    Outcome,
    /// A contact only grazes, with no speed: after a change it may be missed.
    Graze {
        /// The contact, by its place in the list.
        contact: usize,
        /// When (s).
        time_s: f64,
    },
    /// A contact whose force jumps at first touch begins at the same time as another, and after a change at another time.
    Together {
        /// The contact, by its place in the list.
        contact: usize,
        /// When (s).
        time_s: f64,
    },
    /// The law of a contact takes another course after a change.
    Fork {
        /// The contact, by its place in the list.
        contact: usize,
        /// When (s).
        time_s: f64,
    },
    /// A contact begins, ends or changes its law's branch just at a break of a load.
    Break {
        /// When (s).
        time_s: f64,
    },
    /// The derivatives are no finite numbers.
    Infinite,
}
