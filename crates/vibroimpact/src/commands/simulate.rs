//! The command `simulate`.

use std::path::PathBuf;

use clap::Args;
use vibroimpact::assembly::{AnyScene, MOST_INTERVALS};
use vibroimpact::export::{Failure, Files};
use vibroimpact::model::{self, Answer, Model};
use vibroimpact::scene::Location;
use vibroimpact::simulate::{Resolved, Simulation};
use vibroimpact::trust::Check;
use vibroimpact::{InvalidInput, Scene, pictures, report, text, trust};

use super::bodies;
use super::headline;
use super::heartbeat::watched;
use super::infinite_beam;
use super::products::{Output, Products, with_files, write_single};
use super::source::SceneSource;
use super::voice::signature;

pub const EXAMPLES: &str = "Examples:
  vibroimpact simulate ball.json                 a summary
  vibroimpact simulate ball.json --json          one JSON object for programs
  vibroimpact simulate ball.json --out ball/     CSV histories, the picture impact.svg, result.json
  vibroimpact simulate ball.json --plot ball.png the picture alone; .svg or .png
  vibroimpact simulate ball.json --animate a.svg an animation of beam and ball in slow motion, for a browser
  vibroimpact simulate ball.json --out ball/ --until 0.5
                                                 histories up to 0.5 s
  vibroimpact simulate ball.json --report b.html a page with pictures and tables that needs no other file

A scene with bodies in place of structure and striker is followed until its end_s or until it rests; progress is shown
on long runs, and Ctrl-C keeps what was found. Then --out writes history.csv, intervals.csv and .parquet, run.svg,
report.html, result.json, and section.csv where a load is harmonic.

The exit code is 0 for every result, including sustained contact and a computation that stopped early, 2 for a scene that
cannot be used (the message names the field, its value and what is allowed; nothing is written), 1 if writing fails.";

/// The scene to solve, and where its result goes.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneSource,
    #[command(flatten)]
    products: Products,
    #[command(flatten)]
    extent: Extent,
}

/// The extent of the motion that is shown.
#[derive(Args)]
pub struct Extent {
    /// Write an animation of beam and ball in slow motion to this file, .svg
    #[arg(long, value_name = "FILE", value_parser = svg_file)]
    animate: Option<PathBuf>,
    /// Time at which histories and pictures end, from the start of the impact; default: a little after the last contact, or after a period of the slowest vibration if there is none
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
    until: Option<f64>,
    /// Largest number of intervals of contact that are listed for a scene of bodies; the files contain all
    #[arg(long, value_name = "N", value_parser = super::whole(0..=usize::MAX), default_value_t = MOST_INTERVALS, allow_negative_numbers = true)]
    intervals: usize,
}

impl Extent {
    /// The file that it requests.
    pub fn output(&self) -> Output<'_> {
        ("--animate", self.animate.as_deref())
    }

    /// The error for a result without a course in time, which has neither histories nor an animation.
    fn require_no_course(&self, model: Model) -> Result<(), InvalidInput> {
        self.require_still()?;
        match self.until {
            None => Ok(()),
            Some(until) => {
                let allowed = format!(
                    "left out, because the model {} gives the net result alone; \"model\": \"modal\" resolves the motion in time",
                    model.as_str()
                );
                Err(InvalidInput::new("--until", until.to_string(), allowed))
            }
        }
    }

    /// The error for a motion that cannot be animated.
    fn require_still(&self) -> Result<(), InvalidInput> {
        match &self.animate {
            None => Ok(()),
            Some(path) => {
                let allowed = "left out for this scene, because only an impact on a beam or a string that is resolved in \
                               time can be shown";
                Err(InvalidInput::new("--animate", path.display().to_string(), allowed))
            }
        }
    }
}

fn svg_file(name: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    let is_svg = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"));
    if is_svg { Ok(path) } else { Err("it must be a file name that ends in .svg".to_owned()) }
}

fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| (1e-30..=1e12).contains(seconds));
    seconds
        .ok_or_else(|| "it must be a time in seconds, a finite number greater than 0 (from 1e-30 to 1e12)".to_owned())
}

/// Runs the command and returns the text to print.
pub fn run(Arguments { scene, extent, products }: Arguments) -> Result<String, Failure> {
    let draft = scene.draft()?;
    let scene = draft.any()?;
    products.require_room(&draft.files(), &[extent.output()])?;
    answer(scene, extent, &products)
}

/// Solves a scene and returns the text to print.
pub fn answer(scene: AnyScene, extent: Extent, products: &Products) -> Result<String, Failure> {
    let (intervals, until) = (extent.intervals, extent.until);
    if matches!(&scene, AnyScene::Bodies(_)) {
        extent.require_still()?;
    }
    let scene = match (scene, until) {
        (AnyScene::Impact(scene), _) => *scene,
        // it reports its progress itself
        (AnyScene::Bodies(scene), None) => return bodies::simulate(&scene, intervals, products),
        (AnyScene::Bodies(_), Some(until)) => {
            let allowed = "left out for a scene of bodies, whose field end_s states the end".to_owned();
            return Err(InvalidInput::new("--until", until.to_string(), allowed).into());
        }
    };
    let found = watched("simulate", || scene.simulate())?;
    let scene = found.scene(&scene);
    let trust = scene.trust(&found)?;
    let json = found.json_with(&scene, trust.clone())?;
    match &found {
        Simulation::Modal(resolved) => in_modes(&scene, json, &trust, resolved, &extent, products),
        Simulation::Infinite { scale, solution } => {
            extent.require_still()?;
            infinite_beam::of_scene(&scene, (scale, solution), &trust, until, json, products)
        }
        Simulation::Net(answer) => {
            extent.require_no_course(answer.model)?;
            without_course(&scene, json, &trust, answer, products)
        }
    }
}

fn in_modes(
    scene: &Scene,
    json: String,
    trust: &[Check],
    resolved: &Resolved,
    extent: &Extent,
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
    let until_s = resolved.until_s(extent.until);
    let animation = animation(scene, &headline, resolved, extent, until_s)?;
    let figure = || pictures::impact(&headline, resolved, until_s);
    with_files(printed, |printed| {
        products.write(
            printed,
            figure,
            |figure| report::of_impact(&headline, scene, &modelled, trust, resolved, figure),
            || Files::new(json, resolved, until_s, &figure()),
        )?;
        match (&extent.animate, animation) {
            (Some(path), Some(animation)) => write_single(printed, path, animation.as_bytes(), products.json),
            _ => Ok(()),
        }
    })
}

/// The animation, if it is requested.
fn animation(
    scene: &Scene,
    headline: &str,
    resolved: &Resolved,
    extent: &Extent,
    until_s: f64,
) -> Result<Option<String>, Failure> {
    if extent.animate.is_none() {
        return Ok(None);
    }
    let (Some(Location::Along(location_m)), Some(deflection)) =
        (scene.location_m, resolved.deflection(scene, until_s, FRAMES)?)
    else {
        extent.require_still()?;
        return Ok(None);
    };
    Ok(Some(pictures::animation(headline, location_m, &deflection, &resolved.history)))
}

/// Intervals of the length and of the time in an animation.
const FRAMES: [usize; 2] = [48, 240];

/// The error for a model that does not resolve the motion in time.
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
        let hint = "\n  This model gives the net result alone; \"model\": \"modal\" resolves the motion in time.\n";
        format!("{headline}\n\n{}{trust}{hint}{}", model::net_text(answer), signature())
    };
    let figure = || pictures::of_answer(&headline, answer);
    with_files(printed, |printed| {
        products.write(
            printed,
            figure,
            |figure| report::of_net_impact(&headline, scene, trust, answer, figure),
            || Files::of_net(json, &figure()),
        )
    })
}
