//! Gauss quadrature of a discrete measure by the Lanczos process (W. Gautschi, Orthogonal Polynomials, 2004, 2.2.3).

use faer::linalg::solvers::SelfAdjointEigen;
use faer::{Mat, Side};

/// A point mass of a measure on the positive axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Atom {
    pub x: f64,
    pub weight: f64,
}

/// Off-diagonal entries of the Jacobi matrix below this, relative to its largest node, are rounding: the measure has
/// no more nodes.
const EXHAUSTED: f64 = 1e-13;

/// Nodes and weights that integrate polynomials up to degree `2 count - 1` as the measure does.
pub(crate) fn gauss_quadrature(atoms: &[Atom], count: usize) -> Vec<Atom> {
    let total: f64 = atoms.iter().map(|atom| atom.weight).sum();
    let largest = atoms.iter().filter(|atom| atom.weight > 0.0).map(|atom| atom.x).fold(0.0, f64::max);
    if !(total > 0.0 && largest > 0.0) {
        return Vec::new();
    }
    let dot = |u: &[f64], v: &[f64]| u.iter().zip(v).map(|(u, v)| u * v).sum::<f64>();
    let mut basis = vec![atoms.iter().map(|atom| (atom.weight / total).sqrt()).collect::<Vec<f64>>()];
    let (mut diagonal, mut off_diagonal) = (Vec::new(), Vec::new());
    loop {
        let last = &basis[basis.len() - 1];
        let mut next: Vec<f64> = atoms.iter().zip(last).map(|(atom, v)| atom.x / largest * v).collect();
        diagonal.push(dot(last, &next));
        if diagonal.len() == count {
            break;
        }
        // against all earlier vectors, twice: exact orthogonality costs nothing here
        for _ in 0..2 {
            for vector in &basis {
                let overlap = dot(vector, &next);
                next.iter_mut().zip(vector).for_each(|(n, v)| *n -= overlap * v);
            }
        }
        let size = dot(&next, &next).sqrt();
        if size <= EXHAUSTED {
            break;
        }
        off_diagonal.push(size);
        next.iter_mut().for_each(|n| *n /= size);
        basis.push(next);
    }
    let n = diagonal.len();
    let jacobi = Mat::from_fn(n, n, |i, j| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => off_diagonal[i.min(j)],
        _ => 0.0,
    });
    let Ok(eigen) = SelfAdjointEigen::new(jacobi.as_ref(), Side::Lower) else {
        return vec![Atom { x: diagonal[0] * largest, weight: total }];
    };
    let node = |r: usize| Atom { x: eigen.S()[r] * largest, weight: total * eigen.U()[(0, r)].powi(2) };
    (0..n).map(node).filter(|atom| atom.x > 0.0 && atom.weight > 0.0).collect()
}
