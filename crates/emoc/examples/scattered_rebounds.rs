//! Rebounds drawn by an engine: a ball falls on one location of a beam again and again, and each time the law gives another
//! restitution, from a random number of the engine.
//!
//! `cargo run --release -p emoc --features scatter --example scattered_rebounds`

use emoc::{Impact, ScatteredLaw, Site};

fn main() -> Result<(), emoc::InvalidInput> {
    // The first ten modes of a pinned beam of 1 kg, at a quarter of its length.
    let phi: Vec<f64> = (1..=10).map(|k| 2f64.sqrt() * (f64::from(k) * std::f64::consts::PI / 4.0).sin()).collect();
    let site = Site::new(&phi)?;
    // Multiples of the golden ratio cover the interval from 0 to 1 evenly; an engine has its own generator.
    let uniform = |k: u32| (0.5 + f64::from(k) * 0.618_033_988_749_894_9).fract();
    for mass_kg in [0.01, 0.05, 0.5] {
        let scatter = ScatteredLaw::BEAMS.rebound(&Impact::new(mass_kg, &site)?)?;
        let [low, high] = scatter.interval(0.9)?;
        print!("{mass_kg:4} kg: nine of ten from {low:.3} to {high:.3}; drawn");
        for k in 0..6 {
            print!(" {:.3}", scatter.draw(uniform(k))?);
        }
        println!();
    }
    Ok(())
}
