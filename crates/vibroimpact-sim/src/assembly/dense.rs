//! Dense output: the motion anywhere on a panel.

use super::load::Loads;
use super::problem::Assembly;
use super::solution::{ContactSample, Motion};
use super::state::State;
use super::system::System;
use crate::modal::legendre::{BASIS, Nodal, evaluate};
use crate::modal::oscillator::{propagate, response};
use contact_models::ContactLaw;

/// A panel that is about to be committed.
pub(super) struct Panel<'a, L> {
    pub system: &'a System,
    pub loads: &'a Loads,
    pub laws: &'a Assembly<L>,
    /// The contacts at its start.
    pub states: &'a [State],
    pub start_s: f64,
    pub length_s: f64,
    /// What is carried of the modes at its start.
    pub amplitude: &'a [f64],
    pub rate: &'a [f64],
    /// Legendre coefficients of the forces of the closed contacts.
    pub forces: Vec<(usize, Nodal)>,
}

impl<L: ContactLaw> Panel<'_, L> {
    /// What is carried of the modes after `part` of the panel.
    fn carried(&self, part: f64) -> (Vec<f64>, Vec<f64>) {
        let h = part * self.length_s;
        let (mut amplitude, mut rate) = (self.amplitude.to_vec(), self.rate.to_vec());
        // the forces as polynomials on the part alone
        let restricted: Vec<(usize, Nodal)> = self
            .forces
            .iter()
            .map(|(c, force)| (*c, BASIS.coefficients(&BASIS.nodes.map(|s| evaluate(force, s * part)))))
            .collect();
        for (k, mode) in self.system.modes.iter().enumerate() {
            (amplitude[k], rate[k]) = propagate(mode, h).apply(amplitude[k], rate[k]);
        }
        if h > 0.0 {
            for (c, force) in &restricted {
                for span in &self.system.links[*c].spans {
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
        }
        self.loads.push_rigid(self.start_s, h, &mut amplitude, &mut rate);
        (amplitude, rate)
    }

    fn part(&self, time_s: f64) -> f64 {
        ((time_s - self.start_s) / self.length_s).clamp(0.0, 1.0)
    }
}

impl<L: ContactLaw> Motion for Panel<'_, L> {
    fn start_s(&self) -> f64 {
        self.start_s
    }

    fn end_s(&self) -> f64 {
        self.start_s + self.length_s
    }

    fn modes(&self, time_s: f64) -> (Vec<f64>, Vec<f64>) {
        let part = self.part(time_s);
        let (mut amplitude, mut rate) = self.carried(part);
        self.loads.shift_modes(self.system, self.start_s + part * self.length_s, 1.0, &mut amplitude, &mut rate);
        in_users_order(self.system, &amplitude, &rate)
    }

    fn contact(&self, contact: usize, time_s: f64) -> ContactSample {
        let part = self.part(time_s);
        let (mut amplitude, mut rate) = self.carried(part);
        self.loads.shift_modes(self.system, self.start_s + part * self.length_s, 1.0, &mut amplitude, &mut rate);
        let (link, state) = (&self.system.links[contact], &self.states[contact]);
        let overlap_m = state.reference + link.sum(&amplitude);
        let rate_m_s = link.sum(&rate);
        let law = &self.laws.contacts[contact].law;
        let force_n = state.touch().map_or(0.0, |touch| law.force(&touch.branch, overlap_m, rate_m_s).force_n);
        let side =
            |values: &[f64]| link.sides.each_ref().map(|side| side.as_ref().map_or(0.0, |side| side.sum(values)));
        ContactSample {
            closed: state.is_closed(),
            overlap_m,
            rate_m_s,
            force_n,
            displacement_m: side(&amplitude),
            velocity_m_s: side(&rate),
        }
    }
}

/// Body by body, the modes as the user counts them.
pub(super) fn in_users_order(system: &System, amplitude: &[f64], rate: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let pick = |values: &[f64]| system.place.iter().flatten().map(|place| values[*place]).collect();
    (pick(amplitude), pick(rate))
}
