//! The bodies of an assembly.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::fields::KINDS;
use super::rod::Rod;
use crate::scene::json::{found, quote, read, read_field};
use crate::scene::{InvalidInput, Location, MovingMode, SceneError, Structure};

/// A body, of the kind that `"kind"` names.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum Body {
    /// `"mass"`: a compact body.
    Mass(Mass),
    /// Any structure that has modes.
    Elastic(Box<Elastic>),
}

/// A compact body, which moves along `x` and does not vibrate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mass {
    /// `"mass"`.
    pub kind: MassKind,
    /// Mass (kg).
    pub mass_kg: f64,
    /// Displacement at the start (m); 0 when left out.
    #[serde(default)]
    pub position_m: f64,
    /// Velocity at the start (m/s); 0 when left out.
    #[serde(default)]
    pub velocity_m_s: f64,
}

/// The name of the kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum MassKind {
    /// `"mass"`
    Mass,
}

/// A structure with modes, and its motion at the start: undeformed and at rest, plus what is given.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Elastic {
    /// The structure: `rod`, or any kind that is struck in a scene of one impact and has modes.
    #[serde(flatten)]
    #[schemars(skip)]
    pub structure: Elastics,
    /// Number of modes, from the lowest; required where they are computed. When left out: all that are listed.
    pub modes: Option<usize>,
    /// Whether the truncated modes respond with their static compliance; `false` when left out.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub residual_compliance: bool,
    /// Uniform velocity at the start of a body that is free to translate (m/s); 0 when left out.
    #[serde(default)]
    pub velocity_m_s: f64,
    /// Motion of single modes at the start.
    pub start: Option<Start>,
    /// Participation `int m phi dx` of each mode in a uniform acceleration (kg^1/2), which gravity and a motion of the
    /// ground need where the modes are given and not computed; in the order of the list of modes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub gravity_participation_kg0_5: Vec<f64>,
}

/// The structures that a body may be.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Elastics {
    /// A rod in axial vibration.
    Rod(Rod),
    /// A structure of a scene of one impact.
    Structure(Structure),
}

impl Elastics {
    /// For each mode in the order of the file its place by frequency, where modes are listed.
    pub(super) fn ranks(&self) -> Option<Vec<usize>> {
        match self {
            Elastics::Structure(structure) => structure.ranks(),
            Elastics::Rod(_) => None,
        }
    }
}

/// Motion of single modes at the start; what is given adds up.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "BodyStart")]
pub struct Start {
    /// Amplitudes of the first mass-normalised modes (m kg^1/2), where modes are listed in the order of the list; those of the rest
    /// are 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub amplitude_m_kg0_5: Vec<f64>,
    /// Their rates (m kg^1/2 / s); those of the rest are 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rate_m_kg0_5_s: Vec<f64>,
    /// Modes whose motion is given at a location, which each entry names.
    #[serde(default, deserialize_with = "crate::scene::json::objects", skip_serializing_if = "Vec::is_empty")]
    pub moving_modes: Vec<MovingMode>,
}

/// Fields of a body in addition to those of the structure.
#[derive(Deserialize)]
struct Beside {
    modes: Option<usize>,
    #[serde(default)]
    residual_compliance: bool,
    #[serde(default)]
    velocity_m_s: f64,
    start: Option<Value>,
    #[serde(default)]
    gravity_participation_kg0_5: Vec<f64>,
}

/// Structures of one impact that a body may be, and whether their modes are computed.
pub(super) const STRUCTURES: [(&str, bool); 5] =
    [("beam", true), ("string", true), ("plate", true), ("modal", false), ("modes-file", false)];

const BESIDE: [&str; 5] = ["modes", "residual_compliance", "velocity_m_s", "start", "gravity_participation_kg0_5"];

