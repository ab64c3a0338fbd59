//! Converts a scene into the input of the solver.

use contact_models::{Hertz, Law};
use invalid_input::Path;
use vibroimpact_sim::modal::{History, Mode, Posing, Recording, Settings, Solution, Solver, Start, Striker, Structure};

use crate::in_scene::in_scene;
use crate::model::Kept;
use crate::same_modes::{Match, Seen, matched};
use crate::scene::json::number;
use crate::scene::ranges::NOT_NEGATIVE;
use crate::scene::{
    self, Contact, DroppedRod, HertzStiffness, InvalidInput, Modes, Scene, chooses_modes, compliance, of_computed_mode,
    require_elastic,
};

/// The input of [`vibroimpact_sim::modal`] for one impact.
#[derive(Debug, Clone, PartialEq)]
pub struct Impact {
    /// The modes of the structure at the point of impact, remainder modes last.
    pub structure: Structure,
    /// Number of remainder modes, at the end of the list: they represent all truncated modes
    /// ([`beam_modes::remainder_modes`]).
    pub remainder_modes: usize,
    /// Mass and speed.
    pub striker: Striker,
    /// The law of the contact, with its parameters.
    pub law: Law,
    /// Motion of the structure at the start, and the distance of the striker; at rest and touching for `None`.
    pub start: Option<Start>,
    /// Acceleration of gravity (m/s^2), if the striker falls; otherwise 0.
    pub gravity_m_s2: f64,
    /// Accuracy and limits.
    pub settings: Settings,
}

impl Impact {
    /// Number of modes retained, without remainder modes.
    pub fn kept_modes(&self) -> usize {
        self.structure.modes.len() - self.remainder_modes.min(self.structure.modes.len())
    }

    /// Static compliance of the truncated modes (m/N), which the remainder modes have; 0 without them.
    pub fn residual_compliance_m_n(&self) -> f64 {
        compliance(&self.structure.modes[self.kept_modes()..])
    }

    /// Speed with which the rigid-body motions of structure and striker approach each other, or with which a falling striker would
    /// arrive at the undeflected structure (m/s).
    pub(crate) fn approach_m_s(&self) -> f64 {
        let Impact { structure, striker, start, gravity_m_s2, .. } = self;
        start.as_ref().map_or(striker.speed_m_s, |start| structure.approach_m_s(striker, start, *gravity_m_s2))
    }

    /// A solver for it.
    pub(crate) fn solver(&self) -> Result<Solver, InvalidInput> {
        Solver::new(&self.structure).and_then(|solver| solver.under_gravity(self.gravity_m_s2)).map_err(in_scene)
    }

    /// The same with cached tables.
    pub(crate) fn solver_with<'k>(&self, kept: &'k mut Kept) -> Result<&'k Solver, InvalidInput> {
        kept.solver(&self.structure, self.gravity_m_s2)
    }

    /// Solves the impact.
    ///
    /// # Errors
    /// A value out of range, by its name in a scene.
    pub fn solve(&self) -> Result<Solution, InvalidInput> {
        self.solver()?.solve(&self.striker, &self.law, self.start.as_ref(), &self.settings).map_err(in_scene)
    }

    /// Solves the impact and records its whole motion.
    ///
    /// # Errors
    /// As [`Impact::solve`].
    pub fn record(&self) -> Result<(Solution, History<Law>), InvalidInput> {
        self.solver()?.record(&self.striker, &self.law, self.start.as_ref(), &self.settings).map_err(in_scene)
    }

    /// As [`Impact::solve`], with cached tables.
    pub(crate) fn solve_with(&self, kept: &mut Kept) -> Result<Solution, InvalidInput> {
        let Impact { striker, law, start, settings, .. } = self;
        let settings = Settings { concurrent: kept.is_alone(), ..*settings };
        self.solver_with(kept)?.solve(striker, law, start.as_ref(), &settings).map_err(in_scene)
    }

    /// The same, with the motion if the cache is of one scene alone.
    pub(crate) fn keep_with(&self, kept: &mut Kept) -> Result<(Solution, Option<Recording>), InvalidInput> {
        if !kept.is_alone() {
            return Ok((self.solve_with(kept)?, None));
        }
        let recording = self.recording(&self.settings, kept)?;
        Ok((recording.solution().clone(), Some(recording)))
    }

    fn recording(&self, settings: &Settings, kept: &mut Kept) -> Result<Recording, InvalidInput> {
        let settings = Settings { concurrent: kept.is_alone(), ..*settings };
        let solver = self.solver_with(kept)?;
        solver.solve_and_keep(&self.striker, &self.law, self.start.as_ref(), &settings).map_err(in_scene)
    }

    /// As [`Impact::record`], of an impact whose uncertainty is known: with its motion if it is kept, otherwise with cached tables
    /// and without the comparison runs.
    pub(crate) fn record_with(&self, kept: &mut Kept) -> Result<(Solution, History<Law>), InvalidInput> {
        let recording = match kept.motion_on(&self.structure) {
            Some(recording) => recording,
            None => self.recording(&Settings { estimate_uncertainty: false, ..self.settings }, kept)?,
        };
        let counts = recording.counts();
        let (solution, history) = recording.history(self.law);
        Ok((Solution { counts, restitution_uncertainty: None, ..solution }, history))
    }
}

