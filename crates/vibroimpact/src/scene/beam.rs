//! A beam of uniform segments, and its modes.

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vibroimpact_sim::modal;

use super::error::InvalidInput;
use super::json::objects;
use super::known::{require_damping, shapes_as_modes};
use super::sets::one_of_sets;
use super::structure::require_count;

/// A straight beam of uniform segments, from left to right.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
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

/// The ways in which a section is given.
pub(super) const SECTIONS: [&[&str]; 3] = [
    &["flexural_rigidity_n_m2", "mass_per_length_kg_m"],
    &["youngs_modulus_pa", "density_kg_m3", "width_m", "thickness_m"],
    &["youngs_modulus_pa", "density_kg_m3", "diameter_m"],
];

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
        require_damping(self.damping_ratio)?;
        let modes = || Ok(self.to_beam()?.modes(count)?);
        let within = |fault: InvalidInput| fault.within("structure");
        Ok(BeamModes { modes: modes().map_err(within)?, damping_ratio: self.damping_ratio })
    }
}

/// The modes of a beam.
pub(crate) struct BeamModes {
    modes: beam_modes::Modes,
    damping_ratio: f64,
}

impl BeamModes {
    /// Participation of the modes in a uniform acceleration (kg^1/2).
    pub(crate) fn participation_kg0_5(&self) -> Vec<f64> {
        self.modes.participation_kg0_5()
    }

    /// The modes as a striker at a place on the beam meets them.
    pub(crate) fn seen_from(&self, location_m: f64) -> Result<Vec<modal::Mode>, InvalidInput> {
        let shapes = self.modes.shapes_at(location_m).map_err(|fault| match fault.field.as_str() {
            "x_m" => InvalidInput { field: "location_m".to_owned(), ..fault.into() },
            _ => InvalidInput::from(fault).within("structure"),
        })?;
        Ok(shapes_as_modes(self.modes.omega_rad_s(), shapes, self.damping_ratio))
    }
}

impl Segment {
    /// A piece of rectangular section: length, material, width and thickness (along the blow) in SI units.
    pub fn rectangular(
        length_m: f64,
        youngs_modulus_pa: f64,
        density_kg_m3: f64,
        width_m: f64,
        thickness_m: f64,
    ) -> Segment {
        Segment {
            length_m,
            youngs_modulus_pa: Some(youngs_modulus_pa),
            density_kg_m3: Some(density_kg_m3),
            width_m: Some(width_m),
            thickness_m: Some(thickness_m),
            ..Segment::default()
        }
    }

    /// A piece of circular section: length, material and diameter in SI units.
    pub fn circular(length_m: f64, youngs_modulus_pa: f64, density_kg_m3: f64, diameter_m: f64) -> Segment {
        Segment {
            length_m,
            youngs_modulus_pa: Some(youngs_modulus_pa),
            density_kg_m3: Some(density_kg_m3),
            diameter_m: Some(diameter_m),
            ..Segment::default()
        }
    }

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
        let set = one_of_sets(&given, &SECTIONS)?;
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
