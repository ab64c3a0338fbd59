//! Periodic motions under harmonic loads.
//!
//! After `n` common periods of the loads the state `x = (a, b)` of all modes becomes `P(x)`, computed by time integration. A periodic
//! motion is a fixed point, found by Newton's method, `(DP - 1) dx = x - P(x)`. The eigenvalues of `DP` there are its Floquet
//! multipliers, and it is stable if none exceeds 1 in size. `DP` is the tangent of the motion, composed of its exact pieces
//! ([`Solver::differentiate`] computes the same for other parameters). At grazing contacts the map has no derivative. Central
//! differences then replace it, and Newton's method may fail to converge.
//!
//! The states are compared at a moment at which every contact is open, if there is one, or else every contact that turns out to have
//! internal variables, because those of a closed contact are not part of `x`. Neither is the indentation of an open one. If the motion
//! depends on either, a fixed point of the map is not a periodic motion ([`OrbitOutcome::Remembers`]).

use super::period::CommonPeriod;
use super::problem::{Assembly, Force, Settings};
use super::solution::{ContactSample, Interval, Motion, Observer, Outcome, Reason, Run};
use super::solve::{Solver, run};
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::{fmt, iter};

/// Step of finite differences, relative to the size of the motion.
const DIFFERENCE: f64 = 1e-5;
/// States are not compared within a shorter part of the period, as between two stops of which one opens where the other closes.
const LEAST_OPEN: f64 = 1e-9;
/// Least number of moments of a period at which it is sampled, and of a period of the slowest load.
const SAMPLES: usize = 1024;
const SAMPLES_OF_CYCLE: usize = 64;
/// Bisections that locate a turning point. The error of its displacement is the square of that of its time.
const TURNING_HALVINGS: u32 = 24;
/// Newton's method is given up after this many iterations in a row that hardly reduce the distance, by less than this factor.
const STALLED: u32 = 5;
const HARDLY: f64 = 0.9;
/// A motion counts as unstable if a multiplier exceeds 1 by more than this, which is the accuracy at grazing contacts.
const MARGINAL: f64 = 1e-6;

/// Settings of the search for a periodic motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbitSettings {
    /// Common periods of the loads ([`CommonPeriod`]) after which the motion repeats. Default 1.
    pub forcing_periods: u32,
    /// Periods that are followed from the start before Newton's method. Default 100.
    pub transient_periods: u32,
    /// Periods that are followed in search of near returns if Newton's method fails after the transient. Default 1500.
    pub search_periods: u32,
    /// Tolerance of the runs, see [`Settings::tolerance`]. Default 1e-11.
    pub tolerance: f64,
    /// Largest difference `|P(x) - x|` of a periodic motion, relative to its size. Default 1e-9.
    pub closure: f64,
    /// Largest number of Newton iterations. Default 30.
    pub max_iterations: u32,
}

impl Default for OrbitSettings {
    fn default() -> OrbitSettings {
        OrbitSettings {
            forcing_periods: 1,
            transient_periods: 100,
            search_periods: 1500,
            tolerance: 1e-11,
            closure: 1e-9,
            max_iterations: 30,
        }
    }
}

impl OrbitSettings {
    pub(crate) fn check(&self) -> Result<(), InvalidInput> {
        InvalidInput::unless(self.forcing_periods > 0, "forcing_periods", self.forcing_periods, "at least 1")?;
        InvalidInput::unless(self.max_iterations > 0, "max_iterations", self.max_iterations, "at least 1")?;
        let closure = (1e-13..=0.1).contains(&self.closure);
        InvalidInput::unless(closure, "closure", self.closure, "a number from 1e-13 to 0.1")
    }
}

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

