//! The command `simulate`.

use clap::Args;
use vibroimpact::assembly::{AnyScene, MOST_INTERVALS};
use vibroimpact::export::{Failure, Files};
use vibroimpact::model::{self, Answer};
use vibroimpact::simulate::{Resolved, Simulation};
use vibroimpact::trust::Check;
use vibroimpact::{InvalidInput, Scene, pictures, report, text, trust};

use super::bodies;
use super::headline;
use super::heartbeat::watched;
use super::infinite_beam;
use super::products::Products;
use super::source::SceneSource;
use super::voice::signature;

pub const EXAMPLES: &str = "Examples:
  vibroimpact simulate ball.json                 a summary to read
  vibroimpact simulate ball.json --json          one JSON object for programs
  vibroimpact simulate ball.json --out ball/     CSV histories, the picture impact.svg, result.json
  vibroimpact simulate ball.json --plot ball.png the picture alone; .svg or .png
  vibroimpact simulate ball.json --out ball/ --until 0.5
                                                 histories until half a second after the clock has started
  vibroimpact simulate ball.json --report b.html a page with pictures and tables that needs no other file

A scene with bodies in place of structure and striker is followed until its end_s or until it rests; progress is shown
on long runs, and Ctrl-C keeps what was found. Then --out writes history.csv, intervals.csv and .parquet, run.svg,
report.html, result.json, and section.csv where a load is harmonic.

The exit code is 0 for every result, sustained contact and a computation that stopped among them, 2 for a scene that cannot be
used (the message names the field, its value and what is allowed; nothing is written), 1 if writing fails.";

/// What to solve, and where to put it.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneSource,
    #[command(flatten)]
    extent: Extent,
    #[command(flatten)]
    products: Products,
}

/// How much of a course in time is shown.
#[derive(Args)]
pub struct Extent {
    /// List at most so many intervals of contact of a scene of bodies, the first ones; files hold all
    #[arg(long, value_name = "N", default_value_t = MOST_INTERVALS)]
    intervals: usize,
    /// How far histories and pictures go, from the start of the clock; a little past the last contact when left out
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    until: Option<f64>,
}

impl Default for Extent {
    fn default() -> Extent {
        Extent { intervals: MOST_INTERVALS, until: None }
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| *seconds > 0.0 && seconds.is_finite());
    seconds.ok_or_else(|| "allowed is a time in seconds, a finite number greater than 0".to_owned())
}

/// Carries the command out and returns what is to be printed.
pub fn run(Arguments { scene, extent, products }: Arguments) -> Result<String, Failure> {
    let scene = scene.any()?;
    products.require_room()?;
    answer(scene, extent, &products)
}

/// Solves a scene and returns what is to be printed of it.
pub fn answer(scene: AnyScene, extent: Extent, products: &Products) -> Result<String, Failure> {
    let Extent { intervals, until } = extent;
    let scene = match (scene, until) {
        (AnyScene::Impact(scene), _) => *scene,
        // it tells by itself how far it has come
        (AnyScene::Bodies(scene), None) => return bodies::simulate(&scene, intervals, products),
        (AnyScene::Bodies(_), Some(until)) => {
            let allowed = "left out for a scene of bodies, whose field end_s says how far it goes".to_owned();
            return Err(InvalidInput { field: "--until".into(), value: Some(until.to_string()), allowed }.into());
        }
    };
    let found = watched("simulate", || scene.simulate())?;
    let scene = found.scene(&scene);
    let trust = scene.trust(&found)?;
    match &found {
        Simulation::Modal(resolved) => in_modes(&scene, found.json(&scene)?, &trust, resolved, until, products),
        Simulation::Infinite { groups, solution } => {
            infinite_beam::of_scene(&scene, (groups, solution), &trust, until, found.json(&scene)?, products)
        }
        Simulation::Net(answer) => without_course(&scene, found.json(&scene)?, &trust, answer, products),
    }
}

fn in_modes(
    scene: &Scene,
    json: String,
    trust: &[Check],
    resolved: &Resolved,
    until: Option<f64>,
    products: &Products,
) -> Result<String, Failure> {
    let Resolved { impact, summary, .. } = resolved;
    let headline = text::headline(scene, &impact.striker);
    let printed = if products.json {
        json.clone()
    } else {
        format!("{headline}\n\n{}{}{}", text::result(summary), trust::trust_text(trust), signature())
    };
    let reason = summary.choice.as_ref().map_or("", |choice| &choice.reason);
    let modelled = report::modelled(scene, impact, reason);
    let until_s = resolved.until_s(until);
    let figure = || pictures::impact(&headline, resolved, until_s);
    let told = products.write(
        figure,
        |figure| report::of_impact(&headline, scene, &modelled, trust, resolved, figure),
        || Files::new(json, resolved, until_s, &figure()),
    )?;
    Ok(printed + &told)
}

/// A model that has no course in time.
fn without_course(
    scene: &Scene,
    json: String,
    trust: &[Check],
    answer: &Answer,
    products: &Products,
) -> Result<String, Failure> {
    let headline = headline(scene)?;
    let printed = if products.json {
        json.clone()
    } else {
        let trust = trust::trust_text(trust);
        let hint = "\n  This model gives the net result alone; \"model\": \"modal\" resolves the course in time.\n";
        format!("{headline}\n\n{}{trust}{hint}{}", model::net_text(answer), signature())
    };
    let figure = || pictures::of_answer(&headline, answer);
    let told = products.write(
        figure,
        |figure| report::of_net_impact(&headline, scene, trust, answer, figure),
        || Files::of_net(json, &figure()),
    )?;
    Ok(printed + &told)
}
