//! From a scene to the terms of [`vibroimpact_sim::infinite`].

use contact_models::Law;
use invalid_input::{InvalidInput, Path};
use vibroimpact_sim::infinite::{self, PlateSection, Receptance, Scale, Solution};
use vibroimpact_sim::modal::Striker;

use crate::scene::json::number;
use crate::scene::{Contact, Scene, Structure, most_extreme_in, such_that};

/// An impact on an infinite structure in the terms of the solvers.
#[derive(Debug, Clone, PartialEq)]
pub struct Posed {
    /// The impulse response of the structure.
    pub receptance: Receptance,
    /// What strikes it.
    pub striker: Striker,
    /// The law of contact.
    pub law: Law,
    /// The same for the solver of Hertz contact, if that is the law.
    pub hertz: Option<infinite::Impact>,
}

impl Posed {
    /// Solves the impact, by its number `S` if it is Hertz contact; the scale holds the units of the solution. On a structure so
    /// rigid that `S` lies below its range, Hertz contact is solved as any other law is.
    ///
    /// # Errors
    /// Numbers that are out of the range of the solver.
    pub fn solve(&self, settings: &infinite::Settings) -> Result<(Scale, Solution), InvalidInput> {
        let hertz = self.hertz.map(|impact| Ok((impact.structure, impact.groups()?))).transpose()?;
        if let Some((structure, groups)) = hertz.filter(|(_, groups)| groups.s >= *infinite::S_RANGE.start()) {
            return Ok((groups.into(), infinite::solve(structure, groups.s, settings)?));
        }
        let scale = self.receptance.scale(&self.striker)?;
        Ok((scale, infinite::solve_law(&self.receptance, &self.striker, &self.law, settings)?))
    }
}

impl Scene {
    /// The impact on an infinite structure by Hertz contact, which a single number describes, in the terms of its solver.
    ///
    /// # Errors
    /// As [`Scene::posed_on_infinite`], and a law other than Hertz's.
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
        self.posed_on_infinite()?.hertz.ok_or_else(|| {
            let law = format!("\"{}\"", self.contact.law_name());
            InvalidInput::new(
                ["contact", "law"],
                law,
                "hertz, because only with this law the impact depends on a single number",
            )
        })
    }

    /// The impact on an infinite structure in the terms of the solvers, by any law of contact.
    ///
    /// # Errors
    /// A structure that is not infinite, fields that belong to modes, or a value out of range.
    ///
    /// ```
    /// use vibroimpact::{Scene, vibroimpact_sim::infinite::{Outcome, Settings}};
    ///
    /// let scene = Scene::from_json(r#"{
    ///     "structure": { "kind": "infinite-plate", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3,
    ///                    "density_kg_m3": 7800, "thickness_m": 0.003 },
    ///     "striker": { "density_kg_m3": 7800, "radius_m": 0.005, "speed_m_s": 1 },
    ///     "contact": { "law": "kelvin-voigt", "stiffness_n_m": 1e6, "damping_n_s_m": 10 }
    /// }"#)?;
    /// let (scale, solution) = scene.posed_on_infinite()?.solve(&Settings::default())?;
    /// assert_eq!((solution.outcome, solution.s), (Outcome::Rebound, None));
    /// assert!(scale.time_s * solution.sub_impacts[0].duration.unwrap() < 1e-3);
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn posed_on_infinite(&self) -> Result<Posed, InvalidInput> {
        let left_out = |field: Path, value: Option<String>| match value {
            Some(value) => {
                Err(InvalidInput::new(field, value, "left out, because an infinite structure does not have it"))
            }
            None => Ok(()),
        };
        left_out("location_m".into(), self.location_m.map(|place| place.to_string()))?;
        left_out("location".into(), self.location.as_ref().map(|name| format!("{name:?}")))?;
        left_out("start".into(), self.start.as_ref().map(|_| "{...}".to_owned()))?;
        left_out(["striker", "immovable"].into(), self.striker.immovable.then(|| "true".to_owned()))?;
        left_out("modes".into(), self.modes.count().map(|modes| modes.to_string()))?;
        left_out("residual_compliance".into(), self.residual_compliance.filter(|on| *on).map(|on| on.to_string()))?;
        left_out("gravity_m_s2".into(), self.falls().then(|| number(self.gravity_m_s2)))?;
        left_out("tolerance".into(), self.tolerance.map(number))?;
        let (striker, law) = self.striker_and_law(|striker| striker.speed_m_s)?;
        // of Hertz contact the stiffness is a part of the impact; otherwise it does not enter
        let stiffness_n_m1_5 = if let Law::Hertz(law) = &law { law.stiffness_n_m1_5 } else { 1.0 };
        let impact = match &self.structure {
            Structure::InfiniteBeam(beam) => {
                let section = beam.section().map_err(|fault| fault.within("structure"))?;
                // checked even though the impact itself does without
                beam.shear().map_err(|fault| fault.within("structure"))?;
                infinite::Impact::on_beam(section.into(), striker, stiffness_n_m1_5)
            }
            Structure::InfinitePlate(plate) => {
                plate.check().map_err(|fault| fault.within("structure"))?;
                let plate = PlateSection {
                    flexural_rigidity_n_m: plate.flexural_rigidity_n_m(),
                    mass_per_area_kg_m2: plate.mass_per_area_kg_m2(),
                };
                infinite::Impact::on_plate(plate, striker, stiffness_n_m1_5)
            }
            _ => {
                return Err(InvalidInput::new(
                    ["structure", "kind"],
                    format!("\"{}\"", self.structure.kind()),
                    "infinite-beam or infinite-plate",
                ));
            }
        }
        .map_err(|fault| match fault.field.first() {
            Some("mass_kg" | "speed_m_s") => fault.within("striker"),
            Some("stiffness_n_m1_5") => fault.within("contact"),
            Some("impulse_response") => self.of_extreme_field(fault),
            _ => fault.within("structure"),
        })?;
        let hertz = matches!(self.contact, Contact::Hertz(_)).then_some(impact);
        Ok(Posed { receptance: impact.receptance(), striker, law, hertz })
    }

    /// An error of a quantity that follows from striker, contact and structure, as that of the most extreme of the fields that it
    /// follows from.
    pub(crate) fn of_extreme_field(&self, fault: InvalidInput) -> InvalidInput {
        let (quantity, follows, others): (_, _, &[&str]) = match fault.field.first() {
            Some("s") => (
                "number S of the impact",
                "grows with mass and speed of the striker and with the stiffness of the contact, and falls with stiffness and mass \
                 of the structure",
                &[],
            ),
            Some("time_s") => (
                "unit of time T of the impact",
                "follows from the mass of the striker and the section of the structure",
                &["contact", "speed_m_s"],
            ),
            Some("force_n") => (
                "unit of force m v/T of the impact",
                "follows from the striker and the section of the structure",
                &["contact"],
            ),
            Some("displacement_m") => (
                "unit of length v T of the impact",
                "follows from the striker and the section of the structure",
                &["contact"],
            ),
            Some("impulse_response") => {
                ("impulse response of the structure", "falls with its stiffness and mass", &["contact", "striker"])
            }
            _ => return fault,
        };
        let counts = |path: &Path| !others.iter().any(|other| [path.first(), path.last()].contains(&Some(*other)));
        let Some((field, value)) = most_extreme_in(&self.tree(), counts) else { return fault };
        let allowed = such_that(&format!("the {quantity}"), &fault);
        InvalidInput::new(field, number(value), format!("{allowed}; it {follows}"))
    }
}
