//! Stiffness of a contact, stated directly or by materials.

use contact_models::{Body, Hertz, effective_modulus_pa};
use invalid_input::InvalidInput;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Striker;
use super::error::require_positive;
use super::extreme::follows_from;
use super::ranges::POSITIVE;
use super::sets::one_of_sets;

/// Materials of striker and structure at the contact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Materials {
    /// Young's modulus of both bodies; of the structure alone where the striker's own is given (Pa).
    pub youngs_modulus_pa: Option<f64>,
    /// Poisson's ratio of both bodies; of the structure alone where the striker's own is given.
    pub poissons_ratio: Option<f64>,
    /// Young's modulus of a striker of another material (Pa).
    pub striker_youngs_modulus_pa: Option<f64>,
    /// Poisson's ratio of a striker of another material.
    pub striker_poissons_ratio: Option<f64>,
}

/// Stiffness of a Hertzian contact: given, or from the materials and the striker's radius.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HertzStiffness {
    /// The stiffness itself (N/m^1.5).
    pub stiffness_n_m1_5: Option<f64>,
    /// The materials from which it follows.
    #[serde(flatten)]
    pub materials: Materials,
}

const BOTH: &[&str] = &["youngs_modulus_pa", "poissons_ratio"];
const EACH: &[&str] = &["youngs_modulus_pa", "poissons_ratio", "striker_youngs_modulus_pa", "striker_poissons_ratio"];

pub(crate) fn in_contact(fault: InvalidInput) -> InvalidInput {
    fault.within("contact")
}

impl Materials {
    fn fields(&self) -> [(&'static str, Option<f64>); 4] {
        [
            (EACH[0], self.youngs_modulus_pa),
            (EACH[1], self.poissons_ratio),
            (EACH[2], self.striker_youngs_modulus_pa),
            (EACH[3], self.striker_poissons_ratio),
        ]
    }

    /// Young's modulus and Poisson's ratio of the striker, where they are given.
    pub(crate) fn of_striker(&self) -> Option<[f64; 2]> {
        let modulus = self.striker_youngs_modulus_pa.or(self.youngs_modulus_pa)?;
        Some([modulus, self.striker_poissons_ratio.or(self.poissons_ratio)?])
    }

    /// Striker and structure; the structure's surface is flat.
    pub(crate) fn bodies(&self, striker: &Striker) -> Result<(Body, Body), InvalidInput> {
        one_of_sets(&self.fields(), &[BOTH, EACH]).map_err(in_contact)?;
        let radius_m = striker.radius_m.ok_or_else(|| {
            InvalidInput::missing(
                ["striker", "radius_m"],
                format!("{POSITIVE}, because a contact given by materials needs it"),
            )
        })?;
        require_positive(["striker", "radius_m"], radius_m)?;
        // a complete set was given, so both are present
        let [modulus, ratio] = [self.youngs_modulus_pa, self.poissons_ratio].map(|value| value.unwrap_or(f64::NAN));
        let structure = Body::flat(modulus, ratio);
        let ball = Body {
            youngs_modulus_pa: self.striker_youngs_modulus_pa.unwrap_or(modulus),
            poissons_ratio: self.striker_poissons_ratio.unwrap_or(ratio),
            radius_m,
        };
        // each material is checked with a rigid partner, so that an error names the right field
        let partner = Body::rigid(1.0);
        effective_modulus_pa(&structure, &partner).map_err(in_contact)?;
        effective_modulus_pa(&ball, &partner).map_err(|fault| {
            let of_striker = format!("striker_{}", fault.field);
            in_contact(fault.under(of_striker))
        })?;
        Ok((ball, structure))
    }

    /// The error of a quantity that follows from materials and radius, as that of the most extreme of their fields.
    pub(super) fn follows(&self, quantity: &str, fault: &InvalidInput, striker: &Striker) -> InvalidInput {
        let moduli = [EACH[0], EACH[2]].into_iter().zip([self.youngs_modulus_pa, self.striker_youngs_modulus_pa]);
        let given = moduli.chain([("radius_m", striker.radius_m)]);
        let fields: Vec<(&str, f64)> = given.filter_map(|(field, value)| Some((field, value?))).collect();
        let fault = follows_from(quantity, fault, &fields).unwrap_or_else(|| fault.clone());
        if fault.field == "radius_m" { fault.within("striker") } else { in_contact(fault) }
    }
}

impl HertzStiffness {
    /// The stiffness itself (N/m^1.5).
    pub fn given(stiffness_n_m1_5: f64) -> HertzStiffness {
        HertzStiffness { stiffness_n_m1_5: Some(stiffness_n_m1_5), ..HertzStiffness::default() }
    }

    /// Both bodies of one material (Pa, 1).
    pub fn of_material(youngs_modulus_pa: f64, poissons_ratio: f64) -> HertzStiffness {
        let materials = Materials {
            youngs_modulus_pa: Some(youngs_modulus_pa),
            poissons_ratio: Some(poissons_ratio),
            ..Materials::default()
        };
        HertzStiffness { materials, ..HertzStiffness::default() }
    }

    /// Whether the stiffness itself is given, not the materials.
    pub(crate) fn is_given(&self) -> bool {
        self.stiffness_n_m1_5.is_some()
    }

    /// The stiffness (N/m^1.5) of this striker against a flat structure.
    pub(crate) fn of(&self, striker: &Striker) -> Result<f64, InvalidInput> {
        self.one_of(&[], &[&["stiffness_n_m1_5"], BOTH, EACH])?;
        if let Some(stiffness) = self.stiffness_n_m1_5 {
            return Ok(stiffness);
        }
        let (ball, structure) = self.materials.bodies(striker)?;
        Hertz::from_bodies(&ball, &structure)
            .map(|hertz| hertz.stiffness_n_m1_5)
            .map_err(|fault| self.materials.follows("stiffness of the contact", &fault, striker))
    }

    /// The stiffness and exponent of a general power law, which cannot be combined with the fields of Hertz's law.
    pub(crate) fn or_general(
        &self,
        (stiffness, exponent): (Option<f64>, Option<f64>),
    ) -> Result<(f64, f64), InvalidInput> {
        let general = [("stiffness_n_m_n", stiffness), ("exponent", exponent)];
        self.one_of(&general, &[&["stiffness_n_m_n", "exponent"], &["stiffness_n_m1_5"], BOTH, EACH])?;
        Ok((stiffness.unwrap_or(f64::NAN), exponent.unwrap_or(f64::NAN)))
    }

    fn one_of(&self, others: &[(&str, Option<f64>)], sets: &[&[&str]]) -> Result<usize, InvalidInput> {
        let own = std::iter::once(("stiffness_n_m1_5", self.stiffness_n_m1_5)).chain(self.materials.fields());
        let given: Vec<(&str, Option<f64>)> = own.chain(others.iter().copied()).collect();
        one_of_sets(&given, sets).map_err(in_contact)
    }
}
