//! Transitions: a contact closes, passes from one branch of its law to the next, or opens. Each transition is an instantaneous
//! event of the run.

use super::dense::Event;
use super::enclosure::first_difference;
use super::motion::{Crossing, March};
use super::solution::Interval;
use super::state::{ClosedContact, Phase, State};
use super::terminal::series_of;
use crate::panel::ends::EXPONENT;
use crate::panel::peak::Peak;
use contact_models::{After, Boundary, Branch, ContactLaw, Memory, boundaries};

/// A force is taken for one that grows as the power of 3/2 if it does so from once to twice this part of the contact's scale, and how
/// closely (relative).
const NEAR: f64 = 1e-3;
const ALIKE: f64 = 1e-3;

/// Largest number of boundaries that a contact passes as it begins.
const MOST_PASSED: usize = 16;

/// The branch on which fresh surfaces are that overlap at the start; `None` if they separate at once.
pub(super) fn branch_at_start(law: &dyn ContactLaw, overlap: f64, rate: f64) -> Option<Branch> {
    let mut branch = law.touch(&Memory::default(), rate.max(0.0));
    for _ in 0..MOST_PASSED {
        let Some(passed) = boundaries(law, &branch).position(|end| end.margin(overlap, rate) < 0.0) else { break };
        match law.cross(&branch, passed, overlap, rate) {
            After::Continue(next) => branch = next,
            After::Release(_) => return None,
        }
    }
    Some(branch)
}

impl<'a> March<'a> {
    /// Contacts that touch at the start close at once, unless nothing can move them or press them together.
    pub(super) fn begin(&mut self) {
        self.depart();
        for c in 0..self.states.len() {
            let (overlap, rate) = self.overlap_of_modes(c);
            (self.states[c].overlap, self.states[c].rate) = (overlap, rate);
            self.states[c].inverse_mass = self.system.inverse_mass(c);
            self.states[c].momentum = self.momentum_of_loads(c);
        }
        // compressed contacts first, and the fastest first of these and of the others, since their speed is the scale for contacts
        // that touch without speed
        let is_pressed: Vec<bool> =
            (0..self.states.len()).map(|c| self.states[c].overlap > self.overlap_rounding(c)).collect();
        let mut order: Vec<usize> = (0..self.states.len()).collect();
        order.sort_by(|&one, &other| {
            let rates = self.states[other].rate.total_cmp(&self.states[one].rate);
            is_pressed[other].cmp(&is_pressed[one]).then(rates)
        });
        for c in order {
            let rounding = self.overlap_rounding(c);
            if self.states[c].overlap > rounding {
                self.close(c, self.states[c].overlap);
                self.pass_boundaries(c);
            } else if self.states[c].overlap >= -rounding && self.system.links[c].mobility > 0.0 && self.may_press(c) {
                // without rigid-body motion the surfaces vibrate, and their speed now is only a part of the scale of a vibration
                if self.system.links[c].rigid.is_empty() && self.states[c].inverse_mass > 0.0 {
                    let vibration = self.speed_of_displaced_modes(c) / self.states[c].inverse_mass;
                    self.states[c].momentum = self.states[c].momentum.max(vibration);
                }
                self.close(c, 0.0);
            }
        }
    }

    /// Surfaces that overlap at the start may be beyond boundaries of the branch with which a contact begins, as a dashpot that would
    /// pull.
    fn pass_boundaries(&mut self, c: usize) {
        for _ in 0..MOST_PASSED {
            let State { overlap, rate, boundaries, .. } = &self.states[c];
            let Some(boundary) = boundaries.iter().position(|end| end.margin(*overlap, *rate) < 0.0) else { return };
            self.transition(Crossing { contact: c, boundary });
            // unlike a boundary that was located, these may be far behind
            if let Some(contact) = self.states[c].closed_contact_mut() {
                (contact.residue, contact.rate_residue) = (0.0, 0.0);
            }
        }
    }

