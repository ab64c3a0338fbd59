//! The problem of Fig. 5.1: a ball falls on one end of a rod that rests on a table, and the other end lifts off a contact that
//! was not closing, which no coefficient of restitution can describe.
//!
//! A uniform rod (1 kg, 1 m) lies on two supports, a quarter of its length from the left end and at the right end.
//! A ball of 0.2 kg falls on the left end at 1 m/s. Three rules are compared, for two restitutions.
//!
//! `cargo run --release -p emoc --example rod_and_ball`

use emoc::{Coefficients, Contact, Friction, Mode, Problem, Solution, Solver, lcp};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Velocities: ball (upwards), rod's centre (upwards), rod's rotation (anticlockwise); the length is 1 m.
    let mass = [0.2, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 / 12.0];
    let falling = [-1.0, 0.0, 0.0];
    // Opening velocities: ball - left end, left support (x = -1/4), right support (x = 1/2).
    let jacobian = [1.0, -1.0, 0.5, 0.0, 1.0, -0.25, 0.0, 1.0, 0.5];

    let mut solver = Solver::new();
    for ebar in [1.0, 0.6] {
        println!("restitution {ebar}");
        let contact = Contact { friction: Friction::None, coefficients: Coefficients { ebar, beta0: 0.2, beta1: 0.3 } };
        let problem = Problem::from_bodies(vec![contact; 3], &mass, &jacobian, &falling, vec![])?;
        print("complementarity (Newton)", lcp::newton_impact(&problem)?.as_ref());
        print("least energy (Todorov)", Some(&solver.least_energy(&problem)?));
        print("EMOC", Some(&solver.solve(&problem)?));

        // The same with two bending modes of the free rod (shapes at -1/2, -1/4, 1/2). They have the opposite sign at the
        // ball's contact, where the rod is the lower body.
        let bending = |left: f64, support: f64, right: f64| Mode { rate: 0.0, shape: vec![left, -support, -right] };
        let modes = vec![bending(2.0, -0.20, 2.0), bending(2.0, -1.32, -2.0)];
        let problem = Problem::from_bodies(vec![contact; 3], &mass, &jacobian, &falling, modes)?;
        print("EMOC with two bending modes", Some(&solver.solve(&problem)?));
    }
    Ok(())
}

fn print(name: &str, solution: Option<&Solution>) {
    match solution {
        Some(s) => println!(
            "  {name:28} opening speeds (m/s): ball {:.4}, left support {:.4}, right support {:.4}; energy {:+.4} J",
            s.opening_m_s[0], s.opening_m_s[1], s.opening_m_s[2], s.energy_change_j
        ),
        None => println!("  {name:28} contradiction"),
    }
}
