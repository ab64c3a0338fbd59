//! The struck structure of a scene.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use vibroimpact_sim::modal;

use super::error::InvalidInput;
use super::fields;
use super::infinite::{InfiniteBeam, InfinitePlate};
use super::json::{number, objects, read, split_tag};
use super::sets::one_of_sets;

/// What is struck; `"kind"` in JSON tells which.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Structure {
    /// `"beam"`: an Euler-Bernoulli beam of uniform segments, whose modes are computed.
    Beam(Beam),
    /// `"modal"`: any linear structure, given by its modes (measured, or from finite elements).
    Modal(Modal),
    /// `"infinite-beam"`: a beam without ends, [`vibroimpact_sim::infinite`].
    InfiniteBeam(InfiniteBeam),
    /// `"infinite-plate"`: a thin plate without edges, [`vibroimpact_sim::infinite`].
    InfinitePlate(InfinitePlate),
}

impl Structure {
    pub(crate) fn from_value(value: &Value) -> Result<Structure, InvalidInput> {
        let (kind, rest) = split_tag(value, "kind", &["beam", "modal", "infinite-beam", "infinite-plate"])?;
        let rest = Value::Object(rest);
        match kind {
            "beam" => read(&rest).map(Structure::Beam),
            "infinite-beam" => read(&rest).map(Structure::InfiniteBeam),
            "infinite-plate" => read(&rest).map(Structure::InfinitePlate),
            _ => read(&rest).map(Structure::Modal),
        }
    }

    /// The value of `"kind"`.
    pub fn kind(&self) -> &'static str {
        match self {
            Structure::Beam(_) => "beam",
            Structure::Modal(_) => "modal",
            Structure::InfiniteBeam(_) => "infinite-beam",
            Structure::InfinitePlate(_) => "infinite-plate",
        }
    }

    /// Infinite structures cannot be described by modes.
    fn no_modes(&self) -> InvalidInput {
        InvalidInput::new("structure.kind", format!("\"{}\"", self.kind()), "beam or modal, the structures with modes")
    }

    /// The first `count` modes as seen from the point of impact (all that there are, for `None`).
    pub(crate) fn modes(
        &self,
        location_m: Option<f64>,
        count: Option<usize>,
    ) -> Result<Vec<modal::Mode>, InvalidInput> {
        count.map_or(Ok(()), require_count)?;
        match (self, location_m, count) {
            (Structure::InfiniteBeam(_) | Structure::InfinitePlate(_), _, _) => Err(self.no_modes()),
            (Structure::Beam(beam), Some(location_m), Some(count)) => beam.modes(count)?.seen_from(location_m),
            (Structure::Beam(_), None, _) => {
                Err(InvalidInput::missing("location_m", fields::allowed("location_m").unwrap_or_default()))
            }
            (Structure::Beam(_), _, None) => {
                Err(InvalidInput::missing("modes", fields::allowed("modes").unwrap_or_default()))
            }
            (Structure::Modal(_), Some(location_m), _) => {
                let allowed = "left out: a modal structure is given by its shapes at the point of impact";
                Err(InvalidInput::new("location_m", number(location_m), allowed))
            }
            (Structure::Modal(listed), None, Some(count)) if count > listed.omega_rad_s.len() => {
                let allowed = format!("at most {}, the number of modes listed", listed.omega_rad_s.len());
                Err(InvalidInput::new("modes", count.to_string(), allowed))
            }
            (Structure::Modal(listed), None, count) => {
                listed.modes(count.unwrap_or(usize::MAX)).map_err(|fault| fault.within("structure"))
            }
        }
    }

    /// Static compliance at the point of impact (m/N) of the whole elastic structure.
    pub(crate) fn static_compliance_m_n(&self, location_m: Option<f64>) -> Result<f64, InvalidInput> {
        match self {
            Structure::InfiniteBeam(_) | Structure::InfinitePlate(_) => Err(self.no_modes()),
            Structure::Beam(beam) => beam
                .to_beam()
                .and_then(|beam| Ok(beam.static_compliance(location_m.unwrap_or(f64::NAN))?))
                .map_err(|fault| fault.within("structure")),
            Structure::Modal(listed) => {
                let allowed = "needed for residual_compliance: a finite number not less than 0";
                let field = "structure.static_compliance_m_n";
                let value = listed.static_compliance_m_n.ok_or_else(|| InvalidInput::missing(field, allowed))?;
                if value >= 0.0 && value.is_finite() {
                    Ok(value)
                } else {
                    Err(InvalidInput::new(field, number(value), allowed))
                }
            }
        }
    }
}

