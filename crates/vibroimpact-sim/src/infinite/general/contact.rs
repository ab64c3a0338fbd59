//! One contact, from touch to release.
//!
//! The time `theta` is measured from touch. The past before it enters as the free motion [`FreeMotion`], and the past of the
//! contact itself as impulses with their ages. A panel is solved, checked and accepted, as a whole or up to an event.

use super::equations::{Fault, Nodal, solve};
use super::event::{Event, first};
use super::flight::Departure;
use super::kernel::Kernel;
use super::law::Scaled;
use super::past::{FreeMotion, Solved};
use crate::StopReason;
use crate::infinite::contact::Turn;
use crate::infinite::free::REACH;
use crate::infinite::history::{History, Impulse};
use crate::infinite::panel::{end_acceleration, turns, variable};
use crate::infinite::piece::Piece;
use crate::infinite::problem::Settings;
use crate::infinite::rule::{Kind, dot, series, series_slope};
use crate::panel::root::{EXACTLY, root};
use contact_models::{After, Branch, Memory};

/// Number of changes of branch at one time after which the law counts as inconsistent.
const MOST_AT_ONCE: usize = 16;
/// A contact is followed for this many of its natural times.
const LONGEST: f64 = 300.0;
/// The shortest panel, as a part of the natural time.
const SHORTEST: f64 = 1e-12;

/// What is fixed at touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub time: f64,
    pub closing: f64,
    pub body: f64,
    pub memory: Memory,
}

/// How the integration of a contact ended.
#[derive(Debug, Clone, Copy)]
pub(super) enum Ending {
    /// The surfaces part, leaving this memory.
    Released(Memory),
    Stopped(StopReason),
}

/// A trial panel.
struct Trial {
    kind: Kind,
    h: f64,
    nodal: Nodal,
    x_series: Vec<f64>,
    f_series: Vec<f64>,
    /// Impulse that the polynomial of the force does not resolve, relative to the allowed one.
    unresolved: f64,
}

/// The motion on the last panel that was solved, taken or not.
struct Hint {
    kind: Kind,
    /// Time since touch at its start.
    start: f64,
    h: f64,
    x_series: Vec<f64>,
    rate_series: Vec<f64>,
}

/// The integration of one contact.
pub(super) struct Contact<'a> {
    kernel: &'a Kernel,
    law: &'a Scaled<'a>,
    settings: &'a Settings,
    touch: Touch,
    branch: Branch,
    /// See [`natural_times`].
    natural_times: (f64, f64),
    past: History,
    before: FreeMotion,
    /// Impulses of this contact that lie far enough back, and the panels that do not.
    since: History,
    near: Vec<Solved>,
    /// Time since touch, compression and rate at present.
    pub now: f64,
    level: f64,
    x: f64,
    rate: f64,
    /// `int f` and `int (now - s) f ds` since touch.
    impulse: f64,
    moment: f64,
    falling: bool,
    pub pieces: Vec<Piece>,
    pub turns: Vec<Turn>,
    pub peak_force: f64,
    pub trials: usize,
    hint: Option<Hint>,
}

