//! The file of a problem.

use contact_models::{
    Felt, Flores, Hertz, HuntCrossley, Hysteretic, KelvinVoigt, LankaraniNikravesh, Law, LinearSpring, Thornton,
    Viscous,
};
use serde::{Deserialize, Serialize};
use std::path::Path;
use vibroimpact_sim::modal::Mode;

/// A problem: its description, the requested quantities, and the reference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Problem {
    /// Short name, that of the file.
    pub name: String,
    /// Its family.
    pub family: Family,
    /// A description for readers.
    pub statement: String,
    /// Abilities that a code needs to take part.
    pub needs: Vec<String>,
    /// The bodies.
    pub bodies: Vec<Body>,
    /// The contacts.
    pub contacts: Vec<Contact>,
    /// Acceleration of gravity, which acts downwards on free masses (m/s^2).
    pub gravity_m_s2: f64,
    /// Further forces on the bodies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<Load>,
    /// The single parameter `S` of an impact on an infinite beam, which then has no bodies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub infinite_beam_s: Option<f64>,
    /// The time of the requested quantities (s).
    pub end_s: f64,
    /// The requested quantities.
    pub quantities: Vec<Quantity>,
    /// The method of the reference.
    pub reference: String,
}

/// Problems of a kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// A ball at an immovable ground, with a given law.
    Law,
    /// The same, where only the restitution is requested.
    Restitution,
    /// A ball on a structure in its modes.
    Structure,
    /// A ball on an infinite beam.
    InfiniteBeam,
    /// Several bodies and contacts at once.
    Several,
    /// Bodies that vibrate against elastic stops.
    Stop,
}

/// A body in its modes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Circular frequencies of its modes (rad/s); 0 of a free mass.
    pub omega_rad_s: Vec<f64>,
    /// Damping ratio of each mode.
    pub damping_ratio: Vec<f64>,
    /// Mass-normalised shape of each mode at the body's point (kg^-1/2), `m^(-1/2)` of a free mass. Contacts, loads and
    /// quantities refer to this point unless they name another.
    pub shape: Vec<f64>,
    /// Amplitudes at the start (kg^1/2 m).
    pub amplitude: Vec<f64>,
    /// Their rates (kg^1/2 m/s).
    pub rate: Vec<f64>,
}

/// A contact. The ground is on the side without a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Name of the body that is pushed up.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper: Option<String>,
    /// Shapes of its modes at the contact, if not at its own point (kg^-1/2).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper_shape: Option<Vec<f64>>,
    /// Name of the body that is pushed down.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower: Option<String>,
    /// Shapes of its modes at the contact, if not at its own point (kg^-1/2).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_shape: Option<Vec<f64>>,
    /// Distance at zero displacement (m).
    pub gap_m: f64,
    /// The law.
    pub law: LawOfContact,
}

/// A force `force_n sin(omega_rad_s t + phase_rad)` on a body, positive upwards.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Name of the body.
    pub body: String,
    /// Modal force per unit of force, if not the shapes at the body's own point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Vec<f64>>,
    /// Amplitude (N, or m/s^2 if the shape is that of an acceleration).
    pub force_n: f64,
    /// Circular frequency (rad/s); 0 for a constant force, whose phase is then a quarter of a turn.
    pub omega_rad_s: f64,
    /// Phase at the start (rad).
    pub phase_rad: f64,
}

/// The law of a contact, by name and parameters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields are those of the laws in contact-models")]
pub enum LawOfContact {
    Hertz {
        stiffness_n_m1_5: f64,
    },
    LinearSpring {
        stiffness_n_m: f64,
    },
    Viscous {
        stiffness_n_m1_5: f64,
        damping_s_m: f64,
    },
    Hysteretic {
        stiffness_n_m1_5: f64,
        theta_m: f64,
        beta: f64,
        k_bar: f64,
        epsilon_m: f64,
    },
    KelvinVoigt {
        stiffness_n_m: f64,
        damping_n_s_m: f64,
    },
    HuntCrossley {
        stiffness_n_m_n: f64,
        exponent: f64,
        damping_s_m: f64,
    },
    LankaraniNikravesh {
        stiffness_n_m1_5: f64,
        restitution: f64,
    },
    Flores {
        stiffness_n_m1_5: f64,
        restitution: f64,
    },
    Felt {
        stiffness_n_m_n: f64,
        exponent: f64,
        retardation_time_s: f64,
    },
    Thornton {
        effective_modulus_pa: f64,
        effective_radius_m: f64,
        yield_pressure_pa: f64,
    },
    /// No law is given, but the requested restitution.
    Restitution {
        restitution: f64,
    },
}

/// A requested quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quantity {
    /// Name of the body; empty for an infinite beam.
    pub body: String,
    /// Shapes of its modes at the point of the quantity, if not its own (kg^-1/2).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Vec<f64>>,
    /// The quantity of its point.
    pub what: What,
    /// The reference.
    pub value: f64,
    /// Uncertainty of the reference.
    pub uncertainty: f64,
    /// The number by which an error is divided.
    pub scale: f64,
}

/// The requested quantity of a body's point at the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum What {
    /// Velocity, positive upwards (m/s).
    VelocityMS,
    /// Displacement (m).
    DisplacementM,
    /// Speed after the first contact over that before, on an infinite beam.
    FirstReboundRatio,
}

impl Body {
    /// A free mass.
    pub fn mass(name: &str, mass_kg: f64, displacement_m: f64, velocity_m_s: f64) -> Body {
        let root = mass_kg.sqrt();
        Body {
            name: name.into(),
            omega_rad_s: vec![0.0],
            damping_ratio: vec![0.0],
            shape: vec![1.0 / root],
            amplitude: vec![root * displacement_m],
            rate: vec![root * velocity_m_s],
        }
    }

