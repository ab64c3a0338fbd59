//! Strings under tension.

use crate::location::require_on;
use crate::modes::require_count;
use crate::point_mode::{PointMode, point_modes};
use invalid_input::InvalidInput;
use std::f64::consts::PI;

/// A uniform string between two pinned ends, with or without bending stiffness.
///
/// `T w'' - EI w'''' = m w_tt` with `w = w'' = 0` at both ends. The modes are sines for any stiffness (H. Fletcher, *J. Acoust.
/// Soc. Am.* 36 (1964) 203): with `k = n pi/L`,
///
/// ```text
/// omega^2 = (T k^2 + EI k^4)/m,      phi = sqrt(2/(m L)) sin k x.
/// ```
///
/// ```
/// use beam_modes::TautString;
///
/// // C4 of a grand piano, 262 Hz
/// let string = TautString { length_m: 0.62, tension_n: 670.0, mass_per_length_kg_m: 3.93e-3 / 0.62, flexural_rigidity_n_m2: 0.0 };
/// let modes = string.modes(10)?;
/// assert!((modes.omega_rad_s()[0] / std::f64::consts::TAU - 262.2).abs() < 0.1);
/// # Ok::<(), beam_modes::InvalidInput>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct TautString {
    /// Length between the ends (m).
    pub length_m: f64,
    /// Tension `T` (N).
    pub tension_n: f64,
    /// Mass per length `m` (kg/m).
    pub mass_per_length_kg_m: f64,
    /// Flexural rigidity `EI` (N m^2); 0 for a perfectly flexible string.
    pub flexural_rigidity_n_m2: f64,
}

/// Natural modes of a string, in ascending order of frequency, mass-normalised.
#[derive(Debug, Clone)]
pub struct TautStringModes {
    string: TautString,
    omega_rad_s: Vec<f64>,
}

impl TautString {
    fn checked(&self) -> Result<(), InvalidInput> {
        InvalidInput::require_positive("length_m", self.length_m)?;
        InvalidInput::require_positive("tension_n", self.tension_n)?;
        InvalidInput::require_positive("mass_per_length_kg_m", self.mass_per_length_kg_m)?;
        let rigidity = self.flexural_rigidity_n_m2;
        if !(rigidity >= 0.0 && rigidity.is_finite()) {
            return Err(InvalidInput::new("flexural_rigidity_n_m2", rigidity, "a finite number not less than 0"));
        }
        let sizes = [self.omega_rad_s(1), self.mass_per_length_kg_m * self.length_m, self.length_m / self.tension_n];
        if sizes.iter().all(|size| (1e-150..1e150).contains(size)) {
            Ok(())
        } else {
            let allowed = "part of a string whose modes double precision can represent";
            Err(InvalidInput::new("tension_n", self.tension_n, allowed))
        }
    }

    fn omega_rad_s(&self, n: usize) -> f64 {
        let k = n as f64 * PI / self.length_m;
        k * ((self.tension_n + self.flexural_rigidity_n_m2 * k * k) / self.mass_per_length_kg_m).sqrt()
    }

    /// The first `count` modes.
    ///
    /// # Errors
    /// [`InvalidInput`] for a length, tension or mass that is not positive, a negative rigidity, or a count beyond
    /// 100,000.
    pub fn modes(&self, count: usize) -> Result<TautStringModes, InvalidInput> {
        self.checked()?;
        require_count(count, 1)?;
        let omega_rad_s: Vec<f64> = (1..=count).map(|n| self.omega_rad_s(n)).collect();
        if omega_rad_s.iter().any(|omega| !omega.is_finite()) {
            return Err(InvalidInput::new(
                "flexural_rigidity_n_m2",
                self.flexural_rigidity_n_m2,
                "smaller, because with this rigidity double precision cannot resolve the modes",
            ));
        }
        Ok(TautStringModes { string: *self, omega_rad_s })
    }

