//! The tangent of a motion: how all of it changes with a parameter, to first order.
//!
//! The recorded panels are gone through once more. On each of them three things are differentiated.
//!
//! # A mode
//! With `L a = a'' + 2 beta a' + omega^2 a = f`, `beta = zeta omega`, and `t` the time since the start of the panel,
//!
//! ```text
//! L (t a)  = t f + 2 a' + 2 beta a
//! L (t a') = t f' + 2 f - 2 beta a' - 2 omega^2 a
//! ```
//!
//! so that what a change of frequency and damping does to a mode is its own motion times the time. The change `da` obeys
//! `L da = df - d(omega^2) a - 2 d(beta) a'`, and with `c_1 = omega dzeta/(1 - zeta^2)`, `c_2 = domega/omega - zeta
//! dzeta/(1 - zeta^2)`
//!
//! ```text
//! da = y - c_1 t a + c_2 t a',      L y = df + c_1 t f - c_2 (t f' + 2 f)
//! ```
//!
//! where `y` is the motion of the same mode under other forces, for which the propagators and responses of the panel
//! serve. Nothing is integrated numerically. At critical damping, `zeta = 1`, a change of damping has no such form.
//!
//! # The forces
//! `F = law(xi, xi')` at the nodes becomes linear: `(1 - F_xi R - F_rate D R) dF = F_xi dr + F_rate D dr + F_theta`, with
//! Newton's matrix of the panel and `dr` the change of the overlap under unchanged forces.
//!
//! # The loads
//! Modes are carried relative to their steady motion under the loads, which is known in closed form and with it its change.
//! What is carried moves freely, so that all of the above holds for it. A break of a load lies at a fixed time: the panel
//! before it is shorter by as much as its start is later.
//!
//! # The events
//! A panel that ends at an event changes its length by `dh = -dG/G'`, so that the event function `G` stays zero, and what
//! follows begins at the shifted time: every change is that at the event, wherever it has moved. Touches so stay
//! touches, and forces begin and end as `t^(3/2)` does after the change as before it. Where `G' = 0`, at a graze, there is
//! no derivative.

use super::change::{Change, Stencil};
use super::collocate::Blocks;
use super::dense::{Event, Stretch};
use super::load::Loads;
use super::load_change::LoadChange;
use super::problem::Posed;
use super::system::{Span, System};
use super::tables::{Forced, with_rigid_modes};
use crate::panel::dyadic::{Rotation, level_within, step_s};
use crate::panel::legendre::{BASIS, Nodal, Q, apply, derivative, evaluate, slopes};
use crate::panel::vector::vectorized;
use contact_models::{After, Boundary, Branch, ContactLaw, Force, Memory};
use std::array;
use std::collections::HashMap;
use std::rc::Rc;

/// Step, relative to the size of a variable, with which a law's own functions are differenced.
const LAW_STEP: f64 = 1e-6;
/// Two events stay together if their times shift by the same to this part.
const TOGETHER: f64 = 1e-6;

/// How an interval of contact changes.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct IntervalChange {
    pub contact: usize,
    pub start_s: f64,
    pub end_s: f64,
    pub impulse_n_s: f64,
    pub peak_force_n: f64,
    pub peak_compression_m: f64,
    pub approach_speed_m_s: f64,
    pub separation_speed_m_s: f64,
}

/// The change of a motion with one parameter.
#[derive(Clone)]
pub(crate) struct Tangent {
    /// Of the modes when the record ends, in the order of [`System`], and of that time; before, of what is carried of them.
    pub amplitude: Vec<f64>,
    pub rate: Vec<f64>,
    pub time_s: f64,
    pub intervals: Vec<IntervalChange>,
    contacts: Vec<Carried>,
}

/// What a contact carries from panel to panel: the change of ...
#[derive(Debug, Clone, Copy, Default)]
struct Carried {
    /// ... its overlap beyond that of the modes (m),
    reference: f64,
    /// the numbers of its branch: where it began (m), and the law's internal variable,
    branch: [f64; 2],
    /// and of the memory of an open one.
    memory: [f64; 2],
}

/// A contact along the record itself.
#[derive(Debug, Clone, Copy)]
struct Followed {
    branch: Option<Branch>,
    memory: Memory,
    overlap: f64,
    rate: f64,
    /// Sizes of overlap and rate so far.
    sizes: [f64; 2],
    /// Which interval is under way, its largest force and compression.
    interval: usize,
    peaks: [f64; 2],
}

/// All tangents of a record, and how the events met.
pub(crate) struct Tangents {
    pub tangents: Vec<Tangent>,
    /// The motion itself at the end.
    pub amplitude: Vec<f64>,
    pub rate: Vec<f64>,
    /// The slowest touch, in parts of the fastest: the derivatives do not exist where it is zero.
    pub nearest_graze: f64,
}

/// Free motion and responses of all modes on one length of panels, with what the changes weigh them by.
struct Expansion {
    rotation: Rotation,
    forced: Forced,
    /// `[p n + q]` over the closed contacts.
    own: Vec<[Nodal; Q]>,
    /// The same for each change: the weights of `F`, and of `t F` and `t F'` where modes change.
    changed: Vec<Vec<[Option<[Nodal; Q]>; 3]>>,
}

/// Expansions of panels whose length comes again, by that length and the contacts that are closed: for one system and the
/// same changes.
#[derive(Default)]
pub(crate) struct Expansions(HashMap<(u64, Vec<usize>), Rc<Expansion>>);

/// The closed contacts of a panel, as the record has them.
struct Solved {
    contact: usize,
    branch: Branch,
    /// Force by coefficients; at the nodes the force, `F'`, `t F` and `t F'`.
    force: Nodal,
    nodal: Nodal,
    force_rate: Nodal,
    timed: Nodal,
    timed_rate: Nodal,
    /// Compression and its rate at the nodes, with the law there.
    start: f64,
    compression: Nodal,
    rate: Nodal,
    law: [Force; Q],
    /// What a unit of weight would make of all modes by the end of the panel: by `F`, `t F` and `t F' + 2 F`.
    driven: [Motion; 3],
}

