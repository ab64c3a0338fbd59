//! One impact on the beam of thesis chapter 3 as an assembly, with and without the energy ledger. See docs/performance.md.
//!
//! Usage: `assembly_cost MODES TOLERANCE [anew]`; the defaults are 40 and 1e-6. `anew` builds the tables in every run.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{GOLDEN, ball, hertz, pinned};
use std::hint::black_box;
use std::time::Instant;
use vibroimpact_sim::assembly::{Assembly, Body, BodyMode, Contact, Observer, Point, Settings, Solver};

/// Requests the energy ledger, or does not.
struct Energy(bool);

impl Observer for Energy {
    fn wants_energy(&self) -> bool {
        self.0
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    if words.len() < 2 {
        words = ["40", "1e-6"].map(str::to_owned).into();
    }
    let [modes, tolerance, options @ ..] = words.as_slice() else { return Ok(()) };
    let anew = options.iter().any(|option| option == "anew");
    let (structure, ball) = (pinned(modes.parse()?, 0.02, GOLDEN), ball());
    let of = |mode: &vibroimpact_sim::modal::Mode| BodyMode {
        omega_rad_s: mode.omega_rad_s,
        damping_ratio: mode.damping_ratio,
    };
    let beam = Body::at_rest(structure.modes.iter().map(of).collect());
    let place = Point::OfBody { body: 1, shape: structure.modes.iter().map(|mode| mode.shape).collect() };
    let striker = Point::OfBody { body: 0, shape: vec![ball.mass_kg.sqrt().recip()] };
    let assembly = Assembly {
        bodies: vec![Body::mass(ball.mass_kg, 0.0, -ball.speed_m_s), beam],
        contacts: vec![Contact { sides: [striker, place], gap_m: 0.0, law: hertz() }],
        loads: vec![],
    };
    let mut settings = Settings::until(2e-3);
    settings.tolerance = tolerance.parse()?;
    for wanted in [false, true] {
        let mut solver = Solver::new(&assembly)?;
        let mut run = solver.run(&settings, &mut Energy(wanted))?;
        let mut best = f64::INFINITY;
        for _ in 0..200 {
            let clock = Instant::now();
            if anew {
                solver = Solver::new(black_box(&assembly))?;
            }
            run = solver.run(black_box(&settings), &mut Energy(wanted))?;
            best = best.min(clock.elapsed().as_secs_f64());
        }
        println!("{:.1} us at best, {:?}, {:?}", 1e6 * best, run.counts, run.energy);
    }
    Ok(())
}
