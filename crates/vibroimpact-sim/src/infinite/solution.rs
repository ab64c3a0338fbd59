//! The result of a run, and its evaluation at any time.

use super::flight::Departure;
use super::panel::{Panel, Turn};
use super::problem::{Settings, Structure};
use super::rule::Tables;
use crate::StopReason;

pub use crate::outcome::Outcome;

/// One interval of contact. Times in units of `T`, velocities in units of `v`, positive away from the structure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SubImpact {
    /// Time of touch.
    pub start: f64,
    /// Time of separation; `None` in sustained contact.
    pub end: Option<f64>,
    /// `end - start`, with its own relative precision.
    pub duration: Option<f64>,
    /// Rate of compression at touch.
    pub closing_speed: f64,
    /// Velocity of the striker at touch.
    pub striker_velocity_at_start: f64,
    /// Velocity of the striker at separation.
    pub striker_velocity_at_end: Option<f64>,
}

/// A local extremum of the compression during contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremum {
    /// Index of the contact, from 0.
    pub contact: usize,
    /// Time (units of `T`).
    pub time: f64,
    /// Compression (units of `v T`).
    pub compression: f64,
    /// Whether it is a minimum; otherwise it is a maximum.
    pub minimum: bool,
}

/// Motion at one time, in units of `T`, `v`, `v T` and `F`. Displacements are positive away from the structure, as those of
/// [`modal::Sample`](crate::modal::Sample).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Compression, or minus the gap.
    pub compression: f64,
    /// Its rate.
    pub compression_rate: f64,
    /// Contact force.
    pub force: f64,
    /// Displacement of the striker since first touch.
    pub striker_displacement: f64,
    /// Velocity of the striker.
    pub striker_velocity: f64,
    /// Displacement of the struck point.
    pub structure_displacement: f64,
    /// Velocity of the struck point.
    pub structure_velocity: f64,
}

impl State {
    /// From the compression, its rate and the force, and the travel and speed of the striker towards the structure.
    fn new([compression, compression_rate, force]: [f64; 3], travel: f64, speed: f64) -> State {
        // not the negative, which would make a zero negative
        let away = |towards: f64| 0.0 - towards;
        State {
            compression,
            compression_rate,
            force,
            striker_displacement: away(travel),
            striker_velocity: away(speed),
            structure_displacement: away(travel - compression),
            structure_velocity: away(speed - compression_rate),
        }
    }
}

/// Largest time (units of `T`), beyond which powers of the time would overflow.
const LATEST: f64 = 1e120;

/// Largest relative difference of the times of contacts that count as the same in two solutions.
const SAME: f64 = 0.5;

/// Free flight after a contact.
#[derive(Debug, Clone)]
pub(super) struct Flight {
    pub start: f64,
    pub body_travel: f64,
    pub course: Departure,
}

/// The record of a contact from which its motion is evaluated.
#[derive(Debug, Clone)]
pub(super) struct Record {
    pub panels: Vec<Panel>,
    pub turns: Vec<Turn>,
    /// Largest force.
    pub peak_force: f64,
    /// Travel of the striker towards the structure up to touch.
    pub body_travel: f64,
}

/// Solution of one impact.
#[derive(Debug, Clone)]
pub struct Solution {
    /// The struck structure of Hertz contact; `None` where [`solve_law`](super::solve_law) was given its impulse response.
    pub structure: Option<Structure>,
    /// The nondimensional number `S` of Hertz contact; other laws have none.
    pub s: Option<f64>,
    /// How the impact ends.
    pub outcome: Outcome,
    /// Every contact in order.
    pub sub_impacts: Vec<SubImpact>,
    /// Local extrema of the compression during contact, in order.
    pub extrema: Vec<Extremum>,
    /// Estimated relative error of contact starts, durations and speeds of the body at separation:
    /// three times the largest difference between this solution and one with more nodes, plus 1e-5
    /// of the tolerance, since the two may agree by accident. Infinite if the two
    /// differ in the number of contacts or in the outcome. `None` if not requested.
    pub relative_uncertainty: Option<f64>,
    /// Number of separations, from the first, that both solutions have at the same times, within half of these times. Later ones
    /// are not known. `None` if no second solution was requested.
    pub certain_separations: Option<usize>,
    /// The motion can be requested up to this time (units of `T`).
    pub known_until: f64,
    /// Panels in the solution.
    pub panels: usize,
    /// Number of solved panels, including rejected ones and iterations for separation.
    pub panels_tried: usize,
    pub(super) flights: Vec<Flight>,
    records: Vec<Record>,
    nodes: usize,
}

impl Solution {
    pub(super) fn empty(structure: Option<Structure>, s: Option<f64>, nodes: usize) -> Solution {
        Solution {
            structure,
            s,
            outcome: Outcome::Stopped(StopReason::Steps),
            sub_impacts: Vec::new(),
            extrema: Vec::new(),
            relative_uncertainty: None,
            certain_separations: None,
            known_until: 0.0,
            panels: 0,
            panels_tried: 0,
            flights: Vec::new(),
            records: Vec::new(),
            nodes,
        }
    }

    /// Adds a contact.
    pub(super) fn push(&mut self, contact: SubImpact, record: Record) {
        let index = self.sub_impacts.len();
        let at = |&Turn { after, compression, minimum }: &Turn| Extremum {
            contact: index,
            time: contact.start + after,
            compression,
            minimum,
        };
        self.extrema.extend(record.turns.iter().map(at));
        self.panels += record.panels.len();
        self.sub_impacts.push(contact);
        self.records.push(record);
    }

