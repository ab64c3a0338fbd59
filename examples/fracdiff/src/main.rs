//! A fractional oscillator, y'' + 0.5 D^(1/2) y + y = 0 from rest at y = 1, and the times of its zero crossings.

use fracdiff::{Collocation, Equation, Event, InitialValueProblem, Method};

fn main() -> Result<(), fracdiff::InvalidInput> {
    let oscillator =
        InitialValueProblem::new(vec![Equation::new(2.0, &[1.0, 0.0]).plus(0.5, 0.5)], |_, y, f| f[0] = -y[0])
            .with_event(Event::new(|_, y| y[0]));
    let solution = oscillator.solve(&Method::Collocation(Collocation::default()), 15.0)?;
    for hit in &solution.events {
        println!("zero at {:.12}", hit.t);
    }
    println!("y(15) = {:.12}, {} evaluations", solution.at(15.0)?[0], solution.counts.evaluations);
    Ok(())
}
