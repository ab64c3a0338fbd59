//! Earlier segments: their effect on later times by direct sums over their steps.

use crate::power::Power;
use crate::quadrature::Rule;
use crate::system::{Pair, Segment};

/// Distance, in steps, beyond which a Gauss rule replaces the exact integral of the kernel over a step.
const FAR: f64 = 6.0;

/// Grid values of the density on the finished segments.
pub(crate) struct Past {
    /// Each order with its kernel.
    orders: Vec<(f64, Power)>,
    densities: usize,
    rule: Rule,
    segments: Vec<(Segment, Vec<f64>)>,
    /// Weights on the first values of a segment for its singular start, in units of the step.
    start: Vec<f64>,
}

impl Past {
    pub fn new(orders: &[f64], densities: usize, start: Vec<f64>) -> Past {
        let orders = orders.iter().map(|&order| (order, Power::new(order - 1.0))).collect();
        Past { orders, densities, rule: Rule::legendre(4), segments: Vec::new(), start }
    }

    /// Adds a segment with the density at its equally spaced points, `points x densities`.
    pub fn push(&mut self, segment: Segment, f: Vec<f64>) {
        self.segments.push((segment, f));
    }

    /// Number of values stored.
    pub fn len(&self) -> usize {
        self.segments.iter().map(|(_, f)| f.len()).sum()
    }

    /// Adds the effect of all finished segments at time `t` to `rhs`; the density is taken as piecewise linear.
    pub fn add_to(&self, pairs: &[Pair], t: f64, rhs: &mut [f64]) {
        let m = self.densities;
        let mut sums = vec![0.0; self.orders.len() * m];
        for (segment, f) in &self.segments {
            let steps = f.len() / m - 1;
            let h = segment.length() / steps as f64;
            for (o, (_, power)) in self.orders.iter().enumerate() {
                let kernel = h * power.at(t - segment.start);
                for (w, row) in self.start.iter().zip(f.chunks_exact(m)) {
                    for k in 0..m {
                        sums[o * m + k] += kernel * w * row[k];
                    }
                }
            }
            for j in 0..steps {
                let lag = (t - segment.end) + h * (steps - j) as f64;
                for (o, order) in self.orders.iter().enumerate() {
                    let (left, right) = self.step_weights(*order, lag, h);
                    for k in 0..m {
                        sums[o * m + k] += left * f[j * m + k] + right * f[(j + 1) * m + k];
                    }
                }
            }
        }
        for pair in pairs {
            rhs[pair.unknown] += pair.combine(|o| sums[o * m + pair.density]);
        }
    }

    /// Integrals of `u^(order-1)` times the two linear shape functions over `lag - h <= u <= lag`; the first of these functions
    /// is 1 at `u = lag`.
    fn step_weights(&self, (order, power): (f64, Power), lag: f64, h: f64) -> (f64, f64) {
        if lag > FAR * h {
            let (mut left, mut right) = (0.0, 0.0);
            for (&x, &w) in self.rule.nodes.iter().zip(&self.rule.weights) {
                let kernel = h * w * power.at(lag - h * x);
                left += (1.0 - x) * kernel;
                right += x * kernel;
            }
            (left, right)
        } else {
            let near = (lag - h).max(0.0);
            let zeroth = (lag.powf(order) - near.powf(order)) / order;
            let first = (lag.powf(order + 1.0) - near.powf(order + 1.0)) / (order + 1.0);
            let left = (first - near * zeroth) / h;
            (left, zeroth - left)
        }
    }
}
