//! The largest value of a quantity over many panels.

use super::ends::Ends;
use super::legendre::{Legendre, Nodal, Q};

/// The largest value of a quantity over the steps of a contact. It lies in the step with the largest nodal value or in one beside
/// it: a maximum beside the end of a long step can lie above its nodes by more than above those of the short step that adjoins it.
/// What the nodal values of these steps represent is searched when the contact has ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Peak {
    highest: Step,
    before: Step,
    after: Option<Step>,
    last: Step,
}

#[derive(Debug, Clone, Copy)]
struct Step {
    largest: f64,
    nodal: Nodal,
    ends: Ends,
}

/// A step beside the highest one is searched if its largest nodal value is at least this part of the other.
const CLOSE: f64 = 0.8;

impl Step {
    const NONE: Step = Step { largest: 0.0, nodal: [0.0; Q], ends: Ends::SMOOTH };

    fn maximum(&self) -> f64 {
        self.largest.max(self.ends.maximum(&self.ends.quotient(&self.nodal)).1)
    }

    /// Whether its values fall towards the highest step, which adjoins its end or its start. Its maximum then lies inside it.
    fn turns(&self, at_end: bool) -> bool {
        let [at_start, at_the_end] = Legendre::through(&self.nodal).slopes_at_ends();
        !self.ends.is_smooth() || if at_end { at_the_end < 0.0 } else { at_start > 0.0 }
    }
}

impl Peak {
    pub const NONE: Peak = Peak { highest: Step::NONE, before: Step::NONE, after: None, last: Step::NONE };

    pub fn note(&mut self, nodal: &Nodal, ends: Ends) {
        let step = Step { largest: nodal.iter().fold(0.0, |a: f64, b| a.max(*b)), nodal: *nodal, ends };
        if step.largest > self.highest.largest {
            (self.before, self.highest, self.after) = (self.last, step, None);
        } else if self.after.is_none() {
            self.after = Some(step);
        }
        self.last = step;
    }

    /// The largest nodal value.
    pub fn at_nodes(&self) -> f64 {
        self.highest.largest
    }

    pub fn value(&self) -> f64 {
        let beside = |step: &Step, at_end| {
            let may_be_higher = step.largest >= CLOSE * self.highest.largest && step.turns(at_end);
            if may_be_higher { step.maximum() } else { 0.0 }
        };
        let after = self.after.map_or(0.0, |step| beside(&step, false));
        self.highest.maximum().max(beside(&self.before, true)).max(after)
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
