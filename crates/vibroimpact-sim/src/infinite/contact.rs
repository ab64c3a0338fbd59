//! One contact, from touch to release.
//!
//! Time is measured from an origin, at first that of touch, which moves along in a long contact. With the compression `x_0` there,
//!
//! ```text
//! x = x_0 + r theta + bend(theta) - int [(theta - s) + kappa(theta - s)] f ds,
//! ```
//!
//! where `bend` is the free motion [`FreeMotion`] after the impulses before the origin, of which no term cancels another, and `r`
//! the rate of compression to which they lead. Panels that lie close before the origin are not impulses yet: their share is
//! counted from the origin on. A panel is solved, checked and accepted, as a whole or up to an event.

use super::equations::{Equations, Fault, Nodal};
use super::event::{Event, first};
use super::flight::Departure;
use super::free::REACH;
use super::history::{History, Impulse};
use super::kernel::Kernel;
use super::law::{Force, Margin, Scaled};
use super::natural_times::NaturalTimes;
use super::panel::{Panel, Turn, curvature, end_acceleration, largest, turns, variable};
use super::past::{FreeMotion, Solved};
use super::problem::{Settings, Structure};
use super::rule::{Kind, dot, series, series_slope};
use super::solution::{Outcome, Record};
use super::sustained::Watch;
use crate::StopReason;
use contact_models::{After, Branch, Memory};

/// Number of changes of branch at one time after which the law counts as inconsistent.
const MOST_AT_ONCE: usize = 16;
/// A contact is followed for this many of its natural times.
const LONGEST: f64 = 300.0;
/// The shortest panel, as a part of the time in which the law begins to act.
const SHORTEST: f64 = 1e-12;
/// Least ratio of the force and its last two Legendre coefficients, where these are rounding, at which its sign is known.
const NOISE: f64 = 5.0;
/// Panels after which the origin of time moves.
const MOST_PANELS: usize = 12;

/// What is fixed at touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub time: f64,
    pub closing: f64,
    pub body: f64,
    pub memory: Memory,
}

impl Touch {
    /// That with which an impact begins.
    pub fn first() -> Touch {
        Touch { time: 0.0, closing: 1.0, body: 1.0, memory: Memory::default() }
    }
}

/// How far a contact is followed that does not end.
pub(super) struct Extent {
    /// Until it is known to last, for Hertz contact; others are followed for [`LONGEST`] of their natural times.
    watch: Option<Watch>,
    /// To the first minimum of the compression, if it comes before.
    to_minimum: bool,
}

impl Extent {
    /// That of a contact which touches at `time`, known by its number `S` if it is Hertz contact.
    pub fn new(hertz: Option<(Structure, f64)>, time: f64) -> Extent {
        let watch = hertz.map(|(structure, s)| Watch::new(structure, s, time));
        Extent { watch, to_minimum: false }
    }

    /// The same up to the first minimum of the compression.
    pub fn until_minimum(self) -> Extent {
        Extent { to_minimum: true, ..self }
    }
}

/// How the integration of a contact ended.
#[derive(Debug, Clone, Copy)]
pub(super) enum Ending {
    /// The surfaces part, leaving this memory.
    Released(Memory),
    /// The impact ends with this contact.
    Ended(Outcome),
}

/// The computation stops.
fn stopped(reason: StopReason) -> Ending {
    Ending::Ended(Outcome::Stopped(reason))
}

/// A trial panel.
struct Trial {
    kind: Kind,
    h: f64,
    nodal: Nodal,
    x_series: Vec<f64>,
    /// Empty unless the contact follows the rate.
    rate_series: Vec<f64>,
    f_series: Vec<f64>,
    /// The scale of impulses after it.
    impulse_scale: f64,
    /// Impulse that the polynomial of the force does not resolve, relative to the allowed one.
    unresolved: f64,
    /// Whether it is allowed because it may be rounding.
    is_rounding: bool,
}

/// The motion on the last panel that was solved, taken or not.
struct Hint {
    kind: Kind,
    /// Start, from the origin of time.
    start: f64,
    h: f64,
    x_series: Vec<f64>,
    rate_series: Vec<f64>,
}

