//! The striker of a scene.

use std::f64::consts::PI;

use contact_models::LARGEST;
use invalid_input::InvalidInput;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::require_positive;
use super::extreme::of_product;
use super::json::number;

/// The compact body: its mass (or a solid sphere's density and radius) and its speed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Striker {
    /// Mass (kg), or `density_kg_m3` and `radius_m` in its place.
    pub mass_kg: Option<f64>,
    /// Density of a solid sphere (kg/m^3), in place of its mass.
    pub density_kg_m3: Option<f64>,
    /// Radius of curvature at the point of contact (m); needed where the contact's stiffness comes from materials.
    pub radius_m: Option<f64>,
    /// Whether the striker is a stop that never moves, of infinite mass; `false` when left out. Its speed is then 0, and
    /// `start` states the motion of the structure towards it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub immovable: bool,
    /// Speed towards the structure (m/s).
    pub speed_m_s: f64,
}

impl Striker {
    /// A solid sphere (kg/m^3, m, m/s).
    pub fn sphere(density_kg_m3: f64, radius_m: f64, speed_m_s: f64) -> Striker {
        Striker { density_kg_m3: Some(density_kg_m3), radius_m: Some(radius_m), speed_m_s, ..Striker::default() }
    }

    /// A body of which only mass and speed matter (kg, m/s), for contacts given by their stiffness.
    pub fn of_mass(mass_kg: f64, speed_m_s: f64) -> Striker {
        Striker { mass_kg: Some(mass_kg), speed_m_s, ..Striker::default() }
    }

    /// A stop that never moves, which a moving structure meets.
    pub fn stop() -> Striker {
        Striker { immovable: true, ..Striker::default() }
    }

    /// The given mass, or that of the sphere (kg). Infinite for an immovable striker.
    ///
    /// # Errors
    /// Neither is given, or both, or a value is not positive.
    pub fn mass_kg(&self) -> Result<f64, InvalidInput> {
        let Striker { mass_kg, density_kg_m3, radius_m, .. } = *self;
        for (field, value) in [("mass_kg", mass_kg), ("density_kg_m3", density_kg_m3), ("radius_m", radius_m)] {
            value.map_or(Ok(()), |value| require_positive(field, value))?;
        }
        if self.immovable {
            return self.stop_mass_kg();
        }
        let sphere = density_kg_m3.zip(radius_m).map(|(density, radius)| 4.0 / 3.0 * PI * radius.powi(3) * density);
        match (mass_kg, density_kg_m3, sphere) {
            (Some(mass), Some(_), Some(sphere)) => {
                let sphere = number(sphere);
                let allowed =
                    format!("left out in the presence of density_kg_m3 and radius_m, whose sphere has {sphere} kg");
                Err(InvalidInput::new("mass_kg", number(mass), allowed))
            }
            (Some(_), Some(density), None) => {
                let allowed = "left out in the presence of mass_kg, or given with radius_m instead of mass_kg";
                Err(InvalidInput::new("density_kg_m3", number(density), allowed))
            }
            (None, Some(density), Some(mass)) if !(1.0 / LARGEST..=LARGEST).contains(&mass) => {
                let fields = [("density_kg_m3", density), ("radius_m", radius_m.unwrap_or_default())];
                Err(of_product("mass of the sphere", mass, &fields, "from 1e-30 to 1e30"))
            }
            (Some(mass), None, _) | (None, _, Some(mass)) => Ok(mass),
            (None, density, None) => {
                let field = if density.is_some() { "radius_m" } else { "mass_kg" };
                Err(InvalidInput::missing(
                    field,
                    "given, unless mass_kg or both density_kg_m3 and radius_m of a solid sphere are",
                ))
            }
        }
    }

    fn stop_mass_kg(&self) -> Result<f64, InvalidInput> {
        let left_out = "left out in the presence of immovable, because a stop has no mass";
        match (self.mass_kg, self.density_kg_m3) {
            (Some(mass), _) => Err(InvalidInput::new("mass_kg", number(mass), left_out)),
            (_, Some(density)) => Err(InvalidInput::new("density_kg_m3", number(density), left_out)),
            _ if self.speed_m_s != 0.0 => {
                let allowed = "0 for an immovable striker; the field start states the motion of the structure";
                Err(InvalidInput::new("speed_m_s", number(self.speed_m_s), allowed))
            }
            _ => Ok(f64::INFINITY),
        }
    }
}
