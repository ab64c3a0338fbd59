//! One contact, from touch to separation or into sustained contact.
//!
//! Each contact is solved in its own natural units. With closing speed `v0` at touch, the unit
//! of time `w` is chosen such that `sqrt(S v0) (w^(5/2) + w^b) = 1` with `b = 2` for the beam and
//! `3/2` for the plate, and `x = v0 w xi(theta)`, `t = t0 + w theta`. On a local time origin
//! (`theta = 0` at touch, and moved forward in a long contact) the Volterra equation reads
//!
//! ```text
//! xi = xi_0 + slope theta + theta^2 sum_j c_j / (sqrt(d_j + theta) + sqrt(d_j))^2
//!      - int [ A (theta - phi) + B K(theta - phi) ] xi_+^(3/2) d phi,     A + B = 1,
//! ```
//!
//! where the sum over earlier impulses (ages `d_j`) is `x` of free motion with its line removed,
//! every term positive: no digits are lost however late the contact comes.

use super::collocate::Equations;
use super::flight::Departure;
use super::free::{Forcing, Free};
use super::history::{History, Impulse};
use super::panel::{Panel, curvature, end_acceleration, hertz, turns, variable};
use super::piece::Piece;
use super::problem::{Settings, Structure};
use super::rule::{Kind, Tables, dot, series, series_slope};
use super::sustained::Watch;
use super::units::{Touch, Units};
use crate::panel::root::{EXACTLY, root};

/// How the integration of a contact ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Ending {
    /// Separation, this long after touch (units of `T`).
    Separated(f64),
    /// The contact is known to last; integrated up to this time after touch.
    Sustained(f64),
    /// Stopped at the first minimum of the compression, as requested (units of `v T`).
    Minimum(f64),
    /// The limit on panels was reached at this time after touch.
    Limit(f64),
}

/// A local extremum of the compression within a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turn {
    /// Time after touch, units of `T`.
    pub after: f64,
    /// Compression, units of `v T`.
    pub compression: f64,
    /// Whether it is a minimum.
    pub minimum: bool,
}

/// The integration of one contact.
pub(super) struct March<'a> {
    structure: Structure,
    tables: &'static Tables,
    settings: &'a Settings,
    touch: Touch,
    pub units: Units,
    /// Impulses before the time origin, by age at the origin (units of `T`).
    pub history: History,
    free: Forcing,
    /// Scaled time from touch to the time origin.
    origin: f64,
    x_origin: f64,
    slope: f64,
    /// Recent panels that are not part of the history yet, and their memory at the origin.
    near: Vec<Panel>,
    near_at_origin: f64,
    /// `int f` and `int (p - s) f ds` from the origin to the present `p`.
    impulse: f64,
    moment: f64,
    /// Same from touch.
    impulse_since_touch: f64,
    moment_since_touch: f64,
    /// Present compression and its rate.
    x: f64,
    rate: f64,
    falling: bool,
    /// Slowly decaying maximum of the force, the scale of the resolution.
    f_scale: f64,
    pub pieces: Vec<Piece>,
    pub turns: Vec<Turn>,
    pub trials: usize,
    equations: Equations,
    /// The last panel solved, taken or not.
    hint: Option<Hint>,
    /// Memory for the times of the nodes of the trial panel after some earlier moment.
    later: Vec<f64>,
}

/// A solution near which that of the next panel lies.
struct Hint {
    kind: Kind,
    /// Start on the contact's current time origin.
    start: f64,
    h: f64,
    x_series: Vec<f64>,
}

/// A trial panel.
struct Trial {
    kind: Kind,
    start: f64,
    h: f64,
    /// Compression at the nodes.
    x: Vec<f64>,
    x_series: Vec<f64>,
    x_end: f64,
    /// Unresolved part of the force relative to its scale.
    tail: f64,
    /// The requested tolerance, or the rounding error of the force if that is larger.
    attainable: f64,
}

