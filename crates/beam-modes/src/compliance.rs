//! Exact static deflection under a unit force: a polynomial on every piece between steps and force.
//!
//! `EI w'''' = delta(x - y) - m sum_r phi_r(x) phi_r(y)`: if the ends allow rigid-body motions `phi_r`, these take up their
//! part of the force as uniform acceleration, and the rest is in equilibrium. The deflection is then made orthogonal to them.

use crate::definition::End;
use crate::flexure::{allowed, constrained};
use crate::quadrature::gauss;
use crate::span::Span;

/// `(w, w', EI w'', (EI w'')')`.
type State = [f64; 4];

/// A piece with constant rigidity and a load per length `load[0] + load[1] xi`, with `xi` from its left end.
#[derive(Clone, Copy)]
struct Bay {
    span: Span,
    load: [f64; 2],
    /// Force at its left end.
    force: f64,
}

impl Bay {
    fn state(&self, [w, slope, moment, shear]: State, xi: f64, loaded: f64) -> State {
        let [p, q] = self.load.map(|l| l * loaded);
        let shear = shear + self.force * loaded;
        let (x2, x3, x4, x5) = (xi.powi(2) / 2.0, xi.powi(3) / 6.0, xi.powi(4) / 24.0, xi.powi(5) / 120.0);
        [
            w + slope * xi + (moment * x2 + shear * x3 + p * x4 + q * x5) / self.span.rigidity,
            slope + (moment * xi + shear * x2 + p * x3 + q * x4) / self.span.rigidity,
            moment + shear * xi + p * x2 + q * x3,
            shear + p * xi + q * x2,
        ]
    }

    fn end(&self, start: State, loaded: f64) -> State {
        self.state(start, self.span.length, loaded)
    }
}

/// Dimensionless Green's function `G(x, y)` of a beam whose mass-normalised rigid motions are `p + q x`.
pub(crate) fn green(spans: &[Span], ends: [End; 2], motions: &[[f64; 2]], x: f64, y: f64) -> f64 {
    if y > 0.5 {
        // Start from the nearer end, where a small deflection is not a difference of large ones.
        let mut mirrored: Vec<Span> = spans.iter().rev().copied().collect();
        let mut start = 0.0;
        for span in &mut mirrored {
            span.start = start;
            start += span.length;
        }
        let motions: Vec<[f64; 2]> = motions.iter().map(|&[p, q]| [p + q, -q]).collect();
        return deflection(&mirrored, [ends[1], ends[0]], &motions, 1.0 - x, 1.0 - y);
    }
    deflection(spans, ends, motions, x, y)
}

fn deflection(spans: &[Span], ends: [End; 2], motions: &[[f64; 2]], x: f64, y: f64) -> f64 {
    let bays = bays(spans, motions, y);
    let across = |start: State, loaded: f64| bays.iter().fold(start, |state, bay| bay.end(state, loaded));

    // The two unknowns at the left end, from the two conditions at the right end.
    let unknowns = allowed(ends[0]);
    let conditions = constrained(ends[1]);
    let responses = unknowns.map(|i| {
        let mut unit = [0.0; 4];
        unit[i] = 1.0;
        across(unit, 0.0)
    });
    let particular = across([0.0; 4], 1.0);
    let matrix = conditions.map(|c| responses.map(|response| response[c]));
    let solved = solve(matrix, conditions.map(|c| -particular[c]), 2 - motions.len());

    let mut state = [0.0; 4];
    (state[unknowns[0]], state[unknowns[1]]) = (solved[0], solved[1]);
    let mut at_x = 0.0;
    let mut shares = vec![0.0; motions.len()];
    for bay in &bays {
        if bay.span.start <= x {
            at_x = bay.state(state, (x - bay.span.start).min(bay.span.length), 1.0)[0];
        }
        for (share, [p, q]) in shares.iter_mut().zip(motions) {
            *share += bay.span.mass
                * gauss(bay.span.length, |xi| bay.state(state, xi, 1.0)[0] * (p + q * (bay.span.start + xi)));
        }
        state = bay.end(state, 1.0);
    }
    shares.iter().zip(motions).fold(at_x, |w, (share, [p, q])| w - share * (p + q * x))
}

/// Spans, divided where the force acts, with the load that balances the rigid-body acceleration.
fn bays(spans: &[Span], motions: &[[f64; 2]], y: f64) -> Vec<Bay> {
    let [p, q] = motions.iter().fold([0.0; 2], |[a, b], &[p, q]| [a + p * (p + q * y), b + q * (p + q * y)]);
    let bay = |span: Span, force: f64| {
        let load = [-span.mass * (p + q * span.start), -span.mass * q];
        Bay { span, load, force }
    };
    let mut bays = Vec::with_capacity(spans.len() + 1);
    let mut pending = 1.0;
    for (i, span) in spans.iter().enumerate() {
        let before = (y - span.start).clamp(0.0, span.length);
        if pending > 0.0 && (before < span.length || i + 1 == spans.len()) {
            bays.push(bay(Span { length: before, ..*span }, 0.0));
            bays.push(bay(Span { start: span.start + before, length: span.length - before, ..*span }, pending));
            pending = 0.0;
        } else {
            bays.push(bay(*span, 0.0));
        }
    }
    bays
}

/// Solves two equations of known rank by complete pivoting; undetermined unknowns are zero.
fn solve(a: [[f64; 2]; 2], b: [f64; 2], rank: usize) -> [f64; 2] {
    let mut x = [0.0; 2];
    if rank == 0 {
        return x;
    }
    let (mut row, mut column) = (0, 0);
    for i in 0..2 {
        for j in 0..2 {
            if a[i][j].abs() > a[row][column].abs() {
                (row, column) = (i, j);
            }
        }
    }
    let (other_row, other_column) = (1 - row, 1 - column);
    if rank == 2 {
        let factor = a[other_row][column] / a[row][column];
        x[other_column] =
            (b[other_row] - factor * b[row]) / (a[other_row][other_column] - factor * a[row][other_column]);
    }
    x[column] = (b[row] - a[row][other_column] * x[other_column]) / a[row][column];
    x
}
