//! Accuracy against cost of every method on every test problem, as CSV on standard output.
//!
//! `cargo run --release -p fracdiff --example work_precision > work_precision.csv`

use fracdiff::{Collocation, Convolution, GalerkinStates, Method, SumOfExponentials, test_problems};
use std::time::Instant;

fn methods() -> Vec<(usize, Method)> {
    let mut methods = Vec::new();
    for steps in [125, 250, 500, 1000, 2000, 4000, 8000] {
        methods.push((steps, Method::GrunwaldLetnikov(Convolution { steps })));
        methods.push((steps, Method::L1(Convolution { steps })));
        methods.push((steps, Method::Trapezoidal(Convolution { steps })));
        methods.push((steps, Method::SumOfExponentials(SumOfExponentials { steps, ..Default::default() })));
        methods.push((steps, Method::GalerkinStates(GalerkinStates { steps, ..Default::default() })));
    }
    for digits in [3, 5, 7, 9, 11, 13] {
        let tolerance = 10f64.powi(-digits);
        methods.push((digits as usize, Method::Collocation(Collocation { tolerance, ..Default::default() })));
    }
    methods
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("problem,method,steps_or_digits,t_end_s,evaluations,newton_iterations,history_values,error,time_s");
    for problem in test_problems::all() {
        let t_end = problem.end_before(20.0);
        for (setting, method) in methods() {
            let mut best = f64::INFINITY;
            let mut solution = None;
            for _ in 0..3 {
                let start = Instant::now();
                solution = Some(problem.volterra.solve(&method, t_end)?);
                best = best.min(start.elapsed().as_secs_f64());
            }
            let Some(solution) = solution else { continue };
            let mut error: f64 = 0.0;
            for &(t, y) in problem.reference.iter().filter(|r| r.0 <= t_end) {
                error = error.max((solution.at(t).map_or(f64::NAN, |v| v[0]) - y).abs());
            }
            let counts = solution.counts;
            println!(
                "{},{},{setting},{t_end},{},{},{},{error:.3e},{best:.3e}",
                problem.name,
                method.name(),
                counts.evaluations,
                counts.newton_iterations,
                counts.history_values
            );
        }
    }
    Ok(())
}