impl<'a> Contact<'a> {
    pub fn new(
        kernel: &'a Kernel,
        law: &'a Scaled<'a>,
        settings: &'a Settings,
        touch: Touch,
        past: History,
    ) -> Contact<'a> {
        let level = touch.memory.touch_m / law.scale.displacement_m;
        let branch = law.touch(&touch.memory, touch.closing);
        let natural_times = natural_times(kernel, law, &branch, level, touch.closing);
        Contact {
            kernel,
            law,
            settings,
            branch,
            natural_times,
            before: FreeMotion::during_contact(kernel, &past, REACH * natural_times.0),
            past,
            since: History::default(),
            near: Vec::new(),
            now: 0.0,
            level,
            x: level,
            rate: touch.closing,
            touch,
            impulse: 0.0,
            moment: 0.0,
            falling: false,
            pieces: Vec::new(),
            turns: Vec::new(),
            peak_force: 0.0,
            trials: 0,
            hint: None,
        }
    }

    /// Integrates until the contact or the run ends.
    pub fn run(&mut self, budget: usize) -> Ending {
        let (natural, relaxation) = self.natural_times;
        let shortest = SHORTEST * natural;
        let (mut kind, mut h, mut at_once) = (Kind::Start, natural, 0);
        if self.kernel.instant() == 0.0 {
            // a force that begins with a jump is resolved in its impulse, which may leave out its first moment
            self.peak_force = self.law.force(&self.branch, self.x, self.rate).force.max(0.0);
        }
        while self.trials < budget {
            let trial = match self.attempt(kind, h) {
                Ok(trial) => trial,
                Err(Fault::Law) => return Ending::Stopped(StopReason::Law),
                Err(Fault::NotConverged) if h <= shortest => return Ending::Stopped(StopReason::FinestStep),
                Err(Fault::NotConverged) => {
                    h = (0.25 * h).max(shortest);
                    continue;
                }
            };
            if let Some(event) = self.event(&trial) {
                let length = event.fraction * h;
                let landed = if length <= shortest {
                    at_once += 1;
                    at_once <= MOST_AT_ONCE
                } else {
                    at_once = 0;
                    kind == Kind::Middle && self.land(event, length)
                };
                if at_once > MOST_AT_ONCE {
                    return Ending::Stopped(StopReason::Law);
                }
                if !landed {
                    h = (0.5 * length).max(0.5 * shortest);
                    continue;
                }
                match self.law.cross(&self.branch, event.which, self.x, self.rate) {
                    After::Release(memory) => return Ending::Released(memory),
                    After::Continue(branch) => (self.branch, self.hint) = (branch, None),
                }
                (kind, h) = (Kind::Start, length.max(0.1 * self.now).max(shortest));
                continue;
            }
            let order = -1.0 / self.kernel.tables.p as f64;
            if trial.unresolved > 1.0 && h > shortest {
                h = (h * (0.9 * trial.unresolved.powf(order)).clamp(0.25, 0.8)).max(shortest);
                continue;
            }
            h *= (0.95 * trial.unresolved.max(1e-30).powf(order)).clamp(1.0, 2.0);
            self.take(trial);
            if self.pieces.last().and_then(|piece| piece.force.as_ref()).is_some_and(|f| self.pulls(f)) {
                return Ending::Stopped(StopReason::Law);
            }
            (kind, at_once) = (Kind::Middle, 0);
            let known = self.now > LONGEST * (natural + relaxation);
            if known && self.touch.time + self.now >= self.settings.horizon {
                return Ending::Stopped(StopReason::ContactLasts);
            }
        }
        Ending::Stopped(StopReason::Steps)
    }

    /// Whether a law gives a tensile force, which is not allowed.
    fn pulls(&self, force: &[f64]) -> bool {
        force.iter().any(|f| *f < -1e-6 * self.peak_force)
    }

    /// Known terms of the equations of the next panel: compression and rate at its nodes and end without its own force.
    fn known(&self, kind: Kind, h: f64) -> [Vec<f64>; 2] {
        let tables = self.kernel.tables;
        let elapsed = &tables.rule(kind).elapsed;
        let after: Vec<f64> = elapsed.iter().map(|e| h * e).collect();
        let (mut memory, mut slope) = (vec![0.0; after.len()], vec![0.0; after.len()]);
        for impulse in self.since.impulses() {
            self.kernel.add_after_effect(impulse, &after, &mut memory, &mut slope);
        }
        for panel in &self.near {
            panel.add_after_effect(self.kernel, &after, &mut memory, &mut slope);
        }
        for ((tau, memory), slope) in after.iter().zip(&mut memory).zip(&mut slope) {
            let theta = self.now + tau;
            let (bend, gain) = self.before.bend(theta);
            let line = self.level + self.touch.closing * theta;
            *memory = line + bend - (self.moment + self.impulse * (tau + self.kernel.instant())) - *memory;
            *slope = self.touch.closing + gain - self.impulse - *slope;
        }
        [memory, slope]
    }

    /// Compression and rate on a panel from now on, if the rate stayed as it is.
    fn guess(&self, kind: Kind, h: f64) -> Nodal {
        let elapsed = &self.kernel.tables.rule(kind).elapsed;
        Nodal {
            x: elapsed.iter().map(|e| self.x + self.rate * h * e).collect(),
            rate: vec![self.rate; elapsed.len()],
            force: vec![0.0; self.kernel.tables.p],
            stiffness: 0.0,
        }
    }

    /// Compression and rate as on the panel solved before, and beyond it with its last acceleration.
    fn guess_from(&self, hint: &Hint, kind: Kind, h: f64) -> Nodal {
        let mut nodal = self.guess(kind, h);
        let (offset, scale) = ((self.now - hint.start) / hint.h, h / hint.h);
        let elapsed = &self.kernel.tables.rule(kind).elapsed;
        if offset < 0.5 {
            for ((x, rate), e) in nodal.x.iter_mut().zip(&mut nodal.rate).zip(elapsed) {
                let s = variable(hint.kind, offset + scale * e);
                (*x, *rate) = (series(&hint.x_series, s), series(&hint.rate_series, s));
            }
        } else if hint.kind != Kind::End {
            let (acceleration, most) = (end_acceleration(hint.kind, hint.h, &hint.x_series), h * self.rate.abs());
            for (x, e) in nodal.x.iter_mut().zip(elapsed) {
                *x += (0.5 * h * e * h * e * acceleration).clamp(-most, most);
            }
        }
        nodal
    }

    /// Solves one panel from now on.
    fn attempt(&mut self, kind: Kind, h: f64) -> Result<Trial, Fault> {
        self.trials += 1;
        let tables = self.kernel.tables;
        let known = self.known(kind, h);
        let matrices = self.kernel.matrices(kind, h);
        let solved = |guess| solve(self.law, &self.branch, &matrices, &known, guess);
        let nodal = match self.hint.take().map(|hint| solved(self.guess_from(&hint, kind, h))) {
            Some(Ok(nodal)) => nodal,
            _ => solved(self.guess(kind, h))?,
        };
        let [x_series, rate_series] = [&nodal.x, &nodal.rate].map(|values| tables.coefficients(&values[..tables.p]));
        self.hint = Some(Hint { kind, start: self.now, h, x_series: x_series.clone(), rate_series });
        let f_series = tables.coefficients(&nodal.force);
        let tail = f_series[tables.p - 2..].iter().fold(0.0_f64, |tail, c| tail.max(c.abs()));
        let terms = self.level.abs() + self.touch.closing * (self.now + h);
        let noise = 1e-15 * terms * nodal.stiffness * h;
        let allowed = (self.settings.tolerance * self.touch.closing).max(noise).max(f64::MIN_POSITIVE);
        Ok(Trial { kind, h, nodal, x_series, f_series, unresolved: tail * h / allowed })
    }

    /// The first boundary that a panel meets.
    fn event(&self, trial: &Trial) -> Option<Event> {
        let margins = self.law.margins(&self.branch);
        let Nodal { x, rate, .. } = &trial.nodal;
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |largest, v| largest.max(v.abs()));
        let (x_size, rate_size) = (largest(x), largest(rate));
        let x_terms = self.level.abs() + self.touch.closing * (self.now + trial.h);
        let rate_terms = self.touch.closing + rate_size;
        let noise: Vec<f64> = margins
            .iter()
            .map(|margin| {
                let local = margin.per_compression.abs() * x_size + margin.per_rate.abs() * rate_size;
                1e-12 * local + 4e-15 * margin.size(x_terms, rate_terms)
            })
            .collect();
        first(self.kernel.tables, trial.kind, &margins, x, rate, &noise)
    }

    /// Accepts a panel that ends where the boundary is met, from a guess of its length. Returns whether there is one that is
    /// resolved.
    fn land(&mut self, event: Event, guess: f64) -> bool {
        let margins = self.law.margins(&self.branch);
        let Some(margin) = margins.get(event.which) else { return false };
        // slope of the event function in the elapsed fraction of the trial panel
        let mut slope = event.slope * event.fraction / guess;
        let (mut length, mut last): (f64, Option<(f64, f64)>) = (guess, None);
        for _ in 0..20 {
            let Ok(trial) = self.attempt(Kind::End, length) else { return false };
            let p = self.kernel.tables.p;
            let value = margin.at(trial.nodal.x[p], trial.nodal.rate[p]);
            if let Some((old_length, old_value)) = last {
                let secant = (value - old_value) / (length - old_length);
                if secant < 0.0 && (length - old_length).abs() > 1e-9 * length {
                    slope = secant;
                }
            }
            let step = -value / slope;
            if !(slope < 0.0 && step.is_finite()) {
                return false;
            }
            let small = 4e-16 * (self.now + length) + 1e-14 * length;
            let stalled = last.is_some_and(|(_, old)| value.abs() >= 0.5 * old.abs()) && step.abs() < 1e-10 * length;
            if step.abs() <= small || stalled {
                if trial.unresolved > 1.0 {
                    return false;
                }
                self.take(trial);
                return true;
            }
            if step.abs() < 1e-3 * length && trial.unresolved > 1.0 {
                return false;
            }
            last = Some((length, value));
            length += step.clamp(-0.5 * length, 0.5 * guess);
        }
        false
    }

    /// Adds a panel to the record.
    fn take(&mut self, trial: Trial) {
        let Trial { kind, h, mut nodal, x_series, f_series, .. } = trial;
        let tables = self.kernel.tables;
        let (x_end, rate_end) = (nodal.x.pop().unwrap_or(self.x), nodal.rate.pop().unwrap_or(self.rate));
        let (found, falling) = turns(tables, kind, &x_series, self.falling);
        for (fraction, compression, minimum) in found {
            self.turns.push(Turn { after: self.now + fraction * h, compression, minimum });
        }
        self.falling = falling;
        self.peak_force = self.peak_force.max(largest(&tables.sample, &f_series));
        let (impulse, moment) = (self.impulse, self.moment);
        let (mass, lever) = self.kernel.totals(kind);
        self.moment += self.impulse * h + h * h * dot(lever, &nodal.force);
        self.impulse += h * dot(mass, &nodal.force);
        self.pieces.push(Piece { kind, start: self.now, h, x: nodal.x, force: Some(nodal.force), impulse, moment });
        self.now += h;
        (self.x, self.rate) = (x_end, rate_end);
        if !self.kernel.has_after_effect() {
            return;
        }
        // the past moves back, and what is far enough joins the impulses
        self.since.advance(h);
        self.near.iter_mut().for_each(|panel| panel.behind += h);
        self.near.push(Solved::new(self.kernel, kind, h, f_series));
        let far = |panel: &Solved| panel.behind >= if panel.kind == Kind::Start { 2.0 } else { 1.0 } * panel.h;
        let count = self.near.iter().take_while(|panel| far(panel)).count();
        for panel in self.near.drain(..count) {
            self.since.push(panel.impulses(tables, panel.behind), panel.behind, panel.behind + panel.h);
        }
        if count > 0 {
            self.since.condense();
        }
    }

    /// The flight that follows release, and the past as seen from there.
    pub fn departure(mut self) -> (Departure, History) {
        self.past.advance(self.now);
        let near = self.near.iter().flat_map(|panel| panel.impulses(self.kernel.tables, panel.behind));
        let impulses: Vec<Impulse> = self.since.impulses().chain(near).collect();
        let youngest = impulses.iter().fold(f64::INFINITY, |least, impulse| least.min(impulse.age));
        self.past.push(impulses, youngest, self.now);
        let free = FreeMotion::new(self.kernel, &self.past);
        // Where the structure's speed follows from the past alone, the sum of both speeds has the digits that one minus all impulses
        // loses as the striker slows down.
        let body = match self.kernel.instant() {
            0.0 => self.rate + free.structure_speed(),
            _ => self.touch.body - self.impulse,
        };
        (Departure { x: self.x, rate: self.rate, body, free }, self.past)
    }
}

