//! From the fields of a scene to the terms of the solver, and back again in its errors.

use contact_models::Law;
use invalid_input::Step;
use vibroimpact_sim::modal::{History, Mode, Posing, Settings, Solution, Solver, Start, Striker, Structure};

use crate::model::{self, Kept};
use crate::same_modes::{Seen, matched};
use crate::scene::{self, InvalidInput, Scene, require_elastic};

/// An impact in the terms of [`vibroimpact_sim::modal`].
#[derive(Debug, Clone, PartialEq)]
pub struct Impact {
    /// The modes of the structure at the point of impact, remainder modes last.
    pub structure: Structure,
    /// How many of them, at the end, are remainder modes: they represent all truncated modes
    /// ([`beam_modes::remainder_modes`]).
    pub remainder_modes: usize,
    /// Mass and speed.
    pub striker: Striker,
    /// The law of the contact, with its parameters.
    pub law: Law,
    /// Motion of the structure at the start, and the distance of the striker; at rest and touching for `None`.
    pub start: Option<Start>,
    /// Accuracy and limits.
    pub settings: Settings,
}

impl Impact {
    /// Number of modes retained, without remainder modes.
    pub fn kept_modes(&self) -> usize {
        self.structure.modes.len() - self.remainder_modes.min(self.structure.modes.len())
    }

    /// Static compliance of the truncated modes (m/N), with which the remainder modes answer; 0 without them.
    pub fn residual_compliance_m_n(&self) -> f64 {
        compliance(&self.structure.modes[self.kept_modes()..])
    }

    /// Solves the impact.
    ///
    /// # Errors
    /// A value out of range, by its name in a scene.
    pub fn solve(&self) -> Result<Solution, InvalidInput> {
        let mut solver = Solver::new(&self.structure).map_err(in_scene)?;
        solver.solve(&self.striker, &self.law, self.start.as_ref(), &self.settings).map_err(in_scene)
    }

    /// Solves the impact and records its whole motion.
    ///
    /// # Errors
    /// As [`Impact::solve`].
    pub fn record(&self) -> Result<(Solution, History<Law>), InvalidInput> {
        let mut solver = Solver::new(&self.structure).map_err(in_scene)?;
        solver.record(&self.striker, &self.law, self.start.as_ref(), &self.settings).map_err(in_scene)
    }
}

impl Impact {
    /// As a neighbour of another impact is posed; `at_rest` stands in where the structure does not move.
    pub(crate) fn posing<'a>(&'a self, at_rest: &'a Start) -> Posing<'a> {
        let Impact { structure, striker, law, start, .. } = self;
        Posing { structure, striker, law, start: start.as_ref().unwrap_or(at_rest) }
    }

    /// Gives the modes the signs and the order of those of an impact nearby. `false` if they are not the same modes.
    pub(crate) fn take_modes_of(&mut self, base: &Impact) -> bool {
        let seen = |impact: &Impact| -> Vec<Seen> {
            let of = |mode: &Mode| Seen { omega_rad_s: mode.omega_rad_s, shapes: vec![mode.shape] };
            impact.structure.modes.iter().map(of).collect()
        };
        let Some(steps) = matched(&seen(base), seen(self)) else { return false };
        for (k, (i, sign)) in steps.into_iter().enumerate() {
            let modes = &mut self.structure.modes;
            modes.swap(k, i);
            modes[k].shape *= sign;
            if let Some(start) = &mut self.start {
                for values in [&mut start.amplitude, &mut start.rate] {
                    values.swap(k, i);
                    values[k] *= sign;
                }
            }
        }
        true
    }
}

/// The solver's error under the names that scenes use.
pub(crate) fn in_scene(fault: InvalidInput) -> InvalidInput {
    match fault.field.steps() {
        // lists of modes have been checked by their names; these modes were computed
        [_, Step::Index(k), Step::Field(quantity)] => {
            let mode = k + 1;
            let value = fault.value.as_ref().map_or_else(String::new, ToString::to_string);
            let allowed = format!("a structure whose modes have a {quantity} of {}", fault.allowed);
            InvalidInput::new("structure", format!("{quantity} {value} in mode {mode}"), allowed)
        }
        [Step::Field(name)] if ["mass_kg", "speed_m_s"].contains(&name.as_str()) => fault.within("striker"),
        // an amplitude or rate out of range may come from any of the ways in which a scene states the start
        [Step::Field(name), ..] if ["gap_m", "amplitude", "rate"].contains(&name.as_str()) => fault.within("start"),
        _ => fault,
    }
}

