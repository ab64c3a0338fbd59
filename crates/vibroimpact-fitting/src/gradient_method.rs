//! Levenberg-Marquardt, by the crate `levenberg-marquardt` (a port of MINPACK's `lmder`).

use crate::objective::Objective;
use crate::problem::Settings;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::{DMatrix, DVector, Dyn, U1, VecStorage};

struct Adapter<'a> {
    objective: &'a Objective<'a>,
    u: DVector<f64>,
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Adapter<'_> {
    type ResidualStorage = VecStorage<f64, Dyn, U1>;
    type JacobianStorage = VecStorage<f64, Dyn, Dyn>;
    type ParameterStorage = VecStorage<f64, Dyn, U1>;

    fn set_params(&mut self, u: &DVector<f64>) {
        self.u.copy_from(u);
    }

    fn params(&self) -> DVector<f64> {
        self.u.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let mut residuals = DVector::zeros(self.objective.problem.count);
        self.objective.residuals(self.u.as_slice(), residuals.as_mut_slice());
        Some(residuals)
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let (m, n) = (self.objective.problem.count, self.u.len());
        let mut rows = vec![0.0; m * n];
        self.objective.jacobian(self.u.as_slice(), &mut rows);
        Some(DMatrix::from_row_slice(m, n, &rows))
    }
}

/// The point reached from `start`, and whether it is a minimum by the tests of the method.
pub(crate) fn minimise(objective: &Objective, start: &[f64], settings: &Settings) -> (Vec<f64>, bool) {
    let patience = (settings.max_evaluations / (start.len() + 1)).max(1);
    let method = LevenbergMarquardt::new()
        .with_ftol(settings.tolerance)
        .with_xtol(settings.tolerance)
        .with_gtol(settings.tolerance)
        .with_patience(patience);
    let (adapter, report) = method.minimize(Adapter { objective, u: DVector::from_column_slice(start) });
    // Tolerances near rounding end with "no improvement possible".
    let ended = matches!(report.termination, TerminationReason::NoImprovementPossible(_));
    (adapter.u.as_slice().to_vec(), report.termination.was_successful() || ended)
}