/// `int f` and `int (t - s) f ds` up to the present.
#[derive(Debug, Clone, Copy, Default)]
struct Passed {
    impulse: f64,
    moment: f64,
}

impl Passed {
    fn add(&mut self, h: f64, panel: Passed) {
        self.moment += self.impulse * h + panel.moment;
        self.impulse += panel.impulse;
    }
}

/// The integration of one contact.
pub(super) struct Contact<'a> {
    kernel: &'a Kernel,
    law: &'a Scaled<'a>,
    settings: &'a Settings,
    touch: Touch,
    branch: Branch,
    /// Whether force or boundaries of the branch depend on the rate of compression.
    follows_rate: bool,
    natural_times: NaturalTimes,
    /// Impulses before the origin of time, and the motion that follows from them.
    past: History,
    free: FreeMotion,
    /// Time from touch to the origin.
    origin: f64,
    /// Compression at the origin, and the rate of compression to which `past` leads there.
    x_origin: f64,
    slope: f64,
    /// The size of the terms from which the two were computed.
    origin_terms: [f64; 2],
    /// Panels that are not impulses yet, and their after-effect at the origin.
    near: Vec<Solved>,
    near_at_origin: f64,
    /// Panels since the origin.
    panels: usize,
    /// Time from the origin to the present, and what has passed since the origin and since touch.
    since: f64,
    passed: Passed,
    passed_since_touch: Passed,
    /// Compression and rate at present.
    x: f64,
    rate: f64,
    /// Force at the end of the last panel.
    force: f64,
    falling: bool,
    /// Slowly forgotten maximum of the closing speed and of the impulses of panels, the scale of the resolution.
    impulse_scale: f64,
    record: Vec<Panel>,
    pub turns: Vec<Turn>,
    peak_force: f64,
    pub trials: usize,
    equations: Equations,
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
        let natural_times = NaturalTimes::new(kernel, law, &branch, level, touch.closing);
        Contact {
            kernel,
            law,
            settings,
            branch,
            follows_rate: natural_times.follows_rate(law, &branch, level, touch.closing),
            natural_times,
            free: FreeMotion::during_contact(kernel, &past, REACH * natural_times.contact),
            past,
            origin: 0.0,
            x_origin: level,
            slope: touch.closing,
            origin_terms: [0.0; 2],
            near: Vec::new(),
            near_at_origin: 0.0,
            panels: 0,
            since: 0.0,
            passed: Passed::default(),
            passed_since_touch: Passed::default(),
            x: level,
            rate: touch.closing,
            force: 0.0,
            touch,
            falling: false,
            impulse_scale: touch.closing,
            record: Vec::new(),
            turns: Vec::new(),
            peak_force: 0.0,
            trials: 0,
            equations: Equations::default(),
            hint: None,
        }
    }

    /// Time since touch.
    pub fn now(&self) -> f64 {
        self.origin + self.since
    }

    /// Integrates until the contact or the run ends.
    pub fn run(&mut self, mut extent: Extent, budget: usize) -> Ending {
        let NaturalTimes { contact: natural, onset, relaxation } = self.natural_times;
        let shortest = SHORTEST * onset;
        // in which a plate takes the speed of a body that is attached to it: the force on a stiff contact falls exponentially
        let structure = if self.kernel.has_after_effect() { 0.0 } else { self.kernel.instant() };
        let (mut kind, mut h, mut at_once) = (Kind::Start, onset, 0);
        if self.kernel.instant() == 0.0 {
            // a force that begins with a jump is resolved in its impulse, which may leave out its first moment
            self.peak_force = self.law.force(&self.branch, self.x, self.rate).force.max(0.0);
        }
        while self.trials < budget {
            let trial = match self.attempt(kind, h) {
                Ok(trial) => trial,
                Err(Fault::Law) => return stopped(StopReason::Law),
                Err(Fault::NotConverged) if h <= shortest => return stopped(StopReason::FinestStep),
                Err(Fault::NotConverged) => {
                    h = (0.25 * h).max(shortest);
                    continue;
                }
            };
            if let Some(event) = self.event(&trial) {
                let length = event.fraction * h;
                if length <= shortest && trial.unresolved > 1.0 && h > shortest {
                    // so early a fall may be one of a polynomial that does not follow the motion
                    h = (0.25 * h).max(shortest);
                    continue;
                }
                let landed = if length <= shortest {
                    at_once += 1;
                    if at_once > MOST_AT_ONCE {
                        return stopped(StopReason::Law);
                    }
                    true
                } else {
                    kind == Kind::Middle && self.land(event, length)
                };
                if !landed {
                    h = (0.5 * length).max(0.5 * shortest);
                    continue;
                }
                if length > shortest {
                    at_once = 0;
                }
                match self.law.cross(&self.branch, event.which, self.x, self.rate) {
                    After::Release(memory) => return Ending::Released(memory),
                    After::Continue(branch) => self.go_on_with(branch),
                }
                (kind, h) = (Kind::Start, length.max(0.1 * self.now()).max(shortest));
                continue;
            }
            let order = -1.0 / self.kernel.tables.p as f64;
            if trial.unresolved > 1.0 && h > shortest {
                h = (h * (0.9 * trial.unresolved.powf(order)).clamp(0.25, 0.8)).max(shortest);
                continue;
            }
            if self.would_lose_digits(&trial) && h > shortest {
                h = (0.5 * h).max(shortest);
                continue;
            }
            if trial.is_noise() {
                return stopped(StopReason::DigitsExhausted);
            }
            // rounding does not tell how long a panel may be, and is less on a longer one
            let growth = if trial.is_rounding { 2.0 } else { 0.95 * trial.unresolved.max(1e-30).powf(order) };
            h *= growth.clamp(1.0, 2.0);
            let is_tension = self.is_tension(&trial);
            self.take(trial);
            if self.pulls() {
                return stopped(StopReason::Law);
            }
            if is_tension {
                return stopped(StopReason::DigitsExhausted);
            }
            (kind, at_once) = (Kind::Middle, 0);
            if extent.to_minimum && self.first_minimum().is_some() {
                return stopped(StopReason::SubImpacts);
            }
            let lasts = match &mut extent.watch {
                Some(watch) => {
                    self.record.last().inspect(|panel| watch.see(self.kernel.tables, panel));
                    watch.lasting().then_some(Outcome::Sustained)
                }
                None => {
                    let long = self.now() > LONGEST * (natural + relaxation + structure);
                    long.then_some(Outcome::Stopped(StopReason::ContactLasts))
                }
            };
            if let Some(outcome) = lasts
                && self.touch.time + self.now() >= self.settings.horizon
            {
                return Ending::Ended(outcome);
            }
            if self.panels >= MOST_PANELS || self.has_lost_digits() {
                let behind = |panel: &Solved| if panel.kind == Kind::Start { 1.5 } else { 0.5 } * panel.h;
                let present = self.since;
                self.x = self.compression_by_law();
                self.move_origin(|panel| present - panel.end >= behind(panel));
                self.past.condense();
                let reach = REACH * self.natural_times.contact;
                self.free = FreeMotion::during_contact(self.kernel, &self.past, reach);
            }
        }
        stopped(StopReason::Steps)
    }

    /// Whether the rate to which the past leads has lost a digit since the origin. Without an after-effect it may fall
    /// exponentially, and the origin moves along at no cost.
    fn has_lost_digits(&self) -> bool {
        !self.kernel.has_after_effect() && self.passed.impulse > 0.5 * self.slope.abs()
    }

    /// Whether that rate would lose more than a digit on one panel.
    fn would_lose_digits(&self, trial: &Trial) -> bool {
        let before = self.slope - self.passed.impulse;
        let impulse = trial.h * dot(self.kernel.totals(trial.kind).0, &trial.nodal.force);
        !self.kernel.has_after_effect() && (before - impulse).abs() < 0.05 * before.abs()
    }

    /// Continues on another branch of the law.
    fn go_on_with(&mut self, branch: Branch) {
        (self.branch, self.hint) = (branch, None);
        self.follows_rate = self.natural_times.follows_rate(self.law, &self.branch, self.x, self.touch.closing);
    }

    /// Whether the law gave a tensile force on the last panel, which is not allowed.
    fn pulls(&self) -> bool {
        self.record.last().is_some_and(|panel| panel.force.iter().any(|f| *f < -1e-6 * self.peak_force))
    }

    /// Whether the force is tensile throughout a panel, by more than the tolerance, and rounding hid from the event function of
    /// the law that it would release.
    fn is_tension(&self, trial: &Trial) -> bool {
        let impulse = trial.h * dot(self.kernel.totals(trial.kind).0, &trial.nodal.force);
        trial.nodal.force.iter().all(|force| *force < 0.0) && -impulse > self.settings.tolerance * trial.impulse_scale
    }

    /// Sets the equations of a panel from now on.
    fn pose(&mut self, kind: Kind, h: f64) {
        let (kernel, Passed { impulse, moment }) = (self.kernel, self.passed);
        let Equations { x, rate, .. } = &mut self.equations;
        let after: Vec<f64> = kernel.tables.rule(kind).elapsed.iter().map(|e| h * e).collect();
        let (memory, slope) = (&mut x.known, &mut rate.known);
        memory.clear();
        memory.resize(after.len(), -self.near_at_origin);
        slope.clear();
        slope.resize(if self.follows_rate { after.len() } else { 0 }, 0.0);
        for panel in &self.near {
            panel.add_after_effect(kernel, self.since - panel.end, &after, memory, slope);
        }
        let line = |tau: f64| self.x_origin + self.slope * (self.since + tau);
        let pushed = |tau: f64| moment + impulse * (tau + kernel.instant());
        kernel.weigh_compression(kind, h, &mut x.weights);
        if self.follows_rate {
            kernel.weigh_rate(kind, h, &mut rate.weights);
            for ((memory, slope), &tau) in memory.iter_mut().zip(slope).zip(&after) {
                let (bend, gain) = self.free.bend_and_gain(self.since + tau);
                *memory = line(tau) + bend - pushed(tau) - *memory;
                *slope = self.slope + gain - impulse - *slope;
            }
        } else {
            rate.weights.clear();
            for (memory, &tau) in memory.iter_mut().zip(&after) {
                *memory = line(tau) + self.free.bend(self.since + tau) - pushed(tau) - *memory;
            }
        }
    }

    /// Compression and rate on a panel from now on, if the rate stayed as it is.
    fn guess(&self, kind: Kind, h: f64) -> Nodal {
        let elapsed = &self.kernel.tables.rule(kind).elapsed;
        Nodal {
            x: elapsed.iter().map(|e| self.x + self.rate * h * e).collect(),
            rate: vec![if self.follows_rate { self.rate } else { 0.0 }; elapsed.len()],
            force: vec![0.0; self.kernel.tables.p],
        }
    }

    /// Compression and rate as on the panel solved before, and beyond it with its last acceleration.
    fn guess_from(&self, hint: &Hint, kind: Kind, h: f64) -> Nodal {
        let mut nodal = self.guess(kind, h);
        let (offset, scale) = ((self.since - hint.start) / hint.h, h / hint.h);
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
        self.pose(kind, h);
        let hinted = self.hint.take().map(|hint| self.guess_from(&hint, kind, h));
        let mut nodal = match hinted.map(|guess| self.solve(guess)) {
            Some(Ok(nodal)) => nodal,
            _ => self.solve(self.guess(kind, h))?,
        };
        let x_series = tables.coefficients(&nodal.x[..tables.p]);
        let rate_series = if self.follows_rate { tables.coefficients(&nodal.rate[..tables.p]) } else { Vec::new() };
        self.hint =
            Some(Hint { kind, start: self.since, h, x_series: x_series.clone(), rate_series: rate_series.clone() });
        let f_series = tables.coefficients(&nodal.force);
        if self.follows_rate && self.kernel.instant() > 0.0 {
            self.end_by_law(&mut nodal, series(&f_series, variable(kind, 1.0)));
        }
        let tail = f_series[tables.p - 2..].iter().fold(0.0_f64, |tail, c| tail.max(c.abs()));
        let impulse_scale = self.scale_after(h, &nodal.force);
        let mut allowed = (self.settings.tolerance * impulse_scale).max(f64::MIN_POSITIVE);
        let is_rounding = tail * h > allowed;
        if is_rounding {
            // no shorter panel resolves more than rounding leaves: of the motion, of the series, and of the compression at the
            // start, which sets off a vibration by a stiff law
            let terms = self.terms(h).map(|size| 1e-15 * size);
            let of = |k: usize| self.equations.rounding(&tables.to_legendre[k * tables.p..(k + 1) * tables.p], terms);
            let of_series = (2 * tables.p) as f64 * f64::EPSILON * largest_of(&nodal.force);
            let of_start = terms[0] * self.equations.stiffness();
            let rounding = of(tables.p - 1).max(of(tables.p - 2)).max(of_series).max(of_start);
            allowed = allowed.max(h * rounding);
        }
        let unresolved = tail * h / allowed;
        Ok(Trial { kind, h, nodal, x_series, rate_series, f_series, impulse_scale, unresolved, is_rounding })
    }

    /// Sets the rate at the end of a panel anew where a part of it follows the force at once: that force is the law's, and the
    /// `polynomial` of the panel deviates from it by the allowed error. The next branch would begin beyond its boundary.
    fn end_by_law(&self, nodal: &mut Nodal, polynomial: f64) {
        let (p, instant) = (nodal.force.len(), self.kernel.instant());
        let (x, mut rate) = (nodal.x[p], nodal.rate[p]);
        let without_force = rate + instant * polynomial;
        for _ in 0..4 {
            let Force { force, damping, .. } = self.law.force(&self.branch, x, rate);
            rate -= (rate - without_force + instant * force) / (1.0 + instant * damping);
        }
        if rate.is_finite() {
            nodal.rate[p] = rate;
        }
    }

    /// Solves the equations that are set, from a guess.
    fn solve(&mut self, mut nodal: Nodal) -> Result<Nodal, Fault> {
        self.equations.solve(self.law, &self.branch, 1e-6 * self.settings.tolerance, &mut nodal)?;
        Ok(nodal)
    }

    /// The scale of impulses after a panel with these forces.
    fn scale_after(&self, h: f64, force: &[f64]) -> f64 {
        (largest_of(force) * h).max(self.impulse_scale * (-0.5 * h / self.natural_times.contact).exp())
    }

    /// The size of the terms in the compression and its rate up to a time from now on, whose rounding these have.
    fn terms(&self, h: f64) -> [f64; 2] {
        let [x, rate] = self.terms_since_origin(h);
        [x + self.origin_terms[0], rate + self.origin_terms[1]]
    }

    /// Those that came up since the origin.
    fn terms_since_origin(&self, h: f64) -> [f64; 2] {
        let rate = self.slope.abs() + self.passed.impulse;
        [self.x_origin.abs() + self.near_at_origin.abs() + rate * (self.since + h), rate]
    }

    /// The first boundary that a panel meets.
    fn event(&self, trial: &Trial) -> Option<Event> {
        let margins = self.law.margins(&self.branch);
        let Nodal { x, rate, .. } = &trial.nodal;
        let (x_size, rate_size, [x_terms, rate_terms]) = (largest_of(x), largest_of(rate), self.terms(trial.h));
        let noise = |margin: &Margin| {
            let local = margin.per_compression.abs() * x_size + margin.per_rate.abs() * rate_size;
            1e-12 * local + 4e-15 * margin.size(x_terms, rate_terms + rate_size)
        };
        first(self.kernel.tables, trial.kind, &margins, [&trial.x_series, &trial.rate_series], noise)
    }

    /// Accepts a panel that ends where the boundary is met, from a guess of its length. Returns whether there is one that is
    /// resolved.
    fn land(&mut self, event: Event, guess: f64) -> bool {
        let margins = self.law.margins(&self.branch);
        let Some(margin) = margins.get(event.which) else { return false };
        let (mut length, mut last) = (guess, f64::INFINITY);
        for _ in 0..20 {
            let Ok(trial) = self.attempt(Kind::End, length) else { return false };
            let (x, rate) = trial.end();
            let value = margin.at(x, rate);
            let slope = margin.per_compression * rate + margin.per_rate * trial.end_acceleration();
            let step = -value / slope;
            if !(slope < 0.0 && step.is_finite()) {
                return false;
            }
            // converged, or as far as rounding lets the steps shrink
            let small = (4e-16 * (self.since + length)).max(1e-5 * self.settings.tolerance.max(1e-9) * length);
            let stalled = step.abs() < 1e-6 * length && step.abs() > 0.1 * last;
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
            last = step.abs();
            length += step.clamp(-0.5 * length, 0.5 * guess);
        }
        false
    }

    /// Adds a panel to the record.
    fn take(&mut self, trial: Trial) {
        let (x_end, rate_end) = trial.end();
        let Trial { kind, h, mut nodal, x_series, f_series, impulse_scale, .. } = trial;
        let tables = self.kernel.tables;
        nodal.x.truncate(tables.p);
        let (found, falling) = turns(tables, kind, &x_series, self.falling);
        for (fraction, compression, minimum) in found {
            self.turns.push(Turn { after: self.now() + fraction * h, compression, minimum });
        }
        self.falling = falling;
        // the sum of all coefficients bounds the force
        if f_series.iter().map(|c| c.abs()).sum::<f64>() > self.peak_force {
            self.peak_force = self.peak_force.max(largest(&tables.sample, &f_series));
        }
        self.impulse_scale = impulse_scale;
        self.force = series(&f_series, variable(kind, 1.0));
        let Passed { impulse, moment } = self.passed_since_touch;
        let (mass, lever) = self.kernel.totals(kind);
        let panel = Passed { impulse: h * dot(mass, &nodal.force), moment: h * h * dot(lever, &nodal.force) };
        self.passed.add(h, panel);
        self.passed_since_touch.add(h, panel);
        self.since += h;
        self.panels += 1;
        (self.x, self.rate) = (x_end, rate_end);
        let start = self.now() - h;
        if self.kernel.has_after_effect() {
            self.near.push(Solved::new(self.kernel, kind, self.since, h, nodal.force.clone(), f_series));
        }
        self.record.push(Panel { kind, start, h, x: nodal.x, force: nodal.force, impulse, moment });
    }

    /// Moves the origin of time to the present. The oldest panels become impulses, as long as they lie far enough back. The free
    /// motion after all impulses remains to be computed.
    fn move_origin(&mut self, is_far: impl Fn(&Solved) -> bool) {
        let p = self.since;
        self.origin_terms = self.terms_since_origin(0.0);
        self.slope += self.free.bend_and_gain(p).1 - self.passed.impulse;
        self.past.advance(p);
        let count = self.near.iter().take_while(|panel| is_far(panel)).count();
        let moved: Vec<Solved> = self.near.drain(..count).collect();
        if let (Some(oldest), Some(youngest)) = (moved.first(), moved.last()) {
            let mut impulses = Vec::new();
            for panel in &moved {
                let behind = p - panel.end;
                impulses.extend(panel.impulses(self.kernel.tables, behind, behind));
            }
            // from now on their share of the rate is part of the slope
            let share = |impulse: &Impulse| impulse.weight * self.kernel.slope(impulse.age);
            self.slope -= impulses.iter().map(share).sum::<f64>();
            self.past.push(impulses, p - youngest.end, p - oldest.end + oldest.h);
        }
        self.origin += p;
        self.near.iter_mut().for_each(|panel| panel.end -= p);
        self.hint.iter_mut().for_each(|hint| hint.start -= p);
        (self.since, self.passed, self.panels, self.x_origin) = (0.0, Passed::default(), 0, self.x);
        let mut at_origin = [0.0];
        for panel in &self.near {
            panel.add_after_effect(self.kernel, -panel.end, &[0.0], &mut at_origin, &mut []);
        }
        [self.near_at_origin] = at_origin;
    }

    /// The present compression. By a stiff law the force at the end of a panel tells it with more digits than its terms have; left
    /// uncorrected, their rounding would set off a vibration that needs short panels.
    fn compression_by_law(&self) -> f64 {
        let at_end = self.law.force(&self.branch, self.x, self.rate);
        let [x_rounding, rate_rounding] = self.terms_since_origin(0.0).map(|size| 1e-15 * size);
        let by_x = at_end.stiffness * x_rounding;
        let matters = by_x > self.settings.tolerance * self.force.abs() && by_x > at_end.damping.abs() * rate_rounding;
        let correction = (self.force - at_end.force) / at_end.stiffness;
        if matters && correction.abs() < 10.0 * x_rounding { self.x + correction } else { self.x }
    }

    /// The first minimum of the compression.
    pub fn first_minimum(&self) -> Option<f64> {
        self.turns.iter().find(|turn| turn.minimum).map(|turn| turn.compression)
    }

    /// Travel of the body towards the structure since touch.
    pub fn body_travel(&self) -> f64 {
        self.touch.body * self.now() - self.passed_since_touch.moment
    }

    /// What is kept of the contact, at whose touch the body had travelled `body_travel`.
    pub fn record(&mut self, body_travel: f64) -> Record {
        let (panels, turns) = (std::mem::take(&mut self.record), std::mem::take(&mut self.turns));
        Record { panels, turns, peak_force: self.peak_force, body_travel }
    }

    /// The flight that follows release, and the past as seen from there.
    pub fn departure(mut self) -> (Departure, History) {
        self.move_origin(|_| true);
        let free = FreeMotion::new(self.kernel, &self.past);
        // no force acts any more, so that the speed of the structure follows from the past alone: the sum of both speeds has the
        // digits that one minus all impulses loses as the striker slows down
        let body = self.slope + free.structure_speed();
        (
            Departure { x: self.x, rate: self.slope, body, terms: self.origin_terms[1] + free.structure_speed(), free },
            self.past,
        )
    }
}

