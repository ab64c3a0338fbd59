//! A quadratic program.

use alloc::vec;
use alloc::vec::Vec;

/// Minimise `x^T H x / 2 + linear . x` subject to `row . x <= bound` for every row.
///
/// Zero coefficients are stored as entries: the pattern then depends on the kind of problem only, and a solver that was set up
/// for one problem can be used with the numbers of the next.
#[derive(Debug, Default)]
pub(crate) struct Program {
    pub(crate) linear: Vec<f64>,
    pub(crate) hessian: Vec<Entry>,
    pub(crate) rows: Vec<Entry>,
    pub(crate) bounds: Vec<f64>,
}

/// Row, column and value; of the symmetric `H` only the upper triangle.
pub(crate) type Entry = (usize, usize, f64);

impl Program {
    pub(crate) fn new(variables: usize) -> Program {
        Program { linear: vec![0.0; variables], ..Program::default() }
    }

    /// Adds `h x_i x_j` to `x^T H x`, with one call per pair, `i <= j`.
    pub(crate) fn quadratic(&mut self, i: usize, j: usize, h: f64) {
        self.hessian.push((i, j, h));
    }

    pub(crate) fn linear(&mut self, i: usize, c: f64) {
        self.linear[i] = c;
    }

    /// Multiplies the objective, which changes the unit of energy but not the minimiser.
    pub(crate) fn scale_objective(&mut self, factor: f64) {
        self.linear.iter_mut().for_each(|c| *c *= factor);
        self.hessian.iter_mut().for_each(|entry| entry.2 *= factor);
    }

    /// Adds the row `sum coefficient * x <= bound`, each variable at most once.
    pub(crate) fn at_most(&mut self, row: impl IntoIterator<Item = (usize, f64)>, bound: f64) {
        let i = self.bounds.len();
        self.rows.extend(row.into_iter().map(|(j, a)| (i, j, a)));
        self.bounds.push(bound);
    }

    /// Adds the row `sum coefficient * x >= bound`.
    pub(crate) fn at_least(&mut self, row: impl IntoIterator<Item = (usize, f64)>, bound: f64) {
        self.at_most(row.into_iter().map(|(j, a)| (j, -a)), -bound);
    }
}