    /// A structure at rest, with its modes at the contact.
    pub fn at_rest(name: &str, modes: &[Mode]) -> Body {
        let zeros = vec![0.0; modes.len()];
        Body {
            name: name.into(),
            omega_rad_s: modes.iter().map(|mode| mode.omega_rad_s).collect(),
            damping_ratio: modes.iter().map(|mode| mode.damping_ratio).collect(),
            shape: modes.iter().map(|mode| mode.shape).collect(),
            amplitude: zeros.clone(),
            rate: zeros,
        }
    }

    /// The mass of a free mass (kg).
    pub fn free_mass_kg(&self) -> Option<f64> {
        match (self.omega_rad_s.as_slice(), self.shape.as_slice()) {
            ([0.0], [shape]) => Some(shape.powi(-2)),
            _ => None,
        }
    }

    /// Displacement of the body's point, or its velocity, from amplitudes or rates.
    pub fn at_point(&self, modal: &[f64]) -> f64 {
        self.shape.iter().zip(modal).map(|(shape, value)| shape * value).sum()
    }
}

impl LawOfContact {
    /// The law; `None` if only a restitution is requested.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn law(&self) -> Result<Option<Law>, contact_models::InvalidInput> {
        use LawOfContact as Of;
        Ok(Some(match *self {
            Of::Hertz { stiffness_n_m1_5 } => Hertz::new(stiffness_n_m1_5)?.into(),
            Of::LinearSpring { stiffness_n_m } => LinearSpring::new(stiffness_n_m)?.into(),
            Of::Viscous { stiffness_n_m1_5, damping_s_m } => Viscous::new(stiffness_n_m1_5, damping_s_m)?.into(),
            Of::Hysteretic { stiffness_n_m1_5, theta_m, beta, k_bar, epsilon_m } => {
                Hysteretic { stiffness_n_m1_5, theta_m, beta, k_bar, epsilon_m }.validated()?.into()
            }
            Of::KelvinVoigt { stiffness_n_m, damping_n_s_m } => KelvinVoigt::new(stiffness_n_m, damping_n_s_m)?.into(),
            Of::HuntCrossley { stiffness_n_m_n, exponent, damping_s_m } => {
                HuntCrossley::new(stiffness_n_m_n, exponent, damping_s_m)?.into()
            }
            Of::LankaraniNikravesh { stiffness_n_m1_5, restitution } => {
                LankaraniNikravesh::new(stiffness_n_m1_5, restitution)?.into()
            }
            Of::Flores { stiffness_n_m1_5, restitution } => Flores::new(stiffness_n_m1_5, restitution)?.into(),
            Of::Felt { stiffness_n_m_n, exponent, retardation_time_s } => {
                Felt::new(stiffness_n_m_n, exponent, retardation_time_s)?.into()
            }
            Of::Thornton { effective_modulus_pa, effective_radius_m, yield_pressure_pa } => {
                Thornton::new(effective_modulus_pa, effective_radius_m, yield_pressure_pa)?.into()
            }
            Of::Restitution { .. } => return Ok(None),
        }))
    }
}

impl Contact {
    /// A contact at the bodies' own points; the ground for a side without a body.
    pub fn new(upper: &str, lower: Option<&str>, gap_m: f64, law: LawOfContact) -> Contact {
        let (upper, lower) = (Some(upper.to_owned()), lower.map(str::to_owned));
        Contact { upper, upper_shape: None, lower, lower_shape: None, gap_m, law }
    }
}

impl Problem {
    /// A body by its name, and its number.
    ///
    /// # Errors
    /// No body has this name.
    pub fn body(&self, name: &str) -> Result<(usize, &Body), String> {
        let found = self.bodies.iter().enumerate().find(|(_, body)| body.name == name);
        found.ok_or_else(|| format!("{}: no body is called {name}", self.name))
    }

    /// Every problem of a folder, in order of families and names.
    ///
    /// # Errors
    /// A file that cannot be read, by its name.
    pub fn read_all(folder: &Path) -> Result<Vec<Problem>, String> {
        let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let mut problems = Vec::new();
        for entry in entries {
            let path = entry.map_err(|error| error.to_string())?.path();
            let told = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
            let text = std::fs::read_to_string(&path).map_err(|error| told(&error))?;
            problems.push(serde_json::from_str::<Problem>(&text).map_err(|error| told(&error))?);
        }
        problems.sort_by(|a, b| (a.family, &a.name).cmp(&(b.family, &b.name)));
        Ok(problems)
    }

    /// Uncertainty of the reference, divided by its scale.
    pub fn floor(&self) -> f64 {
        self.quantities.iter().map(|quantity| quantity.uncertainty / quantity.scale).fold(1e-16, f64::max)
    }

    /// The error of a result.
    pub fn error(&self, values: &[f64]) -> f64 {
        let right: Vec<f64> = self.quantities.iter().map(|quantity| quantity.value).collect();
        self.distance(values, &right)
    }

    /// The distance between two results: the maximum over the quantities, each divided by its scale.
    pub fn distance(&self, values: &[f64], others: &[f64]) -> f64 {
        let pairs = self.quantities.iter().zip(values.iter().zip(others));
        pairs.map(|(quantity, (value, other))| (value - other).abs() / quantity.scale).fold(0.0, f64::max)
    }

    /// The requested restitution of the only contact, if no law is given.
    pub fn wanted_restitution(&self) -> Option<f64> {
        match self.contacts.as_slice() {
            [Contact { law: LawOfContact::Restitution { restitution }, .. }] => Some(*restitution),
            _ => None,
        }
    }
}
