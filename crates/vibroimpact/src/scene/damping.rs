//! One damping ratio for all modes.

use invalid_input::InvalidInput;
use vibroimpact_sim::modal::Mode;

use super::fields;
use super::told::number;

/// Accepts a damping ratio of a structure.
pub(super) fn require_damping(damping_ratio: f64) -> Result<(), InvalidInput> {
    if (0.0..=fields::MOST_DAMPING).contains(&damping_ratio) {
        return Ok(());
    }
    let allowed = fields::allowed("damping_ratio").unwrap_or_default();
    Err(InvalidInput::new(["structure", "damping_ratio"], number(damping_ratio), allowed))
}

/// Modes of one damping ratio, from frequencies and shapes.
pub(super) fn shapes_as_modes(omega_rad_s: &[f64], shapes: Vec<f64>, damping_ratio: f64) -> Vec<Mode> {
    omega_rad_s.iter().zip(shapes).map(|(&omega_rad_s, shape)| Mode { omega_rad_s, damping_ratio, shape }).collect()
}
