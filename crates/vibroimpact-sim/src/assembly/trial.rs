//! A panel of `2^-j` s with closed contacts: the forces by the laws, and their effect on the motion. A trial does not change the
//! motion; a panel that passes the checks is accepted.

use super::collocate::{Collocated, Mobility, Unknown, collocate};
use super::load::Turns;
use super::motion::March;
use super::state::Phase;
use crate::panel::ends::Ends;
use crate::panel::legendre::{BASIS, Legendre, Nodal, Q, slopes};

/// Allowed error of the nodal forces, as a share of the allowed error of the impulse on a panel.
pub(super) const NEWTON_SHARE: f64 = 1e-2;

/// A force is extrapolated by at most this many panels for a first guess. Beyond, its value at the end is a better guess: a terminal
/// panel can be many orders shorter than the next one.
const FARTHEST: f64 = 8.0;

/// A trial panel; its memory is reused.
#[derive(Default)]
pub(super) struct Trial<'a> {
    /// Closed contacts, then open ones that could close, and how many are closed.
    pub contacts: Vec<usize>,
    pub closed: usize,
    unknowns: Vec<Unknown<'a>>,
    /// Their overlap's increase without contact forces up to the nodes, and its rate if the force may depend on it.
    free: Vec<(Nodal, Option<Nodal>)>,
    /// The closed contacts' forces, at the nodes and as polynomials.
    pub solved: Vec<Collocated>,
    pub force: Vec<Legendre>,
    /// Increases of all contacts' overlaps from the start to the nodes, and the overlaps at the end with their rates.
    pub moved: Vec<Nodal>,
    pub end: Vec<(f64, f64)>,
    turns: Turns,
}

impl<'a> March<'a> {
    /// Solves for the forces of a panel; `false` if it is too long for that.
    pub(super) fn attempt(&mut self, level: i32, trial: &mut Trial<'a>) -> bool {
        let h = self.tables.steps.step_s(level);
        let Trial { contacts, closed, unknowns, free, solved, force, moved, turns, .. } = trial;
        let closed = *closed;
        self.responses.prepare(self.system, self.tables, level, contacts, contacts);
        self.loads.turn(self.time_s, h, turns);
        let by_rate = contacts[..closed].iter().copied().filter(|&c| self.states[c].force_by_rate());
        self.responses.prepare_rates(self.system, self.tables, level, by_rate, &contacts[..closed]);
        free.clear();
        free.extend(contacts.iter().map(|&c| self.free_at_nodes(level, c, turns)));
        moved.clear();
        moved.extend(free.iter().map(|(moved, _)| *moved));
        unknowns.clear();
        unknowns.extend(self.unknowns(&contacts[..closed], h, |i| free[i], |c| self.begins(c)));
        let (system, responses) = (self.system, &*self.responses);
        let response = |i: usize, j: usize| {
            let (c, other) = (contacts[i], contacts[j]);
            let rates = free[i].1.and_then(|_| responses.rates(system, level, c, other));
            Some(Mobility { nodes: &responses.of(system, level, c, other)?.nodes, rates })
        };
        if !collocate(unknowns, response, (&mut self.newton, solved), &mut self.counts) {
            return false;
        }
        force.clear();
        force.extend(solved.iter().map(|solved| Legendre::through(&solved.acting)));
        self.watch(h, contacts, closed, force);
        if contacts.len() > closed {
            let (open, closed) = (&contacts[closed..], &contacts[..closed]);
            self.responses.prepare(self.system, self.tables, level, open, closed);
        }
        self.move_contacts(level, trial);
        true
    }

    /// The overlaps of the contacts under the forces of a panel: their increases up to the nodes, and their values and rates at the end.
    fn move_contacts(&self, level: i32, trial: &mut Trial) {
        let h = self.tables.steps.step_s(level);
        let Trial { contacts, closed, solved, force, moved, end, turns, .. } = trial;
        let open = &contacts[*closed..];
        moved.extend(open.iter().map(|&c| self.free_at_nodes(level, c, turns).0));
        end.clear();
        for (i, &c) in contacts.iter().enumerate() {
            let (state, nodal) = (&self.states[c], &mut moved[i]);
            let link = &self.system.links[c];
            let (free, mut rate) = self.tables.free_at_end(level, link, &self.amplitude, &self.rate);
            let (by_loads, rate_of_loads) = self.loads.moved_on(c, (self.time_s, h), turns, Q);
            let mut forced = 0.0;
            for ((&other, solved), force) in contacts.iter().zip(&*solved).zip(&*force) {
                let Some(response) = self.responses.of(self.system, level, c, other) else { continue };
                let (by_force, speed) = response.at_end(force);
                forced += by_force;
                rate += speed;
                if i >= *closed {
                    for (column, acting) in response.nodes.iter().zip(&solved.acting) {
                        for (nodal, response) in nodal.iter_mut().zip(column) {
                            *nodal += response * acting;
                        }
                    }
                }
            }
            if i < *closed {
                // known from the solution of the laws
                *nodal = solved[i].moved;
            }
            end.push((state.overlap + (free + by_loads + forced), rate + rate_of_loads));
        }
    }