/// The time in which the law, pressed at the closing speed, would take half of that speed from the striker; and that in which its
/// damping relaxes.
fn natural_times(kernel: &Kernel, law: &Scaled<'_>, branch: &Branch, level: f64, closing: f64) -> (f64, f64) {
    let mut h = 2.0_f64.powi(100);
    while h > 2.0_f64.powi(-200) {
        let force = law.force(branch, level + closing * h, 0.0).force;
        if force * (h + kernel.value(h)) <= 0.5 * closing {
            break;
        }
        h *= 0.5;
    }
    let there = law.force(branch, level + closing * h, closing);
    let relaxation = there.damping / there.stiffness;
    (h, if relaxation.is_finite() { relaxation.abs() } else { 0.0 })
}

/// The largest value of a force on a panel.
fn largest(sample: &[f64], f_series: &[f64]) -> f64 {
    let value = |s: f64| series(f_series, s);
    let best = (0..sample.len()).max_by(|&i, &j| value(sample[i]).total_cmp(&value(sample[j]))).unwrap_or(0);
    let turn = (best > 0 && best + 1 < sample.len())
        .then(|| root(sample[best - 1], sample[best + 1], EXACTLY, |s| series_slope(f_series, s)));
    turn.into_iter().filter(|s| (0.0..=1.0).contains(s)).map(value).fold(value(sample[best]), f64::max)
}
