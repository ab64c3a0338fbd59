//! A solved impact with its motion, panel by panel.

use super::history::{History, Recorded};
use super::solution::{Counts, Solution};
use crate::assembly::dense::Stretch;
use crate::assembly::ledger::{Dissipation, Moment, Sum};
use crate::assembly::load::Loads;
use crate::assembly::tables::Tables;
use crate::panel::dyadic::{level_within, step_s};
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
    pub(crate) recorded: Recorded,
    /// Work of the contact without that of fast modes (J).
    pub(crate) contact_work_j: f64,
    pub(crate) tables: Arc<Tables>,
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
        let work_and_damping_j = self.work_and_damping_j();
        let history = History::new(self.recorded, law, &self.solution, work_and_damping_j);
        (self.solution, history)
    }

    /// Work of the contact, and energy that the moved modes lose to damping (J).
    fn work_and_damping_j(&self) -> [f64; 2] {
        let Recorded { system, stretches, .. } = &self.recorded;
        let loads = Loads::new(&[], system);
        let mut dissipation = Dissipation::new(system);
        let mut work_j = Sum::default();
        work_j += self.contact_work_j;
        for stretch in stretches {
            let Stretch { start_s, length_s, amplitude, rate, forces, .. } = stretch;
            let start = Moment { system, loads: &loads, time_s: *start_s, amplitude, rate };
            // the end of the record is the start of its last stretch
            dissipation.land(&start);
            let (contacts, force): (Vec<usize>, Vec<Legendre>) = forces.iter().copied().unzip();
            dissipation.panel(&start, &self.tables, *length_s, &contacts, &force);
            let level = level_within(*length_s);
            if !contacts.is_empty()
                && step_s(level) == *length_s
                && let Some(excess) = self.tables.excess(system, level, &contacts)
            {
                work_j += excess.work_j(system, (amplitude, rate), &contacts, &force);
            }
        }
        [work_j.total(), dissipation.lost_j.total()]
    }
}
