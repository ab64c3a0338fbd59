//! The result of a run, and the interface of observers of a run.

use std::fmt;

/// The reason why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// The end of the requested time was reached.
    End,
    /// The energy above the static equilibrium under the loads is too small to open a contact that is closed or to close
    /// one that is open. Vibrations may continue.
    Rest,
    /// All contacts are open and none can ever close again; the run ends where the last one opened. Only if this was
    /// requested ([`Settings::stop_when_over`](super::Settings::stop_when_over)).
    Parted,
    /// The run stopped before its end; everything up to that time is valid.
    Stopped(Reason),
}

/// The reason why a run stopped before its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reason {
    /// `Settings::max_steps` were made.
    Steps,
    /// `Settings::max_intervals` were found.
    Intervals,
    /// A step would have to be too short for floating-point numbers.
    FinestStep,
    /// A compression or rate left the range in which laws compute ([`contact_models::LARGEST`]).
    LawRange,
    /// Contacts opened and closed again and again while time did not advance.
    Chatter,
    /// A contact law violates its contract ([`contact_models::check_contract`] reports which part, and where).
    Law,
    /// The observer requested it.
    Interrupted,
}

invalid_input::names!(Reason, "stopped_by", {
    Steps: "limit of steps",
    Intervals: "limit of intervals",
    FinestStep: "finest step",
    LawRange: "range of the contact law",
    Chatter: "contacts that open and close while time does not advance",
    Law: "contact law that violates its contract",
    Interrupted: "interrupted",
});

impl Outcome {
    /// The outcome as a word for tables and files.
    pub fn as_str(self) -> &'static str {
        match self {
            Outcome::End => "end",
            Outcome::Rest => "rest",
            Outcome::Parted => "parted",
            Outcome::Stopped(_) => "stopped",
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Outcome::Stopped(reason) => write!(f, "stopped: {reason}"),
            ended => f.pad(ended.as_str()),
        }
    }
}

/// One interval of contact, from touch to release as defined by the law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// First touch (s); 0 for a contact that touches at the start.
    pub start_s: f64,
    /// Release (s); `None` for a contact under way at the end.
    pub end_s: Option<f64>,
    /// Impulse of the contact force (N s).
    pub impulse_n_s: f64,
    /// Largest contact force (N).
    pub peak_force_n: f64,
    /// Largest compression (m).
    pub peak_compression_m: f64,
    /// Rate of compression at first touch (m/s); negative for surfaces that overlap at the start and separate.
    pub approach_speed_m_s: f64,
    /// Rate of opening at the release (m/s).
    pub separation_speed_m_s: Option<f64>,
}

/// Statistics of a contact from [`Run::statistics_from_s`] to the end of the run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Statistics {
    /// Intervals of contact that end in this time or are under way at its end.
    pub intervals: u64,
    /// Time in contact (s).
    pub contact_time_s: f64,
    /// Impulse (N s).
    pub impulse_n_s: f64,
    /// Largest force (N).
    pub largest_force_n: f64,
    /// `int F^2 dt` (N^2 s). Divided by the time that the statistics cover, it is the mean square of the force.
    pub squared_force_n2_s: f64,
    /// `int F xi' dt` while the compression grows (J). Divided by the time that the statistics cover, it is the contact work rate.
    pub compression_work_j: f64,
    /// `int F xi' dt` (J): the energy that the contact has received, stored or dissipated.
    pub work_j: f64,
}

/// A contact at the end of the run.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactEnd {
    /// Its statistics.
    pub statistics: Statistics,
    /// Displacement of either side (m).
    pub displacement_m: [f64; 2],
    /// Velocity of either side (m/s).
    pub velocity_m_s: [f64; 2],
    /// Force at the end (N).
    pub force_n: f64,
    /// Energy that the contact stores (J).
    pub stored_j: f64,
    /// Whether its future depends on the earlier motion, and not only on the present one: open surfaces have a permanent
    /// indentation, or the internal variables of a closed contact differ from those with which surfaces of this compression and rate
    /// begin.
    pub remembers: bool,
}

