//! Solves an assembly.

use super::dense::{Stretch, in_users_order};
use super::miss::{Misses, NearMiss};
use super::motion::March;
use super::problem::{Assembly, Posed, Settings};
use super::reliability::{Comparison, second_run};
use super::responses::Responses;
use super::solution::{ContactEnd, Interval, Observer, Outcome, Run};
use super::state::Phase;
use super::system::System;
use super::tables::Tables;
use super::transition::branch_at_start;
use crate::panel::dyadic::Steps;
use contact_models::{ContactLaw, Memory};
use invalid_input::InvalidInput;
use std::fmt;
use std::sync::OnceLock;

/// Computes the motion of an assembly from its start to the requested end, and notifies the observer.
///
/// # Errors
/// If the input is invalid. The error names the field, its value and the allowed values.
///
/// ```
/// use contact_models::Hertz;
/// use vibroimpact_sim::assembly::{Assembly, Body, Contact, Force, Load, Outcome, Point, Settings, run};
///
/// // a ball of 0.1 kg dropped from 1 cm onto the ground
/// let ball = Body::mass(0.1, 0.01, 0.0);
/// let shape = vec![0.1f64.sqrt().recip()];
/// let side = Point::OfBody { body: 0, shape };
/// let contact = Contact { sides: [side, Point::Ground], gap_m: 0.0, law: Hertz::new(1e9).unwrap() };
/// let weight = Load { body: 0, shape: vec![0.1f64.sqrt()], force: Force::Constant { force_n: -9.81 } };
/// let assembly = Assembly { bodies: vec![ball], contacts: vec![contact], loads: vec![weight] };
/// let run = run(&assembly, &Settings::until(0.2), &mut ())?;
/// assert_eq!(run.outcome, Outcome::End);
/// // it falls for 45 ms and bounces once in every 90 ms
/// assert_eq!(run.contacts[0].statistics.intervals, 2);
/// # Ok::<(), vibroimpact_sim::InvalidInput>(())
/// ```
pub fn run<L: ContactLaw>(
    assembly: &Assembly<L>,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Run, InvalidInput> {
    Solver::new(assembly)?.run(settings, observer)
}

/// A solver for an assembly. It can be used repeatedly: tables are built at first use and cached.
pub struct Solver<'a> {
    pub(crate) posed: Posed<'a>,
    pub(crate) system: System,
    pub(crate) tables: Tables,
    /// With steps of which none is among those of the other tables.
    beside: OnceLock<Tables>,
}

impl fmt::Debug for Solver<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Solver").finish_non_exhaustive()
    }
}

