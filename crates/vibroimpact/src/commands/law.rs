//! The command `law`: parameters of laws of contact for a wanted restitution.

use std::fmt::Write as _;

use clap::{Args, ValueEnum};
use serde::Serialize;
use vibroimpact::InvalidInput;
use vibroimpact::contact_models::{self, Flores, HuntCrossley, LankaraniNikravesh, Law, Solref, Stepped, Wanted};
use vibroimpact::contact_models::{damping_ratio_if_it_pulled, reduced_mass_kg, stepped_restitution};
use vibroimpact::export::{self, Failure};

pub const EXAMPLES: &str = "Examples:
  vibroimpact law --restitution 0.5 --mass-kg 0.1 --speed-m-s 2
                                     the parameters of every law that can do it
  vibroimpact law --restitution 0.5 --mass-kg 0.1 --speed-m-s 2 --step-s 0.002
                                     the same for an engine with this step, and how far it misses
  vibroimpact law --restitution 0.5 --mass-kg 0.1 --speed-m-s 2 --step-s 0.002 --law mujoco --json

Most engines and papers take a damping by a formula that is not the law's own restitution. Asked for 0.5 they give 0.550
(MuJoCo, and spring and dashpot by exp(-pi z/sqrt(1-z^2)), as the force ends before the gap opens), 0.663 (Hunt and
Crossley), 0.725 (Lankarani and Nikravesh), 0.470 (Flores). Here the damping is that of the exact relation; \"by the paper\"
is what the formula would have given.

Damping goes with the restitution (and the speed of approach), stiffness with how deep the bodies may press. Two bodies
count by their reduced mass: give the other's as --other-mass-kg.

A fixed step misses: the touch lies anywhere within a step, so that there is a range. \"at the step\" is for semi-implicit
Euler (MuJoCo and most engines); the parameters \"for the step\" are such that the mean of that range is the wanted one.
In MuJoCo set solimp to two equal numbers, as in solimp=\"0.95 0.95 0.001\", and solref to the two numbers given.";

/// What is wanted.
#[derive(Args)]
pub struct Arguments {
    /// Speed of parting over speed of approach, from 0.001 to 1
    #[arg(long, allow_negative_numbers = true)]
    restitution: f64,
    /// Mass of the striker
    #[arg(long, value_name = "KG", value_parser = positive, allow_negative_numbers = true)]
    mass_kg: f64,
    /// Mass of the other body; immovable when left out
    #[arg(long, value_name = "KG", value_parser = positive, allow_negative_numbers = true)]
    other_mass_kg: Option<f64>,
    /// Speed of approach
    #[arg(long, value_name = "M/S", value_parser = positive, allow_negative_numbers = true)]
    speed_m_s: f64,
    /// How deep the bodies press; when left out six steps of approach, or a millimetre without a step
    #[arg(long, value_name = "M", value_parser = positive, allow_negative_numbers = true)]
    compression_m: Option<f64>,
    /// Time step of an engine that steps by semi-implicit Euler
    #[arg(long, value_name = "S", value_parser = positive, allow_negative_numbers = true)]
    step_s: Option<f64>,
    /// This law alone
    #[arg(long, value_enum)]
    law: Option<Kind>,
    /// Print one JSON object in place of the table
    #[arg(long)]
    json: bool,
}

/// The laws that are made to measure.
#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Kind {
    /// solref of MuJoCo
    Mujoco,
    /// Spring and dashpot
    KelvinVoigt,
    /// k xi^1.5 (1 + D xi')
    HuntCrossley,
    /// The same with the damping set by a restitution, 8 (1 - e) / (5 e v)
    Flores,
    /// The same with 3 (1 - e^2) / (4 v); from 0.663
    LankaraniNikravesh,
}

/// What is printed as JSON.
#[derive(Serialize)]
struct Answer {
    restitution: f64,
    reduced_mass_kg: f64,
    speed_m_s: f64,
    compression_m: f64,
    step_s: Option<f64>,
    laws: Vec<Made>,
}

