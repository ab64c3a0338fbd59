//! The command `simulate`.

use std::path::PathBuf;

use clap::Args;
use vibroimpact::export::{self, Failure, Files};
use vibroimpact::model::{self, Answer};
use vibroimpact::simulate::{Resolved, Simulation};
use vibroimpact::{Scene, pictures, report, text};

use super::headline;
use super::infinite_beam;
use super::products::Products;

pub const EXAMPLES: &str = "Examples:
  vibroimpact simulate ball.json                 a summary to read
  vibroimpact simulate ball.json --json          one JSON object for programs
  vibroimpact simulate ball.json --out ball/     CSV histories, the picture impact.svg, result.json
  vibroimpact simulate ball.json --plot ball.png the picture alone; .svg or .png
  vibroimpact simulate ball.json --report b.html a page with pictures and tables that needs no other file

The exit code is 0 for every result, sustained contact and a limit reached among them, 2 for a scene that cannot be
used (the message names the field, its value and what is allowed; nothing is written), 1 if writing fails.";

/// What to solve, and where to put it.
#[derive(Args)]
pub struct Arguments {
    /// The scene file
    scene: PathBuf,
    #[command(flatten)]
    products: Products,
}

/// Carries the command out and returns what is to be printed.
pub fn run(Arguments { scene, products }: Arguments) -> Result<String, Failure> {
    let scene = Scene::read(&scene)?;
    let found = scene.simulate()?;
    match &found {
        Simulation::Modal(resolved) => in_modes(&scene, &found, resolved, &products),
        Simulation::Infinite { groups, solution } => infinite_beam::of_scene(&scene, groups, solution, &products),
        Simulation::Net(answer) => without_course(&scene, answer, &products),
    }
}

fn in_modes(scene: &Scene, found: &Simulation, resolved: &Resolved, products: &Products) -> Result<String, Failure> {
    let Resolved { impact, summary, history } = resolved;
    let headline = text::headline(scene, &impact.striker);
    let printed = if products.json { found.json()? } else { format!("{headline}\n\n{}", text::result(summary)) };
    let reason = summary.choice.as_ref().map_or("", |choice| &choice.reason);
    let modelled = report::modelled(scene, impact, reason);
    let told = products.write(
        || pictures::impact(&headline, summary, history),
        |figure| report::of_impact(&headline, scene, &modelled, summary, figure),
        || Files::new(&headline, summary, history),
    )?;
    Ok(printed + &told)
}

/// A model that has no course in time.
fn without_course(scene: &Scene, answer: &Answer, products: &Products) -> Result<String, Failure> {
    products.refuse_pictures(answer.model)?;
    let result = export::json(answer)?;
    if products.json {
        products.write_files(|| Ok(Files::result(result.clone())))?;
        return Ok(result);
    }
    let headline = headline(scene)?;
    let told = products.write_files(|| Ok(Files::result(result)))?;
    let hint = "\n  This model has no histories; \"model\": \"modal\" resolves the course in time.\n";
    Ok(format!("{headline}\n\n{}{told}{hint}", model::net_text(answer)))
}
