//! An impact as an assembly: the structure is one body, the striker another, and they share one contact.

use super::problem::{Mode, Start, Striker, height_m};
use crate::assembly::{Assembly, Body, Contact, Load, Point};

/// Mass of a moving stop relative to the structure, so large that no contact slows it down.
const IMMOVABLE: f64 = 1e30;

/// Indices of the structure and of the striker among the bodies. A stop at rest is not a body.
pub(crate) const STRUCTURE: usize = 0;
pub(crate) const STRIKER: usize = 1;

/// Mass with which the striker enters the equations (kg); `None` for a stop at rest.
pub(crate) fn mass_kg(striker: &Striker, modes: &[Mode]) -> Option<f64> {
    if striker.mass_kg.is_finite() {
        return Some(striker.mass_kg);
    }
    let inverse: f64 = modes.iter().map(|mode| mode.shape * mode.shape).sum();
    (striker.speed_m_s != 0.0).then_some(IMMOVABLE / inverse)
}

/// Weight of the striker's own mode in its motion (kg^-1/2); zero for a stop at rest.
pub(crate) fn weight(striker: &Striker, modes: &[Mode]) -> f64 {
    mass_kg(striker, modes).map_or(0.0, |mass_kg| mass_kg.sqrt().recip())
}

/// The impact of a striker, which may have a weight, on some modes of the structure, without the law of their contact.
pub(crate) fn assembly(
    (modes, moved): (&[Mode], &[usize]),
    striker: &Striker,
    start: &Start,
    weight: Option<Load>,
) -> Assembly<()> {
    let pick = |values: &[f64]| moved.iter().map(|k| values[*k]).collect::<Vec<f64>>();
    let shape: Vec<f64> = moved.iter().map(|k| modes[*k].shape).collect();
    let structure = Body {
        modes: moved.iter().map(|k| modes[*k].of_body()).collect(),
        amplitude: pick(&start.amplitude),
        rate: pick(&start.rate),
    };
    let (bodies, side) = match mass_kg(striker, modes) {
        Some(mass_kg) => {
            let side = Point::OfBody { body: STRIKER, shape: vec![mass_kg.sqrt().recip()] };
            (vec![structure, Body::mass(mass_kg, 0.0, -striker.speed_m_s)], side)
        }
        None => (vec![structure], Point::Ground),
    };
    let sides = [side, Point::OfBody { body: STRUCTURE, shape }];
    let contacts = vec![Contact { sides, gap_m: height_m(modes, start), law: () }];
    Assembly { bodies, contacts, loads: weight.into_iter().collect() }
}
