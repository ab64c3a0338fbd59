//! The struck structure of a scene.

use invalid_input::InvalidInput;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;
use vibroimpact_sim::modal;

use super::beam::Beam;
use super::beam_theory::BeamTheory;
use super::dropped_rod::DroppedRod;
use super::infinite::{InfiniteBeam, InfinitePlate};
use super::json::{read_beside, split_tag};
use super::known::KnownModes;
use super::modal::Modal;
use super::modes_file::ModesFile;
use super::place::{Place, require_count};
use super::plate::{Edge, Plate, PlateTheory};
use super::string::TautString;

/// The struck structure, of the kind that `"kind"` names.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Structure {
    /// `"beam"`: a beam of uniform segments by Euler-Bernoulli's or Timoshenko's theory, whose modes are computed.
    Beam(Beam),
    /// `"string"`: a string under tension, with or without stiffness.
    #[serde(rename = "string")]
    TautString(TautString),
    /// `"plate"`: a rectangular plate, whose modes are computed.
    Plate(Plate),
    /// `"modal"`: any linear structure, given by its modes (measured, or from finite elements).
    Modal(Modal),
    /// `"modes-file"`: the same from a table of comma-separated values in the folder of the scene.
    ModesFile(ModesFile),
    /// `"infinite-beam"`: a beam without ends, [`vibroimpact_sim::infinite`].
    InfiniteBeam(InfiniteBeam),
    /// `"infinite-plate"`: a thin plate without edges, [`vibroimpact_sim::infinite`].
    InfinitePlate(InfinitePlate),
    /// `"dropped-rod"`: a tilted rod that falls on an immovable floor, [`vibroimpact_sim::dropped_rod`].
    DroppedRod(DroppedRod),
}

/// Converts a structure of one kind.
macro_rules! from_kind {
    ($($kind:ident),*) => {
        $(impl From<$kind> for Structure {
            fn from(structure: $kind) -> Structure {
                Structure::$kind(structure)
            }
        })*
    };
}

from_kind!(Beam, TautString, Plate, Modal, ModesFile, InfiniteBeam, InfinitePlate, DroppedRod);

/// Names of the kinds of structures in scene files.
const KINDS: [&str; 8] =
    ["beam", "string", "plate", "modal", "modes-file", "infinite-beam", "infinite-plate", "dropped-rod"];

impl Structure {
    /// The theory of bending by which a beam is solved.
    pub(crate) fn bending_theory(&self) -> Option<BeamTheory> {
        match self {
            Structure::Beam(beam) => beam.solved_by().ok(),
            _ => None,
        }
    }

    pub(crate) fn from_value(value: &Value) -> Result<Structure, InvalidInput> {
        Structure::from_value_beside(value, &[])
    }

    /// As [`Structure::from_value`], beside other fields of the same object.
    pub(crate) fn from_value_beside(value: &Value, beside: &[&str]) -> Result<Structure, InvalidInput> {
        let (kind, rest) = split_tag(value, "kind", &KINDS)?;
        let rest = Value::Object(rest);
        match kind {
            "beam" => read_beside(&rest, beside).map(Structure::Beam),
            "string" => read_beside(&rest, beside).map(Structure::TautString),
            "plate" => read_beside(&rest, beside).map(Structure::Plate),
            "infinite-beam" => read_beside(&rest, beside).map(Structure::InfiniteBeam),
            "infinite-plate" => read_beside(&rest, beside).map(Structure::InfinitePlate),
            "dropped-rod" => read_beside(&rest, beside).map(Structure::DroppedRod),
            "modes-file" => read_beside(&rest, beside).map(Structure::ModesFile),
            _ => Modal::from_value(&rest, beside).map(Structure::Modal),
        }
    }

