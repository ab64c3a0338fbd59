//! Length of the first panel of a contact and of a branch, which no accepted panel has tested yet.
//!
//! At touch it follows from `J = h F(h)`, the length of the panel times the force at its end if free motion continued, because the
//! truncation of a force that begins as `t^(3/2)` is a known function of `J` (derived in `docs/theory/modal.md`, "How a force begins and
//! ends").

use super::enclosure::{QuasiStatic, of_panel};
use super::motion::March;
use super::terminal::{Series, series_of, value};
use crate::panel::dyadic::{J_MAX, J_MIN};
use contact_models::Branch;

/// Bound on the relative error of the polynomial through the nodes for `t^(3/2)`, a force at first touch, and its derivatives.
pub(super) const SINGULAR: f64 = 2.5e-4;
/// Where the force is represented as `t^(3/2)` times a polynomial, the error of a first panel's impulse is this times `J^2/p`, with the
/// momentum `p` of the contact: `6/35` times the coefficient of `P_8` in `s^(5/2)`.
const WEIGHTED: f64 = 4e-6;

/// A first panel beyond the reach of the series may have this share of the `J` that accuracy allows, which makes it four times shorter.
const BEYOND_REACH: f64 = 1.0 / 32.0;
/// On such a panel the polynomial may miss this share of the speed of approach. If it missed more, it could not be told whether the
/// surfaces part at once.
const UNCERTAIN: f64 = 0.5;

/// A contact that touches now, as it would compress if free motion continued.
struct Forecast<'m, 'a> {
    march: &'m March<'a>,
    contact: usize,
    branch: Branch,
    /// Power series of the overlap, and the sizes of its terms.
    series: Series,
    sizes: Series,
}

impl Forecast<'_, '_> {
    fn step_s(&self, level: i32) -> f64 {
        self.march.tables.steps.step_s(level)
    }

    /// Overlap and rate after a panel. Beyond the reach of the series they follow a straight line.
    fn end(&self, level: i32) -> (f64, f64) {
        let h = self.step_s(level);
        let within = h.min(self.march.reach);
        let [mut compression, mut rate, _] = value(&self.series, within);
        if rate < 0.0 {
            // the surfaces approach and recede within the panel: the end does not tell how far they overlap before
            [compression, rate, _] = value(&self.sizes, within);
        }
        (compression + rate.max(0.0) * (h - within), rate)
    }

    fn force(&self, (compression, rate): (f64, f64)) -> f64 {
        self.march.law(self.contact).force(&self.branch, compression, rate).force_n
    }

    /// `J`, a bound on the impulse of a panel (N s).
    fn impulse(&self, level: i32) -> f64 {
        self.force(self.end(level)) * self.step_s(level)
    }

    /// Whether the polynomial through the nodes follows the vibrations of the modes on a panel: what it misses changes the impulse by no
    /// more than `allowed` (N s), and leaves certain that the surfaces approach.
    fn follows_vibrations(&self, level: i32, allowed: f64, quasi_static: &mut QuasiStatic) -> bool {
        let (march, c, h) = (self.march, self.contact, self.step_s(level));
        let (missed, motion) = (march.tables.missed(march.system, level), (&*march.amplitude, &*march.rate));
        let [missed, slope, _] = of_panel(march.system, missed, &march.loads, c, h, motion, (&[], quasi_static));
        let (compression, rate) = self.end(level);
        let error = self.force((compression + missed, rate + slope / h)) - self.force((compression, rate));
        slope <= UNCERTAIN * march.states[c].rate * h && error * h <= allowed
    }
}

impl<'a> March<'a> {
    /// Step exponent of the longest panel on which a force that begins at first touch is represented within the tolerance.
    pub(super) fn level_at_touch(&self, c: usize) -> i32 {
        let Some(contact) = self.states[c].closed_contact() else { return J_MIN };
        let mut series = series_of(self.system, &self.loads, c, self.moment(), self.reach);
        series[0] = self.states[c].overlap;
        let sizes = series.map(f64::abs);
        let forecast = Forecast { march: self, contact: c, branch: contact.branch, series, sizes };
        let tolerance = self.impulse_tolerance(c);
        let allowed = match contact.begins {
            true => (tolerance * self.states[c].momentum / WEIGHTED).sqrt(),
            false => tolerance / SINGULAR,
        };
        let covered = if self.reach.is_finite() { self.tables.steps.level_within(4.0 * self.reach) } else { J_MIN };
        let level = first_level_where(covered, |j| forecast.impulse(j) <= allowed);
        if level > covered || !contact.begins {
            return level;
        }
        // beyond the reach of the fastest modes the compression is extrapolated; they hardly matter to a force that is represented as it
        // begins, unless they vibrate
        let mut quasi_static = QuasiStatic::default();
        let longer = |j: &i32| {
            forecast.impulse(*j) <= BEYOND_REACH * allowed
                && forecast.follows_vibrations(*j, tolerance, &mut quasi_static)
        };
        (J_MIN..level).rev().take_while(longer).last().unwrap_or(level)
    }

    /// Step exponent of the longest panel within the time constant of a contact's dashpot. At the begin of a branch the rate is not yet
    /// the one to which a strong dashpot forces it. On longer panels the force would oscillate, and seem to end.
    pub(super) fn level_of_relaxation(&mut self, c: usize) -> i32 {
        let state = &self.states[c];
        let Some(contact) = state.closed_contact() else { return J_MIN };
        self.counts.law_evaluations += 1;
        let drag = self.law(c).force(&contact.branch, state.overlap, state.rate).per_rate_n_s_m.abs();
        self.tables.steps.level_within((drag * self.system.links[c].mobility).recip())
    }
}

/// The first step exponent from `from` on for which this holds, or else [`J_MAX`]. It holds for all shorter steps, too: they are tried
/// further and further ahead, and the last gap is halved.
fn first_level_where(from: i32, holds: impl Fn(i32) -> bool) -> i32 {
    let (mut coarse, mut fine, mut ahead) = (from, from, 1);
    while fine < J_MAX && !holds(fine) {
        (coarse, fine, ahead) = (fine + 1, (fine + ahead).min(J_MAX), 2 * ahead);
    }
    while coarse < fine {
        let middle = coarse + (fine - coarse) / 2;
        if holds(middle) { fine = middle } else { coarse = middle + 1 }
    }
    fine
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::legendre::{Q, coefficients};

    /// The largest term that a polynomial of degree seven leaves out of a force at first touch.
    #[test]
    fn errors_of_a_first_panel_are_those_of_the_derivation() {
        let left_out = |power: f64| coefficients(power).nth(Q).unwrap();
        for (constant, derived) in [(SINGULAR, left_out(1.5)), (WEIGHTED, 6.0 / 35.0 * left_out(2.5))] {
            assert!((1.0..1.1).contains(&(constant / derived.abs())), "{constant} {derived}");
        }
    }

    #[test]
    fn the_first_level_is_found_wherever_it_is() {
        for first in J_MIN..=J_MAX + 1 {
            assert_eq!(first_level_where(J_MIN, |j| j >= first), first.min(J_MAX));
            assert_eq!(first_level_where(7, |j| j >= first), first.clamp(7, J_MAX));
        }
    }
}
