//! The engine of many bodies and contacts beside general integrators with root finding, on the whole system, at equal
//! error: see `run.sh` and `docs/many-contacts.md`.
//!
//! The error is that of the state at the end in the norm of the energy, `sqrt(sum (db^2 + omega^2 da^2))`, relative to
//! the size of the state there.

mod problem;
mod solvers;
mod system;

use problem::library;
use solvers::{Found, TOO_SLOW, cvode, dop853, own};
use std::env;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use system::System;

/// A solver is given no more than this for a run.
const CAP: Duration = Duration::from_secs(60);
/// The error at which solvers are compared.
const EQUAL: f64 = 1e-6;

fn main() -> Result<(), String> {
    let folder = PathBuf::from(env::args().nth(1).ok_or("usage: many-contacts FOLDER [PROBLEM]")?);
    let only = env::args().nth(2);
    let program = env::var_os("CVODE").map(PathBuf::from);
    println!("| problem | solver | tolerance | error | time, ms | times ours |");
    println!("|---|---|---|---|---|---|");
    for problem in library()?.iter().filter(|problem| only.as_ref().is_none_or(|only| problem.name.contains(only))) {
        let system = System::of(problem);
        let reference = own(problem, 1e-13)?.state;
        let size = system.size(&reference);
        let error = |state: &[f64]| {
            let difference: Vec<f64> = state.iter().zip(&reference).map(|(a, b)| a - b).collect();
            system.size(&difference) / size
        };
        let deadline = || Instant::now() + CAP;
        // what a second method makes of the reference
        let tight = dop853(&system, size, 1e-13, deadline()).map(|found| error(&found.state));
        eprintln!("{}: {}; DOP853 at its tightest differs by {tight:?}", problem.name, problem.about);

        let ours = best(problem.name, "ours", &error, 2..=12, |tolerance| own(problem, tolerance));
        let print = |solver: &str, found: Option<(f64, f64, f64)>| match (found, ours) {
            (Some((tolerance, error, time_s)), Some((_, _, own_s))) => println!(
                "| {} | {solver} | {tolerance:.0e} | {error:.1e} | {:.3} | {:.1} |",
                problem.name,
                1e3 * time_s,
                time_s / own_s
            ),
            _ => println!("| {} | {solver} | | not reached | | |", problem.name),
        };
        print("ours", ours);
        let solver = |tolerance: f64| dop853(&system, size, tolerance, deadline());
        print("DOP853", best(problem.name, "DOP853", &error, 4..=13, solver));
        for formula in ["adams", "bdf"] {
            let Some(program) = &program else { continue };
            let solver = |tolerance: f64| cvode(program, &folder, &system, size, formula, tolerance);
            print(&format!("CVODE, {formula}"), best(problem.name, formula, &error, 4..=13, solver));
        }
    }
    Ok(())
}

/// Of all tolerances with an error of at most [`EQUAL`] the one that takes least: tolerance, error, time. After two of them
/// tighter ones are not tried.
fn best(
    problem: &str,
    name: &str,
    error: &dyn Fn(&[f64]) -> f64,
    decades: std::ops::RangeInclusive<i32>,
    mut solve: impl FnMut(f64) -> Result<Found, String>,
) -> Option<(f64, f64, f64)> {
    let mut reached: Vec<(f64, f64, f64)> = Vec::new();
    for half in 2 * decades.start()..=2 * decades.end() {
        let tolerance = 10f64.powf(-0.5 * f64::from(half));
        match solve(tolerance) {
            Ok(Found { state, time_s }) => {
                let error = error(&state);
                eprintln!("  {problem}, {name}, {tolerance:.1e}: error {error:.1e}, {:.3} ms", 1e3 * time_s);
                if error <= EQUAL {
                    reached.push((tolerance, error, time_s));
                }
            }
            Err(fault) => {
                eprintln!("  {problem}, {name}, {tolerance:.1e}: {fault}");
                if fault == TOO_SLOW {
                    break;
                }
            }
        }
        if reached.len() == 2 {
            break;
        }
    }
    reached.into_iter().min_by(|a, b| a.2.total_cmp(&b.2))
}
