//! Parameters of a law from a required restitution.
//!
//! Two bodies that collide centrally satisfy the equation of one striker at a wall, whose mass is their reduced mass
//!
//! ```text
//! m = m_1 m_2 / (m_1 + m_2).                                                      (1)
//! ```
//!
//! The damping follows from the restitution alone, by the exact relation of each law, and the stiffness from the maximum
//! compression. With `alpha = D v0` and `L(x) = x - ln(1 + x)` the maximum compression of the laws `k xi^n (1 + D xi')` is that
//! at which the rate is zero,
//!
//! ```text
//! k xi_m^(n+1) / (n+1) = m v0^2 L(alpha) / alpha^2,                               (2)
//! ```
//!
//! and for spring and dashpot, with `omega^2 = k/m` and `zeta = c / (2 m omega)`, from their linear equation of motion,
//!
//! ```text
//! omega xi_m = v0 exp(-zeta acos(zeta) / sqrt(1 - zeta^2)) = v0 sqrt(e).          (3)
//! ```
//!
//! MuJoCo states the same spring and dashpot per unit of mass. Its force is never tensile, so that it ends before the gap
//! opens, and with a constant impedance (`solimp` with two equal first numbers) the contact has
//!
//! ```text
//! timeconst = 1 / (zeta omega),   dampratio = zeta,                               (4)
//! e = exp(-2 zeta acos(zeta) / sqrt(1 - zeta^2)).                                 (5)
//! ```
//!
//! The usual formula `e = exp(-pi zeta / sqrt(1 - zeta^2))` lets the dashpot pull until the gap opens
//! ([`damping_ratio_if_it_pulled`]).

use crate::{Flores, HuntCrossley, KelvinVoigt, LankaraniNikravesh, Law, LinearSpring};

use crate::range::{require_positive, require_restitution};
use crate::{damped, kelvin_voigt};
use invalid_input::InvalidInput;

/// Requirements on a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Wanted {
    /// Speed of separation over speed of approach, from 0.001 to 1.
    pub restitution: f64,
    /// Mass of the striker, or [reduced mass](reduced_mass_kg) of two bodies (kg).
    pub mass_kg: f64,
    /// Speed of approach (m/s).
    pub speed_m_s: f64,
    /// Maximum compression of the bodies (m).
    pub compression_m: f64,
}

/// Parameters of a contact in MuJoCo, for a constant impedance.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Solref {
    /// `timeconst` (s); infinite without damping, which only the direct form can represent.
    pub time_constant_s: f64,
    /// `dampratio`.
    pub damping_ratio: f64,
    /// Stiffness per mass (1/s^2), which has a minus sign in the direct form of `solref`.
    pub stiffness_per_s2: f64,
    /// Damping per mass (1/s), with a minus sign too.
    pub damping_per_s: f64,
}

/// The reduced mass of two bodies (1). One of them may be immovable: its mass is infinite.
///
/// # Errors
/// A mass that is not positive; two immovable bodies.
pub fn reduced_mass_kg(first_kg: f64, second_kg: f64) -> Result<f64, InvalidInput> {
    let immovable = |mass_kg: f64| mass_kg == f64::INFINITY;
    for mass_kg in [first_kg, second_kg] {
        if !immovable(mass_kg) {
            require_positive("mass_kg", mass_kg)?;
        }
    }
    let one_moves = !(immovable(first_kg) && immovable(second_kg));
    InvalidInput::unless(one_moves, "mass_kg", second_kg, "finite for at least one of the two bodies")?;
    // The mass of a striker at an immovable body is not rounded.
    let light = first_kg.min(second_kg);
    Ok(light / (1.0 + light / first_kg.max(second_kg)))
}

