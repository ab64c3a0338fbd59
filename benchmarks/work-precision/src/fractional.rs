//! Fractional and Volterra test equations with solutions known to 16 digits (`fracdiff::test_problems`).

use crate::measure::{Effort, Found, Origin, Row, Solver, sweep};
use fracdiff::test_problems::{self, TestProblem};
use fracdiff::{Collocation, Convolution, Method, SumOfExponentials};

fn largest_error(problem: &TestProblem, method: &Method) -> Result<Found, String> {
    let end = problem.end_before(20.0);
    let solution = problem.volterra.solve(method, end).map_err(|error| error.to_string())?;
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
        [125.0, 500.0, 2000.0, 8000.0].into_iter().take(if effort.quick { 2 } else { most }).collect()
    };
    let methods: [(&str, Vec<f64>, Make); 5] = [
        ("collocation", effort.tolerances(3, 13), |tolerance| {
            Method::Collocation(Collocation { tolerance, ..Collocation::default() })
        }),
        ("trapezoidal", steps(4), |n| Method::Trapezoidal(Convolution { steps: n as usize })),
        ("sum of exponentials", steps(4), |n| {
            Method::SumOfExponentials(SumOfExponentials { steps: n as usize, ..SumOfExponentials::default() })
        }),
        ("Gruenwald-Letnikov", steps(4), |n| Method::GrunwaldLetnikov(Convolution { steps: n as usize })),
        ("L1", steps(4), |n| Method::L1(Convolution { steps: n as usize })),
    ];
    let mut rows = Vec::new();
    for problem in test_problems::all() {
        let name = format!("fractional-{}", problem.name);
        for (method, settings, make) in &methods {
            let origin = if *method == "collocation" { Origin::Own } else { Origin::Peer };
            let solver = Solver { name: method, origin, cost_unit: "evaluations" };
            rows.extend(sweep(&name, solver, settings, effort, |setting| largest_error(&problem, &make(setting))));
        }
    }
    rows
}
