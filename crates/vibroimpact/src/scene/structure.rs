//! The struck structure of a scene.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::error::InvalidInput;
use super::json::{objects, read, split_tag};
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
}

impl Structure {
    pub(crate) fn from_value(value: &Value) -> Result<Structure, InvalidInput> {
        let (kind, rest) = split_tag(value, "kind", &["beam", "modal"])?;
        let rest = Value::Object(rest);
        match kind {
            "beam" => read(&rest).map(Structure::Beam),
            _ => read(&rest).map(Structure::Modal),
        }
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
    pub damping_ratios: Option<Vec<f64>>,
    /// Static compliance at the point of impact (m/N) of the whole elastic structure, modes beyond the list
    /// included; needed for `"residual_compliance": true` only.
    pub static_compliance_m_n: Option<f64>,
}
