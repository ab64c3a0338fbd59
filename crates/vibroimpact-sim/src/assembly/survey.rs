//! What is reported of a period: the motion of both sides of every contact, and its intervals.

use super::solution::{ContactSample, Interval, Motion, Observer};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::iter;

/// Least number of moments of a period at which it is sampled, and of a period of the slowest load.
const SAMPLES: usize = 1024;
const SAMPLES_OF_CYCLE: usize = 64;
/// Bisections that locate a turning point. The error of its displacement is the square of that of its time.
const TURNING_HALVINGS: u32 = 24;

/// Motion of one side of a contact on an orbit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SideMotion {
    /// Amplitude of the displacement at the lowest frequency of the loads (m).
    pub displacement_first_harmonic_m: f64,
    /// Largest displacement (m).
    pub displacement_max_m: f64,
    /// Least displacement (m).
    pub displacement_min_m: f64,
}

/// What is reported of a period.
pub(super) struct Survey {
    period_s: f64,
    /// Equal intervals between samples, in a period of the loads and in all.
    samples_of_forcing: usize,
    samples: usize,
    next: usize,
    /// Periods of the slowest load.
    cycles: usize,
    /// Sums of the displacements times `e^{i Omega t}`, contact by contact and side by side.
    turned: Vec<[Complex64; 2]>,
    pub section_m: Vec<Vec<[f64; 2]>>,
    /// Smallest and largest displacement (m), contact by contact and side by side.
    extremes: Vec<[(f64, f64); 2]>,
    pub intervals: Vec<u64>,
}

impl Survey {
    /// Of a motion over this many periods of the loads, each of so many cycles of the slowest load.
    pub fn new(contacts: usize, (periods, cycles): (usize, usize), period_s: f64) -> Survey {
        let samples_of_forcing = SAMPLES.div_ceil(periods).max(SAMPLES_OF_CYCLE * cycles);
        Survey {
            period_s,
            samples_of_forcing,
            samples: periods * samples_of_forcing,
            next: 0,
            cycles: periods * cycles,
            turned: vec![[Complex64::ZERO; 2]; contacts],
            section_m: Vec::with_capacity(periods),
            extremes: vec![[(f64::INFINITY, f64::NEG_INFINITY); 2]; contacts],
            intervals: vec![0; contacts],
        }
    }

    fn time_s(&self, sample: usize) -> f64 {
        self.period_s * sample as f64 / self.samples as f64
    }

    pub fn sides(&self) -> Vec<[SideMotion; 2]> {
        let side = |c: usize, side: usize| {
            let (displacement_min_m, displacement_max_m) = self.extremes[c][side];
            let displacement_first_harmonic_m = 2.0 * self.turned[c][side].norm() / self.samples as f64;
            SideMotion { displacement_first_harmonic_m, displacement_max_m, displacement_min_m }
        };
        (0..self.turned.len()).map(|c| [side(c, 0), side(c, 1)]).collect()
    }

    /// Adds a sample, with the displacements of every contact.
    fn add(&mut self, sample: usize, displacements_m: Vec<[f64; 2]>) {
        let turns = (self.cycles * sample) as f64 / self.samples as f64;
        let turn = Complex64::cis(TAU * turns.fract());
        for (turned, displacement_m) in self.turned.iter_mut().zip(&displacements_m) {
            turned.iter_mut().zip(displacement_m).for_each(|(turned, displacement)| *turned += displacement * turn);
        }
        if sample.is_multiple_of(self.samples_of_forcing) {
            self.section_m.push(displacements_m);
        }
    }
}

/// Displacement (m) of one side of a contact where its velocity changes sign between two times.
fn turning_point_m(panel: &dyn Motion, (contact, side): (usize, usize), (mut start, mut end): (f64, f64)) -> f64 {
    let rises = panel.contact(contact, start).velocity_m_s[side] > 0.0;
    for _ in 0..TURNING_HALVINGS {
        let middle = 0.5 * (start + end);
        let still = (panel.contact(contact, middle).velocity_m_s[side] > 0.0) == rises;
        *(if still { &mut start } else { &mut end }) = middle;
    }
    panel.contact(contact, 0.5 * (start + end)).displacement_m[side]
}

impl Observer for Survey {
    fn interval(&mut self, contact: usize, interval: &Interval) {
        // an interval that has begun before the start is counted where it begins
        if interval.start_s > 0.0 || interval.end_s.is_none() {
            self.intervals[contact] += 1;
        }
    }

    fn panel(&mut self, panel: &dyn Motion) {
        let first = self.next;
        while self.next < self.samples && self.time_s(self.next) <= panel.end_s() {
            self.next += 1;
        }
        let within = (first..self.next).map(|sample| self.time_s(sample));
        let times: Vec<f64> = iter::once(panel.start_s()).chain(within).chain([panel.end_s()]).collect();
        let contacts: Vec<Vec<ContactSample>> =
            (0..self.turned.len()).map(|c| times.iter().map(|time| panel.contact(c, *time)).collect()).collect();
        for sample in first..self.next {
            let at = |states: &Vec<ContactSample>| states[1 + sample - first].displacement_m;
            self.add(sample, contacts.iter().map(at).collect());
        }
        for (c, states) in contacts.iter().enumerate() {
            for side in 0..2 {
                let (least, most) = &mut self.extremes[c][side];
                let mut note = |displacement_m: f64| {
                    (*least, *most) = (least.min(displacement_m), most.max(displacement_m));
                };
                states.iter().for_each(|state| note(state.displacement_m[side]));
                for (times, states) in times.windows(2).zip(states.windows(2)) {
                    if states[0].velocity_m_s[side] * states[1].velocity_m_s[side] < 0.0 {
                        note(turning_point_m(panel, (c, side), (times[0], times[1])));
                    }
                }
            }
        }
    }

    fn wants_panels(&self) -> bool {
        true
    }
}
