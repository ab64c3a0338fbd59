//! Solves one impact on the beam of thesis chapter 3 a hundred times, for callgrind. See docs/performance.md.
//!
//! Usage: `impact_cost MODES TOLERANCE [uncertainty] [anew] [keep] [record] [derivatives]`; the defaults are 40 and 1e-6. `keep`
//! keeps the motion, `record` makes the history with its energy balance, and `derivatives` differentiates by ten parameters.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{GOLDEN, ball, hertz, near_pinned, pinned, settings, ten_parameters};
use std::hint::black_box;
use std::time::Instant;
use vibroimpact_sim::modal::{Settings, Solver, Start};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    if words.len() < 2 {
        words = ["40", "1e-6"].map(str::to_owned).into();
    }
    let [modes, tolerance, options @ ..] = words.as_slice() else { return Ok(()) };
    let has = |word: &str| options.iter().any(|option| option == word);
    let modes = modes.parse()?;
    let structure = pinned(modes, 0.02, GOLDEN);
    let (near, law, start) = (near_pinned(modes), hertz(), Start::at_rest(modes));
    let settings = Settings { estimate_uncertainty: has("uncertainty"), ..settings(tolerance.parse()?) };
    let mut solver = Solver::new(&structure)?;
    let mut solution = solver.solve(&ball(), &hertz(), None, &settings)?;
    let mut best = f64::INFINITY;
    for _ in 0..100 {
        let clock = Instant::now();
        if has("anew") {
            solver = Solver::new(black_box(&structure))?;
        }
        let striker = black_box(ball());
        solution = if has("record") {
            solver.record(&striker, &hertz(), None, &settings)?.0
        } else if has("keep") {
            solver.solve_and_keep(&striker, &hertz(), None, &settings)?.solution().clone()
        } else if has("derivatives") {
            let parameters = ten_parameters(&near, &striker, &law, &start);
            solver.differentiate(&striker, &law, None, &settings, &parameters)?.solution
        } else {
            solver.solve(&striker, &hertz(), None, &settings)?
        };
        best = best.min(clock.elapsed().as_secs_f64());
    }
    println!("restitution {:?}, {:.1} us at best, {:?}", solution.restitution, 1e6 * best, solution.counts);
    Ok(())
}
