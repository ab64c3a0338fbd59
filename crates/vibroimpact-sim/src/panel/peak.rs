//! The largest value of a quantity over many panels.

use super::ends::Ends;
use super::legendre::{Nodal, Q};

/// The largest value of a quantity over the steps of a contact. The step with the largest value is stored, and what its nodal
/// values represent is searched when the contact has ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Peak {
    largest: f64,
    nodal: Nodal,
    ends: Ends,
}

/// Steps whose nodal values differ by more than this ratio are compared by these alone. A maximum beside the end of a long step can
/// lie above its nodes by more than above those of the short step that adjoins it.
const CLOSE: f64 = 0.8;

impl Peak {
    pub const NONE: Peak = Peak { largest: 0.0, nodal: [0.0; Q], ends: Ends::SMOOTH };

    pub fn note(&mut self, nodal: &Nodal, ends: Ends) {
        let largest = nodal.iter().fold(0.0, |a: f64, b| a.max(*b));
        if largest <= CLOSE * self.largest {
            return;
        }
        let found = Peak { largest, nodal: *nodal, ends };
        if CLOSE * largest > self.largest || found.value() > self.value() {
            *self = found;
        }
    }

    pub fn value(&self) -> f64 {
        self.largest.max(self.ends.maximum(&self.ends.quotient(&self.nodal)).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::legendre::BASIS;

    /// A parabola whose maximum lies just behind the end of a short step, before all nodes of a long one.
    #[test]
    fn a_maximum_beside_the_join_of_a_short_and_a_long_step_is_found() {
        let parabola = |t: f64| 1.0 - (t - 0.004).powi(2);
        for steps in [[(-0.01, 0.01), (0.0, 1.0)], [(0.008, -0.01), (0.008, -1.0)]] {
            for order in [[0, 1], [1, 0]] {
                let mut peak = Peak::NONE;
                for (from, h) in order.map(|i| steps[i]) {
                    peak.note(&BASIS.nodes.map(|s| parabola(from + s * h)), Ends::SMOOTH);
                }
                assert!((peak.value() - 1.0).abs() < 1e-14, "{}", peak.value());
            }
        }
    }
}
