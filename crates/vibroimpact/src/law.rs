//! Contact laws for a requested restitution: the parameters of each law that has it.
//!
//! ```
//! use vibroimpact::law::{Kind, Parameters, Request};
//!
//! let mut request = Request::new(0.5, 0.1, 2.0);
//! request.law = Some(Kind::Mujoco);
//! let found = request.answer()?;
//! let Some(Parameters::Mujoco { solref: Some([_, damping_ratio]), .. }) = found.laws[0].parameters else { panic!() };
//! assert!((damping_ratio - 0.255276).abs() < 1e-6);
//! # Ok::<(), vibroimpact::InvalidInput>(())
//! ```

use std::fmt::Write as _;

use contact_models::{self, Flores, HuntCrossley, LankaraniNikravesh, Law, Solref, Stepped, Wanted};
use contact_models::{damping_ratio_if_it_pulled, reduced_mass_kg, stepped_restitution};
use serde::Serialize;

use crate::InvalidInput;
use crate::scene::such_that;

/// The requested restitution and what it refers to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// Restitution: speed of separation over speed of approach, 0.001 to 1.
    pub restitution: f64,
    /// Mass of the striker (kg).
    pub mass_kg: f64,
    /// Mass of the other body (kg); immovable if none.
    pub other_mass_kg: Option<f64>,
    /// Speed of approach (m/s).
    pub speed_m_s: f64,
    /// Largest compression (m); if none, the distance covered in six steps, or a millimetre without a step.
    pub compression_m: Option<f64>,
    /// Time step of an engine that steps by semi-implicit Euler (s).
    pub step_s: Option<f64>,
    /// Only this law; all if none.
    pub law: Option<Kind>,
}

/// The available laws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "program", derive(clap::ValueEnum))]
pub enum Kind {
    /// solref of MuJoCo
    Mujoco,
    /// Spring and dashpot
    KelvinVoigt,
    /// k xi^1.5 (1 + D xi')
    HuntCrossley,
    /// The same with the damping set by a restitution, 8 (1 - e) / (5 e v)
    Flores,
    /// The same with 3 (1 - e^2) / (4 v); for restitutions from 0.663 to 1
    LankaraniNikravesh,
}

/// The object that the command `law` prints as JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Answer {
    /// The requested restitution.
    pub restitution: f64,
    /// Reduced mass of the two bodies (kg).
    pub reduced_mass_kg: f64,
    /// Speed of approach (m/s).
    pub speed_m_s: f64,
    /// Largest compression (m).
    pub compression_m: f64,
    /// Time step of the engine (s).
    pub step_s: Option<f64>,
    /// The laws.
    pub laws: Vec<Made>,
}

/// A law with the requested restitution.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Made {
    /// Its name.
    pub law: &'static str,
    /// The parameters with the exact restitution; none if the law cannot have it.
    pub parameters: Option<Parameters>,
    /// Its restitution, computed from the parameters.
    pub restitution: Option<f64>,
    /// The restitution that the published formula for the damping gives.
    pub restitution_by_the_paper: f64,
    /// The restitution of these parameters with the fixed step.
    pub at_the_step: Option<AtStep>,
    /// Parameters whose mean with the fixed step is the requested restitution, and their restitution with it.
    pub for_the_step: Option<ForStep>,
}

/// Restitutions over all phases of the first touch within a step.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AtStep {
    /// The lowest.
    pub lowest: f64,
    /// The mean.
    pub mean: f64,
    /// The highest.
    pub highest: f64,
    /// Number of steps that the contact lasts.
    pub steps_in_contact: f64,
}

/// Parameters for an engine with a fixed step.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ForStep {
    /// The parameters.
    pub parameters: Parameters,
    /// Their restitution with the step.
    #[serde(flatten)]
    pub restitution: AtStep,
}

