//! Responses of the contacts to each other's forces on panels, for the runs of one system. They are the sum of the responses of
//! the elastic modes, which the tables cache, and of those of the rigid modes, which differ from striker to striker.

use super::forced::{Response, with_rigid_modes};
use super::system::System;
use super::tables::Tables;
use crate::panel::dyadic::Levels;
use crate::panel::forcing::Order;
use crate::panel::legendre::Matrix;

/// Filled as they are needed.
#[derive(Default)]
pub(crate) struct Responses {
    levels: Levels<Level>,
}

struct Level {
    /// `[c][c']`: number of the response, where it was requested.
    pairs: Vec<Option<usize>>,
    found: Vec<Response>,
    /// Their rates at the nodes, where these were requested.
    rates: Vec<Option<Matrix>>,
}

impl Responses {
    /// Computes everything for the step exponent `j` and these contacts and forces that is not cached yet, also in the tables.
    pub fn prepare(&mut self, system: &System, tables: &Tables, j: i32, contacts: &[usize], forces: &[usize]) {
        let count = system.links.len();
        let of_neighbours = |c: usize| forces.iter().filter(move |other| system.neighbours[c].contains(other));
        let known = |level: &Level| {
            contacts.iter().all(|&c| of_neighbours(c).all(|other| level.pairs[c * count + other].is_some()))
        };
        if self.levels.get(j).is_some_and(known) {
            return;
        }
        tables.prepare(system, j, contacts, forces);
        // most contacts share a body with few others
        let empty = || Level {
            pairs: vec![None; count * count],
            found: Vec::with_capacity(3 * contacts.len()),
            rates: Vec::new(),
        };
        self.levels.get_or_init(j, empty);
        let Some(Level { pairs, found, rates }) = self.levels.get_mut(j) else { return };
        for &c in contacts {
            for &other in of_neighbours(c) {
                let pair = &mut pairs[c * count + other];
                if pair.is_none() {
                    *pair = Some(found.len());
                    let inverse_mass = system.links[c].shared_rigid(&system.links[other]);
                    found.push(tables.elastic_response(j, c, other).with_rigid(inverse_mass, tables.steps.step_s(j)));
                    rates.push(None);
                }
            }
        }
    }

    /// Computes the rates at the nodes of these contacts under these forces that are not cached yet. Needs [`Responses::prepare`].
    pub fn prepare_rates(
        &mut self,
        system: &System,
        tables: &Tables,
        j: i32,
        contacts: impl Iterator<Item = usize>,
        forces: &[usize],
    ) {
        let count = system.links.len();
        let Some(Level { pairs, rates, .. }) = self.levels.get_mut(j) else { return };
        let number = |(c, other): (usize, usize)| pairs[c * count + other];
        let missing = |pair: &(usize, usize)| number(*pair).is_some_and(|number| rates[number].is_none());
        let missing: Vec<(usize, usize)> =
            contacts.flat_map(|c| forces.iter().map(move |&other| (c, other))).filter(missing).collect();
        if missing.is_empty() {
            return;
        }
        tables.prepare_rates(system, j, &missing);
        for (c, other) in missing {
            let Some(number) = number((c, other)) else { continue };
            let inverse_mass = system.links[c].shared_rigid(&system.links[other]);
            let elastic = tables.elastic_rates(j, c, other);
            rates[number] = Some(with_rigid_modes(elastic, Order::Velocity, inverse_mass, tables.steps.step_s(j)));
        }
    }

    /// Rates of contact `c` at the nodes under the force of `other`, if they share a body. Needs [`Responses::prepare_rates`].
    pub fn rates(&self, system: &System, j: i32, c: usize, other: usize) -> Option<&Matrix> {
        let level = self.levels.get(j)?;
        level.rates[level.pairs[c * system.links.len() + other]?].as_ref()
    }

    /// Response of contact `c` to the force of `other`, if they share a body. Needs [`Responses::prepare`].
    pub fn of(&self, system: &System, j: i32, c: usize, other: usize) -> Option<&Response> {
        let level = self.levels.get(j)?;
        level.pairs[c * system.links.len() + other].map(|pair| &level.found[pair])
    }
}
