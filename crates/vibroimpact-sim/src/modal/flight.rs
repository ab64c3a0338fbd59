//! Free flight: the time of the next contact, found without stepping through what cannot matter.
//!
//! The separation is `u(t) = touch - g(t)`. With the modes' amplitude bounds `A_k` (a free mode never exceeds the one
//! its energy allows), the modes above any `K` move the surface by at most `H = sum_{k>K} A_k`, and the rest has
//! `|u''| <= B = sum_{k<=K} (1 + 2 zeta_k) omega_k^2 A_k`. So `u(t) >= u_K - H + u_K' t - B t^2 / 2`, and no contact
//! can come before the root of the best of these parabolas. With `K = 0` it is a straight line: where that rises, the
//! bodies never meet again. A damped mode's bound falls with its energy, so the bounds are taken anew every few steps.

use super::ladder::{Ladder, level_within, step_s};
use super::landing::{REACH, advance, taylor_of_free_motion};
use super::legendre::{Q, TAYLOR};
use super::motion::Motion;
use super::solution::Counts;

/// The gap is expanded in a power series once the next safe step is this many levels finer than the series reaches;
/// until then a few more plain steps cost less.
const WINDOW: i32 = 2;

/// The bounds of a flight are taken anew after this many steps, as the motion decays.
const RENEWED: u64 = 8;

/// What free flight came to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum FlightEnd {
    /// The surfaces meet now.
    Contact,
    /// They never meet again.
    Never,
    /// The limit on steps was reached.
    Limit,
}

/// Bounds of one flight.
struct Bounds {
    /// Truncations `K` looked at, and for each `H` and `B`.
    cuts: Vec<(usize, f64, f64)>,
    /// Size of the numbers whose difference the gap is: their rounding is the gap's.
    size: f64,
}

impl Bounds {
    fn new(ladder: &Ladder, motion: &Motion) -> Bounds {
        let n = ladder.modes.len();
        let state = &motion.vibration;
        let amplitude: Vec<f64> = (0..n)
            .map(|k| (state.alpha[k].powi(2) + (state.beta[k] / ladder.modes[k].omega_rad_s).powi(2)).sqrt())
            .collect();
        let total: f64 = amplitude.iter().sum();
        let (mut cuts, mut below, mut curvature) = (vec![], 0.0, 0.0);
        for k in 0..=n {
            // every count up to 4, then in ratios of about 4/3
            if k <= 4 || k == n || k.leading_zeros() != (k - 1).leading_zeros() || k % (k.ilog2() as usize * 2) == 0 {
                let above = if k == n { 0.0 } else { (total - below).max(0.0) * (1.0 + 1e-12) };
                cuts.push((k, above, curvature));
            }
            if k < n {
                let mode = &ladder.modes[k];
                below += amplitude[k];
                curvature += (1.0 + 2.0 * mode.damping_ratio) * mode.omega_rad_s.powi(2) * amplitude[k];
            }
        }
        Bounds { cuts, size: total + motion.drift.abs() }
    }

    /// A time before which no contact can come, infinite if none can come at all.
    fn safe_time(&self, motion: &Motion, touch: f64) -> f64 {
        let (mut gap, mut rate, mut next, mut best) = (motion.drift, motion.drift_rate, 0, 0.0f64);
        for &(cut, above, curvature) in &self.cuts {
            let state = &motion.vibration;
            for (alpha, beta) in state.alpha[next..cut].iter().zip(&state.beta[next..cut]) {
                gap += alpha;
                rate += beta;
            }
            next = cut;
            let separation = touch - gap - above;
            // a parabola that is still above zero at the best time yet has its root beyond it
            let at_best = separation - best * (rate + 0.5 * curvature * best);
            if at_best > 0.0 && separation >= 0.0 || (separation == 0.0 && rate < 0.0 && best == 0.0) {
                best = first_root_of_parabola(separation, -rate, curvature);
                if best == f64::INFINITY {
                    break;
                }
            }
        }
        best
    }
}

/// First positive root of `u + u' t - b t^2/2` with `u >= 0`, `b >= 0`; infinite if there is none.
pub(crate) fn first_root_of_parabola(u: f64, slope: f64, b: f64) -> f64 {
    let root = (slope * slope + 2.0 * b * u).sqrt();
    if slope >= 0.0 { if b == 0.0 { f64::INFINITY } else { (slope + root) / b } } else { 2.0 * u / (root - slope) }
}

