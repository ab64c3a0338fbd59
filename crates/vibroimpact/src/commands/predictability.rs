//! The command `predictability`.

use clap::Args;
use vibroimpact::export::Failure;
use vibroimpact::sweep::{Blur, BlurWidth, Over, Part, Scale, Sweep};

use super::source::SceneSource;
use super::sweep::{Run, compute};

pub const EXAMPLES: &str = r#"Examples:
  vibroimpact predictability beam.json --over location_m=0.05:0.95:91 --blur location_m=0.001 --out out/
                                          the spread along the beam, if the location is known to 1 mm
  vibroimpact predictability beam.json --over location_m=0.05:0.95:46 --over striker.speed_m_s=0.1:10:31:log \
      --blur location_m=0.001 --blur striker.speed_m_s=1% --out out/
                                          a map over location and speed, with 1 mm and 1 % of blur

The blur is the standard deviation of a field about its value on the map, or about that of the scene: a number in the unit of
the field (normally distributed), or a share of its value in per cent (its logarithm normally distributed). Every point of the
map has the same number of draws. The folder contains a picture of median and spread (report.html), distribution.csv with mean,
standard deviation and quantiles at every point and their sampling errors, and every draw (results.csv). What is mapped is the
restitution; of a scene of bodies it is the intervals of contact, the largest force and the contact work rate. Ctrl-C stops
the map; the same command continues from there.

The exit code is 0 for a finished map, 130 for one that was stopped, 2 for a scene, field or number that cannot be used, 1 if
reading or writing fails."#;

/// The fields to map, how well others are known, and the folder for the map.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneSource,
    /// A field to map, its first and last value, and the number of values; `:log` spaces them by equal ratios; may be given twice
    #[arg(long, required = true, value_name = "FIELD=FROM:TO:COUNT", value_parser = over)]
    over: Vec<Over>,
    /// A field that is not known exactly, and its standard deviation: a number, or per cent of its value
    #[arg(long, required = true, value_name = "FIELD=WIDTH", value_parser = blur)]
    blur: Vec<Blur>,
    /// Draws at each point, rounded down to 16 times a power of two
    #[arg(long, value_name = "N", value_parser = super::whole(0..=u64::MAX), default_value_t = 256, allow_negative_numbers = true)]
    draws: u64,
    /// Seed of the draws
    #[arg(long, value_name = "N", value_parser = super::whole(0..=u64::MAX), default_value_t = 1, allow_negative_numbers = true)]
    seed: u64,
    #[command(flatten)]
    run: Run,
}

fn over(text: &str) -> Result<Over, &'static str> {
    let read = || {
        let (field, values) = text.split_once('=')?;
        let (values, scale) = match values.strip_suffix(":log") {
            Some(values) => (values, Scale::Log),
            None => (values, Scale::Linear),
        };
        let [from, to, count] = values.split(':').collect::<Vec<_>>().try_into().ok()?;
        let (from, to, count) = (from.parse().ok()?, to.parse().ok()?, count.parse().ok()?);
        Some(Over { field: field.to_owned(), from, to, count, scale })
    };
    read().ok_or("it must be FIELD=FROM:TO:COUNT or FIELD=FROM:TO:COUNT:log, as in location_m=0.05:0.95:46")
}

fn blur(text: &str) -> Result<Blur, &'static str> {
    let read = || {
        let (field, width) = text.split_once('=')?;
        let width = match width.strip_suffix('%') {
            Some(percent) => BlurWidth::Relative(0.01 * percent.parse::<f64>().ok()?),
            None => BlurWidth::Absolute(width.parse().ok()?),
        };
        Some(Blur { field: field.to_owned(), width })
    };
    read().ok_or("it must be FIELD=WIDTH, as in location_m=0.001 or striker.speed_m_s=1%")
}

/// Runs the command and returns the text to print.
pub fn run(arguments: Arguments) -> Result<String, Failure> {
    let Arguments { scene, over, blur, draws, seed, run } = arguments;
    compute(&Sweep::predictability(&scene.draft()?, &over, &blur, draws, seed)?, Part::WHOLE, &run)
}