/// Amplitudes and rates of all modes.
type Motion = [Vec<f64>; 2];

/// A panel of the record, from one stretch to the next, with what all changes need of it.
struct Passage<'a> {
    from: &'a Stretch,
    /// Amplitudes and rates at its end.
    to: [&'a [f64]; 2],
    expansion: &'a Expansion,
    solved: &'a [Solved],
    /// Accelerations of all modes at its start and at its end.
    bends: [Vec<f64>; 2],
}

/// What fixes where a panel ends.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Ending {
    /// Its length.
    Length,
    /// An event of this contact.
    Event(usize, Event),
    /// A break of the loads.
    Break,
    /// The end of the time asked for.
    Run,
}

/// What one change does on one panel.
struct Moved {
    amplitude: Vec<f64>,
    rate: Vec<f64>,
    /// By the panel's closed contacts: change of force and overlap at the nodes.
    force: Vec<Nodal>,
    overlap: Vec<Nodal>,
}

/// What a contact sees of a change by free motion: at the start and at the nodes, and what is multiplied by the time.
#[derive(Default)]
struct Seen {
    start: f64,
    moved: Nodal,
    timed_start: f64,
    timed: Nodal,
}

struct Walk<'a> {
    posed: &'a Posed<'a>,
    system: &'a System,
    changes: &'a [Change<'a>],
    /// A weight of -1 for each mode that a contact sees, and whether any change moves modes.
    units: Vec<Vec<Span>>,
    modes_move: bool,
    /// The loads on the panel at hand, and how they change.
    loads: Loads,
    load_changes: Vec<Option<LoadChange>>,
    expansions: &'a mut Expansions,
    blocks: Blocks,
    contacts: Vec<Followed>,
    tangents: Vec<Tangent>,
    /// Intervals begun so far, the slowest touch and the fastest.
    begun: usize,
    touches: [f64; 2],
}

/// The tangents of a recorded motion. A record that ends at a fixed time ends with a stretch of no length, and `end_s` has how
/// that time changes with each parameter. `None` where there is no tangent: at a graze, where a law's own course forks, and for
/// the damping of a mode that is damped critically.
pub(crate) fn tangents(
    posed: &Posed,
    system: &System,
    stretches: &[Stretch],
    (changes, end_s): (&[Change], Option<&[f64]>),
    expansions: &mut Expansions,
) -> Option<Tangents> {
    let mut walk = Walk::new(posed, system, changes, expansions);
    for (i, stretch) in stretches.iter().enumerate() {
        // events that begin the record are met on a panel of no length
        if i == 0 && !stretch.events.is_empty() {
            walk.begin(stretch)?;
        }
        if let Some(next) = stretches.get(i + 1) {
            let is_last = i + 2 == stretches.len();
            walk.advance(stretch, next, end_s.filter(|_| is_last))?;
        }
    }
    let (amplitude, rate) = walk.end(stretches.last()?);
    let finite = |tangent: &Tangent| {
        let motion = tangent.amplitude.iter().chain(&tangent.rate);
        motion.sum::<f64>().is_finite() && tangent.time_s.is_finite()
    };
    let [slowest, fastest] = walk.touches;
    let nearest_graze = if fastest > 0.0 { slowest / fastest } else { 1.0 };
    walk.tangents.iter().all(finite).then_some(Tangents { tangents: walk.tangents, amplitude, rate, nearest_graze })
}

fn sum(spans: &[Span], values: &[f64]) -> f64 {
    spans.iter().map(|span| span.sum(values)).sum()
}

fn add(to: &mut Nodal, factor: f64, from: &Nodal) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += factor * from);
}

fn times(one: &Nodal, other: &Nodal) -> Nodal {
    array::from_fn(|i| one[i] * other[i])
}

