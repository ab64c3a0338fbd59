//! Ritz's method for thin plates with any edges.
//!
//! With `s` and `t` from -1 to 1 along and across, stiffness and mass of products `f_i(s) g_j(t)` are Kronecker products
//! of one-dimensional integrals (A. W. Leissa, *J. Sound Vib.* 31 (1973) 257, eq. 13 for the energy):
//!
//! ```text
//! U = D/2 int w_xx^2 + w_yy^2 + 2 nu w_xx w_yy + 2 (1 - nu) w_xy^2 dA.
//! ```
//!
//! The eigenproblem is solved for `1/omega^2`, whose largest values belong to the lowest modes (`block.rs`); Rayleigh's
//! quotient of each shape then gives its frequency to within 1e-11. Rigid-body motions, known exactly, are removed beforehand.
//! Equal conditions on opposite edges divide the problem into two, or four.

use super::block::{Block, Found, Rigid};
use super::definition::{Edge, Plate};
use super::line::{Line, Products};
use super::modes::{Kind, PlateModes, Product, lines};
use invalid_input::InvalidInput;
use std::f64::consts::PI;

/// Largest number of functions in one block.
const MOST_ROWS: usize = 3000;

pub(super) struct Ritz<'a> {
    plate: &'a Plate,
    degrees: [usize; 2],
    lines: [Line; 2],
    products: [Products; 2],
    rigidity_n_m: f64,
}

