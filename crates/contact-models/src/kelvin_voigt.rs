//! Spring and dashpot in parallel.

use crate::range::{bounded, require_positive};
use crate::{After, Boundary, Branch, ContactLaw, Force, Internal, Memory, Stage};
use invalid_input::InvalidInput;

/// `F = k xi + c xi_dot` where this is not negative.
///
/// Source: T. Schwager and T. Poschel, *Granular Matter* 9 (2007) 465, who treat the end of the contact in the same way. Valid
/// as a simple model with a restitution that does not depend on the speed; its force jumps to `c v0` at first touch, which no
/// material shows. Tension: the formula would give tension before the compression is zero. There the force is zero and the
/// surface recovers behind the striker (slack); the contact resumes where `k xi + c xi_dot` is positive again, and ends at
/// `xi = 0`. With `zeta = c / (2 sqrt(k m))` the restitution at a wall is
///
/// ```text
/// e = exp(-2 zeta acos(zeta) / sqrt(1 - zeta^2)),   beyond zeta = 1 with acosh and zeta^2 - 1.
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct KelvinVoigt {
    /// Stiffness `k` (N/m).
    pub stiffness_n_m: f64,
    /// Damping `c` (N s/m).
    pub damping_n_s_m: f64,
}

impl KelvinVoigt {
    /// The law with stiffness `k` (N/m) and damping `c` (N s/m).
    ///
    /// # Errors
    /// A parameter that is not positive; without damping, use [`LinearSpring`](crate::LinearSpring).
    pub fn new(stiffness_n_m: f64, damping_n_s_m: f64) -> Result<KelvinVoigt, InvalidInput> {
        KelvinVoigt { stiffness_n_m, damping_n_s_m }.validated()
    }

    /// The law whose restitution at a wall is `restitution` for a striker of this mass, at any speed. The closed relation is
    /// solved to rounding.
    ///
    /// # Errors
    /// A restitution outside 0.001 to 1 or equal to 1, a stiffness or mass that is not positive.
    pub fn with_restitution(stiffness_n_m: f64, restitution: f64, mass_kg: f64) -> Result<KelvinVoigt, InvalidInput> {
        require_positive("stiffness_n_m", stiffness_n_m)?;
        require_positive("mass_kg", mass_kg)?;
        let allowed = "a coefficient of restitution from 0.001 to below 1";
        InvalidInput::unless((0.001..1.0).contains(&restitution), "restitution", restitution, allowed)?;
        KelvinVoigt::new(stiffness_n_m, 2.0 * damping_ratio(restitution) * (stiffness_n_m * mass_kg).sqrt())
    }

    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// As [`KelvinVoigt::new`].
    pub fn validated(self) -> Result<KelvinVoigt, InvalidInput> {
        require_positive("stiffness_n_m", self.stiffness_n_m)?;
        require_positive("damping_n_s_m", self.damping_n_s_m)?;
        Ok(self)
    }

    /// Rebound speed over approach speed of a rigid striker at a wall.
    pub(crate) fn wall_restitution(&self, mass_kg: f64, _speed_m_s: f64) -> f64 {
        restitution_at(0.5 * self.damping_n_s_m / (self.stiffness_n_m * mass_kg).sqrt())
    }
}

/// Half planes of a law that presses where `per_compression xi + per_rate xi_dot > 0` and recovers elsewhere (slack).
pub(crate) fn recovering_boundary(
    branch: &Branch,
    which: usize,
    per_compression: f64,
    per_rate: f64,
) -> Option<Boundary> {
    let formula =
        |side: f64| Some(Boundary { per_compression: side * per_compression, per_rate: side * per_rate, level: 0.0 });
    match (branch.stage, which) {
        (Stage::Slack, 0) => Some(Boundary::compression_falls_to(0.0)),
        (Stage::Slack, 1) => formula(-1.0),
        // The formula becomes negative before the compression is zero.
        (Stage::Single, 0) => formula(1.0),
        _ => None,
    }
}

/// Transitions at these boundaries.
pub(crate) fn cross_recovering(branch: &Branch, which: usize) -> After {
    match (branch.stage, which) {
        (Stage::Slack, 0) => After::Release(Memory::default()),
        (Stage::Slack, _) => After::Continue(Branch { stage: Stage::Single, ..*branch }),
        _ => After::Continue(Branch { stage: Stage::Slack, ..*branch }),
    }
}

/// Restitution at a wall as a function of the damping ratio `zeta`.
fn restitution_at(zeta: f64) -> f64 {
    let root = ((1.0 - zeta).abs() * (1.0 + zeta)).sqrt();
    if root == 0.0 {
        return (-2.0_f64).exp();
    }
    // acosh(zeta) = ln(zeta + root), whose argument is near 1 at critical damping
    let angle = if zeta < 1.0 { zeta.acos() } else { (zeta - 1.0 + root).ln_1p() };
    (-2.0 * zeta * angle / root).exp()
}

/// The damping ratio `zeta` that gives the restitution at a wall, `0.001 <= restitution <= 1`.
pub(crate) fn damping_ratio(restitution: f64) -> f64 {
    if restitution >= 1.0 {
        return 0.0;
    }
    // Bisection on zeta, of which the restitution is a decreasing function: e(0) = 1, e(20) < 0.001.
    let (mut low, mut high) = (0.0, 20.0);
    for _ in 0..200 {
        let zeta = 0.5 * (low + high);
        if zeta <= low || zeta >= high {
            break;
        }
        *(if restitution_at(zeta) > restitution { &mut low } else { &mut high }) = zeta;
    }
    0.5 * (low + high)
}

impl ContactLaw for KelvinVoigt {
    fn touch(&self, _memory: &Memory, _approach_speed_m_s: f64) -> Branch {
        Branch { stage: Stage::Single, anchor_m: 0.0, internal: Internal::NONE }
    }

    fn force(&self, branch: &Branch, compression_m: f64, rate_m_s: f64) -> Force {
        if branch.stage == Stage::Slack {
            return Force::ZERO;
        }
        let (k, c) = (self.stiffness_n_m, self.damping_n_s_m);
        let force_n = k * bounded(compression_m) + c * bounded(rate_m_s);
        Force { force_n, per_compression_n_m: k, per_rate_n_s_m: c }
    }

    fn stored_energy_j(&self, _branch: &Branch, compression_m: f64) -> f64 {
        let xi = bounded(compression_m).max(0.0);
        0.5 * self.stiffness_n_m * xi * xi
    }

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        recovering_boundary(branch, which, self.stiffness_n_m, self.damping_n_s_m)
    }

    fn cross(&self, branch: &Branch, which: usize, _compression_m: f64, _rate_m_s: f64) -> After {
        cross_recovering(branch, which)
    }
}
