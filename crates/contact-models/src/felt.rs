//! Felt of piano hammers: a power law with retarded recovery.

use crate::conservative::power_of;
use crate::kelvin_voigt::{cross_recovering, recovering_boundary};
use crate::range::{bounded, require_positive};
use crate::{After, Boundary, Branch, ContactLaw, Force, Internal, Memory, Stage};
use invalid_input::InvalidInput;

/// `F = Q0 (u^p + alpha d(u^p)/dt)` where this is not negative, with `u = <xi>`.
///
/// Source: A. Stulov, *Acta Mechanica* 169 (2004) 13, the three-parameter model of felt. It is the limit of his hereditary law
/// (*J. Acoust. Soc. Am.* 97 (1995) 2577) for contacts much longer than the relaxation time `tau0`,
/// `F = F0 [u^p - (eps/tau0) int_0^t u^p(s) exp((s - t)/tau0) ds]`, with `Q0 = F0 (1 - eps)` and `alpha = tau0 eps/(1 - eps)`.
/// Felt satisfies this condition, with `tau0` near 10 microseconds and contacts of a millisecond. The hereditary law itself
/// depends on the time since first touch and is not among the laws of this crate. Valid for piano hammers struck in playing,
/// with `p` between 2.5 and 5 and `alpha` up to some 0.3 ms.
///
/// Tension: while the hammer separates, the formula would give tension before the compression is zero. There the force is zero
/// and the felt recovers behind the string (slack), as for [`KelvinVoigt`](crate::KelvinVoigt), which is this law with `p = 1`;
/// the contact resumes where the formula is positive again, and ends at `xi = 0`. A striker at a wall satisfies, in units of
/// its speed and of the length `(m v^2 / Q0)^(1/(p+1))`, `x'' = -x^p - beta (x^p)'` with one number `beta`.
///
/// ```
/// use contact_models::{Felt, Law};
///
/// let hammer = Law::from(Felt::new(4.5e9, 2.5, 1e-4)?);
/// let (slow, fast) = (hammer.wall_restitution(2.97e-3, 0.5)?, hammer.wall_restitution(2.97e-3, 5.0)?);
/// assert!(fast < slow && slow < 1.0); // felt hardens with the speed
/// # Ok::<(), contact_models::InvalidInput>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Felt {
    /// Static stiffness `Q0` (N/m^p).
    pub stiffness_n_m_n: f64,
    /// Exponent `p`, from 2 to 6.
    pub exponent: f64,
    /// Retardation time `alpha` (s).
    pub retardation_time_s: f64,
}

impl Felt {
    /// The law with static stiffness `Q0` (N/m^p), exponent `p` and retardation time `alpha` (s).
    ///
    /// # Errors
    /// A stiffness or time that is not positive (use [`Power`](crate::Power) instead), or an exponent outside 2 to 6.
    pub fn new(stiffness_n_m_n: f64, exponent: f64, retardation_time_s: f64) -> Result<Felt, InvalidInput> {
        Felt { stiffness_n_m_n, exponent, retardation_time_s }.validated()
    }

    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// As [`Felt::new`].
    pub fn validated(self) -> Result<Felt, InvalidInput> {
        require_positive("stiffness_n_m_n", self.stiffness_n_m_n)?;
        InvalidInput::unless((2.0..=6.0).contains(&self.exponent), "exponent", self.exponent, "a number from 2 to 6")?;
        require_positive("retardation_time_s", self.retardation_time_s)?;
        Ok(self)
    }

    /// Rebound speed over approach speed of a rigid striker at a wall, by integration, to about 1e-12.
    pub(crate) fn wall_restitution(&self, mass_kg: f64, speed_m_s: f64) -> f64 {
        let p = self.exponent;
        let length_m = (mass_kg * speed_m_s * speed_m_s / self.stiffness_n_m_n).powf(1.0 / (p + 1.0));
        rebound_of_felt(p, self.retardation_time_s * speed_m_s / length_m)
    }
}

impl ContactLaw for Felt {
    fn touch(&self, _memory: &Memory, _approach_speed_m_s: f64) -> Branch {
        Branch { stage: Stage::Single, anchor_m: 0.0, internal: Internal::NONE }
    }

