//! The contact between striker and structure.

use contact_models::{Body, Hertz, Hysteretic, Law, Viscous, effective_modulus_pa};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::error::InvalidInput;
use super::json::{quote, read};
use super::sets::one_of_sets;
use super::{Striker, fields};

/// The law of the contact; `"law"` in JSON tells which, beside its parameters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "law", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Contact {
    /// `"hertz"`: elastic contact, [`contact_models::Hertz`].
    Hertz(HertzStiffness),
    /// `"viscous"`: the thesis's viscous dissipation, [`contact_models::Viscous`].
    Viscous {
        /// The elastic part.
        #[serde(flatten)]
        stiffness: HertzStiffness,
        /// Damping `c` of thesis Eq. 3.15 (s/m).
        damping_s_m: Option<f64>,
        /// In place of the damping: the restitution at an immovable wall at the striker's speed.
        restitution: Option<f64>,
    },
    /// `"hysteretic"`: the thesis's rate-independent dissipation, [`contact_models::Hysteretic`]. Where the
    /// stiffness comes from materials it is divided by `1 + theta_m + beta`, so that first loading follows Hertz
    /// (thesis 3.3.4); `stiffness_n_m1_5` is taken as it stands.
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
        /// Regularisation (m) at zero compression; 0 when left out, which stands for its limit.
        #[serde(default)]
        epsilon_m: f64,
    },
}

/// Stiffness of a Hertzian contact: given, or from the materials and the striker's radius.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct HertzStiffness {
    /// The stiffness itself (N/m^1.5).
    pub stiffness_n_m1_5: Option<f64>,
    /// Young's modulus of both bodies, or of the structure where the striker's own is given (Pa).
    pub youngs_modulus_pa: Option<f64>,
    /// Poisson's ratio of both bodies, or of the structure where the striker's own is given.
    pub poissons_ratio: Option<f64>,
    /// Young's modulus of a striker of another material (Pa).
    pub striker_youngs_modulus_pa: Option<f64>,
    /// Poisson's ratio of a striker of another material.
    pub striker_poissons_ratio: Option<f64>,
}

impl Contact {
    pub(crate) fn from_value(value: &Value) -> Result<Contact, InvalidInput> {
        let contact = match value.as_object() {
            None => return Err(fault("", Some(value))),
            Some(entries) if !entries.get("law").is_some_and(Value::is_string) => {
                return Err(fault("law", entries.get("law")));
            }
            Some(entries) => {
                let numeric = |(key, value): &(&String, &Value)| *key == "law" || value.is_number();
                if let Some((key, value)) = entries.iter().find(|entry| !numeric(entry)) {
                    return Err(fault(key, Some(value)));
                }
                read::<Contact>(value).map_err(|found| if found.field.is_empty() { fault("law", entries.get("law")) } else { found })?
            }
        };
        // serde cannot refuse unknown fields beside flattened ones: what is not written back was not read
        let known = serde_json::to_value(contact).unwrap_or_default();
        match value.as_object().into_iter().flatten().find(|(key, _)| known.get(key).is_none()) {
            Some((key, value)) => {
                let fields: Vec<&str> = known.as_object().into_iter().flatten().map(|(key, _)| key.as_str()).collect();
                let allowed = format!("no such field; here stand {}", fields.join(", "));
                Err(InvalidInput { field: key.clone(), value: Some(quote(value)), allowed })
            }
            None => Ok(contact),
        }
    }

    /// The law with its parameters, for this striker.
    pub(crate) fn law(&self, striker: &Striker) -> Result<Law, InvalidInput> {
        let law = match *self {
            Contact::Hertz(stiffness) => Hertz::new(stiffness.with(striker)?).map(Law::from),
            Contact::Viscous { stiffness, damping_s_m, restitution } => {
                let k = stiffness.with(striker)?;
                let given = [("damping_s_m", damping_s_m), ("restitution", restitution)];
                one_of_sets(&given, &[&["damping_s_m"], &["restitution"]]).map_err(in_contact)?;
                match (damping_s_m, restitution) {
                    (_, Some(restitution)) => Viscous::with_restitution(k, restitution, striker.speed_m_s),
                    (damping_s_m, None) => Viscous::new(k, damping_s_m.unwrap_or_default()),
                }
                .map(Law::from)
            }
            Contact::Hysteretic { stiffness, theta_m, beta, k_bar, epsilon_m } => {
                let share = if stiffness.stiffness_n_m1_5.is_some() { 1.0 } else { 1.0 + theta_m + beta };
                Hysteretic::new(stiffness.with(striker)? / share, theta_m, beta, k_bar, epsilon_m).map(Law::from)
            }
        };
        law.map_err(|fault| match fault.field.as_str() {
            "speed_m_s" => InvalidInput::from(fault).within("striker"),
            _ => in_contact(fault),
        })
    }
}

fn fault(field: &str, value: Option<&Value>) -> InvalidInput {
    let allowed = fields::allowed(if field.is_empty() { "contact" } else { field }).unwrap_or("a number").to_owned();
    InvalidInput { field: field.to_owned(), value: value.map(quote), allowed }
}

fn in_contact(fault: impl Into<InvalidInput>) -> InvalidInput {
    fault.into().within("contact")
}

impl HertzStiffness {
    const SETS: [&[&str]; 3] = [
        &["stiffness_n_m1_5"],
        &["youngs_modulus_pa", "poissons_ratio"],
        &["youngs_modulus_pa", "poissons_ratio", "striker_youngs_modulus_pa", "striker_poissons_ratio"],
    ];

    /// The stiffness (N/m^1.5) of this striker against a flat structure.
    fn with(&self, striker: &Striker) -> Result<f64, InvalidInput> {
        let given = [
            ("stiffness_n_m1_5", self.stiffness_n_m1_5),
            ("youngs_modulus_pa", self.youngs_modulus_pa),
            ("poissons_ratio", self.poissons_ratio),
            ("striker_youngs_modulus_pa", self.striker_youngs_modulus_pa),
            ("striker_poissons_ratio", self.striker_poissons_ratio),
        ];
        one_of_sets(&given, &HertzStiffness::SETS).map_err(in_contact)?;
        if let Some(stiffness) = self.stiffness_n_m1_5 {
            return Ok(stiffness);
        }
        let radius_m = striker.radius_m.ok_or_else(|| InvalidInput {
            field: "striker.radius_m".to_owned(),
            value: None,
            allowed: "needed for a contact given by materials: a finite number greater than 0".to_owned(),
        })?;
        // both are there: a whole set was given
        let [modulus, ratio] = [self.youngs_modulus_pa, self.poissons_ratio].map(|value| value.unwrap_or(f64::NAN));
        let structure = Body::flat(modulus, ratio);
        let ball = Body {
            youngs_modulus_pa: self.striker_youngs_modulus_pa.unwrap_or(modulus),
            poissons_ratio: self.striker_poissons_ratio.unwrap_or(ratio),
            radius_m,
        };
        // each material against a rigid partner, so that a fault is laid at the right door
        let partner = Body::rigid(1.0);
        effective_modulus_pa(&structure, &partner).map_err(in_contact)?;
        effective_modulus_pa(&ball, &partner).map_err(|mut fault| {
            fault.field.insert_str(0, "striker_");
            in_contact(fault)
        })?;
        let hertz = Hertz::from_bodies(&ball, &structure).map_err(|fault| match fault.field.as_str() {
            "radius_m" => InvalidInput::from(fault).within("striker"),
            _ => in_contact(fault),
        })?;
        Ok(hertz.stiffness_n_m1_5)
    }
}
