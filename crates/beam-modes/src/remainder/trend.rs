//! A remainder mode where nothing but the residual compliance is known of the modes left out.

use super::{PointMode, require_compliance, require_mode};
use crate::error::InvalidInput;

/// How fast frequencies may grow with their number: from a little above what an infinite compliance needs to bending.
const EXPONENTS: [f64; 2] = [0.75, 2.0];
/// Modes beyond the last that the trend is summed over; the integral takes the rest.
const TERMS: usize = 64;

/// One remainder mode for a structure that is known by listed modes and its static compliance only (measured, or from
/// finite elements), or `None` where nothing is left out or no listed mode is elastic.
///
/// `modes` are all modes kept, as seen from the point; rigid-body ones have `omega_rad_s = 0`.
/// `residual_compliance_m_n` is the static compliance that they lack, and is matched exactly. The second moment is an
/// estimate: frequencies beyond the last are assumed to grow by the power of their number that the upper half of the
/// listed ones shows (2 in bending, 1 for shear and strings), with shapes of one mean square.
///
/// ```
/// use beam_modes::{PointMode, remainder_from_trend};
/// let mode = |k: i32| PointMode { omega_rad_s: 160.0 * f64::from(k * k), shape: 1.0 };
/// let kept: Vec<PointMode> = (1..=10).map(mode).collect();
/// let remainder = remainder_from_trend(&kept, 1e-9)?.unwrap();
/// assert!(remainder.omega_rad_s > 16_000.0);
/// assert!(((remainder.shape / remainder.omega_rad_s).powi(2) / 1e-9 - 1.0).abs() < 1e-12);
/// # Ok::<(), beam_modes::InvalidInput>(())
/// ```
///
/// # Errors
/// [`InvalidInput`] for frequencies, shapes or a compliance that are negative, not finite or beyond 1e60.
pub fn remainder_from_trend(
    modes: &[PointMode],
    residual_compliance_m_n: f64,
) -> Result<Option<PointMode>, InvalidInput> {
    let elastic = |mode: &&PointMode| mode.omega_rad_s != 0.0;
    for (k, mode) in modes.iter().enumerate().filter(|(_, mode)| elastic(mode)) {
        require_mode(&format!("modes[{k}]"), mode.omega_rad_s, &[mode.shape])?;
    }
    let compliance = require_compliance(residual_compliance_m_n)
        .map_err(|fault| InvalidInput { field: "residual_compliance_m_n".into(), ..fault })?;
    let mut omega_rad_s: Vec<f64> = modes.iter().filter(elastic).map(|mode| mode.omega_rad_s).collect();
    omega_rad_s.sort_by(f64::total_cmp);
    let n = omega_rad_s.len();
    if n == 0 || compliance == 0.0 {
        return Ok(None);
    }
    let half = n.div_ceil(2);
    let growth = (omega_rad_s[n - 1] / omega_rad_s[half - 1]).ln() / (n as f64 / half as f64).ln();
    // one mode alone shows no trend
    let exponent = if growth.is_finite() { growth.clamp(EXPONENTS[0], EXPONENTS[1]) } else { EXPONENTS[1] };

    // sum over k > n of (n/k)^power, and the integral from where the sum ends
    let sum = |power: f64| {
        let term = |k: usize| (n as f64 / k as f64).powf(power);
        let beyond = (n + TERMS) as f64 + 0.5;
        (n + 1..=n + TERMS).map(term).sum::<f64>() + beyond / (power - 1.0) * (n as f64 / beyond).powf(power)
    };
    let omega = omega_rad_s[n - 1] * (sum(2.0 * exponent) / sum(4.0 * exponent)).sqrt();
    Ok(Some(PointMode { omega_rad_s: omega, shape: compliance.sqrt() * omega }))
}