impl<'a> March<'a> {
    pub fn new(structure: Structure, settings: &'a Settings, touch: Touch, history: History) -> March<'a> {
        let mut march = March {
            structure,
            tables: Tables::get(structure, settings.nodes),
            settings,
            units: Units::new(structure, touch.s, touch.closing),
            touch,
            history,
            free: Forcing::default(),
            origin: 0.0,
            x_origin: 0.0,
            slope: 1.0,
            near: Vec::new(),
            near_at_origin: 0.0,
            impulse: 0.0,
            moment: 0.0,
            impulse_since_touch: 0.0,
            moment_since_touch: 0.0,
            x: 0.0,
            rate: 1.0,
            falling: false,
            f_scale: 0.0,
            pieces: Vec::new(),
            turns: Vec::new(),
            trials: 0,
            equations: Equations::default(),
            hint: None,
            later: Vec::new(),
        };
        march.free = march.free_motion();
        march
    }

    /// Speed of the body towards the structure (units of `v`).
    pub fn body_speed(&self) -> f64 {
        self.touch.body - self.units.impulse * self.impulse_since_touch
    }

    /// Integrates until the contact ends, lasts, or (if requested) passes its first minimum.
    pub fn run(&mut self, to_minimum: bool, budget: usize) -> Ending {
        let mut watch = Watch::new(self.structure, self.touch.s, self.touch.time);
        let mut kind = Kind::Start;
        let mut p = 0.0_f64;
        let mut h = 0.8_f64;
        while self.trials < budget {
            let floor = 1e-10 * (1.0 + p);
            let Some(trial) = self.attempt(kind, p, h) else {
                h *= 0.5;
                continue;
            };
            let (found, falling) = turns(self.tables, kind, &trial.x_series, self.falling);
            let first_low = found.iter().find(|turn| turn.2 && turn.1 < 0.0).map(|turn| turn.0);
            let low = first_low.or((trial.x_end < 0.0).then_some(1.0));
            let ratio = trial.tail / trial.attainable;
            if h > floor && (low.is_some() || ratio > 1.0) {
                // the panel is not accepted: a separation may lie ahead, or the panel is too long
                let shorter = h * (0.9 * ratio.powf(-1.0 / self.tables.p as f64)).clamp(0.25, 0.8);
                if kind == Kind::Middle
                    && let Some(length) = separation_ahead(&trial, low, &found)
                {
                    if let Some(ending) = self.finish(p, length) {
                        return ending;
                    }
                    h = shorter.min(0.5 * length).max(floor);
                } else {
                    h = shorter.max(floor);
                }
                continue;
            }
            let (trial_tail, attainable) = (trial.tail, trial.attainable);
            let minima = self.accept(trial, &found, falling);
            if to_minimum && let Some(minimum) = minima {
                return Ending::Minimum(minimum);
            }
            if let Some(piece) = self.pieces.last() {
                watch.see(&self.units, self.tables, piece);
            }
            p += h;
            let elapsed = self.units.time * (self.origin + p);
            if watch.lasting() && self.touch.time + elapsed >= self.settings.horizon {
                return Ending::Sustained(elapsed);
            }
            kind = Kind::Middle;
            // below 4e-15 the coefficients are rounding and say nothing about the length
            let unresolved = (trial_tail - 4e-15).max(1e-30) / attainable;
            let growth = 0.95 * unresolved.powf(-1.0 / self.tables.p as f64);
            // a panel of the smallest length was accepted as it is: continue after it
            h *= if h <= floor { 4.0 } else { growth.clamp(1.0, 2.0) };
            if self.near.len() >= 12 {
                self.move_origin(p, false);
                p = 0.0;
            }
        }
        Ending::Limit(self.units.time * (self.origin + p))
    }

    /// Free part of `xi` plus what earlier panels of this contact add, at the nodes and the end of a panel from the
    /// present `p`, up to which `impulse` and `moment` count: the right-hand sides of its equations.
    fn know(&mut self, kind: Kind, p: f64, h: f64) {
        let known = &mut self.equations.known;
        let elapsed = &self.tables.rule(kind).elapsed;
        known.clear();
        known.resize(elapsed.len(), -self.near_at_origin);
        for panel in &self.near {
            let behind = (p - panel.start - panel.h).max(0.0);
            self.later.clear();
            self.later.extend(elapsed.iter().map(|e| behind + h * e));
            panel.add_memory(self.structure, self.tables, &self.later, known);
        }
        for (known, e) in known.iter_mut().zip(elapsed) {
            let theta = p + h * e;
            *known = self.x_origin + self.slope * theta + theta * theta * self.free.bend(theta)
                - self.units.linear * (self.moment + self.impulse * h * e)
                - self.units.memory * *known;
        }
    }

    /// A guess of the compression at the nodes of a panel from the present `p`: that of the last solved panel or, beyond it, a
    /// parabola.
    fn guess(&self, kind: Kind, p: f64, h: f64) -> Vec<f64> {
        let rule = self.tables.rule(kind);
        let elapsed = &rule.elapsed[..self.tables.p];
        let Some(hint) = &self.hint else {
            return elapsed.iter().map(|e| self.x + self.rate * h * e).collect();
        };
        let offset = (p - hint.start) / hint.h;
        let scale = h / hint.h;
        if offset < 0.5 {
            let at = |e: &f64| series(&hint.x_series, variable(hint.kind, offset + scale * e));
            return elapsed.iter().map(at).collect();
        }
        let bend = 0.5 * end_acceleration(hint.kind, hint.h, &hint.x_series);
        let bound = self.x + h * self.rate.abs();
        let at = |e: &f64| (self.x + h * e * (self.rate + h * e * bend)).min(bound).max(0.0);
        elapsed.iter().map(at).collect()
    }

    /// Solves one panel from the present `p`; `None` if Newton's method failed.
    fn attempt(&mut self, kind: Kind, p: f64, h: f64) -> Option<Trial> {
        self.trials += 1;
        let n = self.tables.p;
        let rule = self.tables.rule(kind);
        let linear = self.units.linear * h * h;
        let memory = self.units.memory
            * match self.structure {
                Structure::Beam => h * h.sqrt(),
                Structure::Plate => h,
            };
        self.know(kind, p, h);
        let matrix = &mut self.equations.matrix;
        matrix.clear();
        matrix.extend(rule.linear.iter().zip(&rule.memory).map(|(l, m)| linear * l + memory * m));
        let mut x = self.guess(kind, p, h);
        self.hint = None;
        if !self.equations.solve(&mut x, 1e-6 * self.settings.tolerance) {
            return None;
        }
        let f: Vec<f64> = x.iter().map(|&x| hertz(x)).collect();
        let x_end = self.equations.end(&f);
        let x_series = self.tables.coefficients(&x);
        let largest = f.iter().fold(0.0_f64, |a, &b| a.max(b));
        let scale = largest.max(self.f_scale * (-0.5 * h).exp()).max(f64::MIN_POSITIVE);
        let last_rows = self.tables.to_legendre[(n - 2) * n..].chunks_exact(n);
        let tail = last_rows.fold(0.0_f64, |a, row| a.max(dot(row, &f).abs())) / scale;
        let terms = self.x_origin + (self.slope.abs() + self.units.linear * self.impulse) * (p + h);
        let noise = 1e-15 * terms * 1.5 * largest.cbrt() / scale;
        let attainable = self.settings.tolerance.max(noise);
        self.hint = Some(Hint { kind, start: p, h, x_series: x_series.clone() });
        Some(Trial { kind, start: p, h, x, x_series, x_end, tail, attainable })
    }

    /// Tries a mapped end panel over the last stretch; `None` if it is not resolved, or if there
    /// is no separation after all.
    fn finish(&mut self, p: f64, guess: f64) -> Option<Ending> {
        let (mut length, mut last) = (guess, f64::INFINITY);
        for _ in 0..40 {
            let trial = self.attempt(Kind::End, p, length)?;
            // x = x_end + (te - t) |x'|, and te - t = length sigma^2
            let slope = -0.5 * curvature(&trial.x_series) / length;
            let step = -trial.x_end / slope;
            if slope >= 0.0 || !step.is_finite() {
                return None;
            }
            if step.abs() < 1e-3 * length && trial.tail > trial.attainable && length > 1e-9 {
                return None;
            }
            // converged, or as far as rounding lets the steps shrink
            let enough = (4e-16 * (p + length)).max(1e-5 * self.settings.tolerance * length);
            let settled = step.abs() <= enough || (step.abs() < 1e-6 * length && step.abs() > 0.1 * last);
            last = step.abs();
            if settled {
                let (found, falling) = turns(self.tables, Kind::End, &trial.x_series, self.falling);
                if found.iter().any(|turn| turn.2 && turn.1 <= 0.0) {
                    return None;
                }
                self.accept(trial, &found, falling);
                self.move_origin(p + length, true);
                return Some(Ending::Separated(self.units.time * self.origin));
            }
            length += step.clamp(-0.5 * length, 0.5 * guess);
        }
        None
    }

    /// Adds a panel to the record; returns the first minimum in it.
    fn accept(&mut self, trial: Trial, found: &[(f64, f64, bool)], falling: bool) -> Option<f64> {
        let panel = Panel::new(self.tables, trial.kind, trial.start, trial.h, trial.x);
        let (impulse, moment) = (panel.impulse(self.tables), panel.moment(self.tables));
        for &(elapsed, x, minimum) in found {
            let after = self.units.time * (self.origin + panel.start + elapsed * panel.h);
            self.turns.push(Turn { after, compression: self.units.length * x, minimum });
        }
        self.pieces.push(Piece {
            kind: panel.kind,
            start: self.origin + panel.start,
            h: panel.h,
            x: panel.x.clone(),
            force: None,
            impulse: self.impulse_since_touch,
            moment: self.moment_since_touch,
        });
        self.moment += self.impulse * panel.h + moment;
        self.moment_since_touch += self.impulse_since_touch * panel.h + moment;
        self.impulse += impulse;
        self.impulse_since_touch += impulse;
        self.x = trial.x_end.max(0.0);
        self.rate = match panel.kind {
            Kind::Start => 0.5,
            _ => 1.0,
        } * series_slope(&trial.x_series, 1.0)
            / panel.h;
        self.falling = falling;
        let largest = panel.f.iter().fold(0.0_f64, |a, &b| a.max(b));
        self.f_scale = largest.max(self.f_scale * (-0.5 * panel.h).exp());
        self.near.push(panel);
        found.iter().find(|turn| turn.2).map(|turn| turn.1 * self.units.length)
    }

    /// Moves the time origin to the present `p`: panels far enough back join the history.
    fn move_origin(&mut self, p: f64, done: bool) {
        let ready = |panel: &Panel| {
            let behind = (p - panel.start - panel.h) / panel.h;
            done || behind >= if panel.kind == Kind::Start { 1.5 } else { 0.5 }
        };
        let count = self.near.iter().take_while(|panel| ready(panel)).count();
        self.slope += self.free.rate_gain(p) - self.units.linear * self.impulse;
        self.history.advance(self.units.time * p);
        let moved: Vec<Panel> = self.near.drain(..count).collect();
        if self.structure == Structure::Beam
            && let (Some(first), Some(last)) = (moved.first(), moved.last())
        {
            let youngest = self.units.time * (p - last.start - last.h).max(0.0);
            let oldest = self.units.time * (p - first.start);
            let impulses: Vec<Impulse> = moved.iter().flat_map(|panel| self.as_impulses(panel, p)).collect();
            // from now on their share of the rate is part of the slope
            let share: f64 = impulses.iter().map(|i| i.weight / (2.0 * i.age.sqrt())).sum();
            self.slope -= share / self.units.speed;
            self.history.push(impulses, youngest, oldest);
        }
        if !done {
            self.history.condense();
        }
        self.near.iter_mut().for_each(|panel| panel.start -= p);
        self.hint.iter_mut().for_each(|hint| hint.start -= p);
        self.origin += p;
        self.x_origin = self.x;
        (self.impulse, self.moment) = (0.0, 0.0);
        self.near_at_origin = self
            .near
            .iter()
            .map(|panel| panel.memory(self.structure, self.tables, (-panel.start - panel.h).max(0.0)))
            .sum();
        self.free = self.free_motion();
    }

    fn free_motion(&self) -> Forcing {
        Forcing::new(&self.history, self.units.time, self.units.speed * self.units.time.sqrt(), self.tables)
    }

    /// The flight that follows separation.
    pub fn departure(&self) -> Departure {
        let rate = self.units.speed * self.slope;
        let free = Free::new(&self.history, 1.0, 1.0);
        // The body's speed as the sum of both, not as 1 minus all impulses: close to the critical S
        // it falls below the rounding error of the latter.
        Departure { body: rate + free.structure_speed(), rate, free }
    }

    /// A panel of this contact as impulses, seen from the present `p`.
    fn as_impulses(&self, panel: &Panel, p: f64) -> Vec<Impulse> {
        let behind = p - panel.start - panel.h;
        let rule = self.tables.rule(panel.kind);
        // pairs (remaining fraction, weight); where the next panel is much shorter, nodes are close to the panel's end, so that
        // the impulses represent the panel from the present on
        let points: Vec<(f64, f64)> = match panel.kind {
            Kind::Start => (0..self.tables.p).map(|j| (rule.remaining[j], rule.mass[j] * panel.f[j])).collect(),
            Kind::End => {
                let weight = |s: f64, w: f64| w * 2.0 * s * series(&panel.f_series, s);
                self.tables.fine.iter().map(|&(s, w)| (s * s, weight(s, w))).collect()
            }
            Kind::Middle => {
                let (mut points, mut high) = (Vec::new(), 1.0);
                while high > 0.0 {
                    // the piece of remaining fractions (low, high) is seen from its own length or more
                    let low = if high * panel.h <= 2.0 * behind || high < 1e-12 { 0.0 } else { 0.5 * high };
                    points.extend((0..self.tables.p).map(|j| {
                        let remaining = low + (high - low) * self.tables.sigma[j];
                        (remaining, (high - low) * self.tables.weight[j] * series(&panel.f_series, 1.0 - remaining))
                    }));
                    high = low;
                }
                points
            }
        };
        points
            .into_iter()
            .filter(|&(_, weight)| weight > 0.0)
            .map(|(remaining, weight)| Impulse {
                age: self.units.time * (behind + panel.h * remaining),
                weight: self.units.impulse * panel.h * weight,
            })
            .collect()
    }
}

/// Time from the start of a rejected panel to the separation that its solution predicts.
fn separation_ahead(trial: &Trial, low: Option<f64>, found: &[(f64, f64, bool)]) -> Option<f64> {
    let h = trial.h;
    let Some(low) = low else {
        let rate = series_slope(&trial.x_series, 1.0) / h;
        return (rate < 0.0 && trial.x_end < -0.5 * h * rate).then(|| h - trial.x_end / rate);
    };
    // the compression falls from its last maximum before `low`
    let from = found.iter().filter(|turn| !turn.2 && turn.0 < low).map(|turn| turn.0).fold(0.0, f64::max);
    Some(h * zero(&trial.x_series, from, low))
}

/// Elapsed fraction of a middle panel at which a compression that is positive at `from` and not
/// at `to` falls to zero.
fn zero(x_series: &[f64], from: f64, to: f64) -> f64 {
    root(from, to, EXACTLY, |s| series(x_series, s))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One start panel of fixed length: every four nodes more gain two digits and more, down to
    /// rounding.
    #[test]
    fn a_panel_converges_spectrally() {
        let x_end = |nodes: usize| {
            let settings = Settings { nodes, ..Settings::default() };
            let touch = Touch { s: 15.0, time: 0.0, closing: 1.0, body: 1.0 };
            let mut march = March::new(Structure::Beam, &settings, touch, History::default());
            march.attempt(Kind::Start, 0.0, 2.0).unwrap().x_end
        };
        let exact = x_end(32);
        let errors = [8, 12, 16, 20].map(|nodes| (x_end(nodes) - exact).abs());
        for pair in errors.windows(2) {
            assert!(pair[1] < 1e-2 * pair[0] || pair[1] < 1e-15, "{errors:?}");
        }
        assert!(errors[0] > 1e-12 && errors[3] < 1e-13, "{errors:?}");
    }
}
