//! A string under tension.

use invalid_input::InvalidInput;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vibroimpact_sim::modal::{Mode, Structure};

use super::damping::require_damping;

/// A uniform string between two pinned ends, [`beam_modes::TautString`].
///
/// ```
/// use vibroimpact::scene::TautString;
///
/// // C4 of a grand piano
/// let string = TautString { length_m: 0.62, tension_n: 670.0, mass_per_length_kg_m: 3.93e-3 / 0.62, ..TautString::default() };
/// assert!((string.to_taut_string().modes(1)?.omega_rad_s()[0] - 1647.5).abs() < 1.0);
/// # Ok::<(), vibroimpact::beam_modes::InvalidInput>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TautString {
    /// Length between the ends (m).
    pub length_m: f64,
    /// Tension (N).
    pub tension_n: f64,
    /// Mass per length (kg/m).
    pub mass_per_length_kg_m: f64,
    /// Flexural rigidity `EI` of a string that resists bending (N m^2); 0 when left out.
    #[serde(default)]
    pub flexural_rigidity_n_m2: f64,
    /// Damping ratio of every mode; 0 when left out.
    #[serde(default)]
    pub damping_ratio: f64,
}

impl TautString {
    /// The string as input of [`beam_modes`].
    pub fn to_taut_string(&self) -> beam_modes::TautString {
        let TautString { length_m, tension_n, mass_per_length_kg_m, flexural_rigidity_n_m2, .. } = *self;
        beam_modes::TautString { length_m, tension_n, mass_per_length_kg_m, flexural_rigidity_n_m2 }
    }

    /// The first `count` modes at a location.
    pub(super) fn modes(&self, location_m: f64, count: usize) -> Result<Vec<Mode>, InvalidInput> {
        require_damping(self.damping_ratio).map_err(|fault| fault.within("structure"))?;
        let modes = self.to_taut_string().modes(count).map_err(in_structure)?;
        let seen = modes.seen_from(location_m).map_err(in_structure)?;
        Ok(Structure::from_modes(seen, self.damping_ratio).modes)
    }

    /// Participation of the first `count` modes in a uniform acceleration (kg^1/2).
    pub(super) fn participation_kg0_5(&self, count: usize) -> Result<Vec<f64>, InvalidInput> {
        Ok(self.to_taut_string().modes(count).map_err(in_structure)?.participation_kg0_5())
    }

    /// Static compliance at a location (m/N).
    pub(super) fn static_compliance_m_n(&self, location_m: f64) -> Result<f64, InvalidInput> {
        self.to_taut_string().static_compliance(location_m).map_err(in_structure)
    }

    /// Frequency of mode `n` without stiffness (rad/s), and mean contribution of `n` modes to the inverse mass of a location
    /// (1/kg).
    pub(crate) fn estimate(&self, n: usize) -> (f64, f64) {
        let mass = self.mass_per_length_kg_m * self.length_m;
        let omega =
            std::f64::consts::PI * n as f64 * (self.tension_n / self.mass_per_length_kg_m).sqrt() / self.length_m;
        (omega, n as f64 / mass)
    }
}

fn in_structure(fault: InvalidInput) -> InvalidInput {
    match fault.field.first() {
        Some("x_m") => fault.under("location_m"),
        Some("count") => fault.under("modes"),
        _ => fault.within("structure"),
    }
}
