//! The command `identify`: fields of a scene from measurements.

use std::path::PathBuf;

use clap::Args;
use vibroimpact::InvalidInput;
use vibroimpact::export::{self, Failure};
use vibroimpact::identify::{self, Data, Free, MOST_STARTS, Request};

use super::headline;
use super::products::{Picture, with_files};
use super::source::Changes;
use super::voice::signature;

pub const EXAMPLES: &str = "Examples:
  vibroimpact identify measured.csv --scene beam.json --free contact.stiffness_n_m1_5,structure.damping_ratio
  vibroimpact identify measured.csv --scene beam.json --free structure.damping_ratio=0.001..0.1 --json
  vibroimpact identify measured.csv --scene beam.json --free contact.stiffness_n_m1_5 --candidates places.csv
                                                 which of these experiments is the most informative

The table is comma-separated, with a row for each measured impact. Its columns are fields of the scene, which replace those
of the scene; measured quantities; and, for each of these or for none, its standard deviation:

  location_m,striker.speed_m_s,restitution,restitution_sd,first_contact_s,first_contact_s_sd
  0.4,1.0,0.312,0.01,9.8e-5,1e-6
  0.6,1.0,0.145,0.01,,

Measured quantities are restitution, striker_velocity_m_s, first_contact_s, first_impulse_n_s, first_peak_force_n,
last_separation_s, impulse_n_s, peak_force_n, peak_compression_m; and the force over time, as a table time_s,force_n whose
name is in the column force_file (its noise in force_n_sd). The clock of the gauge may have any offset; a delay of its
response is a parameter as well, --free gauge.time_constant_s=1e-6..1e-4. An empty cell is a quantity that was not measured.

The search for a free field begins at its value in the scene. It extends over a factor of three to either side, or between
the stated limits (field=low..high); a field with positive limits may end beyond them. Without standard deviations the noise is
estimated from the misfit. Intervals are those of the likelihood profile.";

/// The data, the scene, and its free fields.
#[derive(Args)]
pub struct Arguments {
    /// The table of measurements (CSV)
    data: PathBuf,
    /// The scene file; - reads the standard input
    #[arg(long)]
    scene: PathBuf,
    #[command(flatten)]
    changes: Changes,
    /// Fields of the scene to find, each as FIELD or FIELD=low..high
    #[arg(long, value_name = "FIELD", value_delimiter = ',', required = true)]
    free: Vec<String>,
    /// Starting points of the search
    #[arg(long, value_name = "N", value_parser = super::whole(1..=MOST_STARTS), default_value_t = 4, allow_negative_numbers = true)]
    starts: usize,
    /// Probability with which an interval contains the true value of its field
    #[arg(long, value_parser = super::real, default_value_t = 0.95, allow_hyphen_values = true)]
    level: f64,
    /// Possible experiments (CSV), which are ranked by the information that they would give
    #[arg(long, value_name = "FILE")]
    candidates: Option<PathBuf>,
    /// Print one JSON object in place of the text
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    picture: Picture,
}

/// Runs the command and returns the text to print.
pub fn run(arguments: Arguments) -> Result<String, Failure> {
    let Arguments { data, scene, changes, free, starts, level, candidates, json, picture } = arguments;
    let draft = changes.draft(&scene)?;
    let scene = draft.impact()?;
    let measured = Data::read(&data)?;
    let inputs = [draft.files(), measured.files(&data), candidates.iter().cloned().collect()].concat();
    picture.require_room(&inputs, &[])?;
    let candidates = candidates.map(|path| Data::read_candidates(&path)).transpose()?;
    let free: Vec<Free> = free.iter().map(|text| Free::parse(text)).collect::<Result<_, InvalidInput>>()?;
    let found = identify::identify(&scene, &measured, &free, &Request { level, starts, candidates })?;
    let printed = if json { export::json(&found)? } else { identify::text(&found) + &signature() };
    with_files(printed, |printed| {
        picture.draw(printed, json, || Ok(identify::picture(&headline(&scene)?, &measured, &found)))
    })
}
