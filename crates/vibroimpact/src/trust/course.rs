//! The forces of an impact, contact by contact, and their spectra.

use std::f64::consts::PI;

use crate::infinite::history;
use crate::model::Model;
use crate::scene::{InvalidInput, Scene};
use crate::simulate::Simulation;
use vibroimpact_sim::modal::{self, Mode};

/// Number of contacts whose force is analysed: those with the largest impulses.
const CONTACTS: usize = 8;
/// Frequency times duration beyond which the spectrum of a contact is neglected: that of a smooth force decreases as
/// `omega^(-5/2)`.
const FASTEST: f64 = 200.0;
/// Steps of Simpson's rule over the frequency, in units of the inverse duration `T`. `|F|^2` is the transform of an even function
/// that is zero beyond `T`, so that the rule with any step below `2 pi/T` errs at the upper limit alone, by less than a hundredth of
/// the part beyond.
const STEP: f64 = 3.0;

/// One contact.
pub(super) struct Pulse {
    pub duration_s: f64,
    pub impulse_n_s: f64,
    pub peak_force_n: f64,
    pub peak_compression_m: f64,
    force: Force,
}

/// The force of a contact.
enum Force {
    /// As it was computed.
    Computed(modal::Pulse),
    /// Time and force.
    Samples(Vec<[f64; 2]>),
    /// The contact is not analysed.
    Unknown,
}

/// The data of an impact for these checks.
pub(super) struct Course {
    /// The largest impulse first.
    pub pulses: Vec<Pulse>,
    /// The modes retained.
    pub modes: Vec<Mode>,
    /// From the first touch to the last separation (s); `None` if that is not known.
    pub interaction_s: Option<f64>,
    /// Whether the location moves, so that there are waves.
    pub moves: bool,
}

impl Course {
    /// The data of a simulation or, if that does not resolve the motion in time, of the contact with an immovable location.
    pub fn of(scene: &Scene, simulation: &Simulation) -> Result<Course, InvalidInput> {
        Ok(match simulation {
            Simulation::Modal(found) => {
                let mut contacts = found.summary.sub_impacts.clone();
                let first = contacts.first().map_or(0.0, |contact| contact.start_s);
                contacts.sort_by(|a, b| b.impulse_n_s.total_cmp(&a.impulse_n_s));
                let pulse = |(rank, contact): (usize, &crate::summary::Contact)| Pulse {
                    duration_s: contact.end_s - contact.start_s,
                    impulse_n_s: contact.impulse_n_s,
                    peak_force_n: contact.peak_force_n,
                    peak_compression_m: contact.peak_compression_m,
                    force: match rank < CONTACTS {
                        true => Force::Computed(found.history.pulse(contact.start_s, contact.end_s)),
                        false => Force::Unknown,
                    },
                };
                let ends = ["rebound", "no contact"].contains(&found.summary.outcome);
                Course {
                    pulses: contacts.iter().enumerate().map(pulse).collect(),
                    modes: found.impact.structure.modes[..found.impact.kept_modes()].to_vec(),
                    interaction_s: ends.then_some(found.summary.end_s - first),
                    moves: found.summary.choice.as_ref().is_none_or(|choice| choice.model != Model::Rigid),
                }
            }
            Simulation::Infinite { scale, solution } => {
                let table = history(solution, Some(scale), None);
                let column =
                    |name: &str| table.columns.iter().find(|(column, _)| column == name).map(|(_, values)| values);
                let (times, forces) = (column("time_s"), column("force_n"));
                let samples = times.into_iter().flatten().zip(forces.into_iter().flatten());
                let samples: Vec<[f64; 2]> = samples.map(|(time, force)| [*time, *force]).collect();
                let mut pulses = Vec::new();
                for (i, contact) in solution.sub_impacts.iter().enumerate() {
                    let Some(end) = contact.end else { continue };
                    let [start_s, end_s] = [contact.start, end].map(|time| scale.time_s * time);
                    let force: Vec<[f64; 2]> =
                        samples.iter().filter(|[t, _]| (start_s..=end_s).contains(t)).copied().collect();
                    let peak = |of: &dyn Fn(f64) -> f64| force.iter().map(|[_, f]| of(*f)).fold(0.0, f64::max);
                    let deepest = solution.extrema.iter().filter(|extremum| extremum.contact == i);
                    pulses.push(Pulse {
                        duration_s: end_s - start_s,
                        impulse_n_s: integral(&force, |[_, f]| f),
                        peak_force_n: peak(&|f| f),
                        peak_compression_m: scale.displacement_m * deepest.map(|e| e.compression).fold(0.0, f64::max),
                        force: Force::Samples(force),
                    });
                }
                pulses.sort_by(|a, b| b.impulse_n_s.total_cmp(&a.impulse_n_s));
                let last = solution.sub_impacts.last().and_then(|contact| contact.end);
                let interaction_s = last.map(|end| scale.time_s * end);
                Course { pulses, modes: Vec::new(), interaction_s, moves: true }
            }
            Simulation::Net(_) => {
                let wall = scene.at_a_wall()?;
                let solution = wall.solve()?;
                let pulse = |contact: &vibroimpact_sim::modal::SubImpact| Pulse {
                    duration_s: contact.end_s - contact.start_s,
                    impulse_n_s: contact.impulse_n_s,
                    peak_force_n: contact.peak_force_n,
                    peak_compression_m: contact.peak_compression_m,
                    force: Force::Unknown,
                };
                let pulses = solution.sub_impacts.iter().map(pulse).collect();
                Course { pulses, modes: Vec::new(), interaction_s: None, moves: false }
            }
        })
    }

