//! Critical `S` and turning points of the beam, as roots of smooth functions of `S`.
//!
//! Below the critical `S` the body leaves after one contact; at it the speed of the body after the
//! first contact vanishes and the second contact comes after infinite time. The `n`-th
//! separation exists for `S` below the `n`-th turning point; there the minimum of the compression,
//! negative in flight and positive in contact, passes through zero.

use super::problem::Settings;
use super::solve::{nth_minimum, speed_after_first};
use invalid_input::InvalidInput;

/// Largest `n` that [`turning_point`] accepts.
pub const MOST_TURNING_POINTS: usize = 60;

/// A value of `S` with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CriticalS {
    /// The value.
    pub s: f64,
    /// Estimate of its absolute error, from solutions of three resolutions.
    pub uncertainty: f64,
}

/// The `S` at which the `n`-th separation disappears.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurningPoint {
    /// Number of the separation, from 1.
    pub n: usize,
    /// Its turning point: the separation exists for smaller `S`.
    pub s: f64,
    /// Estimate of the absolute error of `s`, from solutions of three resolutions.
    pub uncertainty: f64,
}

/// The three resolutions.
fn resolutions() -> [Settings; 3] {
    let base = Settings { estimate_uncertainty: false, ..Settings::default() };
    [base, Settings { nodes: 24, tolerance: 1e-11, ..base }, Settings { nodes: 18, tolerance: 1e-11, ..base }]
}

/// The `S` of a beam at which the speed of the body after the first contact vanishes (thesis
/// 2.3 and 2.5: about 1.559).
///
/// ```
/// let critical = vibroimpact_sim::infinite::critical_s();
/// assert!((critical.s / 1.56 - 1.0).abs() < 1e-3 && critical.uncertainty < 1e-12);
/// ```
pub fn critical_s() -> CriticalS {
    let speed = |s: f64, settings: &Settings| speed_after_first(s, settings).unwrap_or(1.0);
    let [coarse, ..] = resolutions();
    let at = |s: f64| (s, speed(s, &coarse));
    locate(at(1.5), at(1.62), &speed)
}

/// The `n`-th turning point of a beam. Independent of the others, so a caller may compute
/// several in parallel.
///
/// # Errors
/// [`InvalidInput`] if `n` is 0 or above [`MOST_TURNING_POINTS`].
///
/// ```
/// let third = vibroimpact_sim::infinite::turning_point(3)?;
/// assert!((third.s / 74.391 - 1.0).abs() < 1e-3);
/// # Ok::<(), vibroimpact_sim::InvalidInput>(())
/// ```
pub fn turning_point(n: usize) -> Result<TurningPoint, InvalidInput> {
    InvalidInput::unless((1..=MOST_TURNING_POINTS).contains(&n), "n", n, "a number from 1 to 60")?;
    Ok(near(n, critical_s().s, 2.0, 1.0).0)
}

/// The first `count` turning points of a beam, in order of `n` (falling `S`).
///
/// # Errors
/// [`InvalidInput`] if `count` is above [`MOST_TURNING_POINTS`].
pub fn turning_points(count: usize) -> Result<Vec<TurningPoint>, InvalidInput> {
    InvalidInput::unless(count <= MOST_TURNING_POINTS, "count", count, "a number from 0 to 60")?;
    let critical = critical_s().s;
    let mut points: Vec<TurningPoint> = Vec::new();
    let (mut guess, mut step) = (10.0, 1.0);
    for n in 1..=count {
        let (point, y) = near(n, critical, guess, step);
        // ln(S_n - S_critical) falls ever more slowly with n
        let fall = points.last().map_or(4.0, |last| (last.s - critical).ln() - y);
        (guess, step) = (y - 0.8 * fall, 0.12 * fall);
        points.push(point);
    }
    Ok(points)
}

/// The `n`-th turning point, searched from `ln(S - critical) = guess` in steps; and its own
/// `ln(S - critical)`.
fn near(n: usize, critical: f64, guess: f64, step: f64) -> (TurningPoint, f64) {
    // fewer than n contacts: S is too large
    let minimum = |s: f64, settings: &Settings| nth_minimum(s, n, settings).unwrap_or(1.0);
    let [coarse, ..] = resolutions();
    let at = |y: f64| {
        let s = critical + y.exp();
        (s, minimum(s, &coarse))
    };
    // S from 1e-9 above the critical value to 1e8
    let (least, most) = (-20.7, 18.4);
    let (mut y, mut step) = (guess, step);
    let mut here = at(y);
    let separates = here.1 < 0.0;
    let other = loop {
        y = if separates { (y + step).min(most) } else { (y - step).max(least) };
        let next = at(y);
        if (next.1 < 0.0) != separates || y == least || y == most {
            break next;
        }
        (here, step) = (next, 1.5 * step);
    };
    let root = if separates { locate(here, other, &minimum) } else { locate(other, here, &minimum) };
    (TurningPoint { n, s: root.s, uncertainty: root.uncertainty }, (root.s - critical).ln())
}

/// Root of `f` between `low` (where it is negative) and `high`, each with its value, by secant steps
/// kept within the bracket; and its uncertainty from the differences of the three resolutions.
fn locate(low: (f64, f64), high: (f64, f64), f: &dyn Fn(f64, &Settings) -> f64) -> CriticalS {
    let [coarse, fine, other] = resolutions();
    let (mut a, mut b) = (low.0, high.0);
    let mut here = if low.1.abs() < high.1.abs() { low } else { high };
    let mut slope = (high.1 - low.1) / (high.0 - low.0);
    for round in 0..100 {
        let secant = here.0 - here.1 / slope;
        // rounding errors of the function change S by at most 1e-14 of its value
        if here.1 == 0.0 || (secant - here.0).abs() <= 1e-14 * b {
            break;
        }
        let next = if secant > a && secant < b && round % 4 != 3 { secant } else { 0.5 * (a + b) };
        if next <= a || next >= b {
            break;
        }
        let last = std::mem::replace(&mut here, (next, f(next, &coarse)));
        if here.1 < 0.0 {
            a = next;
        } else {
            b = next;
        }
        // a difference that consists of rounding errors gives no slope
        let secant_slope = (here.1 - last.1) / (here.0 - last.0);
        if (here.0 - last.0).abs() > 1e-9 * b && secant_slope > 0.0 {
            slope = secant_slope;
        }
    }
    let values = [here.1, f(here.0, &fine), f(here.0, &other)];
    let spread = values.iter().fold(0.0_f64, |spread, value| spread.max(value.abs()));
    let uncertainty = (2.0 * spread / slope + 4.0 * f64::EPSILON * here.0).min(high.0 - low.0);
    // one correction with the finest solution
    CriticalS { s: here.0 - values[1] / slope, uncertainty }
}
