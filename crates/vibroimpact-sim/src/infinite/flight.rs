//! Free flight between contacts.
//!
//! The compression minus that of the next touch is convex (see [`super::past`]) and not positive at release. Hence there is at
//! most one next contact, and Newton's method from a later time converges to it monotonically.

use super::past::FreeMotion;
use crate::panel::root::{EXACTLY, root};

/// Beyond this time nothing is looked for.
const LATEST: f64 = 1e150;

/// Rounding of a speed, relative to its terms.
const ROUNDING: f64 = 1e-15;

/// Motion at release.
#[derive(Debug, Clone)]
pub(super) struct Departure {
    /// Compression and its rate.
    pub x: f64,
    pub rate: f64,
    /// Speed of the striker towards the structure.
    pub body: f64,
    /// Size of the terms of rate and speed.
    pub terms: f64,
    pub free: FreeMotion,
}

impl Departure {
    /// Compression and its rate, `tau` after release.
    pub fn state(&self, tau: f64) -> (f64, f64) {
        let (bend, gain) = self.free.bend_and_gain(tau);
        (self.x + self.rate * tau + bend, self.rate + gain)
    }

    /// Whether the surfaces part, and the speed of the striker is more than the rounding of its terms, so that its sign is known.
    pub fn is_known(&self) -> bool {
        self.rate < 0.0 && self.body.abs() > ROUNDING * self.terms
    }

    /// Time until the compression has risen to `level` and the closing speed then, looked for from a first time on;
    /// `None` if it never does.
    pub fn next_touch(&self, level: f64, first: f64) -> Option<(f64, f64)> {
        if self.body <= 0.0 {
            return None;
        }
        let offset = (self.x - level).min(0.0);
        let gap = |tau: f64| {
            let (bend, gain) = self.free.bend_and_gain(tau);
            (offset + self.rate * tau + bend, self.rate + gain)
        };
        // bend / tau^2 decreases, which gives a time not later than the touch
        let first = first.max(f64::MIN_POSITIVE);
        let mut tau = first.max(-self.rate * first * first / self.free.bend(first)).min(LATEST);
        while gap(tau).0 <= 0.0 {
            tau *= 2.0;
            if tau > LATEST {
                return None;
            }
        }
        for _ in 0..200 {
            let (value, slope) = gap(tau);
            let next = tau - value / slope;
            if !(next < tau * (1.0 - 1e-15) && next > 0.0) {
                break;
            }
            tau = next;
        }
        Some((tau, gap(tau).1))
    }

    /// The least compression of the flight, or minus infinity if the gap opens for good.
    pub fn least_compression(&self, first: f64) -> f64 {
        if self.body <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let rate = |tau: f64| self.state(tau).1;
        let (mut early, mut late) = (0.0, first.max(f64::MIN_POSITIVE));
        while rate(late) < 0.0 && late < LATEST {
            (early, late) = (late, 2.0 * late);
        }
        self.state(root(early, late, EXACTLY * late, rate)).0
    }
}
