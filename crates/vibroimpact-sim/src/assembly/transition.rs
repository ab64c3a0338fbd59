//! Transitions: a contact closes, passes from one branch of its law to the next, or opens. Each transition is an instantaneous
//! event of the run.

use super::dense::Event;
use super::enclosure::{Held, first_difference, of_panel};
use super::motion::{March, Target};
use super::solution::Interval;
use super::state::{Phase, State, Touch};
use super::terminal::{series_of, value};
use crate::panel::dyadic::{J_MAX, J_MIN};
use crate::panel::ends::EXPONENT;
use crate::panel::peak::Peak;
use contact_models::{After, Boundary, Branch, ContactLaw, Memory, boundaries};

/// Bound on the relative error of the polynomial through the nodes for `t^(3/2)`, a force at first touch, and its derivatives.
pub(super) const SINGULAR: f64 = 2.5e-4;
/// Where the force is represented as `t^(3/2)` times a polynomial, the error of a first panel's impulse relative to the momentum is
/// this times the square of that impulse relative to the momentum.
const WEIGHTED: f64 = 4e-6;

/// A first panel beyond the reach of the series may have this share of the impulse that accuracy allows, which makes it four times shorter.
const EXTRAPOLATED: f64 = 1.0 / 32.0;
/// On such a panel the polynomial may miss this share of the speed of approach. If it missed more, it could not be told whether the
/// surfaces part at once.
const UNCERTAIN: f64 = 0.5;

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
        let is_pressed: Vec<bool> = (0..self.states.len()).map(|c| self.states[c].overlap > self.noise(c)).collect();
        let mut order: Vec<usize> = (0..self.states.len()).collect();
        order.sort_by(|&one, &other| {
            let rates = self.states[other].rate.total_cmp(&self.states[one].rate);
            is_pressed[other].cmp(&is_pressed[one]).then(rates)
        });
        for c in order {
            let noise = self.noise(c);
            if self.states[c].overlap > noise {
                self.touch(c, self.states[c].overlap);
                self.pass_boundaries(c);
            } else if self.states[c].overlap >= -noise && self.system.links[c].mobility > 0.0 && self.may_press(c) {
                // without rigid-body motion the surfaces vibrate, and their speed now is only a part of the scale of a vibration
                if self.system.links[c].rigid.is_empty() && self.states[c].inverse_mass > 0.0 {
                    let vibration = self.speed_of_displaced_modes(c) / self.states[c].inverse_mass;
                    self.states[c].momentum = self.states[c].momentum.max(vibration);
                }
                self.touch(c, 0.0);
            }
        }
    }

    /// Surfaces that overlap at the start may be beyond boundaries of the branch with which a contact begins, as a dashpot that would
    /// pull.
    fn pass_boundaries(&mut self, c: usize) {
        for _ in 0..MOST_PASSED {
            let State { overlap, rate, ends, .. } = &self.states[c];
            let Some(boundary) = ends.iter().position(|end| end.margin(*overlap, *rate) < 0.0) else { return };
            self.transition(Target { contact: c, boundary });
            // unlike a boundary that was located, these may be far behind
            if let Some(touch) = self.states[c].touch_mut() {
                (touch.residue, touch.rate_residue) = (0.0, 0.0);
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
        match first_difference(&series, reach, (self.noise(c), self.rate_noise(c))) {
            Some((_, overlap)) => overlap > 0.0,
            None => !self.loads.is_empty() || self.states.len() > 1,
        }
    }

    /// The relative speed that displaced modes can give the surfaces of a contact (m/s).
    fn speed_of_displaced_modes(&self, c: usize) -> f64 {
        let displaced = |(k, psi): &(usize, f64)| (psi * self.system.omega[*k] * self.amplitude[*k]).abs();
        self.system.links[c].elastic.iter().map(displaced).sum()
    }

    /// The momentum that the loads give a contact during its deformation (N s), a scale for contacts that only loads have closed.
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

    /// Closes a contact of two surfaces that meet now, with this overlap beyond that of touch.
    pub(super) fn touch(&mut self, c: usize, beyond: f64) {
        let law = self.law(c);
        let Phase::Open { memory, .. } = self.states[c].phase else { return };
        let (overlap, _) = self.overlap_of_modes(c);
        let link = &self.system.links[c];
        let mobility = link.mobility;
        // the speed of approach of the bodies without their vibrations, whose effective masses are small
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
            ends_by_rate: false,
            force_by_rate: true,
            residue: 0.0,
            rate_residue: 0.0,
            begins: false,
            previous: None,
            interval,
            peak_force: Peak::NONE,
            peak_compression: Peak::NONE,
        };
        // for surfaces that overlap at the start, the momentum from their compression
        let stored_j = if beyond > 0.0 { law.stored_energy_j(&touch.branch, state.overlap) } else { 0.0 };
        let speed = rigid.abs().max((2.0 * stored_j * inverse).sqrt());
        let momentum =
            if inverse > 0.0 { speed / inverse + (approach_speed_m_s - rigid).abs() / mobility } else { 0.0 };
        state.phase = Phase::Closed(Box::new(touch));
        state.momentum = state.momentum.max(momentum);
        if state.momentum == 0.0 && inverse > 0.0 {
            // it has no speed of its own: the momentum that it will transmit is that of the other contacts or, at rest, that which
            // displaced modes can give it
            let others = self.states.iter().map(State::speed_m_s).fold(0.0, f64::max);
            let speed = if others > 0.0 { others } else { self.speed_of_displaced_modes(c) };
            self.states[c].momentum = speed / inverse;
        }
        let alone = self.states.iter().filter(|state| state.is_closed()).count() == 1;
        let branch = self.states[c].touch().map(|touch| touch.branch);
        if let Some(branch) = branch {
            self.enter(c, branch);
        }
        // of forces that begin together, a small change lets one begin within the panel of the other
        let others = self.states.iter_mut().enumerate().filter(|(other, _)| *other != c);
        let mut together = false;
        for touch in others.filter_map(|(_, other)| other.touch_mut()).filter(|touch| touch.previous.is_none()) {
            (touch.begins, together) = (false, true);
        }
        let begins = beyond == 0.0 && !together && self.begins_singular(c);
        if let Some(touch) = self.states[c].touch_mut() {
            touch.begins = begins;
        }
        let first = self.first_level(c);
        self.level = if alone { first } else { self.level.max(first) };
        self.event(c, Event::Touch { overlaps: beyond > 0.0 });
    }

    fn enter(&mut self, c: usize, branch: Branch) {
        let law = self.law(c);
        let State { phase, ends, .. } = &mut self.states[c];
        ends.clear();
        ends.extend(boundaries(law, &branch));
        if let Phase::Closed(touch) = phase {
            touch.branch = branch;
            touch.ends_by_rate = ends.iter().any(|boundary| boundary.per_rate != 0.0);
            touch.begins = false;
        }
        let by_rate = self.depends_on_rate(c);
        if let Some(touch) = self.states[c].touch_mut() {
            touch.force_by_rate = by_rate;
        }
        let mut vanishes = std::mem::take(&mut self.states[c].vanishes);
        vanishes.clear();
        for which in 0..self.states[c].ends.len() {
            let Boundary { per_compression, per_rate, level } = self.states[c].ends[which];
            vanishes
                .push(per_rate == 0.0 && per_compression > 0.0 && self.is_singular(c, level / per_compression, 0.0));
        }
        self.states[c].vanishes = vanishes;
        self.forget_horizons();
    }

    /// Whether the force of a closed contact may depend on the rate: it does on its whole branch or nowhere, as one of its values tells
    /// that is not zero.
    fn depends_on_rate(&mut self, c: usize) -> bool {
        let (state, law) = (&self.states[c], self.law(c));
        let (Some(touch), Some((scale, speed))) = (state.touch(), state.scales()) else { return true };
        // the branch begins on a boundary, beyond which the law only continues it
        let beside = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(by_overlap, by_rate)| {
            (state.overlap + by_overlap * NEAR * scale, state.rate + by_rate * NEAR * speed)
        });
        let within = |(overlap, rate): &(f64, f64)| state.ends.iter().all(|end| end.margin(*overlap, *rate) > 0.0);
        let Some((overlap, rate)) = beside.into_iter().find(within) else { return true };
        self.counts.law_evaluations += 1;
        let force = law.force(&touch.branch, overlap, rate);
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
    pub(super) fn transition(&mut self, target: Target) {
        let c = target.contact;
        let law = self.law(c);
        let Some(touch) = self.states[c].touch() else {
            return self.touch(c, 0.0);
        };
        let Some(&boundary) = self.states[c].ends.get(target.boundary) else { return };
        let (residue, rate_residue) = self.states[c].beside(&boundary);
        match law.cross(&touch.branch, target.boundary, self.states[c].overlap, self.states[c].rate) {
            After::Continue(branch) => {
                self.enter(c, branch);
                if let Some(touch) = self.states[c].touch_mut() {
                    (touch.residue, touch.rate_residue) = (residue, rate_residue);
                }
                let relaxing = self.relaxing(c);
                self.level = self.level.max(relaxing);
                self.event(c, Event::Cross(target.boundary));
            }
            After::Release(memory) => {
                let (overlap, _) = self.overlap_of_modes(c);
                let (now, rate) = (self.time_s, self.states[c].rate);
                // surfaces that part where they have met, under the forces of other contacts, were not in contact
                let lasted = touch.interval.start_s < now;
                if lasted && let Some(interval) = self.states[c].finish(Some((now, rate))) {
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
                self.forget_horizons();
                self.depart();
                self.event(c, Event::Cross(target.boundary));
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

    /// Step exponent of the longest panel within the time constant of a contact's dashpot. At the begin of a branch the rate is not yet
    /// the one to which a strong dashpot forces it. On longer panels the force would oscillate, and seem to end.
    fn relaxing(&mut self, c: usize) -> i32 {
        let state = &self.states[c];
        let Some(touch) = state.touch() else { return J_MIN };
        self.counts.law_evaluations += 1;
        let drag = self.law(c).force(&touch.branch, state.overlap, state.rate).per_rate_n_s_m.abs();
        self.tables.steps.level_within((drag * self.system.links[c].mobility).recip())
    }

    /// Step exponent of the longest panel on which a force that begins at first touch is represented within the tolerance.
    fn first_level(&self, c: usize) -> i32 {
        let Some(touch) = self.states[c].touch() else { return J_MIN };
        let mut series = series_of(self.system, &self.loads, c, self.moment(), self.reach);
        series[0] = self.states[c].overlap;
        let largest = series.map(f64::abs);
        let law = self.law(c);
        let tolerance = self.impulse_tolerance(c);
        let allowed = match touch.begins {
            true => (tolerance * self.states[c].momentum / WEIGHTED).sqrt(),
            false => tolerance / SINGULAR,
        };
        let at_end = |j: i32| {
            let h = self.tables.steps.step_s(j);
            let within = h.min(self.reach);
            let [mut compression, mut rate, _] = value(&series, within);
            if rate < 0.0 {
                // the surfaces approach and recede within the panel: the end does not tell how far they overlap before
                [compression, rate, _] = value(&largest, within);
            }
            (h, compression + rate.max(0.0) * (h - within), rate)
        };
        let small = |j: i32, allowed: f64| {
            let (h, compression, rate) = at_end(j);
            law.force(&touch.branch, compression, rate).force_n * h <= allowed
        };
        // the force at the end of a panel grows with the panel
        let known = if self.reach.is_finite() { self.tables.steps.level_within(4.0 * self.reach) } else { J_MIN };
        let (mut coarse, mut fine, mut ahead) = (known, known, 1);
        while fine < J_MAX && !small(fine, allowed) {
            (coarse, fine, ahead) = (fine + 1, (fine + ahead).min(J_MAX), 2 * ahead);
        }
        while coarse < fine {
            let middle = coarse + (fine - coarse) / 2;
            if small(middle, allowed) { fine = middle } else { coarse = middle + 1 }
        }
        // beyond the reach of the fastest modes the compression is extrapolated; they hardly matter to a force that is represented as it
        // begins, unless they vibrate
        let mut held = Held::default();
        let mut follows = |j: i32| {
            let (h, compression, rate) = at_end(j);
            let (missed, motion) = (self.tables.missed(self.system, j), (&*self.amplitude, &*self.rate));
            let [missed, slope, _] = of_panel(self.system, missed, &self.loads, c, h, motion, (&[], &mut held));
            let force = |overlap: f64, rate: f64| law.force(&touch.branch, overlap, rate).force_n;
            let error = force(compression + missed, rate + slope / h) - force(compression, rate);
            slope <= UNCERTAIN * self.states[c].rate * h && error * h <= tolerance
        };
        while touch.begins
            && (J_MIN + 1..=known).contains(&fine)
            && small(fine - 1, EXTRAPOLATED * allowed)
            && follows(fine - 1)
        {
            fine -= 1;
        }
        fine
    }
}
