//! Polynomials in one direction of a plate, on `-1 <= s <= 1`.
//!
//! A bubble function has a Legendre polynomial of degree 2 or more as its second derivative, and vanishes with its slope at
//! both ends. The other functions are those polynomials of degree 3 or less that the edges allow. The second derivatives of
//! bubbles are orthogonal to each other and to those of the others, so that stiffness matrices are well conditioned at any
//! degree.

use super::definition::Edge;

/// A polynomial and its two derivatives, as coefficients of Legendre polynomials.
pub(super) struct Function {
    value: Vec<f64>,
    slope: Vec<f64>,
    curvature: Vec<f64>,
}

/// The functions in one direction.
pub(super) struct Line {
    edges: [Edge; 2],
    pub functions: Vec<Function>,
    /// Indices of the functions of either parity; all are in the first list if the two edges differ.
    pub classes: [Vec<usize>; 2],
}

/// Integrals of products of two functions over `-1..1`, row by row.
pub(super) struct Products {
    pub values: Vec<Vec<f64>>,
    pub slopes: Vec<Vec<f64>>,
    pub curvatures: Vec<Vec<f64>>,
    /// The curvature of the first function times the value of the second.
    pub mixed: Vec<Vec<f64>>,
}

impl Line {
    /// All functions up to a degree that these edges, at `s = -1` and `s = 1`, allow.
    pub fn new(edges: [Edge; 2], degree: usize) -> Line {
        let mut functions: Vec<Function> = lowest(edges).into_iter().map(|c| Function::cubic(c, degree)).collect();
        functions.extend((2..=degree.saturating_sub(2)).map(|j| Function::bubble(j, degree)));
        let low = lowest(edges).len();
        let mut classes = [Vec::new(), Vec::new()];
        for k in 0..functions.len() {
            let odd = if k < low { parity(&functions[k].value) } else { (k - low) % 2 };
            classes[if edges[0] == edges[1] { odd } else { 0 }].push(k);
        }
        Line { edges, functions, classes }
    }

    /// Values of all functions at `s`, which are exactly zero at a held edge.
    pub fn values(&self, s: f64) -> Vec<f64> {
        if self.edges.iter().zip([-1.0, 1.0]).any(|(edge, end)| *edge != Edge::Free && s == end) {
            return vec![0.0; self.functions.len()];
        }
        let degree = self.functions.first().map_or(0, |function| function.value.len());
        let mut legendre = vec![1.0, s];
        for n in 1..degree.max(1) {
            let m = n as f64;
            legendre.push(((2.0 * m + 1.0) * s * legendre[n] - m * legendre[n - 1]) / (m + 1.0));
        }
        let sum = |f: &Function| f.value.iter().zip(&legendre).map(|(c, p)| c * p).sum();
        self.functions.iter().map(sum).collect()
    }

    /// Means of all functions over `-1..1`; only the first Legendre polynomial has one.
    pub fn means(&self) -> Vec<f64> {
        self.functions.iter().map(|function| function.value.first().copied().unwrap_or_default()).collect()
    }

    pub fn products(&self) -> Products {
        let table = |left: fn(&Function) -> &[f64], right: fn(&Function) -> &[f64]| -> Vec<Vec<f64>> {
            let row = |f: &Function| self.functions.iter().map(|g| product(left(f), right(g))).collect();
            self.functions.iter().map(row).collect()
        };
        Products {
            values: table(|f| &f.value, |f| &f.value),
            slopes: table(|f| &f.slope, |f| &f.slope),
            curvatures: table(|f| &f.curvature, |f| &f.curvature),
            mixed: table(|f| &f.curvature, |f| &f.value),
        }
    }
}

/// Powers of `s` (constant first) that span the cubics which a pair of edges allows.
fn lowest(edges: [Edge; 2]) -> Vec<[f64; 4]> {
    use Edge::{Clamped, Free, Pinned};
    match edges {
        [Free, Free] => {
            vec![[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 1.0]]
        }
        [Pinned, Pinned] => vec![[-1.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 1.0]],
        [Clamped, Clamped] => vec![],
        [Clamped, Free] => vec![[1.0, 2.0, 1.0, 0.0], [1.0, 3.0, 3.0, 1.0]],
        [Pinned, Free] => vec![[1.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 1.0]],
        [Clamped, Pinned] => vec![[1.0, 1.0, -1.0, -1.0]],
        [left, right] => {
            let mirrored = |[c, s, ss, sss]: [f64; 4]| [c, -s, ss, -sss];
            lowest([right, left]).into_iter().map(mirrored).collect()
        }
    }
}

impl Function {
    fn cubic([c0, c1, c2, c3]: [f64; 4], degree: usize) -> Function {
        // s^2 = (2 P2 + 1)/3, s^3 = (2 P3 + 3 P1)/5
        let legendre = |c0: f64, c1: f64, c2: f64, c3: f64| {
            let mut v = vec![0.0; degree.max(3) + 1];
            v[..4].copy_from_slice(&[c0 + c2 / 3.0, c1 + 0.6 * c3, c2 / 1.5, 0.4 * c3]);
            v
        };
        Function {
            value: legendre(c0, c1, c2, c3),
            slope: legendre(c1, 2.0 * c2, 3.0 * c3, 0.0),
            curvature: legendre(2.0 * c2, 6.0 * c3, 0.0, 0.0),
        }
    }

    /// The bubble whose curvature is `P_j` over its norm, from `int P_j = (P_(j+1) - P_(j-1))/(2j + 1)`.
    fn bubble(j: usize, degree: usize) -> Function {
        let n = j as f64;
        let (mut value, mut slope, mut curvature) =
            (vec![0.0; degree + 1], vec![0.0; degree + 1], vec![0.0; degree + 1]);
        let norm = (n + 0.5).sqrt();
        let (once, up, down) = (norm / (2.0 * n + 1.0), 1.0 / (2.0 * n + 3.0), 1.0 / (2.0 * n - 1.0));
        curvature[j] = norm;
        (slope[j + 1], slope[j - 1]) = (once, -once);
        (value[j + 2], value[j], value[j - 2]) = (once * up, -once * (up + down), once * down);
        Function { value, slope, curvature }
    }
}

/// 0 for an even function, 1 for an odd one.
fn parity(value: &[f64]) -> usize {
    usize::from(value.iter().step_by(2).all(|c| *c == 0.0))
}

/// `int f g ds`.
fn product(f: &[f64], g: &[f64]) -> f64 {
    f.iter().zip(g).enumerate().map(|(n, (a, b))| a * b / (n as f64 + 0.5)).sum()
}