impl Impact {
    /// The impact as a neighbour of another one; `at_rest` is used if the structure does not move.
    pub(crate) fn posing<'a>(&'a self, at_rest: &'a Start) -> Posing<'a> {
        let Impact { structure, striker, law, start, gravity_m_s2, .. } = self;
        Posing { structure, striker, law, start: start.as_ref().unwrap_or(at_rest), gravity_m_s2: *gravity_m_s2 }
    }

    /// The same impact on another structure, which is at rest.
    pub(crate) fn on(&self, structure: Structure) -> Impact {
        let at_rest = Start::at_rest(structure.modes.len());
        let start = self.start.as_ref().map(|start| Start { gap_m: start.gap_m, ..at_rest });
        Impact { structure, start, ..self.clone() }
    }

    /// The modes as they are compared.
    pub(crate) fn seen(&self) -> Vec<Seen> {
        let of = |mode: &Mode| Seen { omega_rad_s: mode.omega_rad_s, shapes: vec![mode.shape] };
        self.structure.modes.iter().map(of).collect()
    }

    /// Gives the modes the signs and the order of those of a neighbouring impact.
    ///
    /// # Errors
    /// The reason why they are not the same modes.
    pub(crate) fn take_modes_of(&mut self, base: &Impact) -> Result<(), &'static str> {
        let steps = matched(&base.seen(), self.seen())?;
        self.structure.modes.truncate(steps.len());
        self.remainder_modes = base.remainder_modes;
        if let Some(start) = &mut self.start {
            start.amplitude.truncate(steps.len());
            start.rate.truncate(steps.len());
        }
        for (k, Match { from, sign }) in steps.into_iter().enumerate() {
            let modes = &mut self.structure.modes;
            modes.swap(k, from);
            modes[k].shape *= sign;
            if let Some(start) = &mut self.start {
                for values in [&mut start.amplitude, &mut start.rate] {
                    values.swap(k, from);
                    values[k] *= sign;
                }
            }
        }
        Ok(())
    }
}

impl Scene {
    /// The structure with its first `count` modes, or all that are listed, and the number of its remainder modes.
    pub(crate) fn structure_of(
        &self,
        count: Option<usize>,
        kept: &mut Kept,
    ) -> Result<(Structure, usize), InvalidInput> {
        self.structure_from((count, self.enough(count)), kept)
    }

    /// Number of computed modes from which remainder modes follow.
    fn enough(&self, count: Option<usize>) -> Option<usize> {
        count.map(|count| self.structure.enough_for_remainder(self.place(), count))
    }

