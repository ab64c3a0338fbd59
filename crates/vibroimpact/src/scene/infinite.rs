//! Infinite structures of a scene, and their impact in the terms of [`vibroimpact_sim::infinite`].

use invalid_input::{InvalidInput, Path};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vibroimpact_sim::infinite;

use super::error::require_positive;
use super::json::number;
use super::{Contact, Scene, Segment, Structure};

/// An infinite Euler-Bernoulli beam: its section in one of three ways, as that of a [`Segment`]. What Timoshenko's theory
/// needs may stand beside it: the answer then tells how the first contact would end by that theory.
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

impl Scene {
    /// Whether the structure is infinite: [`Scene::infinite_impact`] is then the way to solve the scene, and
    /// [`Scene::impact`] is not.
    pub fn is_infinite(&self) -> bool {
        matches!(self.structure, Structure::InfiniteBeam(_) | Structure::InfinitePlate(_))
    }

    /// The impact on an infinite structure in the terms of the solver.
    ///
    /// # Errors
    /// A structure that is not infinite, a law other than Hertz's, fields that belong to modes, or a value out of
    /// range.
    ///
    /// ```
    /// use vibroimpact::Scene;
    ///
    /// // third row of thesis Table 2.1
    /// let scene = Scene::from_json(r#"{
    ///     "structure": { "kind": "infinite-beam", "youngs_modulus_pa": 2e11, "density_kg_m3": 7800,
    ///                    "width_m": 0.028, "thickness_m": 0.028 },
    ///     "striker": { "density_kg_m3": 7800, "radius_m": 0.033, "speed_m_s": 0.5 },
    ///     "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 }
    /// }"#)?;
    /// assert!((scene.infinite_impact()?.groups().unwrap().s - 15.556).abs() < 0.03);
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn infinite_impact(&self) -> Result<infinite::Impact, InvalidInput> {
        let left_out = |field: Path, value: Option<String>| match value {
            Some(value) => Err(InvalidInput::new(field, value, "left out: an infinite structure does not have it")),
            None => Ok(()),
        };
        self.require_yield_strength()?;
        left_out("location_m".into(), self.location_m.map(|place| place.to_string()))?;
        left_out("location".into(), self.location.as_ref().map(|name| format!("{name:?}")))?;
        left_out("start".into(), self.start.as_ref().map(|_| "{...}".to_owned()))?;
        left_out(["striker", "immovable"].into(), self.striker.immovable.then(|| "true".to_owned()))?;
        left_out("modes".into(), self.modes.count().map(|modes| modes.to_string()))?;
        left_out("residual_compliance".into(), self.residual_compliance.filter(|on| *on).map(|on| on.to_string()))?;
        left_out("tolerance".into(), self.tolerance.map(number))?;
        let Contact::Hertz(stiffness) = &self.contact else {
            let law = format!("\"{}\"", self.contact.law_name());
            return Err(InvalidInput::new(["contact", "law"], law, "hertz, the law of impacts on infinite structures"));
        };
        let mass_kg = self.striker.mass_kg().map_err(|fault| fault.within("striker"))?;
        let stiffness_n_m1_5 = stiffness.of(&self.striker)?;
        let speed_m_s = self.striker.speed_m_s;
        match &self.structure {
            Structure::InfiniteBeam(beam) => {
                let section = beam.section().map_err(|fault| fault.within("structure"))?;
                // checked even though the impact itself does without
                beam.shear().map_err(|fault| fault.within("structure"))?;
                let (rigidity, mass_per_length) = (section.flexural_rigidity_n_m2, section.mass_per_length_kg_m);
                infinite::Impact::on_beam(rigidity, mass_per_length, stiffness_n_m1_5, mass_kg, speed_m_s)
            }
            Structure::InfinitePlate(plate) => {
                plate.check().map_err(|fault| fault.within("structure"))?;
                let (rigidity, mass_per_area) = (plate.flexural_rigidity_n_m(), plate.mass_per_area_kg_m2());
                infinite::Impact::on_plate(rigidity, mass_per_area, stiffness_n_m1_5, mass_kg, speed_m_s)
            }
            _ => {
                return Err(InvalidInput::new(
                    ["structure", "kind"],
                    format!("\"{}\"", self.structure.kind()),
                    "infinite-beam, infinite-plate",
                ));
            }
        }
        .map_err(|fault| match fault.field.first() {
            Some("mass_kg" | "speed_m_s") => fault.within("striker"),
            Some("stiffness_n_m1_5") => fault.within("contact"),
            _ => fault.within("structure"),
        })
    }
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
    fn check(&self) -> Result<(), InvalidInput> {
        require_positive("youngs_modulus_pa", self.youngs_modulus_pa)?;
        require_positive("density_kg_m3", self.density_kg_m3)?;
        require_positive("thickness_m", self.thickness_m)?;
        if self.poissons_ratio > -1.0 && self.poissons_ratio <= 0.5 {
            return Ok(());
        }
        let allowed = super::fields::allowed("poissons_ratio").unwrap_or_default();
        Err(InvalidInput::new("poissons_ratio", number(self.poissons_ratio), allowed))
    }

    fn flexural_rigidity_n_m(&self) -> f64 {
        self.youngs_modulus_pa * self.thickness_m.powi(3) / (12.0 * (1.0 - self.poissons_ratio.powi(2)))
    }

    fn mass_per_area_kg_m2(&self) -> f64 {
        self.density_kg_m3 * self.thickness_m
    }
}
