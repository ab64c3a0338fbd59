//! One block of Ritz's problem: the products of the functions of two classes.
//!
//! Each function has a nonzero integral with only a few neighbours. Stiffness and mass are therefore sparse, and block
//! tridiagonal if the functions along the plate are grouped so that each group contains all neighbours of the one before it.

use super::band::Factor;
use super::lanczos::largest;
use super::line::Products;
use super::modes::Product;
use faer::{Mat, MatMut};

/// Relative change of a frequency by rounding.
const ROUNDING: f64 = 1e-11;

/// The first coefficient of a shape that is larger than this share of the largest determines the sign.
const LEADING: f64 = 0.5;

/// An entry of stiffness and mass, made dimensionless by `D` and by the mass.
struct Entry {
    row: usize,
    column: usize,
    stiffness: f64,
    mass: f64,
}

/// A rigid-body motion in the block: the product of functions, its coefficient, and the mass times the motion.
pub(super) struct Rigid {
    pub row: usize,
    pub size: f64,
    pub momentum: Vec<f64>,
}

/// A computed mode with its dimensionless frequency.
pub(super) struct Found {
    pub omega: f64,
    pub change: f64,
    pub product: Product,
}

pub(super) struct Block {
    pub classes: [usize; 2],
    /// The products of functions, by their indices.
    pub pairs: Vec<[usize; 2]>,
    pub rigid: Vec<Rigid>,
    entries: Vec<Entry>,
    /// The factor of the stiffness with rigid-body motions constrained and rows and columns multiplied by `scale`, which makes
    /// its diagonal 1.
    factor: Factor,
    scale: Vec<f64>,
}

/// The indices of the functions, among `functions`, with which each has a nonzero integral.
fn neighbours(products: &Products, functions: &[usize]) -> Vec<Vec<usize>> {
    let Products { values, slopes, curvatures, mixed } = products;
    let shares = |i: usize, k: usize| {
        [values, slopes, curvatures, mixed].iter().any(|table| table[i][k] != 0.0) || mixed[k][i] != 0.0
    };
    let of = |i: &usize| (0..functions.len()).filter(|k| shares(*i, functions[*k])).collect();
    functions.iter().map(of).collect()
}

impl Block {
    /// The block of the functions of two classes, from the square of width over length, Poisson's ratio, and the rigid-body
    /// motions as products of functions with their coefficients. `None` if the stiffness is not positive definite in double
    /// precision.
    pub fn new(
        classes: [usize; 2],
        functions: [&[usize]; 2],
        [x, y]: &[Products; 2],
        ratio: f64,
        nu: f64,
        motions: &[([usize; 2], f64)],
    ) -> Option<Block> {
        let [rows, columns] = functions;
        let pairs: Vec<[usize; 2]> = rows.iter().flat_map(|i| columns.iter().map(move |j| [*i, *j])).collect();
        let (along, across) = (neighbours(x, rows), neighbours(y, columns));
        let width = columns.len();
        let mut entries = Vec::new();
        for (row, [i, j]) in pairs.iter().copied().enumerate() {
            for (p, q) in along[row / width].iter().flat_map(|p| across[row % width].iter().map(move |q| (*p, *q))) {
                let column = p * width + q;
                let [k, l] = pairs[column];
                let stiffness = ratio * x.curvatures[i][k] * y.values[j][l]
                    + x.values[i][k] * y.curvatures[j][l] / ratio
                    + nu * (x.mixed[i][k] * y.mixed[l][j] + x.mixed[k][i] * y.mixed[j][l])
                    + 2.0 * (1.0 - nu) * x.slopes[i][k] * y.slopes[j][l];
                entries.push(Entry { row, column, stiffness, mass: 0.25 * x.values[i][k] * y.values[j][l] });
            }
        }
        let rigid: Vec<Rigid> = motions
            .iter()
            .filter_map(|(pair, size)| pairs.iter().position(|other| other == pair).map(|row| (row, *size)))
            .map(|(row, size)| {
                let mut momentum = vec![0.0; pairs.len()];
                let of_row = entries.iter().filter(|entry| entry.column == row);
                of_row.for_each(|entry| momentum[entry.row] = size * entry.mass);
                Rigid { row, size, momentum }
            })
            .collect();
        // A stiffness of the order of the plate's own constrains the rigid-body motions, which have nonzero integrals with the
        // neighbours of the first functions only.
        let held = 10.0 * ratio.min(1.0 / ratio);
        let moved = |Rigid { momentum, .. }: &Rigid| -> Vec<(usize, f64)> {
            momentum.iter().copied().enumerate().filter(|(_, value)| *value != 0.0).collect()
        };
        let springs = rigid.iter().map(moved).flat_map(|moved| {
            let pair = |(p, a): (usize, f64)| moved.iter().map(move |(q, b)| (p, *q, held * a * b)).collect::<Vec<_>>();
            moved.iter().copied().flat_map(pair).collect::<Vec<_>>()
        });
        let stiff = entries.iter().map(|entry| (entry.row, entry.column, entry.stiffness));
        let factored: Vec<(usize, usize, f64)> = stiff.chain(springs).collect();
        let mut diagonal = vec![0.0; pairs.len()];
        factored.iter().filter(|(p, q, _)| p == q).for_each(|(p, _, value)| diagonal[*p] += value);
        let scale: Vec<f64> = diagonal.iter().map(|value| 1.0 / value.sqrt()).collect();
        let scaled = factored.iter().map(|(p, q, value)| (*p, *q, value * scale[*p] * scale[*q]));
        let factor = Factor::new(groups(&along, width), scaled)?;
        Some(Block { classes, pairs, rigid, entries, factor, scale })
    }

