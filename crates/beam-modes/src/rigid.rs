//! Rigid-body motions.

use crate::definition::End;
use crate::node::Node;
use crate::piece::Piece;
use crate::span::Span;

/// Mass-normalised displacements `p + q x` without strain: a translation before a rotation about the centre of mass.
pub(crate) fn rigid_motions(spans: &[Span], ends: [End; 2], nodes: &[Node]) -> Vec<[f64; 2]> {
    use End::{Free, Guided, Pinned};
    let places = || spans.iter().map(|s| s.start).chain([1.0]);
    let fixed = || places().zip(nodes).filter(|(_, node)| node.is_heavy());
    let mass: f64 = spans.iter().map(|s| s.mass * s.length).sum::<f64>() + fixed().map(|(_, n)| n.mass[0]).sum::<f64>();
    let first_moment = spans.iter().map(|s| s.mass * s.length * (s.start + 0.5 * s.length)).sum::<f64>()
        + fixed().map(|(x, node)| node.mass[0] * x).sum::<f64>();
    let centre = first_moment / mass;
    let held =
        places().zip(nodes).filter(|(_, n)| n.support || n.spring[0] != 0.0).map(|(x, _)| x).collect::<Vec<f64>>();
    let founded = spans.iter().any(|s| s.foundation > 0.0);
    // An axial force keeps its direction, and therefore turns the beam towards it.
    let turned = spans.iter().any(|s| s.tension != 0.0) || nodes.iter().any(|node| node.spring[1] != 0.0);
    let stands = |&[p, q]: &[f64; 2]| !founded && (!turned || q == 0.0) && held.iter().all(|x| p + q * x == 0.0);
    let motions = match ends {
        [Free, Free] => match held.as_slice() {
            // About the only support.
            [x, rest @ ..] if rest.iter().all(|other| other == x) => vec![[-x, 1.0]],
            _ => vec![[1.0, 0.0], [-centre, 1.0]],
        },
        [Guided, Free | Guided] | [Free, Guided] => vec![[1.0, 0.0]],
        [Pinned, Free] => vec![[0.0, 1.0]],
        [Free, Pinned] => vec![[1.0, -1.0]],
        _ => vec![],
    };
    let normalised = |[p, q]: [f64; 2]| {
        // The integral of (p + q x)^2 over a span, from its mean and its variation.
        let square = |s: &Span| (p + q * (s.start + 0.5 * s.length)).powi(2) + (q * s.length).powi(2) / 12.0;
        let along = spans.iter().map(|s| s.mass * s.length * square(s) + s.rotary * s.length * q * q).sum::<f64>();
        let fixed = fixed().map(|(x, node)| node.mass[0] * (p + q * x).powi(2) + node.mass[1] * q * q).sum::<f64>();
        let norm = (along + fixed).sqrt();
        [p / norm, q / norm]
    };
    motions.into_iter().filter(stands).map(normalised).collect()
}

pub(crate) fn rigid_shape(spans: &[Span], &[p, q]: &[f64; 2]) -> Vec<Piece> {
    spans.iter().map(|s| Piece::Short { k: 0.0, length: s.length, start: [p + q * s.start, q, 0.0, 0.0] }).collect()
}
