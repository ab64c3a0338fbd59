//! The contract between a law and an integrator.

use crate::internal::Internal;

/// A half plane of the `(xi, xi_dot)` plane in which a branch is valid:
/// `per_compression * xi + per_rate * xi_dot >= level`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Boundary {
    /// Coefficient of the compression.
    pub per_compression: f64,
    /// Coefficient of the rate of compression (same unit as `per_compression` times seconds).
    pub per_rate: f64,
    /// The value at which the state is on the boundary.
    pub level: f64,
}

impl Boundary {
    /// A boundary that is never reached.
    pub const NEVER: Boundary = Boundary { per_compression: 0.0, per_rate: 0.0, level: -1.0 };

    /// The branch ends when the compression decreases to `level_m`.
    pub const fn compression_falls_to(level_m: f64) -> Boundary {
        Boundary { per_compression: 1.0, per_rate: 0.0, level: level_m }
    }

    /// The branch ends when the compression increases to `level_m`.
    pub const fn compression_rises_to(level_m: f64) -> Boundary {
        Boundary { per_compression: -1.0, per_rate: 0.0, level: -level_m }
    }

    /// The branch ends when the rate decreases to `level_m_s` (0: end of loading).
    pub const fn rate_falls_to(level_m_s: f64) -> Boundary {
        Boundary { per_compression: 0.0, per_rate: 1.0, level: level_m_s }
    }

    /// The branch ends when the rate increases to `level_m_s` (0: end of unloading).
    pub const fn rate_rises_to(level_m_s: f64) -> Boundary {
        Boundary { per_compression: 0.0, per_rate: -1.0, level: -level_m_s }
    }

    /// Signed distance to the boundary, positive inside the branch.
    pub fn margin(&self, compression_m: f64, rate_m_s: f64) -> f64 {
        self.per_compression * compression_m + self.per_rate * rate_m_s - self.level
    }
}

/// The kind of a smooth branch, by which the law distinguishes its branches and others can read them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Stage {
    /// The only curve of the law, valid for loading and unloading alike.
    Single,
    /// Compression increases on a curve that differs from unloading.
    Loading,
    /// Compression decreases on a curve that differs from loading.
    Unloading,
    /// The formula would give tension; the force is zero while the surfaces recover.
    Slack,
    /// A kind of branch of the law's own, by a number that only the law interprets.
    Own(u8),
}

/// One smooth branch of a law, with the numbers that the law needs to evaluate it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Branch {
    /// The kind of branch.
    pub stage: Stage,
    /// Compression at which the branch began (m), where the law needs it.
    pub anchor_m: f64,
    /// The law's internal variables that determine the branch; each law states their meaning.
    pub internal: Internal,
}

/// The variables that outlast a contact: all zero for a fresh surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Memory {
    /// Compression at which the surfaces touch (m): zero, or the permanent indentation.
    pub touch_m: f64,
    /// The law's internal variables that outlast a contact; each law states their meaning.
    pub internal: Internal,
}

/// The transition when a branch reaches one of its boundaries.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum After {
    /// The contact continues on another branch.
    Continue(Branch),
    /// The surfaces separate, with this memory.
    Release(Memory),
}

/// Contact force and its two partial derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Force {
    /// Force (N).
    pub force_n: f64,
    /// Derivative with respect to the compression (N/m).
    pub per_compression_n_m: f64,
    /// Derivative with respect to the rate of compression (N s/m).
    pub per_rate_n_s_m: f64,
}

impl Force {
    /// No force, no stiffness.
    pub const ZERO: Force = Force { force_n: 0.0, per_compression_n_m: 0.0, per_rate_n_s_m: 0.0 };
}

/// A force-compression law with smooth branches, which threads may evaluate at the same time.
pub trait ContactLaw: Send + Sync {
    /// The branch on which a contact begins if surfaces with this memory meet at `approach_speed_m_s` (the rate of compression
    /// at first touch, not negative).
    fn touch(&self, memory: &Memory, approach_speed_m_s: f64) -> Branch;

    /// Force and derivatives on a branch. Outside the branch's boundaries it returns a finite, continuous extension, so that an
    /// iteration may step over them. On a branch the force depends on the rate either wherever it is not zero or nowhere, which
    /// an integrator takes from `per_rate_n_s_m`.
    fn force(&self, branch: &Branch, compression_m: f64, rate_m_s: f64) -> Force;

    /// [`ContactLaw::force`] at several compressions and rates, by one call and with the same results.
    fn forces(&self, branch: &Branch, compressions_m: &[f64], rates_m_s: &[f64], forces: &mut [Force]) {
        for (force, (compression_m, rate_m_s)) in forces.iter_mut().zip(compressions_m.iter().zip(rates_m_s)) {
            *force = self.force(branch, *compression_m, *rate_m_s);
        }
    }

    /// Energy (J) that the contact would return if it were unloaded from here slowly and without reversal until it releases.
    /// The rest of the work of the bodies is dissipated.
    fn stored_energy_j(&self, branch: &Branch, compression_m: f64) -> f64;

    /// The half planes within which the branch is valid, numbered from zero: `None` after the last. A branch may begin on one
    /// of them (unloading begins where the rate is zero): the boundary is reached when its margin becomes negative.
    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary>;

    /// The transition when boundary number `which` is reached at this compression and rate.
    fn cross(&self, branch: &Branch, which: usize, compression_m: f64, rate_m_s: f64) -> After;
}

/// The largest number of boundaries of a branch; a law with more would have no last boundary.
pub const MOST_BOUNDARIES: usize = 256;

/// All boundaries of a branch, in the order of their numbers, up to [`MOST_BOUNDARIES`].
pub fn boundaries<L: ContactLaw + ?Sized>(law: &L, branch: &Branch) -> impl Iterator<Item = Boundary> {
    (0..MOST_BOUNDARIES).map_while(move |which| law.boundary(branch, which))
}

/// References, boxes and shared pointers to a law are laws themselves.
macro_rules! stands_for_a_law {
    ($($stand_in:ty),*) => {$(
        impl<L: ContactLaw + ?Sized> ContactLaw for $stand_in {
            fn touch(&self, memory: &Memory, approach_speed_m_s: f64) -> Branch {
                (**self).touch(memory, approach_speed_m_s)
            }

            fn force(&self, branch: &Branch, compression_m: f64, rate_m_s: f64) -> Force {
                (**self).force(branch, compression_m, rate_m_s)
            }

            fn forces(&self, branch: &Branch, compressions_m: &[f64], rates_m_s: &[f64], forces: &mut [Force]) {
                (**self).forces(branch, compressions_m, rates_m_s, forces);
            }

            fn stored_energy_j(&self, branch: &Branch, compression_m: f64) -> f64 {
                (**self).stored_energy_j(branch, compression_m)
            }

            fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
                (**self).boundary(branch, which)
            }

            fn cross(&self, branch: &Branch, which: usize, compression_m: f64, rate_m_s: f64) -> After {
                (**self).cross(branch, which, compression_m, rate_m_s)
            }
        }
    )*};
}
stands_for_a_law!(&L, Box<L>, std::sync::Arc<L>);
