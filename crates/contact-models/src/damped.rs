//! The common part of the laws `F = k <xi>^n (1 + D xi_dot)`.
//!
//! The viscous law of the thesis, Hunt-Crossley, Lankarani-Nikravesh and Flores differ only in the choice of the damping factor
//! `D` (s/m). While surfaces separate faster than `1/D` the formula would give tension; there the force is zero
//! ([`Stage::Slack`]).
//!
//! Against a wall the striker satisfies `m v dv/dxi = -k xi^n (1 + D v)`. After separation of the variables, the elastic side
//! is the same for loading and unloading, so that approach speed `v0` and rebound speed `e v0` satisfy, for any mass, stiffness
//! and exponent (Marhefka and Orin, *IEEE Trans. Syst. Man Cybern. A* 29 (1999) 566),
//!
//! ```text
//! L(alpha) = L(-alpha e),   L(x) = x - ln(1 + x),   alpha = D v0.
//! ```
//!
//! It follows that `alpha e < 1`: a free striker never reaches tension.

use crate::conservative::power_of;
use crate::range::{bounded, require_positive, require_restitution};
use crate::{After, Boundary, Branch, Force, Memory, Stage};
use invalid_input::InvalidInput;

/// The differences between these laws.
pub(crate) trait Damped {
    /// Stiffness `k` (N/m^n).
    fn stiffness(&self) -> f64;

    /// Exponent `n`.
    fn exponent(&self) -> f64 {
        1.5
    }

    /// Damping factor `D` (s/m) of a contact that begins at this speed.
    fn damping_s_m(&self, approach_speed_m_s: f64) -> f64;
}

/// Implements the contract for a [`Damped`] law. The branch's internal variable is `D`.
macro_rules! damped_law {
    ($law:ty) => {
        impl $law {
            /// Rebound speed over approach speed of a rigid striker at a wall.
            pub(crate) fn wall_restitution(&self, _mass_kg: f64, speed_m_s: f64) -> f64 {
                $crate::damped::restitution(self.damping_s_m(speed_m_s) * speed_m_s)
            }
        }

        impl $crate::ContactLaw for $law {
            fn touch(&self, _memory: &$crate::Memory, approach_speed_m_s: f64) -> $crate::Branch {
                let internal = [self.damping_s_m(approach_speed_m_s)].into();
                $crate::Branch { stage: $crate::Stage::Single, anchor_m: 0.0, internal }
            }

            fn force(&self, branch: &$crate::Branch, compression_m: f64, rate_m_s: f64) -> $crate::Force {
                $crate::damped::force(self, branch, compression_m, rate_m_s)
            }

            fn stored_energy_j(&self, _branch: &$crate::Branch, compression_m: f64) -> f64 {
                $crate::damped::stored_energy_j(self, compression_m)
            }

            fn boundary(&self, branch: &$crate::Branch, which: usize) -> Option<$crate::Boundary> {
                $crate::damped::boundary(branch, which)
            }

            fn cross(&self, branch: &$crate::Branch, which: usize, _xi: f64, _rate: f64) -> $crate::After {
                $crate::damped::cross(branch, which)
            }
        }
    };
}
pub(crate) use damped_law;

/// Default approach speed (m/s) below which a damping factor proportional to `1/v0` stays constant.
pub(crate) const LOWEST_APPROACH_SPEED_M_S: f64 = 1e-6;

/// The damping factor `D` (s/m) from a rule `alpha(e)`, after a check of `e` and the speed.
pub(crate) fn calibrated(e: f64, speed_m_s: f64, alpha: impl Fn(f64) -> f64) -> Result<f64, InvalidInput> {
    require_restitution("restitution", e)?;
    require_positive("speed_m_s", speed_m_s)?;
    Ok(alpha(e) / speed_m_s)
}

/// `k <xi>^n` and its derivative.
fn elastic(law: &impl Damped, compression_m: f64) -> (f64, f64) {
    power_of(law.stiffness(), law.exponent(), compression_m)
}

