//! Net restitution by EMOC: the closed form and quadratic programming.
//!
//! The impacts have masses, shapes and coefficients in small integers and halves, so that the conditions of optimality can be
//! solved exactly: on the basic branch `e = ebar/(1+Z)`, on the outward branch both inequalities are equalities. The references
//! are these rational numbers.

use crate::measure::{Effort, Found, Origin, Row, Solver, sweep};
use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::NonnegativeConeT;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus};
use emoc::{Coefficients, SingleImpact, lcp};

struct Case {
    name: &'static str,
    phi: Vec<f64>,
    mass_kg: f64,
    coefficients: Coefficients<f64>,
    /// Numerator and denominator.
    reference: (f64, f64),
}

fn cases() -> Vec<Case> {
    let shapes = |n: usize| (0..n).map(|k| [1.0, -0.5, 0.5, 1.5][k % 4]).collect::<Vec<f64>>();

    vec![
        Case {
            name: "emoc-N8-basic",
            phi: shapes(8),
            mass_kg: 0.5,
            coefficients: Coefficients { ebar: 0.875, beta0: 0.125, beta1: 0.0 },
            // sum phi^2 = 7.5, Z = 3.75, 0.875 / 4.75.
            reference: (3.5, 19.0),
        },
        Case {
            name: "emoc-N40-outward",
            phi: shapes(40),
            mass_kg: 0.5,
            coefficients: Coefficients { ebar: 0.875, beta0: 0.5, beta1: 0.25 },
            // 0.875 * 0.75 / 1.5.
            reference: (7.0, 16.0),
        },
    ]
}

/// `min x.H x/2` with diagonal `H`, subject to `rows x >= bounds`: problem P_1 (thesis 6.8 to 6.13) in `v`, `a'`, `c`
/// with the speed of approach as unit, `c` bounding `|a'|`, and half of the modal energy on each of `a'` and `c`.
struct Program {
    diagonal: Vec<f64>,
    rows: Vec<Vec<f64>>,
    bounds: Vec<f64>,
}

impl Program {
    fn new(case: &Case) -> Program {
        let n = case.phi.len();
        let Coefficients { ebar, beta0, beta1 } = case.coefficients;
        let m = case.mass_kg;
        // Modal speeds in units of sqrt(m) u.
        let psi: Vec<f64> = case.phi.iter().map(|phi| phi.abs() * m.sqrt()).collect();
        let mut diagonal = vec![0.5; 1 + 2 * n];
        diagonal[0] = 1.0;
        let (mut rows, mut bounds) = (Vec::new(), Vec::new());
        let mut add = |entries: &[(usize, f64)], bound: f64| {
            let mut row = vec![0.0; 1 + 2 * n];
            for &(j, value) in entries {
                row[j] = value;
            }
            rows.push(row);
            bounds.push(bound);
        };
        let with_modes = |first: usize, weight: f64| -> Vec<(usize, f64)> {
            let modes = psi.iter().enumerate().map(|(k, psi)| (first + k, weight * psi));
            [(0, 1.0)].into_iter().chain(modes).collect()
        };
        add(&with_modes(1, -1.0), ebar);
        add(&with_modes(1 + n, -beta0), beta1 * ebar);
        for (k, psi) in psi.iter().enumerate() {
            add(&[(1 + k, 1.0), (1 + n + k, 1.0)], 0.0);
            add(&[(1 + k, -1.0), (1 + n + k, 1.0)], 0.0);
            add(&[(0, *psi), (1 + n + k, -1.0)], -psi);
        }
        Program { diagonal, rows, bounds }
    }

    /// As text for the solvers outside Rust: the diagonal, then a line for each row with its bound in front.
    fn text(&self, case: &Case) -> String {
        let words = |values: &[f64]| values.iter().map(|value| format!(" {value:e}")).collect::<String>();
        let (numerator, denominator) = case.reference;
        let head = format!("name {}\nreference {numerator:e} {denominator:e}\n", case.name);
        let rows = self.rows.iter().zip(&self.bounds).map(|(row, bound)| format!("{bound:e}{}\n", words(row)));
        format!("{head}diagonal{}\n{}", words(&self.diagonal), rows.collect::<String>())
    }

