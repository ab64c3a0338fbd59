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
/// Largest step over the frequency in the integral of `|F|^2`, in units of the inverse duration `T`. `|F|^2` is the transform of an even
/// function that is zero beyond `T`, so that equal weights with any step below `2 pi/T` err at the upper limit alone.
const STEP: f64 = 2.2;
/// The upper limit is in the middle between two frequencies. These are the weights of those beyond it, by which the weights of those
/// before it at the same distance are below one. With `theta` the step times `tau`, the integral of `cos(omega tau)` then has the error
/// `theta (1/(2 sin(theta/2)) - 1/theta - 2 sum_k w_k sin((k + 1/2) theta))` relative to `sin(omega tau)/tau`. It is at most 0.0013 times
/// `(tau/T)^4` and 1e-6, by weights that make the factor smallest, and the integral errs by less than a hundredth of the part beyond.
const BEYOND: [f64; 4] = [0.059541, -0.008198, 0.00165, -0.000219];

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

    /// Frequency of the fastest relevant mode (rad/s): the slowest modes up to it take up `share` of the energy of all modes.
    pub fn fastest_rad_s(&self, share: f64) -> Option<f64> {
        let mut modes: Vec<&Mode> = self.modes.iter().filter(|mode| mode.omega_rad_s > 0.0).collect();
        modes.sort_by(|a, b| a.omega_rad_s.total_cmp(&b.omega_rad_s));
        let omegas: Vec<f64> = modes.iter().map(|mode| mode.omega_rad_s).collect();
        let mut energies = vec![0.0; modes.len()];
        for pulse in &self.pulses {
            let relevant = omegas.partition_point(|omega| omega * pulse.duration_s <= FASTEST);
            for ((energy, mode), square) in energies.iter_mut().zip(&modes).zip(pulse.spectrum(&omegas[..relevant])) {
                *energy += mode.shape.powi(2) * square;
            }
        }
        let whole: f64 = energies.iter().sum();
        let mut sum = 0.0;
        let fastest = energies.iter().position(|energy| {
            sum += energy;
            whole > 0.0 && sum >= share * whole
        });
        fastest.map(|k| omegas[k])
    }

    /// Share of the spectrum beyond a frequency, Eq. (1); `None` without forces.
    pub fn share_beyond(&self, omega_rad_s: f64) -> Option<f64> {
        let (mut below, mut whole) = (0.0, 0.0);
        for pulse in &self.pulses {
            let rate = pulse.duration_s.recip();
            let highest = omega_rad_s.min(FASTEST * rate);
            if !(rate.is_finite() && highest > 0.0) || matches!(pulse.force, Force::Unknown) {
                continue;
            }
            let inside = (highest / (STEP * rate) + 0.5).ceil().max(BEYOND.len() as f64) as usize;
            let step = highest / (inside as f64 - 0.5);
            let omegas: Vec<f64> = (0..inside + BEYOND.len()).map(|i| step * i as f64).collect();
            let values = pulse.spectrum(&omegas);
            let equal = values[..inside].iter().sum::<f64>() - 0.5 * values[0];
            let moved = |(k, weight): (usize, &f64)| weight * (values[inside + k] - values[inside - 1 - k]);
            below += step * (equal + BEYOND.iter().enumerate().map(moved).sum::<f64>());
            whole += PI * pulse.square_n2_s();
        }
        (whole > 0.0).then(|| (1.0 - below / whole).clamp(0.0, 1.0))
    }
}

impl Pulse {
    /// `|F|^2` at some frequencies.
    fn spectrum(&self, omegas_rad_s: &[f64]) -> Vec<f64> {
        let transforms = match &self.force {
            Force::Computed(pulse) => pulse.transforms_n_s(omegas_rad_s),
            Force::Samples(samples) => omegas_rad_s.iter().map(|omega| transform(samples, *omega)).collect(),
            Force::Unknown => Vec::new(),
        };
        transforms.iter().map(|[re, im]| re * re + im * im).collect()
    }

