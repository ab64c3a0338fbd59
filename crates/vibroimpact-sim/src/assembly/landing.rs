//! Terminal panels, whose length is unknown. They end at an event, a break of the loads, the start of the
//! statistics or the end of the run.

use super::collocate::{Collocated, Unknown};
use super::first_panel::SINGULAR;
use super::judge::Judgement;
use super::motion::{ExpectedEvent, March, Target};
use super::terminal::{Landed, Window};
use super::trial::{NEWTON_SHARE, Trial};
use crate::panel::ends::Ends;
use crate::panel::legendre::{BASIS, Legendre, Q};

/// The error of a terminal panel grows with this power of its length at least, in general and where a force ends as
/// `(t - end)^(3/2)` and is represented so.
const LANDING: f64 = 2.5;
const LANDING_WEIGHTED: f64 = 5.0;
/// An event function has fallen to zero where it is smaller than this part of its largest value.
const MET: f64 = 1e-3;
/// A force that was solved on one length is used for others as long as it is extrapolated by no more than this part.
const EXTRAPOLATED: f64 = 0.05;

/// Length of a terminal panel with the allowed error, if the error with this length is too large by this factor.
fn shorter(length: f64, excess: f64, ends: Ends) -> f64 {
    let power = if ends.ends { LANDING_WEIGHTED } else { LANDING };
    0.9 * length * excess.powf(-1.0 / power).max(1e-3)
}

/// Where the zero of an event function lies: above the longest length at which it was positive, below the shortest at which it was not.
struct Bracket {
    low: (f64, f64),
    high: Option<(f64, f64)>,
    /// Whether the last length was too short.
    last_short: Option<bool>,
}

impl Bracket {
    fn from_start(value: f64) -> Bracket {
        Bracket { low: (0.0, value), high: None, last_short: None }
    }

    /// Takes in a value of the function. An end that stays a second time is given half its value, so that secants move it (Illinois).
    fn add(&mut self, length: f64, value: f64) {
        let short = value > 0.0;
        let stays = self.last_short.replace(short) == Some(short);
        if short {
            self.high = self.high.map(|(high, value)| (high, if stays { 0.5 * value } else { value }));
            self.low = (length, value);
        } else {
            self.low.1 *= if stays { 0.5 } else { 1.0 };
            self.high = Some((length, value));
        }
    }

    /// The next length to be tried: of Newton's step, the secant and the middle the first that lies within the bracket. The secant comes
    /// first if it is preferred, and does not begin at the start.
    fn next(&self, newton: f64, prefers_secant: bool) -> Option<f64> {
        let ((low, low_value), (high, high_value)) = (self.low, self.high?);
        let secant = (low * high_value - high * low_value) / (high_value - low_value);
        let guesses = if prefers_secant && low > 0.0 { [secant, newton] } else { [newton, secant] };
        guesses.into_iter().chain([0.5 * (low + high)]).find(|length| *length > low && *length < high)
    }
}

impl<'a> March<'a> {
    /// Advances to the next break of the loads or the end, `length` away.
    pub(super) fn advance_to_stop(&mut self, length: f64) {
        let mut window = self.window(None, length);
        let mut unknowns = self.unknowns_of(&window, length, |c| self.begins(c));
        let Some(mut landed) = window.attempt(length, &mut unknowns, &mut self.newton, &mut self.counts) else {
            return self.refine_within(length);
        };
        self.watch_window(&mut window, &mut landed);
        match self.judge_landed(&window, &landed) {
            Judgement::Meets(target, place) => self.expect(target, place, length),
            _ if self.excess(&window, &landed) > 1.0 => self.refine_within(length),
            _ => self.commit_landed(&window, &landed),
        }
    }

    /// The end of a contact that the compression would reach if its polynomial on the panel of `h` just accepted were continued, by at
    /// most one panel, and no farther than a terminal panel reaches.
    pub(super) fn look_ahead(&self, h: f64, trial: &Trial) -> Option<ExpectedEvent> {
        let reach = (self.reach / h).min(1.0);
        let of = |(i, &contact): (usize, &usize)| {
            let state = &self.states[contact];
            if state.rate >= 0.0 {
                return None;
            }
            let boundary = state.vanishes.iter().position(|vanishes| *vanishes)?;
            let target = Target { contact, boundary };
            if !self.ends_at(target).ends {
                return None;
            }
            let end = &state.boundaries[boundary];
            let compression = Legendre::through(&trial.solved[i].compression);
            let places = std::array::from_fn(|k| reach * (k + 1) as f64 / Q as f64);
            let margins = compression.at_each(&places.map(|place| 1.0 + place)).map(|at| end.margin(at, 0.0));
            let after = margins.iter().position(|margin| *margin <= 0.0)?;
            let (from, before) = match after.checked_sub(1) {
                Some(last) => (places[last], margins[last]),
                None => (0.0, end.margin(state.overlap, 0.0)),
            };
            let place = from + (places[after] - from) * before / (before - margins[after]);
            Some(ExpectedEvent { target, at_s: self.time_s + place * h })
        };
        trial.contacts[..trial.closed].iter().enumerate().find_map(of)
    }

