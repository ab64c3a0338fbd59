//! One panel: its nodes, and the product integration of the kernels over the part of it before each node.

use crate::power::Power;
use crate::quadrature::{Interpolation, Rule};
use crate::system::Segment;

/// An interval of `x = (t - origin)^(1/mapping)` with its nodes.
#[derive(Debug, Clone)]
pub(crate) struct Panel {
    /// Start of the segment.
    pub origin: f64,
    /// End of the segment, in `t` and in `x`.
    pub segment_end: [f64; 2],
    pub mapping: u32,
    /// Ends in `x`.
    pub x: [f64; 2],
    /// Ends in `t`.
    pub t: [f64; 2],
    /// Ends in `t - origin`.
    pub tau: [f64; 2],
    /// Nodes in `x`.
    pub nodes: Vec<f64>,
    /// Nodes in `t`.
    pub times: Vec<f64>,
}

impl Panel {
    /// The panel between two distances from the start of the segment.
    pub fn new(segment: Segment, mapping: u32, tau: [f64; 2], unit_nodes: &[f64]) -> Panel {
        let to_x = |s: f64| if mapping == 2 { s.sqrt() } else { s.powf(1.0 / f64::from(mapping)) };
        let x = tau.map(to_x);
        let segment_end = [segment.end, to_x(segment.length())];
        let t = tau.map(|s| if s == segment.length() { segment.end } else { segment.start + s });
        let nodes: Vec<f64> = unit_nodes.iter().map(|u| x[0] + (x[1] - x[0]) * u).collect();
        let times = nodes.iter().map(|x| segment.inside(segment.start + x.powi(mapping as i32))).collect();
        Panel { origin: segment.start, segment_end, mapping, x, t, tau, nodes, times }
    }

    /// Length in `t`.
    pub fn length(&self) -> f64 {
        self.tau[1] - self.tau[0]
    }

    /// `dt/dx` at `x`.
    pub fn speed(&self, x: f64) -> f64 {
        f64::from(self.mapping) * x.powi(self.mapping as i32 - 1)
    }
}

impl Panel {
    /// Time from the point `back` before the end of this panel (in `x`) to the later `xi` on panel `to`.
    ///
    /// To avoid cancellation between segments, it is the sum of the times before and after the end of this panel.
    #[inline]
    pub fn lag(&self, back: f64, to: &Panel, xi: f64) -> f64 {
        let x = self.x[1] - back;
        if self.origin == to.origin {
            (xi - self.x[1] + back) * divided_power(xi, x, self.mapping)
        } else {
            let [t_end, x_end] = self.segment_end;
            let rest = (x_end - self.x[1] + back) * divided_power(x_end, x, self.mapping);
            (to.origin - t_end) + xi.powi(to.mapping as i32) + rest
        }
    }
}

/// `(a^q - b^q)/(a - b)`, without cancellation.
#[inline]
pub(crate) fn divided_power(a: f64, b: f64, q: u32) -> f64 {
    // the sum of a^(q-1-k) b^k
    let (mut sum, mut power) = (0.0, 1.0);
    for _ in 0..q {
        sum = sum * b + power;
        power *= a;
    }
    sum
}

/// Gauss-Jacobi rules for the singular kernels, one per order.
pub(crate) struct LocalRules {
    rules: Vec<(Power, f64, Rule)>,
}

impl LocalRules {
    pub fn new(orders: &[f64], nodes: usize) -> LocalRules {
        let rule = |&order: &f64| (Power::new(order - 1.0), order, Rule::jacobi(nodes + 6, order));
        LocalRules { rules: orders.iter().map(rule).collect() }
    }

    /// For each order the matrix `W_ij` with `integral_(panel start)^(t_i) (t_i-s)^(order-1) f(s) ds = sum_j W_ij f_j`,
    /// row-major, exact for the interpolating polynomial in `x` up to the smooth factor of the kernel.
    pub fn weights(&self, panel: &Panel, interpolation: &Interpolation) -> Vec<Vec<f64>> {
        let n = panel.nodes.len();
        let width = panel.x[1] - panel.x[0];
        let mut basis = vec![0.0; n];
        let matrix = |(power, order, rule): &(Power, f64, Rule)| {
            let mut w = vec![0.0; n * n];
            for (i, &xi) in panel.nodes.iter().enumerate() {
                let distance = xi - panel.x[0];
                // t_i - s = (x_i - x) (x_i^q - x^q)/(x_i - x), x_i - x = distance * u
                let scale = distance.powf(*order) / order;
                for (&u, &weight) in rule.nodes.iter().zip(&rule.weights) {
                    let x = xi - distance * u;
                    let smooth = power.at(divided_power(xi, x, panel.mapping)) * panel.speed(x);
                    interpolation.basis((x - panel.x[0]) / width, &mut basis);
                    for (w, b) in w[i * n..(i + 1) * n].iter_mut().zip(&basis) {
                        *w += scale * weight * smooth * b;
                    }
                }
            }
            w
        };
        self.rules.iter().map(matrix).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::divided_power;

    #[test]
    fn divided_powers() {
        for q in 1..6 {
            let exact = (2.0f64.powi(q) - 0.5f64.powi(q)) / 1.5;
            assert!((divided_power(2.0, 0.5, q as u32) / exact - 1.0).abs() < 1e-15);
        }
    }
}
