//! The chapter's parameters.

use serde::Deserialize;
use tasks::Failure;
use vibroimpact_sim::dropped_rod::DroppedRod;

/// The parameter file, which explains its entries.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    #[serde(rename = "about")]
    _about: String,
    pub lengths_m: Vec<f64>,
    pub bending_modes_of_the_law: Vec<usize>,
    pub youngs_modulus_pa: f64,
    pub density_kg_m3: f64,
    pub our_choice: Choice,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    #[serde(rename = "about")]
    _about: String,
    pub diameter_m: f64,
    pub poissons_ratio: f64,
    pub speed_m_s: f64,
    pub damping_ratio: f64,
    pub bending_modes: usize,
    pub axial_modes: usize,
    pub angles: usize,
    pub stubby_length_m: f64,
}

impl Parameters {
    pub fn load() -> Result<Parameters, Failure> {
        Ok(serde_json::from_str(include_str!("../../../../datasets/chapter8.json"))?)
    }

    pub fn rod(&self, length_m: f64, angle_deg: f64) -> DroppedRod {
        let choice = &self.our_choice;
        DroppedRod {
            length_m,
            diameter_m: choice.diameter_m,
            youngs_modulus_pa: self.youngs_modulus_pa,
            density_kg_m3: self.density_kg_m3,
            poissons_ratio: choice.poissons_ratio,
            inclination_rad: angle_deg.to_radians(),
            bending_modes: choice.bending_modes,
            axial_modes: choice.axial_modes,
            damping_ratio: choice.damping_ratio,
        }
    }
}
