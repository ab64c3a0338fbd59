//! From a scene to the terms of [`vibroimpact_sim::infinite`].

use invalid_input::{InvalidInput, Path};
use vibroimpact_sim::infinite;
use vibroimpact_sim::modal::Striker;

use crate::scene::json::number;
use crate::scene::{Contact, Scene, Structure};

impl Scene {
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
        let Striker { mass_kg, speed_m_s } = self.posed_striker()?;
        let stiffness_n_m1_5 = stiffness.of(&self.striker)?;
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
