//! The tangent of a motion: its derivative with respect to a parameter.
//!
//! The recorded panels are processed once more. On each of them three things are differentiated.
//!
//! # A mode
//! With `L a = a'' + 2 beta a' + omega^2 a = f`, `beta = zeta omega`, and `t` the time since the start of the panel,
//!
//! ```text
//! L (t a)  = t f + 2 a' + 2 beta a
//! L (t a') = t f' + 2 f - 2 beta a' - 2 omega^2 a
//! ```
//!
//! so that a change of frequency and damping adds to a mode its own motion times the time. The change `da` obeys
//! `L da = df - d(omega^2) a - 2 d(beta) a'`, and with `c_1 = omega dzeta/(1 - zeta^2)`, `c_2 = domega/omega - zeta
//! dzeta/(1 - zeta^2)`
//!
//! ```text
//! da = y - c_1 t a + c_2 t a',      L y = df + c_1 t f - c_2 (t f' + 2 f)
//! ```
//!
//! where `y` is the motion of the same mode under other forces, computed with the propagators and responses of the panel. Near
//! critical damping, `zeta = 1`, `c_1` and `c_2` would magnify the panel's error of `t f`. For such a mode they contain only the
//! part by `domega`, and the derivatives of its free motion and of its responses with respect to `zeta` are added, which have a
//! closed form ([`ByDamping`](crate::panel::by_damping::ByDamping)).
//!
//! # The forces
//! `F = law(xi, xi')` at the nodes becomes linear: `(1 - F_xi R - F_rate D R) dF = F_xi dr + F_rate D dr + F_theta`, with
//! Newton's matrix of the panel and `dr` the change of the overlap under unchanged forces. Where the force begins or ends as `t^(3/2)`,
//! the modes are moved by `T dF` (`panel/ends.rs`), and `R` stands for `R T`.
//!
//! # The loads
//! Modes are computed relative to their steady motion under the loads. The steady motion has a closed form, and so has its
//! derivative. The relative motion is free, so that all of the above holds for it. A break of a load lies at a fixed time: the
//! panel before it becomes shorter by the shift of its start.
//!
//! # The events
//! A panel that ends at an event changes its length by `dh = -dG/G'`, so that the event function `G` stays zero, and the next
//! panel begins at the shifted time: derivatives are taken at the event, not at a fixed time. A touch therefore remains a touch,
//! and a force that begins and ends as `t^(3/2)` still does so after the change. At a grazing contact `G' = 0`, and there is no
//! derivative.

mod event;
mod expansion;
mod panel;
mod walk;

use super::change::Change;
use super::dense::{Event, Stretch};
use super::load::Loads;
use super::load_change::LoadChange;
use super::no_derivative::NoDerivative;
use super::problem::Posed;
use super::system::System;
use crate::panel::legendre::{Legendre, Q, add};
use contact_models::Force;
pub(crate) use expansion::Expansions;
use panel::{Passage, Solved};
pub(crate) use walk::{IntervalChange, Tangent};
use walk::{Moved, Walk};

/// All tangents of a record, or the reasons why there are none.
pub(crate) struct Tangents {
    pub tangents: Vec<Result<Tangent, NoDerivative>>,
    /// The motion itself at the end.
    pub amplitude: Vec<f64>,
    pub rate: Vec<f64>,
    /// The lowest speed at which a contact closed, infinite if none did, and the highest.
    pub closing_speeds_m_s: [f64; 2],
}

/// The condition that determines the end of a panel.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Ending {
    /// Its length.
    Length,
    /// An event of this contact.
    Event(usize, Event),
    /// A break of the loads.
    Break,
    /// The end of the requested time.
    Run,
}

/// Where on a panel force and compression of a contact exceed all before, with the slope of the compression.
#[derive(Clone, Copy)]
struct Peaks {
    force: Option<f64>,
    compression: Option<(f64, f64)>,
}

/// The end of a panel.
struct Arrival<'a> {
    length_s: f64,
    ending: Ending,
    /// The relative modal state there.
    state: [&'a [f64]; 2],
    /// Derivative of the time of the end, if the panel ends at a given time.
    end_s: Option<&'a [f64]>,
    /// The next stretch.
    next: &'a Stretch,
}

/// Relative error of the numbers that a law computes at an event, with which the derivatives beside the answer are computed: that of a
/// few roundings, divided by the factor from a difference to an uncertainty.
pub(crate) const ROUNDED: f64 = 0.25 * f64::EPSILON;

