//! The modes of a body and their shapes at its points.

use beam_modes::{Modes, PointsMode};
use vibroimpact_sim::assembly::BodyMode;
use vibroimpact_sim::modal::{self, Mode};

use super::body::{Body, Elastic, Elastics, Mass, STATED_MODES, stated_modes};
use super::load::{LARGEST, require_finite};
use super::rod::Rod;
use crate::scene::damping::require_damping;
use crate::scene::json::number;
use crate::scene::{InvalidInput, KnownModes, Location, Place, Structure};

/// A body whose modes have been computed, for shapes at any of its points.
pub(super) struct Seen<'a> {
    name: &'a str,
    body: &'a Body,
    known: KnownModes,
    rod: Option<Modes>,
    /// Locations of contacts and loads on a beam with residual compliance (m), and the remainder modes for these locations.
    places_m: Vec<f64>,
    remainder: Vec<PointsMode>,
    /// The modes, remainder modes last.
    pub modes: Vec<BodyMode>,
}

impl<'a> Seen<'a> {
    /// The modes of the body with this name, for contacts and loads at `places_m` if the body is a beam or rod.
    pub fn new(name: &'a str, body: &'a Body, places_m: Vec<f64>) -> Result<Seen<'a>, InvalidInput> {
        let known = KnownModes::default();
        let (remainder, modes) = (Vec::new(), Vec::new());
        let mut seen = Seen { name, body, known, rod: None, places_m, remainder, modes };
        seen.modes = match body {
            Body::Mass(mass) => {
                check_mass(mass).map_err(|fault| seen.of_body(fault))?;
                vec![BodyMode { omega_rad_s: 0.0, damping_ratio: 0.0 }]
            }
            Body::Elastic(body) => {
                let given = &body.gravity_participation_kg0_5;
                let listed =
                    matches!(body.structure, Elastics::Structure(Structure::Modal(_) | Structure::ModesFile(_)));
                if !listed && !given.is_empty() {
                    let allowed = "left out, because it is computed for this kind of body";
                    let value = format!("{} values", given.len());
                    return Err(seen.of_body(InvalidInput::new("gravity_participation_kg0_5", value, allowed)));
                }
                if let (Elastics::Rod(rod), count) = (&body.structure, body.modes) {
                    seen.rod = Some(modes_of(rod, count).map_err(|fault| seen.of_body(fault))?);
                }
                let anywhere = anywhere(body);
                let modes = seen.elastic(body, Place { location_m: anywhere.0, location: anywhere.1.as_deref() })?;
                if body.residual_compliance {
                    seen.remainder = seen.remainder_of(body)?;
                }
                let listed = modes.iter().map(|mode| (mode.omega_rad_s, mode.damping_ratio));
                // as that of the last retained mode
                let damping = modes.last().map_or(0.0, |mode| mode.damping_ratio);
                let rest = seen.remainder.iter().map(|mode| (mode.omega_rad_s, damping));
                let mode = |(omega_rad_s, damping_ratio)| BodyMode { omega_rad_s, damping_ratio };
                listed.chain(rest).map(mode).collect()
            }
        };
        Ok(seen)
    }

    /// An error of the body with its path.
    pub fn of_body(&self, fault: InvalidInput) -> InvalidInput {
        stated_modes(fault.without("structure")).within(["bodies", self.name])
    }

    /// Shapes of the modes at a location (kg^-1/2). An error of the location has the field `location_m` or `location`, any other
    /// error its whole path.
    pub fn shape(&mut self, place: Place) -> Result<Vec<f64>, InvalidInput> {
        let listed = self.modes_at(place)?.into_iter().map(|mode| mode.shape);
        let point = self.places_m.iter().position(|there| place.location_m == Some((*there).into()));
        let rest = self.remainder.iter().map(|mode| point.map_or(0.0, |point| mode.shapes[point]));
        Ok(listed.chain(rest).collect())
    }

    /// The remainder modes of a beam, computed in block form for all its contacts and loads together.
    fn remainder_of(&self, body: &Elastic) -> Result<Vec<PointsMode>, InvalidInput> {
        let Elastics::Structure(Structure::Beam(beam)) = &body.structure else {
            let allowed = "false, because only beams have remainder modes in a scene of bodies";
            return Err(self.of_body(InvalidInput::new("residual_compliance", "true", allowed)));
        };
        let kept = body.modes.unwrap_or_default();
        let on_beam = |place: &f64| *place >= 0.0;
        // a location off the beam is reported as that of its contact or load
        match self.places_m.iter().all(on_beam) && !self.places_m.is_empty() {
            true => {
                let remainder =
                    beam.to_system().map_err(|fault| self.of_body(fault))?.remainder_at(&self.places_m, kept);
                remainder.or_else(|fault| if fault.field == "x_m" { Ok(Vec::new()) } else { Err(self.of_body(fault)) })
            }
            false => Ok(Vec::new()),
        }
    }

    /// The modes with their shapes at a location, without remainder modes; errors as in [`Seen::shape`].
    pub fn modes_at(&mut self, place: Place) -> Result<Vec<Mode>, InvalidInput> {
        match self.body {
            Body::Mass(mass) => {
                place.require_none("left out, because a mass moves as a whole")?;
                Ok(vec![Mode { omega_rad_s: 0.0, damping_ratio: 0.0, shape: mass.mass_kg.sqrt().recip() }])
            }
            Body::Elastic(body) => self.elastic(body, place),
        }
    }

    fn elastic(&mut self, body: &Elastic, place: Place) -> Result<Vec<Mode>, InvalidInput> {
        match &body.structure {
            Elastics::Rod(rod) => {
                place.require_no_name("left out, because the location on a rod is stated by location_m")?;
                let needed = "a finite number from 0 to the length of the rod";
                let location_m =
                    place.location_m.ok_or_else(|| InvalidInput::missing("location_m", needed))?.along()?;
                let Some(modes) = &self.rod else { return Ok(Vec::new()) };
                let seen = modes.seen_from(location_m).map_err(|fault| fault.under("location_m"))?;
                Ok(modal::Structure::from_modes(seen, rod.damping_ratio).modes)
            }
            Elastics::Structure(structure) => {
                let needs_count =
                    matches!(structure, Structure::Beam(_) | Structure::TautString(_) | Structure::Plate(_))
                        && body.modes.is_none();
                if needs_count {
                    return Err(self.of_body(InvalidInput::missing("modes", STATED_MODES)));
                }
                structure.modes_with(place, body.modes, &mut self.known).map_err(|fault| match fault.field.first() {
                    Some("location_m" | "location") => fault,
                    _ => self.of_body(fault),
                })
            }
        }
    }

    /// Participation of the modes in a uniform acceleration along `x` (kg^1/2), which `needed_for` needs.
    pub fn participation(&mut self, needed_for: &str) -> Result<Vec<f64>, InvalidInput> {
        let body = match self.body {
            Body::Mass(mass) => return Ok(vec![mass.mass_kg.sqrt()]),
            Body::Elastic(body) => body,
        };
        let given = &body.gravity_participation_kg0_5;
        let field = "gravity_participation_kg0_5";
        let count = body.modes.unwrap_or_default();
        let computed = match &body.structure {
            Elastics::Rod(_) => self.rod.as_ref().map(Modes::participation_kg0_5),
            Elastics::Structure(structure) => {
                structure.participation_with(count, &mut self.known).transpose().map_err(|fault| self.of_body(fault))?
            }
        };
        let values = || format!("{} values", given.len());
        match computed {
            // the deflection of the truncated modes under gravity is far smaller than their response to a force at a point
            Some(mut computed) => {
                computed.resize(self.modes.len(), 0.0);
                Ok(computed)
            }
            None if given.is_empty() => {
                let allowed = format!("a list of finite numbers, one for each mode, because {needed_for} needs it");
                Err(self.of_body(InvalidInput::missing(field, allowed)))
            }
            None => {
                let listed = body.structure.ranks().unwrap_or_default();
                let mut all = vec![None; listed.len()];
                for (k, value) in given.iter().enumerate() {
                    require_finite((field, k), *value).map_err(|fault| self.of_body(fault))?;
                    if let Some(rank) = listed.get(k) {
                        all[*rank] = Some(*value);
                    }
                }
                // a scene that takes the lowest modes of its list needs no values of the others
                all.truncate(self.modes.len());
                let complete = all.into_iter().collect::<Option<Vec<f64>>>();
                complete.filter(|_| given.len() <= listed.len()).ok_or_else(|| {
                    let allowed = format!("a list with one value for each mode, which is {}", self.modes.len());
                    self.of_body(InvalidInput::new(field, values(), allowed))
                })
            }
        }
    }
}