    /// Whether surfaces that touch begin to press on each other, or may do so by loads and other contacts. Surfaces that only move
    /// along together do not.
    fn may_press(&self, c: usize) -> bool {
        let reach = self.reach.min(self.settings.end_s);
        // rigid bodies alone have no time scale
        let reach = if reach.is_finite() { reach } else { 1.0 };
        let mut series = series_of(self.system, &self.loads, c, self.moment(), reach);
        series[0] = 0.0;
        match first_difference(&series, reach, (self.overlap_rounding(c), self.rate_rounding(c))) {
            Some((_, overlap)) => overlap > 0.0,
            None => !self.loads.is_empty() || self.states.len() > 1,
        }
    }

    /// Closes a contact of two surfaces that meet now, with this overlap beyond that of touch.
    pub(super) fn close(&mut self, c: usize, beyond: f64) {
        let law = self.law(c);
        let Phase::Open { memory, .. } = self.states[c].phase else { return };
        self.turns_at_s = f64::INFINITY;
        let (overlap, _) = self.overlap_of_modes(c);
        let state = &mut self.states[c];
        state.overlap = memory.touch_m + beyond;
        state.reference += state.overlap - overlap;
        if beyond == 0.0 {
            state.rate = state.rate.max(0.0);
        }
        let interval = Interval {
            start_s: self.time_s,
            end_s: None,
            impulse_n_s: 0.0,
            peak_force_n: 0.0,
            peak_compression_m: 0.0,
            approach_speed_m_s: state.rate,
            separation_speed_m_s: None,
        };
        let branch = law.touch(&memory, state.rate.max(0.0));
        // of surfaces that overlap at the start
        let stored_j = if beyond > 0.0 { law.stored_energy_j(&branch, state.overlap) } else { 0.0 };
        state.phase = Phase::Closed(Box::new(ClosedContact {
            branch,
            ends_by_rate: false,
            force_by_rate: true,
            residue: 0.0,
            rate_residue: 0.0,
            begins: false,
            previous: None,
            interval,
            peak_force: Peak::NONE,
            peak_compression: Peak::NONE,
        }));
        self.expect_momentum(c, stored_j);
        self.enter(c, branch);
        // of forces that begin together, a small change lets one begin within the panel of the other
        let others = self.states.iter_mut().enumerate().filter(|(other, _)| *other != c);
        let mut together = false;
        for contact in
            others.filter_map(|(_, other)| other.closed_contact_mut()).filter(|contact| contact.previous.is_none())
        {
            (contact.begins, together) = (false, true);
        }
        let begins = beyond == 0.0 && !together && self.begins_singular(c);
        if let Some(contact) = self.states[c].closed_contact_mut() {
            contact.begins = begins;
        }
        let first = self.level_at_touch(c);
        let alone = self.states.iter().filter(|state| state.is_closed()).count() == 1;
        self.level = if alone { first } else { self.level.max(first) };
        self.event(c, Event::Close { overlaps: beyond > 0.0 });
    }

    fn enter(&mut self, c: usize, branch: Branch) {
        let law = self.law(c);
        let state = &mut self.states[c];
        state.boundaries.clear();
        state.boundaries.extend(boundaries(law, &branch));
        if let Phase::Closed(contact) = &mut state.phase {
            contact.branch = branch;
            contact.ends_by_rate = state.boundaries.iter().any(|boundary| boundary.per_rate != 0.0);
            contact.begins = false;
        }
        let by_rate = self.depends_on_rate(c);
        if let Some(contact) = self.states[c].closed_contact_mut() {
            contact.force_by_rate = by_rate;
        }
        let mut vanishes = std::mem::take(&mut self.states[c].vanishes);
        vanishes.clear();
        for which in 0..self.states[c].boundaries.len() {
            let Boundary { per_compression, per_rate, level } = self.states[c].boundaries[which];
            vanishes
                .push(per_rate == 0.0 && per_compression > 0.0 && self.is_singular(c, level / per_compression, 0.0));
        }
        self.states[c].vanishes = vanishes;
        self.discard_predictions();
    }

