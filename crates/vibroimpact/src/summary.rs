//! The result of a scene for files and text.

use crate::impact::Impact;
use crate::model::{Answer, Choice, Model, Uncertainty};
use crate::stop_word::word;
use serde::Serialize;
use vibroimpact_sim::StopReason;
use vibroimpact_sim::modal::{Counts, EnergyLedger, Mode, Outcome, Solution, SubImpact};

/// A resolved impact on a structure with modes; `simulate --json` prints a [`ResultFile`](crate::ResultFile).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// `rebound`, `no contact`, `sustained` or `stopped`.
    pub outcome: &'static str,
    /// The reason why it stopped before the end of the impact, as a word of [`StopReason`]; null if it did not.
    #[serde(serialize_with = "word")]
    pub stopped_by: Option<StopReason>,
    /// Net restitution, 0 in sustained contact; null where the bodies did not approach each other or the computation stopped.
    pub restitution: Option<f64>,
    /// Estimated error of the restitution: the sum of the known parts in `uncertainty`; null where that of the solver is not known.
    pub restitution_uncertainty: Option<f64>,
    /// Its parts; null where a part cannot be known, which `choice.not_known` explains.
    pub uncertainty: Uncertainty,
    /// Number of separate contacts.
    pub sub_impact_count: usize,
    /// The contacts in order of time.
    pub sub_impacts: Vec<Contact>,
    /// Why parts of the uncertainty of largest forces are not known that are known of the restitution, a sentence each that begins with
    /// the part.
    pub peak_forces_not_known: Vec<String>,
    /// Velocity of the striker at the end, positive away from the structure (m/s).
    pub striker_velocity_m_s: f64,
    /// Motion of a dropped rod at the end; null for other structures.
    pub rod: Option<RodMotion>,
    /// Height to which a falling striker rises above the undeflected structure (m); null without gravity.
    pub rise_m: Option<f64>,
    /// Time of the last separation, or at which the computation stopped (s).
    pub end_s: f64,
    /// Number of modes retained.
    pub modes: usize,
    /// Number of remainder modes that represent all others; they come last in lists of modes.
    pub remainder_modes: usize,
    /// Static compliance of the truncated modes, which the remainder modes have (m/N); 0 without them.
    pub residual_compliance_m_n: f64,
    /// The energy balance.
    pub energy: Energy,
    /// The cost of the computation.
    pub counts: Cost,
    /// The model, the reason for it, and its accuracy compared with the tolerance; null if no choice was made.
    pub choice: Option<Answer>,
}

/// Rigid-body motion of a dropped rod, without vibration.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RodMotion {
    /// Velocity of the centre of mass, positive away from the floor (m/s).
    pub centre_velocity_m_s: f64,
    /// Angular velocity, positive where the end that struck turns away from the floor (rad/s).
    pub angular_velocity_rad_s: f64,
    /// Velocity of the end that struck, from these two, positive away from the floor (m/s). Over the speed of the fall it
    /// is the restitution.
    pub end_velocity_m_s: f64,
}

impl RodMotion {
    /// From the rates of the modes, of which the first two are the rigid-body motions in the order of
    /// [`vibroimpact_sim::dropped_rod`]; `None` if there are not so many.
    pub(crate) fn new(length_m: f64, modes: &[Mode], rates: &[f64]) -> Option<RodMotion> {
        let ([translation, rotation, ..], [rate, turning, ..]) = (modes, rates) else { return None };
        // the mass-normalised rotation is sqrt(12/m) x/length about the centre, translation 1/sqrt(m); towards the
        // floor is positive there
        Some(RodMotion {
            centre_velocity_m_s: -translation.shape * rate,
            angular_velocity_rad_s: -12f64.sqrt() * translation.shape * turning / length_m,
            end_velocity_m_s: -(translation.shape * rate + rotation.shape * turning),
        })
    }
}

