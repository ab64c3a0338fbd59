//! Infinite structures of a scene.

use invalid_input::InvalidInput;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::require_positive;
use super::extreme::require_product;
use super::json::number;
use super::segment::Segment;

/// An infinite Euler-Bernoulli beam: its section in one of three ways, as that of a [`Segment`]. The data of Timoshenko's
/// theory may be given too; the result then states how the first contact would end by that theory.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InfiniteBeam {
    /// Flexural rigidity `EI` (N m^2).
    pub flexural_rigidity_n_m2: Option<f64>,
    /// Mass per length (kg/m).
    pub mass_per_length_kg_m: Option<f64>,
    /// Young's modulus (Pa).
    pub youngs_modulus_pa: Option<f64>,
    /// Density (kg/m^3).
    pub density_kg_m3: Option<f64>,
    /// Width of a rectangular section, across the direction of the impact (m).
    pub width_m: Option<f64>,
    /// Thickness of a rectangular section, in the direction of the impact (m).
    pub thickness_m: Option<f64>,
    /// Diameter of a circular section (m).
    pub diameter_m: Option<f64>,
    /// Poisson's ratio: it gives the shear modulus and the shear coefficient of Timoshenko's theory.
    pub poissons_ratio: Option<f64>,
    /// Shear coefficient of Timoshenko's theory; that of the section when left out, as for a [`Segment`].
    pub shear_coefficient: Option<f64>,
    /// Shear rigidity `kappa G A` (N), beside the flexural rigidity.
    pub shear_rigidity_n: Option<f64>,
    /// Rotary inertia per length `rho I` (kg m), beside the flexural rigidity.
    pub rotary_inertia_kg_m: Option<f64>,
}

/// A thin infinite plate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InfinitePlate {
    /// Young's modulus (Pa).
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
    /// Density (kg/m^3).
    pub density_kg_m3: f64,
    /// Thickness (m).
    pub thickness_m: f64,
}

impl InfiniteBeam {
    /// A piece of it.
    fn piece(&self) -> Segment {
        let InfiniteBeam {
            flexural_rigidity_n_m2,
            mass_per_length_kg_m,
            youngs_modulus_pa,
            density_kg_m3,
            width_m,
            thickness_m,
            diameter_m,
            poissons_ratio,
            shear_coefficient,
            shear_rigidity_n,
            rotary_inertia_kg_m,
        } = *self;
        Segment {
            length_m: 1.0,
            flexural_rigidity_n_m2,
            mass_per_length_kg_m,
            youngs_modulus_pa,
            density_kg_m3,
            width_m,
            thickness_m,
            diameter_m,
            poissons_ratio,
            shear_coefficient,
            shear_rigidity_n,
            rotary_inertia_kg_m,
        }
    }

    /// Rigidity and mass of any piece of it.
    pub(crate) fn section(&self) -> Result<beam_modes::Segment, InvalidInput> {
        self.piece().to_segment()
    }

    /// Shear and rotary inertia, or `None` where nothing of them is given.
    pub(crate) fn shear(&self) -> Result<Option<beam_modes::ShearSection>, InvalidInput> {
        self.piece().to_shear()
    }
}

impl InfinitePlate {
    pub(crate) fn check(&self) -> Result<(), InvalidInput> {
        require_positive("youngs_modulus_pa", self.youngs_modulus_pa)?;
        require_positive("density_kg_m3", self.density_kg_m3)?;
        require_positive("thickness_m", self.thickness_m)?;
        if !(self.poissons_ratio > -1.0 && self.poissons_ratio <= 0.5) {
            let allowed = super::fields::allowed("poissons_ratio").unwrap_or_default();
            return Err(InvalidInput::new("poissons_ratio", number(self.poissons_ratio), allowed));
        }
        let thickness = ("thickness_m", self.thickness_m);
        let rigidity = [("youngs_modulus_pa", self.youngs_modulus_pa), thickness];
        require_product("flexural rigidity", self.flexural_rigidity_n_m(), &rigidity)?;
        let mass = [("density_kg_m3", self.density_kg_m3), thickness];
        require_product("mass per area", self.mass_per_area_kg_m2(), &mass)
    }

    pub(crate) fn flexural_rigidity_n_m(&self) -> f64 {
        self.youngs_modulus_pa * self.thickness_m.powi(3) / (12.0 * (1.0 - self.poissons_ratio.powi(2)))
    }

    pub(crate) fn mass_per_area_kg_m2(&self) -> f64 {
        self.density_kg_m3 * self.thickness_m
    }
}
