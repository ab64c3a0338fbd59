//! A ball dropped on a vibrating beam in the physics engine rapier.
//!
//! A physics engine knows one restitution a pair of bodies. On a beam that is wrong by a factor of ten from place to
//! place: next to a support the ball springs back, in the middle the beam takes its energy. Here the engine asks the
//! EMOC law at each new contact, through its hook for contacts; the law costs some nanoseconds. Beside it stand the
//! engine with the best constant restitution, and each impact resolved in full.
//!
//! `cargo run --release` prints the table and writes `rapier-beam.csv` and `rapier-beam.svg`.

mod engine;
mod law;

use std::error::Error;
use std::fmt::Write as _;
use vibroimpact::plot::{Axis, Figure, Marker, Panel, Series};

/// Places of the drop are compared that the fit has not seen: these many, evenly spaced.
const PLACES: usize = 19;
/// Height of fall (m): about 1 m/s.
const DROP_M: f64 = 0.05;

fn main() -> Result<(), Box<dyn Error>> {
    let beam = law::Beam::new()?;
    let places: Vec<f64> = (1..=PLACES).map(|i| beam.length_m * i as f64 / (PLACES + 1) as f64).collect();
    let resolved: Vec<f64> = places.iter().map(|&x| beam.resolved(x)).collect::<Result<_, _>>()?;
    // the constant that fits these places best: more than a game's author would know
    let constant = resolved.iter().sum::<f64>() / resolved.len() as f64;
    let with_law: Vec<f64> =
        places.iter().map(|&x| engine::drop(&beam, x, DROP_M, |x| beam.restitution(x))).collect();
    let with_constant: Vec<f64> = places.iter().map(|&x| engine::drop(&beam, x, DROP_M, |_| constant)).collect();

    let mut table = String::from("location_m,restitution_resolved,restitution_law,restitution_engine_law,restitution_engine_constant\n");
    println!("{:>10}{:>12}{:>12}{:>16}{:>18}", "place (m)", "resolved", "EMOC law", "engine, EMOC", "engine, constant");
    for (i, &x) in places.iter().enumerate() {
        let law = beam.restitution(x);
        println!("{x:>10.3}{:>12.3}{law:>12.3}{:>16.3}{:>18.3}", resolved[i], with_law[i], with_constant[i]);
        writeln!(table, "{x},{},{law},{},{}", resolved[i], with_law[i], with_constant[i])?;
    }
    let rms = |seen: &[f64]| {
        let squares = seen.iter().zip(&resolved).map(|(seen, resolved)| (seen - resolved).powi(2));
        (squares.sum::<f64>() / seen.len() as f64).sqrt()
    };
    println!("\nrms error against the resolved impacts: EMOC {:.3}, constant {:.3}", rms(&with_law), rms(&with_constant));

    std::fs::write("rapier-beam.csv", table)?;
    picture(&places, &resolved, &with_law, &with_constant).write("rapier-beam.svg".as_ref())?;
    println!("wrote rapier-beam.csv and rapier-beam.svg");
    Ok(())
}

fn picture(places: &[f64], resolved: &[f64], with_law: &[f64], with_constant: &[f64]) -> Figure {
    let panel = Panel::new(Axis::new("place along the beam").unit("m"), Axis::new("restitution of the first bounce"))
        .with(Series::line(places, resolved).label("every contact resolved"))
        .with(Series::points(places, with_law, Marker::Circle).label("rapier, restitution by EMOC"))
        .with(Series::points(places, with_constant, Marker::Square).label("rapier, one constant"));
    Figure::new("A ball dropped on a pinned beam in a physics engine").row([panel])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_engine_does_what_the_law_says_and_the_law_beats_a_constant() {
        let beam = law::Beam::new().unwrap();
        let (mut of_law, mut of_constant) = (0.0, 0.0);
        let places = [0.12, 0.27, 0.38, 0.5, 0.67, 0.91];
        let resolved = places.map(|x| beam.resolved(x).unwrap());
        let constant = resolved.iter().sum::<f64>() / resolved.len() as f64;
        for (x, resolved) in places.into_iter().zip(resolved) {
            let seen = engine::drop(&beam, x, DROP_M, |x| beam.restitution(x));
            assert!((seen - beam.restitution(x)).abs() < 0.02, "{seen} at {x}");
            of_law += (seen - resolved).powi(2);
            of_constant += (constant - resolved).powi(2);
        }
        assert!(of_law < of_constant, "{of_law} {of_constant}");
    }
}