    fn square_n2_s(&self) -> f64 {
        match &self.force {
            Force::Computed(pulse) => pulse.square_n2_s(),
            Force::Samples(samples) => integral(samples, |[_, f]| f * f),
            Force::Unknown => 0.0,
        }
    }
}

/// The transform of samples of time and force.
fn transform(samples: &[[f64; 2]], omega_rad_s: f64) -> [f64; 2] {
    let from = samples.first().map_or(0.0, |[time, _]| *time);
    let turned = |&[t, f]: &[f64; 2]| {
        let (sin, cos) = (omega_rad_s * (t - from)).sin_cos();
        [t, f * cos, f * sin]
    };
    let turned: Vec<[f64; 3]> = samples.iter().map(turned).collect();
    [integral(&turned, |[_, re, _]| re), integral(&turned, |[_, _, im]| im)]
}

/// By the trapezoidal rule, which is accurate for a force that begins and ends at zero.
fn integral<const N: usize>(samples: &[[f64; N]], of: impl Fn([f64; N]) -> f64) -> f64 {
    samples.windows(2).map(|pair| 0.5 * (pair[1][0] - pair[0][0]) * (of(pair[0]) + of(pair[1]))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact_models::{ContactLaw, Hertz, KelvinVoigt};
    use vibroimpact_sim::modal::{Settings, Solver, Striker, Structure};

    #[test]
    fn the_weights_integrate_all_waves_of_the_spectrum() {
        for i in 1..=1000 {
            let theta = STEP * f64::from(i) / 1000.0;
            let corrected = |(k, weight): (usize, &f64)| 2.0 * weight * ((k as f64 + 0.5) * theta).sin();
            let by_rule = 0.5 / (0.5 * theta).sin() - BEYOND.iter().enumerate().map(corrected).sum::<f64>();
            assert!((theta * by_rule - 1.0).abs() < 0.0013 * (theta / STEP).powi(4) + 1e-6, "{theta}");
        }
    }

    /// The share compared with Simpson's rule with small steps.
    fn compare<L: ContactLaw + Clone>(law: &L) {
        let striker = Striker { mass_kg: 1.0, speed_m_s: 1.0 };
        let solver = Solver::new(&Structure::default()).unwrap();
        let (solution, history) = solver.record(&striker, law, None, &Settings::default()).unwrap();
        let contact = &solution.sub_impacts[0];
        let duration_s = contact.end_s - contact.start_s;
        let pulse = Pulse {
            duration_s,
            impulse_n_s: contact.impulse_n_s,
            peak_force_n: contact.peak_force_n,
            peak_compression_m: contact.peak_compression_m,
            force: Force::Computed(history.pulse(contact.start_s, contact.end_s)),
        };
        let whole = PI * pulse.square_n2_s();
        let course = Course { pulses: vec![pulse], modes: Vec::new(), interaction_s: None, moves: false };
        for turned in [0.1, 1.0, 2.4, 3.0, 4.7, 8.0, 8.5, 9.0, 11.3, 20.0, 21.0, 53.0, 125.0, 198.0] {
            let limit = turned / duration_s;
            let steps = 40 * (1 + turned as usize);
            let h = limit / (2 * steps) as f64;
            let omegas: Vec<f64> = (0..=2 * steps).map(|i| h * i as f64).collect();
            let part = |three: &[f64]| (three[0] + 4.0 * three[1] + three[2]) * h / 3.0;
            let below: f64 = course.pulses[0].spectrum(&omegas).windows(3).step_by(2).map(part).sum();
            let (found, known) = (course.share_beyond(limit).unwrap(), 1.0 - below / whole);
            assert!((found - known).abs() < 0.01 * known, "{turned}: {found:e} {known:e}");
        }
    }

    #[test]
    fn the_part_beyond_is_right_within_a_hundredth_for_a_smooth_force() {
        compare(&Hertz::new(1e9).unwrap());
    }

    /// Kelvin and Voigt's force jumps when the contact begins.
    #[test]
    fn the_part_beyond_is_right_within_a_hundredth_for_a_force_that_jumps() {
        compare(&KelvinVoigt::new(1e6, 300.0).unwrap());
    }
}