/// One contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Contact {
    /// First touch (s).
    pub start_s: f64,
    /// Separation (s).
    pub end_s: f64,
    /// Impulse of the contact force (N s).
    pub impulse_n_s: f64,
    /// Largest force (N).
    pub peak_force_n: f64,
    /// Estimated error of the largest force: the sum of the known parts (N); null where one is not known that is known of the
    /// restitution.
    pub peak_force_uncertainty_n: Option<f64>,
    /// Its parts (N); null where a part cannot be known, which `peak_forces_not_known` or `choice.not_known` explains.
    pub peak_force_uncertainty_parts_n: Uncertainty,
    /// Largest compression (m).
    pub peak_compression_m: f64,
}

impl Contact {
    fn new(contact: &SubImpact, peak_force: Uncertainty) -> Contact {
        let &SubImpact { start_s, end_s, impulse_n_s, peak_force_n, peak_compression_m, .. } = contact;
        Contact {
            start_s,
            end_s,
            impulse_n_s,
            peak_force_n,
            peak_force_uncertainty_n: peak_force.whole(),
            peak_force_uncertainty_parts_n: peak_force,
            peak_compression_m,
        }
    }
}

/// The energy balance (J). The residual is the initial energy minus all other parts, and consists of their rounding.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Energy {
    /// Before the impact.
    pub initial_j: f64,
    /// Final energy of the striker.
    pub striker_j: f64,
    /// Final energy of all modes of the structure together.
    pub structure_j: f64,
    /// Dissipated by modal damping until the last separation.
    pub modal_damping_j: f64,
    /// Dissipated in the contact: the work of its force over the compression. Under a law without losses this is the error of the
    /// computed force.
    pub contact_j: f64,
    /// The residual of the balance.
    pub residual_j: f64,
    /// Final energy of each mode, remainder modes last.
    pub modes_j: Vec<f64>,
    /// Whether all contacts have ended under a law without losses.
    #[serde(skip)]
    pub contact_conserves: bool,
}

impl Energy {
    /// What the contact dissipates by its law, and what the balance does not account for, as they are printed.
    pub(crate) fn loss_and_residual(&self) -> [f64; 2] {
        loss_and_residual(self.contact_j, self.residual_j, self.contact_conserves)
    }
}

/// The computed loss of contacts is an error if their laws lose nothing, and then belongs to the residual.
pub(crate) fn loss_and_residual(loss_j: f64, residual_j: f64, conserve: bool) -> [f64; 2] {
    if conserve { [0.0, residual_j + loss_j] } else { [loss_j, residual_j] }
}

/// Deterministic counts of the work for the recorded solution, without those for its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Cost {
    /// Steps accepted in contact.
    pub contact_steps: u64,
    /// Steps tried in contact and rejected.
    pub rejected_steps: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Evaluations of the contact law.
    pub law_evaluations: u64,
    /// Steps of the search for the next contact.
    pub flight_steps: u64,
}

impl Summary {
    /// Collects a result for printing.
    pub fn new(solution: &Solution, energy: EnergyLedger, impact: &Impact) -> Summary {
        let solved = |solver: Option<f64>| Uncertainty { solver, ..Uncertainty::default() };
        let contact = |contact: &SubImpact| Contact::new(contact, solved(contact.peak_force_uncertainty_n));
        let Counts { contact_steps, rejected_steps, newton_iterations, law_evaluations, flight_steps, .. } =
            solution.counts;
        Summary {
            outcome: solution.outcome.as_str(),
            stopped_by: solution.outcome.stopped_by(),
            restitution: solution.restitution,
            restitution_uncertainty: solution.restitution_uncertainty,
            uncertainty: solved(solution.restitution_uncertainty),
            sub_impact_count: solution.sub_impacts.len(),
            sub_impacts: solution.sub_impacts.iter().map(contact).collect(),
            peak_forces_not_known: Vec::new(),
            striker_velocity_m_s: solution.striker_velocity_m_s,
            rod: None,
            rise_m: rise_m(impact, solution),
            end_s: solution.end_s,
            modes: impact.kept_modes(),
            remainder_modes: impact.remainder_modes,
            residual_compliance_m_n: impact.residual_compliance_m_n(),
            energy: Energy {
                initial_j: energy.initial_j,
                striker_j: energy.striker_j,
                structure_j: energy.modes_j.iter().sum(),
                modal_damping_j: energy.modal_damping_j,
                contact_j: energy.contact_j,
                residual_j: energy.residual_j,
                modes_j: energy.modes_j,
                contact_conserves: impact.law.conserves_energy()
                    && matches!(solution.outcome, Outcome::Rebound | Outcome::NoContact),
            },
            counts: Cost { contact_steps, rejected_steps, newton_iterations, law_evaluations, flight_steps },
            choice: None,
        }
    }

