//! One panel of a contact: its collocation solution, and its effect on later times.

use super::problem::{NODES, Structure};
use super::rule::{Kind, Tables, dot, series, series_slope};
use crate::panel::root::{EXACTLY, root};

/// A solved panel, in the scaled units of its contact (see [`super::contact`]).
#[derive(Debug, Clone)]
pub(super) struct Panel {
    pub kind: Kind,
    /// Start, on the contact's current time origin.
    pub start: f64,
    /// Length.
    pub h: f64,
    /// Compression at the nodes.
    pub x: Vec<f64>,
    /// Force at the nodes: `x_+^(3/2)`, or that of another law.
    pub f: Vec<f64>,
    /// Legendre coefficients of `f` in the panel variable.
    pub f_series: Vec<f64>,
    /// Its integral against the square root (middle panels).
    root: RootSum,
}

impl Panel {
    /// From the compression at the nodes.
    pub fn new(tables: &Tables, kind: Kind, start: f64, h: f64, x: Vec<f64>) -> Panel {
        let f = x.iter().map(|&x| hertz(x)).collect();
        Panel::with_force(tables, kind, start, h, x, f)
    }

    /// From compression and force at the nodes.
    pub fn with_force(tables: &Tables, kind: Kind, start: f64, h: f64, x: Vec<f64>, f: Vec<f64>) -> Panel {
        let f_series = tables.coefficients(&f);
        let root = if kind == Kind::Middle { RootSum::new(&f_series) } else { RootSum::default() };
        Panel { kind, start, h, x, f, f_series, root }
    }

    /// `int f dt` over the panel.
    pub fn impulse(&self, tables: &Tables) -> f64 {
        self.h * dot(&tables.rule(self.kind).mass, &self.f)
    }

    /// `int (end - s) f ds` over the panel.
    pub fn moment(&self, tables: &Tables) -> f64 {
        let (p, rule) = (tables.p, tables.rule(self.kind));
        self.h * self.h * dot(&rule.linear[p * p..], &self.f)
    }

    /// `int K(t - s) f ds` over the panel for a time `t` not before its end, with
    /// `after = t - end`.
    pub fn memory(&self, structure: Structure, tables: &Tables, after: f64) -> f64 {
        let mut sum = [0.0];
        self.add_memory(structure, tables, &[after], &mut sum);
        sum[0]
    }

    /// Adds [`memory`](Self::memory) for each time to its sum.
    pub fn add_memory(&self, structure: Structure, tables: &Tables, after: &[f64], sums: &mut [f64]) {
        if structure == Structure::Plate {
            let impulse = self.impulse(tables);
            sums.iter_mut().for_each(|sum| *sum += impulse);
            return;
        }
        if self.kind == Kind::Middle {
            let half = 0.5 * self.h;
            self.root.add(half * half.sqrt(), half.recip(), after, sums);
            return;
        }
        for (sum, after) in sums.iter_mut().zip(after) {
            let later = after / self.h;
            *sum += if self.kind == Kind::Start && later < 1.0 {
                self.memory_next_to_start(tables, later)
            } else {
                let rule = tables.rule(self.kind);
                let points = rule.mass.iter().zip(&self.f).zip(&rule.remaining);
                let part: f64 = points.map(|((m, f), remaining)| m * f * (remaining + later).sqrt()).sum();
                self.h * self.h.sqrt() * part
            };
        }
    }

