//! Variants of all impacts of the study, since the error of a single impact is small or large by accident.
//!
//! Usage: `many_impacts TOLERANCE VARIANTS [errors]`; the defaults are 1e-6 and 2. The instructions of a run are those of its impacts,
//! for callgrind; with `errors`, each impact is also solved at a tolerance of 1e-12, and the distribution of the differences is
//! printed.

use vibroimpact_sim::modal::{Settings, Solver};
use work_precision::impact::library;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    if words.is_empty() {
        words = ["1e-6", "2"].map(str::to_owned).into();
    }
    let [tolerance, variants, rest @ ..] = words.as_slice() else {
        return Err("usage: TOLERANCE VARIANTS [errors]".into());
    };
    let (tolerance, variants): (f64, u32) = (tolerance.parse()?, variants.parse()?);
    let with_errors = rest.iter().any(|word| word == "errors");
    let (mut errors, mut steps, mut impacts) = (Vec::new(), 0, 0);
    for impact in library()? {
        let solver = Solver::new(&impact.structure)?;
        for variant in 0..variants {
            let mut striker = impact.striker;
            // two sequences that fill the square evenly
            let [speed, mass] = [0.618034, 0.754878].map(|step| (f64::from(variant) * step).fract());
            striker.speed_m_s *= 0.8 + 0.4 * speed;
            striker.mass_kg *= 0.5 + mass;
            let solve = |tolerance| {
                let settings = Settings { tolerance, estimate_uncertainty: false, ..Settings::default() };
                solver.solve(&striker, &impact.law, None, &settings)
            };
            let found = solve(tolerance)?;
            impacts += 1;
            steps += found.counts.contact_steps + found.counts.rejected_steps;
            if with_errors && let (Some(found), Some(exact)) = (found.restitution, solve(1e-12)?.restitution) {
                errors.push((found - exact).abs());
            }
        }
    }
    println!("{impacts} impacts, {:.1} steps in contact with rejected ones", steps as f64 / f64::from(impacts));
    errors.sort_by(f64::total_cmp);
    if let Some(last) = errors.len().checked_sub(1) {
        let quantile = |part: f64| errors[(part * last as f64) as usize];
        let beyond = errors.iter().filter(|error| **error > tolerance).count();
        let [half, three_quarters, most] = [0.5, 0.75, 0.9].map(quantile);
        println!("error: median {half:.1e}, 75 % {three_quarters:.1e}, 90 % {most:.1e}; above the tolerance: {beyond}");
    }
    Ok(())
}
