//! The command `sensitivity`.

use clap::Args;
use vibroimpact::export::{self, Failure};
use vibroimpact::sensitivity;

use super::headline;
use super::products::Picture;
use super::source::SceneSource;

pub const EXAMPLES: &str = "Examples:
  vibroimpact sensitivity ball.json                 the restitution by every number of the scene
  vibroimpact sensitivity ball.json --by striker.mass_kg,location_m
                                                    by these two
  vibroimpact sensitivity ball.json --of sub_impacts[0].peak_force_n --plot peak.svg
                                                    the first peak of the force, as a table and as a tornado picture
  vibroimpact sensitivity ball.json --json          all outputs by all fields

A derivative is exact: it goes along the motion, and no second impact is compared. It holds for small changes; an impact
with several contacts may lose or gain one soon after. How near its slowest contact is to that is told.";

/// Which derivatives.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneSource,
    /// Fields of the scene, by their paths and separated by commas; every number of the scene where left out
    #[arg(long, value_name = "FIELDS", value_delimiter = ',')]
    by: Vec<String>,
    /// The output that the table and the picture are of
    #[arg(long, value_name = "OUTPUT", default_value = "restitution")]
    of: String,
    /// Print one JSON object with all outputs in place of the table
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    picture: Picture,
}

/// Carries the command out and returns what is to be printed.
pub fn run(Arguments { scene, by, of, json, picture }: Arguments) -> Result<String, Failure> {
    let scene = scene.impact()?;
    picture.require_room()?;
    let found = scene.sensitivity(&by)?;
    let table = sensitivity::text(&found, &of)?;
    let printed = if json { export::json(&found)? } else { format!("{}\n\n{table}", headline(&scene)?) };
    Ok(printed + &picture.draw(json, || Ok(sensitivity::figure(&found, &of)?))?)
}
