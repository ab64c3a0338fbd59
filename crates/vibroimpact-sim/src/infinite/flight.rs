//! Free flight between contacts, in closed form.
//!
//! Apart, the body moves with its constant speed `u` (towards the structure) and the struck
//! point under the after-effect of the past. The compression (negative: a gap) is
//! `x(tau) = tau q(tau)`, with `q(tau) = r + tau sum_j c_j / (sqrt(d_j + tau) + sqrt(d_j))^2` (see
//! [`super::free`]), which equals `u - sum_j w_j / (sqrt(d_j + tau) + sqrt(d_j))`: it increases from
//! `r = x'(0) < 0` to `u` and is concave, because every `w_j > 0`. Hence there is exactly one next
//! contact if `u > 0`, and none otherwise. No sampling is involved, nothing can be missed. A plate
//! stays where the last contact left it, so there `q = r = u < 0`.

use super::free::Free;

/// Motion at the start of a flight.
#[derive(Debug, Clone)]
pub(super) struct Departure {
    /// Speed of the body towards the structure.
    pub body: f64,
    /// Rate of compression, below zero.
    pub rate: f64,
    pub free: Free,
}

impl Departure {
    /// Time until the surfaces meet again and the closing speed then; `None` if they never do.
    pub fn next_contact(&self) -> Option<(f64, f64)> {
        let total = self.free.impulse();
        if !(self.body > 0.0 && total > 0.0) {
            return None;
        }
        // q and its slope
        let q = |tau: f64| {
            let bend = self.free.bend(tau);
            (self.rate + tau * bend, self.free.rate_gain(tau) / tau - bend)
        };
        // q is concave in tau, so Newton's method from the left never passes the root. In y = tau^(-1/2) it is convex and
        // decreasing, so Newton's method from y = u / total, a time not before the root, does not pass it either. The two
        // sequences enclose the root.
        let (mut early, mut late) = (-self.rate / self.free.bend(0.0), (total / self.body).powi(2));
        for _ in 0..200 {
            let (value, slope) = q(early);
            let advanced = early - value / slope;
            let (value, slope) = q(late);
            let pulled = (late.sqrt().recip() + value / (2.0 * late * late.sqrt() * slope)).powi(-2);
            let moved = (advanced > early && advanced < late, pulled < late && pulled > early);
            early = if moved.0 { advanced } else { early };
            late = if moved.1 { pulled } else { late };
            if !(moved.0 && moved.1) || late < early * (1.0 + 1e-3) {
                break;
            }
        }
        // one of the sequences may have reached the root first: the end with the smaller value is next to it, and Newton's
        // method finishes from there
        let mut tau = if q(early).0.abs() < q(late).0.abs() { early } else { late };
        for _ in 0..4 {
            let (value, slope) = q(tau);
            tau -= value / slope;
        }
        let closing = self.rate + self.free.rate_gain(tau);
        if tau > 0.0 && closing > 0.0 && tau.is_finite() {
            Some((tau, closing))
        } else {
            // the body is so slow that rounding exceeds q near the root: the past then acts as one impulse, x = u t - I sqrt(t)
            Some(((total / self.body).powi(2), 0.5 * self.body))
        }
    }

    /// Compression (below zero) and its rate, `tau` after separation.
    pub fn state(&self, tau: f64) -> (f64, f64) {
        (tau * (self.rate + tau * self.free.bend(tau)), self.rate + self.free.rate_gain(tau))
    }

    /// The least compression of the flight, or minus infinity if the gap opens for good.
    pub fn least_compression(&self) -> f64 {
        if self.body <= 0.0 {
            return f64::NEG_INFINITY;
        }
        // the rate is concave and increasing: Newton from the left, as above
        let mut tau = 0.0_f64;
        for _ in 0..200 {
            let next = tau - self.state(tau).1 / self.free.acceleration(tau);
            if next <= tau * (1.0 + 1e-12) || next.is_nan() {
                break;
            }
            tau = next;
        }
        self.state(tau).0.min(0.0)
    }
}
