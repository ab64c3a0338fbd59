//! The command `orbit`.

use std::path::PathBuf;
use std::sync::atomic::Ordering;

use clap::Args;
use vibroimpact::InvalidInput;
use vibroimpact::assembly;
use vibroimpact::export::Failure;
use vibroimpact::orbit::{self, Over};
use vibroimpact::vibroimpact_sim::assembly::OrbitSettings;

use super::products::{Picture, with_files, write_single};
use super::source::SceneSource;
use super::sweep::stop_on_signal;
use super::voice::signature;

pub const EXAMPLES: &str = "Examples:
  vibroimpact orbit rig.json                     the periodic motion to which the start leads
  vibroimpact orbit rig.json --periods 2         a motion that repeats itself after two periods of the load
  vibroimpact orbit rig.json --over 'loads[0].frequency_hz' --from 20 --to 80 --plot response.svg
                                                 the frequency response, with its unstable parts
  vibroimpact orbit rig.json --over 'loads[0].force_n' --to 50 --json --csv branch.csv
  vibroimpact orbit rig.json --over 'loads[0].force_n' --to 50 --branches 2 --plot bifurcations.svg
                                                 also the motions that begin on the way, of two and four periods

The scene is one of bodies with a harmonic load, or with several that have a common period. After a transient from its
start, Newton's method finds the periodic motion; its Floquet multipliers show whether it is stable. If it fails, the
motion is followed for many more periods (--search), and Newton's method begins where it nearly repeats itself. Over a
field (a path as in a sweep) the branch is followed round its folds, and folds, losses of symmetry (pitchforks), period
doublings, Neimark-Sacker points and grazings are located. With --branches the motions that begin at period doublings
(of twice the period) and at pitchforks (one of the two that are mirror images) are followed too. A sweep over fields of the start shows to which motion a start leads. Ctrl-C ends
the search and prints the results so far.

The exit code is 0 for every result, 2 for an invalid scene or field, 1 if writing fails.";

/// The periodic motion to find, and the file for its branch.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneSource,
    /// Periods of the load after which the motion repeats itself; for several loads, their common periods
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = super::whole::<u32>(1..=1000), allow_negative_numbers = true)]
    periods: u32,
    /// Periods of the load that are followed from the start before the search
    #[arg(long, value_name = "N", value_parser = super::whole::<u32>(0..=u32::MAX), default_value_t = 100, allow_negative_numbers = true)]
    transient: u32,
    /// Periods of the load that are followed in search of near returns if the transient leads to no periodic motion
    #[arg(long, value_name = "N", default_value_t = 1500, value_parser = super::whole::<u32>(0..=10_000_000), allow_negative_numbers = true)]
    search: u32,
    /// Follow the branch over this field of the scene
    #[arg(long, value_name = "FIELD", requires = "to")]
    over: Option<String>,
    /// First value of the field; default: that of the scene
    #[arg(long, value_name = "VALUE", requires = "over", value_parser = super::real, allow_hyphen_values = true)]
    from: Option<f64>,
    /// Value towards which the branch is followed
    #[arg(long, value_name = "VALUE", requires = "over", value_parser = super::real, allow_hyphen_values = true)]
    to: Option<f64>,
    /// First step, as a fraction of the range
    #[arg(long, value_name = "PART", requires = "over", value_parser = super::real, default_value_t = 0.02, allow_hyphen_values = true)]
    step: f64,
    /// How often to follow the branches that begin at period doublings and pitchforks: 1 for those of the branch itself, 2 also
    /// for theirs, and so on
    #[arg(long, value_name = "N", requires = "over", default_value_t = 0, value_parser = super::whole::<u32>(0..=8), allow_negative_numbers = true)]
    branches: u32,
    /// Print one JSON object in place of the summary
    #[arg(long)]
    json: bool,
    /// Write the branch as a table to this file
    #[arg(long, value_name = "FILE", requires = "over")]
    csv: Option<PathBuf>,
    #[command(flatten)]
    picture: Picture,
}

/// Runs the command and returns the text to print.
pub fn run(arguments: Arguments) -> Result<String, Failure> {
    let draft = arguments.scene.draft()?;
    arguments.picture.require_room(&draft.files(), &[("--csv", arguments.csv.as_deref())])?;
    let scene = draft.bodies()?;
    let headline = assembly::headline(&scene, &scene.pose()?);
    let settings = OrbitSettings {
        forcing_periods: arguments.periods,
        transient_periods: arguments.transient,
        search_periods: arguments.search,
        ..OrbitSettings::default()
    };
    let stop = stop_on_signal()?;
    let (Some(field), Some(to)) = (&arguments.over, arguments.to) else {
        arguments.picture.require_none("left out without --over, because it draws a branch")?;
        let found = scene.orbit_until(&settings, &|| stop.load(Ordering::Relaxed))?;
        return match arguments.json {
            true => found.json(&scene),
            false => Ok(format!("{headline}\n\n{}{}", orbit::text(&found), signature())),
        };
    };
    let over = Over { field, from: arguments.from, to, step: arguments.step, branches: arguments.branches };
    let branch = scene.orbit_branch(&over, &settings, &|| stop.load(Ordering::Relaxed)).map_err(as_option)?;
    let printed = match arguments.json {
        true => branch.json(&scene)?,
        false => format!("{headline}\n\n{}{}", branch.text(), signature()),
    };
    with_files(printed, |printed| {
        if let Some(path) = &arguments.csv {
            write_single(printed, path, &branch.csv()?, arguments.json)?;
        }
        arguments.picture.draw(printed, arguments.json, || Ok(orbit::picture(&headline, &branch)))
    })
}

/// An error in the range or the first step of a branch, under the name of its option.
fn as_option(fault: InvalidInput) -> InvalidInput {
    super::renamed(fault, &[("to", "--to"), ("step", "--step")])
}
