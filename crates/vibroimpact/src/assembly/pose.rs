//! Converts a scene of bodies into the input of the solver, and the solver's errors into errors of fields of the scene.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use contact_models::Law;
use invalid_input::{Path, Step, Value, printable};
use vibroimpact_sim::assembly::{self, Assembly, Force, Settings};

use super::AssemblyScene;
use super::body::{Body, Elastic};
use super::contact::{Contact, Point, Side};
use super::fields::CONTACT_NAME;
use super::load::require_finite;
use super::seen::Seen;
use crate::scene::fields::NOT_NEGATIVE;
use crate::scene::json::number;
use crate::scene::{InvalidInput, Place, by_frequency, of_computed_mode};

/// The input of [`vibroimpact_sim::assembly`], and the names of its parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Posed {
    /// The assembly.
    pub assembly: Assembly<Law>,
    /// End and accuracy of the run.
    pub settings: Settings,
    /// Names of the bodies, in the order of the assembly.
    pub bodies: Vec<String>,
    /// Names of the contacts in the order of the assembly; a two-sided contact is two of them.
    pub contacts: Vec<String>,
    /// Thickness of the thinner body at each contact (m), where a thickness is known.
    pub(super) thickness_m: Vec<Option<f64>>,
    /// For each contact of the assembly the number of that of the scene.
    of_scene: Vec<usize>,
    /// Number of loads in the scene; those of gravity and of the ground follow.
    loads: usize,
}

impl AssemblyScene {
    /// Converts the scene into the input of the solver.
    ///
    /// # Errors
    /// A value out of range, an unknown name, or too few or too many fields.
    ///
    /// ```
    /// use vibroimpact::assembly::AssemblyScene;
    ///
    /// let scene = AssemblyScene::from_json(r#"{
    ///     "bodies": { "ball": { "kind": "mass", "mass_kg": 0.1, "velocity_m_s": -1 } },
    ///     "contacts": [{ "name": "floor", "between": [{ "body": "ball" }, "ground"], "gap_m": 0.01,
    ///                    "law": "hertz", "stiffness_n_m1_5": 1e9 }],
    ///     "gravity_m_s2": 9.81, "end_s": 1
    /// }"#)?;
    /// let posed = scene.pose()?;
    /// assert_eq!((posed.assembly.bodies.len(), posed.contacts[0].as_str()), (1, "floor"));
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn pose(&self) -> Result<Posed, InvalidInput> {
        let settings = self.settings()?;
        let mut bodies = Bodies::new(self)?;
        let (mut contacts, mut names, mut of_scene, mut thickness_m) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (i, contact) in self.contacts.iter().enumerate() {
            let posed = bodies.contact(contact).map_err(|fault| beside(fault, ("contacts", i)))?;
            for (name, posed) in posed {
                if name.is_empty() || !is_printable(&name) || names.contains(&name) {
                    return Err(InvalidInput::new(("contacts", i, "name"), format!("{name:?}"), CONTACT_NAME));
                }
                names.push(name);
                of_scene.push(i);
                thickness_m.push(self.thickness_m(contact));
                contacts.push(posed);
            }
        }
        let mut loads = Vec::new();
        for (i, load) in self.loads.iter().enumerate() {
            let within = |fault| beside(fault, ("loads", i));
            let (body, shape) = bodies.point(&load.point()).map_err(within)?;
            loads.push(assembly::Load { body, shape, force: load.to_force().map_err(within)? });
        }
        let of_scene_loads = loads.len();
        loads.extend(self.weight(&mut bodies)?);
        loads.extend(self.inertia(&mut bodies)?);

        let mut start = bodies.start()?;
        if self.static_start {
            sag(&mut start, &loads);
        }
        let posed = Posed {
            assembly: Assembly { bodies: start, contacts, loads },
            settings,
            bodies: self.bodies.keys().cloned().collect(),
            contacts: names,
            thickness_m,
            of_scene,
            loads: of_scene_loads,
        };
        posed.assembly.check().map_err(|fault| of_computed_mode(posed.in_scene(fault), self))?;
        Ok(posed)
    }

