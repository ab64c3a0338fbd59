//! The commands `emoc` and `fit`: net restitution, and its parameters from data.

use std::path::PathBuf;

use clap::Args;
use vibroimpact::InvalidInput;
use vibroimpact::emoc::Parameters;
use vibroimpact::export::{self, Failure};
use vibroimpact::net::{self, FitSummary};
use vibroimpact::scene::MOST_MODES;
use vibroimpact::text;

use super::source::{Changes, SceneSource};
use super::{of_option, real, renamed, whole};

const EMOC_MODES: &str = "--emoc-modes";
/// The parameters of the law, and their options.
const PARAMETERS: [(&str, &str); 3] = [("mu0", "--mu0"), ("alpha0", "--alpha0"), ("alpha1", "--alpha1")];

pub const EMOC_EXAMPLES: &str = "Examples:
  vibroimpact emoc ball.json                               with all parameters 1, if nothing has been fitted
  vibroimpact emoc ball.json --mu0 0.5 --alpha0 8 --alpha1 0.3 --emoc-modes 50 --json

Nothing is integrated in time: the restitution is that of least kinetic energy after the impact under the law's
inequalities, which has a closed form in the mode shapes at the point of impact,

  e = ebar max(1/(1+Z), (beta0+beta1)/(1+beta0)),   Z = m sum phi_k^2,   t = mu0 Z,   ebar = (t^2+1)/(t^2+t+1),
  beta0 = x/(1+x) with x = alpha0 Z/N,              beta1 = y/(1+y) with y = alpha1 m phi_1^2.

The branch printed is the term that is active. Contact, speed and frequencies do not enter. The mode shapes are those of
Timoshenko's theory if the scene states no modes and every segment has the data for it; structure.theory=euler-bernoulli
gives those of the thesis. Parameters for a beam come from `vibroimpact fit` with the same scene; the defaults are not
fitted to any data. The model emoc of `vibroimpact compare` is another law: its two parameters are fixed, its error on
beams that it was not fitted to is stated, and it takes the duration of the contact into account
(docs/choosing-the-model.md).";

pub const FIT_EXAMPLES: &str = "Examples:
  vibroimpact fit measured.csv --scene ball.json           the three parameters, their intervals, the error
  vibroimpact fit measured.csv --scene ball.json --json    the same as one JSON object

The table is comma-separated, its first line names the columns:

  mass_kg,location_m,restitution
  0.0638,0.25,0.41
  0.0638,0.50,0.38

Other columns are ignored. The scene gives the beam; masses and locations come from the table. Its mode shapes are those
of Timoshenko's theory if it states no modes and every segment has the data for it; structure.theory=euler-bernoulli gives
those of the thesis. At least three lines are needed, and they should cover light and heavy strikers. The search starts
from many points, because the sum of squares has several minima. Intervals hold each parameter with 95 % probability if
the errors are independent, which those of a law with three parameters are not: take them as a lower bound on the
uncertainty.";

/// The scene and the parameters of the law.
#[derive(Args)]
pub struct EmocArguments {
    #[command(flatten)]
    scene: SceneSource,
    /// Moderated mass ratio coefficient, not negative; default 1
    #[arg(long, value_parser = real, allow_hyphen_values = true)]
    mu0: Option<f64>,
    /// Modal richness coefficient, not negative; default 1
    #[arg(long, value_parser = real, allow_hyphen_values = true)]
    alpha0: Option<f64>,
    /// Slow response coefficient, not negative; default 1
    #[arg(long, value_parser = real, allow_hyphen_values = true)]
    alpha1: Option<f64>,
    /// Number of modes in the law; default: that of the scene
    #[arg(long, value_name = "N", value_parser = whole(1..=MOST_MODES), allow_negative_numbers = true)]
    emoc_modes: Option<usize>,
    /// Print one JSON object in place of the list
    #[arg(long)]
    json: bool,
}

/// The data, and the scene of their beam.
#[derive(Args)]
pub struct FitArguments {
    /// The table (CSV): mass_kg, location_m, restitution
    data: PathBuf,
    /// The scene file that describes the beam; - reads the standard input
    #[arg(long)]
    scene: PathBuf,
    #[command(flatten)]
    changes: Changes,
    /// Number of modes in the law
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = whole(1..=MOST_MODES), allow_negative_numbers = true)]
    emoc_modes: usize,
    /// Print one JSON object in place of the list
    #[arg(long)]
    json: bool,
}

/// Runs `emoc` and returns the text to print.
pub fn emoc(arguments: EmocArguments) -> Result<String, Failure> {
    let EmocArguments { scene, mu0, alpha0, alpha1, emoc_modes, json } = arguments;
    let stated = mu0.is_some() || alpha0.is_some() || alpha1.is_some();
    let [mu0, alpha0, alpha1] = [mu0, alpha0, alpha1].map(|parameter| parameter.unwrap_or(1.0));
    let parameters = Parameters { mu0, alpha0, alpha1, ..Parameters::default() };
    let rebound = scene.impact()?.emoc(&parameters, emoc_modes);
    let rebound = rebound.map_err(|fault| renamed(fault, &PARAMETERS));
    let rebound = if emoc_modes.is_some() { rebound.map_err(of_option(EMOC_MODES))? } else { rebound? };
    if json { export::json(&rebound) } else { Ok(text::net_rebound(&rebound, stated)) }
}

/// Runs `fit` and returns the text to print.
pub fn fit(FitArguments { data, scene, changes, emoc_modes, json }: FitArguments) -> Result<String, Failure> {
    let scene = changes.draft(&scene)?.impact()?;
    // an error without a line is one of the scene or of the option
    let in_line = |fault: InvalidInput| if fault.field.has_place() { net::in_table(&data, fault) } else { fault };
    let observations = scene.observations(&net::read(&data)?, emoc_modes).map_err(in_line);
    let observations = observations.map_err(of_option(EMOC_MODES))?;
    let fit = FitSummary::new(&observations, emoc_modes).map_err(|fault| net::in_table(&data, fault))?;
    if json { export::json(&fit) } else { Ok(text::fit(&fit)) }
}
