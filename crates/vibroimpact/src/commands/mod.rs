//! The commands, a file each: arguments, help, and what is printed.

pub mod bodies;
pub mod choice;
pub mod infinite_beam;
pub mod modes;
pub mod net;
pub mod shell;
pub mod simulate;
pub mod sweep;

mod products;

use vibroimpact::export::Failure;
use vibroimpact::vibroimpact_sim::modal::Striker;
use vibroimpact::{Scene, scene, text};

/// A scene in a line.
fn headline(scene: &Scene) -> Result<String, Failure> {
    if scene.is_infinite() {
        return Ok(text::infinite_headline(scene, &scene.infinite_impact()?));
    }
    // that of a dropped rod is not the striker's
    let rod = matches!(scene.structure, scene::Structure::DroppedRod(_));
    let mass_kg = if rod { f64::NAN } else { scene.striker.mass_kg()? };
    Ok(text::headline(scene, &Striker { mass_kg, speed_m_s: scene.striker.speed_m_s }))
}
