//! Axial waves on a stepped rod: the counterpart of `flexure`, with one state vector in place of a plane.
//!
//! `u'' = -k^2 u`, trial value `q = omega`, `k = q sqrt(m/EA)`, state `z = sqrt(EA k) (u, u'/k)`: a span rotates it by `k l`, a
//! step scales its components.

use crate::piece::Piece;
use crate::roots::Characteristic;
use crate::shapes::{Match, Waveguide};
use crate::span::Span;
use std::f64::consts::PI;

/// The boundary condition at an end of a rod.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum RodEnd {
    /// No displacement.
    Fixed,
    /// No force.
    Free,
}

invalid_input::names!(RodEnd, "end", { Fixed: "fixed", Free: "free" });

#[derive(Debug, Clone)]
pub(crate) struct Axial {
    spans: Vec<Span>,
    ends: [RodEnd; 2],
    /// `sqrt(m/EA)` of each span.
    slowness: Vec<f64>,
    /// `sum k l / q`.
    phase: f64,
    /// Square root of the impedance of span `i + 1` over that of span `i`.
    steps: Vec<f64>,
}

/// The unit state that satisfies the condition of one end, propagated along the rod; lists in the order of the spans.
pub(crate) struct Sweep {
    /// State at the entry and at the exit of each span; from the right, in reflected variables.
    entries: Vec<[f64; 2]>,
    exits: Vec<[f64; 2]>,
    /// Norms by which the state was divided at the steps.
    stretches: Vec<f64>,
}

/// The states from both ends.
pub(crate) struct Sweeps {
    left: Sweep,
    right: Sweep,
}

fn end_state(end: RodEnd) -> [f64; 2] {
    match end {
        RodEnd::Fixed => [0.0, 1.0],
        RodEnd::Free => [1.0, 0.0],
    }
}

fn turn([u, v]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [u * cos + v * sin, v * cos - u * sin]
}

fn stretch([u, v]: [f64; 2], rho: f64) -> ([f64; 2], f64) {
    let (u, v) = (u * rho, v / rho);
    let size = u.hypot(v);
    ([u / size, v / size], size)
}

impl Axial {
    pub fn new(spans: Vec<Span>, ends: [RodEnd; 2]) -> Self {
        let slowness: Vec<f64> = spans.iter().map(|s| (s.mass / s.rigidity).sqrt()).collect();
        let phase = spans.iter().zip(&slowness).map(|(span, k)| span.length * k).sum();
        let impedance = |s: &Span| (s.mass * s.rigidity).sqrt();
        let steps = spans.windows(2).map(|w| (impedance(&w[1]) / impedance(&w[0])).sqrt()).collect();
        Self { spans, ends, slowness, phase, steps }
    }

    fn angle(&self, i: usize, q: f64) -> f64 {
        q * self.slowness[i] * self.spans[i].length
    }

    fn sweep(&self, q: f64, from_right: bool) -> Sweep {
        let n = self.spans.len();
        let mut state = end_state(self.ends[usize::from(from_right)]);
        let (mut entries, mut exits, mut stretches) = (Vec::new(), Vec::new(), Vec::new());
        for step in 0..n {
            let i = if from_right { n - 1 - step } else { step };
            entries.push(state);
            state = turn(state, self.angle(i, q));
            exits.push(state);
            if step + 1 < n {
                let rho = if from_right { 1.0 / self.steps[i - 1] } else { self.steps[i] };
                let (next, size) = stretch(state, rho);
                state = next;
                stretches.push(size);
            }
        }
        if from_right {
            entries.reverse();
            exits.reverse();
            stretches.reverse();
        }
        Sweep { entries, exits, stretches }
    }
}

impl Characteristic for Axial {
    fn count_and_function(&self, q: f64) -> (usize, f64) {
        let mut state = end_state(self.ends[0]);
        let mut count = 0;
        for i in 0..self.spans.len() {
            let angle = self.angle(i, q);
            let inside = (angle / PI).floor();
            let sign = if inside % 2.0 == 0.0 { 1.0 } else { -1.0 };
            let (sin, cos) = angle.sin_cos();
            // Stiffness of the part to the left plus that of the span with its far end fixed, times |sin| u^2.
            let stiffness = sin.abs() * state[0] * state[1] + sign * cos * state[0] * state[0];
            count += inside as usize + usize::from(stiffness < 0.0);
            state = turn(state, angle);
            if let Some(&rho) = self.steps.get(i) {
                state = stretch(state, rho).0;
            }
        }
        match self.ends[1] {
            RodEnd::Fixed => (count, state[0]),
            RodEnd::Free => (count + usize::from(state[0] * state[1] < 0.0), state[1]),
        }
    }

    fn function(&self, q: f64) -> f64 {
        self.count_and_function(q).1
    }

    fn estimate(&self, count: usize) -> f64 {
        (count as f64 + 1.0) * PI / self.phase
    }
}

impl Waveguide for Axial {
    type Sweeps = Sweeps;

    fn spans(&self) -> &[Span] {
        &self.spans
    }

    fn leading(&self, first: &Piece) -> f64 {
        match self.ends[0] {
            RodEnd::Fixed => first.slope(0.0),
            RodEnd::Free => first.displacement(0.0),
        }
    }

    fn spacing(&self, _: f64) -> f64 {
        PI / self.phase
    }

    fn sweeps(&self, q: f64) -> Sweeps {
        Sweeps { left: self.sweep(q, false), right: self.sweep(q, true) }
    }

    fn matches(&self, Sweeps { left, right }: &Sweeps) -> Vec<Match> {
        let pairs = left.entries.iter().zip(&right.exits).enumerate();
        pairs
            .map(|(span, (l, &[u, v]))| Match { defect: (l[0] * v + l[1] * u).abs(), span, state: [u, -v, 0.0, 0.0] })
            .collect()
    }

    fn unroll(&self, q: f64, Sweeps { left, right }: &Sweeps, at: &Match) -> Vec<Piece> {
        let n = self.spans.len();
        let [u, v, ..] = at.state;
        // Share of each span in the unit state.
        let mut share = vec![0.0; n];
        let mut carried = left.entries[at.span][0] * u + left.entries[at.span][1] * v;
        for i in (0..at.span).rev() {
            carried /= left.stretches[i];
            share[i] = carried;
        }
        share[at.span] = right.exits[at.span][0] * u - right.exits[at.span][1] * v;
        for i in at.span + 1..n {
            share[i] = share[i - 1] / right.stretches[i - 1];
        }
        (0..n)
            .map(|i| {
                let span = &self.spans[i];
                // u = z_0 / sqrt(EA k); the common power of q is omitted.
                let size = share[i] / (span.rigidity * self.slowness[i]).sqrt();
                let k = q * self.slowness[i];
                let piece = |[a, b]: [f64; 2]| Piece::slender(k, span.length, [a * size, b * size, 0.0, 0.0]);
                if i < at.span { piece(left.entries[i]) } else { piece(right.entries[i]).reflected() }
            })
            .collect()
    }
}
