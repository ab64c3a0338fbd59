//! One panel of a contact as it was solved, and the motion on it.

use super::problem::NODES;
use super::rule::{Kind, Tables, dot, gauss, series, series_slope};
use crate::panel::root::{EXACTLY, root};

/// A solved panel.
#[derive(Debug, Clone)]
pub(super) struct Panel {
    pub kind: Kind,
    /// Time from touch to its start.
    pub start: f64,
    /// Length.
    pub h: f64,
    /// Compression at the nodes.
    pub x: Vec<f64>,
    /// Force at the nodes.
    pub force: Vec<f64>,
    /// `int f dt` and `int (start - s) f ds` from touch to the panel's start.
    pub impulse: f64,
    pub moment: f64,
}

impl Panel {
    /// Compression at fraction `elapsed` of the panel.
    pub fn compression(&self, tables: &Tables, elapsed: f64) -> f64 {
        series(&tables.coefficients(&self.x), variable(self.kind, elapsed))
    }

    /// Rate of compression at fraction `elapsed` of the panel.
    pub fn rate(&self, tables: &Tables, elapsed: f64) -> f64 {
        let s = variable(self.kind, elapsed);
        let x_series = tables.coefficients(&self.x);
        // dx/dt = x_s / (dt/ds), where dt/ds vanishes at a mapped end: the limit there is x_ss / 2
        match self.kind {
            Kind::Middle => series_slope(&x_series, s) / self.h,
            Kind::Start if s < MAPPED_END => 0.5 * curvature(&x_series) / self.h,
            Kind::Start => series_slope(&x_series, s) / (2.0 * s * self.h),
            Kind::End if s < MAPPED_END => -0.5 * curvature(&x_series) / self.h,
            Kind::End => -series_slope(&x_series, s) / (2.0 * s * self.h),
        }
    }

    /// Force, `int f dt` and `int (t - s) f ds` since touch, at fraction `elapsed` of the panel.
    pub fn force(&self, tables: &Tables, elapsed: f64) -> [f64; 3] {
        let f_series = tables.coefficients(&self.force);
        let (impulse, moment) = partial(self.kind, self.h, elapsed, &f_series);
        let since = self.h * elapsed;
        let force = series(&f_series, variable(self.kind, elapsed)).max(0.0);
        [force, self.impulse + impulse, self.moment + self.impulse * since + moment]
    }
}

/// `int f` and `int (t - s) f ds` from the start of a panel to an elapsed fraction.
fn partial(kind: Kind, h: f64, elapsed: f64, f_series: &[f64]) -> (f64, f64) {
    let (from, to) = match kind {
        Kind::End => (1.0, variable(kind, elapsed)),
        _ => (0.0, variable(kind, elapsed)),
    };
    let (mut impulse, mut moment) = (0.0, 0.0);
    for (y, w) in gauss(f_series.len() + 2) {
        let s = from + (to - from) * y;
        let rate = match kind {
            Kind::Middle => 1.0,
            Kind::Start => 2.0 * s,
            Kind::End => -2.0 * s,
        };
        let part = w * (to - from) * rate * series(f_series, s);
        impulse += h * part;
        moment += h * h * part * (elapsed - self::elapsed(kind, s));
    }
    (impulse, moment)
}

/// Below this panel variable the rate of compression is taken as that at the mapped end.
const MAPPED_END: f64 = 1e-4;

/// Panel variable at an elapsed fraction.
pub(super) fn variable(kind: Kind, elapsed: f64) -> f64 {
    let elapsed = elapsed.clamp(0.0, 1.0);
    match kind {
        Kind::Start => elapsed.sqrt(),
        Kind::Middle => elapsed,
        Kind::End => (1.0 - elapsed).sqrt(),
    }
}

/// Elapsed fraction at a panel variable.
pub(super) fn elapsed(kind: Kind, s: f64) -> f64 {
    match kind {
        Kind::Start => s * s,
        Kind::Middle => s,
        Kind::End => 1.0 - s * s,
    }
}

