//! Time integration: compute a trial panel, check it, accept it.
//!
//! A trial never changes the motion (`trial.rs`). A panel has to pass three checks: is the force of every closed contact accurate
//! enough, does no event function fall to zero on it, and is the panel short enough for this decision (`judge.rs`)? It is then
//! accepted, tried again with a shorter length, or ended at the event, which is located (`landing.rs`) and changes the branch of
//! the law (`transition.rs`). Without closed contacts nothing has to be solved, and panels are as long as bounds prove that none
//! closes (`flight.rs`).

use super::judge::Judgement;
use super::ledger::Account;
use super::motion::{ExpectedEvent, GROWTH, March};
use super::rest;
use super::rounding::above_rounding;
use super::solution::{Outcome, Reason};
use super::state::State;
use super::terminal::SHORT;
use super::trial::Trial;
use crate::panel::dyadic::{J_MAX, J_MIN, Steps};
use contact_models::{ContactLaw, LARGEST, check_contract};

/// Share of the time to an expected event that one panel may take.
const SHARE: f64 = 0.85;
/// Before an event, panels that are shorter by more than this many halvings than accuracy demands have every second length only: the
/// table of a length that serves once costs more than a further panel.
const SPARSE: i32 = 4;
/// Number of successive events without progress in time that counts as chatter.
const CHATTER: u64 = 10_000;
/// Number of accepted panels between two checks for rest.
const REST: u64 = 64;
/// Number of panels with contact after which the laws are checked, much more than an impact needs.
const TRY_LAWS: u64 = 5_000;
/// Number of panels between two questions to the observer whether to stop.
const ASK: u64 = 64;

impl<'a> March<'a> {
    /// From the start to the end of the requested time.
    pub(super) fn follow(&mut self) -> Outcome {
        (self.ask_rest_at, self.try_laws_at) = (REST, TRY_LAWS);
        let mut trial = Trial::default();
        self.begin();
        if self.observer.wants_energy() {
            self.account = Some(Account::open(self.posed.bodies, &self.here(), self.stored_j()));
        }
        let outcome = loop {
            if let Some(reason) = self.stop {
                break Outcome::Stopped(reason);
            }
            if self.time_s >= self.settings.end_s {
                if !self.waits() {
                    break Outcome::End;
                }
                // until the contact has opened, or its first side has swung (`rise.rs`)
                self.settings.end_s = f64::INFINITY;
            }
            if self.time_s >= self.loads.next_break_s() {
                self.pass_break();
            }
            if self.time_s >= self.statistics_from_s {
                self.begin_statistics();
                self.discard_predictions();
            }
            if !self.states.iter().any(State::is_closed) {
                if self.fly() {
                    break Outcome::Parted;
                }
            } else if self.looks_for_rest() && self.rests() {
                break Outcome::Rest;
            } else {
                self.contact(&mut trial);
                self.look_at_swing();
            }
            self.stop = self.stop.or_else(|| self.limit());
        };
        for c in 0..self.states.len() {
            if let Some(interval) = self.states[c].finish(self.laws[c], None) {
                self.observer.interval(c, &interval);
            }
        }
        outcome
    }

    /// Passes a break of the loads.
    fn pass_break(&mut self) {
        self.look_for_misses();
        let mut account = self.account.take();
        if let Some(account) = &mut account {
            account.end_piece(&self.here());
        }
        self.loads.pass_break(self.system, self.time_s, &mut self.amplitude, &mut self.rate);
        if let Some(account) = &mut account {
            account.begin_piece(&self.here());
        }
        self.account = account;
        self.discard_predictions();
    }

    /// Whether no contact opens or closes any more, or only contacts below the tolerance do.
    fn rests(&self) -> bool {
        let over = self.settings.stop_when_over && rest::has_faded(self, 0.1 * self.settings.tolerance);
        over || self.settings.stop_at_rest && rest::is_certain(self)
    }

    fn looks_for_rest(&mut self) -> bool {
        let now = self.counts.contact_steps >= self.ask_rest_at && self.time_s > self.settings.rest_from_s;
        if now {
            self.ask_rest_at = self.counts.contact_steps + REST;
        }
        now
    }

    /// A step with closed contacts: to the expected event, to the next stop, or by a panel of `2^-j` s.
    fn contact(&mut self, trial: &mut Trial<'a>) {
        let (steps, lasting) = (self.tables.steps, self.lasting());
        let (mut reach, mut level) = (self.terminal_reach(), self.level);
        if let Some(ExpectedEvent { crossing, at_s }) = self.expected {
            let left = (at_s - self.time_s).max(0.0);
            if left <= reach && self.longest_terminal.is_infinite() {
                self.longest_terminal = self.accurate_length(crossing, left);
                reach = reach.min(self.longest_terminal);
            }
            if left <= reach {
                self.expected = None;
                return self.advance_to_event(crossing, left, reach.min(lasting));
            }
            let near = steps.level_within(SHARE * left);
            level = if near > level + SPARSE { near + (near & 1) } else { level.max(near) };
        }
        if steps.step_s(level) > lasting {
            if lasting <= reach {
                return self.advance_to_stop(lasting);
            }
            level = steps.level_within(lasting);
        }
        self.try_panel(level, trial);
    }

