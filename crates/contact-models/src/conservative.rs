//! The common part of the elastic laws `F = k <xi>^n`: one branch, no dissipation, released at `xi = 0`.

use crate::range::bounded;

/// The differences between these laws.
pub(crate) trait Conservative {
    /// Exponent `n`.
    fn exponent(&self) -> f64;

    /// Force (N) and slope (N/m) at a compression (m), and a continuation below zero.
    fn curve(&self, compression_m: f64) -> (f64, f64);
}

/// Implements the contract for a [`Conservative`] law.
macro_rules! conservative_law {
    ($law:ty) => {
        impl $law {
            /// Rebound speed over approach speed of a rigid striker at a wall.
            pub(crate) fn wall_restitution(&self, _mass_kg: f64, _speed_m_s: f64) -> f64 {
                1.0
            }
        }

        impl $crate::ContactLaw for $law {
            fn touch(&self, _memory: &$crate::Memory, _approach_speed_m_s: f64) -> $crate::Branch {
                $crate::Branch { stage: $crate::Stage::Single, anchor_m: 0.0, internal: $crate::Internal::NONE }
            }

            fn force(&self, _branch: &$crate::Branch, compression_m: f64, _rate_m_s: f64) -> $crate::Force {
                let (force_n, per_compression_n_m) = $crate::conservative::Conservative::curve(self, compression_m);
                $crate::Force { force_n, per_compression_n_m, per_rate_n_s_m: 0.0 }
            }

            fn stored_energy_j(&self, _branch: &$crate::Branch, compression_m: f64) -> f64 {
                $crate::conservative::stored_energy_j(self, compression_m)
            }

            fn boundary(&self, _branch: &$crate::Branch, which: usize) -> Option<$crate::Boundary> {
                (which == 0).then_some($crate::Boundary::compression_falls_to(0.0))
            }

            fn cross(&self, _branch: &$crate::Branch, _which: usize, _xi: f64, _rate: f64) -> $crate::After {
                $crate::After::Release($crate::Memory::default())
            }
        }
    };
}
pub(crate) use conservative_law;

/// `k xi^(n+1) / (n+1)`.
pub(crate) fn stored_energy_j(law: &impl Conservative, compression_m: f64) -> f64 {
    let xi = bounded(compression_m).max(0.0);
    law.curve(xi).0 * xi / (law.exponent() + 1.0)
}

/// `k <xi>^n` and its derivative with respect to `xi`, for `n >= 1`.
pub(crate) fn power_of(k: f64, n: f64, compression_m: f64) -> (f64, f64) {
    let xi = bounded(compression_m).max(0.0);
    // The square root is several times faster than a general power.
    let lower = if n == 1.5 { xi.sqrt() } else { xi.powf(n - 1.0) };
    (k * lower * xi, n * k * lower)
}
