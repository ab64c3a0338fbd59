//! Ritz's method for thin plates with any edges.
//!
//! With `s` and `t` from -1 to 1 along and across, stiffness and mass of products `f_i(s) g_j(t)` are Kronecker products
//! of one-dimensional integrals (A. W. Leissa, *J. Sound Vib.* 31 (1973) 257, eq. 13 for the energy):
//!
//! ```text
//! U = D/2 int w_xx^2 + w_yy^2 + 2 nu w_xx w_yy + 2 (1 - nu) w_xy^2 dA.
//! ```
//!
//! The eigenproblem is solved for `1/omega^2`, so that the slow modes are the ones that keep all digits; Cholesky's
//! factor is that of the stiffness. Rigid-body motions, known exactly, are taken out beforehand. Edges that are alike on
//! opposite sides split the problem into two, or four.

use super::line::{Line, Products};
use super::modes::{Kind, PlateModes, Product, lines};
use super::{Edge, Plate};
use crate::error::InvalidInput;
use faer::linalg::solvers::{Llt, SelfAdjointEigen, Solve};
use faer::{Mat, Side};
use std::f64::consts::PI;

/// More functions than this are not taken in one block.
const MOST_ROWS: usize = 3000;

pub(super) struct Ritz<'a> {
    plate: &'a Plate,
    degrees: [usize; 2],
    lines: [Line; 2],
    products: [Products; 2],
    rigidity_n_m: f64,
}

/// What one block of the problem is made of, made dimensionless by `D` and by the mass.
struct Block {
    classes: [usize; 2],
    /// The products of functions, by their numbers.
    pairs: Vec<[usize; 2]>,
    stiffness: Mat<f64>,
    mass: Mat<f64>,
    /// The mass times each rigid-body motion in this block.
    rigid: Vec<Vec<f64>>,
    /// Stiffness with rigid-body motions held, rows and columns times `scale`: its diagonal is 1.
    factored: Mat<f64>,
    scale: Vec<f64>,
}

/// A mode that was found.
struct Found {
    omega_rad_s: f64,
    change: f64,
    product: Product,
}

impl<'a> Ritz<'a> {
    /// Degrees that resolve the first `count` modes, if matrices of a reasonable size do: polynomials need their degree
    /// beyond the wave number times half the length, by an excess that grows as its cube root.
    pub fn degrees(plate: &Plate, count: usize) -> Option<[usize; 2]> {
        let (a, b) = (plate.length_m, plate.width_m);
        // Weyl: N = a b k^2/(4 pi) less what the edges keep still; half a wave for a pinned one, more for a clamped one
        let held = |pair: &[Edge]| {
            let share = |edge: &Edge| match edge {
                Edge::Clamped => 0.5,
                Edge::Pinned => 0.25,
                Edge::Free => 0.0,
            };
            2.0 * pair.iter().map(share).sum::<f64>()
        };
        let still = (held(&plate.edges[..2]) * b + held(&plate.edges[2..]) * a) / PI;
        let count = count as f64 + 4.0;
        let k = (still + (still * still + 4.0 * a * b * count / PI).sqrt()) * PI / (a * b);
        let degree = |length: f64| {
            let waves = 0.5 * k * length;
            (waves + 2.5 * waves.cbrt() + 4.0).min(1e6) as usize + 3
        };
        let degrees = [degree(a), degree(b)];
        let sizes = |pair: &[Edge], degree: usize| if pair[0] == pair[1] { degree.div_ceil(2) + 1 } else { degree };
        let rows = sizes(&plate.edges[..2], degrees[0]) * sizes(&plate.edges[2..], degrees[1]);
        (rows <= MOST_ROWS).then_some(degrees)
    }

    /// Degrees for the static deflection of a square, in one ratio.
    pub const STATIC_DEGREES: [usize; 3] = [16, 24, 36];

    /// Degrees for the static deflection: more along the longer side, as far as matrices stay small.
    pub fn static_degrees(plate: &Plate, of_square: usize) -> [usize; 2] {
        let ratio = (plate.length_m / plate.width_m).clamp(0.25, 4.0).sqrt();
        // even, so that both parities have as many functions
        let degree = |factor: f64| 2 * (0.5 * of_square as f64 * factor).round() as usize;
        [degree(ratio), degree(1.0 / ratio)]
    }