    /// The memory of a start panel at a time that lies less than its length behind it.
    fn memory_next_to_start(&self, tables: &Tables, later: f64) -> f64 {
        // sqrt(Z^2 - s^2) = sqrt(Z - s) sqrt(Z + s); the second factor is smooth
        let z = (1.0 + later).sqrt();
        let mut smooth = [0.0; MOST_NODES];
        for ((smooth, s), f) in smooth.iter_mut().zip(&tables.sigma).zip(&self.f) {
            *smooth = 2.0 * s * f * (z + s).sqrt();
        }
        let beyond = later / (z + 1.0);
        let root = RootSum::new(&tables.coefficients(&smooth[..tables.p]));
        let mut sum = [0.0];
        root.add((self.h * self.h * self.h * 0.125).sqrt(), 2.0, &[beyond], &mut sum);
        sum[0]
    }

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

/// `int_-1^1 sqrt(z - u) sum_k c_k P_k(u) du` as a function of `z >= 1`.
///
/// From the generating function of the Legendre polynomials, with `z = (r + 1/r)/2`, `r <= 1`:
/// `int P_k(u) / sqrt(z - u) du = 2 sqrt(2 r) r^k / (2 k + 1)`; integration by parts then gives
/// `int P_k sqrt(z - u) du = sqrt(2 r)/(2k+1) [r^(k+1)/(2k+3) - r^(k-1)/(2k-1)]` for `k > 0`.
#[derive(Debug, Clone, Default)]
pub(super) struct RootSum {
    mean: f64,
    /// Coefficients of the powers of `r`.
    powers: Vec<f64>,
    /// Logarithm of what is negligible, relative to the largest of them.
    negligible: f64,
    /// Coefficients of the powers of `r` in its derivative.
    slopes: Vec<f64>,
}

impl RootSum {
    pub fn new(coefficients: &[f64]) -> RootSum {
        let mut powers = vec![0.0; coefficients.len() + 1];
        for ((k, c), (raised, lowered)) in coefficients.iter().enumerate().zip(ROOT_FACTORS).skip(1) {
            powers[k + 1] += c * raised;
            powers[k - 1] -= c * lowered;
        }
        let mean = coefficients[0];
        let largest = powers.iter().fold(0.0_f64, |a, c| a.max(c.abs()));
        let slopes = coefficients.iter().enumerate().map(|(k, c)| c / (2 * k + 1) as f64).collect();
        RootSum { mean, powers, negligible: (1e-18 * mean.abs() / largest).max(1e-300).ln(), slopes }
    }

    /// Adds `factor` times the derivative of the function at each `z = 1 + scale * beyond` to its sum.
    pub fn add_slope(&self, factor: f64, scale: f64, beyond: &[f64], sums: &mut [f64]) {
        for (beyond, sums) in beyond.chunks(LANES).zip(sums.chunks_mut(LANES)) {
            let mut r = [0.0; LANES];
            for (r, beyond) in r.iter_mut().zip(beyond) {
                let y = scale * beyond;
                *r = 1.0 / (1.0 + y + (y * (y + 2.0)).sqrt());
            }
            let mut series = [0.0; LANES];
            for &c in self.slopes.iter().rev() {
                for (series, r) in series.iter_mut().zip(r) {
                    *series = *series * r + c;
                }
            }
            for ((sum, series), r) in sums.iter_mut().zip(series).zip(r) {
                *sum += factor * ((2.0 * r).sqrt() * series);
            }
        }
    }