    /// Whether the force of a closed contact may depend on the rate: it does on its whole branch or nowhere, as one of its values tells
    /// that is not zero.
    fn depends_on_rate(&mut self, c: usize) -> bool {
        let (state, law) = (&self.states[c], self.law(c));
        let (Some(contact), Some((scale, speed))) = (state.closed_contact(), state.scales()) else { return true };
        // the branch begins on a boundary, beyond which the law only continues it
        let beside = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(by_overlap, by_rate)| {
            (state.overlap + by_overlap * NEAR * scale, state.rate + by_rate * NEAR * speed)
        });
        let within =
            |(overlap, rate): &(f64, f64)| state.boundaries.iter().all(|end| end.margin(*overlap, *rate) > 0.0);
        let Some((overlap, rate)) = beside.into_iter().find(within) else { return true };
        self.counts.law_evaluations += 1;
        let force = law.force(&contact.branch, overlap, rate);
        force.force_n == 0.0 || force.per_rate_n_s_m != 0.0
    }

    /// Whether the force of a contact that has just closed begins as `t^(3/2)`: its surfaces approach, and its force grows so.
    fn begins_singular(&mut self, c: usize) -> bool {
        let State { overlap, rate, .. } = self.states[c];
        rate > 0.0 && self.is_singular(c, overlap, rate)
    }

    /// Whether the force of a closed contact grows from this compression on as its power of 3/2.
    fn is_singular(&mut self, c: usize, from: f64, rate: f64) -> bool {
        let Some((scale, _)) = self.states[c].scales() else { return false };
        let mut at = |part: f64| self.force_at(c, (from + part * NEAR * scale, rate));
        let (near, far) = (at(1.0), at(2.0));
        near > 0.0 && (far / near - 2f64.powf(EXPONENT)).abs() < ALIKE * far / near
    }

    /// The transition at a zero of an event function.
    pub(super) fn transition(&mut self, crossing: Crossing) {
        let c = crossing.contact;
        let law = self.law(c);
        let Some(contact) = self.states[c].closed_contact() else {
            return self.close(c, 0.0);
        };
        let Some(&boundary) = self.states[c].boundaries.get(crossing.boundary) else { return };
        let (residue, rate_residue) = self.states[c].beside(&boundary);
        match law.cross(&contact.branch, crossing.boundary, self.states[c].overlap, self.states[c].rate) {
            After::Continue(branch) => {
                self.enter(c, branch);
                if let Some(contact) = self.states[c].closed_contact_mut() {
                    (contact.residue, contact.rate_residue) = (residue, rate_residue);
                }
                let relaxed = self.level_of_relaxation(c);
                self.level = self.level.max(relaxed);
                self.event(c, Event::Cross(crossing.boundary));
            }
            After::Release(memory) => {
                let (overlap, _) = self.overlap_of_modes(c);
                let (now, rate) = (self.time_s, self.states[c].rate);
                // surfaces that part where they have met, under the forces of other contacts, were not in contact
                let interval_s = now - contact.interval.start_s;
                let lasted = interval_s > 0.0;
                if lasted && let Some(interval) = self.states[c].finish(law, Some((now, rate))) {
                    self.observer.interval(c, &interval);
                    self.intervals += 1;
                }
                let state = &mut self.states[c];
                // the law determines where the surfaces separate, not the sum over the modes
                if state.overlap <= memory.touch_m + residue {
                    state.overlap = state.overlap.min(memory.touch_m);
                }
                state.reference += state.overlap - overlap;
                state.phase = Phase::Open { memory, clear_until: now, bounds: None };
                self.discard_predictions();
                self.depart();
                self.turns_at_s = self.time_of_turning_s();
                self.wait_after_opening(interval_s);
                self.event(c, Event::Cross(crossing.boundary));
            }
        }
    }

    /// A contact has opened: the motion that follows is free.
    fn depart(&mut self) {
        if self.settings.stop_when_over {
            self.departure.0 = self.time_s;
            self.departure.1.clone_from(&self.amplitude);
            self.departure.2.clone_from(&self.rate);
        }
    }

    fn event(&mut self, c: usize, event: Event) {
        if self.record.is_some() {
            self.pending.push((c, event));
        }
        self.counts.events += 1;
        self.events_at_once = if self.time_s > self.last_event_s { 0 } else { self.events_at_once + 1 };
        self.last_event_s = self.time_s;
    }
}