    fn force(&self, branch: &Branch, compression_m: f64, rate_m_s: f64) -> Force {
        if branch.stage == Stage::Slack {
            return Force::ZERO;
        }
        let (p, alpha) = (self.exponent, self.retardation_time_s);
        let (force, slope) = power_of(self.stiffness_n_m_n, p, compression_m);
        let (_, second) = power_of(self.stiffness_n_m_n, p - 1.0, compression_m);
        let retarded = alpha * bounded(rate_m_s);
        Force {
            force_n: force + retarded * slope,
            per_compression_n_m: slope + retarded * p * second,
            per_rate_n_s_m: alpha * slope,
        }
    }

    fn stored_energy_j(&self, _branch: &Branch, compression_m: f64) -> f64 {
        let xi = bounded(compression_m).max(0.0);
        power_of(self.stiffness_n_m_n, self.exponent, xi).0 * xi / (self.exponent + 1.0)
    }

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        // The force is Q0 u^(p-1) (u + alpha p u'), which is positive where the bracket is.
        recovering_boundary(branch, which, 1.0, self.retardation_time_s * self.exponent)
    }

    fn cross(&self, branch: &Branch, which: usize, _compression_m: f64, _rate_m_s: f64) -> After {
        cross_recovering(branch, which)
    }
}

/// Rebound speed after `x'' = -x^p - beta (x^p)'`, `x(0) = 0`, `x'(0) = 1`, up to where the force vanishes.
///
/// With much damping (`beta > 1`) lengths and times are `beta^(-1/p)` times as long, so that `y'' = -a y^p - b (y^p)'` with `a`
/// and `b` of at most 1 in either case. The force is `-y''`, so that the rebound speed is the maximum of the speed.
fn rebound_of_felt(p: f64, beta: f64) -> f64 {
    let (a, b) = if beta <= 1.0 { (1.0, beta) } else { (beta.powf(-1.0 - 1.0 / p), 1.0) };
    if a < 1e-12 {
        return a / p; // The speed at which creep from a compression of 1 begins.
    }
    // w = y' + b y^p, so that no derivative of the power is needed.
    let slope = |[y, w]: [f64; 2]| {
        let power = y.max(0.0).powf(p);
        [w - b * power, -a * power]
    };
    let pushes = |state: [f64; 2]| a * state[0] + b * p * slope(state)[0] > 0.0 && state[0] >= 0.0;
    let (mut state, mut h) = ([0.0, 1.0], 1e-3);
    for _ in 0..10_000 {
        let (next, error) = extrapolated(&slope, state, h);
        if error > 1e-15 {
            h *= 0.5;
            continue;
        }
        if pushes(next) {
            state = next;
            h *= if error < 1e-17 { 2.0 } else { 1.1 };
        } else if h > 1e-9 {
            h *= 0.5; // The speed is stationary at the end, so that this is close enough.
        } else {
            break;
        }
    }
    (-slope(state)[0]).clamp(0.0, 1.0)
}

/// A step by Gragg's modified midpoint rule with 2, 4, ... 12 parts, extrapolated to infinitely many, with an estimate of its
/// error (E. Hairer, S. P. Norsett and G. Wanner, *Solving Ordinary Differential Equations I*, 1993, II.9).
fn extrapolated(slope: &impl Fn([f64; 2]) -> [f64; 2], start: [f64; 2], h: f64) -> ([f64; 2], f64) {
    const PARTS: [f64; 6] = [2.0, 4.0, 6.0, 8.0, 10.0, 12.0];
    let along = |from: [f64; 2], by: f64, s: [f64; 2]| [from[0] + by * s[0], from[1] + by * s[1]];
    let first = slope(start);
    let mut row = [start; PARTS.len()];
    let mut error = f64::INFINITY;
    for (j, parts) in PARTS.into_iter().enumerate() {
        let step = h / parts;
        let (mut before, mut here) = (start, along(start, step, first));
        for _ in 1..parts as usize {
            (before, here) = (here, along(before, 2.0 * step, slope(here)));
        }
        let last = row;
        row[0] = here;
        for i in 1..=j {
            let weight = 1.0 / ((parts / PARTS[j - i]).powi(2) - 1.0);
            row[i] = [0, 1].map(|k| row[i - 1][k] + weight * (row[i - 1][k] - last[i - 1][k]));
            error = (row[i][0] - row[i - 1][0]).abs().max((row[i][1] - row[i - 1][1]).abs());
        }
    }
    (row[PARTS.len() - 1], error)
}
