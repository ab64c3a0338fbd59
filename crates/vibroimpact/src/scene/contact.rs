//! The contact between striker and structure.

use contact_models::{
    Felt, Flores, Hertz, HuntCrossley, Hysteretic, KelvinVoigt, LankaraniNikravesh, Law, LinearSpring, Power, Thornton,
    Viscous,
};
use invalid_input::{InvalidInput, Path};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::json::{found, number, read_beside, unknown_field};
use super::materials::{HertzStiffness, Materials, in_contact};
use super::sets::one_of_sets;
use super::told::did_you_mean_one_of;
use super::{Striker, fields};

/// The law of the contact, which `"law"` names, with its parameters beside it. A `restitution` is that at an immovable wall, from
/// which the law's damping follows. If the damping depends on the speed of approach, this is the relative speed of striker and
/// structure at the start, where they meet.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Contact {
    /// `"hertz"`: elastic contact of curved bodies, [`contact_models::Hertz`].
    Hertz(HertzStiffness),
    /// `"viscous"`: the thesis's viscous dissipation, [`contact_models::Viscous`].
    Viscous {
        /// The elastic part.
        #[serde(flatten)]
        stiffness: HertzStiffness,
        /// Damping `c` of thesis Eq. 3.15 (s/m), or `restitution` in its place.
        damping_s_m: Option<f64>,
        /// Restitution at a wall.
        restitution: Option<f64>,
    },
    /// `"hysteretic"`: the thesis's rate-independent dissipation, [`contact_models::Hysteretic`]. A stiffness from
    /// materials is divided by `1 + theta_m + beta`, so that first loading follows Hertz (thesis 3.3.4);
    /// `stiffness_n_m1_5` is used unchanged.
    Hysteretic {
        /// The elastic part.
        #[serde(flatten)]
        stiffness: HertzStiffness,
        /// Centre of the internal variable.
        theta_m: f64,
        /// Half width of the internal variable's range.
        beta: f64,
        /// How fast the internal variable follows the compression.
        k_bar: f64,
        /// Regularisation at zero compression (m); 0, which stands for its limit, when left out.
        #[serde(default)]
        epsilon_m: f64,
    },
    /// `"linear-spring"`: a linear spring, [`contact_models::LinearSpring`].
    LinearSpring {
        /// Stiffness (N/m).
        stiffness_n_m: f64,
    },
    /// `"power"`: a power of the compression, [`contact_models::Power`].
    Power {
        /// Stiffness (N/m^n).
        stiffness_n_m_n: f64,
        /// Exponent `n` of the compression.
        exponent: f64,
    },
    /// `"felt"`: the felt of piano hammers by Stulov's three parameters, [`contact_models::Felt`].
    Felt {
        /// Static stiffness (N/m^n).
        stiffness_n_m_n: f64,
        /// Exponent `n` of the compression, at least 2.
        #[schemars(range(min = 2.0))]
        exponent: f64,
        /// Retardation time (s).
        retardation_time_s: f64,
    },
    /// `"kelvin-voigt"`: spring and dashpot side by side, [`contact_models::KelvinVoigt`].
    KelvinVoigt {
        /// Stiffness (N/m).
        stiffness_n_m: f64,
        /// Damping (N s/m), or `restitution` in its place.
        damping_n_s_m: Option<f64>,
        /// Restitution at a wall, less than 1.
        #[schemars(extend("exclusiveMaximum" = 1.0))]
        restitution: Option<f64>,
    },
    /// `"hunt-crossley"`: a power of the compression with damping in proportion to it, [`contact_models::HuntCrossley`].
    HuntCrossley {
        /// The elastic part with Hertz's exponent, or `stiffness_n_m_n` and `exponent` in its place.
        #[serde(flatten)]
        stiffness: HertzStiffness,
        /// Stiffness (N/m^n) that goes with `exponent`.
        stiffness_n_m_n: Option<f64>,
        /// Exponent `n` of the compression.
        exponent: Option<f64>,
        /// Damping factor (s/m), or `restitution` in its place.
        damping_s_m: Option<f64>,
        /// Restitution at a wall.
        restitution: Option<f64>,
    },
    /// `"lankarani-nikravesh"`: Hertz contact damped for a restitution near one, [`contact_models::LankaraniNikravesh`].
    LankaraniNikravesh {
        /// The elastic part.
        #[serde(flatten)]
        stiffness: HertzStiffness,
        /// Restitution that the damping is meant to give.
        restitution: f64,
        /// Approach speed below which the damping grows no further (m/s); 1e-6 when left out.
        lowest_approach_speed_m_s: Option<f64>,
    },
    /// `"flores"`: Hertz contact damped for any restitution, [`contact_models::Flores`].
    Flores {
        /// The elastic part.
        #[serde(flatten)]
        stiffness: HertzStiffness,
        /// Restitution that the damping is meant to give.
        restitution: f64,
        /// Approach speed below which the damping grows no further (m/s); 1e-6 when left out.
        lowest_approach_speed_m_s: Option<f64>,
    },
    /// `"elastoplastic"`: Thornton's law, [`contact_models::Thornton`].
    Elastoplastic {
        /// What the bodies are made of.
        #[serde(flatten)]
        materials: Materials,
        /// Contact pressure at first yield (Pa), about 1.6 times the yield strength.
        yield_pressure_pa: f64,
    },
}

