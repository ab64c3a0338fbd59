//! The characteristic equations of a uniform Euler-Bernoulli beam with a clamped or free end, in a form that never overflows.
//!
//! For every such pair of ends the textbook equation (`cos x cosh x = 1`, `tan x = tanh x`, ...) with `x = k L` is equivalent to
//!
//! `x = (n + shift) pi + s m atan(exp(-2 x / m))`,  `s = -1, +1`,  `m = 1, 2`,
//!
//! whose last term is at most a fraction of the distance between roots: there is exactly one root for each `n`, and Newton's
//! method finds it in a few steps.

use crate::definition::End;
use crate::span::Span;
use std::f64::consts::PI;

/// The square roots of the first `wanted` frequencies; `None` if neither end is clamped or free (`standing.rs`).
pub(crate) fn roots(span: &Span, ends: [End; 2], wanted: usize) -> Option<Vec<f64>> {
    let unit = (span.rigidity / span.mass).sqrt().sqrt() / span.length;
    (1..=wanted).map(|n| Some(root(ends, n)? * unit)).collect()
}

/// `k L` of the `n`-th elastic mode, `n = 1, 2, ...`
fn root(ends: [End; 2], n: usize) -> Option<f64> {
    use End::{Clamped, Free, Guided, Pinned};
    let alternate = if n % 2 == 1 { 1.0 } else { -1.0 };
    let (shift, sign, m) = match ends {
        [Pinned | Guided, Pinned | Guided] => return None,
        // cos x cosh x = 1
        [Clamped, Clamped] | [Free, Free] => (0.5, alternate, 2.0),
        // cos x cosh x = -1
        [Clamped, Free] | [Free, Clamped] => (-0.5, alternate, 2.0),
        // tan x = tanh x
        [Clamped | Free, Pinned] | [Pinned, Clamped | Free] => (0.25, -1.0, 1.0),
        // tan x = -tanh x
        [Clamped | Free, Guided] | [Guided, Clamped | Free] => (-0.25, 1.0, 1.0),
    };
    let start = (n as f64 + shift) * PI;
    let mut x = start;
    for _ in 0..20 {
        let small = (-2.0 * x / m).exp();
        let residual = x - start - sign * m * small.atan();
        let slope = 1.0 + sign * 2.0 * small / (1.0 + small * small);
        let change = residual / slope;
        x -= change;
        if change.abs() <= f64::EPSILON * x {
            break;
        }
    }
    Some(x)
}
