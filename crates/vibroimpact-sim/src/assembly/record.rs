//! Records of a run: the energy balance, the panels for the observer, and all stretches of motion.

use super::collocate::Collocated;
use super::dense::{Acting, Panel, Seen, Stretch};
use super::ledger::Moment;
use super::miss::Distance;
use super::motion::March;
use super::state::State;
use crate::panel::legendre::Legendre;

impl<'a> March<'a> {
    /// Adds a panel that is about to be accepted to the energy balance, and shows it to the observer.
    pub(super) fn show(&mut self, h: f64, contacts: &[usize], force: &[Legendre], solved: &[Collocated]) {
        if let Some(account) = &mut self.account {
            let (amplitude, rate) = (&self.amplitude, &self.rate);
            let start = Moment { system: self.system, loads: &self.loads, time_s: self.time_s, amplitude, rate };
            account.panel(&start, self.tables, h, contacts, force);
        }
        self.look_for_misses();
        if h == 0.0 {
            return;
        }
        let (streams, records) = (self.observer.wants_panels(), self.record.is_some());
        // a flight without loads is one stretch, whatever the number of its panels
        let free = contacts.is_empty() && self.loads.is_empty() && self.pending.is_empty();
        let last = self.record.as_mut().and_then(|record| record.last_mut());
        let flying = last.filter(|last| free && last.forces.is_empty());
        let flies_on = flying.is_some();
        if let Some(last) = flying {
            last.length_s = self.time_s + h - last.start_s;
        }
        if !streams && (flies_on || !records) {
            return;
        }
        let mut stretch = self.stretch(h, contacts, force, solved);
        if streams {
            let (system, loads, laws) = (self.system, &self.loads, self.laws);
            self.observer.panel(&Panel { system, loads, laws, stretch: &stretch });
        }
        if let Some(record) = self.record.as_mut().filter(|_| !flies_on) {
            stretch.events = std::mem::take(&mut self.pending);
            record.push(stretch);
        }
    }

    /// Whether a contact has nearly closed or opened on the last panel, if this is requested.
    pub(super) fn look_for_misses(&mut self) {
        let (Some(record), Some(mut misses)) = (&self.record, self.misses.take()) else { return };
        let distances = (0..self.states.len()).map(|c| self.distance(c));
        let (system, loads, laws) = (self.system, &self.loads, self.laws);
        let panel = record.last().map(|stretch| Panel { system, loads, laws, stretch });
        misses.look(self.time_s, distances, panel.as_ref());
        self.misses = Some(misses);
    }

    /// The distance of a contact from its next event: the gap of an open contact; for a closed one, the compression above that at
    /// which its branch ends, if that does not depend on the rate.
    fn distance(&self, c: usize) -> Option<Distance> {
        let state = &self.states[c];
        if !state.is_closed() {
            let (overlap, rate) = self.overlap_of_modes(c);
            return Some(Distance { is_closed: false, distance_m: state.touch_m() - overlap, approach_m_s: rate });
        }
        let end = state.boundaries.iter().find(|end| end.per_rate == 0.0 && end.per_compression > 0.0)?;
        let distance_m = end.margin(state.overlap, 0.0) / end.per_compression;
        Some(Distance { is_closed: true, distance_m, approach_m_s: -state.rate })
    }

    fn stretch(&self, length_s: f64, contacts: &[usize], force: &[Legendre], solved: &[Collocated]) -> Stretch {
        let forces = contacts.iter().zip(force).zip(solved);
        let seen = |state: &State| Seen {
            reference: state.reference,
            branch: state.closed_contact().map(|contact| contact.branch),
        };
        Stretch {
            events: Vec::new(),
            start_s: self.time_s,
            length_s,
            amplitude: self.amplitude.clone(),
            rate: self.rate.clone(),
            contacts: self.states.iter().map(seen).collect(),
            forces: forces
                .map(|((&contact, &force), solved)| Acting {
                    contact,
                    force,
                    ends: solved.ends,
                    by_rate: self.states[contact].force_by_rate(),
                })
                .collect(),
        }
    }

    /// The end of the record, as a stretch of zero length.
    pub(super) fn last(&mut self) -> Stretch {
        let events = std::mem::take(&mut self.pending);
        Stretch { events, ..self.stretch(0.0, &[], &[], &[]) }
    }

    /// The record, with the endless flight that follows if the bodies have separated for good or never meet.
    pub(super) fn recorded(&mut self, parted: bool) -> Vec<Stretch> {
        let Some(mut record) = self.record.take() else { return Vec::new() };
        if parted || record.is_empty() {
            let known = record.partition_point(|stretch| stretch.start_s < self.time_s);
            let flight = record.drain(known..).next();
            let events = flight.map_or_else(|| std::mem::take(&mut self.pending), |flight| flight.events);
            record.push(Stretch { events, ..self.stretch(f64::INFINITY, &[], &[], &[]) });
        }
        record
    }
}
