//! The truncated modes of a structure, as a few remainder modes ([`beam_modes::remainder_modes`]).
//!
//! For a structure whose modes are computed, further modes are computed for the first part of the truncated spectrum. The rest,
//! and the whole truncated spectrum of a list, follows from the static compliance and the growth of the frequencies.

use std::f64::consts::PI;

use beam_modes::{MOST_REMAINDER_MODES, PointMode, remainder_from_trend, remainder_modes};
use invalid_input::InvalidInput;
use vibroimpact_sim::modal::{self, Mode};

use super::beam_theory::BeamTheory;
use super::location::Location;
use super::place::{MOST_MODES, Place};
use super::plate::Edge;
use super::structure::Structure;
use super::waves::Waves;

/// Checks that the truncated modes of a structure can be extrapolated: a list needs at least one elastic mode.
pub(crate) fn require_elastic(kept: &[Mode], whole_m_n: f64) -> Result<(), InvalidInput> {
    if whole_m_n == 0.0 || kept.iter().any(|mode| mode.omega_rad_s > 0.0) {
        return Ok(());
    }
    let allowed = "left out, unless it is beside at least one mode with a frequency above 0 that is retained: the response of the modes that are \
                   not listed is extrapolated from those that are";
    Err(InvalidInput::new(["structure", "static_compliance_m_n"], format!("{whole_m_n:e}"), allowed))
}

/// Remainder modes of a beam by Euler-Bernoulli's theory, whose truncated modes are nearly a spring. Those of all other structures
/// are nearly a wave impedance.
const OF_SLENDER_BEAM: usize = 2;
/// A list counts as complete if less than this share of the static compliance is missing.
pub(crate) const COMPLETE: f64 = 1e-11;
/// The static compliance of a list may exceed the stated one by this share, by rounding.
const ROUNDING: f64 = 1e-9;
/// Modes for a remainder are computed in multiples of this number, so that impacts with a few more modes share them.
const SIZES: usize = 64;
/// Largest number of modes computed for a remainder because the location is near a reflection: of beams, and of strings and plates,
/// whose modes have a closed form.
const MOST_NEAR_REFLECTION: usize = 2048;
const MOST_IN_CLOSED_FORM: usize = 8192;

impl Structure {
    /// Number of modes from which those beyond the first `kept` can be extrapolated: only `kept` for a list, and for a plate whose
    /// modes take too long to compute.
    pub(crate) fn enough_for_remainder(&self, place: Place, kept: usize) -> usize {
        let cheap = match self {
            Structure::Beam(_) | Structure::TautString(_) => true,
            Structure::Plate(plate) => plate.edges == [Edge::Pinned; 4],
            _ => false,
        };
        if cheap {
            let enough = beam_modes::enough_for_remainder(kept).max(self.resolving_reflections(place));
            enough.next_multiple_of(SIZES).min(MOST_MODES.max(kept))
        } else {
            kept
        }
    }

    /// Number of modes up to the one of which half a wave fits between the location and the nearest reflection: an end, and for beams
    /// a step, a support or an attachment. Before it the mean square of the shapes at the location is another than beyond, by which
    /// the modes that are not computed are extrapolated: it grows near a support, decreases near a free end, and is that of both
    /// sides near a step. With fewer modes, all numbers of retained modes would share the error of the extrapolation, and the change
    /// between them would not show it.
    fn resolving_reflections(&self, place: Place) -> usize {
        let nearest = |distances: &[f64]| distances.iter().copied().fold(f64::INFINITY, f64::min);
        let count = match (self, place.location_m) {
            (Structure::Beam(beam), Some(Location::Along(x_m))) => {
                let waves = Waves::new(beam, x_m).ok().flatten();
                waves.map_or(0.0, |waves| waves.resolving_reflection())
            }
            (Structure::TautString(string), Some(Location::Along(x_m))) => {
                string.length_m / nearest(&[x_m, string.length_m - x_m])
            }
            (Structure::Plate(plate), Some(Location::On([x_m, y_m]))) => {
                let distance_m = nearest(&[x_m, plate.length_m - x_m, y_m, plate.width_m - y_m]);
                // Weyl's law
                0.25 * PI * (plate.length_m / distance_m) * (plate.width_m / distance_m)
            }
            _ => 0.0,
        };
        let most = if let Structure::Beam(_) = self { MOST_NEAR_REFLECTION } else { MOST_IN_CLOSED_FORM };
        // on the end itself the shapes neither grow nor decrease
        if count.is_finite() { count.ceil().clamp(0.0, most as f64) as usize } else { 0 }
    }

