//! The command `modes`.

use clap::Args;
use vibroimpact::export::{self, Failure};
use vibroimpact::scene::{MOST_MODES, Structure};
use vibroimpact::summary::ModeTable;
use vibroimpact::{pictures, text};

use super::products::{Picture, with_files};
use super::source::SceneSource;
use super::{of_option, whole};

pub const EXAMPLES: &str = "Examples:
  vibroimpact modes ball.json                    ten frequencies, and shapes at the point of impact
  vibroimpact modes ball.json --count 40 --json  the same as one JSON object of lists
  vibroimpact modes ball.json --count 6 --plot modes.svg
                                                 shapes along the beam or over the plate, with the location of impact;
                                                 .svg or .png

Shapes are mass-normalised (kg^-1/2). Rigid-body modes come first and have omega 0.";

/// Number of modes that are listed if none is stated.
const COUNT: usize = 10;

/// The modes to list.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneSource,
    /// Number of modes, from the lowest; default: 10, or all of a shorter list
    #[arg(long, value_name = "N", value_parser = whole(1..=MOST_MODES), allow_negative_numbers = true)]
    count: Option<usize>,
    /// Print one JSON object in place of the table
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    picture: Picture,
}

/// Runs the command and returns the text to print.
pub fn run(Arguments { scene, count, json, picture }: Arguments) -> Result<String, Failure> {
    let draft = scene.draft()?;
    let scene = draft.impact()?;
    picture.require_room(&draft.files(), &[])?;
    let count = count.unwrap_or(match &scene.structure {
        Structure::Modal(listed) => COUNT.min(listed.omega_rad_s.len()),
        _ => COUNT,
    });
    let modes = scene.mode_shapes(count).map_err(of_option("--count"))?;
    let converged = scene.converged_modes(count).map_err(of_option("--count"))?;
    let printed = if json { export::json(&ModeTable::new(&modes, converged))? } else { text::modes(&modes, converged) };
    with_files(printed, |printed| picture.draw(printed, json, || Ok(pictures::modes(&scene, count)?)))
}
