//! The state of time integration: the modes, the contacts, and the expected next event. All its steps work on this state.

use super::collocate::Newton;
use super::dense::{Event, Stretch};
use super::enclosure::{ContactForce, QuasiStatic};
use super::ledger::{Account, Moment, Sum};
use super::load::Loads;
use super::miss::Misses;
use super::problem::{Posed, Settings};
use super::responses::Responses;
use super::solution::{Counts, Observer, Reason};
use super::state::{Phase, State};
use super::system::{Span, System};
use super::tables::Tables;
use super::terminal::reach_s;
use crate::panel::dyadic::J_MIN;
use crate::panel::vector::{sum_over, vectorized};
use contact_models::{ContactLaw, Memory};

/// A panel is doubled when its error is this many times below the tolerance.
pub(super) const GROWTH: f64 = 250.0;

/// On a panel an overlap hardly grows by more than this many times what the rate at its start would add.
const FARTHER: f64 = 10.0;

/// Share of the stated tolerance that is allowed for one panel.
const STEP_SHARE: f64 = 0.25;

/// The event of a contact that an event function stands for: it crosses a boundary of its branch, or it closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Crossing {
    pub contact: usize,
    pub boundary: usize,
}

/// An event that is expected.
#[derive(Debug, Clone, Copy)]
pub(super) struct ExpectedEvent {
    pub crossing: Crossing,
    pub at_s: f64,
}

/// The motion of the first side within the first interval of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Swing {
    Falls,
    Rises,
    /// It has risen and turned down again.
    Over,
}

/// The motion during time integration. Its methods are in several files, each of which uses only those above it.
pub(crate) struct March<'a> {
    pub(super) laws: &'a [&'a dyn ContactLaw],
    pub(super) posed: &'a Posed<'a>,
    pub(super) system: &'a System,
    pub(super) tables: &'a Tables,
    pub(super) responses: &'a mut Responses,
    pub(super) loads: Loads,
    pub(super) settings: Settings,
    pub(super) observer: &'a mut dyn Observer,
    pub(super) time_s: f64,
    /// The modal state relative to the steady motion, see [`super::load`].
    pub(super) amplitude: Vec<f64>,
    pub(super) rate: Vec<f64>,
    pub(super) states: Vec<State>,
    pub(super) counts: Counts,
    /// The energy balance, if it is requested.
    pub(super) account: Option<Account>,
    /// Work on the contacts (J), if the balance or the whole motion is requested.
    pub(super) contact_work_j: Sum,
    /// All stretches of the motion, if they are requested, and the events since the last one.
    pub(super) record: Option<Vec<Stretch>>,
    pub(super) pending: Vec<(usize, Event)>,
    /// The search for near misses along a recorded motion, if it is requested.
    pub(super) misses: Option<Misses>,
    /// Time, amplitudes and rates when the last contact opened, if the run may end there.
    pub(super) departure: (f64, Vec<f64>, Vec<f64>),
    /// Time at which the present flight ends the run, if no contact closes before (s); infinite if it does not.
    pub(super) turns_at_s: f64,
    /// Estimated time from there to the next touch (s).
    pub(super) until_touch_s: f64,
    /// The motion of the first side, in a run that waits for a flight of some height.
    pub(super) swing: Swing,
    /// In such a run, the greatest displacement to which a flight would rise if no contact closed (m).
    pub(super) highest: f64,
    /// Memory for the enclosures, and for Newton's method.
    pub(super) contact_forces: Vec<ContactForce<'a>>,
    pub(super) quasi_static: QuasiStatic,
    pub(super) newton: Newton,
    /// Step exponent of the next trial panel.
    pub(super) level: i32,
    pub(super) expected: Option<ExpectedEvent>,
    /// Longest terminal panel that accuracy allows, from the terminal panels on these branches so far (s).
    pub(super) longest_terminal: f64,
    /// Longest terminal panel for which the power series hold (s).
    pub(super) reach: f64,
    /// Number of accepted panels at the next check for rest.
    pub(super) ask_rest_at: u64,
    /// Number of accepted panels at which the laws are checked, once.
    pub(super) try_laws_at: u64,
    /// Whether the last panel was a step with closed contacts.
    pub(super) stepped: bool,
    /// Length of the last panel of flight (s).
    pub(super) flown: f64,
    pub(super) intervals: u64,
    /// Time from which statistics are taken (s); infinite once it has passed.
    pub(super) statistics_from_s: f64,
    pub(super) last_event_s: f64,
    pub(super) events_at_once: u64,
    pub(super) stop: Option<Reason>,
}

