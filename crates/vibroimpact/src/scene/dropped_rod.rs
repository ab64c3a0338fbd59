//! A rod that falls on the floor, as a scene.

use std::f64::consts::{FRAC_PI_2, PI};

use invalid_input::InvalidInput;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vibroimpact_sim::dropped_rod;
use vibroimpact_sim::modal::Mode;

use super::damping::require_damping;
use super::extreme::follows_from;
use super::fields;
use super::json::number;

/// A rod of circular section with hemispherical ends that falls, without turning, on an immovable floor (thesis
/// chapter 8). The floor takes the part of the striker: of `striker` only `speed_m_s` is given, the speed of the fall at
/// first touch; `location_m`, `modes`, `residual_compliance` and `start` are left out. In `contact`, a striker of another
/// material is the floor; `{ "law": "hertz" }` without further fields is the rod's own material on a rigid floor. Remainder modes always represent the truncated modes. The restitution is that of the
/// contact point's rigid-body motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DroppedRod {
    /// Length (m).
    pub length_m: f64,
    /// Diameter (m); the ends are hemispheres of half of it in radius.
    pub diameter_m: f64,
    /// Young's modulus (Pa).
    pub youngs_modulus_pa: f64,
    /// Density (kg/m^3).
    pub density_kg_m3: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
    /// Angle between rod and floor (degrees): 0 for a lying rod, 90 for an upright one.
    pub inclination_deg: f64,
    /// Damping ratio of the elastic modes; 0 when left out.
    #[serde(default)]
    pub damping_ratio: f64,
    /// Number of bending modes; 40 when left out.
    #[serde(default = "bending_modes")]
    pub bending_modes: usize,
    /// Number of axial modes; 20 when left out.
    #[serde(default = "axial_modes")]
    pub axial_modes: usize,
}

fn bending_modes() -> usize {
    40
}

fn axial_modes() -> usize {
    20
}

impl DroppedRod {
    /// The rod as input of the solver.
    ///
    /// # Errors
    /// An inclination or a damping ratio out of range; [`DroppedRod::drop`] checks the rest.
    pub fn to_rod(&self) -> Result<dropped_rod::DroppedRod, InvalidInput> {
        if !(0.0..=90.0).contains(&self.inclination_deg) {
            let allowed = fields::allowed("inclination_deg").unwrap_or_default();
            return Err(InvalidInput::new("inclination_deg", number(self.inclination_deg), allowed));
        }
        require_damping(self.damping_ratio)?;
        Ok(dropped_rod::DroppedRod {
            length_m: self.length_m,
            diameter_m: self.diameter_m,
            youngs_modulus_pa: self.youngs_modulus_pa,
            density_kg_m3: self.density_kg_m3,
            poissons_ratio: self.poissons_ratio,
            inclination_rad: self.inclination_deg.to_radians().min(FRAC_PI_2),
            bending_modes: self.bending_modes,
            axial_modes: self.axial_modes,
            damping_ratio: self.damping_ratio,
        })
    }

    /// The fall of the rod with this speed at first touch (m/s).
    ///
    /// # Errors
    /// A number out of range; those of the section are named by the field from which they follow.
    pub fn drop(&self, speed_m_s: f64) -> Result<dropped_rod::Drop, InvalidInput> {
        self.to_rod()?.drop(speed_m_s).map_err(|fault| {
            let by_modulus = ("youngs_modulus_pa", self.youngs_modulus_pa);
            let by_density = ("density_kg_m3", self.density_kg_m3);
            let (quantity, material) = match fault.field.last() {
                Some("flexural_rigidity_n_m2") => ("flexural rigidity", by_modulus),
                Some("axial_rigidity_n") => ("axial rigidity", by_modulus),
                Some("mass_per_length_kg_m") => ("mass per length", by_density),
                _ => return fault,
            };
            follows_from(quantity, &fault, &[material, ("diameter_m", self.diameter_m)]).unwrap_or(fault)
        })
    }

    /// Rigid-body motions and modes with their shapes at the end that strikes, from the lowest frequency.
    pub(super) fn modes(&self) -> Result<Vec<Mode>, InvalidInput> {
        let drop = self.drop(1.0)?;
        let mut modes = drop.structure.modes;
        modes.truncate(modes.len() - drop.remainder_modes);
        modes.sort_by(|a, b| a.omega_rad_s.total_cmp(&b.omega_rad_s));
        Ok(modes)
    }

    /// Static compliance of the whole elastic rod at its lower end (m/N): of its modes, both ends free,
    ///
    /// ```text
    /// L^3 cos^2 / (105 E I) + L sin^2 / (3 E A).
    /// ```
    pub(super) fn static_compliance_m_n(&self) -> Result<f64, InvalidInput> {
        let (sin, cos) = self.to_rod()?.inclination_rad.sin_cos();
        let area_m2 = 0.25 * PI * self.diameter_m.powi(2);
        let bending = self.length_m.powi(2) / (105.0 * (self.diameter_m / 4.0).powi(2));
        Ok((bending * cos * cos + sin * sin / 3.0) * self.length_m / (self.youngs_modulus_pa * area_m2))
    }
}
