//! Solves one problem a number of times, to be counted by a profiler:
//! `valgrind --tool=callgrind repeat PROBLEM (assembly | dop853) TOLERANCE COUNT`; the defaults are cradle-3, assembly, 1e-6 and 1.
//! The cost of one run is the difference between two counts over the difference of their numbers of runs.

use impactbench::codes::{dop853, own_assembly};
use impactbench::problem::Problem;
use std::path::Path;
use std::time::{Duration, Instant};

fn main() -> Result<(), String> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.is_empty() {
        arguments = ["cradle-3", "assembly", "1e-6", "1"].map(str::to_owned).into();
    }
    let [name, code, tolerance, count] = arguments.as_slice() else {
        return Err("usage: repeat PROBLEM (assembly | dop853) TOLERANCE COUNT".into());
    };
    let tolerance: f64 = tolerance.parse().map_err(|_| format!("{tolerance} is not a tolerance"))?;
    let count: usize = count.parse().map_err(|_| format!("{count} is not a number of runs"))?;
    let problems = Problem::read_all(&Path::new(env!("CARGO_MANIFEST_DIR")).join("problems"))?;
    let problem = problems.iter().find(|problem| problem.name == *name).ok_or(format!("no problem {name}"))?;
    let laws = problem.contacts.iter().map(|contact| contact.law.law().ok().flatten()).collect::<Option<Vec<_>>>();
    let laws = laws.ok_or(format!("{name} states no law"))?;
    let deadline = Instant::now() + Duration::from_secs(3600);
    let solve = || match code.as_str() {
        "assembly" => own_assembly(problem, &laws, tolerance),
        "dop853" => dop853(problem, &laws, tolerance, deadline),
        _ => Err(format!("no code {code}")),
    };
    let mut answer = solve()?;
    for _ in 1..count {
        answer = solve()?;
    }
    println!("{answer:?}");
    Ok(())
}
