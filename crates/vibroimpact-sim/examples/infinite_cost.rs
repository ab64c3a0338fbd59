//! Solves one impact on an infinite beam a hundred times, for callgrind. See docs/performance.md.
//!
//! Usage: `infinite_cost S TOLERANCE NODES [estimate] [first] [law]`; the defaults are 15, 1e-10 and 20. With `law` the impact
//! is solved as that of any contact law on any structure. `RUNS` in the environment replaces the hundred.

use contact_models::Hertz;
use std::hint::black_box;
use std::time::Instant;
use vibroimpact_sim::infinite::{Receptance, Settings, Structure, Term, solve, solve_law};
use vibroimpact_sim::modal::Striker;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    if words.len() < 3 {
        words = ["15", "1e-10", "20"].map(str::to_owned).into();
    }
    let [s, tolerance, nodes, options @ ..] = words.as_slice() else { return Ok(()) };
    let has = |word: &str| options.iter().any(|option| option == word);
    let (s, estimate_uncertainty): (f64, bool) = (s.parse()?, has("estimate"));
    let settings = Settings {
        tolerance: tolerance.parse()?,
        nodes: nodes.parse()?,
        estimate_uncertainty,
        max_sub_impacts: if has("first") { 1 } else { usize::MAX },
        ..Settings::default()
    };
    // units in which all numbers of the impact are 1
    let beam = Receptance::new(&[Term { coefficient: 1.0, power: 0.5 }])?;
    let (ball, hertz) = (Striker { mass_kg: 1.0, speed_m_s: 1.0 }, Hertz::new(s.sqrt())?);
    let once = || match has("law") {
        true => solve_law(&beam, &ball, black_box(&hertz), black_box(&settings)),
        false => solve(Structure::Beam, black_box(s), black_box(&settings)),
    };
    let mut solution = once()?;
    let mut best = f64::INFINITY;
    let runs = std::env::var("RUNS").map_or(Ok(100), |runs| runs.parse())?;
    for _ in 0..runs {
        let clock = Instant::now();
        solution = once()?;
        best = best.min(clock.elapsed().as_secs_f64());
    }
    println!(
        "{:?}, {} separations, first ratio {:?} after {:?}, rebound {:?}, error {:?}, {} panels of {} tried, {:.1} us at best",
        solution.outcome,
        solution.separations(),
        solution.first_rebound_ratio(),
        solution.sub_impacts[0].duration,
        solution.rebound_ratio(),
        solution.relative_uncertainty,
        solution.panels,
        solution.panels_tried,
        1e6 * best
    );
    Ok(())
}
