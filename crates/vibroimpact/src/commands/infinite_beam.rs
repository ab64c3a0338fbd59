//! The command `infinite-beam`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use vibroimpact::export::{self, Failure};
use vibroimpact::infinite::{Summary, TurningPoints, files, picture, text, turning_points_text};
use vibroimpact::report;
use vibroimpact::trust::{Check, trust_text};
use vibroimpact::vibroimpact_sim::infinite::{MOST_TURNING_POINTS, Scale, Settings, Solution, Structure, solve};
use vibroimpact::{InvalidInput, Scene};

use super::products::{Products, with_files};
use super::source::Changes;
use super::voice::signature;

pub const EXAMPLES: &str = "Examples:
  vibroimpact infinite-beam --s 15                       a summary
  vibroimpact infinite-beam --s 15 --json                one JSON object for programs
  vibroimpact infinite-beam beam.json --out beam/        CSV tables, the picture impact.svg, result.json
  vibroimpact infinite-beam --s 15 --plot s15.png        the picture alone; .svg or .png
  vibroimpact infinite-beam turning-points --count 20    where the n-th separation disappears

With Hertz contact the impact depends only on S = C^10 k_H^2 m^8 v. S up to 1.5605 gives a rebound after one contact,
larger S one or more separations and then sustained contact, and S above 35264 sustained contact at once. S from 1e-12
to 1e10 can be solved. Within about 1e-6 of the critical S there are thousands of separations. The outcome may then be
\"stopped\", with the number of separations that are certain.
A scene has { \"kind\": \"infinite-beam\" } as its structure, with the section of a segment, and any contact.";

/// The impact to solve, and where its result goes.
#[derive(Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Arguments {
    /// A scene file whose structure is an infinite-beam; - reads the standard input
    #[arg(required_unless_present = "s", conflicts_with = "s")]
    scene: Option<PathBuf>,
    #[command(flatten)]
    changes: Changes,
    /// The nondimensional parameter S, in place of a scene
    #[arg(long, value_name = "S", value_parser = super::real, allow_hyphen_values = true, conflicts_with = "set")]
    s: Option<f64>,
    #[command(flatten)]
    products: Products,
    #[command(subcommand)]
    study: Option<Study>,
}

/// Studies over all S.
#[derive(Subcommand)]
enum Study {
    /// List the critical S and the turning points, at which the n-th separation disappears
    TurningPoints {
        /// Number of turning points, from the first (at the largest S); 1 to 60
        #[arg(long, value_name = "N", value_parser = super::whole(1..=MOST_TURNING_POINTS), allow_negative_numbers = true)]
        count: usize,
        /// Print one JSON object in place of the table
        #[arg(long)]
        json: bool,
    },
}

/// Runs the command and returns the text to print.
pub fn run(arguments: Arguments) -> Result<String, Failure> {
    match arguments {
        Arguments { study: Some(Study::TurningPoints { count, json }), .. } => list(count, json),
        Arguments { scene: Some(path), changes, products, .. } => {
            let draft = changes.draft(&path)?;
            let scene = draft.impact()?;
            if scene.structure.kind() != "infinite-beam" {
                let kind = format!("\"{}\"", scene.structure.kind());
                let allowed = "infinite-beam; vibroimpact simulate solves scenes of every kind".to_owned();
                return Err(InvalidInput::new(["structure", "kind"], kind, allowed).into());
            }
            products.require_room(&draft.files(), &[])?;
            let (scale, solution) = scene.solve_infinite()?;
            let json = export::json(&Summary::new(&solution, Some(&scale)))?;
            of_scene(&scene, (&scale, &solution), &[], None, json, &products)
        }
        Arguments { s, products, .. } => {
            let s = s.unwrap_or(f64::NAN);
            products.require_room(&[], &[])?;
            let of_s = |fault| super::renamed(fault, &[("s", "--s")]);
            let solution = solve(Structure::Beam, s, &Settings::default()).map_err(of_s)?;
            let headline = format!("Impact on an infinite beam, S = {s}");
            let json = export::json(&Summary::new(&solution, None))?;
            result(&headline, &solution, &Posed { scene: None, scale: None, trust: &[], until: None }, json, &products)
        }
    }
}

/// Returns the text to print for a scene with an infinite structure. Tables and figures extend until `until_s`; `json` is the
/// result for programs.
pub fn of_scene(
    scene: &Scene,
    (scale, solution): (&Scale, &Solution),
    trust: &[Check],
    until_s: Option<f64>,
    json: String,
    products: &Products,
) -> Result<String, Failure> {
    let headline = vibroimpact::text::infinite_headline(scene, &scene.posed_on_infinite()?.striker);
    let until = until_s.map(|until| until / scale.time_s);
    let posed = Posed { scene: Some(scene), scale: Some(scale), trust, until };
    result(&headline, solution, &posed, json, products)
}

/// Origin of an impact: a scene in physical units, or `S` alone.
struct Posed<'a> {
    scene: Option<&'a Scene>,
    scale: Option<&'a Scale>,
    /// How far its theory can be trusted.
    trust: &'a [Check],
    /// End of tables and figures (units of `T`), if it is stated.
    until: Option<f64>,
}

fn result(
    headline: &str,
    solution: &Solution,
    posed: &Posed,
    json: String,
    products: &Products,
) -> Result<String, Failure> {
    let &Posed { scene, scale, trust, until } = posed;
    let summary = Summary::new(solution, scale);
    let printed = if products.json {
        json.clone()
    } else {
        format!("{headline}\n\n{}{}{}", text(&summary), trust_text(trust), signature())
    };
    let figure = || picture(headline, solution, scale, until);
    with_files(printed, |printed| {
        products.write(
            printed,
            figure,
            |figure| report::of_infinite_impact(headline, scene, trust, &summary, figure),
            || files(json, solution, scale, until, &figure()),
        )
    })
}

fn list(count: usize, json: bool) -> Result<String, Failure> {
    let points = TurningPoints::first(count)?;
    if json { export::json(&points) } else { Ok(turning_points_text(&points)) }
}
