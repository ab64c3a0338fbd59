//! The record of an impact: motion and force at any time, and the energy balance.

use super::fall::Fall;
use super::problem::{Mode, Start, Striker};
use super::pulse::{self, Pulse};
use super::solution::{Outcome, Solution};
use crate::assembly::dense::{Panel, Stretch};
use crate::assembly::load::Loads;
use crate::assembly::system::System;
use crate::panel::legendre::BASIS;
use crate::panel::oscillator::propagate;
use contact_models::ContactLaw;

/// Most times of the steps of a history that are worth drawing: several for each point of a picture.
const MOST_TIMES: usize = 20_000;

/// Motion and force at one time. Displacements are positive away from the structure, towards the side from which the striker comes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time since the clock started (s).
    pub time_s: f64,
    /// Displacement of the structure at the contact (m).
    pub structure_displacement_m: f64,
    /// Its velocity (m/s).
    pub structure_velocity_m_s: f64,
    /// Displacement of the striker (m).
    pub striker_displacement_m: f64,
    /// Its velocity (m/s).
    pub striker_velocity_m_s: f64,
    /// Compression of the contact, negative when the surfaces are apart (m).
    pub compression_m: f64,
    /// Contact force (N).
    pub force_n: f64,
}

impl Sample {
    /// Where the striker's surface is (m), counted like its displacement, but from the surface of the undeformed structure: the
    /// displacement of the striker plus its distance at the start.
    pub fn striker_surface_m(&self) -> f64 {
        self.structure_displacement_m - self.compression_m
    }
}

/// The energy balance (J).
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyLedger {
    /// Energy of the striker and of the structure at the start. That of the striker is kinetic and, under gravity, potential, from the
    /// height at which it touches the undeflected structure.
    pub initial_j: f64,
    /// Energy of the striker at the end.
    pub striker_j: f64,
    /// Energy of each mode at the end, in the order of `Structure::modes`.
    pub modes_j: Vec<f64>,
    /// Lost to modal damping, from the modes' velocities.
    pub modal_damping_j: f64,
    /// Work of the contact force over the compression: dissipated, if all contacts have ended. Under a law without losses it then
    /// measures the error of the collocated force.
    pub contact_j: f64,
    /// Residual: the initial energy minus all others. It consists of their rounding.
    pub residual_j: f64,
}

/// The recorded motion of one impact. It is evaluated exactly at any time, given the contact force.
#[derive(Debug, Clone)]
pub struct History<L> {
    recorded: Recorded,
    law: L,
    end_s: f64,
    /// Time up to which the motion is known (s).
    known_until_s: f64,
    ledger: EnergyLedger,
}

/// The data of a run.
#[derive(Debug, Clone)]
pub(crate) struct Recorded {
    pub modes: Vec<Mode>,
    /// Indices of the modes that move the contact.
    pub moved: Vec<usize>,
    pub striker: Striker,
    pub start: Start,
    pub fall: Option<Fall>,
    pub system: System,
    pub loads: Loads,
    pub stretches: Vec<Stretch>,
}

impl<L: ContactLaw> History<L> {
    /// `work_and_damping_j` is the work of the contact, and the energy that the modes which move it lose to damping (J).
    pub(crate) fn new(recorded: Recorded, law: L, solution: &Solution, work_and_damping_j: [f64; 2]) -> History<L> {
        History {
            ledger: recorded.ledger(solution, work_and_damping_j),
            known_until_s: match (solution.outcome, recorded.fall) {
                (Outcome::Rebound, Some(fall)) => solution.end_s + fall.rises_for_s(solution.striker_velocity_m_s),
                (Outcome::Rebound | Outcome::NoContact, None) => f64::INFINITY,
                _ => solution.end_s,
            },
            recorded,
            law,
            end_s: solution.end_s,
        }
    }

    /// Time of the last event (s), or the time up to which a sustained contact was computed.
    pub fn duration_s(&self) -> f64 {
        self.end_s
    }

    /// Time (s) up to which the motion is known. Later times are treated as this one. It is infinite after a rebound, which is
    /// followed by free motion; under gravity, it is the time at which the rebound is highest. A sustained contact is computed at least
    /// up to [`Settings::until_s`](super::Settings).
    pub fn known_until_s(&self) -> f64 {
        self.known_until_s
    }