/// A law made to measure.
#[derive(Serialize)]
struct Made {
    law: &'static str,
    /// With the exact restitution; none where the law cannot have it.
    parameters: Option<Parameters>,
    /// Its restitution, computed from the parameters.
    restitution: Option<f64>,
    /// The restitution that the published rule for the damping leads to.
    restitution_by_the_paper: f64,
    /// What a fixed step makes of these parameters.
    at_the_step: Option<AtStep>,
    /// Parameters whose mean at the step is the restitution wanted, and what the step makes of them.
    for_the_step: Option<ForStep>,
}

/// Restitutions over all places of the first touch within a step.
#[derive(Serialize)]
struct AtStep {
    lowest: f64,
    mean: f64,
    highest: f64,
    steps_in_contact: f64,
}

#[derive(Serialize)]
struct ForStep {
    parameters: Parameters,
    #[serde(flatten)]
    restitution: AtStep,
}

/// The numbers to set.
#[derive(Serialize)]
#[serde(untagged)]
enum Parameters {
    Mujoco { solref: Option<[f64; 2]>, solref_direct: [f64; 2] },
    KelvinVoigt { stiffness_n_m: f64, damping_n_s_m: f64, damping_ratio: f64 },
    HuntCrossley { stiffness_n_m1_5: f64, exponent: f64, damping_s_m: f64 },
    ByRestitution { stiffness_n_m1_5: f64, restitution: f64 },
}

impl Kind {
    /// The law that has the restitution, and the numbers to set.
    fn make(self, wanted: &Wanted) -> Result<(Law, Parameters), contact_models::InvalidInput> {
        Ok(match self {
            Kind::Mujoco => (wanted.kelvin_voigt()?, Parameters::of_mujoco(&wanted.solref()?)),
            Kind::KelvinVoigt => {
                let Solref { stiffness_per_s2, damping_per_s, damping_ratio, .. } = wanted.solref()?;
                let [stiffness_n_m, damping_n_s_m] = [stiffness_per_s2, damping_per_s].map(|p| p * wanted.mass_kg);
                (wanted.kelvin_voigt()?, Parameters::KelvinVoigt { stiffness_n_m, damping_n_s_m, damping_ratio })
            }
            Kind::HuntCrossley => {
                let law = wanted.hunt_crossley(1.5)?;
                let HuntCrossley { stiffness_n_m_n: stiffness_n_m1_5, exponent, damping_s_m } = law;
                (law.into(), Parameters::HuntCrossley { stiffness_n_m1_5, exponent, damping_s_m })
            }
            Kind::Flores => {
                let law = wanted.flores()?;
                let Flores { stiffness_n_m1_5, restitution, .. } = law;
                (law.into(), Parameters::ByRestitution { stiffness_n_m1_5, restitution })
            }
            Kind::LankaraniNikravesh => {
                let law = wanted.lankarani_nikravesh()?;
                let LankaraniNikravesh { stiffness_n_m1_5, restitution, .. } = law;
                (law.into(), Parameters::ByRestitution { stiffness_n_m1_5, restitution })
            }
        })
    }

    /// The law that the published rule leads to; its stiffness does not matter.
    fn by_the_paper(self, wanted: &Wanted) -> Result<f64, contact_models::InvalidInput> {
        let (e, mass_kg, speed_m_s) = (wanted.restitution, wanted.mass_kg, wanted.speed_m_s);
        let law = match self {
            Kind::Mujoco | Kind::KelvinVoigt => {
                let ratio = damping_ratio_if_it_pulled(e)?;
                if ratio == 0.0 {
                    return Ok(1.0);
                }
                contact_models::KelvinVoigt::new(1.0, 2.0 * ratio * mass_kg.sqrt())?.into()
            }
            Kind::HuntCrossley => HuntCrossley::with_restitution_first_order(1.0, 1.5, e, speed_m_s)?.into(),
            Kind::Flores => Flores::new(1.0, e)?.into(),
            Kind::LankaraniNikravesh => Law::from(LankaraniNikravesh::new(1.0, e)?),
        };
        law.wall_restitution(mass_kg, speed_m_s)
    }