/// A periodic motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Orbit {
    /// Period of the motion (s), `forcing_periods` times that of the loads.
    pub period_s: f64,
    /// Common periods of the loads in it.
    pub forcing_periods: u32,
    /// The moment of the loads' period at which the state is given (s).
    pub phase_s: f64,
    /// The state then: amplitudes of all modes, body by body, then their rates.
    pub state: Vec<f64>,
    /// `|P(x) - x|`, relative to the size of the motion.
    pub closure: f64,
    /// Floquet multipliers, real and imaginary part, the largest first.
    pub floquet_multipliers: Vec<[f64; 2]>,
    /// Whether no multiplier lies outside the unit circle.
    pub stable: bool,
    /// Intervals of contact that begin within a period, contact by contact; 1 for a contact that stays closed.
    pub intervals_per_period: Vec<u64>,
    /// Motion of both sides of every contact.
    pub sides: Vec<[SideMotion; 2]>,
    /// Their displacements (m) at `phase_s` of each period of the loads, period by period and contact by contact.
    pub section_m: Vec<Vec<[f64; 2]>>,
    /// Newton iterations that led here.
    pub iterations: u32,
}

/// How nearly the motion from the start repeats itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recurrence {
    /// Periods of the loads after which it is nearest to an earlier state, up to 16.
    pub forcing_periods: u32,
    /// The distance from that state, relative to the size of the motion.
    pub distance: f64,
    /// Whether it repeats itself after so many periods from then on: it has converged to a periodic motion.
    pub has_converged: bool,
    /// Factor by which nearby motions separate in a period of the loads, on average over some periods after the search. Above 1 the
    /// motion is chaotic there; it may still converge later.
    pub separation_per_period: f64,
}

/// Outcome of the search for a periodic motion.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum OrbitOutcome {
    /// A periodic motion was found.
    Found(Box<Orbit>),
    /// Newton's method did not converge; this was the closest approach to a motion that repeats itself.
    NotFound {
        /// `|P(x) - x|`, relative to the size of the motion.
        closure: f64,
        /// The returns of the motion from the start, if it was followed in search of them.
        recurrence: Option<Recurrence>,
    },
    /// A motion was found that would repeat itself if this contact forgot all earlier motion once in each period. It does not
    /// ([`ContactEnd::remembers`](super::ContactEnd::remembers)): its surfaces keep an indentation, or its law has
    /// internal variables, and it is closed all the time, or whenever another one of this kind is open. The real motion differs.
    Remembers {
        /// Index of the contact in [`Assembly::contacts`], from 0.
        contact: usize,
    },
    /// A run of a period stopped before its end.
    Stopped(Outcome),
    /// The observer interrupted the search at this distance.
    Interrupted {
        /// `|P(x) - x|`, relative to the size of the motion.
        closure: f64,
        /// The state then, in the order of [`Orbit::state`].
        state: Vec<f64>,
    },
}

impl fmt::Display for OrbitOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OrbitOutcome::Found(orbit) => write!(f, "found: a period of {} s", orbit.period_s),
            OrbitOutcome::NotFound { closure, .. } => {
                write!(f, "not found: the motion repeats itself to {closure:e} at best")
            }
            OrbitOutcome::Remembers { contact } => {
                write!(f, "not found: the motion depends on what contact {contact} keeps from earlier periods")
            }
            OrbitOutcome::Stopped(outcome) => write!(f, "a period did not end: {outcome}"),
            OrbitOutcome::Interrupted { closure, .. } => write!(f, "interrupted at a closure of {closure:e}"),
        }
    }
}

