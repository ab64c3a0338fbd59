//! Gauss rules on `[0, 1]`, barycentric interpolation and Legendre coefficients on their nodes.

use gauss_quad::{FiniteAboveNegOneF64, GaussJacobi, GaussLegendre};
use std::num::NonZeroUsize;

/// Nodes and weights of a quadrature rule on `[0, 1]`.
#[derive(Debug, Clone)]
pub(crate) struct Rule {
    pub nodes: Vec<f64>,
    pub weights: Vec<f64>,
}

impl Rule {
    /// Gauss-Legendre rule with `count >= 1` nodes, ascending.
    pub fn legendre(count: usize) -> Rule {
        let degree = NonZeroUsize::new(count).unwrap_or(NonZeroUsize::MIN);
        Rule::from_pairs(GaussLegendre::new(degree).as_node_weight_pairs(), 1.0)
    }

    /// Gauss-Jacobi rule for the mean `order integral_0^1 u^(order-1) f(u) du`, `order > 0`, nodes ascending. Its weights add up
    /// to 1, so that it is as accurate for small orders, for which the integral alone grows beyond all bounds.
    ///
    /// The number of nodes is rounded up to an even one: the library places the middle node of an odd rule at the centre, which
    /// is right for symmetric weights only.
    pub fn jacobi(count: usize, order: f64) -> Rule {
        let degree = NonZeroUsize::new(count.max(2).next_multiple_of(2)).unwrap_or(NonZeroUsize::MIN);
        let symmetric = FiniteAboveNegOneF64::default();
        // the mean for an order below the rounding of 1 differs from this one by as little
        let exponent = order.max(f64::EPSILON) - 1.0;
        let power = FiniteAboveNegOneF64::new(exponent).unwrap_or(symmetric);
        let rule = GaussJacobi::new(degree, FiniteAboveNegOneF64::new(0.0).unwrap_or(symmetric), power);
        Rule::from_pairs(rule.as_node_weight_pairs(), 1.0)
    }

    /// A rule for the same mean, `0 < order < 1`, with the nodes of Gauss and Legendre, of which none is as near to 0 as those of
    /// Gauss and Jacobi for a small order. It is exact for polynomials below the degree `count`, by the means of the Legendre
    /// polynomials, `(1-p)/(1+p) (2-p)/(2+p) ...` at the order `p`.
    pub fn product(count: usize, order: f64) -> Rule {
        let mut rule = Rule::legendre(count);
        for (u, weight) in rule.nodes.iter().zip(&mut rule.weights) {
            let x = 1.0 - 2.0 * u;
            let (mut before, mut here, mut mean, mut sum) = (0.0, 1.0, 1.0, 0.0);
            for k in (0..count).map(|k| k as f64) {
                sum += (2.0 * k + 1.0) * here * mean;
                (before, here) = (here, ((2.0 * k + 1.0) * x * here - k * before) / (k + 1.0));
                mean *= (k + 1.0 - order) / (k + 1.0 + order);
            }
            *weight *= sum;
        }
        // as the rounding of nodes near 0 counts there most, it is a common factor
        let sum: f64 = rule.weights.iter().sum();
        rule.weights.iter_mut().for_each(|weight| *weight /= sum);
        rule
    }

    fn from_pairs(pairs: &[(f64, f64)], total: f64) -> Rule {
        let mut pairs: Vec<(f64, f64)> = pairs.iter().map(|&(x, w)| (0.5 * (1.0 + x), w)).collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let sum: f64 = pairs.iter().map(|p| p.1).sum();
        Rule { nodes: pairs.iter().map(|p| p.0).collect(), weights: pairs.iter().map(|p| p.1 * total / sum).collect() }
    }
}

/// Polynomial interpolation on Gauss-Legendre nodes of `[0, 1]`.
#[derive(Debug, Clone)]
pub(crate) struct Interpolation {
    pub nodes: Vec<f64>,
    barycentric: Vec<f64>,
    /// Row `k` maps nodal values to the Legendre coefficient of degree `k`; row-major.
    to_legendre: Vec<f64>,
}