    /// Longest terminal panel that may be tried now (s).
    fn terminal_reach(&self) -> f64 {
        let steps = self.tables.steps;
        if steps != Steps::OF_SECOND && !self.stepped && self.events_at_once == 0 {
            // a terminal panel from event to event would have the same length, and the same error, in any steps; no step fits between
            // events that follow each other at once
            return 0.0;
        }
        // the error of a force limits the length of a panel, and where a polynomial follows it its derivatives can be less smooth
        let ends_singular = self.expected.is_some_and(|expected| self.ends_at(expected.crossing).at_end);
        let reach = if ends_singular { self.reach } else { SHORT * self.reach };
        // a terminal panel is not better than a panel of similar length
        let similar = 2.0 * steps.step_s(self.level.clamp(J_MIN + 1, J_MAX));
        reach.min(self.longest_terminal).min(similar)
    }

    /// Computes a panel with closed contacts, and accepts or rejects it.
    fn try_panel(&mut self, level: i32, trial: &mut Trial<'a>) {
        let h = self.tables.steps.step_s(level);
        trial.closed = self.closed(&mut trial.contacts);
        if !self.attempt(level, trial) {
            return self.refine(level + 1);
        }
        let (contacts, closed) = (trial.contacts.as_slice(), trial.closed);
        let judgement = self.judge(h, (contacts, closed), &trial.force, &trial.moved, true, None);
        if let Judgement::Meets(crossing, place) = judgement
            && place > 0.0
        {
            // the event is located once it is near
            self.counts.rejected_steps += 1;
            self.expected = Some(ExpectedEvent { crossing, at_s: self.time_s + place * h });
            return;
        }
        if judgement == Judgement::Doubtful {
            return self.refine(level + 1);
        }
        let error = self.error_of_trial(h, trial);
        if error.is_nan() || error > 1.0 {
            // the error decreases at least like h^5, except where a polynomial follows a force that begins as t^(3/2): such panels are
            // short enough from the start
            let finer = (error.log2() / 5.0) as i32;
            return self.refine(level + finer.clamp(1, 4));
        }
        if let Judgement::Meets(crossing, _) = judgement {
            self.counts.rejected_steps += 1;
            return self.transition(crossing);
        }
        self.commit(level, trial);
        if self.expected.is_none() {
            self.expected = self.look_ahead(h, trial);
        }
        if level == self.level && error * GROWTH < 1.0 {
            self.level = (level - 1).max(J_MIN);
        }
    }

    /// Error of the forces of a panel relative to the allowed error: by their truncation, and by their defect in the laws at its end, in
    /// which modes show that turn several times within the panel.
    fn error_of_trial(&mut self, h: f64, trial: &Trial) -> f64 {
        let mut error = 0.0f64;
        for (i, &c) in trial.contacts[..trial.closed].iter().enumerate() {
            let (solved, end) = (&trial.solved[i], trial.end[i]);
            let quotient = solved.quotient(&trial.force[i]);
            let defect = (self.force_at(c, end) - quotient.at(1.0)).abs();
            let error_n = above_rounding(solved.ends.truncation(&quotient).max(defect), &solved.force);
            error = error.max(self.error(c, error_n, h, end));
        }
        error
    }

    /// Whether the run has to stop here. Before it stops during a contact, and once if the run is long, the laws are checked: a law
    /// that violates its contract can prevent a run from ending.
    fn limit(&mut self) -> Option<Reason> {
        let reason = self.reached_limit();
        let in_contact = matches!(reason, Some(Reason::FinestStep | Reason::LawRange | Reason::Chatter));
        let long = reason.is_none() && self.counts.contact_steps >= self.try_laws_at;
        if in_contact || long {
            self.try_laws_at = u64::MAX;
            let broken = |(state, law): (&State, &&dyn ContactLaw)| {
                state.scales().is_some_and(|(xi, speed)| check_contract(*law, xi, speed).is_err())
            };
            if self.states.iter().zip(self.laws).any(broken) {
                return Some(Reason::Law);
            }
        }
        reason
    }

    fn reached_limit(&mut self) -> Option<Reason> {
        let steps = self.counts.steps();
        if steps >= self.settings.max_steps {
            Some(Reason::Steps)
        } else if self.intervals >= self.settings.max_intervals {
            Some(Reason::Intervals)
        } else if self.level > J_MAX {
            Some(Reason::FinestStep)
        } else if self.events_at_once > CHATTER {
            Some(Reason::Chatter)
        } else if steps.is_multiple_of(ASK) && self.observer.interrupts() {
            Some(Reason::Interrupted)
        } else {
            let beyond =
                |state: &State| state.is_closed() && (state.overlap.abs() > LARGEST || state.rate.abs() > LARGEST);
            self.states.iter().any(beyond).then_some(Reason::LawRange)
        }
    }
}
