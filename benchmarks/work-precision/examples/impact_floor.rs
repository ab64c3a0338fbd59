//! Steps of one impact of the library, and the operations that these steps need by the cost model of docs/performance.md. Solves it
//! with cached tables a number of times, for callgrind.
//!
//! Usage: `impact_floor NAME TOLERANCE [RUNS] [anew]`; the defaults are pinned-hertz and 1e-6. With `anew` the tables are built for
//! each impact.

use std::hint::black_box;
use std::time::Instant;
use vibroimpact_sim::modal::{Settings, Solver};
use work_precision::impact::{library, reference};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    if words.is_empty() {
        words = ["pinned-hertz", "1e-6"].map(str::to_owned).into();
    }
    let [name, tolerance, rest @ ..] = words.as_slice() else {
        return Err("usage: NAME TOLERANCE [RUNS] [anew]".into());
    };
    let runs: usize = rest.first().map_or(Ok(100), |runs| runs.parse())?;
    let anew = rest.iter().any(|word| word == "anew");
    let impacts = library()?;
    let impact = impacts.iter().find(|impact| impact.name == name).ok_or("no impact of this name")?;
    let settings = Settings { tolerance: tolerance.parse()?, estimate_uncertainty: false, ..Settings::default() };
    let mut solver = Solver::new(&impact.structure)?;
    let mut solution = solver.solve(&impact.striker, &impact.law, None, &settings)?;
    let mut best = f64::INFINITY;
    for _ in 0..runs {
        let clock = Instant::now();
        if anew {
            solver = Solver::new(black_box(&impact.structure))?;
        }
        solution = solver.solve(black_box(&impact.striker), &impact.law, None, &settings)?;
        best = best.min(clock.elapsed().as_secs_f64());
    }
    let (counts, modes) = (solution.counts, impact.structure.modes.len() as u64);
    // a step in contact, and one of free flight
    let (contact, flight) = (counts.contact_steps * (70 * modes + 1000), counts.flight_steps * (8 * modes + 100));
    println!(
        "{modes} modes, error {:.1e}, {} steps in contact, {} rejected, {} in flight, {} events, {} iterations; {} + {} thousand \
         floating-point operations; {:.1} us at best",
        solution
            .restitution
            .map_or(f64::NAN, |e| (e - reference(impact.name).map_or(f64::NAN, |r| r.outcome.restitution)).abs()),
        counts.contact_steps,
        counts.rejected_steps,
        counts.flight_steps,
        counts.events,
        counts.newton_iterations,
        contact / 1000,
        flight / 1000,
        1e6 * best
    );
    Ok(())
}
