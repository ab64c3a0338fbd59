//! The march: try a panel, judge it, commit it.
//!
//! A trial never changes the motion. A panel is judged by three questions: is the force of every closed contact known
//! well enough, does an event function fall to zero on it, and is the panel short enough to tell. It is then committed,
//! tried again shorter, or cut at the event, which is located and handed to the law. Without closed contact there is
//! nothing to solve, and panels are as long as it is certain that none closes.

use super::collocate::{Collocated, Newton, Unknown, collocate};
use super::dense::{Event, Panel, Seen, Stretch};
use super::enclosure::{FlightBounds, Held, Pull, bend_of_loads, first_closing, first_difference, of_panel};
use super::event::{Beginning, EventFunction, Verdict};
use super::ledger::{Account, Moment};
use super::load::{Loads, Turns};
use super::problem::{Posed, Settings};
use super::rest;
use super::solution::{Counts, Interval, Observer, Outcome, Reason};
use super::state::{Phase, State, Touch};
use super::system::{Span, System};
use super::tables::Tables;
use super::terminal::{self, Landed, REACH, Window, series_of, value};
use crate::panel::dyadic::{J_MAX, J_MIN, level_within, step_s};
use crate::panel::legendre::{BASIS, Nodal, Q, TAYLOR, evaluate, evaluate_at, slopes, truncation};
use crate::panel::peak::Peak;
use crate::panel::vector::{sum_over, vectorized};
use contact_models::{After, Boundary, Branch, ContactLaw, LARGEST, Memory, check_contract};

/// Share of the stated tolerance that one panel may use up.
const STEP_SHARE: f64 = 0.1;
/// Share of that by which the nodal forces may miss the law.
const NEWTON_SHARE: f64 = 1e-2;
/// A panel is doubled when its error is this many times below the tolerance.
const GROWTH: f64 = 250.0;
/// Share of the time to an expected event that one panel may take.
const SHARE: f64 = 0.85;
/// The error of a terminal panel grows with this power of its length at least, where a force ends as `(t - end)^(3/2)`.
const LANDING: f64 = 2.5;
/// A force that the laws fixed on one length serves for others while it need not be carried on by more than this part.
const CARRIED: f64 = 0.05;
/// A polynomial through the nodes follows `t^(3/2)`, a force at first touch, to about this fraction of its size.
const SINGULAR: f64 = 1e-4;
/// The sum of all coefficients that a polynomial misses of `t^(3/2)`, in parts of the estimate of the next two, is less.
const TAIL: f64 = 10.0;
/// A flight is followed by power series once the next safe step is this many levels finer than the series reach.
const WINDOW: i32 = 2;
/// Number of successive events without progress in time that counts as chatter.
const CHATTER: u64 = 10_000;
/// Number of committed panels between two checks for rest.
const REST: u64 = 64;
/// Number of panels with contact after which the laws are checked, many times what an impact needs.
const TRY_LAWS: u64 = 5_000;
/// Number of panels between two questions to the observer whether to stop.
const ASK: u64 = 64;

/// Which event function of which contact: a boundary of its branch, or its closing.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Target {
    contact: usize,
    boundary: usize,
}

/// An event that is expected.
#[derive(Debug, Clone, Copy)]
struct Horizon {
    target: Target,
    at_s: f64,
}

/// A panel that is tried; the memory serves one trial after the other.
#[derive(Default)]
struct Trial<'a> {
    /// Closed contacts, then open ones that could close, and how many are closed.
    contacts: Vec<usize>,
    closed: usize,
    unknowns: Vec<Unknown<'a>>,
    newton: Newton,
    /// The closed contacts' forces, by nodes and by coefficients.
    solved: Vec<Collocated>,
    force: Vec<Nodal>,
    /// All contacts' overlaps at the nodes, and at the end with their rates.
    overlap: Vec<Nodal>,
    end: Vec<(f64, f64)>,
    turns: Turns,
}

pub(crate) struct March<'a> {
    pub laws: &'a [&'a dyn ContactLaw],
    posed: &'a Posed<'a>,
    pub system: &'a System,
    tables: &'a mut Tables,
    pub loads: Loads,
    settings: Settings,
    observer: &'a mut dyn Observer,
    pub time_s: f64,
    /// What is carried of the modes, see [`super::load`].
    pub amplitude: Vec<f64>,
    pub rate: Vec<f64>,
    pub states: Vec<State>,
    pub counts: Counts,
    /// The energy ledger, where it is wanted.
    pub account: Option<Account>,
    /// All stretches of the motion, where they are wanted, and the events since the last of them.
    pub record: Option<Vec<Stretch>>,
    pending: Vec<(usize, Event)>,
    /// Time, amplitudes and rates when the last contact opened, where the run may end there.
    departure: (f64, Vec<f64>, Vec<f64>),
    trial: Trial<'a>,
    held: Held,
    level: i32,
    horizon: Option<Horizon>,
    /// Longest terminal panel that accuracy allows, as far as those of these branches have shown (s).
    landing: f64,
    /// Longest terminal panel for which the series serve (s).
    reach: f64,
    /// Number of committed panels at which rest is looked for again.
    ask_rest_at: u64,
    /// Number of committed panels at which the laws are tried, once.
    try_laws_at: u64,
    /// Length of the last panel of flight (s).
    flown: f64,
    intervals: u64,
    last_event_s: f64,
    events_at_once: u64,
    stop: Option<Reason>,
}

