//! Motion before the impact.

use invalid_input::InvalidInput;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vibroimpact_sim::modal::Mode;

use super::fields;
use super::json::{number, objects};
use super::location::Location;
use super::place::Place;

/// Motion of the structure at the start, and distance of the striker. Displacements and velocities are positive towards
/// the striker. Motions that are given in different fields are added.
///
/// The restitution of such an impact is, as always, the relative speed of separation over that of approach, both of
/// the rigid-body motions. Vibration does not count as approach; for a structure without rigid-body modes only the
/// striker's speeds count, so that a structure that swings towards the striker can give it a restitution above 1. Without an
/// approach of the rigid-body motions there is no restitution.
///
/// ```
/// use vibroimpact::scene::{MovingMode, Start};
///
/// // the first mode moves at 0.2 m/s towards the striker where it will be struck
/// let start = Start { moving_modes: vec![MovingMode { mode: 1, velocity_m_s: 0.2, ..MovingMode::default() }], ..Start::default()
/// };
/// # assert_eq!(start.gap_m, 0.0);
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// Distance from the striker to the structure's deflected surface (m); 0, touching, when left out.
    #[serde(default)]
    pub gap_m: f64,
    /// Amplitudes of the first mass-normalised modes (m kg^1/2), where modes are listed in the order of the list; those of the rest
    /// are 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub amplitude_m_kg0_5: Vec<f64>,
    /// Their rates (m kg^1/2 / s); those of the rest are 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rate_m_kg0_5_s: Vec<f64>,
    /// Modes whose motion is given at a location.
    #[serde(default, deserialize_with = "objects", skip_serializing_if = "Vec::is_empty")]
    pub moving_modes: Vec<MovingMode>,
}

impl Start {
    /// Whether the structure moves or is deflected; otherwise the start is a gap alone.
    pub(crate) fn moves(&self) -> bool {
        let Start { gap_m: _, amplitude_m_kg0_5, rate_m_kg0_5_s, moving_modes } = self;
        !(amplitude_m_kg0_5.is_empty() && rate_m_kg0_5_s.is_empty() && moving_modes.is_empty())
    }
}

/// The motion of one mode, given at a location where the mode moves.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MovingMode {
    /// Number of the mode, from 1 for the lowest (a rigid-body mode, where there is one).
    pub mode: usize,
    /// Location on a beam, string or plate (m), as the scene's `location_m`; the point of impact when left out.
    pub location_m: Option<Location>,
    /// Name of the point of a modal structure; the point of impact when left out.
    pub location: Option<String>,
    /// Displacement there (m); 0 when left out.
    #[serde(default)]
    pub displacement_m: f64,
    /// Velocity there (m/s); 0 when left out.
    #[serde(default)]
    pub velocity_m_s: f64,
}

/// Values of the first modes, where modes are listed in the order of the list, as those of `count` modes by ascending frequency; the
/// others are 0. `ranks` are those of the structure.
pub(crate) fn by_frequency(
    field: &str,
    first: &[f64],
    count: usize,
    ranks: Option<&[usize]>,
) -> Result<Vec<f64>, InvalidInput> {
    if first.len() > count {
        let allowed = format!("a list of at most {count} values, the number of modes");
        return Err(InvalidInput::new(field, format!("{} values", first.len()), allowed));
    }
    let mut all = vec![0.0; count];
    for (k, value) in first.iter().enumerate() {
        let rank = ranks.and_then(|ranks| ranks.get(k).copied()).unwrap_or(k);
        match all.get_mut(rank) {
            Some(of_mode) => *of_mode = *value,
            None if *value == 0.0 => {}
            None => {
                let allowed = format!("0, because this mode is not one of the {count} lowest of the list");
                return Err(InvalidInput::new((field, k), number(*value), allowed));
            }
        }
    }
    Ok(all)
}

/// A mode whose shape at the location is below this share of the largest one has a node there.
const NODE: f64 = 1e-9;

impl MovingMode {
    /// The location at which the mode's motion is stated.
    pub(super) fn place<'a>(&'a self, here: Place<'a>) -> Place<'a> {
        match (self.location_m, self.location.as_deref()) {
            (None, None) => here,
            (location_m, location) => Place { location_m, location },
        }
    }

    /// The mode's index, and its shape at the location of `modes`.
    pub(crate) fn shape(&self, modes: &[Mode]) -> Result<(usize, f64), InvalidInput> {
        for (field, value) in [("displacement_m", self.displacement_m), ("velocity_m_s", self.velocity_m_s)] {
            if !value.is_finite() {
                return Err(InvalidInput::new(field, number(value), fields::allowed(field).unwrap_or_default()));
            }
        }
        let most = modes.iter().map(|mode| mode.shape.abs()).fold(0.0, f64::max);
        let fault = |allowed: String| InvalidInput::new("mode", self.mode.to_string(), allowed);
        let k = self.mode.checked_sub(1).filter(|&k| k < modes.len());
        let k = k.ok_or_else(|| fault(format!("a whole number from 1 to {}, the number of modes", modes.len())))?;
        let shape = modes[k].shape;
        if shape.abs() > NODE * most {
            Ok((k, shape))
        } else {
            Err(fault("the number of a mode that moves at the location; this mode has a node there".to_owned()))
        }
    }
}
