//! The thesis's rate-independent contact hysteresis.

use crate::quadrature::power_moment;
use crate::range::{LARGEST, SMALLEST, bounded, require_not_negative, require_positive};
use crate::{After, Boundary, Branch, ContactLaw, Force, Memory, Stage};
use invalid_input::InvalidInput;

/// `F = k_H <xi>^(3/2) (1 + theta)` (thesis Eq. 3.16), where the internal variable varies between `theta_m - beta` and
/// `theta_m + beta`.
///
/// Source: thesis Eqs. 3.16 and 3.17, after S. Biswas, P. Jana and A. Chatterjee, *Int. J. Mech. Sci.* 108-109 (2016) 61. As
/// printed, Eq. 3.17 has a factor `<xi>`, with which `K` would have the unit 1/m, nothing would be singular at `xi = 0`, and
/// the stated parameters would give almost no dissipation instead of a restitution of 0.95. This crate omits the factor, for
/// `xi > 0`:
///
/// ```text
/// theta' = K (theta_m + beta sign(xi') - theta) |xi'| / (xi + eps).
/// ```
///
/// Between reversals `theta` is then a function of `xi`, determined by its value `theta_a` at the branch's anchor `xi_a`:
///
/// ```text
/// loading    theta = theta_m + beta + (theta_a - theta_m - beta) ((xi_a + eps)/(xi + eps))^K
/// unloading  theta = theta_m - beta + (theta_a - theta_m + beta) ((xi + eps)/(xi_a + eps))^K
/// ```
///
/// Every contact begins at `theta = theta_m + beta`, independently of earlier contacts. The thesis states this for each
/// sub-impact (section 3.3.4, second footnote), and it is the limit of small `eps`, in which loading from `xi = 0` removes the
/// influence of the initial `theta` immediately. The first loading is therefore Hertz contact with stiffness
/// `k_H (1 + theta_m + beta)`; to obtain a given Hertz stiffness, divide it by that factor (by 4 in the thesis). Valid where
/// damping does not depend on the rate and leaves no indentation. Tension: none, `F = 0` only at `xi = 0`. For `eps -> 0` the
/// restitution at a wall does not depend on the speed; with `eps` it decreases slightly as the speed grows.
///
/// Complete contacts dissipate energy; single minor loops need not: while `theta < theta_m`, a small loop of loading and
/// unloading raises `theta`, and returns slightly more work than it received. The stored energy is a quadrature of some
/// microseconds, the force a single power.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Hysteretic {
    /// Stiffness `k_H` (N/m^1.5).
    pub stiffness_n_m1_5: f64,
    /// Centre `theta_m` of the internal variable.
    pub theta_m: f64,
    /// Half width `beta` of the internal variable's range.
    pub beta: f64,
    /// How fast the internal variable follows the compression, the thesis's `K` with a bar.
    pub k_bar: f64,
    /// Regularisation `eps` (m) at `xi = 0`; zero stands for its limit.
    pub epsilon_m: f64,
}

impl Hysteretic {
    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// A stiffness, `theta_m` or `K` that is not positive (`K` at most 1000), a negative `beta` or `eps`, or
    /// `beta > 1 + theta_m`, for which the force would be tensile.
    pub fn validated(self) -> Result<Hysteretic, InvalidInput> {
        require_positive("theta_m", self.theta_m)?;
        let pushes = (0.0..=1.0 + self.theta_m).contains(&self.beta);
        InvalidInput::unless(pushes, "beta", self.beta, "a number from 0 to 1 + theta_m")?;
        let in_range = (SMALLEST..=1000.0).contains(&self.k_bar);
        InvalidInput::unless(in_range, "k_bar", self.k_bar, "a number greater than 0 (from 1e-30 to 1000)")?;
        require_not_negative("epsilon_m", self.epsilon_m)?;
        // last, since a scene may have it from materials and the width of the loop
        require_positive("stiffness_n_m1_5", self.stiffness_n_m1_5)?;
        Ok(self)
    }

    /// The limit of `theta` on this branch.
    fn goal(&self, stage: Stage) -> f64 {
        self.theta_m + if stage == Stage::Unloading { -self.beta } else { self.beta }
    }

    /// `xi + eps` where `xi >= 0`.
    fn shifted(&self, xi: f64) -> f64 {
        xi + self.epsilon_m.max(SMALLEST)
    }