    /// The same with the choice of the model, whose restitution and uncertainties are used.
    pub fn chosen(self, choice: Choice) -> Summary {
        let Choice { answer, sub_impacts, peak_forces, .. } = choice;
        let mut contacts = self.sub_impacts;
        if peak_forces.len() == contacts.len() {
            let judged = sub_impacts.iter().zip(peak_forces);
            contacts = judged.map(|(contact, peak)| Contact::new(contact, peak)).collect();
        }
        for contact in &mut contacts {
            contact.peak_force_uncertainty_n = contact.peak_force_uncertainty_parts_n.whole_beside(&answer.uncertainty);
        }
        Summary {
            restitution: answer.restitution,
            restitution_uncertainty: answer.restitution_uncertainty,
            uncertainty: answer.uncertainty,
            peak_forces_not_known: peak_forces_not_known(&answer, &contacts),
            sub_impacts: contacts,
            choice: Some(answer),
            ..self
        }
    }
}

/// Height to which a falling striker rises (m).
fn rise_m(impact: &Impact, solution: &Solution) -> Option<f64> {
    let restitution = solution.restitution.filter(|_| impact.gravity_m_s2 > 0.0)?;
    Some((restitution * impact.approach_m_s()).powi(2) / (2.0 * impact.gravity_m_s2))
}

/// Why parts of the uncertainty of largest forces are not known that are known of the restitution.
fn peak_forces_not_known(answer: &Answer, contacts: &[Contact]) -> Vec<String> {
    if answer.restitution.is_none() && !contacts.is_empty() {
        return vec!["no part: not estimated where there is no restitution".to_owned()];
    }
    let parts = answer.uncertainty.parts().into_iter().enumerate().filter(|(_, (_, part))| part.is_some());
    let of_part = |(place, (name, _)): (usize, (&str, Option<f64>))| {
        let is_unknown = |contact: &&Contact| contact.peak_force_uncertainty_parts_n.parts()[place].1.is_none();
        let unknown = contacts.iter().filter(is_unknown).count();
        let why = match (unknown, answer.model) {
            (0, _) => return None,
            (_, Model::Modal) => {
                let all = contacts.len();
                format!(
                    "not known for {unknown} of {all} sub-impacts: another impact that was solved for the estimate has none at \
                     their time, or not one alone, or all digits of the force are uncertain"
                )
            }
            (_, model) => format!("the model {} bounds the error of the restitution alone", model.as_str()),
        };
        Some(format!("{name}: {why}"))
    };
    parts.filter_map(of_part).collect()
}

/// The object that `modes --json` prints: modes from the lowest.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeTable {
    /// Natural frequencies (rad/s).
    pub omega_rad_s: Vec<f64>,
    /// The same (Hz).
    pub frequency_hz: Vec<f64>,
    /// Mass-normalised shapes at the point of impact (kg^-1/2).
    pub shape_at_location: Vec<f64>,
    /// For a plate by Ritz's method: number of frequencies, from the lowest, that have converged to
    /// [`CONVERGED_FREQUENCY`](crate::scene::CONVERGED_FREQUENCY).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub converged_modes: Option<usize>,
}

impl ModeTable {
    /// Collects modes for printing.
    pub fn new(modes: &[Mode], converged_modes: Option<usize>) -> ModeTable {
        ModeTable {
            converged_modes,
            omega_rad_s: modes.iter().map(|mode| mode.omega_rad_s).collect(),
            frequency_hz: modes.iter().map(|mode| mode.omega_rad_s / std::f64::consts::TAU).collect(),
            shape_at_location: modes.iter().map(|mode| mode.shape).collect(),
        }
    }
}