impl<'a> Ritz<'a> {
    /// Degrees that resolve the first `count` modes, if matrices of a reasonable size do. The degree must exceed the wave
    /// number times half the length by an amount that grows as its cube root.
    pub fn degrees(plate: &Plate, count: usize) -> Option<[usize; 2]> {
        let (a, b) = (plate.length_m, plate.width_m);
        // Weyl: N = a b k^2/(4 pi) minus the effect of the edges; half a wave for a pinned one, more for a clamped one.
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

    /// Degrees for the static deflection of a square, in a constant ratio.
    pub const STATIC_DEGREES: [usize; 3] = [24, 36, 54];

    /// Degrees for the static deflection: more along the longer side, as long as matrices stay small.
    pub fn static_degrees(plate: &Plate, of_square: usize) -> [usize; 2] {
        let ratio = (plate.length_m / plate.width_m).clamp(0.25, 4.0).sqrt();
        // Even, so that both parities have the same number of functions.
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

    /// Indices of the functions of two classes.
    fn functions(&self, classes: [usize; 2]) -> [&[usize]; 2] {
        [0, 1].map(|which| &self.lines[which].classes[classes[which]][..])
    }

    fn block(&self, classes: [usize; 2]) -> Result<Block, InvalidInput> {
        let ratio = (self.plate.width_m / self.plate.length_m).powi(2);
        Block::new(classes, self.functions(classes), &self.products, ratio, self.plate.poissons_ratio, &self.rigid())
            .ok_or_else(unresolved)
    }

    /// Rigid-body motions, orthonormal in mass: the product of functions, and its coefficient.
    fn rigid(&self) -> Vec<([usize; 2], f64)> {
        let root = 3f64.sqrt();
        match self.plate.rigid_body_count() {
            3 => vec![([0, 0], 1.0), ([1, 0], root), ([0, 1], root)],
            // 1 + s from a pinned edge.
            1 => vec![([0, 0], 0.5 * root)],
            _ => Vec::new(),
        }
    }

    /// From the dimensionless problem to (rad/s)^2.
    fn square_frequency(&self) -> f64 {
        4.0 * self.rigidity_n_m / (self.plate.length_m * self.plate.width_m) / self.plate.mass_kg()
    }

    /// The first `count` elastic modes, if there are as many.
    fn elastic(&self, count: usize) -> Result<Vec<Found>, InvalidInput> {
        let blocks = self.classes().into_iter().map(|classes| self.block(classes)).collect::<Result<Vec<_>, _>>()?;
        let rows: usize = blocks.iter().map(|block| block.pairs.len()).sum();
        // Modes are distributed over the blocks nearly in the ratio of their functions.
        let share = |block: &Block| 1.1 * (count * block.pairs.len()) as f64 / rows as f64 + 4.0;
        let modes = |block: &Block, wanted: usize| block.modes(wanted).ok_or_else(unresolved);
        let mut parts = blocks
            .iter()
            .map(|block| modes(block, if blocks.len() == 1 { count } else { share(block) as usize }))
            .collect::<Result<Vec<_>, _>>()?;
        loop {
            let mut all: Vec<f64> = parts.iter().flatten().map(|mode| mode.omega).collect();
            all.sort_by(f64::total_cmp);
            let highest = if count == 0 { 0.0 } else { all.get(count - 1).copied().unwrap_or(f64::INFINITY) };
            // A block whose last mode is among the first ones may contain more of them.
            let mut complete = true;
            for (block, part) in blocks.iter().zip(&mut parts) {
                if part.len() < count.min(block.elastic_count()) && part.last().is_none_or(|mode| mode.omega < highest)
                {
                    *part = modes(block, count.min(part.len() + part.len() / 4 + 4))?;
                    complete = false;
                }
            }
            if complete {
                break;
            }
        }
        let mut found: Vec<Found> = parts.into_iter().flatten().collect();
        found.sort_by(|p, q| p.omega.total_cmp(&q.omega));
        found.truncate(count);
        Ok(found)
    }

    /// The first `count` modes.
    pub fn modes(&self, count: usize) -> Result<PlateModes, InvalidInput> {
        let size = 1.0 / self.plate.mass_kg().sqrt();
        let (mut omega_rad_s, mut change, mut shapes) = (Vec::new(), Vec::new(), Vec::new());
        for (pair, coefficient) in self.rigid() {
            for classes in self.classes() {
                let [rows, columns] = self.functions(classes);
                let place = (rows.iter().position(|i| *i == pair[0]), columns.iter().position(|j| *j == pair[1]));
                let (Some(row), Some(column)) = place else { continue };
                let mut coefficients = vec![0.0; rows.len() * columns.len()];
                coefficients[row * columns.len() + column] = size * coefficient;
                omega_rad_s.push(0.0);
                change.push(0.0);
                shapes.push(Product { classes, coefficients });
            }
        }
        let rigid = shapes.len().min(count);
        for mut mode in self.elastic(count - rigid)? {
            omega_rad_s.push(mode.omega * self.square_frequency().sqrt());
            change.push(mode.change);
            mode.product.coefficients.iter_mut().for_each(|c| *c *= size);
            shapes.push(mode.product);
        }
        if shapes.len() < count {
            return Err(unresolved());
        }
        omega_rad_s.truncate(count);
        change.truncate(count);
        shapes.truncate(count);
        let kind = Kind::Polynomials { degrees: self.degrees, shapes };
        Ok(PlateModes { plate: *self.plate, rigid, omega_rad_s, change, kind })
    }

    /// Static deflection under a unit load at a location, in shares of length and width; that of the elastic modes alone.
    pub fn static_compliance(&self, x: f64, y: f64) -> Result<f64, InvalidInput> {
        let (along, across) = (self.lines[0].values(2.0 * x - 1.0), self.lines[1].values(2.0 * y - 1.0));
        let mut sum = 0.0;
        for classes in self.classes() {
            let block = self.block(classes)?;
            let values: Vec<f64> = block.pairs.iter().map(|[i, j]| along[*i] * across[*j]).collect();
            // The load minus the inertia of the rigid-body motions that it causes.
            let mut load = values.clone();
            for Rigid { row, size, momentum } in &block.rigid {
                load.iter_mut().zip(momentum).for_each(|(force, m)| *force -= m * size * values[*row]);
            }
            sum += block.work(&load);
        }
        let compliance = sum * self.plate.length_m * self.plate.width_m / (4.0 * self.rigidity_n_m);
        if compliance.is_finite() { Ok(compliance) } else { Err(unresolved()) }
    }
}

fn unresolved() -> InvalidInput {
    InvalidInput::new("width_m", "as given", "closer to length_m, so that double precision can resolve the modes")
}

#[cfg(test)]
mod tests {
    use super::super::{PlateTheory, navier};
    use super::*;

    /// For a plate pinned along all edges the frequencies have a closed form: none is missing, and the stated change bounds the
    /// error of each.
    #[test]
    fn frequencies_are_navier_s_within_the_stated_change() {
        let plate = Plate {
            length_m: 0.4,
            width_m: 0.3,
            thickness_m: 0.005,
            youngs_modulus_pa: 2e11,
            poissons_ratio: 0.3,
            density_kg_m3: 7800.0,
            edges: [Edge::Pinned; 4],
            theory: PlateTheory::Kirchhoff,
        };
        let count = 300;
        let exact = navier::modes(&plate, count);
        let found = Ritz::new(&plate, Ritz::degrees(&plate, count).unwrap()).modes(count).unwrap();
        for (k, (omega, theirs)) in found.omega_rad_s().iter().zip(exact.omega_rad_s()).enumerate() {
            let (error, stated) = (omega / theirs - 1.0, found.change()[k]);
            assert!(error.abs() < stated, "{k}: {error:e} {stated:e}");
        }
    }
}
