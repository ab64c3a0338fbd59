//! Free flight: the time of the next contact, found without stepping through what cannot matter.
//!
//! The separation is `u(t) = touch - g(t)`. A mode of energy amplitude `A_k` never moves the surface by more than
//! `A_k`, and its fourth derivative never exceeds `D_k = |row 1 of M^4| omega_k^4 A_k`, where `M` is the matrix of the
//! mode's equation in units of its own frequency. On a window of length `h` the modes below a cut `K`, with the drift,
//! are known at both ends; the cubic `p` through the two displacements and velocities departs from them by at most
//! `t^2 (h-t)^2/24 sum D_k`, so that
//!
//! ```text
//! u(t) >= p(t) - h^4/384 sum_{k<K} D_k - sum_{k>=K} A_k .
//! ```
//!
//! Where the right side is positive the window holds no contact. For a separation that starts from nothing, with all
//! modes below the cut, `u(t)/t >= p(t)/t - h^3/162 sum D_k` serves. Windows are steps of the ladder: longer after an
//! easy proof, half as long after none, and where the bodies overlap at the end of one, such that they lead up to the
//! root of the cubic. What cannot be proven on a window as short as the power series of the
//! gap reaches is decided by the series. Once the drift alone outruns all amplitudes, the bodies never meet again.

use super::ladder::{J_MIN, Ladder, Vibration, level_within, step_s, sum};
use super::landing::{coast, taylor_of_free_motion};
use super::legendre::TAYLOR;
use super::motion::Motion;
use super::solution::Counts;

/// Amplitudes are computed anew once in this many steps: damping makes them fall.
const REFRESH: u64 = 8;
/// A window twice as long leaves 16 times the doubt, one four times as long 256 times.
const EASY: f64 = 16.0;
const VERY_EASY: f64 = 256.0;
/// In the shortest window the fastest motion turns by at most this many radians.
const REACH: f64 = 1.0;
/// How many levels above the power series' reach the search for a contact begins.
const FIRST: i32 = 2;

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

/// How far and how abruptly the free modes can move the surface.
struct Bounds {
    /// Energy amplitudes `A_k` (m) and all together.
    amplitude: Vec<f64>,
    total: f64,
}

impl Bounds {
    fn refresh(&mut self, ladder: &Ladder, state: &Vibration) {
        let n = self.amplitude.len();
        let (alpha, beta, square) = (&state.alpha[..n], &state.beta[..n], &ladder.square[..n]);
        for k in 0..n {
            self.amplitude[k] = (alpha[k] * alpha[k] + beta[k] * beta[k] / square[k]).sqrt();
        }
        self.total = sum(&self.amplitude) * (1.0 + 1e-12);
    }

    /// `sum D_k` of the modes below the cut (m/s^4).
    fn fourth_derivative(&self, ladder: &Ladder, cut: usize) -> f64 {
        self.amplitude[..cut].iter().zip(&ladder.fourth).map(|(a, d)| a * d).sum()
    }

    /// Rounding of the gap, the difference of numbers of this size (m).
    fn noise(&self, motion: &Motion) -> f64 {
        4.0 * f64::EPSILON * (self.total + motion.drift.abs())
    }

    /// The largest curvature that the modes can give the gap (m/s^2).
    fn curvature(&self, ladder: &Ladder) -> f64 {
        let curvature = |(k, a): (usize, &f64)| (1.0 + 2.0 * ladder.modes[k].damping_ratio) * ladder.square[k] * a;
        self.amplitude.iter().enumerate().map(curvature).sum()
    }
}

/// A window of free flight, seen from the modes below a cut.
struct Window {
    h: f64,
    /// Separation and its rate at both ends.
    start: (f64, f64),
    end: (f64, f64),
}

impl Window {
    /// Bernstein coefficients of the cubic through both ends: it lies within their range.
    fn cubic(&self) -> [f64; 4] {
        let third = self.h / 3.0;
        [self.start.0, self.start.0 + third * self.start.1, self.end.0 - third * self.end.1, self.end.0]
    }
}

/// A number below the cubic with these Bernstein coefficients, on its whole interval.
fn below(cubic: [f64; 4]) -> f64 {
    // one halving (de Casteljau) brings the coefficients four times nearer to the curve
    let [a, b, c, d] = cubic;
    let (ab, bc, cd) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + d));
    let (abc, bcd) = (0.5 * (ab + bc), 0.5 * (bc + cd));
    a.min(ab).min(abc).min(bcd).min(cd).min(d)
}

/// What a window's bound came to.
enum Proof {
    /// No contact; the next window may be longer by so many levels.
    Clear(i32),
    /// None; contact is near this time into the window if the bodies overlap at its end.
    Failed(Option<f64>),
}

impl Proof {
    /// Of a separation of `least` at least, but for `doubt`.
    fn of(least: f64, doubt: f64) -> Option<Proof> {
        (least > doubt).then(|| Proof::Clear(i32::from(least > EASY * doubt) + i32::from(least > VERY_EASY * doubt)))
    }
}