/// Newton's method from a state near an orbit.
pub(crate) fn refine<L: ContactLaw + Clone>(
    map: &PeriodMap<'_, L>,
    mut state: DVector<f64>,
    settings: &OrbitSettings,
) -> Result<OrbitOutcome, InvalidInput> {
    let mut image = match map.apply(&state)? {
        Ok(image) => image,
        Err(outcome) => return Ok(OrbitOutcome::Stopped(outcome)),
    };
    let (mut iterations, mut stalled, mut before) = (0, 0, f64::INFINITY);
    loop {
        let scales = map.scales(&state, &image);
        let closure = map.distance(&(&image - &state), &scales);
        let interrupted = || OrbitOutcome::Interrupted { closure, state: state.iter().copied().collect() };
        if (map.stop)() {
            return Ok(interrupted());
        }
        let jacobian = match map.derivative(&state, &scales)? {
            Ok(jacobian) => jacobian,
            Err(Outcome::Stopped(Reason::Interrupted)) => return Ok(interrupted()),
            Err(outcome) => return Ok(OrbitOutcome::Stopped(outcome)),
        };
        if closure <= settings.closure {
            return map.describe(state, closure, &jacobian, iterations);
        }
        stalled = if closure > HARDLY * before { stalled + 1 } else { 0 };
        before = closure;
        if iterations == settings.max_iterations || stalled == STALLED {
            return Ok(OrbitOutcome::NotFound { closure, recurrence: None });
        }
        iterations += 1;
        let matrix = &jacobian - DMatrix::identity(state.len(), state.len());
        let Some(step) = matrix.lu().solve(&(&state - &image)) else {
            return Ok(OrbitOutcome::NotFound { closure, recurrence: None });
        };
        // a full step, or a shorter one that reduces the distance
        let mut part = 1.0;
        let next = loop {
            if (map.stop)() {
                return Ok(interrupted());
            }
            let trial = &state + part * &step;
            if let Ok(after) = map.apply(&trial)?
                && (map.distance(&(&after - &trial), &scales) < closure || part < 1e-3)
            {
                break Some((trial, after));
            }
            part *= 0.5;
            if part < 1e-4 {
                break None;
            }
        };
        match next {
            Some((trial, after)) => (state, image) = (trial, after),
            None => return Ok(OrbitOutcome::NotFound { closure, recurrence: None }),
        }
    }
}

/// The map of the state over a period of the loads.
pub(crate) struct PeriodMap<'s, L> {
    stop: &'s dyn Fn() -> bool,
    assembly: Assembly<L>,
    settings: Settings,
    forcing_period_s: f64,
    /// Periods of the slowest load in it.
    cycles: u32,
    forcing_periods: u32,
    phase_s: f64,
}

pub(super) type Reached<T> = Result<Result<T, Outcome>, InvalidInput>;

