//! Derivatives of an event: of its time, and of the law's transition.

use super::walk::{
    Followed, IntervalChange, LAW_STEP, Moved, NUMBERS, Numbers, Tangent, Walk, internal, numbers, shifted, size_of,
    sum,
};
use crate::assembly::dense::Event;
use crate::assembly::no_derivative::NoDerivative;
use crate::assembly::stencil::Stencil;
use contact_models::{After, Branch, ContactLaw, Memory};
use std::array;

/// Two simultaneous events stay together if their times shift equally within this relative difference.
const TOGETHER: f64 = 1e-6;

/// Largest change of a distance, relative to the sum of its parts, that counts as none: these are slopes through neighbouring
/// values.
const UNCHANGED: f64 = 1e-9;

/// Shift of the zero of an event function with this rate, for a change of the function.
fn later(changes: f64, slope: f64) -> Option<f64> {
    if changes == 0.0 {
        return Some(0.0);
    }
    let later = -changes / slope;
    later.is_finite().then_some(later)
}

impl Walk<'_> {
    /// Rate of an overlap, and the rate of that, at the end of a panel that becomes longer.
    pub fn speed(&self, c: usize, time_s: f64, slide: &Moved) -> [f64; 2] {
        let link = &self.system.links[c];
        let (_, by_loads) = self.loads.overlap(c, time_s);
        [self.rate(c, &slide.amplitude, by_loads), link.sum(&slide.rate) + self.loads.bend(c, time_s)]
    }

    /// Rate of an overlap from those of the modes and of their steady motion, zero within rounding.
    pub fn rate(&self, c: usize, modes: &[f64], by_loads: f64) -> f64 {
        let link = &self.system.links[c];
        let rate = link.sum(modes) + by_loads;
        if rate.abs() <= 4.0 * f64::EPSILON * (link.size(modes) + by_loads.abs()) { 0.0 } else { rate }
    }

    /// Sum of the sizes of the parts of the change of an overlap (`order` 0) or of its rate (1), for the amplitudes of the modes or for
    /// their rates.
    fn parts(&self, d: usize, c: usize, order: usize, time_s: f64, [modes, change]: [&[f64]; 2]) -> f64 {
        let by_loads = self.load_changes[d].as_ref().map_or(0.0, |loads| loads.overlap(c, time_s)[order]);
        let by_shapes: f64 = self.changes[d].psi[c].iter().map(|span| span.size(modes)).sum();
        let reference = if order == 0 { self.tangents[d].contacts[c].reference.abs() } else { 0.0 };
        reference + self.system.links[c].size(change) + by_loads.abs() + by_shapes
    }

    /// Whether a change of an overlap is more than none.
    pub fn moves(&self, d: usize, c: usize, time_s: f64, change: f64, amplitudes: [&[f64]; 2]) -> bool {
        change.abs() > UNCHANGED * self.parts(d, c, 0, time_s, amplitudes)
    }

    /// The contacts that touch without speed and without force, and whose law has a force of first order in the overlap or its rate. Such
    /// a force pushes surfaces that overlap, and does not pull those that are apart, so that the derivatives to both sides differ.
    pub fn resting(&self, overlaps: &[[f64; 2]]) -> Vec<usize> {
        let rests = |c: &usize| {
            let Followed { branch, memory, .. } = &self.contacts[*c];
            let law = self.posed.laws[*c];
            let branch = branch.unwrap_or_else(|| law.touch(memory, 0.0));
            let force = law.force(&branch, memory.touch_m, 0.0);
            let grows = force.per_compression_n_m != 0.0 || force.per_rate_n_s_m != 0.0;
            overlaps[*c] == [memory.touch_m, 0.0] && force.force_n == 0.0 && grows
        };
        (0..overlaps.len()).filter(rests).collect()
    }

    /// Shift of an event at the end of a panel of unchanged length, and the rate of its function.
    pub fn shift(
        &self,
        d: usize,
        (contact, event): (usize, Event),
        (time_s, state): (f64, [&[f64]; 2]),
        overlap: [f64; 2],
        moved: [&[f64]; 2],
        speed: [f64; 2],
    ) -> Result<(f64, f64), NoDerivative> {
        let change = self.overlap(d, contact, time_s, state, moved);
        // surfaces that touch at the start do so after any change that leaves their distance as it is
        if time_s == 0.0 && matches!(event, Event::Close { .. }) {
            match self.moves(d, contact, time_s, change[0], [state[0], moved[0]]) {
                false => return Ok((0.0, speed[0])),
                true if speed[0] == 0.0 => return Err(NoDerivative::Graze { contact, time_s }),
                true => (),
            }
        }
        let found = self.event_function(d, contact, event, overlap, change, speed);
        let (changes, slope) = found.ok_or(NoDerivative::Fork { contact, time_s })?;
        Ok((later(changes, slope).ok_or(NoDerivative::Graze { contact, time_s })?, slope))
    }

    /// Shift of another event at the same time relative to the event that ended the panel. If they shift differently, a contact
    /// whose force jumps at first touch has no tangent here.
    pub fn apart(
        &mut self,
        c: usize,
        event: Event,
        (time_s, state): (f64, [&[f64]; 2]),
        overlap: [f64; 2],
        speed: [f64; 2],
    ) -> Vec<f64> {
        let jumps = match event {
            Event::Close { .. } => {
                let law = self.posed.laws[c];
                let branch = law.touch(&self.contacts[c].memory, overlap[1].max(0.0));
                law.force(&branch, overlap[0], overlap[1]).force_n != 0.0
            }
            Event::Cross(_) => false,
        };
        let of = |(d, tangent): (usize, &Tangent)| {
            let moved = [tangent.amplitude.as_slice(), &tangent.rate];
            let (later, slope) = self.shift(d, (c, event), (time_s, state), overlap, moved, speed)?;
            // the parts that cancel if both events shift by the same time
            let parts =
                sum(&self.changes[d].psi[c], state[0]).abs() + self.system.links[c].sum(&tangent.amplitude).abs();
            let known = TOGETHER * (parts / slope).abs().max(tangent.time_s.abs());
            match later {
                _ if later.abs() <= known => Ok(0.0),
                _ if jumps => Err(NoDerivative::Together { contact: c, time_s }),
                _ => Ok(later),
            }
        };
        let found: Vec<Result<f64, NoDerivative>> = self.tangents.iter().enumerate().map(of).collect();
        found.into_iter().enumerate().map(|(d, shift)| self.or_refuse(d, shift)).collect()
    }

    /// Derivative of an event function at the end of a panel of unchanged length, and its rate. `None` if the law has no such
    /// boundary at a neighbouring value.
    fn event_function(
        &self,
        d: usize,
        c: usize,
        event: Event,
        [overlap, rate]: [f64; 2],
        change: [f64; 2],
        speed: [f64; 2],
    ) -> Option<(f64, f64)> {
        let carried = &self.tangents[d].contacts[c];
        let (Event::Cross(which), Some(branch)) = (event, self.contacts[c].branch) else {
            return Some((change[0] - carried.memory[0], speed[0]));
        };
        let law = self.posed.laws[c];
        let boundary = law.boundary(&branch, which)?;
        let along = |[xi, rate]: [f64; 2]| boundary.per_compression * xi + boundary.per_rate * rate;
        let margin = |law: &dyn ContactLaw, branch: &Branch| Some(law.boundary(branch, which)?.margin(overlap, rate));
        let all = |margins: [Option<f64>; 4]| {
            let [a, b, c, d] = margins;
            Some([a?, b?, c?, d?])
        };
        let mut changes = along(change);
        if let Some(laws) = &self.changes[d].laws {
            changes += self.changes[d].stencil.slope(all(laws[c].map(|law| margin(law, &branch)))?);
        }
        for (which, by) in carried.branch.iter().enumerate().filter(|(_, by)| **by != 0.0) {
            let value = numbers(branch.anchor_m, branch.internal)[which];
            let stencil = Stencil::around(value, LAW_STEP * size_of(&branch, which, &self.contacts[c]));
            let margins = stencil.offsets.map(|offset| margin(law, &shifted(&branch, which, offset)));
            changes += by * stencil.slope(all(margins)?);
        }
        Some((changes, along(speed)))
    }

    /// Derivatives of the law's transition, at an event that shifts by so much more than the first one at this time, with the rate of the
    /// overlap and the rate of that.
    pub fn transition(
        &mut self,
        (c, event): (usize, Event),
        (at_s, state): (f64, [&[f64]; 2]),
        [overlap, rate]: [f64; 2],
        (apart, speed): (&[f64], [f64; 2]),
    ) {
        let (law, rounded) = (self.posed.laws[c], self.rounded);
        let followed = self.contacts[c];
        // the law computes its new numbers from its own numbers and two of the motion
        const GIVEN: usize = NUMBERS + 2;
        type Given = [f64; GIVEN];
        let join = |own: Numbers, motion: [f64; 2]| -> Given {
            array::from_fn(|i| if i < NUMBERS { own[i] } else { motion[i - NUMBERS] })
        };
        let (given, sizes) = match (event, followed.branch) {
            (Event::Cross(_), Some(branch)) => {
                let own = array::from_fn(|which| size_of(&branch, which, &followed));
                let numbers = numbers(branch.anchor_m, branch.internal);
                (join(numbers, [overlap, rate]), join(own, followed.sizes))
            }
            _ => {
                let numbers = numbers(followed.memory.touch_m, followed.memory.internal);
                let mut own = numbers.map(|number| if number == 0.0 { 1.0 } else { number.abs() });
                own[0] = followed.sizes[0].max(numbers[0].abs());
                (join(numbers, [rate.max(0.0), 0.0]), join(own, [rate.abs(), 1.0]))
            }
        };
        let made = |law: &dyn ContactLaw, given: &Given| -> After {
            match (event, followed.branch) {
                (Event::Cross(which), Some(branch)) => {
                    let branch = Branch { anchor_m: given[0], internal: internal(given), ..branch };
                    law.cross(&branch, which, given[NUMBERS], given[NUMBERS + 1])
                }
                _ => {
                    let memory = Memory { touch_m: given[0], internal: internal(given) };
                    After::Continue(law.touch(&memory, given[NUMBERS]))
                }
            }
        };
        let after = made(law, &given);
        let numbers_of = |after: &After| match after {
            After::Continue(branch) => numbers(branch.anchor_m, branch.internal),
            After::Release(memory) => numbers(memory.touch_m, memory.internal),
        };
        let kind = |after: &After| match after {
            After::Continue(branch) => Some(branch.stage),
            After::Release(_) => None,
        };
        // there is no derivative if the law follows another branch at a neighbouring value
        let difference = |found: [After; 4], stencil: &Stencil<4>| -> Result<Numbers, NoDerivative> {
            if found.iter().any(|found| kind(found) != kind(&after)) {
                return Err(NoDerivative::Fork { contact: c, time_s: at_s });
            }
            let (found, made) = (found.each_ref().map(numbers_of), numbers_of(&after));
            let derivative = |which: usize| {
                let slope = stencil.slope(found.map(|numbers| numbers[which]));
                // numbers that are only handed on are not rounded
                let is_exact = slope == 0.0 || given.contains(&made[which]);
                let error = if is_exact { 0.0 } else { rounded * made[which].abs() * stencil.magnification() };
                slope + error
            };
            Ok(array::from_fn(derivative))
        };
        // derivatives of these numbers with respect to a given number
        let by_given = |i: usize| {
            let stencil = Stencil::around(given[i], LAW_STEP * sizes[i]);
            let found = stencil.offsets.map(|offset| {
                let mut shifted = given;
                shifted[i] += offset;
                made(law, &shifted)
            });
            difference(found, &stencil)
        };
        let mut known: [Option<Numbers>; GIVEN] = [None; GIVEN];
        for d in 0..self.changes.len() {
            let tangent = &self.tangents[d];
            let carried = tangent.contacts[c];
            let at_first = self.overlap(d, c, at_s, state, [&tangent.amplitude, &tangent.rate]);
            let [by_overlap, mut by_rate] = array::from_fn(|i| at_first[i] + apart[d] * speed[i]);
            // surfaces that rest against each other at the start still do if the parts of this change cancel
            let rests = at_s == 0.0 && rate == 0.0;
            if rests && by_rate.abs() <= UNCHANGED * self.parts(d, c, 1, at_s, [state[1], &tangent.rate]) {
                by_rate = 0.0;
            }
            let changes: Given = match event {
                Event::Cross(_) => join(carried.branch, [by_overlap, by_rate]),
                Event::Close { .. } => join(carried.memory, [by_rate, 0.0]),
            };
            let mut made_change = || {
                let mut made_change = [0.0; NUMBERS];
                for i in (0..GIVEN).filter(|i| changes[*i] != 0.0 && sizes[*i] != 0.0) {
                    let slopes = match known[i] {
                        Some(slopes) => slopes,
                        None => *known[i].insert(by_given(i)?),
                    };
                    made_change.iter_mut().zip(&slopes).for_each(|(change, slope)| *change += slope * changes[i]);
                }
                if let Some(laws) = &self.changes[d].laws {
                    let slopes = difference(laws[c].map(|law| made(law, &given)), &self.changes[d].stencil)?;
                    made_change.iter_mut().zip(&slopes).for_each(|(change, slope)| *change += slope);
                }
                Ok(made_change)
            };
            let made_change = made_change();
            let made_change = self.or_refuse(d, made_change);
            let tangent = &mut self.tangents[d];
            let time_s = tangent.time_s + apart[d];
            match (event, &after) {
                (Event::Close { .. }, _) => {
                    let start = IntervalChange { contact: c, start_s: time_s, end_s: time_s, ..Default::default() };
                    tangent.intervals.push(IntervalChange { approach_speed_m_s: by_rate, ..start });
                    tangent.contacts[c].branch = made_change;
                }
                (_, After::Continue(_)) => tangent.contacts[c].branch = made_change,
                (_, After::Release(_)) => {
                    tangent.contacts[c].memory = made_change;
                    if let Some(interval) = tangent.intervals.get_mut(followed.interval) {
                        (interval.end_s, interval.separation_speed_m_s) = (time_s, -by_rate);
                    }
                }
            }
        }
        if let Event::Close { overlaps } = event {
            // bodies that rest against each other from the start do not graze
            let rests = at_s == 0.0 && rate <= 0.0;
            let speed = rate.max(0.0);
            let [lowest, highest] = self.closing_speeds_m_s;
            self.closing_speeds_m_s = [if rests { lowest } else { lowest.min(speed) }, highest.max(speed)];
            let followed = &mut self.contacts[c];
            (followed.interval, followed.since_s) = (self.begun, at_s);
            self.begun += 1;
            followed.peaks = [0.0; 2];
            followed.overlap = if overlaps { overlap } else { followed.memory.touch_m };
            // a law may pass several branches at once where surfaces overlap at the start
            followed.sizes[0] = followed.sizes[0].max(followed.overlap.abs());
        }
        match after {
            After::Continue(branch) => self.contacts[c].branch = Some(branch),
            After::Release(memory) => {
                (self.contacts[c].branch, self.contacts[c].memory) = (None, memory);
                if followed.since_s == at_s {
                    self.take_back(followed.interval);
                }
            }
        }
    }

    /// Forgets an interval that ended when it began, which the run does not report either.
    fn take_back(&mut self, interval: usize) {
        for tangent in &mut self.tangents {
            if interval < tangent.intervals.len() {
                tangent.intervals.remove(interval);
            }
        }
        for followed in self.contacts.iter_mut().filter(|followed| followed.interval > interval) {
            followed.interval -= 1;
        }
        self.begun -= 1;
    }
}