    /// Times worth drawing between 0 and `until_s`: `count` equal intervals, and every step made in contact. If the steps have more
    /// than 20,000 times in all, as under a strong dashpot, they are divided into groups of neighbours, of each of which only the times of
    /// the smallest and of the largest force are given.
    pub fn times(&self, until_s: f64, count: usize) -> Vec<f64> {
        let mut steps: Vec<(f64, f64)> = Vec::new();
        for Stretch { start_s, length_s, forces, .. } in &self.recorded.stretches {
            steps.push((*start_s, forces.first().map_or(0.0, |acting| acting.force.at(0.0))));
            if let Some(acting) = forces.first() {
                let nodes = BASIS.nodes.into_iter().zip(acting.force.at_each(&BASIS.nodes));
                steps.extend(nodes.map(|(place, force_n)| (start_s + place * length_s, force_n)));
            }
        }
        steps.retain(|(time_s, _)| (0.0..=until_s).contains(time_s));
        if steps.len() > MOST_TIMES {
            steps = extremes(&steps);
        }
        let mut times: Vec<f64> = (0..=count.max(1)).map(|i| until_s * i as f64 / count.max(1) as f64).collect();
        times.extend(steps.into_iter().map(|(time_s, _)| time_s));
        times.retain(|time_s| *time_s <= until_s);
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Motion and force at `time_s` (s). Times before 0 and NaN are treated as 0, later times than
    /// [`known_until_s`](History::known_until_s) as that time. The force is that of the law at the compression and its rate, and
    /// therefore never negative.
    pub fn at(&self, time_s: f64) -> Sample {
        let laws: [&dyn ContactLaw; 1] = [&self.law];
        let (panel, h) = self.panel(time_s, &laws);
        let contact = panel.contact_after(0, h);
        Sample {
            time_s: panel.stretch.start_s + h,
            structure_displacement_m: contact.displacement_m[1],
            structure_velocity_m_s: contact.velocity_m_s[1],
            striker_displacement_m: contact.displacement_m[0],
            striker_velocity_m_s: contact.velocity_m_s[0],
            compression_m: contact.overlap_m,
            force_n: contact.force_n,
        }
    }

    /// The contact force from one time to another (s), such as those of a sub-impact, where panels begin and end.
    pub fn pulse(&self, from_s: f64, to_s: f64) -> Pulse {
        let within = |stretch: &&Stretch| (from_s..to_s).contains(&(stretch.start_s + 0.5 * stretch.length_s));
        let panels = self.recorded.stretches.iter().filter(within).flat_map(|stretch| {
            let Stretch { start_s, length_s, .. } = *stretch;
            stretch.forces.iter().map(move |acting| pulse::Panel { start_s, length_s, force: acting.force })
        });
        Pulse { from_s, panels: panels.collect() }
    }

    /// Energy of the striker at `time_s` (J), as in the [`EnergyLedger`].
    pub fn striker_energy_j(&self, time_s: f64) -> f64 {
        let Sample { striker_displacement_m, striker_velocity_m_s, .. } = self.at(time_s);
        self.recorded.striker_j(striker_displacement_m, striker_velocity_m_s)
    }

    /// Energy of each mode at `time_s` (J), in the order of `Structure::modes`.
    pub fn modal_energies_j(&self, time_s: f64) -> Vec<f64> {
        let (amplitude, rate) = self.motion(time_s);
        energies(&self.recorded.modes, &amplitude, &rate)
    }

    /// Amplitude of each mode at `time_s` (m kg^1/2), in the order of `Structure::modes`.
    pub fn amplitudes(&self, time_s: f64) -> Vec<f64> {
        self.motion(time_s).0
    }

    /// The energy balance until the last event. Every part is computed separately, so `residual_j` is an independent check.
    pub fn energy_ledger(&self) -> EnergyLedger {
        self.ledger.clone()
    }

    fn motion(&self, time_s: f64) -> (Vec<f64>, Vec<f64>) {
        let (panel, h) = self.panel(time_s, &[]);
        let (amplitude, rate) = panel.modes_after(h);
        let Recorded { modes, moved, start, .. } = &self.recorded;
        all_modes(modes, moved, start, panel.stretch.start_s + h, (&amplitude, &rate))
    }

    /// The stretch at a time, and how far the time is into it (s).
    fn panel<'p>(&'p self, time_s: f64, laws: &'p [&'p dyn ContactLaw]) -> (Panel<'p>, f64) {
        let time_s = if time_s > 0.0 { time_s.min(self.known_until_s) } else { 0.0 };
        let stretches = &self.recorded.stretches;
        let after = stretches.partition_point(|stretch| stretch.start_s <= time_s);
        let stretch = &stretches[after.saturating_sub(1)];
        let Recorded { system, loads, .. } = &self.recorded;
        (Panel { system, loads, laws, stretch }, (time_s - stretch.start_s).min(stretch.length_s))
    }
}

