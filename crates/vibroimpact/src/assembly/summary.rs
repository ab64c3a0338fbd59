//! The result of a scene of bodies for programs.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;
use vibroimpact_sim::assembly::{self, Outcome};

use super::compression::compression;
use super::steady::SteadyMotion;
use super::{AssemblyScene, Simulation};
use crate::export::{self, Failure};
use crate::scene::versioned_tree;
use crate::trust::Check;

/// The object that a command prints with `--json` for a scene of bodies; every name contains its unit.
#[derive(Serialize)]
struct ResultFile<'a, R> {
    /// Version of the program.
    vibroimpact: &'static str,
    /// The scene that was solved: tables are written out, and `version` is that of the format.
    scene: Value,
    #[serde(flatten)]
    result: &'a R,
}

impl AssemblyScene {
    /// A result with its scene and the version of the program, as JSON text.
    pub(crate) fn with_result(&self, result: &impl Serialize) -> Result<String, Failure> {
        let vibroimpact = env!("CARGO_PKG_VERSION");
        export::json(&ResultFile { vibroimpact, scene: versioned_tree(self), result })
    }
}

/// The result of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// `end`, `rest` or `stopped`.
    pub outcome: &'static str,
    /// The reason why it stopped; null if it did not.
    pub reason: Option<&'static str>,
    /// The time at which it ended (s).
    pub end_s: f64,
    /// Start of the time that the statistics of the contacts cover (s). It is that of the scene, or 0 if the run stopped before.
    pub statistics_from_s: f64,
    /// Time up to which touches and releases are certain to the tolerance (s), from a second run with a thousandth of the
    /// tolerance; along a chaotic motion only statistics are meaningful after it. Null if it was not computed.
    pub reliable_until_s: Option<f64>,
    /// The periodic motion under a harmonic load to which it has converged at the end; null if there is none.
    pub steady_motion: Option<SteadyMotion>,
    /// The contacts by their names.
    pub contacts: BTreeMap<String, Statistics>,
    /// Either side of each contact at the end.
    pub points: Vec<Point>,
    /// The energy balance; null if it was not computed.
    pub energy: Option<Energy>,
    /// Whether the surfaces overlap so far that the contact laws do not describe them, if a thickness is known.
    pub trust: Vec<Check>,
    /// The cost of the computation.
    pub counts: Cost,
}

/// The results of a contact. Intervals are listed for the whole run, statistics cover the time from `statistics_from_s` on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Statistics {
    /// Intervals of contact in order of time.
    pub intervals: Vec<Interval>,
    /// Number of intervals that are not listed.
    pub intervals_left_out: u64,
    /// Number of intervals that end in this time or are under way at its end.
    pub count: u64,
    /// Share of the time in contact.
    pub time_share: f64,
    /// Impulse (N s).
    pub impulse_n_s: f64,
    /// Largest force (N).
    pub largest_force_n: f64,
    /// Root mean square of the force over this time (N).
    pub rms_force_n: f64,
    /// Work of the force while the compression grows, over this time (W).
    pub contact_work_rate_w: f64,
}

/// One interval of contact, from touch to release as defined by the law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Interval {
    /// First touch (s).
    pub start_s: f64,
    /// Release (s); null if the contact was closed at the end.
    pub end_s: Option<f64>,
    /// Impulse (N s).
    pub impulse_n_s: f64,
    /// Largest force (N).
    pub peak_force_n: f64,
    /// Largest compression (m).
    pub peak_compression_m: f64,
    /// Rate of compression at the touch (m/s).
    pub approach_speed_m_s: f64,
    /// Rate of opening at the release (m/s); null if the contact was closed at the end.
    pub separation_speed_m_s: Option<f64>,
}

/// A side of a contact at the end.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Point {
    /// Name of the contact.
    pub contact: String,
    /// 0 for the first of `between`, 1 for the second.
    pub side: usize,
    /// Displacement (m).
    pub displacement_m: f64,
    /// Velocity (m/s).
    pub velocity_m_s: f64,
}

/// The energy balance (J). The energy of bodies and contacts at the start plus `load_work_j` equals their energy at the end plus the
/// losses plus the residual, which consists of their rounding.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Energy {
    /// Kinetic and elastic energy of each body.
    pub bodies: BTreeMap<String, BodyEnergy>,
    /// Stored in the contacts at the start, where bodies interfere.
    pub contacts_stored_at_start_j: f64,
    /// Stored in the contacts at the end.
    pub contacts_stored_j: f64,
    /// Work of the loads.
    pub load_work_j: f64,
    /// Dissipated by modal damping.
    pub modal_damping_j: f64,
    /// Dissipated in the contacts. Under laws without losses this is the error of the computed forces.
    pub contact_loss_j: f64,
    /// The residual of the balance.
    pub residual_j: f64,
    /// How far rounding can have falsified any of the parts: far below the energies, unless a harmonic load nearly meets an
    /// undamped frequency.
    pub rounding_j: f64,
    /// Whether all contacts have laws without losses.
    #[serde(skip)]
    pub contacts_conserve: bool,
}