/// Some location of the structure.
fn anywhere(body: &Elastic) -> (Option<Location>, Option<String>) {
    match &body.structure {
        Elastics::Rod(_) | Elastics::Structure(Structure::Beam(_) | Structure::TautString(_)) => {
            (Some(0.0.into()), None)
        }
        Elastics::Structure(Structure::Plate(_)) => (Some([0.0; 2].into()), None),
        Elastics::Structure(Structure::Modal(listed)) => (None, listed.points.keys().next().cloned()),
        Elastics::Structure(_) => (None, None),
    }
}

fn modes_of(rod: &Rod, count: Option<usize>) -> Result<Modes, InvalidInput> {
    let count = count.ok_or_else(|| InvalidInput::missing("modes", STATED_MODES))?;
    crate::scene::require_count(count)?;
    require_damping(rod.damping_ratio)?;
    rod.modes(count)
}

/// A rigid mass within the range of the solver.
fn check_mass(mass: &Mass) -> Result<(), InvalidInput> {
    if !(LARGEST.recip()..=LARGEST).contains(&mass.mass_kg) {
        return Err(InvalidInput::new("mass_kg", number(mass.mass_kg), "a number from 1e-30 to 1e30"));
    }
    // its mode has the amplitude x m^(1/2)
    let most = LARGEST / mass.mass_kg.sqrt().max(1.0);
    for (field, value) in [("position_m", mass.position_m), ("velocity_m_s", mass.velocity_m_s)] {
        if value.is_nan() || value.abs() > most {
            let allowed = format!("a finite number of at most {most:e} in size for this mass");
            return Err(InvalidInput::new(field, number(value), allowed));
        }
    }
    Ok(())
}
