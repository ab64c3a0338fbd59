//! Thornton's elastic, perfectly plastic contact.

use crate::pair::{Body, effective_modulus_pa, effective_radius_m};
use crate::range::{bounded, require_positive};
use crate::{After, Boundary, Branch, ContactLaw, Force, Internal, Memory, Stage};
use invalid_input::InvalidInput;
use std::f64::consts::PI;

/// Hertz up to yield, a straight line beyond, and Hertz with a larger radius on unloading, which leaves a permanent
/// indentation.
///
/// Source: C. Thornton, *J. Appl. Mech.* 64 (1997) 383. With `E*`, `R*` and the contact pressure
/// `p_y` at which yield begins:
///
/// ```text
/// first yield   xi_y = (pi p_y / (2 E*))^2 R*,  F_y = (4/3) E* sqrt(R*) xi_y^(3/2)
/// loading       F = F_y + pi p_y R* (xi - xi_y)
/// unloading     F = F_max ((xi - xi_p) / delta)^(3/2),  xi_p = xi_max - delta,
///               delta = 3 F_max / (4 E* a),  a^2 = (2 F_max + F_y) / (2 pi p_y)
/// ```
///
/// The unloading line is Hertz's law for Thornton's radius `R_p = (4 E* / (3 F_max)) a^3`, expressed by the variables of the
/// branch. Force and slope are continuous at first yield. Contact after release begins at the indentation `xi_p`, follows the
/// last unloading line, and yields again beyond `xi_max`. Valid for moderate plastic deformation without hardening or rate
/// effects; the indentation belongs to one point, so that every contact of a striker with this memory is at the same location.
/// Tension: none.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Thornton {
    /// Effective modulus `E*` (Pa).
    pub effective_modulus_pa: f64,
    /// Effective radius `R*` (m).
    pub effective_radius_m: f64,
    /// Contact pressure `p_y` at first yield (Pa), about 1.6 times the yield strength.
    pub yield_pressure_pa: f64,
}

/// Least ratio of yield pressure and effective modulus. The recovery is about this share of the compression, or more by the root
/// of radius over compression, so that six digits of it are left.
const LEAST_YIELD: f64 = 1e-9;

impl Thornton {
    /// The law from `E*` (Pa), `R*` (m) and `p_y` (Pa).
    ///
    /// # Errors
    /// A parameter that is not positive; a yield pressure below 1e-9 of the effective modulus, for which the compression that is
    /// recovered on unloading is lost to rounding.
    pub fn new(
        effective_modulus_pa: f64,
        effective_radius_m: f64,
        yield_pressure_pa: f64,
    ) -> Result<Thornton, InvalidInput> {
        Thornton { effective_modulus_pa, effective_radius_m, yield_pressure_pa }.validated()
    }

    /// The law of two spheres, the softer of which yields at the pressure `p_y` (Pa).
    ///
    /// # Errors
    /// As [`Thornton::new`] and [`Hertz::from_bodies`](crate::Hertz::from_bodies).
    pub fn from_bodies(first: &Body, second: &Body, yield_pressure_pa: f64) -> Result<Thornton, InvalidInput> {
        Thornton::new(effective_modulus_pa(first, second)?, effective_radius_m(first, second)?, yield_pressure_pa)
    }

    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// As [`Thornton::new`].
    pub fn validated(self) -> Result<Thornton, InvalidInput> {
        require_positive("effective_modulus_pa", self.effective_modulus_pa)?;
        require_positive("effective_radius_m", self.effective_radius_m)?;
        require_positive("yield_pressure_pa", self.yield_pressure_pa)?;
        let least = LEAST_YIELD * self.effective_modulus_pa;
        InvalidInput::unless(self.yield_pressure_pa >= least, "yield_pressure_pa", self.yield_pressure_pa, {
            format!("at least {least:e} (1e-9 of the effective modulus), below which the recovery is lost to rounding")
        })?;
        Ok(self)
    }

    /// Compression at first yield `xi_y` (m).
    pub fn yield_compression_m(&self) -> f64 {
        (PI * self.yield_pressure_pa / (2.0 * self.effective_modulus_pa)).powi(2) * self.effective_radius_m
    }

    /// Force at first yield `F_y` (N).
    pub fn yield_force_n(&self) -> f64 {
        let xi_y = self.yield_compression_m();
        4.0 / 3.0 * self.effective_modulus_pa * (self.effective_radius_m * xi_y).sqrt() * xi_y
    }

    /// Speed (m/s) at a wall above which a striker of this mass leaves an indentation.
    ///
    /// # Errors
    /// A mass that is not positive.
    pub fn yield_speed_m_s(&self, mass_kg: f64) -> Result<f64, InvalidInput> {
        require_positive("mass_kg", mass_kg)?;
        Ok((0.8 * self.yield_force_n() / mass_kg * self.yield_compression_m()).sqrt())
    }

