//! The command `simulate`.

use std::path::PathBuf;

use clap::Args;
use vibroimpact::assembly::{AnyScene, MOST_INTERVALS};
use vibroimpact::export::{self, Failure, Files};
use vibroimpact::model::{self, Answer};
use vibroimpact::simulate::{Resolved, Simulation};
use vibroimpact::{Scene, pictures, report, text};

use super::bodies;
use super::headline;
use super::infinite_beam;
use super::products::Products;

pub const EXAMPLES: &str = "Examples:
  vibroimpact simulate ball.json                 a summary to read
  vibroimpact simulate ball.json --json          one JSON object for programs
  vibroimpact simulate ball.json --out ball/     CSV histories, the picture impact.svg, result.json
  vibroimpact simulate ball.json --plot ball.png the picture alone; .svg or .png
  vibroimpact simulate ball.json --report b.html a page with pictures and tables that needs no other file

A scene with bodies in place of structure and striker is followed until its end_s or until it rests; progress is shown
on long runs, and Ctrl-C keeps what was found. Then --out writes history.csv, intervals.csv and .parquet, run.svg,
report.html, result.json, and section.csv where a load is harmonic.

The exit code is 0 for every result, sustained contact and a computation that stopped among them, 2 for a scene that cannot be
used (the message names the field, its value and what is allowed; nothing is written), 1 if writing fails.";

/// What to solve, and where to put it.
#[derive(Args)]
pub struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// List at most so many intervals of contact of a scene of bodies, the first ones; files hold all
    #[arg(long, value_name = "N", default_value_t = MOST_INTERVALS)]
    intervals: usize,
    #[command(flatten)]
    products: Products,
}

/// Carries the command out and returns what is to be printed.
pub fn run(Arguments { scene, intervals, products }: Arguments) -> Result<String, Failure> {
    let scene = match AnyScene::read(&scene)? {
        AnyScene::Impact(scene) => *scene,
        AnyScene::Bodies(scene) => return bodies::simulate(&scene, intervals, &products),
    };
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