impl<'s, L: ContactLaw + Clone> PeriodMap<'s, L> {
    pub fn new(
        assembly: Assembly<L>,
        settings: &OrbitSettings,
        stop: &'s dyn Fn() -> bool,
    ) -> Result<PeriodMap<'s, L>, InvalidInput> {
        assembly.check()?;
        let CommonPeriod { period_s: forcing_period_s, cycles } = CommonPeriod::of(&assembly.loads)?;
        if let Some(i) = assembly.loads.iter().position(|load| matches!(load.force, Force::Sampled { .. })) {
            let allowed = "a constant or harmonic load, because a sampled load is not periodic";
            return Err(InvalidInput::new(("loads", i), "a sampled load", allowed));
        }
        let mut runs = Settings::until(forcing_period_s * f64::from(settings.forcing_periods));
        runs.tolerance = settings.tolerance;
        runs.stop_at_rest = false;
        runs.check()?;
        let forcing_periods = settings.forcing_periods;
        Ok(PeriodMap { stop, assembly, settings: runs, forcing_period_s, cycles, forcing_periods, phase_s: 0.0 })
    }

    pub fn period_s(&self) -> f64 {
        self.settings.end_s
    }

    /// The same map with the states taken at another moment of the loads' period.
    pub fn at_phase(mut self, phase_s: f64) -> PeriodMap<'s, L> {
        self.set_phase(phase_s);
        self
    }

    fn set_phase(&mut self, phase_s: f64) {
        for load in &mut self.assembly.loads {
            if let Force::Harmonic { omega_rad_s, phase_rad, .. } = &mut load.force {
                *phase_rad += *omega_rad_s * (phase_s - self.phase_s);
            }
        }
        self.phase_s = phase_s;
    }

    fn posed(&self, state: &DVector<f64>) -> Assembly<L> {
        let mut assembly = self.assembly.clone();
        let n = state.len() / 2;
        let mut next = 0;
        for body in &mut assembly.bodies {
            for k in 0..body.modes.len() {
                (body.amplitude[k], body.rate[k]) = (state[next], state[n + next]);
                next += 1;
            }
        }
        assembly
    }

    fn state_of(amplitude: &[Vec<f64>], rate: &[Vec<f64>]) -> DVector<f64> {
        let values = amplitude.iter().chain(rate).flatten().copied();
        DVector::from_vec(values.collect())
    }

    fn run(&self, state: &DVector<f64>, end_s: f64, observer: &mut dyn Observer) -> Result<Run, InvalidInput> {
        let settings = Settings { end_s, ..self.settings };
        run(&self.posed(state), &settings, &mut Stoppable { stop: self.stop, observer })
    }

    pub fn follow(&self, state: &DVector<f64>, end_s: f64, observer: &mut dyn Observer) -> Reached<DVector<f64>> {
        let found = self.run(state, end_s, observer)?;
        Ok(match found.outcome {
            Outcome::End => Ok(Self::state_of(&found.amplitude, &found.rate)),
            other => Err(other),
        })
    }

    /// `P(x)`.
    pub fn apply(&self, state: &DVector<f64>) -> Reached<DVector<f64>> {
        self.follow(state, self.settings.end_s, &mut ())
    }

    /// The assembly's own start.
    pub fn start(&self) -> DVector<f64> {
        let of =
            |part: fn(&super::Body) -> &Vec<f64>| self.assembly.bodies.iter().map(part).cloned().collect::<Vec<_>>();
        Self::state_of(&of(|body| &body.amplitude), &of(|body| &body.rate))
    }

    /// Follows a state for some periods and moves the phase to the middle of the longest time without contact.
    pub fn transient(&mut self, mut state: DVector<f64>, periods: u32) -> Reached<DVector<f64>> {
        if periods > 0 {
            let span = f64::from(periods) * self.forcing_period_s;
            match self.follow(&state, span, &mut ())? {
                Ok(reached) => state = reached,
                Err(outcome) => return Ok(Err(outcome)),
            }
        }
        let all: BTreeSet<usize> = (0..self.assembly.contacts.len()).collect();
        let by = match self.to_opening(&state, &all)? {
            Ok(by) => by,
            Err(outcome) => return Ok(Err(outcome)),
        };
        self.turn(state, by)
    }

    /// The part of a period of the loads until the middle of the longest time at which these contacts are open; zero if there is none.
    pub fn to_opening(&self, state: &DVector<f64>, contacts: &BTreeSet<usize>) -> Reached<f64> {
        let mut closed = Closed { contacts, intervals: Vec::new() };
        let reached = self.follow(state, self.settings.end_s, &mut closed)?;
        Ok(reached.map(|_| closed.middle_of_longest_gap(self.settings.end_s) / self.forcing_period_s))
    }

    /// Follows a state for a part of a period of the loads, and moves the phase with it.
    pub fn turn(&mut self, state: DVector<f64>, part: f64) -> Reached<DVector<f64>> {
        if part <= 0.0 {
            return Ok(Ok(state));
        }
        let turned = self.follow(&state, part * self.forcing_period_s, &mut ())?;
        self.set_phase((self.phase_s + part * self.forcing_period_s) % self.forcing_period_s);
        Ok(turned)
    }

    /// Scales of the state: the largest rate for all rates, and the corresponding amplitude for each mode.
    pub fn scales(&self, state: &DVector<f64>, image: &DVector<f64>) -> DVector<f64> {
        let n = state.len() / 2;
        let omega: Vec<f64> =
            self.assembly.bodies.iter().flat_map(|body| body.modes.iter().map(|mode| mode.omega_rad_s)).collect();
        let base = TAU / self.forcing_period_s;
        let speed =
            |x: &DVector<f64>| (0..n).map(|k| x[n + k].abs().max(omega[k].max(base) * x[k].abs())).fold(0.0, f64::max);
        let speed = speed(state).max(speed(image)).max(1e-30);
        DVector::from_fn(2 * n, |i, _| if i < n { speed / omega[i].max(base) } else { speed })
    }

    pub fn distance(&self, difference: &DVector<f64>, scales: &DVector<f64>) -> f64 {
        difference.iter().zip(scales.iter()).map(|(d, scale)| (d / scale).abs()).fold(0.0, f64::max)
    }

    /// `DP`: the tangent of the motion, or, at a graze, where that does not exist, central differences.
    pub fn derivative(&self, state: &DVector<f64>, scales: &DVector<f64>) -> Reached<DMatrix<f64>> {
        let assembly = self.posed(state);
        match Solver::new(&assembly)?.monodromy(&self.settings)? {
            (Outcome::End, Ok(columns)) => Ok(Ok(DMatrix::from_fn(state.len(), state.len(), |i, j| columns[j][i]))),
            (Outcome::End, Err(_)) => self.differences(state, scales),
            (outcome, _) => Ok(Err(outcome)),
        }
    }

    fn differences(&self, state: &DVector<f64>, scales: &DVector<f64>) -> Reached<DMatrix<f64>> {
        let n = state.len();
        let mut jacobian = DMatrix::zeros(n, n);
        for i in 0..n {
            let step = DIFFERENCE * scales[i];
            let mut sides = [None, None];
            for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
                let mut moved = state.clone();
                moved[i] += sign * step;
                match self.apply(&moved)? {
                    Ok(image) => *side = Some(image),
                    Err(outcome) => return Ok(Err(outcome)),
                }
            }
            if let [Some(above), Some(below)] = sides {
                jacobian.set_column(i, &((above - below) / (2.0 * step)));
            }
        }
        Ok(Ok(jacobian))
    }

    /// The orbit through a state, with all that is reported of it.
    fn describe(
        &self,
        state: DVector<f64>,
        closure: f64,
        jacobian: &DMatrix<f64>,
        iterations: u32,
    ) -> Result<OrbitOutcome, InvalidInput> {
        let mut survey = Survey::new(self);
        let period = self.run(&state, self.settings.end_s, &mut survey)?;
        if period.outcome != Outcome::End {
            return Ok(OrbitOutcome::Stopped(period.outcome));
        }
        if let Some(contact) = period.contacts.iter().position(|contact| contact.remembers) {
            return Ok(OrbitOutcome::Remembers { contact });
        }
        let eigenvalues = jacobian.complex_eigenvalues();
        let mut floquet_multipliers: Vec<[f64; 2]> = eigenvalues.iter().map(|value| [value.re, value.im]).collect();
        floquet_multipliers.sort_by(|a, b| b[0].hypot(b[1]).total_cmp(&a[0].hypot(a[1])));
        let stable = floquet_multipliers.iter().all(|value| value[0].hypot(value[1]) <= 1.0 + MARGINAL);
        let sides = survey.sides();
        Ok(OrbitOutcome::Found(Box::new(Orbit {
            period_s: self.settings.end_s,
            forcing_periods: self.forcing_periods,
            phase_s: self.phase_s,
            state: state.iter().copied().collect(),
            closure,
            floquet_multipliers,
            stable,
            intervals_per_period: survey.intervals,
            sides,
            section_m: survey.section_m,
            iterations,
        })))
    }
}