/// The parameters to set.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Parameters {
    /// Of MuJoCo.
    Mujoco {
        /// Time constant (s) and damping ratio; none without damping.
        solref: Option<[f64; 2]>,
        /// Stiffness (1/s^2) and damping (1/s) by unit of mass, as the negative numbers that MuJoCo takes.
        solref_direct: [f64; 2],
    },
    /// Of spring and dashpot.
    KelvinVoigt {
        /// Stiffness (N/m).
        stiffness_n_m: f64,
        /// Damping (N s/m).
        damping_n_s_m: f64,
        /// Damping over critical damping.
        damping_ratio: f64,
    },
    /// Of Hunt and Crossley's law.
    HuntCrossley {
        /// Stiffness (N/m^1.5).
        stiffness_n_m1_5: f64,
        /// Exponent of the compression.
        exponent: f64,
        /// Damping (s/m).
        damping_s_m: f64,
    },
    /// Of the laws that have a restitution as a parameter.
    ByRestitution {
        /// Stiffness (N/m^1.5).
        stiffness_n_m1_5: f64,
        /// The restitution to set.
        restitution: f64,
    },
}

impl Kind {
    /// The law that has the restitution, and its parameters.
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

    /// The law by the published formula; its stiffness does not matter.
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

    /// All laws.
    pub const ALL: [Kind; 5] =
        [Kind::Mujoco, Kind::KelvinVoigt, Kind::HuntCrossley, Kind::Flores, Kind::LankaraniNikravesh];

    /// Its name.
    pub fn name(self) -> &'static str {
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
                let [time, ratio] = [time, ratio].map(|value| decimals(*value));
                format!("solref \"{time} {ratio}\", or \"{stiffness:.6e} {damping:.6e}\"")
            }
            Parameters::Mujoco { solref: None, solref_direct: [stiffness, damping] } => {
                format!("solref \"{stiffness:.6e} {damping:.6e}\"")
            }
            Parameters::KelvinVoigt { stiffness_n_m, damping_n_s_m, damping_ratio } => {
                let ratio = decimals(*damping_ratio);
                format!("k = {stiffness_n_m:.6e} N/m, c = {damping_n_s_m:.6e} N s/m, damping ratio {ratio}")
            }
            Parameters::HuntCrossley { stiffness_n_m1_5, damping_s_m, .. } => {
                format!("k = {stiffness_n_m1_5:.6e} N/m^1.5, D = {damping_s_m:.6e} s/m")
            }
            Parameters::ByRestitution { stiffness_n_m1_5, restitution } => {
                format!("k = {stiffness_n_m1_5:.6e} N/m^1.5, parameter restitution = {restitution:.6}")
            }
        }
    }
}

/// Six decimals, or a power of ten for a number to which they leave less than four digits, such as the time constant for a short step.
fn decimals(value: f64) -> String {
    if value == 0.0 || value >= 1e-3 { format!("{value:.6}") } else { format!("{value:.6e}") }
}

impl From<Stepped> for AtStep {
    fn from(Stepped { lowest, mean, highest, steps }: Stepped) -> AtStep {
        AtStep { lowest, mean, highest, steps_in_contact: steps }
    }
}

impl Request {
    /// A request for this restitution of a striker of this mass and speed at an immovable body, for every law.
    pub fn new(restitution: f64, mass_kg: f64, speed_m_s: f64) -> Request {
        Request { restitution, mass_kg, other_mass_kg: None, speed_m_s, compression_m: None, step_s: None, law: None }
    }

    /// The parameters of the laws.
    ///
    /// # Errors
    /// A quantity out of range, a restitution that the law requested by name cannot have, or a step so short that a contact
    /// lasts more than 100,000 steps.
    pub fn answer(&self) -> Result<Answer, InvalidInput> {
        let Request { restitution, mass_kg, other_mass_kg, speed_m_s, compression_m, step_s, law } = *self;
        for (field, value) in [
            ("mass_kg", Some(mass_kg)),
            ("other_mass_kg", other_mass_kg),
            ("speed_m_s", Some(speed_m_s)),
            ("compression_m", compression_m),
            ("step_s", step_s),
        ] {
            if let Some(value) = value.filter(|value| !(1e-30..=1e30).contains(value)) {
                let (field, allowed) = (field.to_owned(), POSITIVE.to_owned());
                return Err(InvalidInput::new(field, value.to_string(), allowed));
            }
        }
        let mass_kg = reduced_mass_kg(mass_kg, other_mass_kg.unwrap_or(f64::INFINITY))?;
        let compression_m = compression_m.unwrap_or_else(|| step_s.map_or(1e-3, |step_s| 6.0 * speed_m_s * step_s));
        let wanted = Wanted { restitution, mass_kg, speed_m_s, compression_m }.validated()?;
        let kinds = Kind::ALL.iter().filter(|kind| law.is_none_or(|law| law == **kind));
        let made = |kind: &Kind| {
            made(*kind, &wanted, step_s, law.is_some()).map_err(|fault| of_request(*kind, &wanted, fault))
        };
        let laws = kinds.map(made).collect::<Result<_, _>>()?;
        Ok(Answer { restitution, reduced_mass_kg: mass_kg, speed_m_s, compression_m, step_s, laws })
    }
}

