//! Terminal panels, whose length is unknown. They end at an event, a break of the loads, the start of the
//! statistics or the end of the run.

use super::collocate::{Collocated, Unknown};
use super::first_panel::SINGULAR;
use super::judge::{Judgement, NEAR_END};
use super::motion::{Crossing, ExpectedEvent, March};
use super::rounding::above_rounding;
use super::terminal::{Solved, TerminalPanel};
use super::trial::{NEWTON_SHARE, Trial};
use crate::panel::ends::Ends;
use crate::panel::legendre::{BASIS, Legendre, Q};

/// The error of a terminal panel grows with this power of its length at least, in general and where a force ends as
/// `(t - end)^(3/2)` and is represented so.
const ORDER: f64 = 2.5;
const ORDER_WEIGHTED: f64 = 5.0;
/// An event function has fallen to zero where it is smaller than this part of its largest value.
const MET: f64 = 1e-3;
/// A force that was solved on one length is used for others as long as it is extrapolated by no more than this part.
const EXTRAPOLATED: f64 = 0.05;

/// Length of a terminal panel with the allowed error, if the error with this length is too large by this factor.
fn shorter(length: f64, excess: f64, ends: Ends) -> f64 {
    let power = if ends.at_end { ORDER_WEIGHTED } else { ORDER };
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
        let mut panel = self.terminal_panel(None, length);
        let mut unknowns = self.unknowns_of(&panel, length, |c| self.begins(c));
        let Some(mut solved) = panel.attempt(length, &mut unknowns, &mut self.newton, &mut self.counts) else {
            return self.refine_within(length);
        };
        self.watch_panel(&mut panel, &mut solved);
        match self.judge_solved(&panel, &solved, None) {
            Judgement::Meets(crossing, place) => self.expect(crossing, place, length),
            _ if self.excess(&panel, &solved) > 1.0 => self.refine_within(length),
            _ => self.commit_solved(&panel, &solved),
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
            let crossing = Crossing { contact, boundary };
            if !self.ends_at(crossing).at_end {
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
            Some(ExpectedEvent { crossing, at_s: self.time_s + place * h })
        };
        trial.contacts[..trial.closed].iter().enumerate().find_map(of)
    }

    /// Longest terminal panel that accuracy allows before an event of the compression that is expected after `left`, from the law
    /// along a parabola to the event.
    pub(super) fn accurate_length(&mut self, crossing: Crossing, left: f64) -> f64 {
        let state = &self.states[crossing.contact];
        let Some((contact, (force, _))) = state.closed_contact().and_then(|contact| Some((contact, contact.previous?)))
        else {
            return f64::INFINITY;
        };
        let (law, tolerance) = (self.law(crossing.contact), self.impulse_tolerance(crossing.contact));
        let Some(boundary) = state.boundaries.get(crossing.boundary) else { return f64::INFINITY };
        if boundary.per_rate != 0.0 || SINGULAR * force.at(1.0) * left <= 0.1 * tolerance {
            return f64::INFINITY;
        }
        let (start, slope) = (state.overlap, state.rate * left);
        let bend = boundary.level / boundary.per_compression - start - slope;
        let force = BASIS.nodes.map(|s| {
            let (compression, moved) = (start + s * (slope + s * bend), slope + 2.0 * s * bend);
            law.force(&contact.branch, compression, moved / left).force_n
        });
        self.counts.law_evaluations += Q as u64;
        let ends = self.ends_at(crossing);
        let excess = ends.truncation(&ends.quotient(&force)) * left / tolerance;
        if excess > 1.0 { shorter(left, excess, ends) } else { f64::INFINITY }
    }

    /// Advances to the event, which is expected after `expected` seconds and at most `longest` away.
    pub(super) fn advance_to_event(&mut self, mut crossing: Crossing, expected: f64, longest: f64) {
        let mut panel = self.terminal_panel(Some(crossing.contact), (1.0 + EXTRAPOLATED) * longest);
        let Some(at) = panel.contacts.iter().position(|c| *c == crossing.contact) else {
            return self.refine(self.level + 1);
        };
        let Some(mut solved) = self.panel_to_event(&panel, crossing, at, expected, longest) else {
            // the event is further away than expected: continue until a panel meets it again
            return self.refine((self.level + 1).max(self.tables.steps.level_within(longest)));
        };
        self.watch_panel(&mut panel, &mut solved);
        // This panel may have passed over an earlier zero of the same event function, or over another event. An event function is a
        // polynomial with fewer than Q zeros on the panel, and ends it at most that many times. Beyond that, events exchange their order
        // from one solution to the next. They are as close to each other as their times are known, and the other one follows at once.
        let mut passed = Vec::new();
        while let Judgement::Meets(other, place) = self.judge_solved(&panel, &solved, Some(crossing)) {
            if other == crossing && place == 0.0 {
                break;
            }
            if place < NEAR_END {
                self.expect(other, place, solved.length);
                // a closer guess avoids finding the same end again
                self.level += 1;
                return;
            }
            if passed.iter().filter(|one| **one == other).count() >= Q {
                break;
            }
            // the places of both events are not known well enough to tell which is the first, but their times are
            let Some(at) = panel.contacts.iter().position(|c| *c == other.contact) else { break };
            let (expected, longest) = (place * solved.length, solved.length);
            let found = self.panel_to_event(&panel, other, at, expected, longest);
            let Some(mut earlier) = found.filter(|found| found.length < longest) else { break };
            panel.look(&mut earlier);
            passed.push(crossing);
            (crossing, solved) = (other, earlier);
        }
        let length = solved.length;
        let excess = self.excess(&panel, &solved);
        if excess > 1.0 {
            self.longest_terminal = shorter(length, excess, self.ends_at(crossing));
            self.expected = Some(ExpectedEvent { crossing, at_s: self.time_s + length });
            return self.refine(self.level + 1);
        }
        self.commit_solved(&panel, &solved);
        self.transition(crossing);
    }

    /// The terminal panel of at most `longest` whose end is the event.
    fn panel_to_event(
        &mut self,
        panel: &TerminalPanel,
        crossing: Crossing,
        at: usize,
        expected: f64,
        longest: f64,
    ) -> Option<Solved> {
        let state = &self.states[crossing.contact];
        let initial = self.margin(crossing, [state.overlap, state.rate, 0.0]).0.max(0.0);
        let mut length = expected.clamp(1e-3 * longest, longest);
        // other forces are truncated or extrapolated, as polynomials
        let ends = self.ends_at(crossing);
        let of = |c: usize| if c == crossing.contact { ends } else { Ends::SMOOTH };
        let mut unknowns = self.unknowns_of(panel, length, of);
        let (mut bracket, mut largest) = (Bracket::from_start(initial), initial);
        for _ in 0..60 {
            let solved = panel.attempt(length, &mut unknowns, &mut self.newton, &mut self.counts)?;
            for (unknown, own) in unknowns.iter_mut().zip(&solved.collocated) {
                unknown.guess = own.force;
            }
            if let Some(solved) = self.adjusted(panel, crossing, at, &solved) {
                return (solved.length <= longest).then_some(solved);
            }
            let (margin, slope) = self.margin(crossing, solved.end[at]);
            if margin.abs() <= 1e-13 * initial {
                return Some(solved);
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
                Some((high, _)) => match bracket.next(newton, ends.at_end) {
                    // the motion after the event does not depend on these last digits of the time
                    Some(next) if (next - length).abs() > 1e-13 * high => next,
                    // a function that jumps over zero depends on where Newton's method ends: the panel is too long
                    _ => return (margin.abs() <= MET * largest).then_some(solved),
                },
            };
        }
        None
    }

    /// The forces of a terminal panel, truncated, extrapolated or stretched to the point where the motion under them meets the event,
    /// if that point is so close that the laws hold there as they do at the nodes.
    fn adjusted(&self, panel: &TerminalPanel, crossing: Crossing, at: usize, from: &Solved) -> Option<Solved> {
        let range = BASIS.nodes[Q - 1] * from.length..=(1.0 + EXTRAPOLATED) * from.length;
        let (mut length, mut end) = (from.length, from.end[at]);
        // a force that is stretched by a part changes by that part
        let stretched = from.collocated.get(at).filter(|own| own.ends.at_end);
        let stretched = stretched.map(|own| own.force.iter().fold(0.0f64, |most, force| most.max(force.abs())));
        let defect = NEWTON_SHARE * self.impulse_tolerance(crossing.contact);
        let near = if stretched.is_some() { 1e-13 } else { 1e-7 };
        for _ in 0..8 {
            let (margin, slope) = self.margin(crossing, end);
            let next = length - margin / slope;
            if !range.contains(&next) {
                return None;
            }
            if stretched.is_some_and(|force| force * (next - from.length).abs() > defect) {
                return None;
            }
            // the next of Newton's steps would be the square of this one, unless forces are stretched
            if (next - length).abs() <= near * next {
                return Some(panel.with_length(from, next));
            }
            (length, end) = (next, panel.end(from, at, next));
        }
        None
    }

    /// Adds the open contacts that may close on a terminal panel that is solved.
    fn watch_panel(&mut self, panel: &mut TerminalPanel, solved: &mut Solved) {
        let mut contacts = panel.contacts.clone();
        self.watch(solved.length, &mut contacts, panel.closed, &solved.force);
        for &c in &contacts[panel.contacts.len()..] {
            self.add(panel, c);
        }
        panel.look(solved);
    }

    /// The closed contacts on a terminal panel, and the contact whose closing ends it, with series that hold up to `reach`.
    fn terminal_panel(&mut self, closing: Option<usize>, reach: f64) -> TerminalPanel {
        let mut contacts = Vec::new();
        self.closed(&mut contacts);
        let overlaps: Vec<f64> = contacts.iter().map(|&c| self.states[c].overlap).collect();
        let moment = (self.time_s, self.amplitude.as_slice(), self.rate.as_slice());
        let mut panel = TerminalPanel::new(self.system, self.tables, &self.loads, (contacts, &overlaps, reach), moment);
        if let Some(c) = closing.filter(|&c| !self.states[c].is_closed()) {
            (self.states[c].overlap, self.states[c].rate) = self.overlap_of_modes(c);
            self.add(&mut panel, c);
        }
        panel
    }

    fn add(&mut self, panel: &mut TerminalPanel, c: usize) {
        let moment = (self.time_s, self.amplitude.as_slice(), self.rate.as_slice());
        panel.add(self.system, self.tables, &self.loads, (c, self.states[c].overlap), moment);
    }

    /// The laws of a terminal panel's closed contacts; the free motion is computed for each length that is tried, with its rate where
    /// there is one.
    fn unknowns_of(&self, panel: &TerminalPanel, length: f64, ends: impl Fn(usize) -> Ends) -> Vec<Unknown<'a>> {
        let free = |i: usize| ([0.0; Q], self.states[panel.contacts[i]].force_by_rate().then_some([0.0; Q]));
        self.unknowns(&panel.contacts[..panel.closed], length, free, ends).collect()
    }

    /// How the force of the contact of an event begins and ends on a terminal panel up to it. While other contacts are closed it is
    /// taken for smooth: to truncate or extrapolate all forces costs less than to solve for them once more.
    pub(super) fn ends_at(&self, Crossing { contact, boundary }: Crossing) -> Ends {
        let state = &self.states[contact];
        let alone = || self.states.iter().filter(|state| state.is_closed()).count() == 1;
        let ends = state.is_closed() && state.vanishes.get(boundary) == Some(&true) && alone();
        if ends { Ends { at_end: true, ..self.begins(contact) } } else { Ends::SMOOTH }
    }

    fn expect(&mut self, crossing: Crossing, place: f64, length: f64) {
        self.counts.rejected_steps += 1;
        if place == 0.0 {
            self.transition(crossing);
        } else {
            self.expected = Some(ExpectedEvent { crossing, at_s: self.time_s + place * length });
        }
    }

    /// Tests the event functions of a terminal panel, whose series need no enclosure.
    fn judge_solved(&mut self, panel: &TerminalPanel, solved: &Solved, ends_at: Option<Crossing>) -> Judgement {
        self.judge(solved.length, (&panel.contacts, panel.closed), &solved.force, &solved.moved, false, ends_at)
    }

    /// Error of the forces of a terminal panel relative to the allowed error.
    fn excess(&self, panel: &TerminalPanel, solved: &Solved) -> f64 {
        let of = |(i, own): (usize, &Collocated)| {
            let (truncation, end) = (own.ends.truncation(&own.quotient(&solved.force[i])), solved.end[i]);
            self.error(panel.contacts[i], above_rounding(truncation, &own.force), solved.length, (end[0], end[1]))
        };
        solved.collocated.iter().enumerate().map(of).fold(0.0, f64::max)
    }

    fn commit_solved(&mut self, panel: &TerminalPanel, solved: &Solved) {
        let (contacts, closed) = (panel.contacts.as_slice(), panel.closed);
        self.show(solved.length, &contacts[..closed], &solved.force, &solved.collocated);
        if self.wants_contact_work() {
            for (i, &c) in contacts[..closed].iter().enumerate() {
                let overlap = solved.moved[i].map(|moved| self.states[c].overlap + moved);
                self.contact_work_j += self.states[c].work_j(&solved.force[i], &overlap, solved.end[i][0]);
            }
        }
        panel.advance(self.system, solved, &mut self.amplitude, &mut self.rate);
        self.pass(solved.length);
        self.accept(solved.length, contacts, closed, &solved.collocated, &solved.force, |i| {
            (solved.end[i][0], solved.end[i][1])
        });
    }
}
