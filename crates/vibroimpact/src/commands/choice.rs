//! The commands `plan` and `compare`, which show the choice of the model and all models.

use clap::Args;
use vibroimpact::export::{self, Failure};
use vibroimpact::{model, pictures};

use super::headline;
use super::products::{Picture, with_files};
use super::source::SceneSource;
use super::voice::signature;

pub const PLAN_EXAMPLES: &str = "Examples:
  vibroimpact plan ball.json                     for each model: whether it applies, its expected error, its cost
  vibroimpact plan ball.json --json              the same as one JSON object

No costly impact is solved. These fields of the scene determine the choice, and each of them may be left out:

  \"model\": \"auto\", \"rigid\", \"infinite-beam\", \"modal\" or \"emoc\"
  \"modes\": \"auto\", or the number of modes that the structure is stated to have
  \"tolerance\": requested accuracy of the restitution, which includes truncation where the program chooses the modes;
               1e-3 by default";

pub const COMPARE_EXAMPLES: &str = "Examples:
  vibroimpact compare ball.json                  restitution, uncertainty, cost of every model
  vibroimpact compare ball.json --json           the same as one JSON object
  vibroimpact compare ball.json --plot models.svg
                                                 restitutions with their uncertainties; .svg or .png

Models that do not apply are listed with the reason. Differences are from the model with the
smallest uncertainty.";

/// The scene to plan.
#[derive(Args)]
pub struct PlanArguments {
    #[command(flatten)]
    scene: SceneSource,
    /// Print one JSON object in place of the table
    #[arg(long)]
    json: bool,
}

/// The scene to solve with every model.
#[derive(Args)]
pub struct CompareArguments {
    #[command(flatten)]
    scene: SceneSource,
    /// Print one JSON object in place of the table
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    picture: Picture,
}

/// Runs `plan` and returns the text to print.
pub fn plan(PlanArguments { scene, json }: PlanArguments) -> Result<String, Failure> {
    let plan = scene.impact()?.plan()?;
    if json { export::json(&plan) } else { Ok(model::plan_text(&plan)) }
}

/// Runs `compare` and returns the text to print.
pub fn compare(CompareArguments { scene, json, picture }: CompareArguments) -> Result<String, Failure> {
    let draft = scene.draft()?;
    let scene = draft.impact()?;
    picture.require_room(&draft.files(), &[])?;
    let comparison = scene.compare()?;
    let printed = if json { export::json(&comparison)? } else { model::comparison_text(&comparison) + &signature() };
    with_files(printed, |printed| {
        picture.draw(printed, json, || Ok(pictures::of_comparison(&headline(&scene)?, &comparison)))
    })
}