    fn name(self) -> &'static str {
        match self {
            Kind::Mujoco => "mujoco",
            Kind::KelvinVoigt => "kelvin-voigt",
            Kind::HuntCrossley => "hunt-crossley",
            Kind::Flores => "flores",
            Kind::LankaraniNikravesh => "lankarani-nikravesh",
        }
    }
}

impl Parameters {
    fn of_mujoco(solref: &Solref) -> Parameters {
        let standard = solref.time_constant_s.is_finite().then_some([solref.time_constant_s, solref.damping_ratio]);
        // subtracted from zero, so that zero keeps its sign
        let direct = [solref.stiffness_per_s2, solref.damping_per_s].map(|parameter| 0.0 - parameter);
        Parameters::Mujoco { solref: standard, solref_direct: direct }
    }

    fn text(&self) -> String {
        match self {
            Parameters::Mujoco { solref: Some([time, ratio]), solref_direct: [stiffness, damping] } => {
                format!("solref \"{time:.6} {ratio:.6}\", or \"{stiffness:.6e} {damping:.6e}\"")
            }
            Parameters::Mujoco { solref: None, solref_direct: [stiffness, damping] } => {
                format!("solref \"{stiffness:.6e} {damping:.6e}\"")
            }
            Parameters::KelvinVoigt { stiffness_n_m, damping_n_s_m, damping_ratio } => {
                format!("k = {stiffness_n_m:.6e} N/m, c = {damping_n_s_m:.6e} N s/m, damping ratio {damping_ratio:.6}")
            }
            Parameters::HuntCrossley { stiffness_n_m1_5, damping_s_m, .. } => {
                format!("k = {stiffness_n_m1_5:.6e} N/m^1.5, D = {damping_s_m:.6e} s/m")
            }
            Parameters::ByRestitution { stiffness_n_m1_5, restitution } => {
                format!("k = {stiffness_n_m1_5:.6e} N/m^1.5, told a restitution of {restitution:.6}")
            }
        }
    }
}

impl From<Stepped> for AtStep {
    fn from(Stepped { lowest, mean, highest, steps }: Stepped) -> AtStep {
        AtStep { lowest, mean, highest, steps_in_contact: steps }
    }
}

/// The value of an option that asks for a quantity.
fn positive(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| (1e-30..=1e30).contains(value));
    value.ok_or_else(|| "allowed is a number greater than 0 (from 1e-30 to 1e30)".to_owned())
}

/// Carries the command out and returns what is to be printed.
pub fn run(arguments: Arguments) -> Result<String, Failure> {
    let Arguments { restitution, mass_kg, other_mass_kg, speed_m_s, compression_m, step_s, law, json } = arguments;
    let named = |fault: contact_models::InvalidInput| {
        let fault = InvalidInput::from(fault);
        match fault.field.as_str() {
            "restitution" => InvalidInput { field: "--restitution".to_owned(), ..fault },
            // a stiffness that nothing can have
            _ => fault,
        }
    };
    let mass_kg = reduced_mass_kg(mass_kg, other_mass_kg.unwrap_or(f64::INFINITY)).map_err(named)?;
    let compression_m = compression_m.unwrap_or_else(|| step_s.map_or(1e-3, |step_s| 6.0 * speed_m_s * step_s));
    let wanted = Wanted { restitution, mass_kg, speed_m_s, compression_m }.validated().map_err(named)?;
    let laws = Kind::value_variants().iter().filter(|kind| law.is_none_or(|law| law == **kind));
    let laws = laws.map(|kind| made(*kind, &wanted, step_s, law.is_some()).map_err(named)).collect::<Result<_, _>>()?;
    let answer = Answer { restitution, reduced_mass_kg: mass_kg, speed_m_s, compression_m, step_s, laws };
    if json { export::json(&answer) } else { Ok(text(&answer)) }
}

