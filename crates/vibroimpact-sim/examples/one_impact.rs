//! A ball on a structure of three modes: every contact, the rebound, and the energy balance.
//!
//! `cargo run --release -p vibroimpact-sim --example one_impact`

mod ball_on_beam;

use ball_on_beam::ball_on_beam;
use contact_models::Hertz;
use vibroimpact_sim::infinite;
use vibroimpact_sim::modal::{Settings, Solver};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (structure, ball) = ball_on_beam();
    let solution = Solver::new(&structure)?.solve(&ball, &Hertz::new(1.8e10)?, None, &Settings::default())?;
    for contact in &solution.sub_impacts {
        println!(
            "{:9.3} ms to {:9.3} ms: impulse {:8.3} mN s, largest force {:8.2} N",
            1e3 * contact.start_s,
            1e3 * contact.end_s,
            1e3 * contact.impulse_n_s,
            contact.peak_force_n
        );
    }
    if let (Some(e), Some(uncertainty)) = (solution.restitution, solution.restitution_uncertainty) {
        println!("{}: restitution {e:.9}, uncertain by {uncertainty:.0e}", solution.outcome.as_str());
    }

    // The same question for a beam without ends, given by its only parameter S.
    let waves = infinite::solve(infinite::Structure::Beam, 15.0, &infinite::Settings::default())?;
    println!("infinite beam, S = 15: {} separations, {:?}", waves.separations(), waves.outcome);
    Ok(())
}
