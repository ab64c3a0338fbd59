//! Orthonormal mode shapes from natural frequencies.

use crate::piece::Piece;
use crate::span::Span;
use crate::waves::State;

/// A state at the left end of a span that (nearly) satisfies the conditions of both ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Match {
    /// Sine of the angle between the states that the left and the right end allow: zero for a mode, and least sensitive to
    /// rounding where the mode is large.
    pub defect: f64,
    pub span: usize,
    pub state: State,
}

/// A chain of spans with waves.
pub(crate) trait Waveguide {
    /// The states that both ends allow at one frequency, at every span.
    type Sweeps;
    fn spans(&self) -> &[Span];
    /// Mass inner product of two shapes.
    fn inner(&self, u: &[Piece], v: &[Piece]) -> f64 {
        self.spans().iter().zip(u.iter().zip(v)).map(|(span, (u, v))| span.mass * u.product(v)).sum()
    }
    /// The lowest derivative that the left end leaves free, there; shapes are positive in it.
    fn leading(&self, first: &Piece) -> f64;
    /// The lowest derivative at the left end that is not constrained; it is positive for every shape.
    fn spacing(&self, q: f64) -> f64;
    fn sweeps(&self, q: f64) -> Self::Sweeps;
    /// Candidates for the mode, at every span.
    fn matches(&self, sweeps: &Self::Sweeps) -> Vec<Match>;
    /// The solution through a match, span by span.
    fn unroll(&self, q: f64, sweeps: &Self::Sweeps, at: &Match) -> Vec<Piece>;
}

fn normalise(guide: &impl Waveguide, pieces: &mut [Piece]) {
    // First normalised, so that the squares do not leave the range of f64.
    let size = pieces.iter().map(Piece::size).fold(0.0, f64::max);
    if size > 0.0 {
        pieces.iter_mut().for_each(|p| *p = p.scaled(1.0 / size));
        let norm = guide.inner(pieces, pieces).sqrt();
        pieces.iter_mut().for_each(|p| *p = p.scaled(1.0 / norm));
    }
}

/// For roots closer than this fraction of their mean distance, shapes are too uncertain to be orthogonal without
/// orthogonalisation.
const CLUSTER: f64 = 0.02;
/// A candidate whose part orthogonal to the chosen shapes is smaller than this depends on them.
const NEW: f64 = 0.1;

/// Mass-normalised shapes (dimensionless) of the ascending roots.
pub(crate) fn shapes(guide: &impl Waveguide, roots: &[f64]) -> Vec<Vec<Piece>> {
    let mut shapes: Vec<Vec<Piece>> = Vec::with_capacity(roots.len());
    let mut cluster = 0;
    for (n, &q) in roots.iter().enumerate() {
        if n > 0 && q - roots[n - 1] > CLUSTER * guide.spacing(q) {
            cluster = n;
        }
        let sweeps = guide.sweeps(q);
        let mut candidates = guide.matches(&sweeps);
        candidates.sort_by(|a, b| a.defect.total_cmp(&b.defect));
        if cluster == n {
            candidates.truncate(1);
        }
        let mut best = (-1.0, Vec::new());
        for candidate in &candidates {
            let mut shape = guide.unroll(q, &sweeps, candidate);
            normalise(guide, &mut shape);
            let mut part = 1.0;
            // Twice is enough (Kahan and Parlett).
            let passes = if cluster == n { 0 } else { 2 };
            for _ in 0..passes {
                for other in &shapes[cluster..n] {
                    let overlap = guide.inner(&shape, other);
                    shape.iter_mut().zip(other).for_each(|(piece, o)| *piece = piece.plus(-overlap, o));
                }
                let left = guide.inner(&shape, &shape).max(0.0).sqrt();
                part *= left;
                normalise(guide, &mut shape);
            }
            if part > best.0 {
                best = (part, shape);
            }
            if best.0 > NEW {
                break;
            }
        }
        let mut shape: Vec<Piece> = best.1;
        if shape.first().is_some_and(|piece| guide.leading(piece) < 0.0) {
            shape.iter_mut().for_each(|piece| *piece = piece.scaled(-1.0));
        }
        shapes.push(shape);
    }
    shapes
}