impl<'a> Walk<'a> {
    fn new(
        posed: &'a Posed<'a>,
        system: &'a System,
        changes: &'a [Change<'a>],
        expansions: &'a mut Expansions,
    ) -> Walk<'a> {
        let unit = |span: &Span| Span { modes: span.modes.clone(), psi: vec![-1.0; span.psi.len()] };
        let followed = |gap: &f64| Followed {
            branch: None,
            memory: Memory::default(),
            overlap: -gap,
            rate: 0.0,
            sizes: [0.0; 2],
            interval: 0,
            peaks: [0.0; 2],
        };
        let tangent = |change: &Change| Tangent {
            amplitude: change.amplitude.clone(),
            rate: change.rate.clone(),
            time_s: 0.0,
            intervals: Vec::new(),
            contacts: change.gap_m.iter().map(|gap| Carried { reference: -gap, ..Carried::default() }).collect(),
        };
        Walk {
            posed,
            system,
            changes,
            units: system.links.iter().map(|link| link.spans.iter().map(unit).collect()).collect(),
            modes_move: changes.iter().any(|change| change.moves_modes),
            loads: Loads::new(posed.loads, system),
            load_changes: changes.iter().map(|change| change.loads.clone()).collect(),
            expansions,
            blocks: Blocks::default(),
            contacts: posed.gaps_m.iter().map(followed).collect(),
            tangents: changes.iter().map(tangent).collect(),
            begun: 0,
            touches: [f64::INFINITY, 0.0],
        }
    }

    /// Change of an overlap and its rate at a time, for a state and its change.
    fn overlap(&self, d: usize, c: usize, time_s: f64, state: [&[f64]; 2], change: [&[f64]; 2]) -> [f64; 2] {
        let (link, psi) = (&self.system.links[c], &self.changes[d].psi[c]);
        let beyond = self.beyond(d, c, time_s);
        array::from_fn(|i| sum(psi, state[i]) + link.sum(change[i]) + beyond[i])
    }

    /// The part of it that is not seen of the modes as they are carried.
    fn beyond(&self, d: usize, c: usize, time_s: f64) -> [f64; 2] {
        let mut found = [self.tangents[d].contacts[c].reference, 0.0];
        if !self.loads.is_empty() {
            let later = self.tangents[d].time_s;
            found[0] += later * self.loads.overlap(c, time_s).1;
            found[1] += later * self.loads.bend(c, time_s);
        }
        if let Some(loads) = &self.load_changes[d] {
            let by_loads = loads.overlap(c, time_s);
            (0..2).for_each(|i| found[i] += by_loads[i]);
        }
        found
    }

    /// How free motion from `y` and from the state moves what a contact sees of the change: in one pass over the modes.
    fn seen(&self, d: usize, c: usize, forced: &Forced, y: [&[f64]; 2], [a, b, bend]: [&[f64]; 3]) -> Seen {
        let change = &self.changes[d];
        let mut seen = Seen::default();
        for (Span { modes, psi }, Span { psi: by, .. }) in self.system.links[c].spans.iter().zip(&change.psi[c]) {
            let at_nodes = &forced.at_nodes[modes.clone()];
            let [ya, yb] = y.map(|values| &values[modes.clone()]);
            let [a, b, bend] = [a, b, bend].map(|values| &values[modes.clone()]);
            let (start, moved) = swept(at_nodes, [psi, by, ya, yb, a, b], |[psi, by, ya, yb, a, b]| {
                (psi * ya + by * a, psi * yb + by * b)
            });
            seen.start += start;
            add(&mut seen.moved, 1.0, &moved);
            if change.moves_modes {
                let [fade, stretch] = [&change.fade, &change.stretch].map(|values| &values[modes.clone()]);
                let (start, timed) =
                    swept(at_nodes, [psi, fade, stretch, a, b, bend], |[psi, fade, stretch, a, b, bend]| {
                        (psi * (stretch * b - fade * a), psi * (stretch * bend - fade * b))
                    });
                seen.timed_start += start;
                add(&mut seen.timed, 1.0, &timed);
            }
        }
        seen
    }

    /// From what is carried to the whole motion at the end of the record.
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

    // ---- one panel ----

    fn begin(&mut self, first: &Stretch) -> Option<()> {
        let moved = self.tangents.iter().map(|tangent| Moved {
            amplitude: tangent.amplitude.clone(),
            rate: tangent.rate.clone(),
            force: Vec::new(),
            overlap: Vec::new(),
        });
        let moved = moved.collect();
        let state = [first.amplitude.as_slice(), &first.rate];
        let bend = self.acceleration(first.start_s, state, &[], 0.0);
        let slide = Moved { amplitude: first.rate.clone(), rate: bend, force: Vec::new(), overlap: Vec::new() };
        let end = Arrival { length_s: 0.0, ending: ending(first), state, end_s: None, next: first };
        self.arrive(&end, &[], moved, Some(&slide))
    }

    /// From the start of a stretch to that of the next one; `end_s` has the changes of that time if the record ends there.
    fn advance(&mut self, stretch: &Stretch, next: &Stretch, end_s: Option<&[f64]>) -> Option<()> {
        let h = stretch.length_s;
        // what is carried jumps at a break
        let mut after = None;
        let (mut end_a, mut end_b) = (next.amplitude.clone(), next.rate.clone());
        while next.start_s >= after.as_ref().unwrap_or(&self.loads).next_break_s() {
            let loads = after.get_or_insert_with(|| self.loads.clone());
            let [mut jump, mut jump_rate] = [(); 2].map(|()| vec![0.0; end_a.len()]);
            loads.pass_break(self.system, next.start_s, &mut jump, &mut jump_rate);
            end_a.iter_mut().zip(&jump).for_each(|(end, jump)| *end -= jump);
            end_b.iter_mut().zip(&jump_rate).for_each(|(end, jump)| *end -= jump);
        }
        let state = [end_a.as_slice(), &end_b];
        let ending = match (ending(next), end_s) {
            // an event just at a break has no place of its own
            (Ending::Event(..), _) if after.is_some() => return None,
            (Ending::Length, _) if after.is_some() => Ending::Break,
            (Ending::Length, Some(_)) => Ending::Run,
            (ending, _) => ending,
        };
        let closed: Vec<usize> = stretch.forces.iter().map(|(c, _)| *c).collect();
        let expansion = self.expansion(h, &closed);
        let solved = self.solved(stretch, &expansion);
        if !closed.is_empty() {
            let values: Vec<[Force; Q]> = solved.iter().map(|solved| solved.law).collect();
            let n = closed.len();
            let shares = |p: usize, q: usize| self.system.neighbours[closed[p]].contains(&closed[q]);
            let response = |p: usize, q: usize| shares(p, q).then(|| &expansion.own[p * n + q]);
            self.blocks.factor(&values, &response, h);
        }
        let from = [stretch.amplitude.as_slice(), &stretch.rate];
        let bends = [
            self.acceleration(stretch.start_s, from, &solved, 0.0),
            self.acceleration(stretch.start_s + h, state, &solved, 1.0),
        ];
        let passage = Passage { from: stretch, to: state, expansion: &expansion, solved: &solved, bends };
        let moved = (0..self.changes.len()).map(|d| self.moved(d, &passage)).collect();
        let slide = (ending != Ending::Length).then(|| self.slide(&passage));
        for solved in &solved {
            let (c, followed) = (solved.contact, &mut self.contacts[solved.contact]);
            let moved = state[0].iter().zip(&stretch.amplitude).map(|(after, before)| after - before);
            followed.overlap += self.system.links[c].sum(&moved.collect::<Vec<f64>>());
            followed.overlap += self.loads.overlap(c, next.start_s).0 - self.loads.overlap(c, stretch.start_s).0;
            followed.sizes[0] = solved.compression.iter().fold(followed.sizes[0], |most, value| most.max(value.abs()));
        }
        self.arrive(&Arrival { length_s: h, ending, state, end_s, next }, &solved, moved, slide.as_ref())?;
        if let Some(after) = after {
            self.pass_breaks(after);
        }
        Some(())
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

    fn expansion(&mut self, h: f64, closed: &[usize]) -> Rc<Expansion> {
        let key = (h.to_bits(), closed.to_vec());
        if let Some(kept) = self.expansions.0.get(&key) {
            return kept.clone();
        }
        let system = self.system;
        let rotation = Rotation::new(&system.modes, h);
        let n = closed.len();
        // all weights in one list, so that each mode is expanded once
        let mut weights: Vec<Vec<f64>> = Vec::new();
        for &p in closed {
            for &q in closed {
                weights.push(system.shared(p, q));
            }
        }
        let mut places = Vec::new();
        for change in self.changes {
            let modes_move = change.moves_modes;
            for pair in 0..n * n {
                let [with, by] = [closed[pair / n], closed[pair % n]];
                let product = &weights[pair];
                let mut of_force = vec![0.0; product.len()];
                let [own, other] = [with, by].map(|c| &system.links[c]);
                let mut gather = |one: &[Span], two: &[Span]| {
                    for span in one {
                        for partner in two.iter().filter(|partner| partner.modes == span.modes) {
                            for (k, (a, b)) in span.modes.clone().zip(span.psi.iter().zip(&partner.psi)) {
                                of_force[k] += a * b;
                            }
                        }
                    }
                };
                gather(&change.psi[with], &other.spans);
                gather(&own.spans, &change.psi[by]);
                let by_mode = |factors: &[f64]| product.iter().zip(factors).map(|(w, factor)| w * factor).collect();
                let mut place = [Some(weights.len()), None, None];
                if modes_move {
                    of_force
                        .iter_mut()
                        .zip(product.iter().zip(&change.stretch))
                        .for_each(|(w, (p, c))| *w -= 2.0 * p * c);
                    let timed = [by_mode(&change.fade), by_mode(&change.stretch)];
                    place = [Some(weights.len()), Some(weights.len() + 1), Some(weights.len() + 2)];
                    weights.push(of_force);
                    weights.extend(timed);
                } else if of_force.iter().any(|weight| *weight != 0.0) {
                    weights.push(of_force);
                } else {
                    place[0] = None;
                }
                places.push(place);
            }
        }
        // a flight needs nothing but free motion
        let expand = || Forced::new(system, h, &Rotation::new(&system.modes, 0.5 * h), &weights);
        let (forced, elastic) = if closed.is_empty() { Default::default() } else { expand() };
        let whole: Vec<[Nodal; Q]> = elastic
            .iter()
            .zip(&weights)
            .map(|(elastic, weights)| {
                let rigid = system.modes.iter().zip(weights).filter(|(mode, _)| mode.is_rigid());
                with_rigid_modes(*elastic, rigid.map(|(_, weight)| weight).sum(), h)
            })
            .collect();
        let pick = |place: &[Option<usize>; 3]| place.map(|place| place.map(|i| whole[i]));
        let changed = places.chunks(n.max(1) * n.max(1)).map(|places| places.iter().map(pick).collect()).collect();
        let own = whole[..n * n].to_vec();
        let expansion = Rc::new(Expansion { rotation, forced, own, changed });
        if step_s(level_within(h)) == h {
            self.expansions.0.insert(key, expansion.clone());
        }
        expansion
    }

    fn solved(&self, stretch: &Stretch, expansion: &Expansion) -> Vec<Solved> {
        let (h, n) = (stretch.length_s, stretch.forces.len());
        let place = BASIS.nodes.map(|s| s * h);
        let of = |(p, (c, force)): (usize, &(usize, Nodal))| {
            let (link, followed) = (&self.system.links[*c], &self.contacts[*c]);
            let branch = stretch.contacts[*c].branch?;
            let mut compression = expansion.forced.free_at_nodes(&link.spans, &stretch.amplitude, &stretch.rate);
            let moved = |i: usize| self.loads.moved(*c, stretch.start_s, BASIS.nodes[i] * h).0;
            compression.iter_mut().enumerate().for_each(|(i, value)| *value += followed.overlap + moved(i));
            for (q, (_, other)) in stretch.forces.iter().enumerate() {
                let nodal = BASIS.nodes.map(|s| evaluate(other, s));
                add(&mut compression, 1.0, &apply(&expansion.own[p * n + q], &nodal));
            }
            let rate = slopes(followed.overlap, &compression, h);
            let law = self.posed.laws[*c];
            let nodal = BASIS.nodes.map(|s| evaluate(force, s));
            let slope = derivative(force);
            let force_rate = BASIS.nodes.map(|s| evaluate(&slope, s) / h);
            let (timed, timed_rate) = (times(&place, &nodal), times(&place, &force_rate));
            let driven = |nodal: &Nodal| {
                let [mut amplitude, mut rate] = [(); 2].map(|()| vec![0.0; self.system.modes.len()]);
                let force = BASIS.coefficients(nodal);
                expansion.forced.push(&self.units[*c], &force, &mut amplitude, &mut rate);
                [amplitude, rate]
            };
            let driven_by_timed = |nodal: &Nodal| if self.modes_move { driven(nodal) } else { Motion::default() };
            let again: Nodal = array::from_fn(|i| timed_rate[i] + 2.0 * nodal[i]);
            Some(Solved {
                contact: *c,
                branch,
                force: *force,
                driven: [driven(&nodal), driven_by_timed(&timed), driven_by_timed(&again)],
                timed,
                timed_rate,
                nodal,
                force_rate,
                start: followed.overlap,
                law: array::from_fn(|i| law.force(&branch, compression[i], rate[i])),
                compression,
                rate,
            })
        };
        stretch.forces.iter().enumerate().filter_map(of).collect()
    }

    /// Acceleration of what is carried of all modes in a state, under these forces at a place of their panel.
    fn acceleration(&self, time_s: f64, [a, b]: [&[f64]; 2], solved: &[Solved], place: f64) -> Vec<f64> {
        let system = self.system;
        let mut bend: Vec<f64> =
            (0..system.modes.len()).map(|k| -system.drag[k] * b[k] - system.square[k] * a[k]).collect();
        self.loads.rigid.iter().for_each(|&k| bend[k] += self.loads.line(k, time_s).0);
        for solved in solved {
            let force = evaluate(&solved.force, place);
            for span in &system.links[solved.contact].spans {
                span.modes.clone().zip(&span.psi).for_each(|(k, psi)| bend[k] -= psi * force);
            }
        }
        bend
    }

    /// A panel of unchanged length.
    fn moved(&self, d: usize, passage: &Passage) -> Moved {
        let (system, change, tangent) = (self.system, &self.changes[d], &self.tangents[d]);
        let Passage { from, expansion, solved, .. } = passage;
        let (h, n) = (from.length_s, solved.len());
        let (a, b) = (from.amplitude.as_slice(), from.rate.as_slice());
        let modes_move = change.moves_modes;
        let (fade, stretches) = (&change.fade, &change.stretch);
        // y and y' at the start
        let mut amplitude = tangent.amplitude.clone();
        let mut rate = tangent.rate.clone();
        if modes_move {
            vectorized(
                #[inline(always)]
                || {
                    let held = fade.iter().zip(a).zip(stretches.iter().zip(b));
                    for (rate, ((fade, a), (stretch, b))) in rate.iter_mut().zip(held) {
                        *rate += fade * a - stretch * b;
                    }
                },
            );
        }
        let (mut force, mut overlap) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for (p, own) in solved.iter().enumerate() {
            let c = own.contact;
            let Seen { start, moved: mut found, timed_start, mut timed } =
                self.seen(d, c, &expansion.forced, [&amplitude, &rate], [a, b, &passage.bends[0]]);
            let start = start + self.beyond(d, c, from.start_s)[0];
            found.iter_mut().for_each(|value| *value += start);
            timed.iter_mut().for_each(|value| *value += timed_start);
            for (q, other) in solved.iter().enumerate() {
                let [of_force, of_timed, of_timed_rate] = &expansion.changed[d][p * n + q];
                if let Some(response) = of_force {
                    add(&mut found, 1.0, &apply(response, &other.nodal));
                }
                if let Some(response) = of_timed {
                    add(&mut found, 1.0, &apply(response, &other.timed));
                    add(&mut timed, -1.0, &apply(response, &other.nodal));
                }
                if let Some(response) = of_timed_rate {
                    add(&mut found, -1.0, &apply(response, &other.timed_rate));
                    add(&mut timed, 1.0, &apply(response, &other.force_rate));
                }
            }
            for i in 0..Q {
                found[i] += BASIS.nodes[i] * h * timed[i];
            }
            for (found, s) in found.iter_mut().zip(BASIS.nodes).filter(|_| !self.loads.is_empty()) {
                *found += tangent.time_s * self.loads.moved_later(c, from.start_s, s * h);
            }
            if let Some(loads) = &self.load_changes[d] {
                found.iter_mut().zip(BASIS.nodes).for_each(|(found, s)| *found += loads.moved(c, from.start_s, s * h));
            }
            let slope = slopes(start, &found, h);
            let by_law = self.force_change(d, own);
            force.push(array::from_fn(|i| {
                own.law[i].per_compression_n_m * found[i] + own.law[i].per_rate_n_s_m * slope[i] + by_law[i]
            }));
            overlap.push(found);
        }
        if n > 0 {
            self.blocks.solve(&mut force);
        }
        for (p, found) in overlap.iter_mut().enumerate() {
            for (q, force) in force.iter().enumerate() {
                add(found, 1.0, &apply(&expansion.own[p * n + q], force));
            }
        }
        // y at the end
        expansion.rotation.apply(&mut amplitude, &mut rate);
        for (own, force) in solved.iter().zip(&force) {
            let c = own.contact;
            let link = &system.links[c];
            expansion.forced.push(&link.spans, &BASIS.coefficients(force), &mut amplitude, &mut rate);
            for (Span { modes, psi }, Span { psi: by, .. }) in link.spans.iter().zip(&change.psi[c]) {
                for (order, moved) in [&mut amplitude, &mut rate].into_iter().enumerate() {
                    let driven = own.driven.each_ref().map(|motion| motion[order].get(modes.clone()).unwrap_or(&[]));
                    let moved = &mut moved[modes.clone()];
                    let factors = modes_move.then(|| [&change.fade, &change.stretch].map(|row| &row[modes.clone()]));
                    add_driven(moved, (psi, by), factors, driven);
                }
            }
        }
        let rigid = (0..a.len()).filter(|&k| system.modes[k].is_rigid());
        if !self.loads.is_empty() || self.load_changes[d].is_some() {
            for k in rigid {
                let changes = self.load_changes[d].as_ref();
                let (push, slope) = changes.map_or((0.0, 0.0), |loads| loads.line(k, system, from.start_s));
                let push = push + tangent.time_s * self.loads.line(k, from.start_s).1;
                amplitude[k] += h * h * (0.5 * push + h * slope / 6.0);
                rate[k] += h * (push + 0.5 * h * slope);
            }
        }
        if modes_move {
            let ([a, b], bend) = (passage.to, &passage.bends[1]);
            vectorized(
                #[inline(always)]
                || {
                    let motion = a.iter().zip(b).zip(bend).zip(fade.iter().zip(stretches));
                    for ((amplitude, rate), (((a, b), bend), (fade, stretch))) in
                        amplitude.iter_mut().zip(&mut rate).zip(motion)
                    {
                        let moving = stretch * b - fade * a;
                        *amplitude += h * moving;
                        *rate += moving + h * (stretch * bend - fade * b);
                    }
                },
            );
        }
        Moved { amplitude, rate, force, overlap }
    }

    /// What a panel longer by a second would change at its end. The nodes move along with the end: forces there are those
    /// of the law, of which the polynomial's own slope may miss a little.
    fn slide(&self, passage: &Passage) -> Moved {
        let Passage { from, to, expansion, solved, bends } = passage;
        let (h, n) = (from.length_s, solved.len());
        let [mut amplitude, mut rate] = [(); 2].map(|()| vec![0.0; to[0].len()]);
        let mut force: Vec<Nodal> = solved
            .iter()
            .map(|own| {
                let bend = slopes(slope_at_start(own.start, &own.compression, h), &own.rate, h);
                array::from_fn(|i| {
                    let law = &own.law[i];
                    let by_law = law.per_compression_n_m * own.rate[i] + law.per_rate_n_s_m * bend[i];
                    BASIS.nodes[i] * (by_law - own.force_rate[i])
                })
            })
            .collect();
        if n > 0 {
            self.blocks.solve(&mut force);
        }
        let mut overlap = vec![[0.0; Q]; n];
        for p in 0..n {
            for (q, force) in force.iter().enumerate() {
                add(&mut overlap[p], 1.0, &apply(&expansion.own[p * n + q], force));
            }
            let spans = &self.system.links[solved[p].contact].spans;
            expansion.forced.push(spans, &BASIS.coefficients(&force[p]), &mut amplitude, &mut rate);
        }
        for k in 0..amplitude.len() {
            amplitude[k] += to[1][k];
            rate[k] += bends[1][k];
        }
        Moved { amplitude, rate, force, overlap }
    }

    /// Change of a contact's force at the nodes where the overlap does not change: by its law and its branch.
    fn force_change(&self, d: usize, own: &Solved) -> Nodal {
        let (change, c) = (&self.changes[d], own.contact);
        let mut found = [0.0; Q];
        let at = |law: &dyn ContactLaw, branch: &Branch, i: usize| {
            law.force(branch, own.compression[i], own.rate[i]).force_n
        };
        if let Some(laws) = &change.laws {
            for i in 0..Q {
                found[i] += change.stencil.slope(laws[c].map(|law| at(law, &own.branch, i)));
            }
        }
        let law = self.posed.laws[c];
        for (which, by) in self.tangents[d].contacts[c].branch.iter().enumerate().filter(|(_, by)| **by != 0.0) {
            let stencil = Stencil::central(LAW_STEP * size_of(&own.branch, which, &self.contacts[c]));
            let branches = stencil.offsets.map(|offset| shifted(&own.branch, which, offset));
            for i in 0..Q {
                found[i] += by * stencil.slope(branches.each_ref().map(|branch| at(law, branch, i)));
            }
        }
        found
    }

    // ---- the end of a panel ----

    /// The end of a panel: how far it moves, what is booked, and the events there.
    fn arrive(&mut self, end: &Arrival, solved: &[Solved], moved: Vec<Moved>, slide: Option<&Moved>) -> Option<()> {
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
                [overlap, link.sum(state[1]) + shift_rate]
            })
            .collect();
        for (followed, [_, rate]) in self.contacts.iter_mut().zip(&overlaps) {
            followed.rate = *rate;
            followed.sizes[1] = followed.sizes[1].max(rate.abs());
        }
        let peaks = self.peaks(solved);
        for (d, mut moved) in moved.into_iter().enumerate() {
            let mut longer = 0.0;
            if let Some(slide) = slide {
                longer = match ending {
                    Ending::Length => 0.0,
                    Ending::Event(c, event) => {
                        let change = self.overlap(d, c, time_s, state, [&moved.amplitude, &moved.rate]);
                        let (changes, slope) =
                            self.event_function(d, c, event, overlaps[c], change, self.speed(c, time_s, slide));
                        -changes / slope
                    }
                    Ending::Break => {
                        let later = self.load_changes[d].as_ref().map_or(0.0, LoadChange::next_break_s);
                        later - self.tangents[d].time_s
                    }
                    Ending::Run => end_s.map_or(0.0, |changes| changes[d]) - self.tangents[d].time_s,
                };
                if !longer.is_finite() {
                    return None;
                }
                for k in 0..moved.amplitude.len() {
                    moved.amplitude[k] += longer * slide.amplitude[k];
                    moved.rate[k] += longer * slide.rate[k];
                }
            }
            for (p, own) in solved.iter().enumerate() {
                if let Some(slide) = slide {
                    add(&mut moved.force[p], longer, &slide.force[p]);
                    add(&mut moved.overlap[p], longer, &slide.overlap[p]);
                }
                let interval = self.contacts[own.contact].interval;
                let force = BASIS.coefficients(&moved.force[p]);
                let overlap = BASIS.coefficients(&moved.overlap[p]);
                let Some(interval) = self.tangents[d].intervals.get_mut(interval) else { continue };
                interval.impulse_n_s += h * force[0] + longer * evaluate(&own.force, 1.0);
                let end = |place: f64, slope: f64| if place == 1.0 { longer * slope } else { 0.0 };
                let [by_force, by_compression] = &peaks[p];
                if let Some((place, slope)) = by_force {
                    interval.peak_force_n = evaluate(&force, *place) + end(*place, slope / h);
                }
                if let Some((place, slope)) = by_compression {
                    interval.peak_compression_m = evaluate(&overlap, *place) + end(*place, slope / h);
                }
            }
            let tangent = &mut self.tangents[d];
            (tangent.amplitude, tangent.rate) = (moved.amplitude, moved.rate);
            tangent.time_s += longer;
        }
        for (i, (c, event)) in next.events.iter().enumerate() {
            let apart = match slide {
                Some(slide) if i > 0 => self.apart(*c, *event, (time_s, state), overlaps[*c], slide)?,
                _ => vec![0.0; self.changes.len()],
            };
            self.transition((*c, *event), (time_s, state), overlaps[*c], &apart)?;
        }
        for (followed, seen) in self.contacts.iter_mut().zip(&next.contacts) {
            followed.branch = seen.branch;
        }
        Some(())
    }

    /// Rate of an overlap, and the rate of that, at the end of a panel that becomes longer.
    fn speed(&self, c: usize, time_s: f64, slide: &Moved) -> [f64; 2] {
        let link = &self.system.links[c];
        let (_, by_loads) = self.loads.overlap(c, time_s);
        [link.sum(&slide.amplitude) + by_loads, link.sum(&slide.rate) + self.loads.bend(c, time_s)]
    }

    /// By how much later than the event that ended the panel another event at the same time comes after a change. A contact
    /// whose force jumps at first touch then has no tangent here.
    fn apart(
        &self,
        c: usize,
        event: Event,
        (time_s, state): (f64, [&[f64]; 2]),
        overlap: [f64; 2],
        slide: &Moved,
    ) -> Option<Vec<f64>> {
        let speed = self.speed(c, time_s, slide);
        let jumps = match event {
            Event::Touch { .. } => {
                let law = self.posed.laws[c];
                let branch = law.touch(&self.contacts[c].memory, overlap[1].max(0.0));
                law.force(&branch, overlap[0], overlap[1]).force_n != 0.0
            }
            Event::Cross(_) => false,
        };
        let of = |(d, tangent): (usize, &Tangent)| {
            let change = self.overlap(d, c, time_s, state, [&tangent.amplitude, &tangent.rate]);
            let (changes, slope) = self.event_function(d, c, event, overlap, change, speed);
            let later = -changes / slope;
            // what cancels where both shift alike
            let parts =
                sum(&self.changes[d].psi[c], state[0]).abs() + self.system.links[c].sum(&tangent.amplitude).abs();
            let known = TOGETHER * (parts / slope).abs().max(tangent.time_s.abs());
            match later {
                _ if !later.is_finite() => None,
                _ if later.abs() <= known => Some(0.0),
                _ => (!jumps).then_some(later),
            }
        };
        self.tangents.iter().enumerate().map(of).collect()
    }

    /// Change of an event function at the end of an unchanged panel, and its rate of change with the length.
    fn event_function(
        &self,
        d: usize,
        c: usize,
        event: Event,
        [overlap, rate]: [f64; 2],
        change: [f64; 2],
        speed: [f64; 2],
    ) -> (f64, f64) {
        let carried = &self.tangents[d].contacts[c];
        let (Event::Cross(which), Some(branch)) = (event, self.contacts[c].branch) else {
            return (change[0] - carried.memory[0], speed[0]);
        };
        let law = self.posed.laws[c];
        let boundary = law.boundaries(&branch)[which];
        let along = |[xi, rate]: [f64; 2]| boundary.per_compression * xi + boundary.per_rate * rate;
        let margin = |law: &dyn ContactLaw, branch: &Branch| {
            let boundary: Boundary = law.boundaries(branch)[which];
            boundary.margin(overlap, rate)
        };
        let mut changes = along(change);
        if let Some(laws) = &self.changes[d].laws {
            changes += self.changes[d].stencil.slope(laws[c].map(|law| margin(law, &branch)));
        }
        for (which, by) in carried.branch.iter().enumerate().filter(|(_, by)| **by != 0.0) {
            let stencil = Stencil::central(LAW_STEP * size_of(&branch, which, &self.contacts[c]));
            let margins = stencil.offsets.map(|offset| margin(law, &shifted(&branch, which, offset)));
            changes += by * stencil.slope(margins);
        }
        (changes, along(speed))
    }

    /// The law's own transition.
    fn transition(
        &mut self,
        (c, event): (usize, Event),
        (at_s, state): (f64, [&[f64]; 2]),
        [overlap, rate]: [f64; 2],
        apart: &[f64],
    ) -> Option<()> {
        let law = self.posed.laws[c];
        let followed = self.contacts[c];
        let sizes = followed.sizes;
        // the numbers that the law makes, of the four that it is given
        type Given = [f64; 4];
        let (given, sizes): (Given, Given) = match (event, followed.branch) {
            (Event::Cross(_), Some(branch)) => {
                let own = [0, 1].map(|which| size_of(&branch, which, &followed));
                ([branch.anchor_m, branch.internal, overlap, rate], [own[0], own[1], sizes[0], sizes[1]])
            }
            _ => {
                let Memory { touch_m, internal } = followed.memory;
                let own = [sizes[0].max(touch_m.abs()), if internal == 0.0 { 1.0 } else { internal.abs() }];
                ([touch_m, internal, rate.max(0.0), 0.0], [own[0], own[1], rate.abs(), 1.0])
            }
        };
        let made = |law: &dyn ContactLaw, given: &Given| -> After {
            match (event, followed.branch) {
                (Event::Cross(which), Some(branch)) => {
                    let branch = Branch { anchor_m: given[0], internal: given[1], ..branch };
                    law.cross(&branch, which, given[2], given[3])
                }
                _ => {
                    let memory = Memory { touch_m: given[0], internal: given[1] };
                    After::Continue(law.touch(&memory, given[2]))
                }
            }
        };
        let after = made(law, &given);
        let number = |after: &After, which: usize| match (after, which) {
            (After::Continue(branch), 0) => branch.anchor_m,
            (After::Continue(branch), _) => branch.internal,
            (After::Release(memory), 0) => memory.touch_m,
            (After::Release(memory), _) => memory.internal,
        };
        let kind = |after: &After| match after {
            After::Continue(branch) => Some(branch.stage),
            After::Release(_) => None,
        };
        // a law that takes another course nearby has no derivative here
        let difference = |found: [After; 4], stencil: &Stencil<4>, which: usize| {
            let same = found.iter().all(|found| kind(found) == kind(&after));
            same.then(|| stencil.slope(found.each_ref().map(|found| number(found, which))))
        };
        // how these numbers change with a number given
        let by_given = |i: usize| {
            let stencil = Stencil::central(LAW_STEP * sizes[i]);
            let found = stencil.offsets.map(|offset| {
                let mut shifted = given;
                shifted[i] += offset;
                made(law, &shifted)
            });
            Some([difference(found, &stencil, 0)?, difference(found, &stencil, 1)?])
        };
        let mut known: [Option<[f64; 2]>; 4] = [None; 4];
        for d in 0..self.changes.len() {
            let tangent = &self.tangents[d];
            let carried = tangent.contacts[c];
            let [by_overlap, by_rate] = self.overlap(d, c, at_s, state, [&tangent.amplitude, &tangent.rate]);
            let changes: Given = match event {
                Event::Cross(_) => [carried.branch[0], carried.branch[1], by_overlap, by_rate],
                Event::Touch { .. } => [carried.memory[0], carried.memory[1], by_rate, 0.0],
            };
            let mut made_change = [0.0; 2];
            for i in (0..4).filter(|i| changes[*i] != 0.0 && sizes[*i] != 0.0) {
                let slopes = match known[i] {
                    Some(slopes) => slopes,
                    None => *known[i].insert(by_given(i)?),
                };
                (0..2).for_each(|which| made_change[which] += slopes[which] * changes[i]);
            }
            if let Some(laws) = &self.changes[d].laws {
                for (which, made_change) in made_change.iter_mut().enumerate() {
                    *made_change += difference(laws[c].map(|law| made(law, &given)), &self.changes[d].stencil, which)?;
                }
            }
            let tangent = &mut self.tangents[d];
            let time_s = tangent.time_s + apart[d];
            match (event, &after) {
                (Event::Touch { .. }, _) => {
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
        if let Event::Touch { overlaps } = event {
            let speed = rate.max(0.0);
            self.touches = [self.touches[0].min(speed), self.touches[1].max(speed)];
            let followed = &mut self.contacts[c];
            followed.interval = self.begun;
            self.begun += 1;
            followed.peaks = [0.0; 2];
            followed.overlap = if overlaps { overlap } else { followed.memory.touch_m };
        }
        match after {
            After::Continue(branch) => self.contacts[c].branch = Some(branch),
            After::Release(memory) => (self.contacts[c].branch, self.contacts[c].memory) = (None, memory),
        }
        Some(())
    }

    /// Where on this panel force and compression of each contact exceed all before, with their slope there.
    fn peaks(&mut self, solved: &[Solved]) -> Vec<[Option<(f64, f64)>; 2]> {
        let of = |own: &Solved| {
            let compression = BASIS.coefficients(&own.compression);
            let followed = &mut self.contacts[own.contact];
            [(&own.force, 0), (&compression, 1)].map(|(coefficients, which)| {
                let (place, value) = highest(coefficients);
                (value > followed.peaks[which]).then(|| {
                    followed.peaks[which] = value;
                    (place, evaluate(&derivative(coefficients), place))
                })
            })
        };
        solved.iter().map(of).collect()
    }
}

/// `moved -= by F + c_1 psi (t F) - c_2 psi (t F' + 2 F)`, of what these forces make of the modes; the latter two where modes
/// change.
fn add_driven(moved: &mut [f64], (psi, by): (&[f64], &[f64]), factors: Option<[&[f64]; 2]>, driven: [&[f64]; 3]) {
    let n = moved.len();
    let [by_force, by_timed, by_again] = driven;
    vectorized(
        #[inline(always)]
        || {
            let (by, by_force) = (&by[..n], &by_force[..n]);
            (0..n).for_each(|k| moved[k] -= by[k] * by_force[k]);
            if let Some([fade, stretch]) = factors {
                let [psi, fade, stretch, by_timed, by_again] =
                    [psi, fade, stretch, by_timed, by_again].map(|row| &row[..n]);
                (0..n).for_each(|k| moved[k] -= psi[k] * (fade[k] * by_timed[k] - stretch[k] * by_again[k]));
            }
        },
    );
}

/// How far free motion moves the sum of all modes at the nodes, and that sum at the start: of each mode from the amplitude and
/// the rate that are made of its numbers.
fn swept<const N: usize>(
    at_nodes: &[(Nodal, Nodal)],
    rows: [&[f64]; N],
    motion: impl Fn([f64; N]) -> (f64, f64),
) -> (f64, Nodal) {
    vectorized(
        #[inline(always)]
        || {
            let n = at_nodes.len();
            let rows = rows.map(|row| &row[..n]);
            let (mut start, mut moved) = (0.0, [0.0; Q]);
            for k in 0..n {
                let (a, b) = motion(rows.map(|row| row[k]));
                let (from_a, from_b) = &at_nodes[k];
                start += a;
                for i in 0..Q {
                    moved[i] += from_a[i] * a + from_b[i] * b;
                }
            }
            (start, moved)
        },
    )
}

/// Where a panel ends.
struct Arrival<'a> {
    length_s: f64,
    ending: Ending,
    /// What is carried of the modes there.
    state: [&'a [f64]; 2],
    /// How the time of the end changes, where that is what fixes it.
    end_s: Option<&'a [f64]>,
    /// What follows.
    next: &'a Stretch,
}

/// What fixes where the panel before a stretch ends, loads apart: the first event at its start.
fn ending(next: &Stretch) -> Ending {
    match next.events.first() {
        Some((_, Event::Touch { overlaps: true })) | None => Ending::Length,
        Some((c, event)) => Ending::Event(*c, *event),
    }
}

/// Rate at the start of a polynomial by its values at the start and at the nodes.
fn slope_at_start(start: f64, nodal: &Nodal, h: f64) -> f64 {
    let rates = slopes(start, nodal, h);
    evaluate(&BASIS.coefficients(&rates), 0.0)
}

/// Place and value of the maximum of a polynomial on [0, 1].
fn highest(coefficients: &Nodal) -> (f64, f64) {
    const GRID: u32 = 16;
    let value = |place: f64| evaluate(coefficients, place);
    let grid = (0..=GRID).map(|i| f64::from(i) / f64::from(GRID));
    let (mut place, mut best) = grid.map(|s| (s, value(s))).fold((0.0, f64::MIN), |a, b| if b.1 > a.1 { b } else { a });
    let slope = derivative(coefficients);
    let bend = derivative(&slope);
    for _ in 0..8 {
        let next = place - evaluate(&slope, place) / evaluate(&bend, place);
        if !((0.0..=1.0).contains(&next) && value(next) >= best) {
            break;
        }
        (place, best) = (next, value(next));
    }
    (place, best)
}

/// The size that a number of a branch is differenced by.
fn size_of(branch: &Branch, which: usize, followed: &Followed) -> f64 {
    match which {
        0 if branch.anchor_m != 0.0 => branch.anchor_m.abs(),
        0 => followed.sizes[0],
        _ if branch.internal != 0.0 => branch.internal.abs(),
        _ => 1.0,
    }
}

fn shifted(branch: &Branch, which: usize, by: f64) -> Branch {
    match which {
        0 => Branch { anchor_m: branch.anchor_m + by, ..*branch },
        _ => Branch { internal: branch.internal + by, ..*branch },
    }
}