/// `x_ss` at `s = 0` of a Legendre series on `(0, 1)`.
pub(super) fn curvature(x_series: &[f64]) -> f64 {
    x_series.iter().zip(END_CURVATURES).enumerate().map(|(k, (c, d))| if k % 2 == 0 { c * d } else { -c * d }).sum()
}

/// Second derivative in time at the end of a start or middle panel.
pub(super) fn end_acceleration(kind: Kind, h: f64, x_series: &[f64]) -> f64 {
    let x_ss: f64 = x_series.iter().zip(END_CURVATURES).map(|(c, d)| c * d).sum();
    match kind {
        Kind::Start => 0.25 * (x_ss - series_slope(x_series, 1.0)) / (h * h),
        _ => x_ss / (h * h),
    }
}

/// Second derivatives of the Legendre polynomials on `(0, 1)` at 1: `(k-1) k (k+1) (k+2) / 2`.
const END_CURVATURES: [f64; *NODES.end()] = {
    let mut values = [0.0; *NODES.end()];
    let mut k = 1;
    while k < *NODES.end() {
        values[k] = ((k - 1) * k * (k + 1) * (k + 2)) as f64 / 2.0;
        k += 1;
    }
    values
};

/// A local extremum of the compression within a contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    /// Time after touch.
    pub after: f64,
    pub compression: f64,
    /// Whether it is a minimum.
    pub minimum: bool,
}

/// Stationary points of a panel's compression, in time order: `(elapsed fraction, compression,
/// is a minimum)`. `falling` is whether the compression fell at the end of the panel before.
pub(super) fn turns(tables: &Tables, kind: Kind, x_series: &[f64], falling: bool) -> (Vec<(f64, f64, bool)>, bool) {
    let p = tables.p;
    let count = tables.sample.len();
    let mut found = Vec::new();
    // no derivative of a Legendre polynomial exceeds k (k + 1), that of the first is 2
    let bends: f64 = x_series.iter().enumerate().skip(2).map(|(k, c)| c.abs() * (k * (k + 1)) as f64).sum();
    if kind == Kind::Middle && 2.0 * x_series[1].abs() > bends && falling == (x_series[1] < 0.0) {
        return (found, falling);
    }
    let mut falling = falling;
    let slope_at = |i: usize| {
        let slope = dot(&tables.slope[i * p..(i + 1) * p], x_series);
        if kind == Kind::End { -slope } else { slope }
    };
    let order = |i: usize| if kind == Kind::End { count - 1 - i } else { i };
    let mut left = tables.sample[order(0)];
    for i in 0..count {
        let here = tables.sample[order(i)];
        let slope = slope_at(order(i));
        // at the mapped end of a panel the slope in the panel variable is zero by nature
        let blind = (kind == Kind::Start && i == 0) || (kind == Kind::End && i + 1 == count);
        if !blind && slope != 0.0 && (slope < 0.0) != falling {
            let s = root(left, here, EXACTLY, |s| series_slope(x_series, s));
            found.push((elapsed(kind, s), series(x_series, s), falling));
            falling = !falling;
        }
        left = here;
    }
    (found, falling)
}

/// The largest value of a force on a panel. It may lie between a sample at either end and the next one.
pub(super) fn largest(sample: &[f64], f_series: &[f64]) -> f64 {
    let value = |s: f64| series(f_series, s);
    let slope = |s: f64| series_slope(f_series, s);
    let values: Vec<f64> = sample.iter().map(|&s| value(s)).collect();
    let best = (0..sample.len()).max_by(|&i, &j| values[i].total_cmp(&values[j])).unwrap_or(0);
    let (before, after) = (sample[best.saturating_sub(1)], sample[(best + 1).min(sample.len() - 1)]);
    let turn = (slope(before) > 0.0 && slope(after) < 0.0).then(|| value(root(before, after, EXACTLY, slope)));
    turn.map_or(values[best], |turn| turn.max(values[best]))
}