    /// Longest terminal panel that accuracy allows before an event of the compression that is expected after `left`, from the law
    /// along a parabola to the event.
    pub(super) fn accurate_length(&mut self, target: Target, left: f64) -> f64 {
        let state = &self.states[target.contact];
        let Some((touch, (force, _))) = state.touch().and_then(|touch| Some((touch, touch.previous?))) else {
            return f64::INFINITY;
        };
        let (law, tolerance) = (self.law(target.contact), self.impulse_tolerance(target.contact));
        let Some(boundary) = state.boundaries.get(target.boundary) else { return f64::INFINITY };
        if boundary.per_rate != 0.0 || SINGULAR * force.at(1.0) * left <= 0.1 * tolerance {
            return f64::INFINITY;
        }
        let (start, slope) = (state.overlap, state.rate * left);
        let bend = boundary.level / boundary.per_compression - start - slope;
        let force = BASIS.nodes.map(|s| {
            let (compression, moved) = (start + s * (slope + s * bend), slope + 2.0 * s * bend);
            law.force(&touch.branch, compression, moved / left).force_n
        });
        self.counts.law_evaluations += Q as u64;
        let ends = self.ends_at(target);
        let excess = ends.truncation(&ends.quotient(&force)) * left / tolerance;
        if excess > 1.0 { shorter(left, excess, ends) } else { f64::INFINITY }
    }

    /// Advances to the event, which is expected after `expected` seconds and at most `longest` away.
    pub(super) fn advance_to_event(&mut self, target: Target, expected: f64, longest: f64) {
        let mut window = self.window(Some(target.contact), (1.0 + EXTRAPOLATED) * longest);
        let Some(at) = window.contacts.iter().position(|c| *c == target.contact) else {
            return self.refine(self.level + 1);
        };
        let Some(mut landed) = self.panel_to_event(&window, target, at, expected, longest) else {
            // the event is further away than expected: continue until a panel meets it again
            return self.refine((self.level + 1).max(self.tables.steps.level_within(longest)));
        };
        self.watch_window(&mut window, &mut landed);
        let length = landed.length;
        // this panel may have passed over an earlier zero of the same event function, or over another event
        match self.judge_landed(&window, &landed) {
            Judgement::Meets(other, place) if place < 0.99 && (other != target || place > 0.0) => {
                self.expect(other, place, length);
                // a closer guess avoids finding the same end again
                self.level += 1;
                return;
            }
            _ => {}
        }
        let excess = self.excess(&window, &landed);
        if excess > 1.0 {
            self.longest_terminal = shorter(length, excess, self.ends_at(target));
            self.expected = Some(ExpectedEvent { target, at_s: self.time_s + length });
            return self.refine(self.level + 1);
        }
        self.commit_landed(&window, &landed);
        self.transition(target);
    }

    /// The terminal panel of at most `longest` whose end is the event.
    fn panel_to_event(
        &mut self,
        window: &Window,
        target: Target,
        at: usize,
        expected: f64,
        longest: f64,
    ) -> Option<Landed> {
        let state = &self.states[target.contact];
        let initial = self.margin(target, [state.overlap, state.rate, 0.0]).0.max(0.0);
        let mut length = expected.clamp(1e-3 * longest, longest);
        // other forces are truncated or extrapolated, as polynomials
        let ends = self.ends_at(target);
        let of = |c: usize| if c == target.contact { ends } else { Ends::SMOOTH };
        let mut unknowns = self.unknowns_of(window, length, of);
        let (mut bracket, mut largest) = (Bracket::from_start(initial), initial);
        for _ in 0..60 {
            let landed = window.attempt(length, &mut unknowns, &mut self.newton, &mut self.counts)?;
            for (unknown, solved) in unknowns.iter_mut().zip(&landed.solved) {
                unknown.guess = solved.force;
            }
            if let Some(landed) = self.adjusted(window, target, at, &landed) {
                return (landed.length <= longest).then_some(landed);
            }
            let (margin, slope) = self.margin(target, landed.end[at]);
            if margin.abs() <= 1e-13 * initial {
                return Some(landed);
            }
            largest = largest.max(margin.abs());
            bracket.add(length, margin);
            let newton = length - margin / slope;
            length = match bracket.high {
                None if length >= longest => return None,
                None => {
                    // the guess was good if the event is near
                    let near = newton > length && newton <= (1.0 + EXTRAPOLATED) * length;
                    if near { newton } else { 2.0 * length }.min(longest)
                }
                // while forces are stretched with the panel, the rate at its end is not the slope of the event function
                Some((high, _)) => match bracket.next(newton, ends.ends) {
                    // the motion after the event does not depend on these last digits of the time
                    Some(next) if (next - length).abs() > 1e-13 * high => next,
                    // a function that jumps over zero depends on where Newton's method ends: the panel is too long
                    _ => return (margin.abs() <= MET * largest).then_some(landed),
                },
            };
        }
        None
    }