    /// The closed contacts' laws and first guesses on a panel of `h`.
    pub(super) fn unknowns<'s>(
        &'s self,
        contacts: &'s [usize],
        h: f64,
        free: impl Fn(usize) -> (Nodal, Option<Nodal>) + 's,
        ends: impl Fn(usize) -> Ends + 's,
    ) -> impl Iterator<Item = Unknown<'a>> + 's {
        let unknown = move |(i, &c): (usize, &usize)| {
            let state = &self.states[c];
            let contact = state.closed_contact()?;
            let guess = contact.previous.map_or([0.0; Q], |(force, length)| {
                let ahead = if h <= FARTHEST * length { h / length } else { 0.0 };
                force.at_each(&BASIS.nodes.map(|s| 1.0 + s * ahead)).map(|force| force.max(0.0))
            });
            let (free, free_rate) = free(i);
            Some(Unknown {
                law: self.law(c),
                branch: contact.branch,
                start: state.overlap,
                free,
                free_rate,
                accuracy: NEWTON_SHARE * self.impulse_tolerance(c) / h,
                guess,
                ends: ends(c),
            })
        };
        contacts.iter().enumerate().filter_map(unknown)
    }

    /// How the force of a closed contact begins on a panel from here on.
    pub(super) fn begins(&self, c: usize) -> Ends {
        Ends { at_start: self.states[c].closed_contact().is_some_and(|contact| contact.begins), at_end: false }
    }

    /// Increase of the overlap of a contact up to the nodes without contact forces, and its rate if the force may depend on it.
    fn free_at_nodes(&self, level: i32, c: usize, turns: &Turns) -> (Nodal, Option<Nodal>) {
        let (tables, link) = (self.tables, &self.system.links[c]);
        let by_loads = |i: usize| self.loads.moved_on(c, (self.time_s, self.tables.steps.step_s(level)), turns, i);
        if self.states[c].force_by_rate() {
            let (mut moved, mut rate) = tables.free_with_rates(self.system, level, link, &self.amplitude, &self.rate);
            for i in 0..Q {
                let (more, faster) = by_loads(i);
                moved[i] += more;
                rate[i] += faster;
            }
            return (moved, Some(rate));
        }
        let moved = tables.free_at_nodes(level, link, &self.amplitude, &self.rate);
        (std::array::from_fn(|i| moved[i] + by_loads(i).0), None)
    }

    pub(super) fn commit(&mut self, level: i32, trial: &Trial) {
        let h = self.tables.steps.step_s(level);
        let (contacts, closed) = (trial.contacts.as_slice(), trial.closed);
        self.show(h, &contacts[..closed], &trial.force, &trial.solved);
        self.account_for(level, trial);
        self.tables.rotate(self.system, level, &mut self.amplitude, &mut self.rate);
        for (i, &c) in contacts[..closed].iter().enumerate() {
            let link = &self.system.links[c];
            self.tables.push(level, link, &trial.force[i], &mut self.amplitude, &mut self.rate);
        }
        self.pass(h);
        self.stepped = true;
        self.accept(h, contacts, closed, &trial.solved, &trial.force, |i| trial.end[i]);
    }

    /// Adds the work on the closed contacts, if it is requested.
    fn account_for(&mut self, level: i32, trial: &Trial) {
        if !self.wants_contact_work() {
            return;
        }
        let closed = &trial.contacts[..trial.closed];
        for (i, &c) in closed.iter().enumerate() {
            let (compression, end) = (&trial.solved[i].compression, trial.end[i].0);
            self.contact_work_j += self.states[c].work_j(&trial.force[i], compression, end);
        }
        if self.account.is_none() {
            return;
        }
        for (&c, force) in closed.iter().zip(&trial.force) {
            self.contact_work_j += self.loads.work_missed_j(c, self.tables.steps.step_s(level), &trial.turns, force);
        }
        if let Some(excess) = self.tables.excess(self.system, level, closed) {
            self.contact_work_j += excess.work_j(self.system, (&self.amplitude, &self.rate), closed, &trial.force);
        }
    }

    /// Whether the balance or the whole motion is requested.
    pub(super) fn wants_contact_work(&self) -> bool {
        self.account.is_some() || self.record.is_some()
    }

    /// Accepts a panel of `h`.
    pub(super) fn accept(
        &mut self,
        h: f64,
        contacts: &[usize],
        closed: usize,
        solved: &[Collocated],
        force: &[Legendre],
        end: impl Fn(usize) -> (f64, f64),
    ) {
        self.counts.contact_steps += 1;
        let now = self.time_s;
        for (i, &c) in contacts.iter().enumerate() {
            let state = &mut self.states[c];
            if i < closed {
                let rate = slopes(state.overlap, &solved[i].compression, h);
                state.accept(self.laws[c], h, &solved[i], force[i], &rate, end(i));
            }
            (state.overlap, state.rate) = end(i);
        }
        for c in 0..self.states.len() {
            let moved = contacts.contains(&c) || self.is_disturbed(c);
            if moved && let Phase::Open { clear_until, bounds, .. } = &mut self.states[c].phase {
                (*clear_until, *bounds) = (now, None);
            }
        }
        self.arrive_exactly();
    }
}
