//! Collocation rules on one panel of a contact, tabulated once per number of nodes.
//!
//! A panel covers the time `[start, start + h]`. Its nodes are the Gauss-Legendre points of a
//! panel variable `sigma` in `(0, 1)`, mapped so that the compression is smooth in `sigma`:
//!
//! | panel | elapsed fraction | why |
//! |---|---|---|
//! | `Start` | `sigma^2` | after touch, `x` is a series in `sqrt(t)` and `f ~ t^(3/2)` |
//! | `Middle` | `sigma` | `x` is analytic |
//! | `End` | `1 - sigma^2` | before separation `f ~ e^(3/2)`, `x` has a term `e^3 log e` |
//!
//! The product weights integrate the polynomial interpolant of the force exactly against the
//! kernels `t - s` and `sqrt(t - s)` (or 1 for the plate).

use super::problem::{NODES, Structure};
use gauss_quad::GaussLegendre;
use std::num::NonZeroUsize;
use std::sync::OnceLock;

/// Where in a contact a panel lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Start,
    Middle,
    End,
}

/// Product-integration rule of one kind of panel. Rows `0..p` belong to the nodes, row `p` to
/// the end of the panel.
#[derive(Debug)]
pub(super) struct Rule {
    /// Elapsed fraction of the panel at the nodes and at the end (`p + 1` values).
    pub elapsed: Vec<f64>,
    /// `1 - elapsed`, without cancellation.
    pub remaining: Vec<f64>,
    /// `int f dt = h sum_j mass[j] f_j`.
    pub mass: Vec<f64>,
    /// `int (t_i - s) f ds = h^2 sum_j linear[i p + j] f_j`.
    pub linear: Vec<f64>,
    /// Same for the structure's kernel; times `h^(3/2)` (beam) or `h` (plate).
    pub memory: Vec<f64>,
}

/// Everything that depends on the number of nodes alone.
#[derive(Debug)]
pub(super) struct Tables {
    /// Nodes per panel.
    pub p: usize,
    /// Gauss-Legendre nodes on `(0, 1)`, ascending.
    pub sigma: Vec<f64>,
    /// Their weights, with sum 1.
    pub weight: Vec<f64>,
    /// `to_legendre[k p + j]`: nodal values to Legendre coefficients on `(0, 1)`.
    pub to_legendre: Vec<f64>,
    /// Points at which the slope of a panel's interpolant is sampled (ascending, ends included).
    pub sample: Vec<f64>,
    /// `slope[i p + k]`: derivative of the `k`-th Legendre polynomial at sample `i`.
    pub slope: Vec<f64>,
    /// Twice as many nodes for sampling the end panel as a measure: `(sigma, weight)`.
    pub fine: Vec<(f64, f64)>,
    start: Rule,
    middle: Rule,
    end: Rule,
}

impl Tables {
    /// The tables for `p` nodes (a number within [`NODES`]), computed at first use.
    pub fn get(structure: Structure, p: usize) -> &'static Tables {
        static BEAM: [OnceLock<Tables>; 33] = [const { OnceLock::new() }; 33];
        static PLATE: [OnceLock<Tables>; 33] = [const { OnceLock::new() }; 33];
        let p = p.clamp(*NODES.start(), *NODES.end());
        let cells = match structure {
            Structure::Beam => &BEAM,
            Structure::Plate => &PLATE,
        };
        cells[p].get_or_init(|| Tables::new(structure, p))
    }

    /// The rule of one kind of panel.
    pub fn rule(&self, kind: Kind) -> &Rule {
        match kind {
            Kind::Start => &self.start,
            Kind::Middle => &self.middle,
            Kind::End => &self.end,
        }
    }

    fn new(structure: Structure, p: usize) -> Tables {
        let (sigma, weight): (Vec<f64>, Vec<f64>) = gauss(p).into_iter().unzip();
        let mut to_legendre = vec![0.0; p * p];
        for j in 0..p {
            let values = legendre(2.0 * sigma[j] - 1.0, p);
            for k in 0..p {
                to_legendre[k * p + j] = (2 * k + 1) as f64 * weight[j] * values[k];
            }
        }
        let count = 2 * p + 1;
        let sample: Vec<f64> =
            (0..count).map(|i| (std::f64::consts::FRAC_PI_2 * i as f64 / (count - 1) as f64).sin().powi(2)).collect();
        let slope = sample.iter().flat_map(|&s| legendre_slopes(s, p)).collect();
        let build = |kind| Rule::new(structure, kind, &sigma, &weight, &to_legendre);
        let (start, middle, end) = (build(Kind::Start), build(Kind::Middle), build(Kind::End));
        Tables { p, to_legendre, sample, slope, fine: gauss(2 * p), start, middle, end, sigma, weight }
    }

    /// Legendre coefficients on `(0, 1)` of the interpolant of nodal values.
    pub fn coefficients(&self, values: &[f64]) -> Vec<f64> {
        self.to_legendre.chunks_exact(self.p).map(|row| dot(row, values)).collect()
    }
}