    pub fn new(plate: &'a Plate, degrees: [usize; 2]) -> Ritz<'a> {
        let lines = lines(plate, degrees);
        let products = [lines[0].products(), lines[1].products()];
        Ritz { plate, degrees, lines, products, rigidity_n_m: plate.flexural_rigidity_n_m() }
    }

    /// The classes of functions that are not empty, in pairs.
    fn classes(&self) -> Vec<[usize; 2]> {
        let pairs = [[0, 0], [0, 1], [1, 0], [1, 1]];
        let filled =
            |[i, j]: &[usize; 2]| !self.lines[0].classes[*i].is_empty() && !self.lines[1].classes[*j].is_empty();
        pairs.into_iter().filter(filled).collect()
    }

    fn block(&self, classes: [usize; 2]) -> Block {
        let [x, y] = &self.products;
        let pairs = self.pairs(classes);
        let n = pairs.len();
        let ratio = (self.plate.width_m / self.plate.length_m).powi(2);
        let nu = self.plate.poissons_ratio;
        let stiffness = Mat::from_fn(n, n, |p, q| {
            let ([i, j], [k, l]) = (pairs[p], pairs[q]);
            ratio * x.curvatures[i][k] * y.values[j][l]
                + x.values[i][k] * y.curvatures[j][l] / ratio
                + nu * (x.mixed[i][k] * y.mixed[l][j] + x.mixed[k][i] * y.mixed[j][l])
                + 2.0 * (1.0 - nu) * x.slopes[i][k] * y.slopes[j][l]
        });
        let mass = Mat::from_fn(n, n, |p, q| {
            let ([i, j], [k, l]) = (pairs[p], pairs[q]);
            0.25 * x.values[i][k] * y.values[j][l]
        });
        let rigid: Vec<Vec<f64>> = self
            .rigid()
            .into_iter()
            .filter_map(|(pair, size)| pairs.iter().position(|other| *other == pair).map(|row| (row, size)))
            .map(|(row, size)| (0..n).map(|p| size * mass[(p, row)]).collect())
            .collect();
        // a stiffness of the plate's own order holds the rigid-body motions
        let held = 10.0 * ratio.min(1.0 / ratio);
        let mut factored = stiffness.clone();
        for motion in &rigid {
            for p in 0..n {
                for q in 0..n {
                    factored[(p, q)] += held * motion[p] * motion[q];
                }
            }
        }
        let scale: Vec<f64> = (0..n).map(|p| 1.0 / factored[(p, p)].sqrt()).collect();
        for p in 0..n {
            for q in 0..n {
                factored[(p, q)] *= scale[p] * scale[q];
            }
        }
        Block { classes, pairs, stiffness, mass, rigid, factored, scale }
    }

    fn pairs(&self, classes: [usize; 2]) -> Vec<[usize; 2]> {
        let (rows, columns) = (&self.lines[0].classes[classes[0]], &self.lines[1].classes[classes[1]]);
        rows.iter().flat_map(|i| columns.iter().map(move |j| [*i, *j])).collect()
    }

    /// Rigid-body motions, orthonormal in mass: which product of functions, and its coefficient.
    fn rigid(&self) -> Vec<([usize; 2], f64)> {
        let root = 3f64.sqrt();
        match self.plate.rigid_body_count() {
            3 => vec![([0, 0], 1.0), ([1, 0], root), ([0, 1], root)],
            // 1 + s from a pinned edge
            1 => vec![([0, 0], 0.5 * root)],
            _ => Vec::new(),
        }
    }

    /// From the dimensionless problem to (rad/s)^2.
    fn square_frequency(&self) -> f64 {
        4.0 * self.rigidity_n_m / (self.plate.length_m * self.plate.width_m) / self.plate.mass_kg()
    }

    /// The first `count` modes.
    pub fn modes(&self, count: usize) -> Result<PlateModes, InvalidInput> {
        let size = 1.0 / self.plate.mass_kg().sqrt();
        let mut found: Vec<Found> = Vec::new();
        for classes in self.classes() {
            found.extend(self.block(classes).modes(count).ok_or_else(unresolved)?);
        }
        found.sort_by(|p, q| p.omega_rad_s.total_cmp(&q.omega_rad_s));
        let mut modes = PlateModes {
            plate: *self.plate,
            rigid: 0,
            omega_rad_s: Vec::new(),
            change: Vec::new(),
            kind: Kind::Sines(Vec::new()),
        };
        let mut shapes = Vec::new();
        for (pair, coefficient) in self.rigid() {
            for classes in self.classes() {
                let pairs = self.pairs(classes);
                let Some(row) = pairs.iter().position(|other| *other == pair) else { continue };
                let mut coefficients = vec![0.0; pairs.len()];
                coefficients[row] = size * coefficient;
                modes.omega_rad_s.push(0.0);
                modes.change.push(0.0);
                shapes.push(Product { classes, coefficients });
                modes.rigid += 1;
            }
        }
        for mut mode in found {
            modes.omega_rad_s.push(mode.omega_rad_s * self.square_frequency().sqrt());
            modes.change.push(mode.change);
            mode.product.coefficients.iter_mut().for_each(|c| *c *= size);
            shapes.push(mode.product);
        }
        if shapes.len() < count {
            return Err(unresolved());
        }
        modes.rigid = modes.rigid.min(count);
        modes.omega_rad_s.truncate(count);
        modes.change.truncate(count);
        shapes.truncate(count);
        modes.kind = Kind::Polynomials { degrees: self.degrees, shapes };
        Ok(modes)
    }

    /// Static deflection under a unit load at a place, in shares of length and width; of elastic modes alone.
    pub fn static_compliance(&self, x: f64, y: f64) -> Result<f64, InvalidInput> {
        let (along, across) = (self.lines[0].values(2.0 * x - 1.0), self.lines[1].values(2.0 * y - 1.0));
        let mut sum = 0.0;
        for classes in self.classes() {
            let block = self.block(classes);
            let values: Vec<f64> = block.pairs.iter().map(|[i, j]| along[*i] * across[*j]).collect();
            if values.iter().all(|value| *value == 0.0) {
                continue;
            }
            // the load less the inertia of the rigid-body motions that it causes
            let mut load = values.clone();
            for (pair, size) in self.rigid() {
                let Some(row) = block.pairs.iter().position(|other| *other == pair) else { continue };
                for (p, force) in load.iter_mut().enumerate() {
                    *force -= size * block.mass[(p, row)] * size * values[row];
                }
            }
            let n = load.len();
            let scaled = Mat::from_fn(n, 1, |p, _| load[p] * block.scale[p]);
            let factor = Llt::new(block.factored.as_ref(), Side::Lower).map_err(|_| unresolved())?;
            let moved = factor.solve(&scaled);
            sum += (0..n).map(|p| scaled[(p, 0)] * moved[(p, 0)]).sum::<f64>();
        }
        let compliance = sum * self.plate.length_m * self.plate.width_m / (4.0 * self.rigidity_n_m);
        if compliance.is_finite() { Ok(compliance) } else { Err(unresolved()) }
    }
}

fn unresolved() -> InvalidInput {
    InvalidInput::new("width_m", "as given", "a shape of the plate for which double precision resolves the modes")
}

impl Block {
    /// The elastic modes of the block, at most `count`, lowest first.
    fn modes(&self, count: usize) -> Option<Vec<Found>> {
        let n = self.pairs.len();
        let factor = Llt::new(self.factored.as_ref(), Side::Lower).ok()?;
        // the mass without the rigid-body motions, whose 1/omega^2 is then zero
        let mut reduced = Mat::from_fn(n, n, |p, q| {
            let taken: f64 = self.rigid.iter().map(|motion| motion[p] * motion[q]).sum();
            (self.mass[(p, q)] - taken) * self.scale[p] * self.scale[q]
        });
        factor.L().solve_lower_triangular_in_place(reduced.as_mut());
        let mut reduced = reduced.transpose().to_owned();
        factor.L().solve_lower_triangular_in_place(reduced.as_mut());
        let eigen = SelfAdjointEigen::new(reduced.as_ref(), Side::Lower).ok()?;
        let kept = count.min(n - self.rigid.len().min(n));
        let mut vectors = Mat::from_fn(n, kept, |p, k| eigen.U()[(p, n - 1 - k)]);
        factor.L().transpose().solve_upper_triangular_in_place(vectors.as_mut());
        let inverse: Vec<f64> = (0..kept).map(|k| eigen.S()[n - 1 - k]).collect();
        if !inverse.iter().all(|mu| *mu > 0.0 && mu.is_finite()) {
            return None;
        }
        let mut shapes = Mat::from_fn(n, kept, |p, k| vectors[(p, k)] * self.scale[p] / inverse[k].sqrt());
        for k in 0..kept {
            let largest =
                (0..n).map(|p| shapes[(p, k)]).fold(0.0, |best: f64, c| if c.abs() > best.abs() { c } else { best });
            if largest < 0.0 {
                (0..n).for_each(|p| shapes[(p, k)] = -shapes[(p, k)]);
            }
        }
        let change = self.change(&shapes, &inverse);
        let found = |k: usize| Found {
            omega_rad_s: 1.0 / inverse[k].sqrt(),
            change: change[k],
            product: Product { classes: self.classes, coefficients: (0..n).map(|p| shapes[(p, k)]).collect() },
        };
        Some((0..kept).map(found).collect())
    }

    /// Rayleigh's quotient of each shape without its highest functions, against the frequency.
    fn change(&self, shapes: &Mat<f64>, inverse: &[f64]) -> Vec<f64> {
        let last = |which: usize| self.pairs.iter().map(|pair| pair[which]).max().unwrap_or(0);
        let (i_last, j_last) = (last(0), last(1));
        let cut = Mat::from_fn(shapes.nrows(), shapes.ncols(), |p, k| {
            let [i, j] = self.pairs[p];
            if i + 2 > i_last || j + 2 > j_last { 0.0 } else { shapes[(p, k)] }
        });
        let (stiff, heavy) = (&self.stiffness * &cut, &self.mass * &cut);
        let quotient = |k: usize| {
            let inner = |with: &Mat<f64>| (0..cut.nrows()).map(|p| cut[(p, k)] * with[(p, k)]).sum::<f64>();
            let square = inner(&stiff) / inner(&heavy) * inverse[k];
            if square.is_finite() { (square.sqrt() - 1.0).max(0.0) } else { f64::INFINITY }
        };
        (0..inverse.len()).map(quotient).collect()
    }
}