/// The damping ratio from the usual formula `e = exp(-pi zeta / sqrt(1 - zeta^2))`, for a dashpot that pulls until the gap
/// opens.
///
/// # Errors
/// A restitution outside 0.001 to 1.
pub fn damping_ratio_if_it_pulled(restitution: f64) -> Result<f64, InvalidInput> {
    require_restitution("restitution", restitution)?;
    let decrement = -restitution.ln();
    Ok(decrement / std::f64::consts::PI.hypot(decrement))
}

/// The damping ratio of spring and dashpot that do not pull, from a restitution (5).
///
/// # Errors
/// A restitution outside 0.001 to 1.
pub fn damping_ratio(restitution: f64) -> Result<f64, InvalidInput> {
    require_restitution("restitution", restitution)?;
    Ok(kelvin_voigt::damping_ratio(restitution))
}

impl Wanted {
    /// The requirements if they are in range.
    ///
    /// # Errors
    /// A restitution outside 0.001 to 1; a mass, speed or compression that is not positive.
    pub fn validated(self) -> Result<Wanted, InvalidInput> {
        require_restitution("restitution", self.restitution)?;
        require_positive("mass_kg", self.mass_kg)?;
        require_positive("speed_m_s", self.speed_m_s)?;
        require_positive("compression_m", self.compression_m)?;
        Ok(self)
    }

    /// Spring and dashpot; without losses the [`LinearSpring`].
    ///
    /// # Errors
    /// As [`Wanted::validated`]; a resulting stiffness beyond the range of the crate.
    pub fn kelvin_voigt(&self) -> Result<Law, InvalidInput> {
        let Solref { stiffness_per_s2, damping_per_s, .. } = self.solref()?;
        let (stiffness, damping) = (stiffness_per_s2 * self.mass_kg, damping_per_s * self.mass_kg);
        if damping == 0.0 {
            return LinearSpring::new(stiffness).map(Law::from);
        }
        KelvinVoigt::new(stiffness, damping).map(Law::from)
    }

    /// Spring and dashpot in the form of MuJoCo.
    ///
    /// # Errors
    /// As [`Wanted::validated`].
    pub fn solref(&self) -> Result<Solref, InvalidInput> {
        self.validated()?;
        let zeta = kelvin_voigt::damping_ratio(self.restitution);
        let omega = self.speed_m_s * self.restitution.sqrt() / self.compression_m;
        Ok(Solref {
            time_constant_s: 1.0 / (zeta * omega),
            damping_ratio: zeta,
            stiffness_per_s2: omega * omega,
            damping_per_s: 2.0 * zeta * omega,
        })
    }

    /// Hunt and Crossley's law with this exponent.
    ///
    /// # Errors
    /// As [`Wanted::kelvin_voigt`]; an exponent outside 1 to 6.
    pub fn hunt_crossley(&self, exponent: f64) -> Result<HuntCrossley, InvalidInput> {
        let stiffness = self.damped_stiffness(exponent)?;
        HuntCrossley::with_restitution(stiffness, exponent, self.restitution, self.speed_m_s)
    }

    /// The law of Flores and others.
    ///
    /// # Errors
    /// As [`Wanted::kelvin_voigt`].
    pub fn flores(&self) -> Result<Flores, InvalidInput> {
        Flores::with_restitution(self.damped_stiffness(1.5)?, self.restitution)
    }

    /// Lankarani and Nikravesh's law, whose lowest restitution is 0.663.
    ///
    /// # Errors
    /// As [`Wanted::kelvin_voigt`]; a restitution below the range of the law.
    pub fn lankarani_nikravesh(&self) -> Result<LankaraniNikravesh, InvalidInput> {
        LankaraniNikravesh::with_restitution(self.damped_stiffness(1.5)?, self.restitution)
    }

    /// The stiffness of a damped power law (2).
    fn damped_stiffness(&self, exponent: f64) -> Result<f64, InvalidInput> {
        self.validated()?;
        let energy_j = self.mass_kg * self.speed_m_s * self.speed_m_s * damped::share_stored(self.restitution);
        Ok((exponent + 1.0) * energy_j / self.compression_m.powf(exponent + 1.0))
    }
}
