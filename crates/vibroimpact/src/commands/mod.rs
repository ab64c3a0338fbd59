//! The commands, one file for each: arguments, help, and printed text.

pub mod bodies;
pub mod choice;
pub mod first;
pub mod heartbeat;
pub mod identify;
pub mod infinite_beam;
pub mod law;
pub mod modes;
pub mod net;
pub mod orbit;
pub mod predictability;
pub mod products;
pub mod sensitivity;
pub mod shell;
pub mod simulate;
pub mod source;
pub mod sweep;
pub mod voice;

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

use vibroimpact::export::Failure;
use vibroimpact::vibroimpact_sim::modal::Striker;
use vibroimpact::{InvalidInput, Scene, scene, text};

/// Reads the value of an option that asks for a whole number in a range.
fn whole<T>(range: RangeInclusive<T>) -> impl Fn(&str) -> Result<T, String> + Clone
where
    T: FromStr + PartialOrd + Display + Clone,
{
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| format!("it must be a whole number from {} to {}", range.start(), range.end()))
    }
}

/// The value of an option that asks for a number.
fn real(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "it must be a number".to_owned())
}

/// The error for a number of modes that an option gave.
fn of_option(option: &str) -> impl Fn(InvalidInput) -> InvalidInput {
    move |fault| renamed(fault, &[("modes", option)])
}

/// An error in a field that an option gave, under the name of the option.
fn renamed(fault: InvalidInput, options: &[(&str, &str)]) -> InvalidInput {
    match options.iter().find(|(field, _)| fault.field == *field) {
        Some((_, option)) => fault.under(*option),
        None => fault,
    }
}

/// A scene in a line.
fn headline(scene: &Scene) -> Result<String, Failure> {
    if scene.is_infinite() {
        return Ok(text::infinite_headline(scene, &scene.posed_on_infinite()?.striker));
    }
    // the speed of a dropped rod is not that of a striker
    let rod = matches!(scene.structure, scene::Structure::DroppedRod(_));
    let mass_kg = if rod { f64::NAN } else { scene.striker.mass_kg()? };
    Ok(text::headline(scene, &Striker { mass_kg, speed_m_s: scene.striker.speed_m_s }))
}
