//! The command `sensitivity`.

use clap::Args;
use vibroimpact::assembly::{self, AnyScene};
use vibroimpact::export::{self, Failure};
use vibroimpact::sensitivity;

use super::headline;
use super::products::{Picture, with_files};
use super::source::SceneSource;

pub const EXAMPLES: &str = "Examples:
  vibroimpact sensitivity ball.json                 the restitution with respect to every number of the scene
  vibroimpact sensitivity ball.json --by striker.mass_kg,location_m
                                                    with respect to these two fields
  vibroimpact sensitivity ball.json --of sub_impacts[0].peak_force_n --plot peak.svg
                                                    the first peak of the force, as a table and as a tornado picture
  vibroimpact sensitivity ball.json --json          all outputs by all fields
  vibroimpact sensitivity rattle.json --by contacts[0].gap_m --of points[0].velocity_m_s
                                                    a scene of bodies: how fast a point is at the end

Derivatives are computed from the motion itself, not from differences of two impacts. They hold for small changes: an impact
with several contacts may lose or gain one after a larger change. The result states how close the nearest contact is to this.";

/// The derivatives to compute.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneSource,
    /// Paths of fields of the scene, separated by commas; default: every number of the scene
    #[arg(long, value_name = "FIELDS", value_delimiter = ',')]
    by: Vec<String>,
    /// Output that the table and the picture show; default: the restitution, or the first impulse of a scene of bodies
    #[arg(long, value_name = "OUTPUT")]
    of: Option<String>,
    /// Print one JSON object with all outputs in place of the table
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    picture: Picture,
}

/// Runs the command and returns the text to print.
pub fn run(Arguments { scene, by, of, json, picture }: Arguments) -> Result<String, Failure> {
    let draft = scene.draft()?;
    picture.require_room(&draft.files(), &[])?;
    let (printed, figure) = match draft.any()? {
        AnyScene::Impact(scene) => {
            let found = scene.sensitivity(&by)?;
            let of = of.as_deref().unwrap_or("restitution");
            let text = sensitivity::text(&found, of)?;
            let printed = if json { export::json(&found)? } else { format!("{}\n\n{text}", headline(&scene)?) };
            (printed, sensitivity::figure(&found.table, of)?)
        }
        AnyScene::Bodies(scene) => {
            let found = scene.sensitivity(&by)?;
            let of = of.as_deref().unwrap_or_else(|| found.first_output());
            let text = sensitivity::text_of_bodies(&found, of)?;
            let headline = assembly::headline(&scene, &scene.pose()?);
            let printed = if json { export::json(&found)? } else { format!("{headline}\n\n{text}") };
            (printed, sensitivity::figure(&found.table, of)?)
        }
    };
    with_files(printed, |printed| picture.draw(printed, json, || Ok(figure)))
}