/// A law made to measure; one that cannot have the restitution is a fault only where it was asked for by name.
fn made(kind: Kind, wanted: &Wanted, step_s: Option<f64>, by_name: bool) -> Result<Made, contact_models::InvalidInput> {
    let mut made = Made {
        law: kind.name(),
        parameters: None,
        restitution: None,
        restitution_by_the_paper: kind.by_the_paper(wanted)?,
        at_the_step: None,
        for_the_step: None,
    };
    let (law, parameters) = match kind.make(wanted) {
        Ok(made) => made,
        Err(fault) if fault.field == "restitution" && !by_name => return Ok(made),
        Err(fault) => return Err(fault),
    };
    made.restitution = Some(law.wall_restitution(wanted.mass_kg, wanted.speed_m_s)?);
    made.parameters = Some(parameters);
    if let Some(step_s) = step_s {
        let stepped = |law: &Law| stepped_restitution(law, wanted.mass_kg, wanted.speed_m_s, step_s);
        made.at_the_step = Some(stepped(&law)?.into());
        made.for_the_step = for_the_step(kind, wanted, &stepped)?;
    }
    Ok(made)
}

/// The law whose mean at the step is the restitution wanted, by bisection on the restitution that it would have without a
/// step; none if no law of the kind has it.
fn for_the_step(
    kind: Kind,
    wanted: &Wanted,
    stepped: &impl Fn(&Law) -> Result<Stepped, contact_models::InvalidInput>,
) -> Result<Option<ForStep>, contact_models::InvalidInput> {
    let at = |restitution: f64| kind.make(&Wanted { restitution, ..*wanted });
    let least = if kind == Kind::LankaraniNikravesh { LankaraniNikravesh::LEAST_RESTITUTION } else { 0.001 };
    let (mut low, mut high) = (least, 1.0);
    let mean = |restitution: f64| Ok(stepped(&at(restitution)?.0)?.mean);
    if mean(low)? > wanted.restitution || mean(high)? < wanted.restitution {
        return Ok(None);
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if mean(middle)? < wanted.restitution { &mut low } else { &mut high }) = middle;
    }
    let (law, parameters) = at(high)?;
    Ok(Some(ForStep { parameters, restitution: stepped(&law)?.into() }))
}

fn text(answer: &Answer) -> String {
    let Answer { restitution, reduced_mass_kg, speed_m_s, compression_m, step_s, laws } = answer;
    let mut text = format!(
        "Laws of contact with a restitution of {restitution}, for {reduced_mass_kg} kg at {speed_m_s} m/s, pressing {compression_m} m deep"
    );
    if let Some(step_s) = step_s {
        let _ = write!(text, ", and for steps of {step_s} s");
    }
    text += "\n";
    for made in laws {
        let _ = writeln!(text, "\n{}", made.law);
        match &made.parameters {
            Some(parameters) => {
                let _ = writeln!(text, "  exact          {}", parameters.text());
            }
            None => text += "  exact          none: the law cannot have this restitution\n",
        }
        let _ = writeln!(text, "  by the paper   would give {:.4}", made.restitution_by_the_paper);
        if let Some(at) = &made.at_the_step {
            let _ = writeln!(text, "  at the step    gives {}", range(at));
        }
        match &made.for_the_step {
            Some(found) => {
                let _ = writeln!(text, "  for the step   {}", found.parameters.text());
                let _ = writeln!(text, "                 gives {}", range(&found.restitution));
            }
            None if made.at_the_step.is_some() => text += "  for the step   none: no damping has this mean\n",
            None => {}
        }
    }
    text
}

fn range(at: &AtStep) -> String {
    let AtStep { lowest, mean, highest, steps_in_contact } = at;
    format!("{mean:.4} on average, {lowest:.4} to {highest:.4}; {steps_in_contact:.1} steps in contact")
}
