//! Fractional and Volterra test equations with solutions known to 16 digits (`fracdiff::test_problems`).

use crate::measure::{Effort, Found, Origin, Row, Solver, sweep};
use fracdiff::test_problems::{self, TestProblem};
use fracdiff::{Collocation, Convolution, Method, Solution, SumOfExponentials};

/// Final time of the problems.
const UNTIL: f64 = 20.0;

fn largest_error(problem: &TestProblem, solution: &Solution) -> Result<Found, String> {
    let end = problem.end_before(UNTIL);
    let mut error: f64 = 0.0;
    for &(t, value) in problem.reference.iter().filter(|point| point.0 <= end) {
        let found = solution.at(t).map_err(|error| error.to_string())?;
        error = error.max((found.first().ok_or("no value")? - value).abs());
    }
    Ok(Found { cost: solution.counts.evaluations, errors: vec![("largest error", error)] })
}

/// Every test equation with every method.
pub fn rows(effort: &Effort) -> Vec<Row> {
    type Make = fn(f64) -> Method;
    let steps = |most: usize| -> Vec<f64> {
        [16.0, 32.0, 125.0, 500.0, 2000.0, 8000.0].into_iter().take(if effort.quick { 2 } else { most }).collect()
    };
    let methods: [(&str, Vec<f64>, Make); 5] = [
        ("collocation", effort.tolerances(3, 13), |tolerance| {
            Method::Collocation(Collocation { tolerance, ..Collocation::default() })
        }),
        ("trapezoidal", steps(6), |n| Method::Trapezoidal(Convolution { steps: n as usize })),
        ("sum of exponentials", steps(6), |n| {
            Method::SumOfExponentials(SumOfExponentials { steps: n as usize, ..SumOfExponentials::default() })
        }),
        ("Gruenwald-Letnikov", steps(6), |n| Method::GrunwaldLetnikov(Convolution { steps: n as usize })),
        ("L1", steps(6), |n| Method::L1(Convolution { steps: n as usize })),
    ];
    let mut rows = Vec::new();
    for problem in test_problems::all() {
        let name = format!("fractional-{}", problem.name);
        let end = problem.end_before(UNTIL);
        // Cost of both of its runs, the second of which is only for the estimate.
        let chosen = Solver { name: "to a tolerance, with its error", origin: Origin::Own, cost_unit: "evaluations" };
        rows.extend(sweep(&name, chosen, &effort.tolerances(1, 12), effort, |tolerance| {
            let found = problem.volterra.solve_to(tolerance, end).map_err(|error| error.to_string())?;
            largest_error(&problem, &found.solution)
        }));
        let fewer = Solver { name: "collocation, few nodes", origin: Origin::Own, cost_unit: "evaluations" };
        rows.extend(sweep(&name, fewer, &effort.tolerances(1, 6), effort, |tolerance| {
            let method = Collocation { tolerance, nodes: 8, first_panel: Some(0.3 * end), ..Collocation::default() };
            let solution =
                problem.volterra.solve(&Method::Collocation(method), end).map_err(|error| error.to_string())?;
            largest_error(&problem, &solution)
        }));
        for (method, settings, make) in &methods {
            let origin = if *method == "collocation" { Origin::Own } else { Origin::Peer };
            let solver = Solver { name: method, origin, cost_unit: "evaluations" };
            rows.extend(sweep(&name, solver, settings, effort, |setting| {
                let solution = problem.volterra.solve(&make(setting), end).map_err(|error| error.to_string())?;
                largest_error(&problem, &solution)
            }));
        }
    }
    rows
}
