//! The command `law`: parameters of contact laws for a given restitution.

use clap::Args;
use vibroimpact::export::{self, Failure};
use vibroimpact::law::{Kind, POSITIVE, Request};

pub const EXAMPLES: &str = "Examples:
  vibroimpact law --restitution 0.5 --mass-kg 0.1 --speed-m-s 2
                                     the parameters of every law that can have this restitution
  vibroimpact law --restitution 0.5 --mass-kg 0.1 --speed-m-s 2 --step-s 0.002
                                     the same for an engine with this step, and its deviation
  vibroimpact law --restitution 0.5 --mass-kg 0.1 --speed-m-s 2 --step-s 0.002 --law mujoco --json

Most engines and papers compute the damping by an approximate formula. For a requested restitution of 0.5 the result is 0.550
(MuJoCo, and spring and dashpot by exp(-pi z/sqrt(1-z^2)), since the force ends before the gap opens), 0.663 (Hunt and
Crossley), 0.725 (Lankarani and Nikravesh) or 0.470 (Flores). Here the damping follows from the exact relation; \"by the
paper\" is the restitution that results from the published formula.

The damping depends on the restitution (and on the speed of approach), the stiffness on the largest compression. For two free
bodies state the mass of the other body as --other-mass-kg.

With a fixed step the first touch may lie anywhere within a step, so the restitution has a range. \"at the step\" is for
semi-implicit Euler (MuJoCo and most engines). With the parameters \"for the step\" the mean of that range is the
requested restitution. A contact that lasts more than 100,000 steps is not computed. In MuJoCo set solimp to two equal
numbers, as in solimp=\"0.95 0.95 0.001\", and solref to the two numbers.";

/// The requested restitution and what it refers to.
#[derive(Args)]
pub struct Arguments {
    /// Restitution: speed of separation over speed of approach, from 0.001 to 1
    #[arg(long, value_parser = super::real, allow_hyphen_values = true)]
    restitution: f64,
    /// Mass of the striker
    #[arg(long, value_name = "KG", value_parser = positive, allow_hyphen_values = true)]
    mass_kg: f64,
    /// Mass of the other body; without it that body is immovable
    #[arg(long, value_name = "KG", value_parser = positive, allow_hyphen_values = true)]
    other_mass_kg: Option<f64>,
    /// Speed of approach
    #[arg(long, value_name = "M/S", value_parser = positive, allow_hyphen_values = true)]
    speed_m_s: f64,
    /// Largest compression; default: the distance covered in six steps, or a millimetre without a step
    #[arg(long, value_name = "M", value_parser = positive, allow_hyphen_values = true)]
    compression_m: Option<f64>,
    /// Time step of an engine that steps by semi-implicit Euler
    #[arg(long, value_name = "S", value_parser = positive, allow_hyphen_values = true)]
    step_s: Option<f64>,
    /// Print only this law
    #[arg(long, value_enum)]
    law: Option<Kind>,
    /// Print one JSON object in place of the table
    #[arg(long)]
    json: bool,
}

/// The value of an option that asks for a quantity.
fn positive(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| (1e-30..=1e30).contains(value));
    value.ok_or_else(|| format!("it must be {POSITIVE}"))
}

/// Runs the command and returns the text to print.
pub fn run(arguments: Arguments) -> Result<String, Failure> {
    let Arguments { restitution, mass_kg, other_mass_kg, speed_m_s, compression_m, step_s, law, json } = arguments;
    let request = Request { restitution, mass_kg, other_mass_kg, speed_m_s, compression_m, step_s, law };
    // the fields of a request are named as its options
    let answer = request.answer().map_err(|fault| {
        let option = format!("--{}", fault.field.to_string().replace('_', "-"));
        fault.under(option)
    })?;
    if json { export::json(&answer) } else { Ok(answer.to_string()) }
}
