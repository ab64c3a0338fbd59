//! A solved impact with its motion, panel by panel.

use super::fall::Fall;
use super::history::{History, Recorded};
use super::problem::{Mode, Start, Striker};
use super::solution::{Counts, Solution};
use crate::assembly::dense::Stretch;
use crate::assembly::ledger::{Dissipation, Moment, Sum};
use crate::assembly::load::Loads;
use crate::assembly::solve::Record;
use crate::assembly::system::System;
use crate::assembly::tables::Tables;
use crate::panel::legendre::Legendre;
use contact_models::ContactLaw;
use std::fmt;
use std::sync::Arc;

/// A solved impact and its motion, which becomes a [`History`] when one is needed: keeping the motion costs little, while the energy
/// balance of a history costs a part of the impact.
#[derive(Clone)]
pub struct Recording {
    pub(crate) solution: Solution,
    pub(crate) counts: Counts,
    pub(crate) modes: Vec<Mode>,
    pub(crate) moved: Vec<usize>,
    pub(crate) striker: Striker,
    pub(crate) start: Start,
    pub(crate) fall: Option<Fall>,
    pub(crate) system: System,
    pub(crate) loads: Loads,
    pub(crate) record: Record,
    pub(crate) tables: Arc<Tables>,
    /// Work of the contact and loss by damping, if they are already known (J).
    pub(crate) work_and_damping_j: Option<[f64; 2]>,
}

impl fmt::Debug for Recording {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recording").field("solution", &self.solution).finish_non_exhaustive()
    }
}

impl Recording {
    /// The result.
    pub fn solution(&self) -> &Solution {
        &self.solution
    }

    /// Counts of the solution alone, without those that estimate its uncertainty.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// The history, for the law with which the impact was solved.
    pub fn history<L: ContactLaw>(self, law: L) -> (Solution, History<L>) {
        let Recording {
            solution,
            modes,
            moved,
            striker,
            start,
            fall,
            system,
            loads,
            record,
            tables,
            work_and_damping_j: known,
            ..
        } = self;
        let work_and_damping_j = known.unwrap_or_else(|| work_and_damping_j(&system, &loads, &record, &tables));
        let stretches = record.stretches;
        let recorded = Recorded { modes, moved, striker, start, fall, system, loads, stretches };
        let history = History::new(recorded, law, &solution, work_and_damping_j);
        (solution, history)
    }
}

/// Work of the contact, and energy that the moved modes lose to damping (J).
pub(crate) fn work_and_damping_j(system: &System, loads: &Loads, record: &Record, tables: &Tables) -> [f64; 2] {
    let mut dissipation = Dissipation::new(system);
    let mut work_j = Sum::default();
    work_j += record.contact_work_j;
    for stretch in &record.stretches {
        let Stretch { start_s, length_s, amplitude, rate, forces, .. } = stretch;
        let start = Moment { system, loads, time_s: *start_s, amplitude, rate };
        // the end of the record is the start of its last stretch
        dissipation.land(&start);
        let (contacts, force): (Vec<usize>, Vec<Legendre>) = forces.iter().map(|of| (of.contact, of.force)).unzip();
        dissipation.panel(&start, tables, *length_s, &contacts, &force);
        if !contacts.is_empty()
            && let Some(level) = tables.steps.level_of(*length_s)
            && let Some(excess) = tables.excess(system, level, &contacts)
        {
            work_j += excess.work_j(system, (amplitude, rate), &contacts, &force);
        }
    }
    [work_j.total(), dissipation.lost_j.total()]
}