    /// `|F|^2` of every contact at one frequency, summed.
    fn spectrum(&self, omega_rad_s: f64) -> f64 {
        self.pulses.iter().map(|pulse| pulse.spectrum(omega_rad_s)).sum()
    }

    /// Frequency of the fastest relevant mode (rad/s): the slowest modes up to it take up `share` of the energy of all modes.
    pub fn fastest_rad_s(&self, share: f64) -> Option<f64> {
        let mut energies: Vec<[f64; 2]> = self
            .modes
            .iter()
            .filter(|mode| mode.omega_rad_s > 0.0)
            .map(|mode| [mode.omega_rad_s, mode.shape.powi(2) * self.spectrum(mode.omega_rad_s)])
            .collect();
        energies.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let whole: f64 = energies.iter().map(|[_, energy]| energy).sum();
        let mut sum = 0.0;
        energies
            .iter()
            .find(|[_, energy]| {
                sum += energy;
                whole > 0.0 && sum >= share * whole
            })
            .map(|[omega, _]| *omega)
    }

    /// Share of the spectrum beyond a frequency, Eq. (1); `None` without forces.
    pub fn share_beyond(&self, omega_rad_s: f64) -> Option<f64> {
        let (mut below, mut whole) = (0.0, 0.0);
        for pulse in &self.pulses {
            let rate = pulse.duration_s.recip();
            let highest = omega_rad_s.min(FASTEST * rate);
            if !(rate.is_finite() && highest > 0.0) {
                continue;
            }
            let steps = (highest / (STEP * rate)).ceil().max(1.0) as usize;
            let h = highest / steps as f64;
            let values = pulse.spectra(0.5 * h, 2 * steps + 1);
            let part = |three: &[f64]| (three[0] + 4.0 * three[1] + three[2]) * h / 6.0;
            below += values.windows(3).step_by(2).map(part).sum::<f64>();
            whole += PI * pulse.square_n2_s();
        }
        (whole > 0.0).then(|| (1.0 - below / whole).clamp(0.0, 1.0))
    }
}

impl Pulse {
    /// `|F|^2` at the first multiples of a frequency, from zero on.
    fn spectra(&self, step_rad_s: f64, count: usize) -> Vec<f64> {
        match &self.force {
            Force::Computed(pulse) => {
                pulse.transforms_n_s(step_rad_s, count).iter().map(|[re, im]| re * re + im * im).collect()
            }
            Force::Samples(_) | Force::Unknown => (0..count).map(|i| self.spectrum(step_rad_s * i as f64)).collect(),
        }
    }

    fn spectrum(&self, omega_rad_s: f64) -> f64 {
        if omega_rad_s * self.duration_s > FASTEST {
            return 0.0;
        }
        let [re, im] = match &self.force {
            Force::Computed(pulse) => pulse.transform_n_s(omega_rad_s),
            Force::Samples(samples) => {
                let from = samples.first().map_or(0.0, |[time, _]| *time);
                let turned = |&[t, f]: &[f64; 2]| {
                    let (sin, cos) = (omega_rad_s * (t - from)).sin_cos();
                    [t, f * cos, f * sin]
                };
                let turned: Vec<[f64; 3]> = samples.iter().map(turned).collect();
                [integral(&turned, |[_, re, _]| re), integral(&turned, |[_, _, im]| im)]
            }
            Force::Unknown => [0.0; 2],
        };
        re * re + im * im
    }

    fn square_n2_s(&self) -> f64 {
        match &self.force {
            Force::Computed(pulse) => pulse.square_n2_s(),
            Force::Samples(samples) => integral(samples, |[_, f]| f * f),
            Force::Unknown => 0.0,
        }
    }
}

/// By the trapezoidal rule, which is accurate for a force that begins and ends at zero.
fn integral<const N: usize>(samples: &[[f64; N]], of: impl Fn([f64; N]) -> f64) -> f64 {
    samples.windows(2).map(|pair| 0.5 * (pair[1][0] - pair[0][0]) * (of(pair[0]) + of(pair[1]))).sum()
}
