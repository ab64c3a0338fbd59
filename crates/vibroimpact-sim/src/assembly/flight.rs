//! Motion without closed contacts. Nothing has to be solved: each panel is as long as bounds prove that no contact closes, and
//! power series of the overlaps locate the touch.

use super::enclosure::{FlightBounds, bend_of_loads, first_closing};
use super::motion::March;
use super::terminal::{self, series_of};

/// Power series are used once the next certified step is shorter than their reach by this many step exponents.
const WINDOW: i32 = 2;

impl<'a> March<'a> {
    /// Makes a step of free flight; `true` if the bodies have separated for good and no step is needed.
    pub(super) fn fly(&mut self) -> bool {
        self.counts.flight_steps += 1;
        if self.time_s >= self.turns_at_s {
            self.until_touch_s = self.time_until_touch_s();
            return self.go_back_to_separation();
        }
        let lasting = self.lasting();
        let mut go = f64::INFINITY;
        for c in 0..self.states.len() {
            // the rest of an old bound is shorter than a new bound
            if self.clear_until(c) - self.time_s <= self.flown {
                self.renew(c, lasting);
            }
            go = go.min(self.clear_until(c) - self.time_s);
        }
        if go == f64::INFINITY && self.settings.stop_when_over && self.loads.is_empty() {
            return self.go_back_to_separation();
        }
        let steps = self.tables.steps;
        let near = steps.level_within(self.reach);
        if go >= lasting {
            if lasting <= self.reach { self.coast(lasting, true) } else { self.rotate(steps.level_within(lasting)) }
        } else if steps.level_within(go) < near + WINDOW {
            self.rotate(steps.level_within(go.min(lasting)));
        } else {
            let by_level = lasting > steps.step_s(near);
            let window = if by_level { steps.step_s(near) } else { lasting };
            let (mut first, mut clear): (Option<(usize, f64)>, f64) = (None, window);
            for c in 0..self.states.len() {
                if self.clear_until(c) >= self.time_s + window {
                    continue;
                }
                let curvature = self.bounds(c).map_or(0.0, FlightBounds::curvature)
                    + bend_of_loads(&self.loads, c, self.time_s, lasting);
                let mut series = series_of(self.system, &self.loads, c, self.moment(), window);
                series[0] = self.overlap_of_modes(c).0 - self.states[c].touch_m();
                let (time, meets) =
                    first_closing(&series, curvature, window, (self.overlap_rounding(c), self.rate_rounding(c)));
                if !meets {
                    clear = clear.min(time);
                } else if first.is_none_or(|(_, earlier)| time < earlier) {
                    first = Some((c, time));
                }
            }
            match first {
                Some((c, time)) if time <= clear => {
                    self.coast(time, false);
                    let (_, rate) = self.overlap_of_modes(c);
                    self.states[c].rate = rate;
                    self.close(c, 0.0);
                }
                _ if clear < window => self.coast(clear, false),
                _ if by_level => self.rotate(near),
                _ => self.coast(window, true),
            }
        }
        false
    }

    /// Ends the run at the last separation.
    fn go_back_to_separation(&mut self) -> bool {
        self.look_for_misses();
        (self.time_s, self.amplitude, self.rate) = std::mem::take(&mut self.departure);
        true
    }

    pub(super) fn rotate(&mut self, level: i32) {
        let h = self.tables.steps.step_s(level);
        self.flown = h;
        self.show(h, &[], &[], &[]);
        self.tables.rotate(self.system, level, &mut self.amplitude, &mut self.rate);
        self.pass(h);
    }

    /// Free motion of any length within the reach of the series; with `whole`, to the next break or the end.
    fn coast(&mut self, length: f64, whole: bool) {
        self.show(length, &[], &[], &[]);
        terminal::coast(self.system, length, &mut self.amplitude, &mut self.rate);
        self.pass(length);
        if whole {
            self.arrive_exactly();
        }
    }
}
