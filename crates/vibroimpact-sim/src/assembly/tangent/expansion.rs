//! All modes on panels of one length, with the weighted responses for the derivatives.

use crate::assembly::change::Change;
use crate::assembly::collocate::Mobility;
use crate::assembly::forced::{Forced, Over, rates_at_nodes, with_rigid_modes};
use crate::assembly::system::{Span, System};
use crate::panel::by_damping::ByDamping;
use crate::panel::dyadic::{Rotation, Steps};
use crate::panel::forcing::Order;
use crate::panel::legendre::{Matrix, Q, add};
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

/// Free motion and responses of all modes on panels of one length, with their weights in the derivatives.
pub(super) struct Expansion {
    pub rotation: Rotation,
    pub forced: Forced,
    /// Responses of all modes together, at first `[p n + q]` over the closed contacts, and their rates, where a force may depend on
    /// the rate.
    pub responses: Vec<Matrix>,
    pub rates: Vec<Matrix>,
    /// For each change and pair of contacts, `[(d n + p) n + q]`, where its responses are among these: to `F`, and to `t F` and
    /// `t F'` where modes change.
    pub changed: Vec<[Option<usize>; 3]>,
    /// The modes next to critical damping whose damping changes.
    critical: BTreeMap<usize, ByDamping>,
}

impl Expansion {
    /// How the force of one closed contact moves the overlap of another.
    pub fn mobility(&self, pair: usize) -> Mobility<'_> {
        Mobility { nodes: &self.responses[pair], rates: self.rates.get(pair) }
    }

    /// The modes next to critical damping whose damping a change moves, and by how much.
    pub fn critical<'a>(&'a self, change: &'a Change) -> impl Iterator<Item = (usize, f64, &'a ByDamping)> {
        change.critical.iter().filter_map(|(k, by_zeta)| Some((*k, *by_zeta, self.critical.get(k)?)))
    }

    /// Adds the change of the responses of these modes to the weights of `F`, with the products of the contacts' weights.
    fn add_critical(&mut self, changes: &[Change], products: &[Vec<f64>]) {
        for (change, pairs) in changes.iter().zip(self.changed.chunks_mut(products.len().max(1))) {
            for (k, by_zeta) in &change.critical {
                let Some(mode) = self.critical.get(k) else { continue };
                for (product, [of_force, _, _]) in products.iter().zip(&mut *pairs) {
                    let place = *of_force.get_or_insert(self.responses.len());
                    let tables = [(&mut self.responses, &mode.compliance), (&mut self.rates, &mode.compliance_rates)];
                    for (table, changed) in tables.into_iter().filter(|(table, _)| !table.is_empty()) {
                        table.resize(table.len().max(place + 1), [[0.0; Q]; Q]);
                        for (column, changed) in table[place].iter_mut().zip(changed) {
                            add(column, by_zeta * product[*k], changed);
                        }
                    }
                }
            }
        }
    }
}

/// Cached expansions of panels by length, closed contacts and whether rates are included, for one system and the same parameters.
pub(crate) struct Expansions {
    /// Panels of other lengths do not return.
    steps: Steps,
    cached: HashMap<(u64, Vec<usize>, bool), Rc<Expansion>>,
}

impl Expansions {
    pub fn new(steps: Steps) -> Expansions {
        Expansions { steps, cached: HashMap::new() }
    }

    /// The expansion for panels of this length with these contacts closed, with rates or without.
    pub(super) fn of(
        &mut self,
        system: &System,
        changes: &[Change],
        h: f64,
        (closed, by_rate): (&[usize], bool),
    ) -> Rc<Expansion> {
        let key = (h.to_bits(), closed.to_vec(), by_rate);
        if let Some(kept) = self.cached.get(&key) {
            return kept.clone();
        }
        let rotation = Rotation::new(&system.modes, h);
        let n = closed.len();
        // all weights in one list, so that each mode is expanded once
        let mut weights: Vec<Vec<f64>> = Vec::new();
        for &p in closed {
            for &q in closed {
                weights.push(system.shared(p, q));
            }
        }
        let mut changed = Vec::new();
        for change in changes {
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
                changed.push(place);
            }
        }
        // a flight needs nothing but free motion
        let expand = || Forced::new(system, &Over::any(h), &Over::any(0.5 * h), &weights);
        let (forced, elastic) = if closed.is_empty() { Default::default() } else { expand() };
        let with_rigid = |elastic: Vec<Matrix>, order: Order| -> Vec<Matrix> {
            let of = |(elastic, weights): (Matrix, &Vec<f64>)| {
                let rigid = system.modes.iter().zip(weights).filter(|(mode, _)| mode.is_rigid());
                with_rigid_modes(elastic, order, rigid.map(|(_, weight)| weight).sum(), h)
            };
            elastic.into_iter().zip(&weights).map(of).collect()
        };
        let responses = with_rigid(elastic, Order::Displacement);
        let elastic_rates = if by_rate { rates_at_nodes(system, h, &weights) } else { Vec::new() };
        let rates = with_rigid(elastic_rates, Order::Velocity);
        let by_damping = |(k, _): &(usize, f64)| {
            let mode = &system.modes[*k];
            (*k, if closed.is_empty() { ByDamping::of_free_motion(mode, h) } else { ByDamping::new(mode, h) })
        };
        let critical = changes.iter().flat_map(|change| &change.critical).map(by_damping).collect();
        let mut expansion = Expansion { rotation, forced, responses, rates, changed, critical };
        expansion.add_critical(changes, &weights[..n * n]);
        let expansion = Rc::new(expansion);
        if self.steps.level_of(h).is_some() {
            self.cached.insert(key, expansion.clone());
        }
        expansion
    }
}
