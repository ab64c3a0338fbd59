//! Rebound speeds of balls of several masses from a pinned beam of one kilogram, without integration, and without allocation or
//! dependencies in the crate.

use emoc::{Impact, Parameters, Site};

fn main() -> Result<(), emoc::InvalidInput> {
    // Mass-normalised shapes of 30 modes at 0.4 of the length.
    let shape = |k: u8| 2f64.sqrt() * (0.4 * std::f64::consts::PI * f64::from(k)).sin();
    let phi: Vec<f64> = (1..=30).map(shape).collect();
    let site = Site::new(&phi)?;
    let law = Parameters { mu0: 0.7, alpha0: 3.0, alpha1: 0.2, notional_restitution: 1.0 };
    for mass_kg in [0.003, 0.03, 0.1, 0.6] {
        let rebound = law.rebound(&Impact::new(mass_kg, &site)?)?;
        println!("{mass_kg} kg: restitution {:.4} ({})", rebound.restitution, rebound.branch.as_str());
    }
    Ok(())
}
