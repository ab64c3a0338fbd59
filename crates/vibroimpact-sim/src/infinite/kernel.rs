//! The kernels of the Volterra equation for a sum of powers of time, and their product integration on a panel.
//!
//! A kernel `lag^q` with `q > -1` is singular where `lag = 0`. In a variable `y` in which `sqrt(lag)` is smooth and
//! vanishes at `y = 0`, the integrand is `y^(2 q + 1)` times a smooth function, and the Gauss-Jacobi rule of that
//! weight integrates it to rounding.

use super::history::Impulse;
use super::problem::NODES;
use super::receptance::{Receptance, Scale};
use super::rule::{Kind, Tables, gauss, legendre};
use gauss_quad::{FiniteAboveNegOneF64, GaussJacobi};
use std::f64::consts::FRAC_PI_2;
use std::num::NonZeroUsize;
use std::sync::{Arc, OnceLock};

/// Nodes of the rules for the weights.
const POINTS: NonZeroUsize = NonZeroUsize::new(64).unwrap();

/// A matrix, row by row.
type Rows = Arc<[f64]>;

/// Weights of nodal forces on one kind of panel: rows `0..p` belong to the nodes, row `p` to the end. Each is for a
/// panel of length 1.
#[derive(Debug, Default)]
struct Weights {
    /// `int (t_i - s) f ds`.
    linear: Rows,
    /// `int f ds`.
    impulse: Rows,
    /// `int (t_i - s)^p f ds` and, for `p > 0`, `int (t_i - s)^(p-1) f ds`, of each term.
    memory: Vec<(Rows, Rows)>,
}

/// `kappa(t) = sum_k c_k t^(p_k)` in the units of the impact, so that `kappa(1) = 1`.
#[derive(Debug)]
pub(super) struct Kernel {
    /// Coefficients and powers.
    pub terms: Vec<(f64, f64)>,
    pub tables: &'static Tables,
    weights: [Weights; 3],
}

impl Kernel {
    /// With tables of `nodes` nodes a panel.
    pub fn new(receptance: &Receptance, scale: &Scale, nodes: usize) -> Kernel {
        // m c T^(p - 1)
        let mass_kg = scale.force_n * scale.time_s / scale.speed_m_s;
        let nondimensional = |c: f64, power: f64| (mass_kg * c * scale.time_s.powf(power) / scale.time_s, power);
        let terms = receptance.terms().iter().map(|term| nondimensional(term.coefficient, term.power)).collect();
        let tables = Tables::get(nodes);
        let mut kernel = Kernel { terms, tables, weights: Default::default() };
        kernel.weights = [Kind::Start, Kind::Middle, Kind::End].map(|kind| kernel.weights_of(kind));
        kernel
    }

    /// Whether the point moves on after an impulse: whether some power is above 0.
    pub fn has_after_effect(&self) -> bool {
        self.terms.iter().any(|term| term.1 > 0.0)
    }

    /// The coefficient of the square root, if that is the whole after-effect, as on a beam.
    pub fn root(&self) -> Option<f64> {
        let mut bending = self.terms.iter().filter(|term| term.1 > 0.0);
        match (bending.next(), bending.next()) {
            (Some(&(c, 0.5)), None) => Some(c),
            _ => None,
        }
    }

    /// Adds the after-effect of an impulse on compression and rate, at times after its `age`, to their sums; `slope` is empty if
    /// the rate is not asked for. The displacement that it causes at once is not part of it.
    pub fn add_after_effect(&self, impulse: Impulse, after: &[f64], memory: &mut [f64], slope: &mut [f64]) {
        for &(c, power) in self.terms.iter().filter(|term| term.1 > 0.0) {
            let sums = (&mut *memory, &mut *slope);
            match power {
                // without a branch in the loop, for the vector units
                0.5 => add_power(impulse, (c, power), f64::sqrt, after, sums),
                _ => add_power(impulse, (c, power), |t| t.powf(power), after, sums),
            }
        }
    }

    /// `kappa(t)`.
    pub fn value(&self, t: f64) -> f64 {
        self.terms.iter().map(|&(c, power)| c * raise(t, power)).sum()
    }

    /// `kappa'(t)` for `t > 0`.
    pub fn slope(&self, t: f64) -> f64 {
        self.terms.iter().map(|&(c, power)| c * power * raise(t, power) / t).sum()
    }

    /// The instantaneous part of the response: the velocity of the point under a unit force.
    pub fn instant(&self) -> f64 {
        self.terms.iter().filter(|term| term.1 == 0.0).map(|term| term.0).sum()
    }

    /// Weights of the nodal forces on a panel of length `h` in the compression, a row for each node and one for the end.
    pub(super) fn weigh_compression(&self, kind: Kind, h: f64, weights: &mut Vec<f64>) {
        let of = &self.weights[kind as usize];
        weights.clear();
        weights.extend(of.linear.iter().map(|w| h * h * w));
        for (&(c, power), (memory, _)) in self.terms.iter().zip(&of.memory) {
            add_row(weights, c * h * raise(h, power), memory);
        }
    }