/// The tangents of a recorded motion. A record that ends at a fixed time ends with a stretch of zero length, and `end_s` has the
/// derivatives of that time with respect to each parameter. `rounded` is an error of the numbers that the laws compute at events,
/// relative to them: zero, or [`ROUNDED`] to see what it amounts to.
pub(crate) fn tangents(
    posed: &Posed,
    system: &System,
    stretches: &[Stretch],
    (changes, end_s): (&[Change], Option<&[f64]>),
    expansions: &mut Expansions,
    rounded: f64,
) -> Result<Tangents, NoDerivative> {
    let mut walk = Walk::new(posed, system, changes, expansions, rounded);
    for (i, stretch) in stretches.iter().enumerate() {
        // events at the start of the record are treated on a panel of zero length
        if i == 0 && !stretch.events.is_empty() {
            walk.begin(stretch);
        }
        if let Some(next) = stretches.get(i + 1) {
            let is_last = i + 2 == stretches.len();
            walk.advance(stretch, next, end_s.filter(|_| is_last))?;
        }
    }
    let (amplitude, rate) = walk.end(stretches.last().ok_or(NoDerivative::Outcome)?);
    let known = |tangent: Tangent| {
        let motion = tangent.amplitude.iter().chain(&tangent.rate);
        let finite = motion.sum::<f64>().is_finite() && tangent.time_s.is_finite();
        match tangent.refused {
            Some(why) => Err(why),
            None if finite => Ok(tangent),
            None => Err(NoDerivative::Infinite),
        }
    };
    Ok(Tangents {
        tangents: walk.tangents.into_iter().map(known).collect(),
        amplitude,
        rate,
        closing_speeds_m_s: walk.closing_speeds_m_s,
    })
}