    fn structure_from(
        &self,
        (count, enough): (Option<usize>, Option<usize>),
        kept: &mut Kept,
    ) -> Result<(Structure, usize), InvalidInput> {
        let place = self.place();
        let modes = if self.residual_compliance.unwrap_or(chooses_modes(self)) {
            let mut known = self.structure.modes_with(place, enough, &mut kept.modes)?;
            let count = count.unwrap_or(known.len()).min(known.len());
            let whole_m_n = self.structure.static_compliance_m_n(place)?;
            if matches!((&self.structure, self.modes), (scene::Structure::Modal(_), Modes::Count(_))) {
                require_elastic(&known[..count], whole_m_n)?;
            }
            let remainder = self.structure.remainder(&known, count, whole_m_n)?;
            known.truncate(count);
            [known, remainder]
        } else {
            [self.structure.modes_with(place, count, &mut kept.modes)?, Vec::new()]
        };
        let remainder = modes[1].len();
        Ok((self.solvable(Structure { modes: modes.concat() })?, remainder))
    }

    /// These modes of the structure, if they lie in the range of the solver. Listed modes have been checked under their own names.
    pub(crate) fn solvable(&self, structure: Structure) -> Result<Structure, InvalidInput> {
        let checked = structure.check().map_err(|fault| of_computed_mode(fault.within("structure"), self));
        checked.map(|()| structure)
    }

    /// The first `count` modes of the structure with their shapes at the point of impact, whatever the scene's number of modes.
    ///
    /// # Errors
    /// As [`Scene::structure`].
    pub fn mode_shapes(&self, count: usize) -> Result<Vec<Mode>, InvalidInput> {
        self.structure.modes(self.place(), Some(count))
    }

    /// Number of modes among the first `count`, from the lowest, whose frequencies would change by less than
    /// [`CONVERGED_FREQUENCY`](scene::CONVERGED_FREQUENCY) with more polynomials; `None` if modes have a closed form or are stated.
    ///
    /// # Errors
    /// As [`Scene::structure`].
    pub fn converged_modes(&self, count: usize) -> Result<Option<usize>, InvalidInput> {
        match &self.structure {
            scene::Structure::Plate(plate) => plate.converged_modes(count),
            _ => Ok(None),
        }
    }

    /// The impact with the first `count` modes, or all that are listed.
    pub(crate) fn impact_of(&self, count: Option<usize>, kept: &mut Kept) -> Result<Impact, InvalidInput> {
        self.impact_from((count, self.enough(count)), kept)
    }

    /// The impact of a scene with stated modes that is near to another one, whose modes are cached. Its numbers change continuously
    /// from that one to this one, because the remainder modes of both follow from the same number of modes.
    pub(crate) fn impact_beside(&self, other: &Scene, kept: &mut Kept) -> Result<Impact, InvalidInput> {
        let counts = (self.modes.count(), other.enough(other.modes.count()));
        let kept = if self.structure == other.structure { kept } else { &mut Kept::default() };
        let impact = self.impact_from(counts, kept)?;
        impact.posing(&Start::at_rest(impact.structure.modes.len())).check().map_err(in_scene)?;
        Ok(impact)
    }

    fn impact_from(&self, counts: (Option<usize>, Option<usize>), kept: &mut Kept) -> Result<Impact, InvalidInput> {
        let settings = Settings::default();
        let settings = Settings { tolerance: self.tolerance.unwrap_or(settings.tolerance), ..settings };
        if let scene::Structure::DroppedRod(rod) = &self.structure {
            return self.drop(rod, settings);
        }
        let (structure, remainder_modes) = self.structure_from(counts, kept)?;
        let start = self.start(&structure.modes, remainder_modes)?;
        let (striker, law) = self.striker_and_law(|striker| {
            let Some(start) = &start else { return striker.speed_m_s };
            let rates = start.rate.iter().zip(&structure.modes);
            let surface_m_s: f64 = rates.map(|(rate, mode)| rate * mode.shape).sum();
            let falls = self.falls();
            surface_m_s
                + if falls { structure.approach_m_s(striker, start, self.gravity_m_s2) } else { striker.speed_m_s }
        })?;
        let gravity_m_s2 = self.gravity_m_s2;
        Ok(Impact { structure, remainder_modes, striker, law, start, gravity_m_s2, settings })
    }

