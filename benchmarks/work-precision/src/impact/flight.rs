//! Exact free flight: modes in closed form, and a search for the next contact that cannot miss one.
//!
//! The gap `u = z - sum phi_k a_k` is followed in steps within which no contact is possible. If the modes above a cut move the
//! surface by at most `H`, and the second derivative of the gap due to the others is at most `B`, then
//! `u(t) >= u - H + u' t - B t^2/2` with the gap of the modes below the cut; the best of these parabolas gives the step. When
//! the gap closes and is nearly zero, Newton's method finishes.

use vibroimpact_sim::modal::Mode;

/// Advances the state (layout of [`Equations`](super::Equations)) until the surfaces meet, `Some(0)`, or `end_s`.
pub(super) fn fly(modes: &[Mode], t_s: &mut f64, y: &mut [f64], end_s: f64) -> Option<usize> {
    let fastest = modes.iter().map(|mode| mode.omega_rad_s).fold(0.0, f64::max);
    let cuts = Cuts::new(modes, y);
    loop {
        let (gap, opening) = gap(modes, y);
        if gap <= 0.0 && opening < 0.0 {
            return Some(0);
        }
        let mut step = cuts.safe_time(modes, y);
        if step * fastest < 0.02 {
            // So close that the gap is a parabola to many digits; the smallest step only matters after a grazing contact.
            step = if opening < 0.0 { gap / -opening } else { step.max(1e-4 / fastest) };
            if step <= 1e-15 * (*t_s).max(1.0 / fastest) {
                return Some(0);
            }
        }
        if *t_s + step >= end_s {
            propagate(modes, y, end_s - *t_s);
            *t_s = end_s;
            return None;
        }
        propagate(modes, y, step);
        *t_s += step;
    }
}

/// Separation and its rate.
fn gap(modes: &[Mode], y: &[f64]) -> (f64, f64) {
    let n = modes.len();
    let (mut gap, mut rate) = (y[0], y[1]);
    for k in 0..n {
        gap -= modes[k].shape * y[2 + k];
        rate -= modes[k].shape * y[2 + n + k];
    }
    (gap, rate)
}

/// Closed form of every mode (damped below critical) and of the striker.
fn propagate(modes: &[Mode], y: &mut [f64], time: f64) {
    let n = modes.len();
    y[0] += y[1] * time;
    for (k, mode) in modes.iter().enumerate() {
        let (omega, zeta) = (mode.omega_rad_s, mode.damping_ratio);
        let damped = omega * (1.0 - zeta * zeta).sqrt();
        let (a, b) = (y[2 + k], y[2 + n + k]);
        let (sine, cosine) = (damped * time).sin_cos();
        let decay = if zeta == 0.0 { 1.0 } else { (-zeta * omega * time).exp() };
        let quadrature = (b + zeta * omega * a) / damped;
        y[2 + k] = decay * (a * cosine + quadrature * sine);
        y[2 + n + k] = decay * (b * cosine - (zeta * omega * quadrature + damped * a) * sine);
    }
}

/// For each cut: modes below it, `H`, `B`.
struct Cuts(Vec<(usize, f64, f64)>);

impl Cuts {
    fn new(modes: &[Mode], y: &[f64]) -> Cuts {
        let n = modes.len();
        // The amplitude of a free mode never exceeds the one that its energy allows.
        let reach = |k: usize| modes[k].shape.abs() * y[2 + k].hypot(y[2 + n + k] / modes[k].omega_rad_s);
        let mut above: f64 = (0..n).map(reach).sum();
        let mut bend = 0.0;
        let mut cuts = vec![(0, above, 0.0)];
        for k in 0..n {
            above -= reach(k);
            bend += (1.0 + 2.0 * modes[k].damping_ratio) * modes[k].omega_rad_s.powi(2) * reach(k);
            let above = if k + 1 == n { 0.0 } else { above.max(0.0) };
            // Every cut up to 4, then fewer.
            if k < 4 || k + 1 == n || k % 4 == 0 {
                cuts.push((k + 1, above, bend));
            }
        }
        Cuts(cuts)
    }

    fn safe_time(&self, modes: &[Mode], y: &[f64]) -> f64 {
        let n = modes.len();
        let (mut gap, mut opening, mut next, mut best) = (y[0], y[1], 0, 0.0f64);
        for &(cut, above, bend) in &self.0 {
            while next < cut {
                gap -= modes[next].shape * y[2 + next];
                opening -= modes[next].shape * y[2 + n + next];
                next += 1;
            }
            let clear = gap - above;
            if clear > 0.0 || (clear == 0.0 && opening > 0.0) {
                let root = opening + (opening * opening + 2.0 * bend * clear).sqrt();
                // The larger root of the parabola, in the form without cancellation.
                let time = if opening >= 0.0 { root / bend } else { 2.0 * clear / (root - 2.0 * opening) };
                best = best.max(if time.is_nan() { f64::INFINITY } else { time });
            }
        }
        best
    }
}
