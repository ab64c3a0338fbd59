//! Samples of the displacements of both sides of every contact, for their spectrum.
//!
//! Samples at equal distances represent frequencies up to half their rate. A mode that vibrates faster would appear as a slow
//! vibration that the motion does not have, and is left out.

use std::f64::consts::TAU;

use contact_models::Law;
use vibroimpact_sim::assembly::{Assembly, Motion, Point};

/// Samples of the displacements without the modes that are too fast for them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SpectrumSamples {
    /// Time between two samples (s).
    pub step_s: f64,
    /// Numbers and shapes of the modes at either side of each contact.
    sides: Vec<[Vec<(usize, f64)>; 2]>,
    /// Modes that are left out although they move a side of a contact.
    pub fast_modes: usize,
    /// Displacements (m), contact by contact and side by side.
    samples: Vec<[Vec<f64>; 2]>,
}

impl SpectrumSamples {
    pub(super) fn new(assembly: &Assembly<Law>, step_s: f64) -> SpectrumSamples {
        let mut spectrum = SpectrumSamples { step_s, ..SpectrumSamples::default() };
        let firsts = assembly.bodies.iter().scan(0, |next, body| {
            let first = *next;
            *next += body.modes.len();
            Some(first)
        });
        let firsts: Vec<usize> = firsts.collect();
        let mut fast = vec![false; assembly.bodies.iter().map(|body| body.modes.len()).sum()];
        let mut side = |point: &Point| match point {
            Point::Ground => Vec::new(),
            Point::OfBody { body, shape } => {
                let mut slow = Vec::new();
                for (k, (mode, shape)) in assembly.bodies[*body].modes.iter().zip(shape).enumerate() {
                    if mode.omega_rad_s < TAU * spectrum.highest_hz() {
                        slow.push((firsts[*body] + k, *shape));
                    } else {
                        fast[firsts[*body] + k] |= *shape != 0.0;
                    }
                }
                slow
            }
        };
        let sides = assembly.contacts.iter().map(|contact| contact.sides.each_ref().map(&mut side)).collect();
        spectrum.samples = vec![Default::default(); assembly.contacts.len()];
        spectrum.fast_modes = fast.into_iter().filter(|fast| *fast).count();
        spectrum.sides = sides;
        spectrum
    }

    /// The largest frequency that the samples represent (Hz).
    pub fn highest_hz(&self) -> f64 {
        0.5 / self.step_s
    }

    pub(super) fn add(&mut self, panel: &dyn Motion, time_s: f64) {
        let (amplitude, _) = panel.modes(time_s);
        for (sides, samples) in self.sides.iter().zip(&mut self.samples) {
            for (modes, samples) in sides.iter().zip(samples) {
                samples.push(modes.iter().map(|(k, shape)| shape * amplitude[*k]).sum());
            }
        }
    }

    /// Displacements of the first side of a contact, or of the second if the first does not move (m).
    pub fn of_contact(&self, contact: usize) -> &[f64] {
        let [first, second] = &self.samples[contact];
        if first.iter().any(|value| *value != 0.0) { first } else { second }
    }
}
