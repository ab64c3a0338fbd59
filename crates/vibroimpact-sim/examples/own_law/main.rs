//! A contact law of your own: a ball on a beam that it indents, and the same ball between the beam and a stop.
//!
//! `cargo run --release -p vibroimpact-sim --example own_law`

#[path = "../ball_on_beam/mod.rs"]
mod ball_on_beam;
mod hardening;

use ball_on_beam::ball_on_beam;
use contact_models::check_contract;
use hardening::Hardening;
use vibroimpact_sim::assembly::{Assembly, Body, BodyMode, Contact, Interval, Observer, Point, Settings, run};
use vibroimpact_sim::modal::{self, Solver};

/// Prints each contact after its end.
struct Printed;

impl Observer for Printed {
    fn interval(&mut self, contact: usize, interval: &Interval) {
        let from_us = 1e6 * interval.start_s;
        println!("contact {contact} from {from_us:8.2} us on: impulse {:9.3} mN s", 1e3 * interval.impulse_n_s);
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // ANCHOR: run
    let law = Hardening { stiffness_n_m: 2e7, yield_force_n: 100.0, kinematic_n_m: 8e6, isotropic_n_m: 1e6 };
    let law = law.validated()?;
    check_contract(&law, 1e-4, 1.0)?;

    let (structure, ball) = ball_on_beam();
    let (solution, history) = Solver::new(&structure)?.record(&ball, &law, None, &modal::Settings::default())?;
    let lasting_m = history.at(solution.end_s).compression_m;
    let restitution = solution.restitution.ok_or("the ball does not rebound")?;
    println!("restitution {restitution:.4}, indentation {:.3} um", 1e6 * lasting_m);
    // ANCHOR_END: run

    // The same ball falls on the beam, and a stop above catches it.
    let shape = |factor: f64| -> Vec<f64> { structure.modes.iter().map(|mode| factor * mode.shape).collect() };
    let modes = structure.modes.iter().map(|m| BodyMode { omega_rad_s: m.omega_rad_s, damping_ratio: m.damping_ratio });
    let of_ball = Point::OfBody { body: 0, shape: vec![ball.mass_kg.sqrt().recip()] };
    let of_beam = Point::OfBody { body: 1, shape: shape(1.0) };
    let assembly = Assembly {
        bodies: vec![Body::mass(ball.mass_kg, 0.0, -ball.speed_m_s), Body::at_rest(modes.collect())],
        contacts: vec![
            Contact { sides: [of_ball.clone(), of_beam], gap_m: 0.0, law },
            Contact { sides: [Point::Ground, of_ball], gap_m: 1e-4, law },
        ],
        loads: vec![],
    };
    let run = run(&assembly, &Settings::until(5e-3), &mut Printed)?;
    println!("{}", run.outcome);
    Ok(())
}
