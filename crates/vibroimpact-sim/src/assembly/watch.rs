//! The contacts that are computed on a panel: the closed ones, and those open ones that may close on it.

use super::enclosure::{FlightBounds, bend_of_loads};
use super::motion::March;
use super::state::Phase;
use crate::panel::legendre::Legendre;
use crate::panel::vector::vectorized;

impl<'a> March<'a> {
    /// Lists the closed contacts and returns their number.
    pub(super) fn closed(&self, contacts: &mut Vec<usize>) -> usize {
        contacts.clear();
        contacts.extend((0..self.states.len()).filter(|&c| self.states[c].is_closed()));
        contacts.len()
    }

    /// Adds the open contacts that may close within `h` while the closed ones have these forces.
    pub(super) fn watch(&mut self, h: f64, contacts: &mut Vec<usize>, closed: usize, force: &[Legendre]) {
        let lasting = self.lasting();
        for c in 0..self.states.len() {
            let moves = self.system.links[c].mobility > 0.0;
            if self.states[c].is_closed() || contacts.contains(&c) || !moves {
                continue;
            }
            let disturbed = self.is_disturbed(c);
            if !disturbed && self.clear_until(c) <= self.time_s {
                self.renew(c, lasting);
            }
            let near = match disturbed {
                true => self.may_close(c, h, (&contacts[..closed], force)),
                false => self.clear_until(c) < self.time_s + h,
            };
            if near {
                (self.states[c].overlap, self.states[c].rate) = self.overlap_of_modes(c);
                contacts.push(c);
            }
        }
    }

    /// Whether an open contact can close within `h`. Free motion from `a` and `a'` displaces a mode by at most
    /// `min(omega h, 2) |a| + h |a'|`. An impulse changes the overlap by at most `h` times the change of its rate.
    fn may_close(&self, c: usize, h: f64, (closed, force): (&[usize], &[Legendre])) -> bool {
        let (links, state) = (&self.system.links, &self.states[c]);
        let (mut overlap, mut reach, mut size) = (self.loads.overlap(c, self.time_s).0, 0.0, state.reference.abs());
        let sums = self.sums(
            c,
            #[inline(always)]
            |[psi, omega, a, b]| {
                let turned = omega * h;
                let turned = if turned < 2.0 { turned } else { 2.0 };
                [psi * a, psi.abs() * (turned * a.abs() + h * b.abs()), (psi * a).abs()]
            },
        );
        for [here, moved, most] in sums {
            overlap += here;
            reach += moved;
            size += most;
        }
        for (other, force) in closed.iter().zip(force).filter(|(other, _)| self.system.neighbours[c].contains(other)) {
            let impulse = h * force.0.iter().map(|coefficient| coefficient.abs()).sum::<f64>();
            reach += h * impulse * (links[c].mobility * links[*other].mobility).sqrt();
        }
        reach += self.loads.most_moved(c, self.time_s, h);
        // with more than rounding to spare
        state.touch_m() - (state.reference + overlap) <= reach + 1e-12 * (size + reach)
    }

    /// Finds the time up to which an open contact stays open if no force acts on its bodies.
    pub(super) fn renew(&mut self, c: usize, lasting: f64) {
        let link = &self.system.links[c];
        let (shift, shift_rate) = self.loads.overlap(c, self.time_s);
        let rigid = |values: &[f64]| link.rigid.iter().map(|(k, psi)| psi * values[*k]).sum::<f64>();
        let overlap = self.states[c].reference + (rigid(&self.amplitude) + shift) - self.states[c].touch_m();
        let rate = rigid(&self.rate) + shift_rate;
        let bend = bend_of_loads(&self.loads, c, self.time_s, lasting);
        self.bounds(c);
        let motion = (self.amplitude.as_slice(), self.rate.as_slice());
        let Phase::Open { bounds: Some(bounds), .. } = &self.states[c].phase else { return };
        let safe = vectorized(
            #[inline(always)]
            || {
                bounds.safe_time(
                    link,
                    (overlap, rate),
                    bend,
                    || (self.overlap_rounding(c), self.rate_rounding(c)),
                    motion,
                )
            },
        );
        let until = self.time_s + safe;
        if let Phase::Open { clear_until, .. } = &mut self.states[c].phase {
            *clear_until = until;
        }
    }

    /// Bounds on the free motion of an open contact.
    pub(super) fn bounds(&mut self, c: usize) -> Option<&FlightBounds> {
        let motion = (self.amplitude.as_slice(), self.rate.as_slice());
        let new = || Box::new(FlightBounds::new(self.system, c, motion));
        match &mut self.states[c].phase {
            Phase::Open { bounds, .. } => {
                if bounds.as_mut().is_some_and(|bounds| bounds.are_worn()) {
                    *bounds = None;
                }
                Some(bounds.get_or_insert_with(new))
            }
            Phase::Closed(_) => None,
        }
    }
}
