//! Dense output: the motion anywhere on a panel.

use super::load::Loads;
use super::solution::{ContactSample, Motion};
use super::system::System;
use crate::panel::ends::Ends;
use crate::panel::legendre::{Legendre, Nodal};
use crate::panel::oscillator::{propagate, response};
use contact_models::{Branch, ContactLaw};

/// A contact on a stretch of motion: the part of its overlap that does not come from modes and loads (m), and its branch while
/// it is closed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    pub reference: f64,
    pub branch: Option<Branch>,
}

/// An event of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Event {
    /// It closes: its surfaces meet. Surfaces that overlap at the start have met before.
    Close { overlaps: bool },
    /// It crosses this boundary of its branch.
    Cross(usize),
}

/// A stretch of motion without an event.
#[derive(Debug, Clone)]
pub(crate) struct Stretch {
    /// Events at its start, in this order.
    pub events: Vec<(usize, Event)>,
    pub start_s: f64,
    pub length_s: f64,
    /// Modal state at its start, relative to the steady motion.
    pub amplitude: Vec<f64>,
    pub rate: Vec<f64>,
    pub contacts: Vec<Seen>,
    /// The forces of the closed contacts.
    pub forces: Vec<Acting>,
}

/// The force of a closed contact on a stretch: the polynomial that moves the modes, how the force begins and ends, and whether it may
/// depend on the rate of compression.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Acting {
    pub contact: usize,
    pub force: Legendre,
    pub ends: Ends,
    pub by_rate: bool,
}

/// A stretch with the data that its evaluation needs.
pub(crate) struct Panel<'a> {
    pub system: &'a System,
    pub loads: &'a Loads,
    pub laws: &'a [&'a dyn ContactLaw],
    pub stretch: &'a Stretch,
}

impl Panel<'_> {
    /// Relative modal state `h` seconds after its start: up to its length, or for all later times if no contact is closed.
    fn carried(&self, h: f64) -> (Vec<f64>, Vec<f64>) {
        let stretch = self.stretch;
        let (mut amplitude, mut rate) = (stretch.amplitude.clone(), stretch.rate.clone());
        for (k, mode) in self.system.modes.iter().enumerate() {
            (amplitude[k], rate[k]) = propagate(mode, h).apply(amplitude[k], rate[k]);
        }
        for Acting { contact, force, .. } in stretch.forces.iter().filter(|_| h > 0.0) {
            // the force as a polynomial on the part alone
            let Legendre(force) = &force.restricted(h / stretch.length_s);
            for span in &self.system.links[*contact].spans {
                for (k, psi) in span.modes.clone().zip(&span.psi).filter(|(_, psi)| **psi != 0.0) {
                    let (moved, pushed) = match self.system.modes[k].is_rigid() {
                        // int (1-s) P_n ds is 1/2, -1/6 and 0 from then on
                        true => (h * h * (force[0] / 2.0 - force[1] / 6.0), h * force[0]),
                        false => {
                            let (displacement, velocity) = response(&self.system.modes[k], h);
                            let of = |response: &Nodal| response.iter().zip(force).map(|(r, f)| r * f).sum::<f64>();
                            (of(&displacement), of(&velocity))
                        }
                    };
                    amplitude[k] -= psi * moved;
                    rate[k] -= psi * pushed;
                }
            }
        }
        self.loads.push_rigid(stretch.start_s, h, &mut amplitude, &mut rate);
        (amplitude, rate)
    }

    /// The modes `h` seconds after the start, in the system's order.
    fn moved(&self, h: f64) -> (Vec<f64>, Vec<f64>) {
        let (mut amplitude, mut rate) = self.carried(h);
        self.loads.shift_modes(self.system, self.stretch.start_s + h, 1.0, &mut amplitude, &mut rate);
        (amplitude, rate)
    }

    /// All modes, body by body as the user counts them, `h` seconds after the start.
    pub fn modes_after(&self, h: f64) -> (Vec<f64>, Vec<f64>) {
        let (amplitude, rate) = self.moved(h);
        in_users_order(self.system, &amplitude, &rate)
    }

    /// A contact `h` seconds after the start.
    pub fn contact_after(&self, contact: usize, h: f64) -> ContactSample {
        let (amplitude, rate) = self.moved(h);
        let (link, seen) = (&self.system.links[contact], self.stretch.contacts[contact]);
        let overlap_m = seen.reference + link.sum(&amplitude);
        let rate_m_s = link.sum(&rate);
        let law = self.laws[contact];
        // between the nodes and at a touch the motion satisfies the law only within the tolerance
        let force_n = seen.branch.map_or(0.0, |branch| law.force(&branch, overlap_m, rate_m_s).force_n.max(0.0));
        let side =
            |values: &[f64]| link.sides.each_ref().map(|side| side.as_ref().map_or(0.0, |side| side.sum(values)));
        ContactSample {
            closed: seen.branch.is_some(),
            overlap_m,
            rate_m_s,
            force_n,
            displacement_m: side(&amplitude),
            velocity_m_s: side(&rate),
        }
    }

    fn after_start(&self, time_s: f64) -> f64 {
        (time_s - self.stretch.start_s).clamp(0.0, self.stretch.length_s)
    }
}

impl Motion for Panel<'_> {
    fn start_s(&self) -> f64 {
        self.stretch.start_s
    }

    fn end_s(&self) -> f64 {
        self.stretch.start_s + self.stretch.length_s
    }

    fn modes(&self, time_s: f64) -> (Vec<f64>, Vec<f64>) {
        self.modes_after(self.after_start(time_s))
    }

    fn contact(&self, contact: usize, time_s: f64) -> ContactSample {
        self.contact_after(contact, self.after_start(time_s))
    }
}

/// Body by body, the modes as the user counts them.
pub(crate) fn in_users_order(system: &System, amplitude: &[f64], rate: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let pick = |values: &[f64]| system.place.iter().flatten().map(|place| values[*place]).collect();
    (pick(amplitude), pick(rate))
}
