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

use super::problem::NODES;
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

/// Times of the nodes of one kind of panel.
#[derive(Debug)]
pub(super) struct Rule {
    /// Elapsed fraction of the panel at the nodes and at the end (`p + 1` values).
    pub elapsed: Vec<f64>,
    /// `1 - elapsed`, without cancellation.
    pub remaining: Vec<f64>,
    /// `int f dt = h sum_j mass[j] f_j`.
    pub mass: Vec<f64>,
}

/// Everything that depends on the number of nodes alone.
#[derive(Debug)]
pub(super) struct Tables {
    /// Nodes per panel.
    pub p: usize,
    /// Gauss-Legendre nodes on `(0, 1)`, ascending.
    pub sigma: Vec<f64>,
    /// `to_legendre[k p + j]`: nodal values to Legendre coefficients on `(0, 1)`.
    pub to_legendre: Vec<f64>,
    /// Points at which the slope of a panel's interpolant is sampled (ascending, ends included).
    pub sample: Vec<f64>,
    /// `slope[i p + k]`: derivative of the `k`-th Legendre polynomial at sample `i`.
    pub slope: Vec<f64>,
    /// The Gauss-Legendre rules on `(0, 1)` of up to `p` nodes, by their number: `(node, weight)`.
    pub gauss: Vec<Vec<(f64, f64)>>,
    start: Rule,
    middle: Rule,
    end: Rule,
}

impl Tables {
    /// The tables for `p` nodes (a number within [`NODES`]), computed at first use.
    pub fn get(p: usize) -> &'static Tables {
        static TABLES: [OnceLock<Tables>; *NODES.end() + 1] = [const { OnceLock::new() }; *NODES.end() + 1];
        let p = p.clamp(*NODES.start(), *NODES.end());
        TABLES[p].get_or_init(|| Tables::new(p))
    }

    /// The rule of one kind of panel.
    pub fn rule(&self, kind: Kind) -> &Rule {
        match kind {
            Kind::Start => &self.start,
            Kind::Middle => &self.middle,
            Kind::End => &self.end,
        }
    }

    fn new(p: usize) -> Tables {
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
        let build = |kind| Rule::new(kind, &sigma, &weight);
        let (start, middle, end) = (build(Kind::Start), build(Kind::Middle), build(Kind::End));
        let by_number = (0..=p).map(gauss).collect();
        Tables { p, to_legendre, sample, slope, gauss: by_number, start, middle, end, sigma }
    }

    /// Legendre coefficients on `(0, 1)` of the interpolant of nodal values.
    pub fn coefficients(&self, values: &[f64]) -> Vec<f64> {
        self.to_legendre.chunks_exact(self.p).map(|row| dot(row, values)).collect()
    }
}

impl Rule {
    fn new(kind: Kind, sigma: &[f64], weight: &[f64]) -> Rule {
        let targets: Vec<f64> = sigma.iter().copied().chain([if kind == Kind::End { 0.0 } else { 1.0 }]).collect();
        let squares = targets.iter().map(|s| s * s);
        let (elapsed, remaining): (Vec<f64>, Vec<f64>) = match kind {
            Kind::Start => squares.map(|q| (q, 1.0 - q)).unzip(),
            Kind::Middle => targets.iter().map(|&s| (s, 1.0 - s)).unzip(),
            Kind::End => squares.map(|q| (1.0 - q, q)).unzip(),
        };
        let rate = |s: f64| if kind == Kind::Middle { 1.0 } else { 2.0 * s };
        let mass = sigma.iter().zip(weight).map(|(&s, w)| w * rate(s)).collect();
        Rule { elapsed, remaining, mass }
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
