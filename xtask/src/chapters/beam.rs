//! The beams of the chapters in modes.

use super::Failure;
use super::impact::Material;
use beam_modes::Modes;
use serde::Deserialize;
use vibroimpact_sim::modal::{Mode, Structure};

/// Remainder modes for the modes left out, as the program takes them for Euler-Bernoulli beams.
const REMAINDER_MODES: usize = 2;

/// How an end of a beam is held, as the parameter files write it.
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

/// A steel beam of square or, where slimmer, rectangular section with its modes.
#[derive(Debug)]
pub(super) struct Beam {
    /// Short name for tables.
    pub name: String,
    /// Name for headings.
    pub title: String,
    /// The beam itself.
    pub model: beam_modes::Beam,
    modes: Modes,
}

/// A stretch of length `length_m` whose width is the side of the square section and whose
/// thickness is a fraction of it.
pub(super) fn segment(material: &Material, length_m: f64, side_m: f64, thickness_fraction: f64) -> beam_modes::Segment {
    let thickness_m = thickness_fraction * side_m;
    beam_modes::Segment::rectangular(length_m, material.youngs_modulus_pa, material.density_kg_m3, side_m, thickness_m)
}

impl Beam {
    /// A beam with its first `count` modes.
    pub fn new(
        name: &str,
        title: &str,
        ends: [End; 2],
        segments: Vec<beam_modes::Segment>,
        count: usize,
    ) -> Result<Beam, Failure> {
        let model = beam_modes::Beam { segments, ends: ends.map(Into::into) };
        let modes = model.modes(count)?;
        Ok(Beam { name: name.into(), title: title.into(), model, modes })
    }

    /// Natural frequencies (rad/s).
    pub fn omega_rad_s(&self) -> &[f64] {
        self.modes.omega_rad_s()
    }

    /// The first `count` modes as a ball at `location_m` meets them; with `residual`, remainder modes answer for all
    /// others.
    pub fn structure(
        &self,
        location_m: f64,
        count: usize,
        damping_ratio: f64,
        residual: bool,
    ) -> Result<Structure, Failure> {
        let omega =
            self.omega_rad_s().get(..count).ok_or_else(|| format!("{count} modes asked for, fewer computed"))?;
        let mut modes = Vec::with_capacity(count);
        for (k, &omega_rad_s) in omega.iter().enumerate() {
            modes.push(Mode { omega_rad_s, damping_ratio, shape: self.modes.shape(k, location_m)? });
        }
        if residual {
            let remainder = self.model.remainder(location_m, count, REMAINDER_MODES)?;
            modes.extend(remainder.iter().map(|m| Mode { omega_rad_s: m.omega_rad_s, damping_ratio, shape: m.shape }));
        }
        Ok(Structure { modes })
    }
}
