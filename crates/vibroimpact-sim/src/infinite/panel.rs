//! One panel of a contact: its collocation solution, and what it does to later times.

use super::Structure;
use super::rule::{Kind, Tables, dot, series, series_slope};

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
    /// `x_+^(3/2)` at the nodes.
    pub f: Vec<f64>,
    /// Legendre coefficients of `f` in the panel variable.
    pub f_series: Vec<f64>,
    /// Its integral against the square root (middle panels).
    root: RootSum,
}

impl Panel {
    /// From the compression at the nodes.
    pub fn new(tables: &Tables, kind: Kind, start: f64, h: f64, x: Vec<f64>) -> Panel {
        let f: Vec<f64> = x.iter().map(|&x| hertz(x)).collect();
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
        if structure == Structure::Plate {
            return self.impulse(tables);
        }
        let p = tables.p;
        let later = after / self.h;
        match self.kind {
            Kind::Middle => (0.5 * self.h).powf(1.5) * self.root.at(2.0 * later),
            Kind::Start if later < 1.0 => {
                // sqrt(Z^2 - s^2) = sqrt(Z - s) sqrt(Z + s); the second factor is smooth
                let z = (1.0 + later).sqrt();
                let smooth: Vec<f64> =
                    (0..p).map(|j| 2.0 * tables.sigma[j] * self.f[j] * (z + tables.sigma[j]).sqrt()).collect();
                let beyond = later / (z + 1.0);
                (self.h * self.h * self.h * 0.125).sqrt() * RootSum::new(&tables.coefficients(&smooth)).at(2.0 * beyond)
            }
            _ => {
                let rule = tables.rule(self.kind);
                let sum: f64 = (0..p).map(|j| rule.mass[j] * self.f[j] * (rule.remaining[j] + later).sqrt()).sum();
                self.h.powf(1.5) * sum
            }
        }
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
struct RootSum {
    mean: f64,
    /// Coefficients of the powers of `r`.
    powers: Vec<f64>,
}

impl RootSum {
    fn new(coefficients: &[f64]) -> RootSum {
        let mut powers = vec![0.0; coefficients.len() + 1];
        for (k, c) in coefficients.iter().enumerate().skip(1) {
            let n = (2 * k) as f64;
            powers[k + 1] += c / ((n + 1.0) * (n + 3.0));
            powers[k - 1] -= c / ((n + 1.0) * (n - 1.0));
        }
        RootSum { mean: coefficients[0], powers }
    }

    /// At `z = 1 + beyond`.
    fn at(&self, beyond: f64) -> f64 {
        let r = 1.0 / (1.0 + beyond + (beyond * (beyond + 2.0)).sqrt());
        let (far, near) = ((beyond + 2.0).sqrt(), beyond.sqrt());
        // (2/3) (far^3 - near^3), as far^2 - near^2 = 2
        let first = 4.0 / 3.0 * (far * far + far * near + near * near) / (far + near);
        self.mean * first + (2.0 * r).sqrt() * self.powers.iter().rev().fold(0.0, |sum, c| sum * r + c)
    }
}

/// Solves `x_i + sum_j m_ij f(x_j) = rhs_i`, `f = x_+^(3/2)`, at the nodes of a panel by Newton's
/// method from the guess in `x`. Returns whether it settled.
pub(super) fn collocate(matrix: &[f64], rhs: &[f64], x: &mut [f64]) -> bool {
    let p = x.len();
    let mut lu = vec![0.0; p * p];
    let mut step = vec![0.0; p];
    let mut last = f64::INFINITY;
    let mut fresh = false;
    for _ in 0..60 {
        let f: Vec<f64> = x.iter().map(|&x| hertz(x)).collect();
        let mut scale = 0.0_f64;
        for i in 0..p {
            step[i] = rhs[i] - x[i] - dot(&matrix[i * p..(i + 1) * p], &f);
            scale = scale.max(x[i].abs()).max(rhs[i].abs());
        }
        if !fresh {
            for i in 0..p {
                for j in 0..p {
                    lu[i * p + j] = matrix[i * p + j] * 1.5 * x[j].max(0.0).sqrt();
                }
                lu[i * p + i] += 1.0;
            }
            if !factor(&mut lu, p) {
                return false;
            }
        }
        substitute(&lu, p, &mut step);
        let size = step.iter().fold(0.0_f64, |size, s| size.max(s.abs()));
        if !size.is_finite() {
            return false;
        }
        for i in 0..p {
            x[i] += step[i];
        }
        if size <= 2e-16 * scale || (size < 1e-13 * scale && size > 0.3 * last) {
            return true;
        }
        // once close, the factors serve on
        fresh = size < 1e-3 * scale && size < 0.1 * last;
        last = size;
    }
    false
}

/// `x_ss` at `s = 0` of a Legendre series on `(0, 1)`.
pub(super) fn curvature(x_series: &[f64]) -> f64 {
    // P_k''(-1) = (-1)^k (k-1) k (k+1) (k+2) / 8, times 4 for the interval (0, 1)
    x_series
        .iter()
        .enumerate()
        .skip(2)
        .map(|(k, c)| {
            let n = k as f64;
            let value = (n - 1.0) * n * (n + 1.0) * (n + 2.0) / 2.0;
            if k % 2 == 0 { c * value } else { -c * value }
        })
        .sum()
}

/// `x_+^(3/2)`.
pub(super) fn hertz(x: f64) -> f64 {
    if x > 0.0 { x * x.sqrt() } else { 0.0 }
}

/// LU factors in place without exchange of rows: the matrices are the identity plus a Volterra
/// operator with positive kernel, whose pivots stay away from zero.
fn factor(a: &mut [f64], p: usize) -> bool {
    for k in 0..p {
        let pivot = a[k * p + k];
        if pivot.abs() < 1e-8 || pivot.is_nan() {
            return false;
        }
        let (head, tail) = a.split_at_mut((k + 1) * p);
        let row = &head[k * p + k + 1..(k + 1) * p];
        for below in tail.chunks_exact_mut(p) {
            let l = below[k] / pivot;
            below[k] = l;
            for (b, r) in below[k + 1..].iter_mut().zip(row) {
                *b -= l * r;
            }
        }
    }
    true
}

fn substitute(lu: &[f64], p: usize, b: &mut [f64]) {
    for i in 0..p {
        b[i] -= dot(&lu[i * p..i * p + i], &b[..i]);
    }
    for i in (0..p).rev() {
        let sum = dot(&lu[i * p + i + 1..(i + 1) * p], &b[i + 1..]);
        b[i] = (b[i] - sum) / lu[i * p + i];
    }
}

/// Stationary points of a panel's compression, in time order: `(elapsed fraction, compression,
/// is a minimum)`. `falling` is whether the compression fell at the end of the panel before.
pub(super) fn turns(tables: &Tables, kind: Kind, x_series: &[f64], falling: bool) -> (Vec<(f64, f64, bool)>, bool) {
    let p = tables.p;
    let count = tables.sample.len();
    let mut found = Vec::new();
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
            let (mut a, mut b) = (left, here);
            for _ in 0..60 {
                let mid = 0.5 * (a + b);
                let slope = series_slope(x_series, mid) * if kind == Kind::End { -1.0 } else { 1.0 };
                if (slope < 0.0) == falling {
                    a = mid;
                } else {
                    b = mid;
                }
            }
            let s = 0.5 * (a + b);
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
