//! Beams of the chapters and their modes.

use super::material::Material;
use beam_modes::{BeamSystem, MOST_REMAINDER_MODES, Modes, ShearSection};
use serde::Deserialize;
use tasks::Failure;
use vibroimpact_sim::modal::Structure;

/// Number of remainder modes that represent the truncated modes. For an Euler-Bernoulli beam it is the program's default, for a
/// Timoshenko beam the largest allowed number.
const REMAINDER_MODES: usize = 2;

/// Support of one end of a beam, as it is written in the parameter files.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum End {
    Clamped,
    Pinned,
    Free,
}

impl From<End> for beam_modes::End {
    fn from(end: End) -> beam_modes::End {
        match end {
            End::Clamped => beam_modes::End::Clamped,
            End::Pinned => beam_modes::End::Pinned,
            End::Free => beam_modes::End::Free,
        }
    }
}

/// A steel beam with its modes. The section is square, or rectangular where the beam is thinner.
#[derive(Debug)]
pub(super) struct Beam {
    /// Short name for tables.
    pub name: String,
    /// Name for headings.
    pub title: String,
    /// The beam itself.
    pub model: BeamSystem,
    modes: Modes,
}

/// A segment of length `length_m` whose width is the side of the square section and whose thickness is a fraction of that side.
pub(super) fn segment(material: &Material, length_m: f64, side_m: f64, thickness_fraction: f64) -> beam_modes::Segment {
    let thickness_m = thickness_fraction * side_m;
    beam_modes::Segment::from(beam_modes::RectangularSegment {
        length_m,
        youngs_modulus_pa: material.youngs_modulus_pa,
        density_kg_m3: material.density_kg_m3,
        width_m: side_m,
        thickness_m,
    })
}

impl Beam {
    /// A beam with its first `count` modes by Euler-Bernoulli's theory, which the thesis uses.
    pub fn new(
        name: &str,
        title: &str,
        ends: [End; 2],
        segments: Vec<beam_modes::Segment>,
        count: usize,
    ) -> Result<Beam, Failure> {
        let model = BeamSystem::from(beam_modes::Beam { segments, ends: ends.map(Into::into) });
        let modes = model.modes(count)?;
        Ok(Beam { name: name.into(), title: title.into(), model, modes })
    }

    /// The same beam with the same number of modes by Timoshenko's theory.
    pub fn timoshenko(&self, material: &Material, shear_coefficient: f64) -> Result<Beam, Failure> {
        let shear_modulus_pa = 0.5 * material.youngs_modulus_pa / (1.0 + material.poissons_ratio);
        let section = |segment: &beam_modes::Segment| ShearSection {
            shear_rigidity_n: shear_coefficient * shear_modulus_pa * segment.mass_per_length_kg_m
                / material.density_kg_m3,
            rotary_inertia_kg_m: material.density_kg_m3 * segment.flexural_rigidity_n_m2 / material.youngs_modulus_pa,
        };
        let shear = self.model.beam.segments.iter().map(section).collect();
        let model = BeamSystem { shear: Some(shear), ..self.model.clone() };
        let modes = model.modes(self.modes.len())?;
        Ok(Beam { name: self.name.clone(), title: self.title.clone(), model, modes })
    }

    /// Natural frequencies (rad/s).
    pub fn omega_rad_s(&self) -> &[f64] {
        self.modes.omega_rad_s()
    }

    /// The first `count` modes with their shapes at `location_m`. With `residual`, remainder modes represent all others.
    pub fn structure(
        &self,
        location_m: f64,
        count: usize,
        damping_ratio: f64,
        residual: bool,
    ) -> Result<Structure, Failure> {
        let mut modes = self.modes.seen_from(location_m)?;
        if modes.len() < count {
            return Err(format!("{count} modes asked for, fewer computed").into());
        }
        modes.truncate(count);
        if residual {
            let remainder_modes = if self.model.shear.is_some() { MOST_REMAINDER_MODES } else { REMAINDER_MODES };
            modes.extend(self.model.remainder(location_m, count, remainder_modes)?);
        }
        Ok(Structure::from_modes(modes, damping_ratio))
    }
}