impl Interpolation {
    pub fn new(rule: &Rule) -> Interpolation {
        let n = rule.nodes.len();
        // Barycentric weights of Gauss-Legendre nodes (Wang & Xiang 2012): (-1)^j sqrt(u (1-u) w).
        let barycentric = (0..n)
            .map(|j| {
                let u = rule.nodes[j];
                let size = (u * (1.0 - u) * rule.weights[j]).sqrt();
                if j % 2 == 0 { size } else { -size }
            })
            .collect();
        let mut to_legendre = vec![0.0; n * n];
        for j in 0..n {
            let x = 2.0 * rule.nodes[j] - 1.0;
            let (mut before, mut here) = (0.0, 1.0);
            for k in 0..n {
                let kf = k as f64;
                to_legendre[k * n + j] = (2.0 * kf + 1.0) * rule.weights[j] * here;
                (before, here) = (here, ((2.0 * kf + 1.0) * x * here - kf * before) / (kf + 1.0));
            }
        }
        Interpolation { nodes: rule.nodes.clone(), barycentric, to_legendre }
    }

    /// The values of the Lagrange basis at `u`.
    pub fn basis(&self, u: f64, out: &mut [f64]) {
        let mut sum = 0.0;
        for (j, &node) in self.nodes.iter().enumerate() {
            if u == node {
                out.fill(0.0);
                out[j] = 1.0;
                return;
            }
            out[j] = self.barycentric[j] / (u - node);
            sum += out[j];
        }
        out.iter_mut().for_each(|v| *v /= sum);
    }

    /// The larger of the last two Legendre coefficients of nodal values, a measure of what the panel does not resolve.
    pub fn tail(&self, values: impl Fn(usize) -> f64) -> f64 {
        let n = self.nodes.len();
        let coefficient = |k: usize| (0..n).map(|j| self.to_legendre[k * n + j] * values(j)).sum::<f64>().abs();
        (n.saturating_sub(2)..n).map(coefficient).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jacobi_rules_integrate_powers() {
        for count in [2, 5, 16, 31] {
            for order in [5e-324, 1e-16, 1e-10, 0.1, 0.5, 1.3, 1.5, 2.0] {
                let rule = Rule::jacobi(count, order);
                for power in 0..4 {
                    let sum: f64 = rule.nodes.iter().zip(&rule.weights).map(|(u, w)| w * u.powi(power)).sum();
                    let exact = order / (order + power as f64);
                    assert!((sum - exact).abs() < 1e-13 * exact + 4e-15, "{count} {order} {power}: {sum} {exact}");
                }
            }
        }
    }

    #[test]
    fn product_rules_integrate_polynomials() {
        for count in [2, 8, 64, 256] {
            for order in [5e-324, 1e-9, 0.1, 0.9] {
                let rule = Rule::product(count, order);
                for power in 0..count.min(5) {
                    let terms = rule.nodes.iter().zip(&rule.weights).map(|(u, w)| w * u.powi(power as i32));
                    let exact = order / (order + power as f64);
                    assert!((terms.sum::<f64>() - exact).abs() < 1e-13, "{count} {order} {power}");
                }
            }
        }
    }

    #[test]
    fn interpolation_reproduces_polynomials_and_sees_their_degree() {
        let rule = Rule::legendre(9);
        let inter = Interpolation::new(&rule);
        let poly = |u: f64| 1.0 + u - 3.0 * u.powi(6);
        let mut basis = vec![0.0; 9];
        for u in [0.0, 0.3, 1.0, 1.05] {
            inter.basis(u, &mut basis);
            let value: f64 = basis.iter().zip(&rule.nodes).map(|(b, &x)| b * poly(x)).sum();
            assert!((value - poly(u)).abs() < 1e-13);
        }
        assert!(inter.tail(|j| poly(rule.nodes[j])) < 1e-14);
        assert!(inter.tail(|j| rule.nodes[j].powi(8)) > 1e-5);
    }
}