/// An observer whose run can be stopped from outside.
struct Stoppable<'a> {
    stop: &'a dyn Fn() -> bool,
    observer: &'a mut dyn Observer,
}

impl Observer for Stoppable<'_> {
    fn interval(&mut self, contact: usize, interval: &Interval) {
        self.observer.interval(contact, interval);
    }

    fn panel(&mut self, panel: &dyn Motion) {
        self.observer.panel(panel);
    }

    fn wants_panels(&self) -> bool {
        self.observer.wants_panels()
    }

    fn interrupts(&mut self) -> bool {
        (self.stop)()
    }
}

/// When any of some contacts is closed.
struct Closed<'a> {
    contacts: &'a BTreeSet<usize>,
    intervals: Vec<(f64, f64)>,
}

impl Observer for Closed<'_> {
    fn interval(&mut self, contact: usize, interval: &Interval) {
        if self.contacts.contains(&contact) {
            self.intervals.push((interval.start_s, interval.end_s.unwrap_or(f64::INFINITY)));
        }
    }
}

impl Closed<'_> {
    fn middle_of_longest_gap(mut self, end_s: f64) -> f64 {
        self.intervals.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut open_since, mut best) = (0.0, (LEAST_OPEN * end_s, 0.0));
        for (start, end) in self.intervals.into_iter().chain([(end_s, end_s)]) {
            if start - open_since > best.0 {
                best = (start - open_since, 0.5 * (start + open_since));
            }
            open_since = f64::max(open_since, end);
        }
        best.1
    }
}