/// Largest number of modes that a scene may ask for.
const MAX_MODES: usize = 10_000;

fn require_count(count: usize) -> Result<(), InvalidInput> {
    if count <= MAX_MODES {
        Ok(())
    } else {
        Err(InvalidInput::new("modes", count.to_string(), fields::allowed("modes").unwrap_or_default()))
    }
}

impl Beam {
    /// The beam in the terms of [`beam_modes`].
    ///
    /// # Errors
    /// A segment whose section is not given in exactly one way, or by numbers that are not positive.
    pub fn to_beam(&self) -> Result<beam_modes::Beam, InvalidInput> {
        let segment = |(i, segment): (usize, &Segment)| {
            segment.to_segment().map_err(|fault| fault.within(&format!("segments[{i}]")))
        };
        Ok(beam_modes::Beam {
            segments: self.segments.iter().enumerate().map(segment).collect::<Result<_, _>>()?,
            ends: self.ends.map(|end| match end {
                End::Clamped => beam_modes::End::Clamped,
                End::Pinned => beam_modes::End::Pinned,
                End::Free => beam_modes::End::Free,
                End::Guided => beam_modes::End::Guided,
            }),
        })
    }

    /// The first `count` modes, to be seen from any place.
    pub(crate) fn modes(&self, count: usize) -> Result<BeamModes, InvalidInput> {
        require_count(count)?;
        let damping_ratio = self.damping_ratio;
        let modes = || {
            if !(damping_ratio >= 0.0 && damping_ratio.is_finite()) {
                let allowed = fields::allowed("damping_ratio").unwrap_or_default();
                return Err(InvalidInput::new("damping_ratio", number(damping_ratio), allowed));
            }
            Ok(self.to_beam()?.modes(count)?)
        };
        Ok(BeamModes { modes: modes().map_err(|fault| fault.within("structure"))?, damping_ratio })
    }
}

/// The modes of a beam.
pub(crate) struct BeamModes {
    modes: beam_modes::Modes,
    damping_ratio: f64,
}

impl BeamModes {
    /// The modes as a striker at a place on the beam meets them.
    pub(crate) fn seen_from(&self, location_m: f64) -> Result<Vec<modal::Mode>, InvalidInput> {
        let shapes = self.modes.shapes_at(location_m).map_err(|fault| match fault.field.as_str() {
            "x_m" => InvalidInput { field: "location_m".to_owned(), ..fault.into() },
            _ => InvalidInput::from(fault).within("structure"),
        })?;
        let mode = |(&omega_rad_s, shape)| modal::Mode { omega_rad_s, damping_ratio: self.damping_ratio, shape };
        Ok(self.modes.omega_rad_s().iter().zip(shapes).map(mode).collect())
    }
}