    /// Static deflection at `x_m` under a unit load there, m/N: `x (L - x)/(T L)` without stiffness. With stiffness, for
    /// `lambda = sqrt(T/EI)`, `p = lambda x`, `q = lambda (L - x)` and Langevin's `L(p) = coth p - 1/p`,
    ///
    /// ```text
    /// G = (L(p) + L(q)) / (T lambda (1/p + 1/q)(coth p + coth q)),
    /// ```
    ///
    /// in which nothing cancels, even if only the stiffness carries the load.
    ///
    /// # Errors
    /// As [`TautString::modes`], and for a location outside the string.
    pub fn static_compliance(&self, x_m: f64) -> Result<f64, InvalidInput> {
        self.checked()?;
        let x = require_on("x_m", x_m, self.length_m)?;
        let rest = self.length_m - x;
        if x == 0.0 || rest == 0.0 {
            return Ok(0.0);
        }
        // without its sign a rigidity of -0 is 0
        let lambda = (self.tension_n / self.flexural_rigidity_n_m2.abs()).sqrt();
        let (p, q) = (lambda * x, lambda * rest);
        if p.min(q) > 1e8 {
            return Ok(x / self.tension_n * (rest / self.length_m)); // Stiffness below rounding.
        }
        let coth = |r: f64| 1.0 / r.tanh();
        let bent = (langevin(p) + langevin(q)) / ((1.0 / p + 1.0 / q) * (coth(p) + coth(q)));
        Ok(bent / (self.tension_n * lambda))
    }
}

/// `coth r - 1/r`.
fn langevin(r: f64) -> f64 {
    if r > 0.5 {
        return 1.0 / r.tanh() - 1.0 / r;
    }
    // r/(3 + r^2/(5 + r^2/(7 + ...)))
    let fraction = (1..12).rev().fold(0.0, |below, n| r * r / (f64::from(2 * n + 3) + below));
    r / (3.0 + fraction)
}

impl TautStringModes {
    /// Natural frequencies, rad/s.
    pub fn omega_rad_s(&self) -> &[f64] {
        &self.omega_rad_s
    }

    /// Shapes of all modes at `x_m`, kg^(-1/2).
    ///
    /// # Errors
    /// [`InvalidInput`] for a location outside the string.
    pub fn shapes_at(&self, x_m: f64) -> Result<Vec<f64>, InvalidInput> {
        let share = require_on("x_m", x_m, self.string.length_m)? / self.string.length_m;
        let size = (2.0 / (self.string.mass_per_length_kg_m * self.string.length_m)).sqrt();
        Ok((1..=self.omega_rad_s.len()).map(|n| size * sine_of(n, share)).collect())
    }

    /// All modes as excited by a force at `x_m`.
    ///
    /// # Errors
    /// As for [`shapes_at`](Self::shapes_at).
    pub fn seen_from(&self, x_m: f64) -> Result<Vec<PointMode>, InvalidInput> {
        Ok(point_modes(&self.omega_rad_s, self.shapes_at(x_m)?))
    }

    /// Participation `int m phi dx` of every mode in a uniform acceleration, kg^(1/2), as that of a beam: `sqrt(8 m L)/(n
    /// pi)` for odd `n`.
    pub fn participation_kg0_5(&self) -> Vec<f64> {
        let mass = self.string.mass_per_length_kg_m * self.string.length_m;
        (1..=self.omega_rad_s.len()).map(|n| (0.5 * mass).sqrt() * sine_mean(n) * 2.0).collect()
    }
}

/// The mean of `sin(n pi s)` over `0..1`.
pub(crate) fn sine_mean(n: usize) -> f64 {
    if n.is_multiple_of(2) { 0.0 } else { 2.0 / (n as f64 * PI) }
}

/// `sin(n pi s)`, exactly zero if `n s` is an integer.
pub(crate) fn sine_of(n: usize, s: f64) -> f64 {
    let turns = (n as f64 * s).rem_euclid(2.0);
    let (sign, turns) = if turns >= 1.0 { (-1.0, turns - 1.0) } else { (1.0, turns) };
    if turns == 0.0 { 0.0 } else { sign * (PI * turns.min(1.0 - turns)).sin() }
}