    /// Thickness of the thinner body at a contact.
    fn thickness_m(&self, contact: &Contact) -> Option<f64> {
        let sides = contact.between.iter().filter_map(|side| match side {
            Side::Ground(_) => None,
            Side::Body(point) => self.bodies.get(&point.body)?.thickness_m(point.location_m),
        });
        sides.filter(|thickness_m| *thickness_m > 0.0).reduce(f64::min)
    }

    fn settings(&self) -> Result<Settings, InvalidInput> {
        const LONGEST_S: f64 = 1e12;
        let mut settings = Settings::until(self.end_s);
        settings.tolerance = self.tolerance.unwrap_or(settings.tolerance);
        if !(self.end_s > 0.0 && self.end_s <= LONGEST_S) {
            let allowed = "a number greater than 0 and not greater than 1e12";
            return Err(InvalidInput::new("end_s", number(self.end_s), allowed));
        }
        settings.statistics_from_s = self.statistics_from_s.unwrap_or(0.0);
        if !(settings.statistics_from_s >= 0.0 && settings.statistics_from_s < self.end_s) {
            let allowed = format!("a number not less than 0 and less than end_s, {}", number(self.end_s));
            return Err(InvalidInput::new("statistics_from_s", number(settings.statistics_from_s), allowed));
        }
        settings.rest_from_s = settings.statistics_from_s;
        if !(1e-13..=0.1).contains(&settings.tolerance) {
            return Err(InvalidInput::new("tolerance", number(settings.tolerance), "a number from 1e-13 to 0.1"));
        }
        Ok(settings)
    }

    /// Gravity along `-x` on every body.
    fn weight(&self, bodies: &mut Bodies) -> Result<Vec<assembly::Load>, InvalidInput> {
        let gravity = self.gravity_m_s2;
        if !(gravity >= 0.0 && gravity.is_finite()) {
            return Err(InvalidInput::new("gravity_m_s2", number(gravity), NOT_NEGATIVE));
        }
        require_finite("gravity_m_s2", gravity)?;
        if gravity == 0.0 {
            return Ok(Vec::new());
        }
        bodies.field("gravity_m_s2", &Force::Constant { force_n: -gravity })
    }

    /// The inertial load of the ground's acceleration on every body.
    fn inertia(&self, bodies: &mut Bodies) -> Result<Vec<assembly::Load>, InvalidInput> {
        let Some(motion) = &self.ground_motion else { return Ok(Vec::new()) };
        let opposite = match motion.to_acceleration().map_err(|fault| fault.within("ground_motion"))? {
            Force::Harmonic { force_n, omega_rad_s, phase_rad } => {
                Force::Harmonic { force_n: -force_n, omega_rad_s, phase_rad }
            }
            Force::Sampled { times_s, forces_n } => {
                Force::Sampled { times_s, forces_n: forces_n.into_iter().map(|value| -value).collect() }
            }
            other => other,
        };
        bodies.field("ground_motion", &opposite)
    }
}

/// Whether a name is one line that cannot control a terminal.
fn is_printable(name: &str) -> bool {
    !name.contains(['\n', '\t']) && printable(name).to_string() == name
}

/// An error of a location or a field of an object with the object's path; an error of a body has its path already.
fn beside(fault: InvalidInput, path: impl Into<Path>) -> InvalidInput {
    if fault.field.first() == Some("bodies") { fault } else { fault.within(path) }
}

/// Elastic modes start where the constant loads hold them.
fn sag(bodies: &mut [assembly::Body], loads: &[assembly::Load]) {
    for load in loads {
        let Force::Constant { force_n } = load.force else { continue };
        let assembly::Body { modes, amplitude, .. } = &mut bodies[load.body];
        for ((mode, shape), amplitude) in modes.iter().zip(&load.shape).zip(amplitude) {
            if mode.omega_rad_s > 0.0 {
                *amplitude += shape * force_n / (mode.omega_rad_s * mode.omega_rad_s);
            }
        }
    }
}

/// The bodies by their names, with their modes.
struct Bodies<'a> {
    given: &'a BTreeMap<String, Body>,
    seen: Vec<Seen<'a>>,
}