    /// The striker and the law of contact as input of the solvers, for the speed with which it meets the surface that is struck.
    pub(crate) fn striker_and_law(
        &self,
        meets_m_s: impl FnOnce(&Striker) -> f64,
    ) -> Result<(Striker, Law), InvalidInput> {
        if !(self.gravity_m_s2 >= 0.0 && self.gravity_m_s2.is_finite()) {
            return Err(InvalidInput::new("gravity_m_s2", number(self.gravity_m_s2), NOT_NEGATIVE));
        }
        let mass_kg = self.striker.mass_kg().map_err(|fault| fault.within("striker"))?;
        let striker = Striker { mass_kg, speed_m_s: self.striker.speed_m_s };
        Ok((striker, self.law(&self.striker, meets_m_s(&striker), None)?))
    }

    /// The law of contact for this striker and speed of approach; Hertz's law with these parameters where the scene says nothing of
    /// its stiffness.
    fn law(&self, striker: &scene::Striker, speed_m_s: f64, hertz: Option<Hertz>) -> Result<Law, InvalidInput> {
        // trust compares the stresses of the contact with it
        self.require_yield_strength()?;
        match (&self.contact, hertz) {
            (Contact::Hertz(stiffness), Some(hertz)) if *stiffness == HertzStiffness::default() => Ok(hertz.into()),
            (contact, _) => contact.law(striker, speed_m_s),
        }
    }

    /// The speed with which this striker meets the structure at rest: that at the start, or at the end of the fall.
    pub(crate) fn meets_m_s(&self, striker: &Striker) -> f64 {
        self.fall_from(0)
            .map_or(striker.speed_m_s, |start| Structure::default().approach_m_s(striker, &start, self.gravity_m_s2))
    }

    /// The height from which the striker falls on this many modes at rest, if one is stated.
    pub(crate) fn fall_from(&self, modes: usize) -> Option<Start> {
        let start = self.start.as_ref().filter(|_| self.falls())?;
        Some(Start { gap_m: start.gap_m, ..Start::at_rest(modes) })
    }

    /// The fall of a rod as input of the solver.
    pub(crate) fn drop(&self, rod: &DroppedRod, settings: Settings) -> Result<Impact, InvalidInput> {
        let left_out = |field: Path, value: Option<String>| match value {
            Some(value) => Err(InvalidInput::new(field, value, "left out, because a dropped rod does not have it")),
            None => Ok(()),
        };
        let scene::Striker { mass_kg, density_kg_m3, radius_m, immovable, speed_m_s } = self.striker;
        left_out(["striker", "mass_kg"].into(), mass_kg.map(number))?;
        left_out(["striker", "density_kg_m3"].into(), density_kg_m3.map(number))?;
        left_out(["striker", "radius_m"].into(), radius_m.map(number))?;
        left_out(["striker", "immovable"].into(), immovable.then(|| "true".to_owned()))?;
        left_out("location_m".into(), self.location_m.map(|place| place.to_string()))?;
        left_out("location".into(), self.location.as_ref().map(|name| format!("{name:?}")))?;
        left_out("modes".into(), self.modes.count().map(|modes| modes.to_string()))?;
        left_out("residual_compliance".into(), self.residual_compliance.map(|on| on.to_string()))?;
        left_out("start".into(), self.start.as_ref().map(|_| "{...}".to_owned()))?;
        left_out("gravity_m_s2".into(), self.falls().then(|| number(self.gravity_m_s2)))?;
        let described = rod.to_rod().map_err(|fault| fault.within("structure"))?;
        let drop = rod.drop(speed_m_s).map_err(|fault| match fault.field.first() {
            Some("speed_m_s") => fault.within("striker"),
            _ => fault.within("structure"),
        })?;
        let end = scene::Striker {
            mass_kg: Some(described.rigid_body_mass_kg()),
            radius_m: Some(0.5 * rod.diameter_m),
            speed_m_s,
            ..scene::Striker::default()
        };
        let law = self.law(&end, speed_m_s, Some(drop.law))?;
        let vibroimpact_sim::dropped_rod::Drop { structure, remainder_modes, start, surface, .. } = drop;
        let structure = self.solvable(structure)?;
        let start = Some(start);
        Ok(Impact { structure, remainder_modes, striker: surface, law, start, gravity_m_s2: 0.0, settings })
    }
}