/// The allowed values of a quantity.
pub const POSITIVE: &str = "a number greater than 0 (from 1e-30 to 1e30)";

/// An error about a law in the terms of the request, from which its parameters follow.
fn of_request(kind: Kind, wanted: &Wanted, fault: InvalidInput) -> InvalidInput {
    let name = kind.name();
    let (field, value) = match fault.field.first() {
        Some("step_s") => return InvalidInput { allowed: format!("{} with the law {name}", fault.allowed), ..fault },
        Some("damping_s_m") => ("speed_m_s", wanted.speed_m_s),
        Some("stiffness_n_m" | "stiffness_n_m1_5" | "stiffness_n_m_n" | "damping_n_s_m") => {
            ("compression_m", wanted.compression_m)
        }
        _ => return fault,
    };
    let parameter = format!("{} of the law {name}", fault.field);
    InvalidInput::new(field, value, such_that(&parameter, &fault))
}

/// A law with the requested restitution. A law that cannot have it is an error only if it was requested by name.
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

/// The law whose mean restitution with the step is the requested one, by bisection on the restitution without a step; none if no
/// law of the kind has it.
fn for_the_step(
    kind: Kind,
    wanted: &Wanted,
    stepped: &impl Fn(&Law) -> Result<Stepped, contact_models::InvalidInput>,
) -> Result<Option<ForStep>, contact_models::InvalidInput> {
    let at = |restitution: f64| kind.make(&Wanted { restitution, ..*wanted });
    let least = if kind == Kind::LankaraniNikravesh { LankaraniNikravesh::LEAST_RESTITUTION } else { 0.001 };
    let mean = |restitution: f64| Ok(stepped(&at(restitution)?.0)?.mean);
    // The interval grows from the requested restitution, because contacts with far more damping last many more steps.
    let mut reach = 0.01;
    let (mut low, mut high) = loop {
        let low = (wanted.restitution - reach).max(least);
        let high = (wanted.restitution + reach).min(1.0);
        let (low_is_below, high_is_above) = (mean(low)? <= wanted.restitution, mean(high)? >= wanted.restitution);
        if low_is_below && high_is_above {
            break (low, high);
        }
        if (!low_is_below && low == least) || (!high_is_above && high == 1.0) {
            return Ok(None);
        }
        reach *= 2.0;
    };
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if mean(middle)? < wanted.restitution { &mut low } else { &mut high }) = middle;
    }
    let (law, parameters) = at(high)?;
    Ok(Some(ForStep { parameters, restitution: stepped(&law)?.into() }))
}

impl std::fmt::Display for Answer {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(&text(self))
    }
}

fn text(answer: &Answer) -> String {
    let Answer { restitution, reduced_mass_kg, speed_m_s, compression_m, step_s, laws } = answer;
    let mut text = format!(
        "Contact laws with a restitution of {restitution}, for {reduced_mass_kg} kg at {speed_m_s} m/s and a compression \
             of {compression_m} m"
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
            None if made.at_the_step.is_some() => {
                text += "  for the step   none: no damping has this mean restitution\n"
            }
            None => {}
        }
    }
    text
}

fn range(at: &AtStep) -> String {
    let AtStep { lowest, mean, highest, steps_in_contact } = at;
    format!("{mean:.4} on average, {lowest:.4} to {highest:.4}; {steps_in_contact:.1} steps in contact")
}