impl<'a> Solver<'a> {
    /// A solver for an assembly, without tables so far.
    ///
    /// # Errors
    /// As [`run`].
    pub fn new<L: ContactLaw>(assembly: &'a Assembly<L>) -> Result<Solver<'a>, InvalidInput> {
        assembly.check()?;
        let posed = assembly.posed();
        let system = System::new(&posed);
        let tables = Tables::new(&system, Steps::OF_SECOND);
        Ok(Solver { posed, system, tables, beside: OnceLock::new() })
    }

    /// Tables for a run that shares no step, and therefore no error, with those in the other tables.
    pub(crate) fn beside(&self) -> &Tables {
        self.beside.get_or_init(|| Tables::new(&self.system, Steps::HALFWAY))
    }

    /// As [`run`].
    ///
    /// # Errors
    /// As [`run`].
    pub fn run(&self, settings: &Settings, observer: &mut dyn Observer) -> Result<Run, InvalidInput> {
        settings.check()?;
        Ok(follow(
            &self.posed,
            (&self.system, &self.tables, &mut Responses::default()),
            settings,
            observer,
            Keep::Result,
        )
        .0)
    }

    /// The time up to which the touches and releases of contacts are certain to the tolerance. Up to this time a second run, with
    /// a thousandth of the tolerance, finds each of them at a time that differs by less than the tolerance times the time since the
    /// start. (A tolerance below 1e-10 leaves no room for a finer run. The second run is then 32 times coarser, and so is the
    /// comparison.) Later events are known less accurately and, along a chaotic motion, only statistically. `intervals` are those
    /// of the run to be checked, contact by contact, in order; the run ended at `end_s`. `None` if `stop`, which is called from
    /// time to time, ended the second run.
    ///
    /// # Errors
    /// As [`run`].
    pub fn reliable_until(
        &self,
        settings: &Settings,
        intervals: &[Vec<Interval>],
        end_s: f64,
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<Option<f64>, InvalidInput> {
        let (tolerance, difference) = second_run(settings.tolerance);
        let second = Settings { tolerance, end_s, ..*settings };
        let mut comparison = Comparison::new(intervals, difference, end_s, stop);
        self.run(&second, &mut comparison)?;
        Ok(comparison.certain_until())
    }
}

/// What is kept of a run beside its result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Keep {
    Result,
    /// The whole motion.
    Motion,
    /// The same, with the nearest miss.
    NearestMiss,
}

/// The whole motion of a run.
#[derive(Clone, Default)]
pub(crate) struct Record {
    /// Its stretches. If the bodies have separated for good, the last one is endless; otherwise the last one has zero length.
    pub stretches: Vec<Stretch>,
    pub nearest_miss: Option<NearMiss>,
    /// Estimated time from where the side has turned round with which the run ended to its next touch; otherwise infinite (s).
    pub until_touch_s: f64,
    /// In a run that waits for a flight of some height: the greatest displacement to which a flight would rise if no contact closed (m).
    pub highest_m: f64,
    /// Work on the contacts (J), without what the balance adds for modes and harmonic loads that turn fast on a panel.
    pub contact_work_j: f64,
}

/// One run, and what is to be kept of it.
pub(crate) fn follow(
    posed: &Posed,
    (system, tables, responses): (&System, &Tables, &mut Responses),
    settings: &Settings,
    observer: &mut dyn Observer,
    keep: Keep,
) -> (Run, Record) {
    let mut march = March::new(posed, system, (tables, responses), *settings, observer);
    march.record = (keep != Keep::Result).then(Vec::new);
    march.misses = (keep == Keep::NearestMiss).then(Misses::default);
    let outcome = march.follow();
    let mut stretches = march.recorded(outcome == Outcome::Parted);
    if stretches.last().is_some_and(|last| last.length_s.is_finite()) {
        stretches.push(march.last());
    }
    let contacts: Vec<ContactEnd> = (0..march.states.len()).map(|c| contact_end(&march, c)).collect();
    let contact_work_j = march.contact_work_j.total();
    let energy = march.account.take().map(|account| account.close(&march.here(), march.stored_j(), contact_work_j));
    let (mut amplitude, mut rate) = (march.amplitude, march.rate);
    march.loads.shift_modes(march.system, march.time_s, 1.0, &mut amplitude, &mut rate);
    let (amplitude, rate) = in_users_order(march.system, &amplitude, &rate);
    let by_body = |values: &[f64]| march.system.bodies.iter().map(|body| values[body.clone()].to_vec()).collect();
    let (amplitude, rate) = (by_body(&amplitude), by_body(&rate));
    let statistics_from_s = if march.statistics_from_s.is_finite() { 0.0 } else { settings.statistics_from_s };
    let run = Run {
        outcome,
        end_s: march.time_s,
        statistics_from_s,
        amplitude,
        rate,
        contacts,
        energy,
        counts: march.counts,
    };
    let nearest_miss = march.misses.and_then(|misses| misses.nearest);
    let (until_touch_s, highest_m) = (march.until_touch_s, march.highest);
    (run, Record { stretches, nearest_miss, until_touch_s, highest_m, contact_work_j })
}

fn contact_end(march: &March, c: usize) -> ContactEnd {
    let state = &march.states[c];
    let law = march.laws[c];
    let mut end = ContactEnd {
        statistics: state.statistics,
        displacement_m: [0.0; 2],
        velocity_m_s: [0.0; 2],
        force_n: 0.0,
        stored_j: 0.0,
        remembers: match &state.phase {
            Phase::Open { memory, .. } => *memory != Memory::default(),
            Phase::Closed(contact) => branch_at_start(law, state.overlap, state.rate) != Some(contact.branch),
        },
    };
    for (i, side) in march.system.links[c].sides.iter().enumerate() {
        if let Some(side) = side {
            let (shift, shift_rate) = march.loads.side(march.system, side, march.time_s);
            end.displacement_m[i] = side.sum(&march.amplitude) + shift;
            end.velocity_m_s[i] = side.sum(&march.rate) + shift_rate;
        }
    }
    if let Some(contact) = state.closed_contact() {
        end.force_n = law.force(&contact.branch, state.overlap, state.rate).force_n;
        end.stored_j = law.stored_energy_j(&contact.branch, state.overlap);
    }
    end
}