impl Walk<'_> {
    fn begin(&mut self, first: &Stretch) {
        let moved = self.tangents.iter().map(|tangent| Moved {
            amplitude: tangent.amplitude.clone(),
            rate: tangent.rate.clone(),
            ..Moved::default()
        });
        let mut moved: Vec<Moved> = moved.collect();
        let state = [first.amplitude.as_slice(), &first.rate];
        let bend = self.acceleration(first.start_s, state, &[], 0.0);
        let slide = Moved { amplitude: first.rate.clone(), rate: bend, ..Moved::default() };
        let end = Arrival { length_s: 0.0, ending: ending(first), state, end_s: None, next: first };
        self.arrive(&end, &[], &mut moved, Some(&slide));
    }

    /// From the start of a stretch to that of the next one; `end_s` has the changes of that time if the record ends there.
    fn advance(&mut self, stretch: &Stretch, next: &Stretch, end_s: Option<&[f64]>) -> Result<(), NoDerivative> {
        let h = stretch.length_s;
        // the relative motion jumps at a break
        let mut after = None;
        let mut before = None;
        while next.start_s >= after.as_ref().unwrap_or(&self.loads).next_break_s() {
            let loads = after.get_or_insert_with(|| self.loads.clone());
            let [mut jump, mut jump_rate] = [(); 2].map(|()| vec![0.0; next.rate.len()]);
            loads.pass_break(self.system, next.start_s, &mut jump, &mut jump_rate);
            let [end_a, end_b] = before.get_or_insert_with(|| [next.amplitude.clone(), next.rate.clone()]);
            end_a.iter_mut().zip(&jump).for_each(|(end, jump)| *end -= jump);
            end_b.iter_mut().zip(&jump_rate).for_each(|(end, jump)| *end -= jump);
        }
        let state = before.as_ref().map_or([next.amplitude.as_slice(), &next.rate], |[a, b]| [a.as_slice(), b]);
        let ending = match (ending(next), end_s) {
            // the time of an event at a break cannot shift separately
            (Ending::Event(..), _) if after.is_some() => return Err(NoDerivative::Break { time_s: next.start_s }),
            (Ending::Length, _) if after.is_some() => Ending::Break,
            (Ending::Length, Some(_)) => Ending::Run,
            (ending, _) => ending,
        };
        let closed: Vec<usize> = stretch.forces.iter().map(|acting| acting.contact).collect();
        let by_rate = stretch.forces.iter().any(|acting| acting.by_rate);
        let expansion = self.expansions.of(self.system, self.changes, h, (&closed, by_rate));
        let solved = self.solved(stretch, &expansion);
        if !closed.is_empty() {
            let values: Vec<[Force; Q]> = solved.iter().map(|solved| solved.law).collect();
            let system = self.system;
            let shares = |p: usize, q: usize| system.neighbours[closed[p]].contains(&closed[q]);
            let response = |p: usize, q: usize| shares(p, q).then(|| expansion.mobility(p * closed.len() + q));
            self.blocks.factor(&values, |q| solved[q].ends, &response);
        }
        let from = [stretch.amplitude.as_slice(), &stretch.rate];
        let bends = [
            self.acceleration(stretch.start_s, from, &solved, 0.0),
            self.acceleration(stretch.start_s + h, state, &solved, 1.0),
        ];
        let passage = Passage { from: stretch, to: state, expansion: &expansion, solved: &solved, bends };
        let mut moved = std::mem::take(&mut self.moved);
        moved.iter_mut().enumerate().for_each(|(d, moved)| self.moved(d, &passage, moved));
        let slide = (ending != Ending::Length).then(|| self.slide(&passage));
        for solved in &solved {
            let (c, followed) = (solved.contact, &mut self.contacts[solved.contact]);
            let moved = state[0].iter().zip(&stretch.amplitude).map(|(after, before)| after - before);
            followed.overlap += self.system.links[c].sum(&moved.collect::<Vec<f64>>());
            followed.overlap += self.loads.overlap(c, next.start_s).0 - self.loads.overlap(c, stretch.start_s).0;
            followed.sizes[0] = solved.compression.iter().fold(followed.sizes[0], |most, value| most.max(value.abs()));
        }
        self.arrive(&Arrival { length_s: h, ending, state, end_s, next }, &solved, &mut moved, slide.as_ref());
        self.moved = moved;
        if let Some(after) = after {
            self.pass_breaks(after);
        }
        Ok(())
    }

    /// To the loads after a break, or several at once.
    fn pass_breaks(&mut self, after: Loads) {
        for (tangent, loads) in self.tangents.iter_mut().zip(&mut self.load_changes) {
            let Some(loads) = loads else { continue };
            for _ in 0..after.breaks_since(&self.loads) {
                let (jump, jump_rate) = loads.pass_break(self.system);
                tangent.amplitude.iter_mut().zip(&jump).for_each(|(change, jump)| *change += jump);
                tangent.rate.iter_mut().zip(&jump_rate).for_each(|(change, jump)| *change += jump);
            }
        }
        self.loads = after;
    }

    /// The end of a panel: its shift, the statistics, and the events there.
    fn arrive(&mut self, end: &Arrival, solved: &[Solved], moved: &mut [Moved], slide: Option<&Moved>) {
        let Arrival { length_s: h, ending, state, end_s, next } = *end;
        let time_s = next.start_s;
        let overlaps: Vec<[f64; 2]> = (0..self.contacts.len())
            .map(|c| {
                let (link, followed) = (&self.system.links[c], &self.contacts[c]);
                let (shift, shift_rate) = self.loads.overlap(c, time_s);
                let overlap = match followed.branch {
                    Some(_) => followed.overlap,
                    None => next.contacts[c].reference + link.sum(state[0]) + shift,
                };
                [overlap, self.rate(c, state[1], shift_rate)]
            })
            .collect();
        for (followed, [_, rate]) in self.contacts.iter_mut().zip(&overlaps) {
            followed.rate = *rate;
            followed.sizes[1] = followed.sizes[1].max(rate.abs());
        }
        let peaks = self.peaks(solved);
        let resting = if h > 0.0 { self.resting(&overlaps) } else { Vec::new() };
        for (d, moved) in moved.iter_mut().enumerate() {
            let mut longer = 0.0;
            if let Some(slide) = slide {
                longer = match ending {
                    Ending::Length => 0.0,
                    Ending::Event(c, event) => {
                        let (speed, moved) = (self.speed(c, time_s, slide), [moved.amplitude.as_slice(), &moved.rate]);
                        let shift = self.shift(d, (c, event), (time_s, state), overlaps[c], moved, speed);
                        self.or_refuse(d, shift).0
                    }
                    Ending::Break => {
                        let later = self.load_changes[d].as_ref().map_or(0.0, LoadChange::next_break_s);
                        later - self.tangents[d].time_s
                    }
                    Ending::Run => end_s.map_or(0.0, |changes| changes[d]) - self.tangents[d].time_s,
                };
                for k in 0..moved.amplitude.len() {
                    moved.amplitude[k] += longer * slide.amplitude[k];
                    moved.rate[k] += longer * slide.rate[k];
                }
            }
            for (p, own) in solved.iter().enumerate() {
                if let Some(slide) = slide {
                    add(&mut moved.law[p], longer, &slide.law[p]);
                    add(&mut moved.force[p], longer, &slide.force[p]);
                    add(&mut moved.overlap[p], longer, &slide.overlap[p]);
                }
                let interval = self.contacts[own.contact].interval;
                let force = Legendre::through(&moved.force[p]);
                let overlap = Legendre::through(&moved.overlap[p]);
                let Some(interval) = self.tangents[d].intervals.get_mut(interval) else { continue };
                interval.impulse_n_s += h * force.mean() + longer * own.force.at(1.0);
                let Peaks { force: by_force, compression: by_compression } = peaks[p];
                if let Some(place) = by_force {
                    interval.peak_force_n = own.ends.value(&own.ends.quotient(&moved.law[p]), place);
                }
                if let Some((place, slope)) = by_compression {
                    let end = if place == 1.0 { longer * slope / h } else { 0.0 };
                    interval.peak_compression_m = overlap.at(place) + end;
                }
            }
            for &c in &resting {
                let change = self.overlap(d, c, time_s, state, [&moved.amplitude, &moved.rate])[0];
                if self.moves(d, c, time_s, change, [state[0], &moved.amplitude]) {
                    self.or_refuse(d, Err::<(), _>(NoDerivative::Rests { contact: c, time_s }));
                }
            }
            let tangent = &mut self.tangents[d];
            std::mem::swap(&mut tangent.amplitude, &mut moved.amplitude);
            std::mem::swap(&mut tangent.rate, &mut moved.rate);
            tangent.time_s += longer;
        }
        for (i, (c, event)) in next.events.iter().enumerate() {
            let speed = slide.map_or([0.0; 2], |slide| self.speed(*c, time_s, slide));
            // branches that surfaces pass because they overlap at the start are not located
            let is_located = time_s > 0.0 || matches!(event, Event::Close { overlaps: false });
            let apart = match slide {
                Some(_) if i > 0 && is_located => self.apart(*c, *event, (time_s, state), overlaps[*c], speed),
                _ => vec![0.0; self.changes.len()],
            };
            self.transition((*c, *event), (time_s, state), overlaps[*c], (&apart, speed));
        }
        for (followed, seen) in self.contacts.iter_mut().zip(&next.contacts) {
            followed.branch = seen.branch;
        }
    }

    fn peaks(&mut self, solved: &[Solved]) -> Vec<Peaks> {
        let of = |own: &Solved| {
            let followed = &mut self.contacts[own.contact];
            let exceeds = |(which, value): (usize, f64)| {
                let exceeds = value > followed.peaks[which];
                followed.peaks[which] = followed.peaks[which].max(value);
                exceeds
            };
            let compression = Legendre::through(&own.compression);
            let (by_force, by_compression) =
                (own.ends.maximum(&own.ends.quotient(&own.law.map(|law| law.force_n))), compression.maximum());
            let [force, compressed] = [(0, by_force.1), (1, by_compression.1)].map(exceeds);
            let slope = || compression.derivative().at(by_compression.0);
            Peaks { force: force.then_some(by_force.0), compression: compressed.then(|| (by_compression.0, slope())) }
        };
        solved.iter().map(of).collect()
    }

    /// From the relative to the total motion at the end of the record.
    fn end(&mut self, last: &Stretch) -> (Vec<f64>, Vec<f64>) {
        let (time_s, loads) = (last.start_s, &self.loads);
        let (mut amplitude, mut rate) = (last.amplitude.clone(), last.rate.clone());
        loads.shift_modes(self.system, time_s, 1.0, &mut amplitude, &mut rate);
        for (tangent, changed) in self.tangents.iter_mut().zip(&self.load_changes) {
            let later = tangent.time_s;
            if let Some(changed) = changed {
                let (steady, steady_rate) = changed.steady(self.system, time_s);
                tangent.amplitude.iter_mut().zip(&steady).for_each(|(change, steady)| *change += steady);
                tangent.rate.iter_mut().zip(&steady_rate).for_each(|(change, steady)| *change += steady);
            }
            for k in 0..amplitude.len() {
                tangent.amplitude[k] += later * (rate[k] - last.rate[k]);
            }
            loads.add_accelerations(time_s, later, &mut tangent.rate);
        }
        (amplitude, rate)
    }
}

/// The condition that ends the panel before a stretch, apart from loads: the first event at its start.
fn ending(next: &Stretch) -> Ending {
    match next.events.first() {
        Some((_, Event::Close { overlaps: true })) | None => Ending::Length,
        Some((c, event)) => Ending::Event(*c, *event),
    }
}