/// The branch's `D` (s/m).
fn damping_of(branch: &Branch) -> f64 {
    let [damping_s_m] = branch.internal.into();
    damping_s_m
}

/// Force on the branch.
pub(crate) fn force(law: &impl Damped, branch: &Branch, compression_m: f64, rate_m_s: f64) -> Force {
    if branch.stage == Stage::Slack {
        return Force::ZERO;
    }
    let (f, slope) = elastic(law, compression_m);
    let damping_s_m = damping_of(branch);
    let factor = 1.0 + damping_s_m * bounded(rate_m_s);
    Force { force_n: f * factor, per_compression_n_m: slope * factor, per_rate_n_s_m: f * damping_s_m }
}

/// Energy in the spring.
pub(crate) fn stored_energy_j(law: &impl Damped, compression_m: f64) -> f64 {
    elastic(law, compression_m).0 * bounded(compression_m).max(0.0) / (law.exponent() + 1.0)
}

/// The contact ends at `xi = 0`; the boundary between pressing and slack is `1 + D xi_dot = 0`.
pub(crate) fn boundary(branch: &Branch, which: usize) -> Option<Boundary> {
    let side = if branch.stage == Stage::Slack { -1.0 } else { 1.0 };
    match which {
        0 => Some(Boundary::compression_falls_to(0.0)),
        1 => Some(Boundary { per_compression: 0.0, per_rate: side * damping_of(branch), level: -side }),
        _ => None,
    }
}

pub(crate) fn cross(branch: &Branch, which: usize) -> After {
    if which == 0 {
        return After::Release(Memory::default());
    }
    let stage = if branch.stage == Stage::Slack { Stage::Single } else { Stage::Slack };
    After::Continue(Branch { stage, ..*branch })
}

/// `L(x) = x - ln(1 + x)` for `x > -1`, without cancellation near zero.
fn log_excess(x: f64) -> f64 {
    if x.abs() > 0.1 {
        return x - x.ln_1p();
    }
    // x^2/2 - x^3/3 + x^4/4 - ...
    (2..=17).rev().fold(0.0, |sum, n| 1.0 / f64::from(n) - x * sum) * x * x
}

/// The restitution at a wall for `alpha = D v0`.
pub(crate) fn restitution(alpha: f64) -> f64 {
    if alpha < 1e-8 {
        return 1.0 - 2.0 / 3.0 * alpha;
    }
    // With alpha e = 1 - exp(-w): L(-alpha e) = w - 1 + exp(-w), which is convex, so that Newton's iteration decreases
    // monotonically towards w after its first step.
    let target = log_excess(alpha);
    let mut w = (2.0 * target).sqrt();
    for _ in 0..100 {
        let y = -(-w).exp_m1();
        // Below 1 the logarithm of 1 - y is w to rounding, and the series avoids w - y.
        let value = if y < 0.1 { log_excess(-y) } else { w - y };
        let step = (value - target) / y;
        w -= step;
        if step.abs() <= 1e-16 * w {
            break;
        }
    }
    -(-w).exp_m1() / alpha
}

/// The `alpha = D v0` that gives the restitution `e` at a wall, `0 < e <= 1`.
pub(crate) fn damping_ratio(e: f64) -> f64 {
    // Bisection on y = alpha e in (0, 1), where the residual decreases through zero once.
    let residual = |y: f64| log_excess(y / e) - log_excess(-y);
    let (mut low, mut high) = (0.0, 1.0);
    if e >= 1.0 {
        return 0.0;
    }
    for _ in 0..200 {
        let y = 0.5 * (low + high);
        if y <= low || y >= high {
            break;
        }
        *(if residual(y) > 0.0 { &mut low } else { &mut high }) = y;
    }
    0.5 * (low + high) / e
}

/// The share `L(alpha)/alpha^2` of `m v0^2` that the spring stores at the maximum compression, for a restitution `e`.
pub(crate) fn share_stored(e: f64) -> f64 {
    let alpha = damping_ratio(e);
    if alpha == 0.0 { 0.5 } else { log_excess(alpha) / (alpha * alpha) }
}
