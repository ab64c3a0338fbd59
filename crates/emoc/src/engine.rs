//! The solution of a sequence of quadratic programs.

use crate::active_set;
use crate::program::{Entry, Program};
use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;
use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::NonnegativeConeT;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus};

/// A minimiser.
#[derive(Debug, Clone)]
pub(crate) struct Minimum {
    pub(crate) x: Vec<f64>,
    /// Whether its active rows prove it to the last digits; otherwise it is the interior-point iterate.
    pub(crate) proven: bool,
}

/// The reason why there is no minimum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Failure {
    /// No point satisfies all rows.
    Infeasible,
    /// The objective has no lower bound.
    Unbounded,
    /// The solver stopped early, for this reason.
    Stopped(&'static str),
}

/// Solves programs one after the other. While the pattern stays the same it first tries the rows that were active last time,
/// which costs one factorisation instead of an iteration. If that fails, Clarabel runs and reuses its ordering, symbolic
/// factorisation and memory. Its iteration starts anew each time, as an interior-point method must.
#[derive(Default)]
pub(crate) struct Engine {
    kept: Option<Kept>,
}

struct Kept {
    pattern: [Pattern; 2],
    solver: Box<DefaultSolver<f64>>,
    active: Option<Vec<bool>>,
}

/// Starts of the columns, and row indices.
type Pattern = (Vec<usize>, Vec<usize>);

impl Engine {
    /// The minimiser: proven on its active rows if possible, otherwise Clarabel's result.
    pub(crate) fn minimise(&mut self, program: &Program) -> Result<Minimum, Failure> {
        let n = program.linear.len();
        let hessian = columns(n, n, &program.hessian);
        let rows = columns(program.bounds.len(), n, &program.rows);
        let pattern = [(hessian.colptr.clone(), hessian.rowval.clone()), (rows.colptr.clone(), rows.rowval.clone())];
        if let Some(kept) = self.kept.as_mut().filter(|kept| kept.pattern == pattern) {
            if let Some(proven) = kept.active.as_ref().and_then(|guess| active_set::minimise(program, guess)) {
                kept.active = Some(proven.active);
                return Ok(Minimum { x: proven.x, proven: true });
            }
            let updated = kept.solver.update_data(&hessian.nzval, &program.linear, &rows.nzval, &program.bounds);
            if updated.is_ok() {
                kept.solver.solve();
                // The previous scaling may not suit the new numbers: only a solution counts, otherwise the solver is set up
                // again.
                if kept.solver.solution.status == SolverStatus::Solved {
                    return kept.finish(program);
                }
            }
        }
        let cones = [NonnegativeConeT(program.bounds.len())];
        let run = |tolerance: f64| {
            let settings = settings(tolerance);
            let solver = DefaultSolver::new(&hessian, &program.linear, &rows, &program.bounds, &cones, settings);
            let mut solver = solver.map_err(|_| Failure::Stopped("the solver refused the data"))?;
            solver.solve();
            Ok(Kept { pattern: pattern.clone(), solver: Box::new(solver), active: None })
        };
        match self.kept.insert(run(1e-12)?).finish(program) {
            // With a lower accuracy required, it can distinguish a minimum from infeasibility.
            Err(Failure::Stopped(_)) => self.kept.insert(run(1e-8)?).finish(program),
            result => result,
        }
    }
}

impl Kept {
    /// Completes Clarabel's result on the rows whose multiplier exceeds their slack; if it stalled too early for that, starting
    /// without any active row.
    fn finish(&mut self, program: &Program) -> Result<Minimum, Failure> {
        let found = &self.solver.solution;
        let guess: Vec<bool> = found.z.iter().zip(&found.s).map(|(z, s)| z > s).collect();
        let none = vec![false; guess.len()];
        let proven = active_set::minimise(program, &guess).or_else(|| active_set::minimise(program, &none));
        if let Some(proven) = proven {
            self.active = Some(proven.active);
            return Ok(Minimum { x: proven.x, proven: true });
        }
        self.active = None;
        match found.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => Ok(Minimum { x: found.x.clone(), proven: false }),
            SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => Err(Failure::Infeasible),
            SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => Err(Failure::Unbounded),
            SolverStatus::MaxIterations => Err(Failure::Stopped("iteration limit")),
            SolverStatus::NumericalError => Err(Failure::Stopped("numerical error")),
            _ => Err(Failure::Stopped("no progress")),
        }
    }
}

/// One thread, no output, no change of the pattern; for "almost solved" a thousand times the tolerance is allowed. By the tolerances of
/// Clarabel itself the first iterates of a program with a minimum can pass for a proof that it has none.
fn settings(tolerance: f64) -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        max_threads: 1,
        presolve_enable: false,
        tol_gap_abs: tolerance,
        tol_gap_rel: tolerance,
        tol_feas: tolerance,
        tol_infeas_abs: tolerance,
        tol_infeas_rel: tolerance,
        reduced_tol_gap_abs: 1e3 * tolerance,
        reduced_tol_gap_rel: 1e3 * tolerance,
        reduced_tol_feas: 1e3 * tolerance,
        reduced_tol_infeas_abs: 1e3 * tolerance,
        reduced_tol_infeas_rel: 1e3 * tolerance,
        ..DefaultSettings::default()
    }
}

/// Entries as compressed columns; zeros are stored.
fn columns(rows: usize, columns: usize, entries: &[Entry]) -> CscMatrix<f64> {
    let mut sorted = entries.to_vec();
    sorted.sort_unstable_by_key(|&(row, column, _)| (column, row));
    let mut starts = vec![0; columns + 1];
    for &(_, column, _) in &sorted {
        starts[column + 1] += 1;
    }
    for j in 0..columns {
        starts[j + 1] += starts[j];
    }
    let row_indices = sorted.iter().map(|entry| entry.0).collect();
    let values = sorted.iter().map(|entry| entry.2).collect();
    CscMatrix::new(rows, columns, starts, row_indices, values)
}