/// The energy balance. The energy of the bodies and the stored energy at the start, plus the work of the loads, equal the energy
/// of the bodies and the stored energy at the end, plus the losses and the residual. Every part is computed separately, so the
/// residual is a check of all others.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ledger {
    /// Kinetic and elastic energy of each body at the start and at the end (J).
    pub bodies_j: Vec<[f64; 2]>,
    /// Energy that closed contacts store at the start, where bodies interfere, and at the end (J).
    pub stored_j: [f64; 2],
    /// Work of the loads (J).
    pub load_work_j: f64,
    /// Energy dissipated by modal damping (J).
    pub modal_damping_j: f64,
    /// Energy dissipated in the contacts (J).
    pub contact_loss_j: f64,
    /// The residual of the balance (J).
    pub unaccounted_j: f64,
    /// How far rounding can have falsified any of the parts (J). It is far below the energies unless a harmonic load nearly
    /// meets an undamped frequency, or a sampled one changes within a small part of a slow mode's period; errors of two
    /// parts can then cancel in `unaccounted_j`.
    pub rounding_j: f64,
}

/// The cost of the computation, in deterministic counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Accepted panels with a closed contact.
    pub contact_steps: u64,
    /// Rejected panels.
    pub rejected_steps: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Evaluations of contact laws.
    pub law_evaluations: u64,
    /// Panels without a closed contact.
    pub flight_steps: u64,
    /// Transitions of contacts from one branch of their law to another, touches and releases included.
    pub events: u64,
}

impl Counts {
    /// Panels of all kinds, rejected ones included.
    pub fn steps(&self) -> u64 {
        self.contact_steps + self.rejected_steps + self.flight_steps
    }
}

impl std::ops::AddAssign for Counts {
    fn add_assign(&mut self, other: Counts) {
        self.contact_steps += other.contact_steps;
        self.rejected_steps += other.rejected_steps;
        self.newton_iterations += other.newton_iterations;
        self.law_evaluations += other.law_evaluations;
        self.flight_steps += other.flight_steps;
        self.events += other.events;
    }
}

/// The result of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The reason why it ended.
    pub outcome: Outcome,
    /// The time at which it ended (s).
    pub end_s: f64,
    /// The time from which the statistics of the contacts are taken (s); 0 if the run ended before the requested time.
    pub statistics_from_s: f64,
    /// Modal amplitudes at the end (m kg^1/2), body by body.
    pub amplitude: Vec<Vec<f64>>,
    /// Their rates (m kg^1/2 / s).
    pub rate: Vec<Vec<f64>>,
    /// The contacts.
    pub contacts: Vec<ContactEnd>,
    /// Energy, if it was requested ([`Observer::wants_energy`]).
    pub energy: Option<Ledger>,
    /// Costs.
    pub counts: Counts,
}

/// Observes a run. Every method has a default.
pub trait Observer {
    /// An interval of contact has ended, or the run has ended with the contact still closed.
    fn interval(&mut self, contact: usize, interval: &Interval) {
        let _ = (contact, interval);
    }

    /// A stretch of motion without an event has been computed, and can be evaluated anywhere.
    fn panel(&mut self, panel: &dyn Motion) {
        let _ = panel;
    }

    /// Whether [`Observer::panel`] is called. Default: no.
    fn wants_panels(&self) -> bool {
        false
    }

    /// Whether the energy balance is computed. Default: no.
    fn wants_energy(&self) -> bool {
        false
    }

    /// Whether the run should stop; called from time to time.
    fn interrupts(&mut self) -> bool {
        false
    }
}

/// An observer that does nothing.
impl Observer for () {}

/// The state of a contact at a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSample {
    /// Whether the contact is closed.
    pub closed: bool,
    /// Overlap of the surfaces (m); negative while they are apart.
    pub overlap_m: f64,
    /// Its rate (m/s).
    pub rate_m_s: f64,
    /// Contact force (N).
    pub force_n: f64,
    /// Displacement of either side (m).
    pub displacement_m: [f64; 2],
    /// Velocity of either side (m/s).
    pub velocity_m_s: [f64; 2],
}

/// A stretch of motion between two events, evaluated where it is requested.
pub trait Motion {
    /// Its beginning (s).
    fn start_s(&self) -> f64;
    /// Its end (s).
    fn end_s(&self) -> f64;
    /// Modal amplitudes and rates of all bodies, one after the other, at a time within.
    fn modes(&self, time_s: f64) -> (Vec<f64>, Vec<f64>);
    /// A contact at a time within.
    fn contact(&self, contact: usize, time_s: f64) -> ContactSample;
}