impl Scene {
    /// The structure as the solver sees it: its modes at the point of impact and, as far as the scene asks for them, a few
    /// remainder modes for all others. See [`Scene::impact`] for `"modes": "auto"`.
    ///
    /// # Errors
    /// A value out of range, or fields of which too few or too many are given.
    pub fn structure(&self) -> Result<Structure, InvalidInput> {
        if let scene::Structure::DroppedRod(rod) = &self.structure {
            return Ok(self.drop(rod, Settings::default())?.structure);
        }
        if model::chooses_modes(self) {
            Ok(self.impact()?.structure)
        } else {
            Ok(self.structure_of(self.modes.count(), &mut Kept::default())?.0)
        }
    }

    /// The structure with its first `count` modes, or all that are listed, and how many remainder modes it has beside
    /// them.
    fn structure_of(&self, count: Option<usize>, kept: &mut Kept) -> Result<(Structure, usize), InvalidInput> {
        let place = self.place();
        let modes = if self.residual_compliance.unwrap_or(model::chooses_modes(self)) {
            let enough = count.map(|count| self.structure.enough_for_remainder(count));
            let mut known = self.structure.modes_with(place, enough, &mut kept.modes)?;
            let count = count.unwrap_or(known.len()).min(known.len());
            let whole_m_n = self.structure.static_compliance_m_n(place)?;
            if matches!((&self.structure, self.modes), (scene::Structure::Modal(_), model::Modes::Count(_))) {
                require_elastic(&known[..count], whole_m_n)?;
            }
            let remainder = self.structure.remainder(&known, count, whole_m_n)?;
            known.truncate(count);
            [known, remainder]
        } else {
            [self.structure.modes_with(place, count, &mut kept.modes)?, Vec::new()]
        };
        let remainder = modes[1].len();
        Ok((Structure { modes: modes.concat() }, remainder))
    }

    /// The modes of the structure as seen from the point of impact: the first `count`, however many the scene keeps.
    ///
    /// # Errors
    /// As [`Scene::structure`].
    pub fn mode_shapes(&self, count: usize) -> Result<Vec<Mode>, InvalidInput> {
        self.structure.modes(self.place(), Some(count))
    }

    /// How many of the first `count` modes, from the lowest, have frequencies that more polynomials would change by less than
    /// [`CONVERGED_FREQUENCY`](scene::CONVERGED_FREQUENCY); `None` where modes have a closed form, or are stated.
    ///
    /// # Errors
    /// As [`Scene::structure`].
    pub fn converged_modes(&self, count: usize) -> Result<Option<usize>, InvalidInput> {
        match &self.structure {
            scene::Structure::Plate(plate) => plate.converged_modes(count),
            _ => Ok(None),
        }
    }

    /// The whole scene in the terms of the modal solver. Where the program chooses the modes, with as many as the
    /// restitution needs to converge, which takes a few solves; [`Scene::choose`](crate::Scene::choose) states how well
    /// it converged, and whether another model would do.
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
        if model::chooses_modes(self) {
            model::settled_impact(self)
        } else {
            self.impact_of(self.modes.count(), &mut Kept::default())
        }
    }

    /// The impact with the first `count` modes, or all that are listed.
    pub(crate) fn impact_of(&self, count: Option<usize>, kept: &mut Kept) -> Result<Impact, InvalidInput> {
        self.require_yield_strength()?;
        let settings = Settings::default();
        let settings = Settings { tolerance: self.tolerance.unwrap_or(settings.tolerance), ..settings };
        if let scene::Structure::DroppedRod(rod) = &self.structure {
            return self.drop(rod, settings);
        }
        let (structure, remainder_modes) = self.structure_of(count, kept)?;
        let start = self.start(&structure.modes, remainder_modes)?;
        Ok(Impact {
            structure,
            remainder_modes,
            striker: Striker {
                mass_kg: self.striker.mass_kg().map_err(|fault| fault.within("striker"))?,
                speed_m_s: self.striker.speed_m_s,
            },
            law: self.contact.law(&self.striker)?,
            start,
            settings,
        })
    }
}

/// Static compliance of the elastic ones of these modes (m/N).
pub(crate) fn compliance(modes: &[Mode]) -> f64 {
    modes.iter().filter(|mode| mode.omega_rad_s > 0.0).map(|mode| (mode.shape / mode.omega_rad_s).powi(2)).sum()
}