impl Recorded {
    /// Energy of the striker with this displacement and velocity; 0 for a stop.
    fn striker_j(&self, displacement_m: f64, velocity_m_s: f64) -> f64 {
        let mass_kg = self.striker.mass_kg;
        let kinetic_j = if mass_kg.is_finite() { 0.5 * mass_kg * velocity_m_s * velocity_m_s } else { 0.0 };
        kinetic_j + self.fall.map_or(0.0, |fall| fall.potential_j(displacement_m))
    }

    fn ledger(&self, end: &Solution, [contact_j, damping_j]: [f64; 2]) -> EnergyLedger {
        let mass_kg = self.striker.mass_kg;
        let before = energies(&self.modes, &self.start.amplitude, &self.start.rate);
        let modes_j = energies(&self.modes, &end.amplitude, &end.rate);
        let elastic = |k: &usize| !self.modes[*k].is_rigid() && self.moved.binary_search(k).is_err();
        let unmoved: f64 = (0..self.modes.len()).filter(elastic).map(|k| before[k] - modes_j[k]).sum();
        let initial_j = self.striker_j(0.0, self.striker.speed_m_s) + before.iter().sum::<f64>();
        let striker_j = self.striker_j(end.striker_displacement_m, end.striker_velocity_m_s);
        let modal_damping_j = damping_j + unmoved;
        // a stop that moves does work
        let impulse: f64 = end.sub_impacts.iter().map(|contact| contact.impulse_n_s).sum();
        let work_of_stop = if mass_kg.is_finite() { 0.0 } else { self.striker.speed_m_s * impulse };
        let residual_j =
            initial_j + work_of_stop - striker_j - modes_j.iter().sum::<f64>() - modal_damping_j - contact_j;
        EnergyLedger { initial_j, striker_j, modes_j, modal_damping_j, contact_j, residual_j }
    }
}

/// Of these times and forces, by ascending time, the smallest and the largest force of each group of neighbours, in groups of one size
/// that leave at most [`MOST_TIMES`]. As steps follow the force, short contacts keep their shape.
fn extremes(steps: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let by_force = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
    let groups = steps.chunks(steps.len().div_ceil(MOST_TIMES / 2));
    let pairs = groups.flat_map(|group| [group.iter().min_by(by_force), group.iter().max_by(by_force)]);
    pairs.flatten().copied().collect()
}

fn energies(modes: &[Mode], amplitude: &[f64], rate: &[f64]) -> Vec<f64> {
    let energy = |(k, mode): (usize, &Mode)| 0.5 * (rate[k].powi(2) + (mode.omega_rad_s * amplitude[k]).powi(2));
    modes.iter().enumerate().map(energy).collect()
}

/// All modes of a structure at a time. Those that the contact moves have this state; the others move freely.
pub(crate) fn all_modes(
    modes: &[Mode],
    moved: &[usize],
    start: &Start,
    time_s: f64,
    (amplitude, rate): (&[f64], &[f64]),
) -> (Vec<f64>, Vec<f64>) {
    let free = |(k, mode): (usize, &Mode)| propagate(&mode.of_body(), time_s).apply(start.amplitude[k], start.rate[k]);
    let mut all: Vec<(f64, f64)> = match moved.len() == modes.len() {
        true => vec![(0.0, 0.0); modes.len()],
        false => modes.iter().enumerate().map(free).collect(),
    };
    for (k, motion) in moved.iter().zip(amplitude.iter().copied().zip(rate.iter().copied())) {
        all[*k] = motion;
    }
    all.into_iter().unzip()
}