    /// Decides after a flight, which begins where the solution is known so far, whether to follow the `next` contact, given by
    /// the time until then and its closing speed. Returns it if so; otherwise the solution ends, and states why. `rounding`
    /// says that the closing speed is no more than rounding.
    pub(super) fn go_on(
        &mut self,
        next: Option<(f64, f64)>,
        rounding: bool,
        settings: &Settings,
    ) -> Option<(f64, f64)> {
        let Some((time, _)) = next else {
            self.known_until = f64::INFINITY;
            return None;
        };
        let touch = self.known_until + time;
        let lost = (rounding || touch > LATEST).then_some(StopReason::DigitsExhausted);
        let limit = (self.sub_impacts.len() >= settings.max_sub_impacts).then_some(StopReason::SubImpacts);
        let Some(reason) = limit.or(lost) else { return next };
        self.known_until = touch;
        self.outcome = Outcome::Stopped(reason);
        None
    }

    /// Largest force of every contact (units of `F`).
    pub fn peak_forces(&self) -> Vec<f64> {
        self.records.iter().map(|record| record.peak_force).collect()
    }

    /// Number of separations.
    pub fn separations(&self) -> usize {
        self.flights.len()
    }

    /// Speed away from the structure after the last separation over the speed of impact; `None`
    /// unless the body rebounds.
    pub fn rebound_ratio(&self) -> Option<f64> {
        (self.outcome == Outcome::Rebound).then(|| self.flights.last().map(|flight| -flight.course.body)).flatten()
    }

    /// Speed away from the structure after the first separation over the speed of impact (thesis
    /// Fig. 2.6b, `v_f / v`), below zero if the body still moves towards the structure; `None` if
    /// there is no separation.
    pub fn first_rebound_ratio(&self) -> Option<f64> {
        self.flights.first().map(|flight| -flight.course.body)
    }

    /// Decimal digits that two resolutions agree on (see [`relative_uncertainty`](Self::relative_uncertainty)), at most 15.
    pub fn digits(&self) -> Option<f64> {
        self.relative_uncertainty.map(|error| (-error.max(1e-15).log10()).max(0.0))
    }

    /// Motion at a time (units of `T`); `None` for a time below zero or beyond
    /// [`known_until`](Self::known_until).
    pub fn at(&self, time: f64) -> Option<State> {
        if !(time >= 0.0 && time <= self.known_until) {
            return None;
        }
        let index = self.sub_impacts.partition_point(|contact| contact.start <= time).checked_sub(1)?;
        match self.flights.get(index).filter(|flight| time > flight.start) {
            Some(flight) => Some(flight.state(time - flight.start)),
            None => self.in_contact(index, time - self.sub_impacts[index].start),
        }
    }

    /// Motion at a time after the touch of a contact (index from 0; time in units of `T`). Unlike
    /// [`at`](Self::at) it keeps its precision in late contacts, where the time itself has few
    /// digits left for what happens within a contact. `None` outside the contact.
    pub fn in_contact(&self, index: usize, after_touch: f64) -> Option<State> {
        let record = self.records.get(index)?;
        let contact = self.sub_impacts.get(index)?;
        let last = record.panels.last()?;
        if !(after_touch >= 0.0 && after_touch <= (last.start + last.h) * (1.0 + 1e-12)) {
            return None;
        }
        let at = record.panels.partition_point(|panel| panel.start <= after_touch).saturating_sub(1);
        let (panel, tables) = (&record.panels[at], Tables::get(self.nodes));
        let elapsed = ((after_touch - panel.start) / panel.h).min(1.0);
        let (compression, rate) = (panel.compression(tables, elapsed).max(0.0), panel.rate(tables, elapsed));
        let [force, impulse, moment] = panel.force(tables, elapsed);
        let speed_at_start = -contact.striker_velocity_at_start;
        let travel = record.body_travel + speed_at_start * after_touch - moment;
        Some(State::new([compression, rate, force], travel, speed_at_start - impulse))
    }

    /// Sets the error estimate from a finer solution.
    pub(super) fn compare(&mut self, finer: &Solution, tolerance: f64) {
        let relative = |a: f64, b: f64| if a == b { 0.0 } else { (a / b - 1.0).abs() };
        let certain = |(a, b): &(&SubImpact, &SubImpact)| {
            let ends = a.duration.zip(b.duration);
            relative(a.start, b.start) < SAME && ends.is_some_and(|(a, b)| relative(a, b) < SAME)
        };
        self.certain_separations = Some(self.sub_impacts.iter().zip(&finer.sub_impacts).take_while(certain).count());
        if self.outcome != finer.outcome || self.sub_impacts.len() != finer.sub_impacts.len() {
            self.relative_uncertainty = Some(f64::INFINITY);
            if (self.outcome == Outcome::Rebound) != (finer.outcome == Outcome::Rebound) {
                // whether the body leaves or returns depends on further digits
                self.outcome = Outcome::Stopped(StopReason::DigitsExhausted);
            }
            return;
        }
        let error = self.sub_impacts.iter().zip(&finer.sub_impacts).fold(0.0_f64, |error, (a, b)| {
            let duration = a.duration.zip(b.duration).map_or(0.0, |(a, b)| relative(a, b));
            // the body's speed may pass through zero: measured against its change if that is larger
            let change = 2.0 * a.closing_speed;
            let speed = a
                .striker_velocity_at_end
                .zip(b.striker_velocity_at_end)
                .map_or(0.0, |(a, b)| (a - b).abs() / b.abs().max(change));
            error.max(relative(a.start, b.start)).max(duration).max(speed)
        });
        self.relative_uncertainty = Some(3.0 * error + 1e-5 * tolerance);
    }
}

impl Flight {
    fn state(&self, tau: f64) -> State {
        let (compression, compression_rate) = self.course.state(tau);
        let speed = self.course.body;
        State::new([compression, compression_rate, 0.0], self.body_travel + speed * tau, speed)
    }
}
