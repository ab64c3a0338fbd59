//! The largest value of a quantity over many panels.

use super::legendre::{BASIS, Nodal, Q, evaluate, evaluate_at};

/// The largest value of a quantity over the steps of a contact. The step with the largest nodal value is stored, and its
/// polynomial is searched when the contact has ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Peak {
    largest: f64,
    nodal: Nodal,
}

impl Peak {
    pub const NONE: Peak = Peak { largest: 0.0, nodal: [0.0; Q] };

    pub fn note(&mut self, nodal: &Nodal) {
        let largest = nodal.iter().fold(0.0, |a: f64, b| a.max(*b));
        if largest > self.largest {
            *self = Peak { largest, nodal: *nodal };
        }
    }

    pub fn value(&self) -> f64 {
        let coefficients = BASIS.coefficients(&self.nodal);
        let value = |at: f64| evaluate(&coefficients, at);
        // the best of a grid, then twice the vertex of the parabola through it and its neighbours
        let mut spacing = 1.0 / (2 * Q) as f64;
        let (mut at, mut best) = (0.0, value(0.0));
        for first in [1, Q + 1] {
            let places = std::array::from_fn(|i| (first + i) as f64 * spacing);
            for (place, here) in places.into_iter().zip(evaluate_at(&coefficients, &places)) {
                if here > best {
                    (at, best) = (place, here);
                }
            }
        }
        for _ in 0..2 {
            let (before, after) = (value(at - spacing), value(at + spacing));
            let bend = before - 2.0 * best + after;
            let vertex = at + 0.5 * spacing * (before - after) / bend;
            if !(bend < 0.0 && (0.0..=1.0).contains(&vertex)) {
                break;
            }
            let here = value(vertex);
            if here > best {
                (at, best) = (vertex, here);
            }
            spacing *= 0.1;
        }
        self.largest.max(best)
    }
}
