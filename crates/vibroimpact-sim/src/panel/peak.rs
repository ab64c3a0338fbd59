//! The largest value of a quantity over many panels.

use super::ends::Ends;
use super::legendre::{Legendre, Nodal};
use super::root::root;

/// The largest value of a quantity over the steps of a contact, hump by hump of the largest nodal values of the steps: a hump with
/// lower nodal values than another may be higher between its nodes. The maximum of a hump lies in its step with the largest nodal
/// value or in one beside it: a maximum beside the end of a long step can lie above its nodes by more than above those of the short
/// step that adjoins it. What the nodal values of these steps represent is searched when the hump has ended. `M` is what else is known
/// of a step, by which the maximum of the polynomial through its nodes is improved.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Peak<M> {
    at_nodes: f64,
    of_earlier_humps: f64,
    before: Option<Step<M>>,
    highest: Option<Step<M>>,
    after: Option<Step<M>>,
    last: Option<Step<M>>,
}

#[derive(Debug, Clone, Copy)]
struct Step<M> {
    largest: f64,
    nodal: Nodal,
    ends: Ends,
    more: M,
}

/// A step or a hump is searched if its largest nodal value is at least this part of the highest one.
const CLOSE: f64 = 0.8;
/// Distance from the place of the maximum of a polynomial within which that of the quantity is searched, and its accuracy.
const BESIDE: f64 = 1.0 / 16.0;
const WITHIN: f64 = 1e-9;

/// The place of the maximum of a quantity with this slope on a step, from that of the polynomial through its nodes.
pub(crate) fn turning_point(place: f64, slope: impl Fn(f64) -> f64) -> f64 {
    let [from, to] = [(place - BESIDE).max(0.0), (place + BESIDE).min(1.0)];
    let turns = slope(from) > 0.0 && slope(to) < 0.0;
    if turns { root(from, to, WITHIN, slope).clamp(from, to) } else { place }
}

impl<M> Step<M> {
    fn maximum(&self, improve: &impl Fn(&M, f64) -> f64) -> f64 {
        let (place, _) = self.ends.maximum(&self.ends.quotient(&self.nodal));
        self.largest.max(improve(&self.more, place))
    }

    /// Whether its values fall towards the highest step, which adjoins its end or its start. Its maximum then lies inside it.
    fn turns(&self, at_end: bool) -> bool {
        let [at_start, at_the_end] = Legendre::through(&self.nodal).slopes_at_ends();
        !self.ends.is_smooth() || if at_end { at_the_end < 0.0 } else { at_start > 0.0 }
    }
}

impl<M: Copy> Peak<M> {
    pub const NONE: Peak<M> =
        Peak { at_nodes: 0.0, of_earlier_humps: 0.0, before: None, highest: None, after: None, last: None };

    /// Adds a step; `improve` as in [`Peak::value`].
    pub fn note(&mut self, nodal: &Nodal, ends: Ends, more: M, improve: impl Fn(&M, f64) -> f64) {
        let largest = nodal.iter().fold(0.0, |a: f64, b| a.max(*b));
        let step = Step { largest, nodal: *nodal, ends, more };
        let rises = |from: &Option<Step<M>>| from.is_none_or(|from| largest > from.largest);
        if self.after.is_some() && rises(&self.last) {
            self.of_earlier_humps = self.value(improve);
            (self.before, self.highest, self.after) = (self.last, Some(step), None);
        } else if rises(&self.highest) {
            (self.before, self.highest, self.after) = (self.last, Some(step), None);
        } else if self.after.is_none() {
            self.after = Some(step);
        }
        self.last = Some(step);
        self.at_nodes = self.at_nodes.max(largest);
    }

    /// The largest nodal value.
    pub fn at_nodes(&self) -> f64 {
        self.at_nodes
    }

    /// The largest value, where `improve` gives the maximum of the quantity on a step near the place of that of the polynomial.
    pub fn value(&self, improve: impl Fn(&M, f64) -> f64) -> f64 {
        let Some(highest) = self.highest.filter(|step| step.largest >= CLOSE * self.of_earlier_humps) else {
            return self.of_earlier_humps;
        };
        let beside = |step: &Option<Step<M>>, at_end| {
            let may_be_higher = |step: &Step<M>| step.largest >= CLOSE * highest.largest && step.turns(at_end);
            step.filter(may_be_higher).map_or(0.0, |step| step.maximum(&improve))
        };
        let hump = highest.maximum(&improve).max(beside(&self.before, true)).max(beside(&self.after, false));
        hump.max(self.of_earlier_humps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::legendre::BASIS;

    /// The peak of a quantity over steps from a place and of a length.
    fn peak(quantity: impl Fn(f64) -> f64, steps: &[(f64, f64)]) -> f64 {
        let at = |(from, h): &(f64, f64), place: f64| quantity(from + place * h);
        let mut peak = Peak::NONE;
        for step in steps {
            peak.note(&BASIS.nodes.map(|s| at(step, s)), Ends::SMOOTH, *step, at);
        }
        peak.value(at)
    }

    /// A parabola whose maximum lies just behind the end of a short step, before all nodes of a long one.
    #[test]
    fn a_maximum_beside_the_join_of_a_short_and_a_long_step_is_found() {
        for steps in [[(-0.01, 0.01), (0.0, 1.0)], [(0.008, -0.01), (0.008, -1.0)]] {
            for order in [[0, 1], [1, 0]] {
                let value = peak(|t| 1.0 - (t - 0.004).powi(2), &order.map(|i| steps[i]));
                assert!((value - 1.0).abs() < 1e-14, "{value}");
            }
        }
    }

    /// The higher of two humps lies between the nodes of a long step, all of which are lower than a node at the top of the other.
    #[test]
    fn the_higher_of_two_humps_is_found_between_its_nodes() {
        let hump = |t: f64, top: f64, height: f64| height - (t - top).powi(2);
        let node = BASIS.nodes[4];
        let between = 0.5 * (BASIS.nodes[3] + BASIS.nodes[4]);
        let quantity = |t: f64| if t < 1.0 { hump(t, node, 1.0) } else { hump(t, 2.0 + between, 1.0 + 1e-3) };
        for steps in [[0.0, 1.0, 2.0], [2.0, 1.0, 0.0]] {
            let value = peak(quantity, &steps.map(|from| (from, 1.0)));
            assert!((value - 1.001).abs() < 1e-14, "{value}");
        }
    }
}
