//! Solves one impact on an infinite beam a hundred times, for callgrind. See docs/performance.md.
//!
//! Usage: `infinite_cost S TOLERANCE NODES [estimate] [first]`; the defaults are 15, 1e-10 and 20.

use std::hint::black_box;
use std::time::Instant;
use vibroimpact_sim::infinite::{Settings, Structure, solve};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    if words.len() < 3 {
        words = ["15", "1e-10", "20"].map(str::to_owned).into();
    }
    let [s, tolerance, nodes, options @ ..] = words.as_slice() else { return Ok(()) };
    let has = |word: &str| options.iter().any(|option| option == word);
    let (s, estimate_uncertainty) = (s.parse()?, has("estimate"));
    let settings = Settings {
        tolerance: tolerance.parse()?,
        nodes: nodes.parse()?,
        estimate_uncertainty,
        max_sub_impacts: if has("first") { 1 } else { usize::MAX },
        ..Settings::default()
    };
    let mut solution = solve(Structure::Beam, s, &settings)?;
    let mut best = f64::INFINITY;
    for _ in 0..100 {
        let clock = Instant::now();
        solution = solve(Structure::Beam, black_box(s), black_box(&settings))?;
        best = best.min(clock.elapsed().as_secs_f64());
    }
    println!(
        "{} separations, first ratio {:?}, error {:?}, {} panels of {} tried, {:.1} us at best",
        solution.separations(),
        solution.first_rebound_ratio(),
        solution.relative_uncertainty,
        solution.panels,
        solution.panels_tried,
        1e6 * best
    );
    Ok(())
}