    /// Adds `factor` times the function at each `z = 1 + scale * beyond` to its sum.
    pub fn add(&self, factor: f64, scale: f64, beyond: &[f64], sums: &mut [f64]) {
        for (beyond, sums) in beyond.chunks(LANES).zip(sums.chunks_mut(LANES)) {
            let mut y = [0.0; LANES];
            y.iter_mut().zip(beyond).for_each(|(y, beyond)| *y = scale * beyond);
            let y = y;
            let r = y.map(|y| 1.0 / (1.0 + y + (y * (y + 2.0)).sqrt()));
            // powers beyond which nothing is left of any lane
            let nearest = r[..beyond.len()].iter().fold(0.0_f64, |a, &b| a.max(b));
            let count =
                if nearest < 0.9 { (self.negligible / nearest.ln()).ceil() as usize } else { self.powers.len() };
            let mut series = [0.0; LANES];
            for &c in self.powers[..count.min(self.powers.len())].iter().rev() {
                for (series, r) in series.iter_mut().zip(r) {
                    *series = *series * r + c;
                }
            }
            for (i, sum) in sums.iter_mut().enumerate() {
                let (far, near) = ((y[i] + 2.0).sqrt(), y[i].sqrt());
                // (2/3) (far^3 - near^3), as far^2 - near^2 = 2
                let first = 4.0 / 3.0 * (far * far + far * near + near * near) / (far + near);
                *sum += factor * (self.mean * first + (2.0 * r[i]).sqrt() * series[i]);
            }
        }
    }
}

/// Times that are treated together, for the vector units.
const LANES: usize = 8;

const MOST_NODES: usize = *NODES.end();

/// `1 / ((2k+1)(2k+3))` and `1 / ((2k+1)(2k-1))`.
const ROOT_FACTORS: [(f64, f64); MOST_NODES] = {
    let mut factors = [(0.0, 0.0); MOST_NODES];
    let mut k = 1;
    while k < MOST_NODES {
        let n = (2 * k) as f64;
        factors[k] = (1.0 / ((n + 1.0) * (n + 3.0)), 1.0 / ((n + 1.0) * (n - 1.0)));
        k += 1;
    }
    factors
};

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
const END_CURVATURES: [f64; MOST_NODES] = {
    let mut values = [0.0; MOST_NODES];
    let mut k = 1;
    while k < MOST_NODES {
        values[k] = ((k - 1) * k * (k + 1) * (k + 2)) as f64 / 2.0;
        k += 1;
    }
    values
};

/// `x_+^(3/2)`.
pub(super) fn hertz(x: f64) -> f64 {
    if x > 0.0 { x * x.sqrt() } else { 0.0 }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Later effect of panels against closed forms.
    #[test]
    fn memory_of_a_panel_is_exact() {
        let tables = Tables::get(Structure::Beam, 20);
        for after in [0.0, 1e-9, 1e-3, 0.3, 1.0, 10.0, 1e4] {
            // Middle, f = s on (0, 2)
            let x: Vec<f64> = tables.sigma.iter().map(|s| (2.0 * s).powf(2.0 / 3.0)).collect();
            let mut panel = Panel::new(tables, Kind::Middle, 0.0, 2.0, x);
            panel.f = tables.sigma.iter().map(|s| 2.0 * s).collect();
            panel.root = RootSum::new(&tables.coefficients(&panel.f));
            let t: f64 = 2.0 + after;
            // int_0^2 sqrt(t-s) s ds by the substitution w = sqrt(t-s), polynomial quadrature
            let (low, high) = (after.sqrt(), t.sqrt());
            let want: f64 = crate::infinite::rule::gauss(8)
                .iter()
                .map(|&(y, w)| {
                    let v = low + (high - low) * y;
                    (high - low) * w * 2.0 * v * v * (t - v * v).max(0.0)
                })
                .sum();
            let got = panel.memory(Structure::Beam, tables, after);
            assert!((got / want - 1.0).abs() < 1e-11 * (1.0 + after), "{after}: {got} {want}");
            // Start, f = t^(3/2) (1 - t) on (0, 1): against many-node quadrature in sqrt(t)
            let f: Vec<f64> = tables.sigma.iter().map(|s| s.powi(3) * (1.0 - s * s)).collect();
            let x = f.iter().map(|f| f.powf(2.0 / 3.0)).collect();
            let panel = Panel::new(tables, Kind::Start, 0.0, 1.0, x);
            let z = (1.0 + after).sqrt();
            let range = (1.0 / z).asin();
            let want: f64 = crate::infinite::rule::gauss(60)
                .iter()
                .map(|&(y, w)| {
                    let (sin, cos) = (range * y).sin_cos();
                    let s = z * sin;
                    range * w * z * cos * 2.0 * s * s.powi(3) * (1.0 - s * s) * z * cos
                })
                .sum();
            let got = panel.memory(Structure::Beam, tables, after);
            assert!((got / want - 1.0).abs() < 2e-14, "{after}: {got} {want}");
        }
    }

    /// A contact with the force `(t (1 - t))^(3/2)`: its effect on the beam during and after it
    /// (hypergeometric closed forms, values in 50-digit arithmetic).
    #[test]
    fn manufactured_contact() {
        for p in [16, 20, 28] {
            let tables = Tables::get(Structure::Beam, p);
            let panel = |kind, start: f64| {
                let rule = tables.rule(kind);
                let x = (0..p).map(|j| (start + 0.5 * rule.elapsed[j]) * (0.5 - start + 0.5 * rule.remaining[j]));
                Panel::new(tables, kind, start, 0.5, x.collect())
            };
            let (first, second) = (panel(Kind::Start, 0.0), panel(Kind::End, 0.5));
            let own = |panel: &Panel| 0.5_f64.powf(1.5) * dot(&tables.rule(panel.kind).memory[p * p..], &panel.f);
            let after = |t: f64| {
                first.memory(Structure::Beam, tables, t - 0.5) + second.memory(Structure::Beam, tables, t - 1.0)
            };
            let found =
                [own(&first), first.memory(Structure::Beam, tables, 0.5) + own(&second), after(10.0), after(1e6)];
            let exact = [0.014120218079899651, 16.0 / 315.0, 0.22693312224317404, 73.63105941073864];
            for (found, exact) in found.iter().zip(exact) {
                assert!((found / exact - 1.0).abs() < 1e-12, "{p}: {found} {exact}");
            }
            assert!((first.moment(tables) / 0.00625 - 1.0).abs() < 1e-12);
        }
    }
}