/// The largest absolute value.
fn largest_of(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| largest.max(value.abs()))
}

impl Trial {
    /// Whether what may be rounding is as large as the force, of which no digit is known then, nor its sign.
    fn is_noise(&self) -> bool {
        self.is_rounding
            && NOISE * largest_of(&self.f_series[self.f_series.len() - 2..]) > largest_of(&self.nodal.force)
    }

    /// Compression and its rate at the end.
    fn end(&self) -> (f64, f64) {
        let p = self.nodal.force.len();
        let rate = match self.kind {
            _ if !self.rate_series.is_empty() => self.nodal.rate[p],
            Kind::Start => 0.5 * series_slope(&self.x_series, 1.0) / self.h,
            Kind::Middle => series_slope(&self.x_series, 1.0) / self.h,
            Kind::End => -0.5 * curvature(&self.x_series) / self.h,
        };
        (self.nodal.x[p], rate)
    }

    /// Rate of the rate of compression at the end of an end panel, where the contact follows the rate.
    fn end_acceleration(&self) -> f64 {
        -0.5 * curvature(&self.rate_series) / self.h
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::infinite::receptance::{Receptance, Term, UNIT};
    use contact_models::Hertz;

    /// One start panel of fixed length: every four nodes more gain two digits and more, down to
    /// rounding.
    #[test]
    fn a_panel_converges_spectrally() {
        let beam = Receptance::new(&[Term { coefficient: 1.0, power: 0.5 }]).unwrap();
        let hertz = Hertz::new(15.0_f64.sqrt()).unwrap();
        let law = Scaled { law: &hertz, scale: beam.scale(&UNIT).unwrap(), rounding: 0.0 };
        let x_end = |nodes: usize| {
            let settings = Settings { nodes, ..Settings::default() };
            let kernel = Kernel::new(&beam, &law.scale, nodes);
            let mut contact = Contact::new(&kernel, &law, &settings, Touch::first(), History::default());
            contact.attempt(Kind::Start, 0.8).ok().map(|trial| trial.end().0).unwrap()
        };
        let exact = x_end(32);
        let errors = [8, 12, 16, 20].map(|nodes| (x_end(nodes) - exact).abs());
        for pair in errors.windows(2) {
            assert!(pair[1] < 1e-2 * pair[0] || pair[1] < 1e-15, "{errors:?}");
        }
        assert!(errors[0] > 1e-12 && errors[3] < 1e-13, "{errors:?}");
    }
}