    /// The value of `"kind"`.
    pub fn kind(&self) -> &'static str {
        match self {
            Structure::Beam(_) => "beam",
            Structure::TautString(_) => "string",
            Structure::Plate(_) => "plate",
            Structure::Modal(_) => "modal",
            Structure::ModesFile(_) => "modes-file",
            Structure::InfiniteBeam(_) => "infinite-beam",
            Structure::InfinitePlate(_) => "infinite-plate",
            Structure::DroppedRod(_) => "dropped-rod",
        }
    }

    /// The reason why this kind cannot be described by modes, or not yet.
    fn no_modes(&self) -> InvalidInput {
        let allowed = match self {
            Structure::ModesFile(_) => {
                "replaced by the kind modal with the modes of its table, as Scene::read and Scene::read_modes_file do"
            }
            _ => "one of beam, string, plate, modal, dropped-rod, the structures with modes",
        };
        InvalidInput::new(["structure", "kind"], format!("\"{}\"", self.kind()), allowed)
    }

    /// The first `count` modes with their shapes at a location (all modes for `None`).
    pub(crate) fn modes(&self, place: Place, count: Option<usize>) -> Result<Vec<modal::Mode>, InvalidInput> {
        self.modes_with(place, count, &mut KnownModes::default())
    }

    /// As [`Structure::modes`], with cached modes.
    pub(crate) fn modes_with(
        &self,
        place: Place,
        count: Option<usize>,
        known: &mut KnownModes,
    ) -> Result<Vec<modal::Mode>, InvalidInput> {
        count.map_or(Ok(()), require_count)?;
        let modes = match self {
            Structure::InfiniteBeam(_) | Structure::InfinitePlate(_) | Structure::ModesFile(_) => {
                return Err(self.no_modes());
            }
            Structure::Beam(_) | Structure::TautString(_) | Structure::Plate(_) => {
                let location_m = place.on_structure()?;
                let stated = "a whole number from 0 to 10000; the program does not choose it for a structure that moves \
                              before the impact, for an immovable striker, and for Mindlin's plate";
                let count = count.ok_or_else(|| InvalidInput::missing("modes", stated))?;
                return match self {
                    Structure::Beam(beam) => known.first(beam, count)?.seen_from(location_m.along()?),
                    Structure::TautString(string) => string.modes(location_m.along()?, count),
                    Structure::Plate(plate) => {
                        let there = location_m.on()?;
                        plate.seen_from(known.plates.first(plate, count, Plate::modes)?, there)
                    }
                    _ => Ok(Vec::new()),
                };
            }
            Structure::Modal(listed) => {
                place.require_no_distance("left out, because the points of a modal structure have names")?;
                listed.modes(place.location)?
            }
            Structure::DroppedRod(rod) => {
                place.require_none("left out, because a dropped rod is struck at its lower end")?;
                rod.modes().map_err(|fault| fault.within("structure"))?
            }
        };
        match count {
            Some(count) if count > modes.len() => {
                let allowed = format!("at most {}, the number of listed modes", modes.len());
                Err(InvalidInput::new("modes", count.to_string(), allowed))
            }
            _ => Ok(modes.into_iter().take(count.unwrap_or(usize::MAX)).collect()),
        }
    }

    /// For each mode in the order of the file its place by frequency, where modes are listed.
    pub(crate) fn ranks(&self) -> Option<Vec<usize>> {
        match self {
            Structure::Modal(listed) => Some(listed.ranks()),
            _ => None,
        }
    }

    /// Participation of the first `count` modes in a uniform acceleration (kg^1/2), where modes are computed.
    pub(crate) fn participation_with(
        &self,
        count: usize,
        known: &mut KnownModes,
    ) -> Option<Result<Vec<f64>, InvalidInput>> {
        match self {
            Structure::Beam(beam) => Some(known.first(beam, count).map(|modes| modes.participation_kg0_5())),
            Structure::TautString(string) => Some(string.participation_kg0_5(count)),
            Structure::Plate(plate) => {
                let modes = known.plates.first(plate, count, Plate::modes);
                Some(modes.map(beam_modes::PlateModes::participation_kg0_5))
            }
            _ => None,
        }
    }

    /// Whether modes and static compliance are computed from the structure, so that there is a limit for many modes.
    pub(crate) fn is_computed(&self) -> bool {
        match self {
            Structure::Beam(_) | Structure::TautString(_) => true,
            Structure::Plate(plate) => plate.theory == PlateTheory::Kirchhoff,
            _ => false,
        }
    }

    /// Largest number of modes that the program tries of a structure whose modes it computes.
    pub(crate) fn most_modes(&self) -> usize {
        // closed forms are cheap; by Ritz's method more modes take many seconds
        const CLOSED_FORM: usize = 4000;
        const RITZ: usize = 500;
        match self {
            Structure::Plate(plate) => {
                let most = if plate.edges == [Edge::Pinned; 4] { CLOSED_FORM } else { RITZ };
                plate.to_plate().map_or(0, |plate| plate.most_modes().min(most))
            }
            _ => CLOSED_FORM,
        }
    }

    /// Frequency of mode `n` of a string or plate (rad/s), and contribution of `n` modes to the inverse mass of a location (1/kg):
    /// means, before any mode is computed.
    pub(crate) fn estimate(&self, n: usize) -> Option<(f64, f64)> {
        match self {
            Structure::TautString(string) => Some(string.estimate(n)),
            Structure::Plate(plate) => Some(plate.estimate(n)),
            _ => None,
        }
    }

    /// Number of rigid-body modes of a string or plate.
    pub(crate) fn rigid_body_count(&self) -> Result<usize, InvalidInput> {
        match self {
            Structure::Plate(plate) => {
                Ok(plate.to_plate().map_err(|fault| fault.within("structure"))?.rigid_body_count())
            }
            _ => Ok(0),
        }
    }

    /// The damping ratio of every mode of a string or plate.
    pub(crate) fn damping_ratio(&self) -> f64 {
        match self {
            Structure::TautString(string) => string.damping_ratio,
            Structure::Plate(plate) => plate.damping_ratio,
            _ => 0.0,
        }
    }

    /// [`Structure::static_compliance_m_n`], and its uncertainty (m/N): 0 if it has a closed form or is stated.
    pub(crate) fn static_compliance_with_uncertainty_m_n(&self, place: Place) -> Result<(f64, f64), InvalidInput> {
        match self {
            Structure::Plate(plate) => plate.static_compliance_with_uncertainty_m_n(place.on_structure()?.on()?),
            _ => Ok((self.static_compliance_m_n(place)?, 0.0)),
        }
    }

    /// Static compliance at a location (m/N) of the whole elastic structure.
    pub(crate) fn static_compliance_m_n(&self, place: Place) -> Result<f64, InvalidInput> {
        match self {
            Structure::Beam(beam) => beam
                .to_system()
                .and_then(|beam| beam.static_compliance(place.on_structure()?.along()?))
                .map_err(|fault| if fault.field == "location_m" { fault } else { fault.within("structure") }),
            Structure::TautString(string) => string.static_compliance_m_n(place.on_structure()?.along()?),
            Structure::Plate(_) => Ok(self.static_compliance_with_uncertainty_m_n(place)?.0),
            Structure::Modal(listed) => listed.static_compliance_m_n(place.location),
            Structure::DroppedRod(rod) => rod.static_compliance_m_n().map_err(|fault| fault.within("structure")),
            Structure::InfiniteBeam(_) | Structure::InfinitePlate(_) | Structure::ModesFile(_) => Err(self.no_modes()),
        }
    }
}