    fn plastic_slope(&self) -> f64 {
        PI * self.yield_pressure_pa * self.effective_radius_m
    }

    /// Force on the loading line.
    fn loading_force(&self, xi: f64) -> f64 {
        self.yield_force_n() + self.plastic_slope() * (xi - self.yield_compression_m())
    }

    /// Compression that is recovered on unloading from this largest compression, `delta` (m).
    fn recovery(&self, xi_max: f64) -> f64 {
        let force = self.loading_force(xi_max);
        let a = ((2.0 * force + self.yield_force_n()) / (2.0 * PI * self.yield_pressure_pa)).sqrt();
        0.75 * force / (self.effective_modulus_pa * a)
    }

    /// The elastic line through the point of the loading line at `xi_max`; up to first yield, Hertz.
    fn elastic(&self, xi_max: f64) -> Branch {
        let has_yielded = xi_max > self.yield_compression_m();
        let anchor_m = if has_yielded { (xi_max - self.recovery(xi_max)).max(0.0) } else { 0.0 };
        let internal = if has_yielded { [xi_max].into() } else { Internal::NONE };
        Branch { stage: Stage::Single, anchor_m, internal }
    }

    /// The compression at which an elastic branch yields.
    fn yields_at_m(&self, branch: &Branch) -> f64 {
        let [xi_max] = branch.internal.into();
        xi_max.max(self.yield_compression_m())
    }

    /// Rebound speed over approach speed of a rigid striker at a wall.
    pub(crate) fn wall_restitution(&self, mass_kg: f64, speed_m_s: f64) -> f64 {
        let (xi_y, f_y) = (self.yield_compression_m(), self.yield_force_n());
        let energy = 0.5 * mass_kg * speed_m_s * speed_m_s;
        let plastic = energy - 0.4 * f_y * xi_y;
        if plastic <= 0.0 {
            return 1.0;
        }
        // F_y x + slope x^2 / 2 = plastic
        let root = f_y.hypot((2.0 * self.plastic_slope() * plastic).sqrt());
        let xi_max = xi_y + 2.0 * plastic / (f_y + root);
        (0.4 * self.loading_force(xi_max) * self.recovery(xi_max) / energy).sqrt()
    }
}

impl ContactLaw for Thornton {
    /// On an elastic branch (`Single`) the anchor is the indentation `xi_p` and the internal variable is the largest
    /// compression so far, or 0 before first yield: `xi_y` belongs to the law, and changes with its parameters. The memory consists of
    /// the same two numbers.
    fn touch(&self, memory: &Memory, _approach_speed_m_s: f64) -> Branch {
        let [xi_max] = memory.internal.into();
        self.elastic(bounded(xi_max))
    }

    fn force(&self, branch: &Branch, compression_m: f64, _rate_m_s: f64) -> Force {
        let xi = bounded(compression_m);
        if branch.stage == Stage::Loading {
            let per_compression_n_m = self.plastic_slope();
            return Force { force_n: self.loading_force(xi), per_compression_n_m, per_rate_n_s_m: 0.0 };
        }
        let xi_max = self.yields_at_m(branch);
        let delta = xi_max - branch.anchor_m;
        let share = (xi - branch.anchor_m).max(0.0) / delta;
        let force = self.loading_force(xi_max) * share.sqrt();
        Force { force_n: force * share, per_compression_n_m: 1.5 * force / delta, per_rate_n_s_m: 0.0 }
    }

    fn stored_energy_j(&self, branch: &Branch, compression_m: f64) -> f64 {
        let xi = bounded(compression_m);
        if branch.stage == Stage::Loading {
            let xi = xi.max(self.yield_compression_m());
            return 0.4 * self.loading_force(xi) * self.recovery(xi);
        }
        0.4 * self.force(branch, xi, 0.0).force_n * (xi - branch.anchor_m).max(0.0)
    }

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        match (branch.stage, which) {
            (Stage::Loading, 0) => Some(Boundary::rate_falls_to(0.0)),
            (Stage::Single, 0) => Some(Boundary::compression_falls_to(branch.anchor_m)),
            (Stage::Single, 1) => Some(Boundary::compression_rises_to(self.yields_at_m(branch))),
            _ => None,
        }
    }

    fn cross(&self, branch: &Branch, which: usize, compression_m: f64, _rate_m_s: f64) -> After {
        match (branch.stage, which) {
            (Stage::Loading, _) => After::Continue(self.elastic(bounded(compression_m))),
            (_, 0) => After::Release(Memory { touch_m: branch.anchor_m, internal: branch.internal }),
            _ => {
                let [anchor_m] = branch.internal.into();
                After::Continue(Branch { stage: Stage::Loading, anchor_m, internal: Internal::NONE })
            }
        }
    }
}