    /// Remainder modes in place of all modes beyond the first `kept` of those `known`, for a structure with this static compliance.
    /// They have the damping of the last retained mode. A list without a retained elastic mode has none.
    pub(crate) fn remainder(&self, known: &[Mode], kept: usize, whole_m_n: f64) -> Result<Vec<Mode>, InvalidInput> {
        let (first, tail) = known.split_at_checked(kept).unwrap_or((known, &[]));
        let answered = compliance(first);
        // if both are computed, a negative difference is due to rounding
        if !self.is_computed() && whole_m_n < answered * (1.0 - ROUNDING) {
            let allowed = format!("not less than the static compliance of the retained modes, {answered:e}");
            return Err(InvalidInput::new(["structure", "static_compliance_m_n"], format!("{whole_m_n:e}"), allowed));
        }
        if !self.is_computed() && whole_m_n - answered <= COMPLETE * answered {
            return Ok(Vec::new());
        }
        let count = match self {
            Structure::Beam(beam) if beam.solved_by()? == BeamTheory::EulerBernoulli => OF_SLENDER_BEAM,
            _ => MOST_REMAINDER_MODES,
        };
        let elastic = |modes: &[Mode]| -> Vec<PointMode> {
            let elastic = modes.iter().filter(|mode| mode.omega_rad_s > 0.0);
            elastic.map(|mode| PointMode { omega_rad_s: mode.omega_rad_s, shape: mode.shape }).collect()
        };
        let (first, tail) = (elastic(first), elastic(tail));
        let remainder = if tail.is_empty() {
            remainder_from_trend(&first, whole_m_n - answered, count)
        } else {
            remainder_modes(&tail, (whole_m_n - compliance(known)).max(0.0), count)
        };
        let remainder = remainder.map_err(|fault| {
            let allowed = "a structure whose modes and static compliance double precision holds";
            InvalidInput { field: "structure".into(), allowed: allowed.to_owned(), ..fault }
        })?;
        let last = known[..kept.min(known.len())].last().or(known.first());
        let damping_ratio = last.map_or(0.0, |mode| mode.damping_ratio);
        Ok(modal::Structure::from_modes(remainder, damping_ratio).modes)
    }
}

/// Static compliance of the elastic ones of these modes in ascending order of frequency (m/N).
pub(crate) fn compliance(modes: &[Mode]) -> f64 {
    let elastic = modes.iter().filter(|mode| mode.omega_rad_s > 0.0);
    // summed from the smallest term: the remainder is the small difference from the whole, and decisive for a light striker
    elastic.rev().map(|mode| (mode.shape / mode.omega_rad_s).powi(2)).fold(0.0, |sum, one| sum + one)
}

/// Inverse mass of the rigid ones of these modes at the location (1/kg).
pub(crate) fn rigid_mobility(modes: &[Mode]) -> f64 {
    modes.iter().filter(|mode| mode.omega_rad_s == 0.0).map(|mode| mode.shape.powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `sum 1/k^4` is `pi^4/90`, and beyond `n` it is `1/(3 n^3) - 1/(2 n^4) + 1/(3 n^5)`.
    #[test]
    fn what_many_modes_lack_of_the_whole_compliance_is_not_lost_by_rounding() {
        let n = 1400.0f64;
        let mode = |k: i32| Mode { omega_rad_s: f64::from(k).powi(2), damping_ratio: 0.0, shape: 1.0 };
        let modes: Vec<Mode> = (1..=1400).map(mode).collect();
        let lacking = PI.powi(4) / 90.0 - compliance(&modes);
        let beyond = 1.0 / (3.0 * n.powi(3)) - 0.5 / n.powi(4) + 1.0 / (3.0 * n.powi(5));
        assert!((lacking - beyond).abs() < 2.0 * f64::EPSILON, "{lacking:e} {beyond:e}");
    }
}