/// What is reported of a period.
struct Survey {
    period_s: f64,
    /// Equal intervals between samples, in a period of the loads and in all.
    samples_of_forcing: usize,
    samples: usize,
    next: usize,
    /// Periods of the slowest load.
    cycles: usize,
    /// Sums of the displacements times `e^{i Omega t}`, contact by contact and side by side.
    turned: Vec<[Complex64; 2]>,
    section_m: Vec<Vec<[f64; 2]>>,
    /// Smallest and largest displacement (m), contact by contact and side by side.
    extremes: Vec<[(f64, f64); 2]>,
    intervals: Vec<u64>,
}

impl Survey {
    fn new<L>(map: &PeriodMap<'_, L>) -> Survey {
        let contacts = map.assembly.contacts.len();
        let (periods, cycles) = (map.forcing_periods as usize, map.cycles as usize);
        let samples_of_forcing = SAMPLES.div_ceil(periods).max(SAMPLES_OF_CYCLE * cycles);
        Survey {
            period_s: map.settings.end_s,
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

    fn sides(&self) -> Vec<[SideMotion; 2]> {
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

#[cfg(test)]
mod tests {
    use super::super::{Body, BodyMode, Contact, Load, Point};
    use super::*;
    use contact_models::{Law, LinearSpring};

    /// Two bodies of two modes, a spring between them and one at the ground, two loads.
    fn rattling() -> Assembly<Law> {
        let body = |omega: f64| {
            let mode = |omega_rad_s: f64| BodyMode { omega_rad_s, damping_ratio: 0.03 };
            Body::at_rest(vec![mode(omega), mode(2.7 * omega)])
        };
        let point = |body: usize, first: f64| Point::OfBody { body, shape: vec![first, -0.7 * first] };
        let contacts = vec![
            Contact { sides: [point(0, 1.0), point(1, 1.2)], gap_m: 1e-3, law: LinearSpring::new(4e3).unwrap().into() },
            Contact { sides: [point(1, 1.2), Point::Ground], gap_m: 2e-3, law: LinearSpring::new(6e3).unwrap().into() },
        ];
        let load = |body: usize, force| Load { body, shape: vec![1.0, 0.5], force };
        let driving = Force::Harmonic { force_n: 3.0, omega_rad_s: 11.0, phase_rad: 0.2 };
        let loads = vec![load(0, driving), load(1, Force::Constant { force_n: -0.3 })];
        Assembly { bodies: vec![body(9.0), body(14.0)], contacts, loads }
    }

    #[test]
    fn the_tangent_of_a_period_is_that_of_differences() {
        let map =
            PeriodMap::new(rattling(), &OrbitSettings { tolerance: 1e-12, ..OrbitSettings::default() }, &|| false)
                .unwrap();
        let state = map.start();
        let mut closed = Closed { contacts: &BTreeSet::from([0, 1, 2]), intervals: Vec::new() };
        map.follow(&state, map.period_s(), &mut closed).unwrap().unwrap();
        assert!(closed.intervals.len() > 2, "{:?}", closed.intervals);
        let scales = map.scales(&state, &map.apply(&state).unwrap().unwrap());
        let exact = map.derivative(&state, &scales).unwrap().unwrap();
        let differences = map.differences(&state, &scales).unwrap().unwrap();
        let n = state.len();
        for i in 0..n {
            for j in 0..n {
                let error = (exact[(i, j)] - differences[(i, j)]).abs() * scales[j] / scales[i];
                assert!(error < 1e-4, "{i} {j}: {} {}", exact[(i, j)], differences[(i, j)]);
            }
        }
        // only the damping of the modes reduces the volume in the space of states; springs do not
        let damping: f64 =
            map.assembly.bodies.iter().flat_map(|body| &body.modes).map(|mode| 0.06 * mode.omega_rad_s).sum();
        let volume = (-damping * map.period_s()).exp();
        assert!((exact.determinant() / volume - 1.0).abs() < 1e-8, "{} {volume}", exact.determinant());
    }
}