impl Rule {
    fn new(structure: Structure, kind: Kind, sigma: &[f64], weight: &[f64], to_legendre: &[f64]) -> Rule {
        let p = sigma.len();
        let targets: Vec<f64> = sigma.iter().copied().chain([if kind == Kind::End { 0.0 } else { 1.0 }]).collect();
        let squares = targets.iter().map(|s| s * s);
        let (elapsed, remaining): (Vec<f64>, Vec<f64>) = match kind {
            Kind::Start => squares.map(|q| (q, 1.0 - q)).unzip(),
            Kind::Middle => targets.iter().map(|&s| (s, 1.0 - s)).unzip(),
            Kind::End => squares.map(|q| (1.0 - q, q)).unzip(),
        };
        let mass = (0..p).map(|j| weight[j] * if kind == Kind::Middle { 1.0 } else { 2.0 * sigma[j] }).collect();
        let (mut linear, mut memory) = (Vec::new(), Vec::new());
        for &target in &targets {
            // row of integrals of Legendre polynomials, turned into weights of nodal values
            let (mut lin, mut mem) = (vec![0.0; p], vec![0.0; p]);
            for (s, dt, lag) in elapsed_points(kind, target) {
                let kernel = match structure {
                    Structure::Beam => lag.sqrt(),
                    Structure::Plate => 1.0,
                };
                for (k, value) in legendre(2.0 * s - 1.0, p).into_iter().enumerate() {
                    lin[k] += dt * lag * value;
                    mem[k] += dt * kernel * value;
                }
            }
            let nodal = |row: &[f64], j: usize| (0..p).map(|k| row[k] * to_legendre[k * p + j]).sum::<f64>();
            linear.extend((0..p).map(|j| nodal(&lin, j)));
            memory.extend((0..p).map(|j| nodal(&mem, j)));
        }
        Rule { elapsed, remaining, mass, linear, memory }
    }
}

/// Quadrature of the part of a panel before `target`: `(sigma, dt, lag)` with `lag` the fraction
/// of the panel between that point and the target. Each substitution makes `sqrt(lag)` smooth.
fn elapsed_points(kind: Kind, target: f64) -> Vec<(f64, f64, f64)> {
    let rule = gauss(64);
    match kind {
        Kind::Start => rule
            .iter()
            .map(|&(y, w)| {
                let (sin, cos) = (std::f64::consts::FRAC_PI_2 * y).sin_cos();
                let s = target * sin;
                (s, w * std::f64::consts::FRAC_PI_2 * 2.0 * s * target * cos, (target * cos).powi(2))
            })
            .collect(),
        Kind::Middle => {
            rule.iter().map(|&(y, w)| (target * (1.0 - y * y), w * 2.0 * target * y, target * y * y)).collect()
        }
        Kind::End if target == 0.0 => rule.iter().map(|&(y, w)| (y, w * 2.0 * y, y * y)).collect(),
        Kind::End => {
            // s = target cosh(y): the interval of y is cut into pieces of length below 1
            let range = (1.0 / target).acosh();
            let pieces = range.ceil().max(1.0);
            (0..pieces as usize)
                .flat_map(|i| rule.iter().map(move |&(y, w)| (range / pieces * (i as f64 + y), w * range / pieces)))
                .map(|(y, w)| {
                    let (s, rise) = (target * y.cosh(), target * y.sinh());
                    (s, w * 2.0 * s * rise, rise * rise)
                })
                .collect()
        }
    }
}

/// Gauss-Legendre rule on `(0, 1)`, ascending.
pub(super) fn gauss(n: usize) -> Vec<(f64, f64)> {
    let rule = GaussLegendre::new(NonZeroUsize::new(n).unwrap_or(NonZeroUsize::MIN));
    let mut pairs: Vec<(f64, f64)> =
        rule.as_node_weight_pairs().iter().map(|&(x, w)| (0.5 * (1.0 + x), 0.5 * w)).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    pairs
}

/// Legendre polynomials `P_0 .. P_(p-1)` at `u`.
pub(super) fn legendre(u: f64, p: usize) -> Vec<f64> {
    let mut values = vec![1.0; p];
    if p > 1 {
        values[1] = u;
    }
    for k in 2..p {
        let n = k as f64;
        values[k] = ((2.0 * n - 1.0) * u * values[k - 1] - (n - 1.0) * values[k - 2]) / n;
    }
    values
}

