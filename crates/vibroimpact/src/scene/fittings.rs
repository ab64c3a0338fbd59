//! What may be fixed to a beam, and how it is damped.

use invalid_input::{InvalidInput, Path};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fields;
use super::json::number;

/// Masses and springs fixed to a beam at one location; all fields but the location may be left out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// Location on the beam from its left end (m).
    pub location_m: f64,
    /// Mass (kg); 0 when left out.
    #[serde(default)]
    #[schemars(schema_with = "mass")]
    pub mass_kg: f64,
    /// Rotary inertia about the axis of bending (kg m^2); 0 when left out.
    #[serde(default)]
    pub rotary_inertia_kg_m2: f64,
    /// Spring between beam and ground (N/m); 0 when left out.
    #[serde(default)]
    pub spring_n_m: f64,
    /// Rotational spring between beam and ground (N m/rad); 0 when left out.
    #[serde(default)]
    pub rotational_spring_n_m_rad: f64,
}

/// The mass of an attachment may be zero, unlike that of a striker.
fn mass(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
    schemars::json_schema!({ "anyOf": [{ "type": "number", "minimum": 0.0 }], "default": 0.0 })
}

/// A rigid support between the ends of a beam: no displacement, no moment.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// Location on the beam from its left end (m).
    pub location_m: f64,
}

/// Damping of the modes of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Damping<'a> {
    /// Of every mode beyond the list.
    pub ratio: f64,
    /// Of the first elastic modes.
    pub ratios: &'a [f64],
    /// Coefficients of mass and stiffness.
    pub rayleigh: [f64; 2],
}

impl Damping<'_> {
    pub fn check(&self) -> Result<(), InvalidInput> {
        let given = [
            ("damping_ratio", self.ratio),
            ("rayleigh_mass_per_s", self.rayleigh[0]),
            ("rayleigh_stiffness_s", self.rayleigh[1]),
        ];
        for (field, value) in given {
            require_not_negative(field, field, value)?;
        }
        for (k, &value) in self.ratios.iter().enumerate() {
            require_not_negative(("damping_ratios", k), "damping_ratio", value)?;
        }
        Ok(())
    }

    /// Of the elastic mode `k` (from 0): `zeta_k + alpha/(2 omega) + beta omega/2`. Rigid-body motions are not damped.
    pub fn of(&self, k: Option<usize>, omega_rad_s: f64) -> f64 {
        let ratio = k.and_then(|k| self.ratios.get(k)).copied().unwrap_or(self.ratio);
        let [mass, stiffness] = self.rayleigh;
        match k {
            Some(_) if self.rayleigh != [0.0; 2] => ratio + 0.5 * (mass / omega_rad_s + stiffness * omega_rad_s),
            _ => ratio,
        }
    }
}

/// Largest damping ratio that the solver takes.
const MOST_DAMPING: f64 = 1e6;

fn require_not_negative(path: impl Into<Path>, field: &str, value: f64) -> Result<(), InvalidInput> {
    let most = if field == "damping_ratio" { MOST_DAMPING } else { f64::MAX };
    if value >= 0.0 && value <= most {
        return Ok(());
    }
    Err(InvalidInput::new(path, number(value), fields::allowed(field).unwrap_or_default()))
}
