//! Chapter 8: tilted rods dropped on an immovable surface.

mod drops;
mod law;
mod measured;
mod measurements;
mod two_rods;
mod upright;

use super::study::Study;
use super::{BadInput, Failure};
use serde::Deserialize;
use std::path::Path;
use vibroimpact_sim::dropped_rod::DroppedRod;

const INTRODUCTION: &str = "Steel rods with hemispherical ends fall on an immovable surface and meet it with one end, at \
inclinations from lying (0°) to upright (90°). **The points of the experiment (Stoianovici and Hurmuzlu 1996) are not \
printed in the thesis, so nothing here is compared with them.** In their place stand our own drops, resolved in time: \
rigid translation and rotation, bending and axial modes, Hertz contact of the end, no friction, no gravity during the \
contact, and no contact of the other end, which matters for rods that fall almost flat. The algebraic law is fitted to \
these drops. `cargo xtask reproduce-chapter 8 --data points.csv` (columns length_m, angle_deg, restitution) fits and \
plots points that a person has read off the published figure.";

/// The parameter file, which explains its entries.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    #[serde(rename = "about")]
    _about: String,
    lengths_m: Vec<f64>,
    bending_modes_of_the_law: Vec<usize>,
    youngs_modulus_pa: f64,
    density_kg_m3: f64,
    our_choice: Choice,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Choice {
    #[serde(rename = "about")]
    _about: String,
    diameter_m: f64,
    poissons_ratio: f64,
    speed_m_s: f64,
    damping_ratio: f64,
    bending_modes: usize,
    axial_modes: usize,
    angles: usize,
    stubby_length_m: f64,
}

impl Parameters {
    fn load() -> Result<Parameters, Failure> {
        Ok(serde_json::from_str(include_str!("../../../../datasets/chapter8.json"))?)
    }

    fn rod(&self, length_m: f64, angle_deg: f64) -> DroppedRod {
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

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(study: &mut Study, data: Option<&Path>) -> Result<&'static str, Failure> {
    let parameters = Parameters::load()?;
    // the user's file is checked before anything is computed
    let points = data.map(measured::read).transpose().map_err(|fault| BadInput(fault.to_string()))?;
    let drops = drops::run(study, &parameters)?;
    upright::run(study, &parameters)?;
    two_rods::run(study, &parameters)?;
    law::run(study, &parameters, &drops)?;
    measurements::run(study, &parameters, &drops)?;
    if let Some(points) = points {
        measured::run(study, &parameters, &points)?;
    }
    Ok(INTRODUCTION)
}