impl Contact {
    pub(crate) fn from_value(value: &Value) -> Result<Contact, InvalidInput> {
        Contact::from_value_beside(value, &[])
    }

    /// As [`Contact::from_value`], beside other fields of the same object.
    pub(crate) fn from_value_beside(value: &Value, beside: &[&str]) -> Result<Contact, InvalidInput> {
        let fault = |field: &str, value: Option<&Value>| {
            let name = if field.is_empty() { "contact" } else { field };
            let mut allowed = fields::allowed(name).unwrap_or("a number").to_owned();
            if let Some(Value::String(word)) = value {
                allowed += &did_you_mean_one_of(word, &allowed);
            }
            found(if field.is_empty() { Path::default() } else { field.into() }, value, allowed)
        };
        let Value::Object(entries) = value else { return Err(fault("", Some(value))) };
        let law = entries.get("law");
        if !law.is_some_and(Value::is_string) {
            return Err(fault("law", law));
        }
        // a field that is null is not given
        let given: Map<String, Value> = entries
            .iter()
            .filter(|(_, value)| !value.is_null())
            .map(|(field, value)| (field.clone(), value.clone()))
            .collect();
        // serde loses the path of a mistyped field behind a tag, but all of them are numbers
        if let Some((field, value)) = given.iter().find(|(field, value)| *field != "law" && !value.is_number()) {
            return Err(fault(field, Some(value)));
        }
        let contact: Contact = read_beside(&Value::Object(given), beside)
            .map_err(|fault_found| if fault_found.field.is_empty() { fault("law", law) } else { fault_found })?;
        // serde cannot reject unknown fields beside flattened ones, but a field that is not written back was not read
        let written = serde_json::to_value(contact).unwrap_or_default();
        for (field, value) in entries {
            match written.get(field) {
                None => {
                    let known = written.as_object().into_iter().flatten().map(|(field, _)| field.as_str());
                    return Err(unknown_field(field.as_str().into(), value, known.chain(beside.iter().copied())));
                }
                // a number with a default may be left out, but not null, as in all other objects
                Some(used) if value.is_null() && !used.is_null() => return Err(fault(field, Some(value))),
                Some(_) => {}
            }
        }
        Ok(contact)
    }