impl Body {
    pub(super) fn from_value(value: &Value) -> Result<Body, InvalidInput> {
        let Some(entries) = value.as_object() else {
            return Err(InvalidInput::new(
                invalid_input::Path::default(),
                quote(value),
                "an object with the field kind",
            ));
        };
        match entries.get("kind").and_then(Value::as_str) {
            Some("mass") => read(value).map(Body::Mass),
            Some(kind) if kind == "rod" || STRUCTURES.iter().any(|(name, _)| *name == kind) => {
                Elastic::from_entries(kind, entries).map(|body| Body::Elastic(Box::new(body)))
            }
            _ => Err(found("kind", entries.get("kind"), KINDS)),
        }
    }

    /// Replaces the name of a table of modes by its numbers; `folder` is that of the scene.
    pub(super) fn read_table(&mut self, folder: &Path) -> Result<(), SceneError> {
        if let Body::Elastic(body) = self
            && let Elastics::Structure(Structure::ModesFile(named)) = &body.structure
        {
            let modal = named.load(folder).map_err(|fault| match fault {
                SceneError::Invalid(fault) => fault.without("structure").into(),
                other => other,
            })?;
            body.structure = Elastics::Structure(Structure::Modal(modal));
        }
        Ok(())
    }

    /// Extent along `x` at a location (m): the thickness of a beam or plate, the length of a rod; `None` if it is not stated.
    pub(super) fn thickness_m(&self, location_m: Option<Location>) -> Option<f64> {
        let Body::Elastic(body) = self else { return None };
        match &body.structure {
            Elastics::Rod(rod) => Some(rod.segments.iter().map(|segment| segment.length_m).sum()),
            Elastics::Structure(Structure::Beam(beam)) => {
                let place = location_m?.along().ok()?;
                let mut end_m = 0.0;
                let here = beam.segments.iter().find(|segment| {
                    end_m += segment.length_m;
                    end_m >= place
                });
                here.or(beam.segments.last())?.thickness().map(|(_, thickness_m)| thickness_m)
            }
            Elastics::Structure(Structure::Plate(plate)) => Some(plate.thickness_m),
            Elastics::Structure(_) => None,
        }
    }

    /// The value of `"kind"`.
    pub fn kind(&self) -> &'static str {
        match self {
            Body::Mass(_) => "mass",
            Body::Elastic(body) => match &body.structure {
                Elastics::Rod(_) => "rod",
                Elastics::Structure(structure) => structure.kind(),
            },
        }
    }
}

impl Elastic {
    /// A structure at rest with its first `modes` modes.
    pub fn new(structure: impl Into<Structure>, modes: Option<usize>) -> Elastic {
        Elastic {
            structure: Elastics::Structure(structure.into()),
            modes,
            residual_compliance: false,
            velocity_m_s: 0.0,
            start: None,
            gravity_participation_kg0_5: Vec::new(),
        }
    }

    fn from_entries(kind: &str, entries: &Map<String, Value>) -> Result<Elastic, InvalidInput> {
        let (beside, own): (Map<String, Value>, Map<String, Value>) =
            entries.clone().into_iter().partition(|(field, _)| BESIDE.contains(&field.as_str()));
        let own = Value::Object(own);
        let Beside { modes, residual_compliance, velocity_m_s, start, gravity_participation_kg0_5 } =
            read(&Value::Object(beside)).map_err(stated_modes)?;
        let structure = match kind {
            "rod" => Elastics::Rod(Rod::from_value_beside(&own, &BESIDE)?),
            _ => Elastics::Structure(Structure::from_value_beside(&own, &BESIDE)?),
        };
        let start = start.as_ref().map(|start| read_field(start, "start")).transpose()?;
        Ok(Elastic { structure, modes, residual_compliance, velocity_m_s, start, gravity_participation_kg0_5 })
    }
}

/// The modes of a body, which have to be stated: the program chooses those of a single impact only.
pub(super) const STATED_MODES: &str = "a whole number from 0 to 10000";

/// The same fault, where it is one of the modes with what a body allows.
pub(super) fn stated_modes(fault: InvalidInput) -> InvalidInput {
    match fault.field.first() {
        Some("modes") => InvalidInput { allowed: STATED_MODES.into(), ..fault },
        _ => fault,
    }
}