    /// The limit of `1 + theta` on this branch: exactly zero for unloading where `beta` is `1 + theta_m`.
    fn floor(&self, stage: Stage) -> f64 {
        1.0 + self.theta_m + if stage == Stage::Unloading { -self.beta } else { self.beta }
    }

    /// The distance of `theta` from its limit, and its derivative with respect to `xi`. The limit may be the one without a force, so
    /// that their sum would lose the digits of a small force. Before the anchor, where the branch is not valid, it is continued by its
    /// tangent.
    fn distance(&self, branch: &Branch, xi: f64) -> (f64, f64) {
        let [theta_a] = branch.internal.into();
        let distance = theta_a - self.goal(branch.stage);
        let (anchor, here) = (self.shifted(branch.anchor_m), self.shifted(xi));
        let (sign, ratio) = if branch.stage == Stage::Unloading { (1.0, here / anchor) } else { (-1.0, anchor / here) };
        if ratio <= 1.0 {
            let share = ratio.powf(self.k_bar);
            (distance * share, sign * self.k_bar * distance * share / here)
        } else {
            let slope = sign * self.k_bar * distance / anchor;
            (distance + slope * (here - anchor), slope)
        }
    }

    /// Rebound speed over approach speed of a rigid striker at a wall.
    pub(crate) fn wall_restitution(&self, mass_kg: f64, speed_m_s: f64) -> f64 {
        let loading = self.touch(&Memory::default(), speed_m_s);
        let energy = 0.5 * mass_kg * speed_m_s * speed_m_s;
        let peak = (2.5 * energy / (self.stiffness_n_m1_5 * (1.0 + self.goal(Stage::Loading)))).powf(0.4);
        (self.stored_energy_j(&loading, peak) / energy).sqrt()
    }
}

impl ContactLaw for Hysteretic {
    /// The branch's internal variable is `theta` at the anchor.
    fn touch(&self, _memory: &Memory, _approach_speed_m_s: f64) -> Branch {
        Branch { stage: Stage::Loading, anchor_m: 0.0, internal: [self.goal(Stage::Loading)].into() }
    }

    fn force(&self, branch: &Branch, compression_m: f64, _rate_m_s: f64) -> Force {
        let xi = bounded(compression_m);
        if xi <= 0.0 {
            return Force::ZERO;
        }
        let (distance, slope) = self.distance(branch, xi);
        let factor = self.floor(branch.stage) + distance;
        let root = self.stiffness_n_m1_5 * xi.sqrt();
        Force {
            force_n: root * xi * factor,
            per_compression_n_m: root * (1.5 * factor + xi * slope),
            per_rate_n_s_m: 0.0,
        }
    }

    fn stored_energy_j(&self, branch: &Branch, compression_m: f64) -> f64 {
        let xi = bounded(compression_m);
        if xi <= 0.0 {
            return 0.0;
        }
        // Unloading from here: 1 + theta = floor + excess ((s + eps)/(xi + eps))^K at s < xi.
        let floor = self.floor(Stage::Unloading);
        let excess = self.floor(branch.stage) - floor + self.distance(branch, xi).0;
        let eps = self.shifted(0.0);
        let moment = power_moment((eps / xi).min(LARGEST), self.k_bar);
        self.stiffness_n_m1_5 * xi * xi * xi.sqrt() * (0.4 * floor + excess * moment)
    }

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        match (branch.stage, which) {
            (Stage::Unloading, 0) => Some(Boundary::compression_falls_to(0.0)),
            (Stage::Unloading, 1) => Some(Boundary::rate_rises_to(0.0)),
            (Stage::Loading, 0) => Some(Boundary::rate_falls_to(0.0)),
            _ => None,
        }
    }

    fn cross(&self, branch: &Branch, which: usize, compression_m: f64, _rate_m_s: f64) -> After {
        if branch.stage == Stage::Unloading && which == 0 {
            return After::Release(Memory::default());
        }
        let xi = bounded(compression_m).max(0.0);
        let stage = if branch.stage == Stage::Unloading { Stage::Loading } else { Stage::Unloading };
        let theta = self.goal(branch.stage) + self.distance(branch, xi).0;
        After::Continue(Branch { stage, anchor_m: xi, internal: [theta].into() })
    }
}
