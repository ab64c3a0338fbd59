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

use vibroimpact::export::Failure;
use vibroimpact::scene::MOST_MODES;
use vibroimpact::vibroimpact_sim::modal::Striker;
use vibroimpact::{InvalidInput, Scene, scene, text};

/// The value of an option that asks for a whole number.
fn whole<T: std::str::FromStr>(text: &str) -> Result<T, String> {
    text.parse().map_err(|_| "it must be a whole number not less than 0".to_owned())
}

/// The value of an option that asks for a number.
fn real(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "it must be a number".to_owned())
}

/// The value of an option that asks for a number of modes.
fn mode_count(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (1..=MOST_MODES).contains(count));
    count.ok_or_else(|| format!("it must be a whole number from 1 to {MOST_MODES}"))
}

/// The error for a number of modes that an option gave.
fn of_option(option: &str) -> impl Fn(InvalidInput) -> InvalidInput {
    move |fault| if fault.field == "modes" { fault.under(option) } else { fault }
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
