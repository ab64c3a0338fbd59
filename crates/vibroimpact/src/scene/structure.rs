//! The struck structure of a scene.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;
use vibroimpact_sim::modal;

use super::beam::{Beam, KnownModes};
use super::dropped_rod::DroppedRod;
use super::error::InvalidInput;
use super::fields;
use super::infinite::{InfiniteBeam, InfinitePlate};
use super::json::{number, read, split_tag};
use super::modal::Modal;
use super::modes_file::ModesFile;

/// What is struck; `"kind"` tells which.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Structure {
    /// `"beam"`: an Euler-Bernoulli beam of uniform segments, whose modes are computed.
    Beam(Beam),
    /// `"modal"`: any linear structure, given by its modes (measured, or from finite elements).
    Modal(Modal),
    /// `"modes-file"`: the same from a table of comma-separated values that stands beside the scene.
    ModesFile(ModesFile),
    /// `"infinite-beam"`: a beam without ends, [`vibroimpact_sim::infinite`].
    InfiniteBeam(InfiniteBeam),
    /// `"infinite-plate"`: a thin plate without edges, [`vibroimpact_sim::infinite`].
    InfinitePlate(InfinitePlate),
    /// `"dropped-rod"`: a tilted rod that falls on an immovable floor, [`vibroimpact_sim::dropped_rod`].
    DroppedRod(DroppedRod),
}

/// A structure of one kind is a structure.
macro_rules! from_kind {
    ($($kind:ident),*) => {
        $(impl From<$kind> for Structure {
            fn from(structure: $kind) -> Structure {
                Structure::$kind(structure)
            }
        })*
    };
}

from_kind!(Beam, Modal, ModesFile, InfiniteBeam, InfinitePlate, DroppedRod);

/// Where a structure is struck or seen from: a distance along a beam, or the name of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place<'a> {
    pub location_m: Option<f64>,
    pub location: Option<&'a str>,
}

impl Place<'_> {
    /// Passes a place that is not given; `why` says why it must not be.
    pub(crate) fn require_none(&self, why: &str) -> Result<(), InvalidInput> {
        self.require_no_distance(why)?;
        self.require_no_name(why)
    }

    pub(crate) fn require_no_distance(&self, why: &str) -> Result<(), InvalidInput> {
        match self.location_m {
            Some(location_m) => Err(InvalidInput::new("location_m", number(location_m), why)),
            None => Ok(()),
        }
    }

    pub(crate) fn require_no_name(&self, why: &str) -> Result<(), InvalidInput> {
        match self.location {
            Some(location) => Err(InvalidInput::new("location", format!("{location:?}"), why)),
            None => Ok(()),
        }
    }
}

/// How the kinds of structures are named in scene files.
const KINDS: [&str; 6] = ["beam", "modal", "modes-file", "infinite-beam", "infinite-plate", "dropped-rod"];

impl Structure {
    pub(crate) fn from_value(value: &Value) -> Result<Structure, InvalidInput> {
        let (kind, rest) = split_tag(value, "kind", &KINDS)?;
        let rest = Value::Object(rest);
        match kind {
            "beam" => read(&rest).map(Structure::Beam),
            "infinite-beam" => read(&rest).map(Structure::InfiniteBeam),
            "infinite-plate" => read(&rest).map(Structure::InfinitePlate),
            "dropped-rod" => read(&rest).map(Structure::DroppedRod),
            "modes-file" => read(&rest).map(Structure::ModesFile),
            _ => Modal::from_value(&rest).map(Structure::Modal),
        }
    }

    /// The value of `"kind"`.
    pub fn kind(&self) -> &'static str {
        match self {
            Structure::Beam(_) => "beam",
            Structure::Modal(_) => "modal",
            Structure::ModesFile(_) => "modes-file",
            Structure::InfiniteBeam(_) => "infinite-beam",
            Structure::InfinitePlate(_) => "infinite-plate",
            Structure::DroppedRod(_) => "dropped-rod",
        }
    }

    /// Why this kind cannot be described by modes, or not yet.
    fn no_modes(&self) -> InvalidInput {
        let allowed = match self {
            Structure::ModesFile(_) => "replaced by its table: Scene::read does it, or Scene::read_modes_file",
            _ => "beam, modal or dropped-rod, the structures with modes",
        };
        InvalidInput::new("structure.kind", format!("\"{}\"", self.kind()), allowed)
    }

    /// The first `count` modes as seen from a place (all that there are, for `None`).
    pub(crate) fn modes(&self, place: Place, count: Option<usize>) -> Result<Vec<modal::Mode>, InvalidInput> {
        self.modes_with(place, count, &mut KnownModes::default())
    }

    /// As [`Structure::modes`], by what is known of the beam.
    pub(crate) fn modes_with(
        &self,
        place: Place,
        count: Option<usize>,
        known: &mut KnownModes,
    ) -> Result<Vec<modal::Mode>, InvalidInput> {
        count.map_or(Ok(()), require_count)?;
        let missing = |field| InvalidInput::missing(field, fields::allowed(field).unwrap_or_default());
        let modes = match self {
            Structure::InfiniteBeam(_) | Structure::InfinitePlate(_) | Structure::ModesFile(_) => {
                return Err(self.no_modes());
            }
            Structure::Beam(beam) => {
                place.require_no_name("left out: the place on a beam is location_m")?;
                let location_m = place.location_m.ok_or_else(|| missing("location_m"))?;
                let stated = "a whole number from 0 to 10000, where the program does not choose it: for a structure that \
                              moves before the impact, and for an immovable striker";
                let count = count.ok_or_else(|| InvalidInput::missing("modes", stated))?;
                return known.first(beam, count)?.seen_from(location_m);
            }
            Structure::Modal(listed) => {
                place.require_no_distance("left out: the points of a modal structure have names")?;
                listed.modes(place.location)?
            }
            Structure::DroppedRod(rod) => {
                place.require_none("left out: a dropped rod is struck at its lower end")?;
                rod.modes().map_err(|fault| fault.within("structure"))?
            }
        };
        match count {
            Some(count) if count > modes.len() => {
                let allowed = format!("at most {}, the number of modes listed", modes.len());
                Err(InvalidInput::new("modes", count.to_string(), allowed))
            }
            _ => Ok(modes.into_iter().take(count.unwrap_or(usize::MAX)).collect()),
        }
    }

    /// Static compliance at a place (m/N) of the whole elastic structure.
    pub(crate) fn static_compliance_m_n(&self, place: Place) -> Result<f64, InvalidInput> {
        match self {
            Structure::Beam(beam) => beam
                .to_beam()
                .and_then(|beam| Ok(beam.static_compliance(place.location_m.unwrap_or(f64::NAN))?))
                .map_err(|fault| fault.within("structure")),
            Structure::Modal(listed) => listed.static_compliance_m_n(place.location),
            Structure::DroppedRod(rod) => rod.static_compliance_m_n().map_err(|fault| fault.within("structure")),
            Structure::InfiniteBeam(_) | Structure::InfinitePlate(_) | Structure::ModesFile(_) => Err(self.no_modes()),
        }
    }
}

/// Largest number of modes that a scene may ask for.
const MAX_MODES: usize = 10_000;

pub(crate) fn require_count(count: usize) -> Result<(), InvalidInput> {
    if count <= MAX_MODES {
        Ok(())
    } else {
        Err(InvalidInput::new("modes", count.to_string(), fields::allowed("modes").unwrap_or_default()))
    }
}
