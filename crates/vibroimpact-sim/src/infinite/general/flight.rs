//! Free flight between contacts.
//!
//! The compression minus that of the next touch is convex (see [`super::past`]) and not positive at release. Hence there is at
//! most one next contact, and Newton's method from a later time converges to it monotonically.

use super::past::FreeMotion;

/// Motion at release.
#[derive(Debug, Clone)]
pub(in crate::infinite) struct Departure {
    /// Compression and its rate.
    pub x: f64,
    pub rate: f64,
    /// Speed of the striker towards the structure.
    pub body: f64,
    pub free: FreeMotion,
}

impl Departure {
    /// Compression and its rate, `tau` after release.
    pub fn state(&self, tau: f64) -> (f64, f64) {
        let (bend, gain) = self.free.bend(tau);
        (self.x + self.rate * tau + bend, self.rate + gain)
    }

    /// Time until the compression has risen to `level` and the closing speed then, looked for from a first time on;
    /// `None` if it never does.
    pub fn next_touch(&self, level: f64, first: f64) -> Option<(f64, f64)> {
        if self.body <= 0.0 {
            return None;
        }
        let offset = (self.x - level).min(0.0);
        let gap = |tau: f64| {
            let (bend, gain) = self.free.bend(tau);
            (offset + self.rate * tau + bend, self.rate + gain)
        };
        let mut tau = first;
        while gap(tau).0 <= 0.0 {
            tau *= 2.0;
            if tau > 1e150 {
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
}
