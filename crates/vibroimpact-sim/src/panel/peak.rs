//! The largest value of a quantity over many panels.

use super::legendre::{Legendre, Nodal, Q};

/// The largest value of a quantity over the steps of a contact. The step with the largest nodal value is stored, and its
/// polynomial is searched when the contact has ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Peak {
    largest: f64,
    nodal: Nodal,
}

impl Peak {
    pub const NONE: Peak = Peak { largest: 0.0, nodal: [0.0; Q] };

    pub fn note(&mut self, nodal: &Nodal) {
        let largest = nodal.iter().fold(0.0, |a: f64, b| a.max(*b));
        if largest > self.largest {
            *self = Peak { largest, nodal: *nodal };
        }
    }

    pub fn value(&self) -> f64 {
        self.largest.max(Legendre::through(&self.nodal).maximum().1)
    }
}