    /// The same for the rate of compression.
    pub(super) fn weigh_rate(&self, kind: Kind, h: f64, weights: &mut Vec<f64>) {
        let of = &self.weights[kind as usize];
        weights.clear();
        weights.extend(of.impulse.iter().map(|w| h * w));
        for (&(c, power), (_, slope)) in self.terms.iter().zip(&of.memory) {
            add_row(weights, c * power * raise(h, power), slope);
        }
        let p = self.tables.p;
        let instant = self.instant();
        (0..p).for_each(|i| weights[i * p + i] += instant);
        // at the end of the panel the force is that of its polynomial
        let end = if kind == Kind::End { -1.0 } else { 1.0 };
        for (k, value) in legendre(end, p).into_iter().enumerate() {
            add_row(&mut weights[p * p..], instant * value, &self.tables.to_legendre[k * p..(k + 1) * p]);
        }
    }

    /// Weights of `int f ds` and `int (end - s) f ds` over a whole panel of length 1.
    pub(super) fn totals(&self, kind: Kind) -> (&[f64], &[f64]) {
        let (p, weights) = (self.tables.p, &self.weights[kind as usize]);
        (&weights.impulse[p * p..], &weights.linear[p * p..])
    }

    fn weights_of(&self, kind: Kind) -> Weights {
        let of = |power: f64| cached_weights(self.tables, kind, power);
        let memory = |&(_, power): &(f64, f64)| {
            let slope = if power > 0.0 { of(power - 1.0) } else { Arc::default() };
            (of(power), slope)
        };
        Weights { linear: of(1.0), impulse: of(0.0), memory: self.terms.iter().map(memory).collect() }
    }
}

/// Adds `weight c t^power` and its rate at times after the impulse to their sums; `raise` computes the power.
fn add_power(
    Impulse { age, weight }: Impulse,
    (c, power): (f64, f64),
    raise: impl Fn(f64) -> f64,
    after: &[f64],
    (memory, slope): (&mut [f64], &mut [f64]),
) {
    if slope.is_empty() {
        let effects = after.iter().map(|tau| weight * (c * raise(age + tau)));
        memory.iter_mut().zip(effects).for_each(|(memory, effect)| *memory += effect);
        return;
    }
    for ((memory, slope), tau) in memory.iter_mut().zip(slope).zip(after) {
        let t = age + tau;
        let value = weight * (c * raise(t));
        *memory += value;
        *slope += power * value / t;
    }
}

/// `t^power`.
fn raise(t: f64, power: f64) -> f64 {
    match power {
        0.0 => 1.0,
        0.5 => t.sqrt(),
        _ => t.powf(power),
    }
}

fn add_row(sums: &mut [f64], factor: f64, row: &[f64]) {
    sums.iter_mut().zip(row).for_each(|(sum, w)| *sum += factor * w);
}

/// Powers whose weights are computed once in a program: those of the body, of a beam and of a plate.
const CACHED: [f64; 4] = [1.0, 0.0, 0.5, -0.5];

/// [`product_weights`], kept for the powers in [`CACHED`]. There is no bound on the number of other powers.
fn cached_weights(tables: &Tables, kind: Kind, power: f64) -> Rows {
    type Cells = [[OnceLock<[Rows; CACHED.len()]>; 3]; *NODES.end() + 1];
    static CELLS: Cells = [const { [const { OnceLock::new() }; 3] }; *NODES.end() + 1];
    match CACHED.iter().position(|&cached| cached == power) {
        Some(which) => {
            CELLS[tables.p][kind as usize].get_or_init(|| product_weights(tables, kind, CACHED))[which].clone()
        }
        None => {
            let [weights] = product_weights(tables, kind, [power]);
            weights
        }
    }
}

