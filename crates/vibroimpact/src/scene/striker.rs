//! The striker of a scene.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::error::InvalidInput;
use super::json::number;

/// How far a given mass may be from that of a sphere of the given density and radius.
const MASS_AGREEMENT: f64 = 1e-3;

/// The compact body: its mass (or a solid sphere's density and radius) and its speed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Striker {
    /// Mass (kg). May be left out when density and radius are given.
    pub mass_kg: Option<f64>,
    /// Density of a solid sphere (kg/m^3).
    pub density_kg_m3: Option<f64>,
    /// Radius of curvature at the point of contact (m); needed where the contact's stiffness comes from materials.
    pub radius_m: Option<f64>,
    /// Speed towards the structure (m/s).
    pub speed_m_s: f64,
}

impl Striker {
    /// The mass as given, or that of the sphere (kg). Both may be given if they agree within 0.1 %; the mass then
    /// counts.
    ///
    /// # Errors
    /// Neither is given, they contradict each other, or a value is not positive.
    pub fn mass_kg(&self) -> Result<f64, InvalidInput> {
        let Striker { mass_kg, density_kg_m3, radius_m, .. } = *self;
        for (field, value) in [("mass_kg", mass_kg), ("density_kg_m3", density_kg_m3), ("radius_m", radius_m)] {
            value.map_or(Ok(()), |value| InvalidInput::require_positive(field, value))?;
        }
        let sphere = density_kg_m3.zip(radius_m).map(|(density, radius)| 4.0 / 3.0 * PI * radius.powi(3) * density);
        let agrees = |mass: f64, sphere: f64| ((mass - sphere) / sphere).abs() <= MASS_AGREEMENT;
        match (mass_kg, sphere) {
            (Some(mass), Some(sphere)) if !agrees(mass, sphere) => {
                let sphere = number(sphere);
                let allowed =
                    format!("left out beside density_kg_m3 and radius_m, or within 0.1 % of that sphere's {sphere} kg");
                Err(InvalidInput::new("mass_kg", number(mass), allowed))
            }
            (Some(mass), _) | (None, Some(mass)) => Ok(mass),
            (None, None) => {
                let field = if density_kg_m3.is_some() { "radius_m" } else { "mass_kg" };
                Err(InvalidInput::missing(field, "give mass_kg, or density_kg_m3 and radius_m of a solid sphere"))
            }
        }
    }
}