impl Segment {
    pub(super) fn to_segment(self) -> Result<beam_modes::Segment, InvalidInput> {
        let given = [
            ("flexural_rigidity_n_m2", self.flexural_rigidity_n_m2),
            ("mass_per_length_kg_m", self.mass_per_length_kg_m),
            ("youngs_modulus_pa", self.youngs_modulus_pa),
            ("density_kg_m3", self.density_kg_m3),
            ("width_m", self.width_m),
            ("thickness_m", self.thickness_m),
            ("diameter_m", self.diameter_m),
        ];
        let sets: [&[&str]; 3] = [
            &["flexural_rigidity_n_m2", "mass_per_length_kg_m"],
            &["youngs_modulus_pa", "density_kg_m3", "width_m", "thickness_m"],
            &["youngs_modulus_pa", "density_kg_m3", "diameter_m"],
        ];
        let set = one_of_sets(&given, &sets)?;
        let [rigidity, mass, modulus, density, width, thickness, diameter] =
            given.map(|(_, value)| value.unwrap_or_default());
        for (field, value) in std::iter::once(("length_m", Some(self.length_m))).chain(given) {
            value.map_or(Ok(()), |value| InvalidInput::require_positive(field, value))?;
        }
        let length_m = self.length_m;
        Ok(match set {
            0 => beam_modes::Segment { length_m, flexural_rigidity_n_m2: rigidity, mass_per_length_kg_m: mass },
            1 => beam_modes::Segment::rectangular(length_m, modulus, density, width, thickness),
            _ => beam_modes::Segment {
                length_m,
                flexural_rigidity_n_m2: modulus * PI * diameter.powi(4) / 64.0,
                mass_per_length_kg_m: density * PI * diameter.powi(2) / 4.0,
            },
        })
    }
}

impl Modal {
    fn modes(&self, count: usize) -> Result<Vec<modal::Mode>, InvalidInput> {
        let listed = self.omega_rad_s.len();
        let ratios = &self.damping_ratios;
        for (field, length) in [("shape_at_location", self.shape_at_location.len()), ("damping_ratios", ratios.len())] {
            if length != listed && !(field == "damping_ratios" && length == 0) {
                let allowed = format!("as many values as omega_rad_s has, which is {listed}");
                return Err(InvalidInput::new(field, format!("{length} values"), allowed));
            }
        }
        let modes = self.omega_rad_s.iter().zip(&self.shape_at_location).enumerate();
        let mode = |(k, (&omega_rad_s, &shape))| modal::Mode {
            omega_rad_s,
            shape,
            damping_ratio: ratios.get(k).copied().unwrap_or_default(),
        };
        Ok(modes.take(count).map(mode).collect())
    }
}

/// A straight beam of uniform segments, from left to right.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// How the left and the right end are held.
    pub ends: [End; 2],
    /// The segments from left to right; at least one.
    #[serde(deserialize_with = "objects")]
    pub segments: Vec<Segment>,
    /// Damping ratio of every mode; 0 when left out.
    #[serde(default)]
    pub damping_ratio: f64,
}

/// How an end of a beam is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum End {
    /// Neither displacement nor slope.
    Clamped,
    /// No displacement, no moment.
    Pinned,
    /// No moment, no shear force.
    Free,
    /// No slope, no shear force.
    Guided,
}

/// A uniform piece of a beam: its length, and its section in one of three ways: flexural rigidity and mass per
/// length; material, width and thickness; or material and diameter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// Length (m).
    pub length_m: f64,
    /// Flexural rigidity `EI` (N m^2).
    pub flexural_rigidity_n_m2: Option<f64>,
    /// Mass per length (kg/m).
    pub mass_per_length_kg_m: Option<f64>,
    /// Young's modulus (Pa).
    pub youngs_modulus_pa: Option<f64>,
    /// Density (kg/m^3).
    pub density_kg_m3: Option<f64>,
    /// Width of a rectangular section, across the direction of the blow (m).
    pub width_m: Option<f64>,
    /// Thickness of a rectangular section, along the direction of the blow (m).
    pub thickness_m: Option<f64>,
    /// Diameter of a circular section (m).
    pub diameter_m: Option<f64>,
}

/// A structure given by its modes at the point of impact. The lists run over the same modes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Modal {
    /// Angular frequencies (rad/s); 0 for a rigid-body mode.
    pub omega_rad_s: Vec<f64>,
    /// Mass-normalised shapes at the point of impact (kg^-1/2).
    pub shape_at_location: Vec<f64>,
    /// Damping ratios, one a mode; all 0 when left out.
    #[serde(default)]
    pub damping_ratios: Vec<f64>,
    /// Static compliance at the point of impact (m/N) of the whole elastic structure, modes beyond the list
    /// included; needed for `"residual_compliance": true` only.
    pub static_compliance_m_n: Option<f64>,
}
