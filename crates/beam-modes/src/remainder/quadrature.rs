//! Gauss quadrature (W. Gautschi, Orthogonal Polynomials, 2004): of a discrete measure by the Lanczos process (2.2.3), of
//! a power law by Jacobi's recurrence (1.5).

use crate::dense::eigen_tridiagonal;

/// A point mass of a measure on the positive axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Atom {
    pub x: f64,
    pub weight: f64,
}

/// Off-diagonal entries of the Jacobi matrix below this, relative to its largest node, are rounding: the measure has no more
/// nodes.
const EXHAUSTED: f64 = 1e-13;

/// Nodes and weights that integrate polynomials up to degree `2 count - 1` exactly for this measure.
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
        // Against all earlier vectors, twice: exact orthogonality costs little here.
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
    let atom = |(x, weight)| Atom { x: x * largest, weight: total * weight };
    of_recurrence(&diagonal, &off_diagonal)
        .into_iter()
        .map(atom)
        .filter(|atom| atom.x > 0.0 && atom.weight > 0.0)
        .collect()
}

/// The `count` nodes of the weight `x^(-1/(2 growth))` on (0, 1), scaled to the sum `total`: the contribution beyond
/// `omega = 1`, in `x = 1/omega^2`, of frequencies that grow as this power of their index and have the same mean square shape.
pub(crate) fn power_law_atoms(growth: f64, total: f64, count: usize) -> Vec<Atom> {
    let b = -0.5 / growth;
    // Jacobi's weight x^b (1-x)^0, mapped from (-1, 1) to (0, 1).
    let diagonal = |k: f64| {
        if k == 0.0 { (1.0 + b) / (2.0 + b) } else { 0.5 + 0.5 * b * b / ((2.0 * k + b) * (2.0 * k + 2.0 + b)) }
    };
    let off_diagonal = |k: f64| k * (k + b) / ((2.0 * k + b) * ((2.0 * k + b).powi(2) - 1.0).sqrt());
    let diagonal: Vec<f64> = (0..count).map(|k| diagonal(k as f64)).collect();
    let off_diagonal: Vec<f64> = (1..count).map(|k| off_diagonal(k as f64)).collect();
    of_recurrence(&diagonal, &off_diagonal).into_iter().map(|(x, weight)| Atom { x, weight: total * weight }).collect()
}

/// Nodes, and weights that sum to 1, from the three-term recurrence of the orthonormal polynomials.
fn of_recurrence(diagonal: &[f64], off_diagonal: &[f64]) -> Vec<(f64, f64)> {
    match eigen_tridiagonal(diagonal, off_diagonal) {
        Some((values, vectors)) => (0..values.len()).map(|r| (values[r], vectors[(0, r)].powi(2))).collect(),
        None => vec![(diagonal[0], 1.0)],
    }
}