/// Weights of `int_0^(t_i) (t_i - s)^power f ds` for nodal values of `f` on a panel of length 1, for powers whose rules of
/// [`jacobi`] have the same nodes: one power, or several for each of which `2 power + 1` is a natural number.
fn product_weights<const N: usize>(tables: &Tables, kind: Kind, powers: [f64; N]) -> [Rows; N] {
    let p = tables.p;
    let near = powers.map(|power| jacobi(2.0 * power + 1.0));
    let plain = gauss(POINTS.get());
    let end = if kind == Kind::End { 0.0 } else { 1.0 };
    let mut weights: [Vec<f64>; N] = std::array::from_fn(|_| Vec::with_capacity((p + 1) * p));
    for target in tables.sigma.iter().copied().chain([end]) {
        let mut rows: [Vec<f64>; N] = std::array::from_fn(|_| vec![0.0; p]);
        // the weight of a place, for each power
        let mut add = |s: f64, weight: &dyn Fn(usize) -> f64| {
            let values = legendre(2.0 * s - 1.0, p);
            for (which, row) in rows.iter_mut().enumerate() {
                add_row(row, weight(which), &values);
            }
        };
        let nodes = near[0].iter().map(|&(y, _)| y).enumerate();
        match kind {
            // s = target (1 - y^2)
            Kind::Middle => nodes.for_each(|(i, y)| {
                add(target * (1.0 - y * y), &|n| near[n][i].1 * 2.0 * target.powf(powers[n] + 1.0));
            }),
            // s = target cos(a), lag = target^2 sin(a)^2, a = y pi/2
            Kind::Start => nodes.for_each(|(i, y)| {
                let (sin, cos) = (FRAC_PI_2 * y).sin_cos();
                let of = |n: usize| {
                    let smooth = (sin / y).powf(2.0 * powers[n] + 1.0) * 2.0 * cos * FRAC_PI_2;
                    near[n][i].1 * smooth * target.powf(2.0 * powers[n] + 2.0)
                };
                add(target * cos, &of);
            }),
            // the panel's end: lag = s^2
            Kind::End if target == 0.0 => nodes.for_each(|(i, y)| add(y, &|n| 2.0 * near[n][i].1)),
            // s = target cosh(a), lag = target^2 sinh(a)^2: the interval of a in pieces of length below 1
            Kind::End => {
                let range = (1.0 / target).acosh();
                let pieces = range.ceil().max(1.0);
                let piece = range / pieces;
                for (i, y) in nodes {
                    let (s, rise) = (target * (piece * y).cosh(), target * (piece * y).sinh());
                    add(s, &|n| near[n][i].1 * piece * (rise / y).powf(2.0 * powers[n] + 1.0) * 2.0 * s);
                }
                for (i, &(y, w)) in (1..pieces as usize).flat_map(|i| plain.iter().map(move |pair| (i, pair))) {
                    let a = piece * (i as f64 + y);
                    let (s, rise) = (target * a.cosh(), target * a.sinh());
                    add(s, &|n| w * piece * rise.powf(2.0 * powers[n] + 1.0) * 2.0 * s);
                }
            }
        }
        for (weights, row) in weights.iter_mut().zip(&rows) {
            weights.extend((0..p).map(|j| (0..p).map(|k| row[k] * tables.to_legendre[k * p + j]).sum::<f64>()));
        }
    }
    weights.map(Rows::from)
}

/// Rule on `(0, 1)` for the weight `y^beta`, `beta > -1`.
fn jacobi(beta: f64) -> Vec<(f64, f64)> {
    if beta >= 0.0 && beta.fract() == 0.0 {
        // a polynomial needs no rule of its own
        return gauss(POINTS.get()).into_iter().map(|(y, w)| (y, w * y.powf(beta))).collect();
    }
    let (Some(alpha), Some(exponent)) = (FiniteAboveNegOneF64::new(0.0), FiniteAboveNegOneF64::new(beta)) else {
        return Vec::new();
    };
    let rule = GaussJacobi::new(POINTS, alpha, exponent);
    let scale = 0.5_f64.powf(beta + 1.0);
    rule.as_node_weight_pairs().iter().map(|&(x, w)| (0.5 * (1.0 + x), scale * w)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::infinite::rule::dot;

    /// Weights against closed forms: the elapsed time and its square on start and middle panels, the remaining time on end
    /// panels.
    #[test]
    fn product_weights_match_closed_forms() {
        for nodes in [8, 20, 32] {
            let tables = Tables::get(nodes);
            for power in [-0.9_f64, -0.5, -0.25, 0.0, 0.1, 0.5, 0.8, 1.0] {
                // of weights whose sum is 1 / (power + 1) at most
                let rounding = 4e-14 / (power + 1.0);
                for (kind, exponent) in [(Kind::Middle, 1), (Kind::Middle, 2), (Kind::Start, 1), (Kind::Start, 2)] {
                    let [weights] = product_weights(tables, kind, [power]);
                    let elapsed = &tables.rule(kind).elapsed;
                    let f: Vec<f64> = elapsed[..nodes].iter().map(|t| t.powi(exponent)).collect();
                    for (row, &t) in weights.chunks_exact(nodes).zip(elapsed) {
                        // int_0^t (t - s)^q s^n ds = n! t^(q + n + 1) / [(q + 1) ... (q + n + 1)]
                        let product: f64 = (1..=exponent + 1).map(|i| power + f64::from(i)).product();
                        let exact = f64::from(exponent) * t.powf(f64::from(exponent) + power + 1.0) / product;
                        assert!((dot(row, &f) - exact).abs() < rounding, "{kind:?} {power} {t}");
                    }
                }
                let [weights] = product_weights(tables, Kind::End, [power]);
                let rule = tables.rule(Kind::End);
                let ones = vec![1.0; nodes];
                let e: Vec<f64> = rule.remaining[..nodes].to_vec();
                for (i, row) in weights.chunks_exact(nodes).enumerate() {
                    let (length, left) = (rule.elapsed[i], rule.remaining[i]);
                    let first = length.powf(power + 1.0) / (power + 1.0);
                    assert!((dot(row, &ones) - first).abs() < rounding, "end {power} {length}");
                    let second = left * first + length.powf(power + 2.0) / (power + 2.0);
                    assert!((dot(row, &e) - second).abs() < rounding, "end {power} {length}");
                }
            }
        }
    }
}