/// Derivatives with respect to `s` of the Legendre polynomials in `2 s - 1`.
fn legendre_slopes(s: f64, p: usize) -> Vec<f64> {
    let values = legendre(2.0 * s - 1.0, p);
    let mut slopes = vec![0.0; p];
    for k in 1..p {
        let before = if k >= 2 { slopes[k - 2] } else { 0.0 };
        slopes[k] = before + 2.0 * (2 * k - 1) as f64 * values[k - 1];
    }
    slopes
}

/// Value of a Legendre series on `(0, 1)` (Clenshaw).
pub(super) fn series(coefficients: &[f64], s: f64) -> f64 {
    let u = 2.0 * s - 1.0;
    let (mut b1, mut b2) = (0.0, 0.0);
    for (c, (a, b)) in coefficients.iter().zip(&RECURRENCE).rev() {
        let b0 = c + a * u * b1 - b * b2;
        (b2, b1) = (b1, b0);
    }
    b1
}

/// `(2k+1)/(k+1)` and `(k+1)/(k+2)`.
const RECURRENCE: [(f64, f64); *NODES.end()] = {
    let mut factors = [(0.0, 0.0); *NODES.end()];
    let mut k = 0;
    while k < factors.len() {
        let n = k as f64;
        factors[k] = ((2.0 * n + 1.0) / (n + 1.0), (n + 1.0) / (n + 2.0));
        k += 1;
    }
    factors
};

/// Slope of a Legendre series on `(0, 1)`.
pub(super) fn series_slope(coefficients: &[f64], s: f64) -> f64 {
    // P'_k = P'_(k-2) + (2k - 1) P_(k-1), in u = 2 s - 1
    let u = 2.0 * s - 1.0;
    let (mut p0, mut p1) = (1.0, u);
    let (mut d0, mut d1) = (0.0, 1.0);
    let mut sum = 0.0;
    for (k, (c, (rise, _))) in coefficients.iter().zip(&RECURRENCE).enumerate().skip(1) {
        sum += c * d1;
        (d0, d1) = (d1, d0 + (2 * k + 1) as f64 * p1);
        // P_(k+1) = a u P_k - (a - 1) P_(k-1), a = (2k+1)/(k+1)
        (p0, p1) = (p1, rise * (u * p1 - p0) + p0);
    }
    2.0 * sum
}

/// Scalar product, in four interleaved parts that the compiler can vectorise.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let (a4, b4) = (a[..n].chunks_exact(4), b[..n].chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(x, y)| x * y).sum();
    let mut parts = [0.0; 4];
    for (x, y) in a4.zip(b4) {
        for i in 0..4 {
            parts[i] += x[i] * y[i];
        }
    }
    (parts[0] + parts[2]) + (parts[1] + parts[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The weights reproduce closed forms for powers of the panel variable.
    #[test]
    fn product_weights_match_closed_forms() {
        for p in [8, 16, 20, 32] {
            let tables = Tables::get(Structure::Beam, p);
            for i in 0..=p {
                // Middle, f = s: int_0^t sqrt(t-s) s ds = (4/15) t^(5/2)
                let rule = tables.rule(Kind::Middle);
                let got = dot(&rule.memory[i * p..(i + 1) * p], &tables.sigma);
                assert!((got - 4.0 / 15.0 * rule.elapsed[i].powf(2.5)).abs() < 2e-15);
                // Start, f = t^(3/2): B(5/2, 3/2) t^3 = (pi/16) t^3
                let cubes: Vec<f64> = tables.sigma.iter().map(|s| s.powi(3)).collect();
                let rule = tables.rule(Kind::Start);
                let got = dot(&rule.memory[i * p..(i + 1) * p], &cubes);
                assert!((got - std::f64::consts::PI / 16.0 * rule.elapsed[i].powi(3)).abs() < 2e-15);
                // End, f = 1 and f = e: int_0^L sqrt(L-e') de' with L the elapsed part
                let rule = tables.rule(Kind::End);
                let length = rule.elapsed[i];
                let got: f64 = rule.memory[i * p..(i + 1) * p].iter().sum();
                assert!((got - 2.0 / 3.0 * length.powf(1.5)).abs() < 4e-15, "{got}");
                let squares: Vec<f64> = tables.sigma.iter().map(|s| s.powi(2)).collect();
                let got = dot(&rule.linear[i * p..(i + 1) * p], &squares);
                let want = length.powi(2) / 2.0 * rule.remaining[i] + length.powi(3) / 3.0;
                assert!((got - want).abs() < 4e-15);
            }
        }
    }
}