    /// The name of the law in scene files.
    pub fn law_name(&self) -> &'static str {
        match self {
            Contact::Hertz(_) => "hertz",
            Contact::Viscous { .. } => "viscous",
            Contact::Hysteretic { .. } => "hysteretic",
            Contact::LinearSpring { .. } => "linear-spring",
            Contact::Power { .. } => "power",
            Contact::Felt { .. } => "felt",
            Contact::KelvinVoigt { .. } => "kelvin-voigt",
            Contact::HuntCrossley { .. } => "hunt-crossley",
            Contact::LankaraniNikravesh { .. } => "lankarani-nikravesh",
            Contact::Flores { .. } => "flores",
            Contact::Elastoplastic { .. } => "elastoplastic",
        }
    }

    /// What the bodies are made of, where a law takes its stiffness from that.
    pub(crate) fn materials(&self) -> Option<&Materials> {
        match self {
            Contact::Hertz(stiffness)
            | Contact::Viscous { stiffness, .. }
            | Contact::Hysteretic { stiffness, .. }
            | Contact::HuntCrossley { stiffness, .. }
            | Contact::LankaraniNikravesh { stiffness, .. }
            | Contact::Flores { stiffness, .. } => Some(&stiffness.materials),
            Contact::Elastoplastic { materials, .. } => Some(materials),
            Contact::LinearSpring { .. }
            | Contact::Power { .. }
            | Contact::Felt { .. }
            | Contact::KelvinVoigt { .. } => None,
        }
    }

    /// Whether the contact is loaded as Hertz's is.
    pub(crate) fn is_hertzian(&self) -> bool {
        self.materials().is_some() && !matches!(self, Contact::HuntCrossley { exponent: Some(_), .. })
    }

    /// The law with its parameters, for this striker and the speed of approach to which a `restitution` belongs. The striker's own
    /// speed does not enter.
    pub(crate) fn law(&self, striker: &Striker, speed: f64) -> Result<Law, InvalidInput> {
        let no_approach = (speed <= 0.0).then_some("striker and structure do not approach each other at the start");
        let no_mass =
            striker.immovable.then_some("it belongs to the mass of the striker, and an immovable one has none");
        let law: Result<Law, InvalidInput> = match *self {
            Contact::Hertz(stiffness) => Hertz::new(stiffness.of(striker)?).map(Law::from),
            Contact::Viscous { stiffness, damping_s_m, restitution } => {
                let k = stiffness.of(striker)?;
                match damping(("damping_s_m", damping_s_m), restitution, no_approach)? {
                    Damping::Given(c) => Viscous::new(k, c),
                    Damping::FromRestitution(e) => Viscous::with_restitution(k, e, speed),
                }
                .map(Law::from)
            }
            Contact::Hysteretic { stiffness, theta_m, beta, k_bar, epsilon_m } => {
                let share = if stiffness.is_given() { 1.0 } else { 1.0 + theta_m + beta };
                let stiffness_n_m1_5 = stiffness.of(striker)? / share;
                match (Hysteretic { stiffness_n_m1_5, theta_m, beta, k_bar, epsilon_m }).validated() {
                    Err(fault) if fault.field == "stiffness_n_m1_5" && !stiffness.is_given() => {
                        let quantity = "stiffness of the contact over 1 + theta_m + beta";
                        return Err(stiffness.materials.follows(quantity, &fault, striker));
                    }
                    law => law.map(Law::from),
                }
            }
            Contact::LinearSpring { stiffness_n_m } => LinearSpring::new(stiffness_n_m).map(Law::from),
            Contact::Power { stiffness_n_m_n, exponent } => Power::new(stiffness_n_m_n, exponent).map(Law::from),
            Contact::Felt { stiffness_n_m_n, exponent, retardation_time_s } => {
                Felt::new(stiffness_n_m_n, exponent, retardation_time_s).map(Law::from)
            }
            Contact::KelvinVoigt { stiffness_n_m: k, damping_n_s_m, restitution } => {
                match damping(("damping_n_s_m", damping_n_s_m), restitution, no_mass)? {
                    Damping::Given(c) => KelvinVoigt::new(k, c),
                    Damping::FromRestitution(e) => KelvinVoigt::with_restitution(k, e, striker.mass_kg()?),
                }
                .map(Law::from)
            }
            Contact::HuntCrossley { stiffness, stiffness_n_m_n, exponent, damping_s_m, restitution } => {
                let hertzian = stiffness_n_m_n.is_none() && exponent.is_none();
                let (k, n) = match hertzian {
                    true => (stiffness.of(striker)?, 1.5),
                    false => stiffness.or_general((stiffness_n_m_n, exponent))?,
                };
                let law = match damping(("damping_s_m", damping_s_m), restitution, no_approach)? {
                    Damping::Given(c) => HuntCrossley::new(k, n, c),
                    Damping::FromRestitution(e) => HuntCrossley::with_restitution(k, n, e, speed),
                };
                law.map(Law::from).map_err(|fault| match fault.field.first() {
                    // the scene states Hertz's stiffness
                    Some("stiffness_n_m_n") if hertzian => InvalidInput { field: "stiffness_n_m1_5".into(), ..fault },
                    _ => fault,
                })
            }
            Contact::LankaraniNikravesh { stiffness, restitution, lowest_approach_speed_m_s } => {
                LankaraniNikravesh::new(stiffness.of(striker)?, restitution).and_then(|law| {
                    let lowest_approach_speed_m_s = lowest_approach_speed_m_s.unwrap_or(law.lowest_approach_speed_m_s);
                    LankaraniNikravesh { lowest_approach_speed_m_s, ..law }.validated().map(Law::from)
                })
            }
            Contact::Flores { stiffness, restitution, lowest_approach_speed_m_s } => {
                Flores::new(stiffness.of(striker)?, restitution).and_then(|law| {
                    let lowest_approach_speed_m_s = lowest_approach_speed_m_s.unwrap_or(law.lowest_approach_speed_m_s);
                    Flores { lowest_approach_speed_m_s, ..law }.validated().map(Law::from)
                })
            }
            Contact::Elastoplastic { materials, yield_pressure_pa } => {
                let (ball, structure) = materials.bodies(striker)?;
                match Thornton::from_bodies(&ball, &structure, yield_pressure_pa) {
                    Err(fault) if fault.field == "effective_modulus_pa" => {
                        return Err(materials.follows("effective modulus of the contact", &fault, striker));
                    }
                    law => law.map(Law::from),
                }
            }
        };
        law.map_err(|fault| match fault.field.first() {
            Some("speed_m_s" | "mass_kg" | "radius_m") => fault.within("striker"),
            _ => in_contact(fault),
        })
    }
}

enum Damping {
    Given(f64),
    FromRestitution(f64),
}

/// The damping is stated directly or follows from a restitution, unless there is a reason against that.
fn damping(
    given: (&str, Option<f64>),
    restitution: Option<f64>,
    against: Option<&str>,
) -> Result<Damping, InvalidInput> {
    one_of_sets(&[given, ("restitution", restitution)], &[&[given.0], &["restitution"]]).map_err(in_contact)?;
    match (given.1, restitution, against) {
        (None, Some(restitution), Some(reason)) => {
            let allowed = format!("left out, because {reason}; {} takes its place", given.0);
            Err(in_contact(InvalidInput::new("restitution", number(restitution), allowed)))
        }
        (Some(damping), ..) => Ok(Damping::Given(damping)),
        (None, restitution, _) => Ok(Damping::FromRestitution(restitution.unwrap_or(f64::NAN))),
    }
}