    /// The forces of a terminal panel, truncated, extrapolated or stretched to the point where the motion under them meets the event,
    /// if that point is so close that the laws hold there as they do at the nodes.
    fn adjusted(&self, window: &Window, target: Target, at: usize, from: &Landed) -> Option<Landed> {
        let range = BASIS.nodes[Q - 1] * from.length..=(1.0 + EXTRAPOLATED) * from.length;
        let (mut length, mut end) = (from.length, from.end[at]);
        // a force that is stretched by a part changes by that part
        let stretched = from.solved.get(at).filter(|solved| solved.ends.ends);
        let stretched = stretched.map(|solved| solved.force.iter().fold(0.0f64, |most, force| most.max(force.abs())));
        let defect = NEWTON_SHARE * self.impulse_tolerance(target.contact);
        let near = if stretched.is_some() { 1e-13 } else { 1e-7 };
        for _ in 0..8 {
            let (margin, slope) = self.margin(target, end);
            let next = length - margin / slope;
            if !range.contains(&next) {
                return None;
            }
            if stretched.is_some_and(|force| force * (next - from.length).abs() > defect) {
                return None;
            }
            // the next of Newton's steps would be the square of this one, unless forces are stretched
            if (next - length).abs() <= near * next {
                return Some(window.with_length(from, next));
            }
            (length, end) = (next, window.end(from, at, next));
        }
        None
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

    /// The closed contacts on a terminal panel, and the contact whose closing ends it, with series that hold up to `reach`.
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

    /// The laws of a terminal panel's closed contacts; the free motion is computed for each length that is tried, with its rate where
    /// there is one.
    fn unknowns_of(&self, window: &Window, length: f64, ends: impl Fn(usize) -> Ends) -> Vec<Unknown<'a>> {
        let free = |i: usize| ([0.0; Q], self.states[window.contacts[i]].force_by_rate().then_some([0.0; Q]));
        self.unknowns(&window.contacts[..window.closed], length, free, ends).collect()
    }

    /// How the force of the contact of an event begins and ends on a terminal panel up to it. While other contacts are closed it is
    /// taken for smooth: to truncate or extrapolate all forces costs less than to solve for them once more.
    pub(super) fn ends_at(&self, Target { contact, boundary }: Target) -> Ends {
        let state = &self.states[contact];
        let alone = || self.states.iter().filter(|state| state.is_closed()).count() == 1;
        let ends = state.is_closed() && state.vanishes.get(boundary) == Some(&true) && alone();
        if ends { Ends { ends, ..self.begins(contact) } } else { Ends::SMOOTH }
    }

    fn expect(&mut self, target: Target, place: f64, length: f64) {
        self.counts.rejected_steps += 1;
        if place == 0.0 {
            self.transition(target);
        } else {
            self.expected = Some(ExpectedEvent { target, at_s: self.time_s + place * length });
        }
    }

    /// Tests the event functions of a terminal panel, whose series need no enclosure.
    fn judge_landed(&mut self, window: &Window, landed: &Landed) -> Judgement {
        self.judge(landed.length, &window.contacts, window.closed, &landed.force, &landed.moved, false)
    }

    /// Error of the forces of a terminal panel relative to the allowed error.
    fn excess(&self, window: &Window, landed: &Landed) -> f64 {
        let of = |(i, solved): (usize, &Collocated)| {
            let (truncation, end) = (solved.ends.truncation(&solved.quotient(&landed.force[i])), landed.end[i]);
            self.error(window.contacts[i], truncation, landed.length, (end[0], end[1]))
        };
        landed.solved.iter().enumerate().map(of).fold(0.0, f64::max)
    }

    fn commit_landed(&mut self, window: &Window, landed: &Landed) {
        let (contacts, closed) = (window.contacts.as_slice(), window.closed);
        self.show(landed.length, &contacts[..closed], &landed.force, &landed.solved);
        if self.wants_contact_work() {
            for (i, &c) in contacts[..closed].iter().enumerate() {
                let overlap = landed.moved[i].map(|moved| self.states[c].overlap + moved);
                self.contact_work_j += self.states[c].work_j(&landed.force[i], &overlap, landed.end[i][0]);
            }
        }
        window.advance(self.system, landed, &mut self.amplitude, &mut self.rate);
        self.pass(landed.length);
        self.accept(landed.length, contacts, closed, &landed.solved, &landed.force, |i| {
            (landed.end[i][0], landed.end[i][1])
        });
    }
}