    /// Clarabel's interior point at a tolerance; cost: iterations.
    fn interior_point(&self, tolerance: f64) -> Result<(f64, u64), String> {
        let n = self.diagonal.len();
        let hessian = CscMatrix::new(n, n, (0..=n).collect(), (0..n).collect(), self.diagonal.clone());
        let (mut pointers, mut indices, mut values) = (vec![0], Vec::new(), Vec::new());
        for j in 0..n {
            for (i, row) in self.rows.iter().enumerate().filter(|(_, row)| row[j] != 0.0) {
                indices.push(i);
                values.push(-row[j]);
            }
            pointers.push(indices.len());
        }
        let matrix = CscMatrix::new(self.rows.len(), n, pointers, indices, values);
        let right: Vec<f64> = self.bounds.iter().map(|bound| -bound).collect();
        let settings = DefaultSettings {
            verbose: false,
            tol_gap_abs: tolerance,
            tol_gap_rel: tolerance,
            tol_feas: tolerance,
            ..DefaultSettings::default()
        };
        let linear = vec![0.0; n];
        let cones = [NonnegativeConeT(right.len())];
        let mut solver = DefaultSolver::new(&hessian, &linear, &matrix, &right, &cones, settings)
            .map_err(|error| error.to_string())?;
        solver.solve();
        match solver.solution.status {
            SolverStatus::Solved => Ok((solver.solution.x[0], u64::from(solver.solution.iterations))),
            status => Err(format!("{status:?}")),
        }
    }

    /// The dual program as a linear complementarity problem, by complementary pivoting: an active-set method.
    fn pivoting(&self) -> Result<f64, String> {
        let m = self.rows.len();
        let mut matrix = vec![0.0; m * m];
        for i in 0..m {
            for j in 0..m {
                matrix[i * m + j] =
                    (0..self.diagonal.len()).map(|k| self.rows[i][k] * self.rows[j][k] / self.diagonal[k]).sum();
            }
        }
        let right: Vec<f64> = self.bounds.iter().map(|bound| -bound).collect();
        match lcp::solve(&matrix, &right).map_err(|error| error.to_string())? {
            lcp::Lcp::Solved(z) => {
                Ok(z.iter().zip(&self.rows).map(|(z, row)| z * row[0]).sum::<f64>() / self.diagonal[0])
            }
            other => Err(format!("{other:?}")),
        }
    }
}

/// Names of the cases, and their quadratic programs as text.
pub fn texts() -> Vec<(&'static str, String)> {
    cases().iter().map(|case| (case.name, Program::new(case).text(case))).collect()
}

/// Every form on every case.
pub fn rows(effort: &Effort) -> Vec<Row> {
    let mut rows = Vec::new();
    for case in cases() {
        let reference = case.reference.0 / case.reference.1;
        let judge = |e: f64, cost: u64| Found { cost, errors: vec![("restitution", (e - reference).abs())] };
        let solver = |name, origin, cost_unit| Solver { name, origin, cost_unit };
        let single = SingleImpact { mass_kg: case.mass_kg, phi: &case.phi, coefficients: case.coefficients };
        let variables = 2 * case.phi.len() as u64 + 1;

        let closed = solver("closed form", Origin::Own, "variables");
        rows.extend(sweep(case.name, closed, &[1.0], effort, |_| closed_form(&case).map(|e| judge(e, 2))));
        let full = solver("emoc P_1 (Clarabel + active set)", Origin::Own, "variables");
        rows.extend(sweep(case.name, full, &[1.0], effort, |_| {
            single.solve_full().map(|s| judge(s.restitution, variables)).map_err(|error| error.to_string())
        }));
        let reduced = solver("emoc reduced (Clarabel + active set)", Origin::Own, "variables");
        rows.extend(sweep(case.name, reduced, &[1.0], effort, |_| {
            single.solve_reduced().map(|s| judge(s.restitution, 2)).map_err(|error| error.to_string())
        }));
        let program = Program::new(&case);
        let pivoting = solver("P_1 by complementary pivoting", Origin::Peer, "variables");
        rows.extend(sweep(case.name, pivoting, &[1.0], effort, |_| program.pivoting().map(|e| judge(e, variables))));
        let interior = solver("P_1 by Clarabel", Origin::Peer, "iterations");
        rows.extend(sweep(case.name, interior, &effort.tolerances(2, 12), effort, |tolerance| {
            program.interior_point(tolerance).map(|(e, iterations)| judge(e, iterations))
        }));
    }
    rows
}

fn closed_form(case: &Case) -> Result<f64, String> {
    let z = case.mass_kg * case.phi.iter().map(|phi| phi * phi).sum::<f64>();
    case.coefficients.rebound(z).map(|rebound| rebound.restitution).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_gives_the_rational_number() {
        for case in cases() {
            let reference = case.reference.0 / case.reference.1;
            let program = Program::new(&case);
            let (interior, _) = program.interior_point(1e-9).unwrap();
            for (e, floor) in
                [(closed_form(&case).unwrap(), 1e-15), (program.pivoting().unwrap(), 1e-12), (interior, 1e-7)]
            {
                assert!((e - reference).abs() < floor, "{}: {e} {reference}", case.name);
            }
        }
    }
}
