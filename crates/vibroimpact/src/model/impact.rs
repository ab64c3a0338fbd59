//! The modal problem of a scene, with a stated or chosen number of modes.

use vibroimpact_sim::modal::{self, Settings};

use super::Kept;
use super::choose::settled_impact;
use crate::impact::Impact;
use crate::scene::{InvalidInput, Scene, Structure, chooses_modes};

impl Scene {
    /// The structure as input of the solver: its modes at the point of impact and, if the scene requests them, a few remainder
    /// modes for all others. See [`Scene::impact`] for `"modes": "auto"`.
    ///
    /// # Errors
    /// A value out of range, or too few or too many fields.
    pub fn structure(&self) -> Result<modal::Structure, InvalidInput> {
        if let Structure::DroppedRod(rod) = &self.structure {
            return Ok(self.drop(rod, Settings::default())?.structure);
        }
        if chooses_modes(self) {
            Ok(self.impact()?.structure)
        } else {
            Ok(self.structure_of(self.modes.count(), &mut Kept::default())?.0)
        }
    }

    /// The whole scene as input of the modal solver. If the program chooses the modes, their number is the one that the restitution
    /// needs to converge, which takes a few solutions. [`Scene::choose`](crate::Scene::choose) states the accuracy of the
    /// convergence, and whether another model is sufficient.
    ///
    /// # Errors
    /// As [`Scene::structure`].
    ///
    /// ```
    /// use vibroimpact::Scene;
    ///
    /// let scene = Scene::from_json(r#"{
    ///     "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.02,
    ///         "segments": [{ "length_m": 1, "youngs_modulus_pa": 2e11, "density_kg_m3": 7800,
    ///                        "width_m": 0.011323, "thickness_m": 0.011323 }] },
    ///     "striker": { "density_kg_m3": 7800, "radius_m": 0.015, "speed_m_s": 1 },
    ///     "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 },
    ///     "location_m": 0.4, "modes": 40
    /// }"#)?;
    /// let solution = scene.impact()?.solve()?;
    /// assert!(solution.sub_impacts.len() > 1);
    /// assert!(solution.restitution.is_some_and(|e| e > 0.0 && e < 1.0));
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn impact(&self) -> Result<Impact, InvalidInput> {
        if chooses_modes(self) {
            settled_impact(self)
        } else {
            self.impact_of(self.modes.count(), &mut Kept::default())
        }
    }
}