impl<'a> March<'a> {
    pub fn new(
        posed: &'a Posed<'a>,
        system: &'a System,
        tables: &'a mut Tables,
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
            loads,
            settings,
            observer,
            time_s: 0.0,
            amplitude,
            rate,
            states,
            counts: Counts::default(),
            account: None,
            record: None,
            pending: Vec::new(),
            departure: (0.0, Vec::new(), Vec::new()),
            trial: Trial::default(),
            held: Held::default(),
            level: J_MIN,
            horizon: None,
            landing: f64::INFINITY,
            reach: if fastest > 0.0 { REACH / fastest } else { f64::INFINITY },
            ask_rest_at: REST,
            try_laws_at: TRY_LAWS,
            flown: 0.0,
            intervals: 0,
            last_event_s: -1.0,
            events_at_once: 0,
            stop: None,
        }
    }

    /// From the start to the end of the requested time.
    pub fn follow(&mut self) -> Outcome {
        self.begin();
        if self.observer.wants_energy() {
            self.account = Some(Account::open(self.posed.bodies, &self.here(), self.stored_j()));
        }
        let outcome = loop {
            if let Some(reason) = self.stop {
                break Outcome::Stopped(reason);
            }
            if self.time_s >= self.settings.end_s {
                break Outcome::End;
            }
            if self.time_s >= self.loads.next_break_s() {
                self.pass_break();
            }
            if !self.states.iter().any(State::is_closed) {
                if self.fly() {
                    break Outcome::Parted;
                }
            } else if self.looks_for_rest() && self.rests() {
                break Outcome::Rest;
            } else {
                self.contact();
            }
            self.stop = self.stop.or_else(|| self.limit());
        };
        for c in 0..self.states.len() {
            if let Some(interval) = self.states[c].finish(None) {
                self.observer.interval(c, &interval);
            }
        }
        outcome
    }

    /// Whether nothing opens or closes any more, or nothing that does matters.
    fn rests(&self) -> bool {
        let over = self.settings.stop_when_over && rest::has_faded(self, 0.1 * self.settings.tolerance);
        over || self.settings.stop_at_rest && rest::is_certain(self)
    }

    fn looks_for_rest(&mut self) -> bool {
        let now = self.counts.contact_steps >= self.ask_rest_at && self.time_s >= self.settings.rest_from_s;
        if now {
            self.ask_rest_at = self.counts.contact_steps + REST;
        }
        now
    }

    /// A straight line of the loads ends, another one begins.
    fn pass_break(&mut self) {
        let mut account = self.account.take();
        if let Some(account) = &mut account {
            account.end_piece(&self.here());
        }
        self.loads.pass_break(self.system, self.time_s, &mut self.amplitude, &mut self.rate);
        if let Some(account) = &mut account {
            account.begin_piece(&self.here());
        }
        self.account = account;
        self.forget_horizons();
    }

    /// What is carried now.
    pub fn here(&self) -> Moment<'_> {
        let (amplitude, rate) = (&self.amplitude, &self.rate);
        Moment { system: self.system, loads: &self.loads, time_s: self.time_s, amplitude, rate }
    }

    /// Energy that the closed contacts store (J).
    pub fn stored_j(&self) -> f64 {
        let of = |(state, law): (&State, &&dyn ContactLaw)| {
            state.touch().map_or(0.0, |touch| law.stored_energy_j(&touch.branch, state.overlap))
        };
        self.states.iter().zip(self.laws).map(of).sum()
    }

    /// Whether the run has to stop here. Before it stops in the middle of a contact, and once a run is long, the laws are
    /// tried: one that breaks its contract is what keeps a run from ending.
    fn limit(&mut self) -> Option<Reason> {
        let reason = self.reached_limit();
        let in_contact = matches!(reason, Some(Reason::FinestStep | Reason::LawRange | Reason::Chatter));
        let long = reason.is_none() && self.counts.contact_steps >= self.try_laws_at;
        if in_contact || long {
            self.try_laws_at = u64::MAX;
            let broken = |(state, law): (&State, &&dyn ContactLaw)| {
                state.scales().is_some_and(|(xi, speed)| check_contract(*law, xi, speed).is_err())
            };
            if self.states.iter().zip(self.laws).any(broken) {
                return Some(Reason::Law);
            }
        }
        reason
    }

    fn reached_limit(&mut self) -> Option<Reason> {
        let steps = self.counts.steps();
        if steps >= self.settings.max_steps {
            Some(Reason::Steps)
        } else if self.intervals >= self.settings.max_intervals {
            Some(Reason::Intervals)
        } else if self.level > J_MAX {
            Some(Reason::FinestStep)
        } else if self.events_at_once > CHATTER {
            Some(Reason::Chatter)
        } else if steps.is_multiple_of(ASK) && self.observer.interrupts() {
            Some(Reason::Interrupted)
        } else {
            let beyond =
                |state: &State| state.is_closed() && (state.overlap.abs() > LARGEST || state.rate.abs() > LARGEST);
            self.states.iter().any(beyond).then_some(Reason::LawRange)
        }
    }

    /// Contacts that touch at the start close at once.
    fn begin(&mut self) {
        self.depart();
        for c in 0..self.states.len() {
            let (overlap, rate) = self.overlap_of_modes(c);
            (self.states[c].overlap, self.states[c].rate) = (overlap, rate);
            self.states[c].inverse_mass = self.system.inverse_mass(c);
            self.states[c].momentum = self.momentum_of_loads(c);
        }
        // the fastest first, whose speed is the measure for those that touch without one
        let mut order: Vec<usize> = (0..self.states.len()).collect();
        order.sort_by(|&one, &other| self.states[other].rate.total_cmp(&self.states[one].rate));
        for c in order {
            let noise = self.noise(c);
            if self.states[c].overlap > noise {
                self.touch(c, self.states[c].overlap);
            } else if self.states[c].overlap >= -noise && !self.parts_from_here(c) {
                self.touch(c, 0.0);
            }
        }
    }

    /// Whether surfaces that touch begin to part.
    fn parts_from_here(&self, c: usize) -> bool {
        let reach = self.reach.min(self.settings.end_s);
        // rigid bodies alone have no time of their own
        let reach = if reach.is_finite() { reach } else { 1.0 };
        let mut series = series_of(self.system, &self.loads, c, self.moment(), reach);
        series[0] = 0.0;
        let differs = first_difference(&series, reach, (self.noise(c), self.rate_noise(c)));
        differs.is_some_and(|(_, overlap)| overlap < 0.0)
    }

    fn moment(&self) -> (f64, &[f64], &[f64]) {
        (self.time_s, &self.amplitude, &self.rate)
    }

    /// Overlap of a contact and its rate, from modes and loads.
    fn overlap_of_modes(&self, c: usize) -> (f64, f64) {
        let link = &self.system.links[c];
        let (shift, shift_rate) = self.loads.overlap(c, self.time_s);
        (self.states[c].reference + (link.sum(&self.amplitude) + shift), link.sum(&self.rate) + shift_rate)
    }

    /// Rounding of an overlap that is a difference of where bodies are (m).
    fn noise(&self, c: usize) -> f64 {
        let of = |Span { modes, psi }: &Span| {
            let [sum] = sum_over([psi, &self.amplitude[modes.clone()]], |[psi, a]| [(psi * a).abs()]);
            sum
        };
        let moved: f64 = self.system.links[c].spans.iter().map(of).sum();
        4.0 * f64::EPSILON * (moved + self.states[c].reference.abs())
    }

    /// The same of its rate (m/s).
    fn rate_noise(&self, c: usize) -> f64 {
        let of = |Span { modes, psi }: &Span| {
            let [sum] = sum_over([psi, &self.rate[modes.clone()]], |[psi, b]| [(psi * b).abs()]);
            sum
        };
        4.0 * f64::EPSILON * self.system.links[c].spans.iter().map(of).sum::<f64>()
    }

    /// Rounding of an overlap as it is summed up over a panel of `h` (m).
    fn panel_noise(&self, c: usize, h: f64) -> f64 {
        let of = |Span { modes, psi }: &Span| {
            let [omega, a, b] = [&self.system.omega, &self.amplitude, &self.rate].map(|row| &row[modes.clone()]);
            let [sum] = vectorized(
                #[inline(always)]
                || {
                    sum_over(
                        [psi, omega, a, b],
                        #[inline(always)]
                        |[psi, omega, a, b]| {
                            let turned = omega * h;
                            [psi.abs() * ((if turned < 1.0 { turned } else { 1.0 }) * a.abs() + h * b.abs())]
                        },
                    )
                },
            );
            sum
        };
        let moved: f64 = self.system.links[c].spans.iter().map(of).sum();
        let tracked = if self.states[c].is_closed() { 0.0 } else { self.noise(c) };
        // of the motion that the contact's momentum stands for no less is known
        let moved = moved.max(self.states[c].speed_m_s() * h);
        tracked + 4.0 * f64::EPSILON * (moved + self.states[c].overlap.abs())
    }

    fn law(&self, c: usize) -> &'a dyn ContactLaw {
        self.laws[c]
    }

    /// The momentum that the loads give a contact while it yields to them (N s), a scale for contacts that nothing else
    /// has closed.
    fn momentum_of_loads(&self, c: usize) -> f64 {
        let inverse = self.states[c].inverse_mass;
        let mut acceleration = self.loads.acceleration(c, 0.0).abs();
        for load in self.posed.loads {
            let span = self.system.span(load.body, &load.shape);
            let links = self.system.links[c].spans.iter().filter(|link| link.modes == span.modes);
            let drive: f64 = links.map(|link| link.psi.iter().zip(&span.psi).map(|(a, b)| a * b).sum::<f64>()).sum();
            acceleration = acceleration.max(drive.abs() * load.force.largest());
        }
        let force = acceleration / inverse;
        if !(force > 0.0 && force.is_finite()) {
            return 0.0;
        }
        let law = self.law(c);
        let branch = law.touch(&Memory::default(), 0.0);
        let (mut low, mut high) = (-30.0f64, 10.0f64);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let found = law.force(&branch, 10f64.powf(middle), 0.0).force_n;
            *(if found < force { &mut low } else { &mut high }) = middle;
        }
        (2.0 * acceleration * 10f64.powf(low)).sqrt() / inverse
    }

    /// The first contact of two surfaces that meet now, with this overlap beyond where they touch.
    fn touch(&mut self, c: usize, beyond: f64) {
        let law = self.law(c);
        let Phase::Open { memory, .. } = self.states[c].phase else { return };
        let (overlap, _) = self.overlap_of_modes(c);
        let link = &self.system.links[c];
        let mobility = link.mobility;
        // how fast the bodies approach each other, but for their vibrations; these push with their own small masses
        let vibrates: f64 =
            if link.rigid.is_empty() { 0.0 } else { link.elastic.iter().map(|(k, psi)| psi * self.rate[*k]).sum() };
        let state = &mut self.states[c];
        let inverse = state.inverse_mass;
        state.overlap = memory.touch_m + beyond;
        state.reference += state.overlap - overlap;
        if beyond == 0.0 {
            state.rate = state.rate.max(0.0);
        }
        let approach_speed_m_s = state.rate;
        let rigid = approach_speed_m_s - vibrates;
        let interval = Interval {
            start_s: self.time_s,
            end_s: None,
            impulse_n_s: 0.0,
            peak_force_n: 0.0,
            peak_compression_m: 0.0,
            approach_speed_m_s,
            separation_speed_m_s: None,
        };
        let touch = Touch {
            branch: law.touch(&memory, approach_speed_m_s.max(0.0)),
            needs_rate: false,
            residue: 0.0,
            rate_residue: 0.0,
            previous: None,
            interval,
            peak_force: Peak::NONE,
            peak_compression: Peak::NONE,
        };
        // of surfaces that overlap at the start, what their compression will push
        let stored_j = if beyond > 0.0 { law.stored_energy_j(&touch.branch, state.overlap) } else { 0.0 };
        let speed = rigid.abs().max((2.0 * stored_j * inverse).sqrt());
        let momentum =
            if inverse > 0.0 { speed / inverse + (approach_speed_m_s - rigid).abs() / mobility } else { 0.0 };
        state.phase = Phase::Closed(Box::new(touch));
        state.momentum = state.momentum.max(momentum);
        if state.momentum == 0.0 && inverse > 0.0 {
            // what it will pass on comes from the others
            let speed = self.states.iter().map(State::speed_m_s).fold(0.0, f64::max);
            self.states[c].momentum = speed / inverse;
        }
        let alone = self.states.iter().filter(|state| state.is_closed()).count() == 1;
        let branch = self.states[c].touch().map(|touch| touch.branch);
        if let Some(branch) = branch {
            self.enter(c, branch);
        }
        let first = self.first_level(c);
        self.level = if alone { first } else { self.level.max(first) };
        self.event(c, Event::Touch { overlaps: beyond > 0.0 });
    }

    fn enter(&mut self, c: usize, branch: Branch) {
        let law = self.law(c);
        if let Phase::Closed(touch) = &mut self.states[c].phase {
            touch.branch = branch;
            touch.needs_rate =
                law.depends_on_rate() || law.boundaries(&branch).iter().any(|boundary| boundary.per_rate != 0.0);
        }
        self.forget_horizons();
    }

    fn event(&mut self, c: usize, event: Event) {
        if self.record.is_some() {
            self.pending.push((c, event));
        }
        self.counts.events += 1;
        self.events_at_once = if self.time_s > self.last_event_s { 0 } else { self.events_at_once + 1 };
        self.last_event_s = self.time_s;
    }

    /// What was expected does not hold any more.
    fn forget_horizons(&mut self) {
        self.horizon = None;
        self.landing = f64::INFINITY;
        for state in &mut self.states {
            if let Phase::Open { clear_until, bounds, .. } = &mut state.phase {
                *clear_until = clear_until.min(self.time_s);
                *bounds = None;
            }
        }
    }

    /// The coarsest level on which the force, begun at first touch, is still small against the tolerance.
    fn first_level(&self, c: usize) -> i32 {
        let Some(touch) = self.states[c].touch() else { return J_MIN };
        let mut series = series_of(self.system, &self.loads, c, self.moment(), self.reach);
        series[0] = self.states[c].overlap;
        let law = self.law(c);
        let allowed = self.impulse_tolerance(c) / SINGULAR;
        let small = |j: i32| {
            let h = step_s(j);
            let [compression, rate, _] = value(&series, h.min(self.reach));
            let compression = compression + rate.max(0.0) * (h - h.min(self.reach));
            law.force(&touch.branch, compression, rate).force_n * h <= allowed
        };
        // the force at the end of a panel grows with the panel
        let (mut coarse, mut fine) = (J_MIN, J_MAX);
        while coarse < fine {
            let middle = coarse + (fine - coarse) / 2;
            if small(middle) { fine = middle } else { coarse = middle + 1 }
        }
        if self.reach.is_finite() { fine.max(level_within(4.0 * self.reach)) } else { fine }
    }

    /// Impulse that a panel may get wrong (N s): a part of the momentum exchanged, but no more than what would give the
    /// modes, light ones too, this part of the contact's energy.
    fn impulse_tolerance(&self, c: usize) -> f64 {
        let (state, tolerance) = (&self.states[c], self.settings.tolerance);
        let share = STEP_SHARE * tolerance * state.momentum;
        let energy = tolerance * state.momentum * state.speed_m_s();
        share.min((energy / self.system.links[c].mobility).sqrt()).max(f64::MIN_POSITIVE)
    }

    /// Time until the loads change or the run ends (s).
    fn lasting(&self) -> f64 {
        (self.settings.end_s.min(self.loads.next_break_s()) - self.time_s).max(0.0)
    }

    // ---- free flight ----

    /// The bodies have parted, perhaps for good: what follows is free motion.
    fn depart(&mut self) {
        if self.settings.stop_when_over {
            self.departure.0 = self.time_s;
            self.departure.1.clone_from(&self.amplitude);
            self.departure.2.clone_from(&self.rate);
        }
    }

    /// A step of free flight; `true` if there is none to make since the bodies have parted for good.
    fn fly(&mut self) -> bool {
        self.counts.flight_steps += 1;
        let lasting = self.lasting();
        let mut go = f64::INFINITY;
        for c in 0..self.states.len() {
            // what is left of a bound is less than a new one gives
            if self.clear_until(c) - self.time_s <= self.flown {
                self.renew(c, lasting);
            }
            go = go.min(self.clear_until(c) - self.time_s);
        }
        if go == f64::INFINITY && self.settings.stop_when_over && self.loads.is_empty() {
            (self.time_s, self.amplitude, self.rate) = std::mem::take(&mut self.departure);
            return true;
        }
        let near = level_within(self.reach);
        if go >= lasting {
            if lasting <= self.reach { self.coast(lasting, true) } else { self.rotate(level_within(lasting)) }
        } else if level_within(go) < near + WINDOW {
            self.rotate(level_within(go.min(lasting)));
        } else {
            let by_level = lasting > step_s(near);
            let window = if by_level { step_s(near) } else { lasting };
            let (mut first, mut clear): (Option<(usize, f64)>, f64) = (None, window);
            for c in 0..self.states.len() {
                if self.clear_until(c) >= self.time_s + window {
                    continue;
                }
                let curvature = self.bounds(c).map_or(0.0, FlightBounds::curvature)
                    + bend_of_loads(&self.loads, c, self.time_s, lasting);
                let mut series = series_of(self.system, &self.loads, c, self.moment(), window);
                series[0] = self.overlap_of_modes(c).0 - self.states[c].touch_m();
                let (time, meets) = first_closing(&series, curvature, window, (self.noise(c), self.rate_noise(c)));
                if !meets {
                    clear = clear.min(time);
                } else if first.is_none_or(|(_, earlier)| time < earlier) {
                    first = Some((c, time));
                }
            }
            match first {
                Some((c, time)) if time <= clear => {
                    self.coast(time, false);
                    let (_, rate) = self.overlap_of_modes(c);
                    self.states[c].rate = rate;
                    self.touch(c, 0.0);
                }
                _ if clear < window => self.coast(clear, false),
                _ if by_level => self.rotate(near),
                _ => self.coast(window, true),
            }
        }
        false
    }

    fn clear_until(&self, c: usize) -> f64 {
        match self.states[c].phase {
            Phase::Open { clear_until, .. } => clear_until,
            Phase::Closed(_) => f64::INFINITY,
        }
    }

    /// Bounds on the free motion of an open contact.
    fn bounds(&mut self, c: usize) -> Option<&FlightBounds> {
        let motion = (self.amplitude.as_slice(), self.rate.as_slice());
        let new = || Box::new(FlightBounds::new(self.system, c, motion));
        match &mut self.states[c].phase {
            Phase::Open { bounds, .. } => {
                if bounds.as_mut().is_some_and(|bounds| bounds.are_worn()) {
                    *bounds = None;
                }
                Some(bounds.get_or_insert_with(new))
            }
            Phase::Closed(_) => None,
        }
    }

    /// Finds out until when an open contact stays open, if its bodies meet no force.
    fn renew(&mut self, c: usize, lasting: f64) {
        let link = &self.system.links[c];
        let (shift, shift_rate) = self.loads.overlap(c, self.time_s);
        let rigid = |values: &[f64]| link.rigid.iter().map(|(k, psi)| psi * values[*k]).sum::<f64>();
        let overlap = self.states[c].reference + (rigid(&self.amplitude) + shift) - self.states[c].touch_m();
        let rate = rigid(&self.rate) + shift_rate;
        let bend = bend_of_loads(&self.loads, c, self.time_s, lasting);
        self.bounds(c);
        let motion = (self.amplitude.as_slice(), self.rate.as_slice());
        let Phase::Open { bounds: Some(bounds), .. } = &self.states[c].phase else { return };
        let until = self.time_s + bounds.safe_time(link, (overlap, rate), bend, || self.noise(c), motion);
        if let Phase::Open { clear_until, .. } = &mut self.states[c].phase {
            *clear_until = until;
        }
    }

    fn rotate(&mut self, level: i32) {
        self.flown = step_s(level);
        self.show(step_s(level), &[], &[]);
        self.tables.rotate(self.system, level, &mut self.amplitude, &mut self.rate);
        self.pass(step_s(level));
    }

    /// Free motion of any length within the series' reach; to the next break or the end where `whole`.
    fn coast(&mut self, length: f64, whole: bool) {
        self.show(length, &[], &[]);
        terminal::coast(self.system, length, &mut self.amplitude, &mut self.rate);
        self.pass(length);
        if whole {
            self.arrive_exactly();
        }
    }

    /// Time goes on, with what the loads do to the rigid modes meanwhile.
    fn pass(&mut self, h: f64) {
        self.loads.push_rigid(self.time_s, h, &mut self.amplitude, &mut self.rate);
        self.time_s += h;
    }

    /// The end of the run and the breaks of loads are met to the last digit.
    fn arrive_exactly(&mut self) {
        let target = self.settings.end_s.min(self.loads.next_break_s());
        if target.is_finite() && (self.time_s - target).abs() <= 1e-12 * target {
            self.time_s = target;
        }
    }

    // ---- contact ----

    /// A step while contacts are closed: to an event that is near, to the end, or by a panel.
    fn contact(&mut self) {
        let lasting = self.lasting();
        // a terminal panel is no better than one of about its length
        let usual = 2.0 * step_s(self.level.clamp(J_MIN + 1, J_MAX));
        let reach = self.reach.min(self.landing).min(usual);
        let mut level = self.level;
        if let Some(Horizon { target, at_s }) = self.horizon {
            let left = (at_s - self.time_s).max(0.0);
            if left <= reach {
                self.horizon = None;
                return self.land(target, left, reach.min(lasting));
            }
            level = level.max(level_within(SHARE * left));
        }
        if step_s(level) > lasting {
            if lasting <= reach {
                return self.land_at(lasting);
            }
            level = level_within(lasting);
        }
        let mut trial = std::mem::take(&mut self.trial);
        self.try_panel(level, &mut trial);
        self.trial = trial;
    }

    /// A panel with closed contacts, and what follows from it.
    fn try_panel(&mut self, level: i32, trial: &mut Trial<'a>) {
        let h = step_s(level);
        trial.closed = self.closed(&mut trial.contacts);
        if !self.attempt(level, trial) {
            return self.refine(level + 1);
        }
        let (contacts, closed) = (trial.contacts.as_slice(), trial.closed);
        let judgement = self.judge(h, contacts, closed, &trial.solved, &trial.overlap, true);
        if let Judgement::Meets(target, place) = judgement
            && place > 0.0
        {
            // where it lies is found out when it is near
            self.counts.rejected_steps += 1;
            self.horizon = Some(Horizon { target, at_s: self.time_s + place * h });
            return;
        }
        if judgement == Judgement::Doubtful {
            return self.refine(level + 1);
        }
        let mut error = 0.0f64;
        for (i, &c) in contacts[..closed].iter().enumerate() {
            let tolerance = self.impulse_tolerance(c);
            // modes that turn several times within the panel escape the coefficients, but not the law at its end
            let missed = (self.force_at(c, trial.end[i]) - evaluate(&trial.force[i], 1.0)).abs();
            error = error.max(truncation(&trial.force[i]) * h / tolerance).max(missed * h / tolerance);
        }
        if error.is_nan() || error > 1.0 {
            // the error falls at least like h^5, but for the first panels of a contact, which are begun short enough
            let finer = (error.log2() / 5.0) as i32;
            return self.refine(level + finer.clamp(1, 4));
        }
        if let Judgement::Meets(target, _) = judgement {
            self.counts.rejected_steps += 1;
            return self.transition(target);
        }
        self.commit(level, trial);
        if level == self.level && error * GROWTH < 1.0 {
            self.level = (level - 1).max(J_MIN);
        }
    }

    fn force_at(&mut self, c: usize, (compression, rate): (f64, f64)) -> f64 {
        self.counts.law_evaluations += 1;
        let law = self.law(c);
        self.states[c].touch().map_or(0.0, |touch| law.force(&touch.branch, compression, rate).force_n)
    }

    fn refine(&mut self, level: i32) {
        self.counts.rejected_steps += 1;
        self.level = level;
    }

    /// The closed contacts, whose number it returns.
    fn closed(&self, contacts: &mut Vec<usize>) -> usize {
        contacts.clear();
        contacts.extend((0..self.states.len()).filter(|&c| self.states[c].is_closed()));
        contacts.len()
    }

    /// Adds the open contacts that may close within `h` while the closed ones have these forces.
    fn watch(&mut self, h: f64, contacts: &mut Vec<usize>, closed: usize, force: &[Nodal]) {
        let lasting = self.lasting();
        for c in 0..self.states.len() {
            if self.states[c].is_closed() || contacts.contains(&c) {
                continue;
            }
            let disturbed = self.is_disturbed(c);
            if !disturbed && self.clear_until(c) <= self.time_s {
                self.renew(c, lasting);
            }
            let near = match disturbed {
                true => self.may_close(c, h, (&contacts[..closed], force)),
                false => self.clear_until(c) < self.time_s + h,
            };
            if near {
                (self.states[c].overlap, self.states[c].rate) = self.overlap_of_modes(c);
                contacts.push(c);
            }
        }
    }

    /// Whether a closed contact acts on a body of this one.
    fn is_disturbed(&self, c: usize) -> bool {
        self.system.neighbours[c].iter().any(|&other| self.states[other].is_closed())
    }

    /// Whether an open contact can come as far as to close within `h`. Free motion from `a` and `a'` takes a mode no farther
    /// than `min(omega h, 2) |a| + h |a'|`; an impulse moves the overlap by no more than `h` times what it changes its rate by.
    fn may_close(&self, c: usize, h: f64, (closed, force): (&[usize], &[Nodal])) -> bool {
        let (links, state) = (&self.system.links, &self.states[c]);
        let (mut overlap, mut reach, mut size) = (self.loads.overlap(c, self.time_s).0, 0.0, state.reference.abs());
        for Span { modes, psi } in &links[c].spans {
            let [omega, a, b] = [&self.system.omega, &self.amplitude, &self.rate].map(|row| &row[modes.clone()]);
            let [here, moved, most] = vectorized(
                #[inline(always)]
                || {
                    sum_over(
                        [psi, omega, a, b],
                        #[inline(always)]
                        |[psi, omega, a, b]| {
                            let turned = omega * h;
                            let turned = if turned < 2.0 { turned } else { 2.0 };
                            [psi * a, psi.abs() * (turned * a.abs() + h * b.abs()), (psi * a).abs()]
                        },
                    )
                },
            );
            overlap += here;
            reach += moved;
            size += most;
        }
        for (other, force) in closed.iter().zip(force).filter(|(other, _)| self.system.neighbours[c].contains(other)) {
            let impulse = h * force.iter().map(|coefficient| coefficient.abs()).sum::<f64>();
            reach += h * impulse * (links[c].mobility * links[*other].mobility).sqrt();
        }
        reach += self.loads.most_moved(c, self.time_s, h);
        // with more than rounding to spare
        state.touch_m() - (state.reference + overlap) <= reach + 1e-12 * (size + reach)
    }

    /// The closed contacts' laws and first guesses on a panel of `h`.
    fn unknowns<'s>(
        &'s self,
        contacts: &'s [usize],
        h: f64,
        free: impl Fn(usize) -> Nodal + 's,
    ) -> impl Iterator<Item = Unknown<'a>> + 's {
        let unknown = move |(i, &c): (usize, &usize)| {
            let state = &self.states[c];
            let touch = state.touch()?;
            let guess = touch.previous.map_or([0.0; Q], |(coefficients, length)| {
                evaluate_at(&coefficients, &BASIS.nodes.map(|s| 1.0 + s * h / length)).map(|force| force.max(0.0))
            });
            Some(Unknown {
                law: self.law(c),
                branch: touch.branch,
                start: state.overlap,
                free: free(i),
                needs_rate: touch.needs_rate,
                accuracy: NEWTON_SHARE * self.impulse_tolerance(c) / h,
                guess,
            })
        };
        contacts.iter().enumerate().filter_map(unknown)
    }

    /// Solves for the forces of a panel; `false` if it is too long for that.
    fn attempt(&mut self, level: i32, trial: &mut Trial<'a>) -> bool {
        let h = step_s(level);
        let Trial { contacts, closed, unknowns, newton, solved, force, overlap, end, turns } = trial;
        let closed = *closed;
        self.tables.prepare(self.system, level, contacts, contacts);
        self.loads.turn(self.time_s, h, turns);
        overlap.clear();
        overlap.extend(contacts.iter().map(|&c| self.free_at_nodes(level, c, turns)));
        unknowns.clear();
        unknowns.extend(self.unknowns(&contacts[..closed], h, |i| overlap[i]));
        let tables = &*self.tables;
        let response = |i: usize, j: usize| tables.response(level, contacts[i], contacts[j]).map(|r| &r.nodes);
        if !collocate(unknowns, response, h, (newton, solved), &mut self.counts) {
            return false;
        }
        force.clear();
        force.extend(solved.iter().map(|solved| BASIS.coefficients(&solved.force)));
        self.watch(h, contacts, closed, force);
        if contacts.len() > closed {
            self.tables.prepare(self.system, level, &contacts[closed..], &contacts[..closed]);
        }
        for &c in &contacts[closed..] {
            let start = self.states[c].overlap;
            overlap.push(self.free_at_nodes(level, c, turns).map(|moved| start + moved));
        }
        let tables = &*self.tables;
        let response = |i: usize, j: usize| tables.response(level, contacts[i], contacts[j]);
        end.clear();
        for (i, &c) in contacts.iter().enumerate() {
            let nodal = &mut overlap[i];
            let (moved, mut rate) = tables.free_at_end(level, &self.system.links[c], &self.amplitude, &self.rate);
            let (by_loads, rate_of_loads) = self.loads.moved_on(c, (self.time_s, h), turns, Q);
            let mut forced = 0.0;
            for (j, solved) in solved.iter().enumerate() {
                if let Some(response) = response(i, j) {
                    let (moved, speed) = response.at_end(&force[j]);
                    forced += moved;
                    rate += speed;
                    if i >= closed {
                        for j in 0..Q {
                            for i in 0..Q {
                                nodal[i] += response.nodes[j][i] * solved.force[j];
                            }
                        }
                    }
                }
            }
            if i < closed {
                *nodal = solved[i].compression;
            }
            end.push((self.states[c].overlap + (moved + by_loads + forced), rate + rate_of_loads));
        }
        true
    }

    /// By how much the overlap of a contact would have grown at the nodes if there were no contact force.
    fn free_at_nodes(&self, level: i32, c: usize, turns: &Turns) -> Nodal {
        let panel = (self.time_s, step_s(level));
        let moved = self.tables.free_at_nodes(level, &self.system.links[c], &self.amplitude, &self.rate);
        std::array::from_fn(|i| moved[i] + self.loads.moved_on(c, panel, turns, i).0)
    }

    /// Judges all event functions of the contacts on a panel of `h`: the first that falls to zero.
    fn judge(
        &mut self,
        h: f64,
        contacts: &[usize],
        closed: usize,
        solved: &[Collocated],
        overlap: &[Nodal],
        enclosed: bool,
    ) -> Judgement {
        let (mut first, mut doubtful): (Option<(Target, f64)>, bool) = (None, false);
        let pulls = if enclosed { self.pulls(&contacts[..closed]) } else { Vec::new() };
        for (i, &c) in contacts.iter().enumerate() {
            let state = &self.states[c];
            let mut rho = [0.0; 3];
            if enclosed {
                let missed = self.tables.missed(self.system, level_within(h));
                rho = of_panel(
                    self.system,
                    missed,
                    &self.loads,
                    c,
                    h,
                    (&self.amplitude, &self.rate),
                    (&pulls, &mut self.held),
                );
            }
            let noise = self.panel_noise(c, h);
            let mut acceleration = None;
            let (residue, rate_residue) = state.touch().map_or((0.0, 0.0), |touch| (touch.residue, touch.rate_residue));
            let mut ask = |boundary: usize, start: f64, nodal: Nodal, per: (f64, f64)| {
                let (per_overlap, per_rate) = (per.0.abs(), per.1.abs() / h);
                // interpolation of a rate magnifies rounding
                let noise = noise * (per_overlap + 50.0 * per_rate);
                let function = EventFunction {
                    start,
                    nodal,
                    rho: [0, 1, 2].map(|r| per_overlap * rho[r] + per_rate * rho.get(r + 1).copied().unwrap_or(0.0)),
                    noise,
                    residue: 2.0 * residue,
                    slope_residue: 2.0 * per_overlap * rate_residue * h,
                };
                let beginning = || {
                    let acceleration = *acceleration.get_or_insert_with(|| self.acceleration(c, &contacts[..closed]));
                    Beginning {
                        slope: (per.0 * state.rate + per.1 * acceleration) * h,
                        bend: (per.1 == 0.0).then_some(per.0 * acceleration * h * h),
                        unresolved: (per_overlap + per_rate) * h * h * self.unresolved(c, &contacts[..closed], solved),
                    }
                };
                match function.verdict(beginning) {
                    Verdict::Clear => {}
                    Verdict::Doubtful => doubtful = true,
                    Verdict::Meets(place) => {
                        if first.is_none_or(|(_, earlier)| place < earlier) {
                            first = Some((Target { contact: c, boundary }, place));
                        }
                    }
                }
            };
            match state.touch() {
                Some(touch) => {
                    let rates = if touch.needs_rate { solved[i].rate } else { [0.0; Q] };
                    for (which, boundary) in self.law(c).boundaries(&touch.branch).iter().enumerate() {
                        if *boundary == Boundary::NEVER {
                            continue;
                        }
                        let nodal = std::array::from_fn(|n| boundary.margin(overlap[i][n], rates[n]));
                        let start = boundary.margin(state.overlap, state.rate);
                        ask(which, start, nodal, (boundary.per_compression, boundary.per_rate));
                    }
                }
                None => {
                    let touch_m = state.touch_m();
                    ask(0, touch_m - state.overlap, overlap[i].map(|overlap| touch_m - overlap), (-1.0, 0.0));
                }
            }
        }
        match first {
            Some((target, place)) => Judgement::Meets(target, place),
            None if doubtful => Judgement::Doubtful,
            None => Judgement::Clear,
        }
    }

    /// Acceleration of the overlap of a contact now (m/s^2), while these are closed.
    fn acceleration(&self, c: usize, closed: &[usize]) -> f64 {
        let (system, link) = (self.system, &self.system.links[c]);
        let mut series = [0.0; TAYLOR];
        self.loads.add_series(c, self.time_s, &mut series);
        let of =
            |(k, psi): &(usize, f64)| psi * (system.drag[*k] * self.rate[*k] + system.square[*k] * self.amplitude[*k]);
        let free = 2.0 * series[2] - link.elastic.iter().map(of).sum::<f64>();
        let pull = |&other: &usize| {
            let (state, links) = (&self.states[other], &self.system.links);
            let weight: f64 = links[c].shared(&links[other]).map(|(_, weight)| weight).sum();
            let force = |touch: &Touch| self.law(other).force(&touch.branch, state.overlap, state.rate).force_n;
            weight * state.touch().map_or(0.0, force)
        };
        free - closed.iter().map(pull).sum::<f64>()
    }

    /// By how much the acceleration of the overlap of a contact is left open by what the polynomials of the closed contacts'
    /// forces miss (m/s^2).
    fn unresolved(&self, c: usize, closed: &[usize], solved: &[Collocated]) -> f64 {
        let links = &self.system.links;
        let of = |(other, solved): (&usize, &Collocated)| {
            // no product of weights is larger
            let weight = (links[c].mobility * links[*other].mobility).sqrt();
            weight * TAIL * truncation(&BASIS.coefficients(&solved.force))
        };
        let shares = |(other, _): &(&usize, &Collocated)| self.system.neighbours[c].contains(other);
        closed.iter().zip(solved).filter(shares).map(of).sum()
    }

    /// The forces of closed contacts at the start of a panel.
    fn pulls(&self, closed: &[usize]) -> Vec<Pull<'a>> {
        let pull = |c: &usize| {
            let (force, h) = self.states[*c].touch()?.previous?;
            // P_n' is n (n+1) at the end of [0, 1]
            let slope: f64 = force.iter().enumerate().map(|(n, f)| (n * (n + 1)) as f64 * f).sum();
            Some(Pull { link: &self.system.links[*c], force_n: evaluate(&force, 1.0), rate_n_s: slope / h })
        };
        closed.iter().filter_map(pull).collect()
    }

    fn commit(&mut self, level: i32, trial: &Trial) {
        let h = step_s(level);
        let (contacts, closed) = (trial.contacts.as_slice(), trial.closed);
        self.show(h, &contacts[..closed], &trial.force);
        self.tables.rotate(self.system, level, &mut self.amplitude, &mut self.rate);
        for (i, &c) in contacts[..closed].iter().enumerate() {
            let link = &self.system.links[c];
            self.tables.push(level, link, &trial.force[i], &mut self.amplitude, &mut self.rate);
        }
        self.pass(h);
        self.book(h, contacts, closed, &trial.solved, &trial.force, |i| trial.end[i]);
    }

    /// Books a panel of `h` that has been made.
    fn book(
        &mut self,
        h: f64,
        contacts: &[usize],
        closed: usize,
        solved: &[Collocated],
        force: &[Nodal],
        end: impl Fn(usize) -> (f64, f64),
    ) {
        self.counts.contact_steps += 1;
        let now = self.time_s;
        for (i, &c) in contacts.iter().enumerate() {
            let state = &mut self.states[c];
            if i < closed {
                let rate = slopes(state.overlap, &solved[i].compression, h);
                state.book(h, &solved[i].force, force[i], &solved[i].compression, &rate, end(i).0);
            }
            (state.overlap, state.rate) = end(i);
        }
        for c in 0..self.states.len() {
            let moved = contacts.contains(&c) || self.is_disturbed(c);
            if moved && let Phase::Open { clear_until, bounds, .. } = &mut self.states[c].phase {
                (*clear_until, *bounds) = (now, None);
            }
        }
        self.arrive_exactly();
    }

    // ---- terminal panels ----

    /// The closed contacts on a terminal panel, and one more where its closing ends it, with series that serve up to `reach`.
    fn window(&mut self, closing: Option<usize>, reach: f64) -> Window {
        let mut contacts = Vec::new();
        self.closed(&mut contacts);
        let overlaps: Vec<f64> = contacts.iter().map(|&c| self.states[c].overlap).collect();
        let moment = (self.time_s, self.amplitude.as_slice(), self.rate.as_slice());
        let mut window = Window::new(self.system, self.tables, &self.loads, (contacts, &overlaps, reach), moment);
        if let Some(c) = closing.filter(|&c| !self.states[c].is_closed()) {
            (self.states[c].overlap, self.states[c].rate) = self.overlap_of_modes(c);
            self.add(&mut window, c);
        }
        window
    }

    fn add(&mut self, window: &mut Window, c: usize) {
        let moment = (self.time_s, self.amplitude.as_slice(), self.rate.as_slice());
        window.add(self.system, self.tables, &self.loads, (c, self.states[c].overlap), moment);
    }

    /// Adds the open contacts that may close on a terminal panel that is solved.
    fn watch_window(&mut self, window: &mut Window, landed: &mut Landed) {
        let mut contacts = window.contacts.clone();
        self.watch(landed.length, &mut contacts, window.closed, &landed.force);
        for &c in &contacts[window.contacts.len()..] {
            self.add(window, c);
        }
        window.look(landed);
    }

    /// Goes on to the next break of the loads or the end, `length` away.
    fn land_at(&mut self, length: f64) {
        let mut window = self.window(None, length);
        let mut unknowns = self.unknowns_of(&window, length);
        let Some(mut landed) = window.attempt(length, &mut unknowns, &mut self.counts) else {
            return self.refine(self.level.max(level_within(length)) + 1);
        };
        self.watch_window(&mut window, &mut landed);
        match self.judge(length, &window.contacts, window.closed, &landed.solved, &landed.overlap, false) {
            Judgement::Meets(target, place) => self.head_for(target, place, length),
            _ if self.excess(&window, &landed) > 1.0 => self.refine(self.level.max(level_within(length)) + 1),
            _ => self.commit_landed(&window, &landed),
        }
    }

    /// The laws of a terminal panel's closed contacts; what moves freely is found for each length that is tried.
    fn unknowns_of(&self, window: &Window, length: f64) -> Vec<Unknown<'a>> {
        self.unknowns(&window.contacts[..window.closed], length, |_| [0.0; Q]).collect()
    }

    fn head_for(&mut self, target: Target, place: f64, length: f64) {
        self.counts.rejected_steps += 1;
        if place == 0.0 {
            self.transition(target);
        } else {
            self.horizon = Some(Horizon { target, at_s: self.time_s + place * length });
        }
    }

    /// By how much the forces of a terminal panel are less well known than those of a panel must be.
    fn excess(&self, window: &Window, landed: &Landed) -> f64 {
        let of = |(c, force): (&usize, &Nodal)| truncation(force) * landed.length / self.impulse_tolerance(*c);
        window.contacts.iter().zip(&landed.force).map(of).fold(0.0, f64::max)
    }

    /// Goes to the event, expected after `expected` seconds and at most `longest` away.
    fn land(&mut self, target: Target, expected: f64, longest: f64) {
        let mut window = self.window(Some(target.contact), (1.0 + CARRIED) * longest);
        let Some(at) = window.contacts.iter().position(|c| *c == target.contact) else {
            return self.refine(self.level + 1);
        };
        let Some(mut landed) = self.locate(&window, target, at, expected, longest) else {
            // not so near after all: go on, until a panel meets the event again
            return self.refine((self.level + 1).max(level_within(longest)));
        };
        self.watch_window(&mut window, &mut landed);
        let length = landed.length;
        // the event may have come before, in a dip that this panel passed over, or another one first
        match self.judge(length, &window.contacts, window.closed, &landed.solved, &landed.overlap, false) {
            Judgement::Meets(other, place) if place < 0.99 && (other != target || place > 0.0) => {
                self.head_for(other, place, length);
                // from nearer by, lest the same end is found again
                self.level += 1;
                return;
            }
            _ => {}
        }
        let excess = self.excess(&window, &landed);
        if excess > 1.0 {
            self.landing = 0.9 * length * excess.powf(-1.0 / LANDING).max(1e-3);
            self.horizon = Some(Horizon { target, at_s: self.time_s + length });
            return self.refine(self.level + 1);
        }
        self.commit_landed(&window, &landed);
        self.transition(target);
    }

    /// Value of an event function at the end of a terminal panel, and how fast it changes.
    fn margin(&self, target: Target, [overlap, rate, acceleration]: [f64; 3]) -> (f64, f64) {
        let state = &self.states[target.contact];
        match state.touch() {
            Some(touch) => {
                let boundary = self.law(target.contact).boundaries(&touch.branch)[target.boundary];
                let slope = boundary.per_compression * rate + boundary.per_rate * acceleration;
                (boundary.margin(overlap, rate), slope)
            }
            None => (state.touch_m() - overlap, -rate),
        }
    }

    /// The terminal panel of at most `longest` whose end is the event.
    fn locate(&mut self, window: &Window, target: Target, at: usize, expected: f64, longest: f64) -> Option<Landed> {
        let state = &self.states[target.contact];
        let initial = self.margin(target, [state.overlap, state.rate, 0.0]).0.max(0.0);
        let mut length = expected.clamp(1e-3 * longest, longest);
        let mut unknowns = self.unknowns_of(window, length);
        let (mut low, mut low_margin) = (0.0, initial);
        let mut high: Option<(f64, f64)> = None;
        let mut side = 0;
        for _ in 0..60 {
            let landed = window.attempt(length, &mut unknowns, &mut self.counts)?;
            for (unknown, solved) in unknowns.iter_mut().zip(&landed.solved) {
                unknown.guess = solved.force;
            }
            if let Some(landed) = self.carried(window, target, at, &landed) {
                return (landed.length <= longest).then_some(landed);
            }
            let (margin, slope) = self.margin(target, landed.end[at]);
            if margin.abs() <= 1e-13 * initial {
                return Some(landed);
            }
            if margin > 0.0 {
                if let Some((_, high_margin)) = &mut high
                    && side > 0
                {
                    *high_margin *= 0.5;
                }
                (low, low_margin, side) = (length, margin, 1);
            } else {
                if side < 0 {
                    low_margin *= 0.5;
                }
                (high, side) = (Some((length, margin)), -1);
            }
            let next = match high {
                None if length >= longest => return None,
                None => (2.0 * length).min(longest),
                Some((high, high_margin)) => {
                    let newton = length - margin / slope;
                    let secant = (low * high_margin - high * low_margin) / (high_margin - low_margin);
                    let within = |x: &f64| *x > low && *x < high;
                    match [newton, secant, 0.5 * (low + high)].into_iter().find(within) {
                        // what follows does not depend on where within these last digits the branch is left
                        Some(next) if (next - length).abs() > 1e-13 * high => next,
                        _ => return Some(landed),
                    }
                }
            };
            length = next;
        }
        None
    }

    /// The forces of a terminal panel, cut short or carried on to where they meet the event themselves, if that is near
    /// enough for the laws to hold there as they do at the nodes.
    fn carried(&self, window: &Window, target: Target, at: usize, from: &Landed) -> Option<Landed> {
        let range = BASIS.nodes[Q - 1] * from.length..=(1.0 + CARRIED) * from.length;
        let (mut length, mut end) = (from.length, from.end[at]);
        for _ in 0..8 {
            let (margin, slope) = self.margin(target, end);
            let next = length - margin / slope;
            if !range.contains(&next) {
                return None;
            }
            // the next of Newton's steps would be the square of this one
            if (next - length).abs() <= 1e-7 * next {
                return Some(window.carried(from, next));
            }
            (length, end) = (next, window.end(from, at, next));
        }
        None
    }

    fn commit_landed(&mut self, window: &Window, landed: &Landed) {
        let (contacts, closed) = (window.contacts.as_slice(), window.closed);
        self.show(landed.length, &contacts[..closed], &landed.force);
        terminal::coast(self.system, landed.length, &mut self.amplitude, &mut self.rate);
        for (i, &c) in contacts[..closed].iter().enumerate() {
            let (link, nodal) = (&self.system.links[c], &landed.solved[i].force);
            terminal::push(self.system, link, landed.length, nodal, &mut self.amplitude, &mut self.rate);
        }
        self.pass(landed.length);
        self.book(landed.length, contacts, closed, &landed.solved, &landed.force, |i| {
            (landed.end[i][0], landed.end[i][1])
        });
    }

    /// What follows where an event function has fallen to zero.
    fn transition(&mut self, target: Target) {
        let c = target.contact;
        let law = self.law(c);
        let Some(touch) = self.states[c].touch() else {
            return self.touch(c, 0.0);
        };
        let boundary = law.boundaries(&touch.branch)[target.boundary];
        let residue = boundary.margin(self.states[c].overlap, self.states[c].rate).abs();
        match law.cross(&touch.branch, target.boundary, self.states[c].overlap, self.states[c].rate) {
            After::Continue(branch) => {
                self.enter(c, branch);
                if let Phase::Closed(touch) = &mut self.states[c].phase {
                    touch.residue = residue;
                    touch.rate_residue = if boundary.per_rate == 0.0 { 0.0 } else { residue / boundary.per_rate.abs() };
                }
                self.event(c, Event::Cross(target.boundary));
            }
            After::Release(memory) => {
                let (overlap, _) = self.overlap_of_modes(c);
                let (now, rate) = (self.time_s, self.states[c].rate);
                if let Some(interval) = self.states[c].finish(Some((now, rate))) {
                    self.observer.interval(c, &interval);
                }
                self.intervals += 1;
                let state = &mut self.states[c];
                // the surfaces part where the law says so, not where the sum over the modes puts them
                state.reference += state.overlap - overlap;
                state.phase = Phase::Open { memory, clear_until: now, bounds: None };
                self.forget_horizons();
                self.depart();
                self.event(c, Event::Cross(target.boundary));
            }
        }
    }

    /// Shows the energy ledger and the observer a panel that is about to be committed.
    fn show(&mut self, h: f64, contacts: &[usize], force: &[Nodal]) {
        if let Some(account) = &mut self.account {
            let (amplitude, rate) = (&self.amplitude, &self.rate);
            let start = Moment { system: self.system, loads: &self.loads, time_s: self.time_s, amplitude, rate };
            account.panel(&start, self.tables, h, contacts, force);
        }
        let free = contacts.is_empty();
        let streams = self.observer.wants_panels();
        if h == 0.0 || !streams && self.record.is_none() {
            return;
        }
        let mut stretch = self.stretch(h, contacts, force);
        if streams {
            let (system, loads, laws) = (self.system, &self.loads, self.laws);
            self.observer.panel(&Panel { system, loads, laws, stretch: &stretch });
        }
        if let Some(record) = &mut self.record {
            stretch.events = std::mem::take(&mut self.pending);
            // a flight without loads is one stretch, however many panels it took to see that nothing closes
            let flies_on =
                |last: &Stretch| free && self.loads.is_empty() && last.forces.is_empty() && stretch.events.is_empty();
            match record.last_mut().filter(|last| flies_on(last)) {
                Some(last) => last.length_s = self.time_s + h - last.start_s,
                None => record.push(stretch),
            }
        }
    }

    fn stretch(&self, length_s: f64, contacts: &[usize], force: &[Nodal]) -> Stretch {
        let seen = |state: &State| Seen { reference: state.reference, branch: state.touch().map(|touch| touch.branch) };
        Stretch {
            events: Vec::new(),
            start_s: self.time_s,
            length_s,
            amplitude: self.amplitude.clone(),
            rate: self.rate.clone(),
            contacts: self.states.iter().map(seen).collect(),
            forces: contacts.iter().copied().zip(force.iter().copied()).collect(),
        }
    }

    /// Where the record ends, as a stretch of no length.
    pub fn last(&mut self) -> Stretch {
        let events = std::mem::take(&mut self.pending);
        Stretch { events, ..self.stretch(0.0, &[], &[]) }
    }

    /// The record, with the endless flight that follows where bodies have parted for good, or have never been otherwise.
    pub fn recorded(&mut self, parted: bool) -> Vec<Stretch> {
        let mut record = self.record.take().unwrap_or_default();
        if parted || record.is_empty() {
            let known = record.partition_point(|stretch| stretch.start_s < self.time_s);
            let flight = record.drain(known..).next();
            let events = flight.map_or_else(|| std::mem::take(&mut self.pending), |flight| flight.events);
            record.push(Stretch { events, ..self.stretch(f64::INFINITY, &[], &[]) });
        }
        record
    }
}

/// What the event functions of a panel say.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Judgement {
    Clear,
    Doubtful,
    Meets(Target, f64),
}
