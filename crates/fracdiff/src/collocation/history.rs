//! Past panels: their effect on later times, by quadrature sums.

use super::panel::{Panel, divided_power};
use crate::power::Power;
use crate::quadrature::{Interpolation, Rule};
use crate::system::Pair;

/// Largest number of dyadic levels towards the end of a panel. Each halves the distance, so that rounding of `t` ends them
/// first.
const MOST_LEVELS: usize = 300;

/// A finished panel.
struct Past {
    panel: Panel,
    /// Density at the nodes, `nodes x densities`.
    f: Vec<f64>,
}

pub(crate) struct History {
    powers: Vec<Power>,
    rule: Rule,
    densities: usize,
    past: Vec<Past>,
    /// Interpolation from the nodes of a panel to the Gauss nodes of its dyadic pieces `[1 - 2^-k, 1 - 2^-(k+1)]`, and then of
    /// the remaining pieces `[1 - 2^-k, 1]`; computed when first needed.
    levels: Vec<Vec<f64>>,
    rests: Vec<Vec<f64>>,
    interpolation: Interpolation,
}

/// A quadrature rule on a piece of a past panel: distances in `x` from the end of the panel, from which the times to later
/// nodes follow without cancellation, and `weight * dt/dx * density` there.
struct Sources {
    back: Vec<f64>,
    strength: Vec<f64>,
}

impl History {
    pub fn new(orders: &[f64], rule: &Rule, interpolation: &Interpolation, densities: usize) -> History {
        History {
            powers: orders.iter().map(|order| Power::new(order - 1.0)).collect(),
            rule: rule.clone(),
            densities,
            past: Vec::new(),
            levels: Vec::new(),
            rests: Vec::new(),
            interpolation: interpolation.clone(),
        }
    }

    /// Number of values stored.
    pub fn len(&self) -> usize {
        self.past.iter().map(|p| p.f.len() + 2 * p.panel.nodes.len()).sum()
    }

    pub fn push(&mut self, panel: &Panel, f: &[f64]) {
        self.past.push(Past { panel: panel.clone(), f: f.to_vec() });
    }

    /// Adds the effect of all past panels to the right-hand side at the nodes of `panel`.
    pub fn add_to(&mut self, pairs: &[Pair], panel: &Panel, unknowns: usize, rhs: &mut [f64]) {
        let (n, m, orders) = (panel.nodes.len(), self.densities, self.powers.len());
        // sums[(order * nodes + i) * densities + k] of source strengths times kernels
        let mut sums = vec![0.0; orders * n * m];
        let gap = panel.nodes[0] - panel.x[0];
        for p in 0..self.past.len() {
            let level = self.levels_needed(p, panel, gap);
            if level == 0 {
                let sources = self.sources(p, [1.0, 0.0], None);
                self.add_sources(p, &sources, panel, &mut sums);
                continue;
            }
            self.build_levels(level);
            for k in 0..level {
                let ends = [0.5f64.powi(k as i32), 0.5f64.powi(k as i32 + 1)];
                let sources = self.sources(p, ends, Some(&self.levels[k]));
                self.add_sources(p, &sources, panel, &mut sums);
            }
            let sources = self.sources(p, [0.5f64.powi(level as i32), 0.0], Some(&self.rests[level]));
            self.add_sources(p, &sources, panel, &mut sums);
        }
        for pair in pairs {
            for i in 0..n {
                rhs[i * unknowns + pair.unknown] += pair.combine(|o| sums[(o * n + i) * m + pair.density]);
            }
        }
    }

    /// Dyadic levels after which the rest of the past panel is no longer than its distance from the first node.
    fn levels_needed(&self, p: usize, panel: &Panel, gap: f64) -> usize {
        let past = &self.past[p].panel;
        // The gap is computed separately: the panels may be neighbours, and the first node close to the panel's start.
        let distance = if past.origin == panel.origin {
            (panel.x[0] - past.x[1] + gap) * divided_power(panel.nodes[0], past.x[1], panel.mapping)
        } else {
            past.lag(0.0, panel, panel.nodes[0])
        };
        let mut level = 0;
        let mut rest = past.length();
        while rest > distance && level < MOST_LEVELS {
            level += 1;
            let x = past.x[1] - (past.x[1] - past.x[0]) * 0.5f64.powi(level as i32);
            rest = (past.x[1] - x) * divided_power(past.x[1], x, past.mapping);
        }
        level
    }

    fn build_levels(&mut self, level: usize) {
        let n = self.rule.nodes.len();
        let matrix = |a: f64, b: f64| {
            let mut rows = vec![0.0; n * n];
            for (row, u) in rows.chunks_exact_mut(n).zip(&self.rule.nodes) {
                self.interpolation.basis(a + (b - a) * u, row);
            }
            rows
        };
        for k in self.rests.len()..=level {
            let (a, b) = (1.0 - 0.5f64.powi(k as i32), 1.0 - 0.5f64.powi(k as i32 + 1));
            self.levels.push(matrix(a, b));
            self.rests.push(matrix(a, 1.0));
        }
    }

    /// Sources on the part of a past panel between two distances from its end, in units of its width; `to`
    /// interpolates the density to them.
    fn sources(&self, p: usize, [far, near]: [f64; 2], to: Option<&Vec<f64>>) -> Sources {
        let Past { panel, f } = &self.past[p];
        let (n, m) = (self.rule.nodes.len(), self.densities);
        let width = panel.x[1] - panel.x[0];
        let back: Vec<f64> = self.rule.nodes.iter().map(|u| width * (near + (far - near) * (1.0 - u))).collect();
        let mut strength = vec![0.0; n * m];
        for (j, row) in strength.chunks_exact_mut(m).enumerate() {
            let weight = self.rule.weights[j] * width * (far - near) * panel.speed(panel.x[1] - back[j]);
            for (k, s) in row.iter_mut().enumerate() {
                *s = weight
                    * match to {
                        None => f[j * m + k],
                        Some(rows) => (0..n).map(|l| rows[j * n + l] * f[l * m + k]).sum(),
                    };
            }
        }
        Sources { back, strength }
    }

    fn add_sources(&self, p: usize, sources: &Sources, panel: &Panel, sums: &mut [f64]) {
        let past = &self.past[p].panel;
        let (n, m) = (panel.nodes.len(), self.densities);
        for (i, &xi) in panel.nodes.iter().enumerate() {
            for (&back, strength) in sources.back.iter().zip(sources.strength.chunks_exact(m)) {
                let lag = past.lag(back, panel, xi);
                for (o, power) in self.powers.iter().enumerate() {
                    let kernel = power.at(lag);
                    let row = &mut sums[(o * n + i) * m..(o * n + i + 1) * m];
                    for (sum, s) in row.iter_mut().zip(strength) {
                        *sum += kernel * s;
                    }
                }
            }
        }
    }
}
