//! Runs that end with a flight of some height of the first side of their only contact, which constant loads press onto the second:
//! the rebound of a striker that falls.
//!
//! Such a run gives the contact time for it. After the first interval of contact it goes on for at least four times its duration. If within
//! that interval the side rises and turns down again without leaving, the time until then counts in its place.

use super::motion::{March, Swing};
use super::state::State;

/// The run goes on for this many times the duration of the first interval of contact, or of the first swing within it.
const WAITED: f64 = 4.0;

impl March<'_> {
    /// Whether the run waits for a flight of some height.
    fn waits_for_flight(&self) -> bool {
        self.settings.over_above_m < f64::INFINITY
    }

    /// Displacement and velocity of the first side of the only contact.
    fn first_side(&self) -> Option<(f64, f64)> {
        let [link] = &self.system.links[..] else { return None };
        let side = link.sides[0].as_ref()?;
        let (shift, shift_rate) = self.loads.side(self.system, side, self.time_s);
        Some((side.sum(&self.amplitude) + shift, side.sum(&self.rate) + shift_rate))
    }

    /// Time at which the first side of the only contact turns round, if it is displaced by enough then for the run to end (s).
    pub(super) fn time_of_turning_s(&mut self) -> f64 {
        if !self.waits_for_flight() {
            return f64::INFINITY;
        }
        let Some((displacement, rate)) = self.first_side() else { return f64::INFINITY };
        let pressed = self.loads.acceleration(0, self.time_s);
        if !(rate > 0.0 && pressed > 0.0) {
            return f64::INFINITY;
        }
        let highest = displacement + rate * rate / (2.0 * pressed);
        self.highest = self.highest.max(highest);
        if highest > self.settings.over_above_m { self.time_s + rate / pressed } else { f64::INFINITY }
    }

    /// Time until the only contact closes if its gap closes as fast as now; infinite if it does not (s).
    pub(super) fn time_until_touch_s(&self) -> f64 {
        let (overlap, rate) = self.overlap_of_modes(0);
        let gap = (self.states[0].touch_m() - overlap).max(0.0);
        if rate > 0.0 { gap / rate } else { f64::INFINITY }
    }

    /// Whether the run may not end yet, because the first interval of contact lasts and its first side has not swung.
    pub(super) fn waits(&self) -> bool {
        let lasts = self.intervals == 0 && self.states.iter().any(State::is_closed);
        self.waits_for_flight() && lasts && self.swing != Swing::Over
    }

    /// Follows the first side within the first interval of contact.
    pub(super) fn look_at_swing(&mut self) {
        if !self.waits_for_flight() || self.intervals > 0 || self.swing == Swing::Over {
            return;
        }
        let Some(start_s) = self.states[0].closed_contact().map(|contact| contact.interval.start_s) else { return };
        let Some((_, rate)) = self.first_side() else { return };
        self.swing = match self.swing {
            Swing::Falls if rate > 0.0 => Swing::Rises,
            Swing::Rises if rate < 0.0 => {
                self.wait_after(self.time_s - start_s);
                Swing::Over
            }
            swing => swing,
        };
    }

    /// Waits after the first interval of contact, of this duration (s).
    pub(super) fn wait_after_opening(&mut self, interval_s: f64) {
        if self.waits_for_flight() && self.intervals == 1 && self.swing != Swing::Over {
            self.wait_after(interval_s);
        }
    }

    fn wait_after(&mut self, lasted_s: f64) {
        let (end_s, after_s) = (self.settings.end_s, self.time_s + WAITED * lasted_s);
        self.settings.end_s = if end_s.is_finite() { end_s.max(after_s) } else { after_s };
    }
}
