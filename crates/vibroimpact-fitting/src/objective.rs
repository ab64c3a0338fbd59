//! The residuals as functions of the unrestricted coordinates `u`.

use crate::parameter::Parameter;
use crate::problem::Problem;
use std::cell::Cell;

/// Replaces a residual that is not finite, or larger; a step to such a point is always rejected.
pub(crate) const HUGE: f64 = 1e100;

/// Weighted residuals `sqrt(w_i) r_i(p(u))` and their Jacobian in `u`.
pub(crate) struct Objective<'a> {
    pub(crate) problem: &'a Problem<'a>,
    /// Square roots of the weights, or 1. A residual of weight 0 is omitted.
    root_weights: Option<Vec<f64>>,
    pub(crate) evaluations: Cell<usize>,
    pub(crate) jacobians: Cell<usize>,
}

impl<'a> Objective<'a> {
    pub(crate) fn new(problem: &'a Problem<'a>, weights: Option<&[f64]>) -> Objective<'a> {
        let root_weights = weights.map(|weights| weights.iter().map(|w| w.sqrt()).collect());
        Objective { problem, root_weights, evaluations: Cell::new(0), jacobians: Cell::new(0) }
    }

    /// Size of a change of each coordinate that matters.
    pub(crate) fn units(&self) -> Vec<f64> {
        self.problem.parameters.iter().map(Parameter::unit).collect()
    }

    pub(crate) fn parameters(&self, u: &[f64]) -> Vec<f64> {
        self.problem.parameters.iter().zip(u).map(|(parameter, &u)| parameter.outward(u)).collect()
    }

    /// Writes the residuals. Numbers that are too large become [`HUGE`]; `false` if there were any.
    pub(crate) fn residuals(&self, u: &[f64], residuals: &mut [f64]) -> bool {
        self.evaluations.set(self.evaluations.get() + 1);
        // Residuals that the closure does not write count as not finite.
        residuals.fill(f64::NAN);
        (self.problem.residuals)(&self.parameters(u), residuals);
        let mut sound = true;
        for (i, r) in residuals.iter_mut().enumerate() {
            let weight = self.root_weights.as_ref().map_or(1.0, |weights| weights[i]);
            if weight == 0.0 {
                *r = 0.0;
            } else if r.abs() < HUGE {
                *r *= weight;
            } else {
                (*r, sound) = (HUGE, false);
            }
        }
        sound
    }

    /// Sum of squares, or infinity where a residual is not finite.
    pub(crate) fn sum_of_squares(&self, u: &[f64], residuals: &mut [f64]) -> f64 {
        if self.residuals(u, residuals) { residuals.iter().map(|r| r * r).sum() } else { f64::INFINITY }
    }

    /// Writes `d r_i / d u_j` at `i * n + j`, analytic if given, otherwise by central differences. Entries that are not finite
    /// become 0, which excludes their parameter from the step.
    pub(crate) fn jacobian(&self, u: &[f64], jacobian: &mut [f64]) {
        self.jacobians.set(self.jacobians.get() + 1);
        let n = u.len();
        match self.problem.jacobian {
            Some(closure) => {
                let p = self.parameters(u);
                jacobian.fill(f64::NAN);
                closure(&p, jacobian);
                let slopes: Vec<f64> =
                    self.problem.parameters.iter().zip(&p).map(|(parameter, &p)| parameter.slope(p)).collect();
                for (i, row) in jacobian.chunks_exact_mut(n).enumerate() {
                    let weight = self.root_weights.as_ref().map_or(1.0, |weights| weights[i]);
                    for (entry, slope) in row.iter_mut().zip(&slopes) {
                        *entry *= weight * slope;
                    }
                }
            }
            None => self.differences(u, jacobian),
        }
        for entry in jacobian {
            if entry.is_nan() || entry.abs() >= HUGE {
                *entry = 0.0;
            }
        }
    }

    fn differences(&self, u: &[f64], jacobian: &mut [f64]) {
        let n = u.len();
        let mut shifted = u.to_vec();
        let (mut above, mut below) = (vec![0.0; self.problem.count], vec![0.0; self.problem.count]);
        for (j, parameter) in self.problem.parameters.iter().enumerate() {
            let step = f64::EPSILON.cbrt() * u[j].abs().max(parameter.unit());
            shifted[j] = u[j] + step;
            self.residuals(&shifted, &mut above);
            shifted[j] = u[j] - step;
            self.residuals(&shifted, &mut below);
            shifted[j] = u[j];
            for i in 0..self.problem.count {
                jacobian[i * n + j] = (above[i] - below[i]) / (2.0 * step);
            }
        }
    }
}
