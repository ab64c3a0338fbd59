//! The command `modes`.

use std::path::PathBuf;

use clap::Args;
use vibroimpact::export::{self, Failure};
use vibroimpact::summary::ModeTable;
use vibroimpact::{Scene, pictures, text};

use super::products::{self, picture_file};

pub const EXAMPLES: &str = "Examples:
  vibroimpact modes ball.json --count 10         frequencies, and shapes at the point of impact
  vibroimpact modes ball.json --count 40 --json  the same as one JSON object of lists
  vibroimpact modes ball.json --count 6 --plot modes.svg
                                                 shapes along the beam, with the place of impact; .svg or .png

Shapes are mass-normalised (kg^-1/2). Rigid-body modes come first, with omega 0.";

/// Which modes.
#[derive(Args)]
pub struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// How many modes, from the lowest
    #[arg(long, value_name = "N")]
    count: usize,
    /// Print one JSON object in place of the table
    #[arg(long)]
    json: bool,
    /// Draw the modes into this file, .svg or .png
    #[arg(long, value_name = "FILE", value_parser = picture_file)]
    plot: Option<PathBuf>,
}

/// Carries the command out and returns what is to be printed.
pub fn run(Arguments { scene, count, json, plot }: Arguments) -> Result<String, Failure> {
    let scene = Scene::read(&scene)?;
    let modes = scene.mode_shapes(count)?;
    let printed = if json { export::json(&ModeTable::new(&modes))? } else { text::modes(&modes) };
    let told = match plot {
        Some(path) => products::draw(&path, &pictures::modes(&scene, count)?, json)?,
        None => String::new(),
    };
    Ok(printed + &told)
}