impl<'a> March<'a> {
    pub(super) fn new(
        posed: &'a Posed<'a>,
        system: &'a System,
        (tables, responses): (&'a Tables, &'a mut Responses),
        settings: Settings,
        observer: &'a mut dyn Observer,
    ) -> March<'a> {
        let loads = Loads::new(posed.loads, system);
        let (mut amplitude, mut rate) = (vec![0.0; system.modes.len()], vec![0.0; system.modes.len()]);
        for (body, places) in posed.bodies.iter().zip(&system.place) {
            for (k, place) in places.iter().enumerate() {
                (amplitude[*place], rate[*place]) = (body.amplitude[k], body.rate[k]);
            }
        }
        loads.shift_modes(system, 0.0, -1.0, &mut amplitude, &mut rate);
        let fastest = system.modes.iter().map(|mode| mode.omega_rad_s * (1.0 + 2.0 * mode.damping_ratio));
        let fastest = fastest.fold(loads.fastest_rad_s(), f64::max);
        let state = |gap: f64| State {
            phase: Phase::Open { memory: Memory::default(), clear_until: 0.0, bounds: None },
            boundaries: Vec::new(),
            vanishes: Vec::new(),
            overlap: 0.0,
            rate: 0.0,
            reference: -gap,
            momentum: 0.0,
            inverse_mass: 0.0,
            statistics: Default::default(),
        };
        let states = posed.gaps_m.iter().map(|gap| state(*gap)).collect();
        March {
            laws: &posed.laws,
            posed,
            system,
            tables,
            responses,
            loads,
            settings,
            observer,
            time_s: 0.0,
            amplitude,
            rate,
            states,
            counts: Counts::default(),
            account: None,
            contact_work_j: Sum::default(),
            record: None,
            pending: Vec::new(),
            misses: None,
            departure: (0.0, Vec::new(), Vec::new()),
            turns_at_s: f64::INFINITY,
            until_touch_s: f64::INFINITY,
            swing: Swing::Falls,
            highest: f64::NEG_INFINITY,
            contact_forces: Vec::new(),
            quasi_static: QuasiStatic::default(),
            newton: Newton::default(),
            level: J_MIN,
            expected: None,
            longest_terminal: f64::INFINITY,
            reach: reach_s(fastest),
            ask_rest_at: 0,
            try_laws_at: 0,
            stepped: false,
            flown: 0.0,
            intervals: 0,
            statistics_from_s: if settings.statistics_from_s > 0.0 {
                settings.statistics_from_s
            } else {
                f64::INFINITY
            },
            last_event_s: -1.0,
            events_at_once: 0,
            stop: None,
        }
    }

    /// The present relative modal state.
    pub(super) fn here(&self) -> Moment<'_> {
        let (amplitude, rate) = (&self.amplitude, &self.rate);
        Moment { system: self.system, loads: &self.loads, time_s: self.time_s, amplitude, rate }
    }

    /// Energy that the closed contacts store (J).
    pub(super) fn stored_j(&self) -> f64 {
        let of = |(state, law): (&State, &&dyn ContactLaw)| {
            state.closed_contact().map_or(0.0, |contact| law.stored_energy_j(&contact.branch, state.overlap))
        };
        self.states.iter().zip(self.laws).map(of).sum()
    }

    pub(super) fn moment(&self) -> (f64, &[f64], &[f64]) {
        (self.time_s, &self.amplitude, &self.rate)
    }

    /// Time until the loads change, statistics begin, a side turns round with which the run ends, or the run ends anyway (s).
    pub(super) fn lasting(&self) -> f64 {
        (self.next_stop_s() - self.time_s).max(0.0)
    }

    fn next_stop_s(&self) -> f64 {
        self.settings.end_s.min(self.loads.next_break_s()).min(self.statistics_from_s).min(self.turns_at_s)
    }

    pub(super) fn law(&self, c: usize) -> &'a dyn ContactLaw {
        self.laws[c]
    }

    pub(super) fn force_at(&mut self, c: usize, (compression, rate): (f64, f64)) -> f64 {
        self.counts.law_evaluations += 1;
        let law = self.law(c);
        self.states[c].closed_contact().map_or(0.0, |contact| law.force(&contact.branch, compression, rate).force_n)
    }

    /// Overlap of a contact and its rate, from modes and loads.
    pub(super) fn overlap_of_modes(&self, c: usize) -> (f64, f64) {
        let link = &self.system.links[c];
        let (shift, shift_rate) = self.loads.overlap(c, self.time_s);
        (self.states[c].reference + (link.sum(&self.amplitude) + shift), link.sum(&self.rate) + shift_rate)
    }

    /// For each body of a contact, the sums over its modes of some terms in their weight, frequency, amplitude and rate.
    #[inline(always)]
    pub(super) fn sums<const N: usize>(
        &self,
        c: usize,
        terms: impl Fn([f64; 4]) -> [f64; N],
    ) -> impl Iterator<Item = [f64; N]> {
        self.system.links[c].spans.iter().map(
            #[inline(always)]
            move |Span { modes, psi }| {
                let [omega, a, b] = [&self.system.omega, &self.amplitude, &self.rate].map(|row| &row[modes.clone()]);
                vectorized(
                    #[inline(always)]
                    || sum_over([psi, omega, a, b], &terms),
                )
            },
        )
    }

    /// Allowed error of the impulse on a panel (N s): a part of the exchanged momentum, but at most the impulse that would give the
    /// modes, even light ones, this part of the contact's energy.
    pub(super) fn impulse_tolerance(&self, c: usize) -> f64 {
        let (state, tolerance) = (&self.states[c], self.settings.tolerance);
        let share = STEP_SHARE * tolerance * state.momentum;
        let energy = tolerance * state.momentum * state.speed_m_s();
        share.min((energy / self.system.links[c].mobility).sqrt()).max(f64::MIN_POSITIVE)
    }

    /// Error of the impulse on a panel of `h` relative to the allowed one, for an error of the force and the overlap and its rate at
    /// the end. What the rounding of the rate changes in the force of a dashpot is omitted, because no shorter panel reduces it. The
    /// dashpot is taken no farther than the present rate reaches, so that an absurd end does not excuse itself.
    pub(super) fn error(&self, c: usize, force_n: f64, h: f64, (overlap, rate): (f64, f64)) -> f64 {
        let tolerance = self.impulse_tolerance(c);
        let error = force_n * h / tolerance;
        match self.states[c].closed_contact() {
            Some(contact) if contact.force_by_rate && error * GROWTH >= 1.0 => {
                let reached = self.states[c].overlap + FARTHER * h * self.states[c].rate.abs();
                let drag = self.law(c).force(&contact.branch, overlap.min(reached), rate).per_rate_n_s_m.abs();
                (force_n - drag * self.rate_rounding_on_panel(c)).max(0.0) * h / tolerance
            }
            _ => error,
        }
    }

    pub(super) fn clear_until(&self, c: usize) -> f64 {
        match self.states[c].phase {
            Phase::Open { clear_until, .. } => clear_until,
            Phase::Closed(_) => f64::INFINITY,
        }
    }

    /// Whether a closed contact acts on a body of this one.
    pub(super) fn is_disturbed(&self, c: usize) -> bool {
        self.system.neighbours[c].iter().any(|&other| self.states[other].is_closed())
    }

    pub(super) fn refine(&mut self, level: i32) {
        self.counts.rejected_steps += 1;
        self.level = level;
    }

    /// Continues with steps of at most half this length.
    pub(super) fn refine_within(&mut self, length: f64) {
        self.refine(self.level.max(self.tables.steps.level_within(length)) + 1);
    }

    /// Begins the statistics of all contacts anew.
    pub(super) fn begin_statistics(&mut self) {
        self.statistics_from_s = f64::INFINITY;
        self.states.iter_mut().zip(self.laws).for_each(|(state, law)| state.begin_statistics(*law));
    }

    /// Discards what was predicted of the motion: the next event, the length of a terminal panel before it, and how long contacts stay
    /// open.
    pub(super) fn discard_predictions(&mut self) {
        self.expected = None;
        self.longest_terminal = f64::INFINITY;
        for state in &mut self.states {
            if let Phase::Open { clear_until, bounds, .. } = &mut state.phase {
                *clear_until = clear_until.min(self.time_s);
                *bounds = None;
            }
        }
    }

    /// Advances the time, with the effect of the loads on the rigid modes.
    pub(super) fn pass(&mut self, h: f64) {
        self.loads.push_rigid(self.time_s, h, &mut self.amplitude, &mut self.rate);
        self.time_s += h;
        self.stepped = false;
    }

    /// The end of the run, the start of the statistics and the breaks of loads are reached exactly.
    pub(super) fn arrive_exactly(&mut self) {
        let target = self.next_stop_s();
        if target.is_finite() && (self.time_s - target).abs() <= 1e-12 * target {
            self.time_s = target;
        }
    }
}
