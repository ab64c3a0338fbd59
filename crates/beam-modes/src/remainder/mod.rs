//! A few *remainder modes* that respond to a force as all truncated modes of a model do.
//!
//! At one point, the truncated modes `k > N` are the spectral measure with the weights `phi_k^2 / omega_k^2` at
//! `x_k = 1 / omega_k^2`; its moments are
//!
//! ```text
//! m_j = sum_{k > N} phi_k^2 / omega_k^(2 j),      j = 1, 2, ...
//! ```
//!
//! `m_1` is the residual static compliance (residual flexibility), `m_2` the residual inertia (R. H. MacNeal, Comput. Struct.
//! 1:581, 1971; S. Rubin, AIAA J. 13:995, 1975). The Gauss quadrature with `n` nodes `X_r` and weights `W_r` matches the first
//! `2 n` moments. It corresponds to `n` modes, `omega_r = X_r^(-1/2)` and `phi_r = (W_r / X_r)^(1/2)`, which respond to every
//! force slower than themselves as the whole tail does, and add no algebraic equation to the model. Their frequencies are above
//! those of the modes that are not truncated.
//!
//! For modes that do not come from a solved beam, [`remainder_from_trend`] makes remainder modes from the residual compliance
//! and the growth of the known frequencies. Several points of one body need one common set of modes: [`remainder_at_points`].

mod beam;
mod points;
mod quadrature;
mod trend;

pub use beam::enough_for_remainder;
pub use points::{PointsMode, remainder_at_points};
pub use trend::remainder_from_trend;

use crate::point_mode::PointMode;
use invalid_input::InvalidInput;
use quadrature::{Atom, gauss_quadrature, power_law_atoms};

/// Largest number of remainder modes: more gain nothing because of the rounding of the moments.
pub const MOST_REMAINDER_MODES: usize = 4;

/// The `count` remainder modes (1 to 4) of the truncated modes, in ascending order of frequency; fewer if the tail has fewer
/// frequencies, none if the point does not move in it.
///
/// `tail` contains the modes `N+1 .. M` that were computed but are truncated. `static_rest_m_n` is the static compliance of the
/// modes beyond `M`, `G(x,x) - sum_{k <= M} phi_k^2/omega_k^2`. It is distributed over frequencies above the highest of `tail`
/// by the law of shear waves, which have evenly spaced frequencies and equal shapes, and for which the compliance beyond
/// `omega` decreases as `1/omega`. In bending it decreases as `omega^(-3/2)`, but the small rest beyond `M` may be distributed
/// by either law. The first moment is exact in any case.
///
/// ```
/// use beam_modes::{PointMode, remainder_modes};
/// // the tail of a pinned beam beyond ten modes, at its middle
/// let mode = |k: i32| PointMode {
///     omega_rad_s: 160.0 * f64::from(k * k),
///     shape: if k % 2 == 0 { 0.0 } else { 1.414 },
/// };
/// let tail: Vec<PointMode> = (11..=200).map(mode).collect();
/// let remainder = remainder_modes(&tail, 0.0, 2)?;
/// let compliance = |modes: &[PointMode]| modes.iter().map(|m| (m.shape / m.omega_rad_s).powi(2)).sum::<f64>();
/// assert_eq!(remainder.len(), 2);
/// assert!((compliance(&remainder) / compliance(&tail) - 1.0).abs() < 1e-12);
/// # Ok::<(), beam_modes::InvalidInput>(())
/// ```
///
/// # Errors
/// [`InvalidInput`] for a `count` other than 1 to 4, for frequencies that are not positive, for a compliance that is negative,
/// for numbers that are not finite or beyond 1e60, and for a compliance beyond an empty `tail`.
pub fn remainder_modes(tail: &[PointMode], static_rest_m_n: f64, count: usize) -> Result<Vec<PointMode>, InvalidInput> {
    require_count(count)?;
    for (k, mode) in tail.iter().enumerate() {
        require_mode(mode.omega_rad_s, &[mode.shape]).map_err(|fault| fault.at(k).within("tail"))?;
    }
    let Some(highest) = highest(tail.iter().map(|mode| mode.omega_rad_s)) else {
        return match require_compliance("static_rest_m_n", static_rest_m_n)? {
            0.0 => Ok(Vec::new()),
            rest => Err(InvalidInput::new("static_rest_m_n", rest, "0, because the list tail is empty")),
        };
    };
    let mut atoms: Vec<Atom> = tail
        .iter()
        .map(|mode| Atom { x: (highest / mode.omega_rad_s).powi(2), weight: (mode.shape / mode.omega_rad_s).powi(2) })
        .collect();
    match require_compliance("static_rest_m_n", static_rest_m_n)? {
        0.0 => {}
        rest => atoms.extend(power_law_atoms(ASYMPTOTIC_GROWTH, rest, MOST_REMAINDER_MODES)),
    }
    Ok(from_atoms(gauss_quadrature(&atoms, count), highest))
}

/// Mean of `1/omega^2` over the compliance beyond `omega_M` by the law of shear waves, in units of `1/omega_M^2`.
const ASYMPTOTIC_MEAN: f64 = 1.0 / 3.0;

/// By that law the frequencies grow as this power of their index.
const ASYMPTOTIC_GROWTH: f64 = 1.0;

/// The modes of a quadrature in `(unit / omega)^2`, from the lowest.
fn from_atoms(atoms: Vec<Atom>, unit_rad_s: f64) -> Vec<PointMode> {
    let mode = |atom: Atom| {
        let omega_rad_s = unit_rad_s / atom.x.sqrt();
        PointMode { omega_rad_s, shape: atom.weight.sqrt() * omega_rad_s }
    };
    let mut modes: Vec<PointMode> = atoms.into_iter().map(mode).collect();
    modes.sort_by(|a, b| a.omega_rad_s.total_cmp(&b.omega_rad_s));
    modes
}

fn require_count(count: usize) -> Result<(), InvalidInput> {
    if (1..=MOST_REMAINDER_MODES).contains(&count) {
        Ok(())
    } else {
        Err(InvalidInput::new("count", count, "a number from 1 to 4"))
    }
}

fn highest(omega_rad_s: impl Iterator<Item = f64>) -> Option<f64> {
    omega_rad_s.max_by(f64::total_cmp)
}

fn require_mode(omega_rad_s: f64, shapes: &[f64]) -> Result<(), InvalidInput> {
    const ALLOWED: &str = "a number from 1e-60 to 1e60";
    if !(1e-60..=1e60).contains(&omega_rad_s) {
        return Err(InvalidInput::new("omega_rad_s", omega_rad_s, ALLOWED));
    }
    match shapes.iter().find(|shape| shape.is_nan() || shape.abs() > 1e60) {
        Some(shape) => Err(InvalidInput::new("shape", *shape, "a number of at most 1e60 in size")),
        None => Ok(()),
    }
}

fn require_compliance(field: &'static str, compliance_m_n: f64) -> Result<f64, InvalidInput> {
    if (0.0..=1e60).contains(&compliance_m_n) {
        Ok(compliance_m_n)
    } else {
        Err(InvalidInput::new(field, compliance_m_n, "a number from 0 to 1e60"))
    }
}
