//! What may be fixed to a beam, and how it is damped.

use invalid_input::InvalidInput;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::damping::require_damping;
use super::json::number;
use super::ranges::NOT_NEGATIVE;

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
        require_damping(self.ratio)?;
        let [mass_per_s, stiffness_s] = self.rayleigh;
        for (field, value) in [("rayleigh_mass_per_s", mass_per_s), ("rayleigh_stiffness_s", stiffness_s)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(InvalidInput::new(field, number(value), NOT_NEGATIVE));
            }
        }
        for (k, &ratio) in self.ratios.iter().enumerate() {
            require_damping(ratio).map_err(|fault| fault.under(("damping_ratios", k)))?;
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
