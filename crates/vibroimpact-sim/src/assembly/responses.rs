//! Responses of the contacts to each other's forces on panels, for the runs of one system: those of the elastic modes, which the tables
//! keep, with those of the rigid modes, which differ from striker to striker, added once.

use super::system::System;
use super::tables::{Response, Tables};
use crate::panel::dyadic::{J_MAX, J_MIN, step_s};

/// Filled as they are needed.
pub(crate) struct Responses {
    levels: Vec<Option<Box<Level>>>,
}

/// `[c][c']`, where asked for.
struct Level {
    pairs: Vec<Option<Box<Response>>>,
}

impl Responses {
    pub fn new() -> Responses {
        Responses { levels: std::iter::repeat_with(|| None).take((J_MAX - J_MIN + 1) as usize).collect() }
    }

    /// Makes sure that everything about level `j` is there for these contacts and these forces, in the tables as well.
    pub fn prepare(&mut self, system: &System, tables: &Tables, j: i32, contacts: &[usize], forces: &[usize]) {
        let count = system.links.len();
        let level = &mut self.levels[(j - J_MIN) as usize];
        let of_neighbours = |c: usize| forces.iter().filter(move |other| system.neighbours[c].contains(other));
        let known = |level: &Level| {
            contacts.iter().all(|&c| of_neighbours(c).all(|other| level.pairs[c * count + other].is_some()))
        };
        if level.as_deref().is_some_and(known) {
            return;
        }
        tables.prepare(system, j, contacts, forces);
        let empty = || Box::new(Level { pairs: std::iter::repeat_with(|| None).take(count * count).collect() });
        let pairs = &mut level.get_or_insert_with(empty).pairs;
        for &c in contacts {
            for &other in of_neighbours(c) {
                let with_rigid = |elastic: &Response| {
                    let inverse_mass = system.links[c].shared_rigid(&system.links[other]);
                    Box::new(elastic.with_rigid(inverse_mass, step_s(j)))
                };
                let pair = &mut pairs[c * count + other];
                if pair.is_none() {
                    *pair = tables.elastic_response(j, c, other).map(with_rigid);
                }
            }
        }
    }

    /// Response of contact `c` to the force of `other`, if they share a body. Needs [`Responses::prepare`].
    pub fn of(&self, system: &System, j: i32, c: usize, other: usize) -> Option<&Response> {
        let level = self.levels[(j - J_MIN) as usize].as_deref()?;
        level.pairs[c * system.links.len() + other].as_deref()
    }
}