    /// Number of elastic modes of the block.
    pub fn elastic_count(&self) -> usize {
        self.pairs.len() - self.rigid.len().min(self.pairs.len())
    }

    /// The elastic modes of the block, at most `count`, lowest first.
    pub fn modes(&self, count: usize) -> Option<Vec<Found>> {
        let n = self.pairs.len();
        let (inverse, mut vectors) = largest(n, count.min(self.elastic_count()), |columns| self.flexibility(columns))?;
        self.factor.solve_transposed(vectors.as_mut());
        let last = [0, 1].map(|which| self.pairs.iter().map(|pair| pair[which]).max().unwrap_or(0));
        let high = |[i, j]: &[usize; 2]| i + 2 > last[0] || j + 2 > last[1];
        let mode = |k: usize| {
            let mut shape: Vec<f64> = (0..n).map(|p| vectors[(p, k)] * self.scale[p]).collect();
            // in symmetric plates several coefficients are equally large, and rounding would choose among them
            let largest = shape.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
            let leading = shape.iter().find(|c| c.abs() > LEADING * largest).copied().unwrap_or(1.0);
            // The error of a Lanczos eigenvalue is relative to the largest one; Rayleigh's quotient of the shape is more
            // accurate.
            let [stiffness, mass] = self.energies(&shape);
            let square = stiffness / mass;
            let size = leading.signum() / mass.sqrt();
            shape.iter_mut().for_each(|c| *c *= size);
            let cut: Vec<f64> =
                self.pairs.iter().zip(&shape).map(|(pair, c)| if high(pair) { 0.0 } else { *c }).collect();
            let [stiffness, mass] = self.energies(&cut);
            let without = stiffness / mass / square;
            let change = if without.is_finite() { (without.sqrt() - 1.0).max(ROUNDING) } else { f64::INFINITY };
            let product = Product { classes: self.classes, coefficients: shape };
            (square > 0.0 && square.is_finite()).then(|| Found { omega: square.sqrt(), change, product })
        };
        (0..inverse.len()).map(mode).collect()
    }

    /// Twice the potential energy and twice the kinetic energy of a shape at unit frequency.
    fn energies(&self, shape: &[f64]) -> [f64; 2] {
        let (mut stiff, mut heavy) = (0.0, 0.0);
        for Entry { row, column, stiffness, mass } in &self.entries {
            let product = shape[*row] * shape[*column];
            stiff += stiffness * product;
            heavy += mass * product;
        }
        [stiff, heavy]
    }

    /// Replaces columns `x` by `L^(-1) M L^(-T) x`, with `L` the Cholesky factor of the stiffness and `M` the mass without the
    /// rigid-body motions, whose `1/omega^2` is then zero.
    fn flexibility(&self, mut columns: MatMut<'_, f64>) {
        self.factor.solve_transposed(columns.as_mut());
        let n = self.pairs.len();
        let mut from = vec![0.0; n];
        let mut into = vec![0.0; n];
        for k in 0..columns.ncols() {
            for p in 0..n {
                from[p] = self.scale[p] * columns[(p, k)];
                into[p] = 0.0;
            }
            for entry in &self.entries {
                into[entry.row] += entry.mass * from[entry.column];
            }
            for Rigid { momentum, .. } in &self.rigid {
                let inner: f64 = momentum.iter().zip(&from).map(|(m, x)| m * x).sum();
                into.iter_mut().zip(momentum).for_each(|(y, m)| *y -= inner * m);
            }
            for p in 0..n {
                columns[(p, k)] = self.scale[p] * into[p];
            }
        }
        self.factor.solve(columns);
    }

    /// The work of a load, given by its work on every product of functions, on its own static deflection.
    pub fn work(&self, load: &[f64]) -> f64 {
        let mut scaled = Mat::from_fn(load.len(), 1, |p, _| load[p] * self.scale[p]);
        self.factor.solve(scaled.as_mut());
        scaled.col(0).squared_norm_l2()
    }
}

/// Starts of the groups of products, from the neighbours of the functions along the plate and the number of those across: the
/// first group is the first function, each further one contains the neighbours of the group before.
fn groups(along: &[Vec<usize>], width: usize) -> Vec<usize> {
    let (mut starts, mut begin, mut end) = (vec![0], 0, 1);
    while begin < along.len() {
        starts.push(end * width);
        let reached = along[begin..end].iter().flatten().max().map_or(end, |last| last + 1);
        (begin, end) = (end, reached.max(end + 1).min(along.len()));
    }
    starts
}
