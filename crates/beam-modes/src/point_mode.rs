//! Modes as excited by a force at one point.

/// A mode at one point of the structure.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct PointMode {
    /// Natural frequency, rad/s.
    pub omega_rad_s: f64,
    /// Mass-normalised shape at the point, kg^(-1/2).
    pub shape: f64,
}

/// Modes with these frequencies and shapes.
pub(crate) fn point_modes(omega_rad_s: &[f64], shapes: Vec<f64>) -> Vec<PointMode> {
    omega_rad_s.iter().zip(shapes).map(|(&omega_rad_s, shape)| PointMode { omega_rad_s, shape }).collect()
}
