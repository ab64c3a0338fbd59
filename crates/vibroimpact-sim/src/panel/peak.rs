//! The largest value of a quantity over many panels.

use super::ends::Ends;
use super::legendre::{Nodal, Q};

/// The largest value of a quantity over the steps of a contact. The step with the largest nodal value is stored, and
/// what its nodal values represent is searched when the contact has ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Peak {
    largest: f64,
    nodal: Nodal,
    ends: Ends,
}

impl Peak {
    pub const NONE: Peak = Peak { largest: 0.0, nodal: [0.0; Q], ends: Ends::SMOOTH };

    pub fn note(&mut self, nodal: &Nodal, ends: Ends) {
        let largest = nodal.iter().fold(0.0, |a: f64, b| a.max(*b));
        if largest > self.largest {
            *self = Peak { largest, nodal: *nodal, ends };
        }
    }

    pub fn value(&self) -> f64 {
        self.largest.max(self.ends.maximum(&self.ends.quotient(&self.nodal)).1)
    }
}