/// Tries to prove that no contact comes within the window that leads from `motion` to `end`.
fn prove(ladder: &Ladder, bounds: &Bounds, motion: &Motion, end: &Motion, h: f64, touch: f64) -> Proof {
    let n = ladder.modes.len();
    let power = (h * h) * (h * h);
    // below the cut the derivative tells more than the amplitude
    let cut = ladder.fourth.partition_point(|fourth| fourth * power < 384.0);
    let above = sum(&bounds.amplitude[cut..]);
    let seen = |motion: &Motion| {
        let gap = motion.drift + sum(&motion.vibration.alpha[..cut]);
        (touch - gap, -motion.drift_rate - sum(&motion.vibration.beta[..cut]))
    };
    let window = Window { h, start: seen(motion), end: seen(end) };
    let fourth = power * bounds.fourth_derivative(ladder, cut);
    let noise = bounds.noise(motion);
    let cubic = window.cubic();
    // p(s)/s is a quadratic with the Bernstein coefficients 3 b1, 3/2 b2, b3, and more
    let from_touch = || {
        let least = (3.0 * cubic[1]).min(1.5 * cubic[2]).min(cubic[3] - noise);
        if cut == n && cubic[0] >= 0.0 { Proof::of(least, fourth / 162.0) } else { None }
    };
    Proof::of(below(cubic), above + fourth / 384.0 + noise)
        .or_else(from_touch)
        .unwrap_or_else(|| Proof::Failed((end.gap() > touch).then(|| h * root(cubic))))
}

/// Where the cubic with these Bernstein coefficients on [0, 1] falls through zero, roughly.
fn root([a, b, c, d]: [f64; 4]) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..8 {
        let s: f64 = 0.5 * (low + high);
        let r = 1.0 - s;
        let value = r * r * (r * a + 3.0 * s * b) + s * s * (3.0 * r * c + s * d);
        (low, high) = if value > 0.0 { (s, high) } else { (low, s) };
    }
    low
}

/// Flies from a separation to the next contact, if there is one.
pub(crate) fn fly(
    ladder: &mut Ladder,
    motion: &mut Motion,
    touch: f64,
    max_steps: u64,
    counts: &mut Counts,
) -> FlightEnd {
    let reach = if ladder.fastest_rad_s > 0.0 { REACH / ladder.fastest_rad_s } else { f64::INFINITY };
    // the surfaces have just parted: an overlap of rounding is none
    let overlap = motion.gap() - touch;
    if overlap > 0.0 {
        motion.drift -= overlap;
    }
    // the power series of the gap serves for one ladder step
    let near = level_within(reach);
    let mut bounds = Bounds { amplitude: vec![0.0; ladder.modes.len()], total: 0.0 };
    let mut end = motion.clone();
    // the window tried first, and when the bodies are expected to meet
    let (mut level, mut ahead) = (near - FIRST, f64::INFINITY);
    for step in 0.. {
        counts.flight_steps += 1;
        if counts.flight_steps > max_steps {
            return FlightEnd::Limit;
        }
        if step % REFRESH == 0 {
            bounds.refresh(ladder, &motion.vibration);
        }
        let separation = touch - motion.drift - bounds.total;
        if (separation > 0.0 && motion.drift_rate <= 0.0) || (separation == 0.0 && motion.drift_rate < 0.0) {
            return FlightEnd::Never;
        }
        level = level.clamp(J_MIN, near);
        ladder.rotate(level, &motion.vibration, &mut end.vibration);
        end.carry_on_from(motion);
        end.coast(step_s(level));
        match prove(ladder, &bounds, motion, &end, step_s(level), touch) {
            Proof::Failed(meeting) if level < near => {
                ahead = meeting.map_or(ahead, |after| motion.time + after);
                level = (level + 1).max(level_within(ahead - motion.time));
                continue;
            }
            Proof::Failed(_) => {
                let mut series = taylor_of_free_motion(ladder, &motion.vibration, step_s(near));
                series[0] += motion.drift - touch;
                series[1] += motion.drift_rate;
                if let Some(time) = first_root(&series, bounds.curvature(ladder), step_s(near), bounds.noise(motion)) {
                    coast(ladder, &motion.vibration, &mut end.vibration, time);
                    motion.coast(time);
                    std::mem::swap(&mut motion.vibration, &mut end.vibration);
                    return FlightEnd::Contact;
                }
                (level, ahead) = (level - 1, f64::INFINITY);
            }
            Proof::Clear(longer) => {
                let left = ahead - end.time;
                level = if left > 0.0 { (level - longer).max(level_within(left)) } else { level - longer };
            }
        }
        std::mem::swap(motion, &mut end);
    }
    FlightEnd::Limit
}

/// First positive root of `u + u' t - b t^2/2` with `u >= 0`, `b >= 0`; infinite if there is none.
fn first_root_of_parabola(u: f64, slope: f64, b: f64) -> f64 {
    let root = (slope * slope + 2.0 * b * u).sqrt();
    if slope >= 0.0 { if b == 0.0 { f64::INFINITY } else { (slope + root) / b } } else { 2.0 * u / (root - slope) }
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
                    let a = p.p11 * departure.vibration.alpha[k] + p.p12 * departure.vibration.beta[k];
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