/// Energy of a body (J).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BodyEnergy {
    /// At the start.
    pub start_j: f64,
    /// At the end.
    pub end_j: f64,
}

/// Deterministic counts of the solver's work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Cost {
    /// Steps accepted with a closed contact.
    pub contact_steps: u64,
    /// Rejected steps.
    pub rejected_steps: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Evaluations of contact laws.
    pub law_evaluations: u64,
    /// Steps without a closed contact.
    pub flight_steps: u64,
    /// Transitions of contacts between the branches of their laws.
    pub events: u64,
}

impl Interval {
    pub(super) fn new(interval: &assembly::Interval) -> Interval {
        Interval {
            start_s: interval.start_s,
            end_s: interval.end_s,
            impulse_n_s: interval.impulse_n_s,
            peak_force_n: interval.peak_force_n,
            peak_compression_m: interval.peak_compression_m,
            approach_speed_m_s: interval.approach_speed_m_s,
            separation_speed_m_s: interval.separation_speed_m_s,
        }
    }
}

impl Summary {
    /// The text of `simulate --json` and of `result.json`: the result with its scene.
    ///
    /// # Errors
    /// Errors of the writer, which a run cannot cause.
    pub fn json(&self, scene: &AssemblyScene) -> Result<String, Failure> {
        scene.with_result(self)
    }

    /// The same with at most this many intervals of all contacts together, the first ones.
    pub fn listing(mut self, most: usize) -> Summary {
        let mut starts: Vec<f64> =
            self.contacts.values().flat_map(|contact| contact.intervals.iter().map(|one| one.start_s)).collect();
        if starts.len() > most {
            starts.sort_by(f64::total_cmp);
            let first_left_out = starts[most];
            for contact in self.contacts.values_mut() {
                let listed = contact.intervals.partition_point(|one| one.start_s < first_left_out);
                contact.intervals_left_out += (contact.intervals.len() - listed) as u64;
                contact.intervals.truncate(listed);
            }
        }
        self
    }

    /// Number of intervals of all contacts in the whole run.
    pub(super) fn interval_count(&self) -> u64 {
        self.contacts.values().map(|contact| contact.intervals.len() as u64 + contact.intervals_left_out).sum()
    }

    /// Collects a result for printing.
    pub fn new(found: &Simulation) -> Summary {
        let run = &found.run;
        let end_s = run.end_s;
        let covered_s = end_s - run.statistics_from_s;
        let per_time = |value: f64| if covered_s > 0.0 { value / covered_s } else { 0.0 };
        let contact = |(c, name): (usize, &String)| {
            let statistics = &run.contacts[c].statistics;
            let contact = Statistics {
                intervals: found.intervals[c].iter().map(Interval::new).collect(),
                intervals_left_out: found.left_out[c],
                count: statistics.intervals,
                time_share: per_time(statistics.contact_time_s),
                impulse_n_s: statistics.impulse_n_s,
                largest_force_n: statistics.largest_force_n,
                rms_force_n: per_time(statistics.squared_force_n2_s).sqrt(),
                contact_work_rate_w: per_time(statistics.compression_work_j),
            };
            (name.clone(), contact)
        };
        let names = &found.posed.contacts;
        let point = |(c, name): (usize, &String)| {
            let end = &run.contacts[c];
            [0, 1].map(|side| Point {
                contact: name.clone(),
                side,
                displacement_m: end.displacement_m[side],
                velocity_m_s: end.velocity_m_s[side],
            })
        };
        let counts = run.counts;
        Summary {
            outcome: run.outcome.as_str(),
            reason: match run.outcome {
                Outcome::Stopped(reason) => Some(reason.as_str()),
                _ => None,
            },
            end_s,
            statistics_from_s: run.statistics_from_s,
            reliable_until_s: found.reliable_until_s,
            steady_motion: found.steady,
            contacts: names.iter().enumerate().map(contact).collect(),
            points: names.iter().enumerate().flat_map(point).collect(),
            energy: run.energy.as_ref().map(|ledger| Energy {
                bodies: (found.posed.bodies.iter().cloned())
                    .zip(ledger.bodies_j.iter().map(|[start_j, end_j]| BodyEnergy { start_j: *start_j, end_j: *end_j }))
                    .collect(),
                contacts_stored_at_start_j: ledger.stored_j[0],
                contacts_stored_j: ledger.stored_j[1],
                load_work_j: ledger.load_work_j,
                modal_damping_j: ledger.modal_damping_j,
                contact_loss_j: ledger.contact_loss_j,
                residual_j: ledger.unaccounted_j,
                rounding_j: ledger.rounding_j,
                contacts_conserve: (found.posed.assembly.contacts.iter()).all(|contact| contact.law.conserves_energy()),
            }),
            trust: compression(found).into_iter().collect(),
            counts: Cost {
                contact_steps: counts.contact_steps,
                rejected_steps: counts.rejected_steps,
                newton_iterations: counts.newton_iterations,
                law_evaluations: counts.law_evaluations,
                flight_steps: counts.flight_steps,
                events: counts.events,
            },
        }
    }
}