impl<'a> Bodies<'a> {
    fn new(scene: &'a AssemblyScene) -> Result<Bodies<'a>, InvalidInput> {
        let given = &scene.bodies;
        if given.is_empty() {
            return Err(InvalidInput::new("bodies", "{}", "an object with at least one named body"));
        }
        if let Some(name) = given.keys().find(|name| ["", "ground"].contains(&name.as_str()) || !is_printable(name)) {
            let allowed = "another name, because the empty name, \"ground\" and control characters do not name bodies";
            return Err(InvalidInput::new("bodies", format!("{name:?}"), allowed));
        }
        let sides = scene.contacts.iter().flat_map(|contact| &contact.between).filter_map(|side| match side {
            Side::Ground(_) => None,
            Side::Body(point) => Some((&point.body, point.location_m?.along().ok()?)),
        });
        let loads = scene.loads.iter().filter_map(|load| Some((&load.body, load.location_m?.along().ok()?)));
        let points: Vec<(&String, f64)> = sides.chain(loads).collect();
        let places_m = |name: &String| {
            let mut places: Vec<f64> =
                points.iter().filter(|(body, _)| *body == name).map(|(_, place)| *place).collect();
            places.sort_by(f64::total_cmp);
            places.dedup();
            places
        };
        let seen = given.iter().map(|(name, body)| Seen::new(name, body, places_m(name))).collect::<Result<_, _>>()?;
        Ok(Bodies { given, seen })
    }

    /// Number of the body, and its shapes at the point.
    fn point(&mut self, point: &Point) -> Result<(usize, Vec<f64>), InvalidInput> {
        let Some(body) = self.given.keys().position(|name| *name == point.body) else {
            let names = self.given.keys().map(|name| format!("{name:?}")).collect::<Vec<_>>().join(", ");
            return Err(InvalidInput::new("body", format!("{:?}", point.body), format!("one of the bodies {names}")));
        };
        let place = Place { location_m: point.location_m, location: point.location.as_deref() };
        Ok((body, self.seen[body].shape(place)?))
    }

    /// A contact under its name; a two-sided one is two.
    fn contact(&mut self, contact: &Contact) -> Result<Vec<(String, assembly::Contact<Law>)>, InvalidInput> {
        require_finite("gap_m", contact.gap_m)?;
        let mut side = |i: usize| match &contact.between[i] {
            Side::Ground(_) => Ok(assembly::Point::Ground),
            Side::Body(point) => self
                .point(point)
                .map(|(body, shape)| assembly::Point::OfBody { body, shape })
                .map_err(|fault| beside(fault, ("between", i))),
        };
        let sides = [side(0)?, side(1)?];
        if sides[0] == sides[1] {
            return Err(match &contact.between[1] {
                Side::Ground(_) => {
                    let allowed = "a point of a body, because the other side is the ground";
                    InvalidInput::new(("between", 1), "\"ground\"", allowed)
                }
                Side::Body(point) => {
                    let allowed = "another body than that of the first point, or the same body at another location";
                    InvalidInput::new(("between", 1, "body"), format!("{:?}", point.body), allowed)
                }
            });
        }
        let (gap_m, law) = (contact.gap_m, contact.to_law()?);
        let [a, b] = sides.clone();
        // the second of a two-sided contact is the first seen from the other side
        let posed = [sides, [b, a]].map(|sides| assembly::Contact { sides, gap_m, law });
        Ok(contact.names().into_iter().zip(posed).collect())
    }

    /// A uniform acceleration on every body.
    fn field(&mut self, needed_for: &str, acceleration: &Force) -> Result<Vec<assembly::Load>, InvalidInput> {
        let load = |(body, seen): (usize, &mut Seen)| {
            Ok(assembly::Load { body, shape: seen.participation(needed_for)?, force: acceleration.clone() })
        };
        self.seen.iter_mut().enumerate().map(load).collect()
    }

    /// The modes and their motion at the start.
    fn start(&mut self) -> Result<Vec<assembly::Body>, InvalidInput> {
        let body = |(body, seen): (&Body, &mut Seen)| match body {
            Body::Mass(mass) => Ok(assembly::Body::mass(mass.mass_kg, mass.position_m, mass.velocity_m_s)),
            Body::Elastic(body) => moving(body, seen),
        };
        self.given.values().zip(&mut self.seen).map(body).collect()
    }
}

/// An elastic body in the motion that is given.
fn moving(body: &Elastic, seen: &mut Seen) -> Result<assembly::Body, InvalidInput> {
    let mut moving = assembly::Body::at_rest(seen.modes.clone());
    if let Some(start) = &body.start {
        let ranks = body.structure.ranks();
        let of_start = |fault: InvalidInput| seen.of_body(fault.within("start"));
        for (field, first, all) in [
            ("amplitude_m_kg0_5", &start.amplitude_m_kg0_5, &mut moving.amplitude),
            ("rate_m_kg0_5_s", &start.rate_m_kg0_5_s, &mut moving.rate),
        ] {
            for (k, value) in first.iter().enumerate() {
                require_finite((field, k), *value).map_err(of_start)?;
            }
            *all = by_frequency(field, first, seen.modes.len(), ranks.as_deref()).map_err(of_start)?;
        }
        for (i, mode) in start.moving_modes.iter().enumerate() {
            let place = Place { location_m: mode.location_m, location: mode.location.as_deref() };
            let shape = seen.modes_at(place).and_then(|modes| mode.shape(&modes));
            let (k, shape) = shape.map_err(|fault| {
                let own = fault.field.first() == Some("bodies");
                if own { fault } else { seen.of_body(fault.within(("moving_modes", i)).within("start")) }
            })?;
            moving.amplitude[k] += mode.displacement_m / shape;
            moving.rate[k] += mode.velocity_m_s / shape;
        }
    }
    if body.velocity_m_s != 0.0 {
        require_finite("velocity_m_s", body.velocity_m_s).map_err(|fault| seen.of_body(fault))?;
        let participation = seen.participation("velocity_m_s")?;
        if !is_free(seen, &participation) {
            let allowed = "0 or left out, because the body is not free to translate";
            let value = number(body.velocity_m_s);
            return Err(seen.of_body(InvalidInput::new("velocity_m_s", value, allowed)));
        }
        for ((rate, share), mode) in moving.rate.iter_mut().zip(participation).zip(&seen.modes) {
            if mode.omega_rad_s == 0.0 {
                *rate += share * body.velocity_m_s;
            }
        }
    }
    Ok(moving)
}

/// Whether a uniform motion is one of the rigid-body modes alone.
fn is_free(seen: &Seen, participation: &[f64]) -> bool {
    const ROUNDING: f64 = 1e-6;
    let largest = |rigid: bool| {
        let modes = seen.modes.iter().zip(participation).filter(|(mode, _)| (mode.omega_rad_s == 0.0) == rigid);
        modes.map(|(_, share)| share.abs()).fold(0.0, f64::max)
    };
    largest(true) > 0.0 && largest(false) <= ROUNDING * largest(true)
}

impl Posed {
    /// The solver's fault under the names that scenes use.
    pub(crate) fn in_scene(&self, fault: InvalidInput) -> InvalidInput {
        let [Step::Field(list), Step::Index(i), inner @ ..] = fault.field.steps() else { return fault };
        let (i, inner) = (*i, Path::from(inner));
        match list.as_str() {
            "bodies" => match self.bodies.get(i) {
                Some(name) => fault.under(inner.within(["bodies", name])),
                None => fault,
            },
            "contacts" => match self.of_scene.get(i) {
                Some(i) => fault.under(in_contact(inner).within(("contacts", *i))),
                None => fault,
            },
            "loads" => {
                let load = if i < self.loads { ("loads", i).into() } else { Path::from("ground_motion") };
                let fault = fault.under(inner).without("force");
                match fault.value {
                    Some(Value::Number(omega)) if fault.field == "omega_rad_s" => {
                        // without the last digit, which is rounding
                        let frequency_hz = format!("{:.14e}", omega / TAU).parse().unwrap_or(omega / TAU);
                        InvalidInput::new("frequency_hz", number(frequency_hz), fault.allowed)
                    }
                    _ => fault,
                }
                .within(load)
            }
            _ => fault,
        }
    }
}

/// The sides of a contact are called `between` in scenes.
fn in_contact(path: Path) -> Path {
    let step = |step: &Step| match step {
        Step::Field(name) if name == "sides" => Step::Field("between".to_owned()),
        other => other.clone(),
    };
    path.steps().iter().map(step).collect()
}