/// Flies from a separation to the next contact, if there is one.
pub(crate) fn fly(
    ladder: &mut Ladder,
    motion: &mut Motion,
    touch: f64,
    max_steps: u64,
    counts: &mut Counts,
) -> FlightEnd {
    let decays = ladder.drag.iter().any(|drag| *drag > 0.0);
    let mut bounds = Bounds::new(ladder, motion);
    let reach = if ladder.fastest_rad_s > 0.0 { REACH / ladder.fastest_rad_s } else { f64::INFINITY };
    // the surfaces have just parted: an overlap of rounding is none
    let overlap = motion.gap() - touch;
    if overlap > 0.0 {
        motion.drift -= overlap;
    }
    // the power series of the gap serves for one ladder step
    let near = level_within(reach);
    for step in 1.. {
        counts.flight_steps += 1;
        if counts.flight_steps > max_steps {
            return FlightEnd::Limit;
        }
        if decays && step % RENEWED == 0 {
            bounds = Bounds::new(ladder, motion);
        }
        let safe = bounds.safe_time(motion, touch);
        if safe == f64::INFINITY {
            return FlightEnd::Never;
        }
        let mut level = level_within(safe);
        if level >= near + WINDOW {
            let mut series = taylor_of_free_motion(ladder, &motion.vibration, step_s(near));
            series[0] += motion.drift - touch;
            series[1] += motion.drift_rate;
            let curvature = bounds.cuts.last().map_or(0.0, |cut| cut.2);
            let noise = 4.0 * f64::EPSILON * bounds.size;
            if let Some(time) = first_root(&series, curvature, step_s(near), noise) {
                advance(ladder, &mut motion.vibration, time, &[0.0; Q]);
                motion.coast(time);
                return FlightEnd::Contact;
            }
            level = near;
        }
        ladder.rotate(level, &mut motion.vibration);
        motion.coast(step_s(level));
    }
    FlightEnd::Limit
}

/// First time in `[0, reach]` at which the overlap `g(t) = sum series[p] t^p` rises to zero, approached from below.
/// Overlaps within `noise` count as zero.
fn first_root(series: &[f64; TAYLOR], curvature: f64, reach: f64, noise: f64) -> Option<f64> {
    let evaluate = |t: f64| {
        let (mut value, mut slope) = (0.0, 0.0);
        for p in (0..TAYLOR).rev() {
            slope = slope * t + value;
            value = value * t + series[p];
        }
        (value, slope)
    };
    // a grazing touch leaves the surfaces together for so short a time that the overlap stays rounding
    let least = if curvature > 0.0 { (noise / curvature).sqrt() } else { 0.0 };
    let mut t = 0.0;
    for _ in 0..10_000 {
        let (overlap, rate) = evaluate(t);
        if overlap >= -noise && rate > 0.0 {
            return Some(t);
        }
        let step = first_root_of_parabola((-overlap).max(0.0), -rate, curvature);
        t += if rate > 0.0 { step } else { step.max(least) };
        if t >= reach {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::super::ladder::Vibration;
    use super::super::oscillator::propagate;
    use super::super::problem::Mode;
    use super::*;

    #[test]
    fn a_flight_ends_where_the_exact_motion_puts_it() {
        for zeta in [0.0, 0.02, 1.5] {
            let modes: Vec<Mode> = (1..=12)
                .map(|k| Mode { omega_rad_s: 163.0 * (k * k) as f64, damping_ratio: zeta, shape: 1.0 })
                .collect();
            let vibration = Vibration {
                alpha: (1..=12).map(|k| -1e-3 / f64::from(k * k)).collect(),
                beta: (1..=12).map(|k| -0.1 / f64::from(k)).collect(),
            };
            let drift = -vibration.alpha.iter().sum::<f64>();
            let departure =
                Motion { time: 0.0, vibration, drift, drift_rate: -0.05, impulse: 0.0, impulse_integral: 0.0 };
            let mut ladder = Ladder::new(modes.clone());
            let mut motion = departure.clone();
            let end = fly(&mut ladder, &mut motion, 0.0, 100_000, &mut Counts::default());
            if end == FlightEnd::Contact {
                let mut gap = departure.drift + departure.drift_rate * motion.time;
                for (k, mode) in modes.iter().enumerate() {
                    let p = propagate(mode, motion.time);
                    let (a, _) = p.apply(departure.vibration.alpha[k], departure.vibration.beta[k]);
                    assert!(
                        (a - motion.vibration.alpha[k]).abs() < 1e-16,
                        "{zeta} {k} {:e}",
                        a - motion.vibration.alpha[k]
                    );
                    gap += a;
                }
                assert!(gap.abs() < 1e-16, "{gap:e}");
            } else {
                assert!(zeta > 1.0, "{end:?}");
            }
        }
    }
}
