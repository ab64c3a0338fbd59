//! The net law: a single contact for light strikers, common motion with the slow modes for heavy ones (chapter 7's study of laws).
//!
//! ```text
//! Z_w = m sum phi_k^2 exp(-(c omega_k tau)^2),    A = exp(-q Z_w),    e = A + (1 - A) max_j m psi_j^2
//! ```
//!
//! `tau` is the duration of a contact with an immovable surface, `psi_j` the modes of the structure with the striker
//! attached ([`largest_share`]). It is more accurate than the thesis's three-parameter form on every beam of chapter 7, with one
//! set of parameters for all.

use vibroimpact_sim::modal::Mode;

use super::attached::largest_share;
use super::choice::{Choice, Tried};
use super::pose::{Pose, Source};
use super::uncertainty::{CLOSED_FORM, Known};
use super::{Answer, Cost, Model};
use crate::scene::{Contact, InvalidInput};
use crate::text::small;

/// Parameters of the law, and their accuracy for beams to which they were not fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Validated {
    /// Determines up to which frequency a mode takes up an impulse.
    pub c: f64,
    /// Determines the share of the impulse that the modes keep.
    pub q: f64,
    /// Error that 95 of 100 predictions for a beam left out of the fit do not exceed.
    pub error_95: f64,
    /// The largest error of such a prediction.
    pub largest_error: f64,
    /// Validated range of the striker's mass over that of the beam.
    pub mass_ratios: [f64; 2],
    /// Validated range of damping ratios.
    pub damping_ratios: [f64; 2],
    /// Validated range of speeds (m/s).
    pub speeds_m_s: [f64; 2],
}

/// From `cargo xtask study-auto`, which fits and validates the law again and compares the results with these values.
pub const VALIDATED: Validated = Validated {
    c: 0.300,
    q: 2.951,
    error_95: 0.154,
    largest_error: 0.286,
    mass_ratios: [1e-3, 3.0],
    damping_ratios: [1e-3, 0.1],
    speeds_m_s: [0.05, 5.0],
};

/// Modes with `exp(-(c omega tau)^2)` below `exp(-FAST)` are neglected.
const FAST: f64 = 30.0;

/// The law's restitution for a striker of mass `mass_kg`, a contact of `duration_s` at a wall, and the modes of a
/// structure without rigid-body motion.
pub fn law(c: f64, q: f64, mass_kg: f64, duration_s: f64, modes: &[Mode]) -> f64 {
    let exponent = |mode: &Mode| (c * mode.omega_rad_s * duration_s).powi(2);
    let slow = modes.iter().map(|mode| (exponent(mode), mode)).filter(|(x, _)| *x < FAST);
    let z: f64 = slow.map(|(x, mode)| mass_kg * mode.shape.powi(2) * (-x).exp()).sum();
    let first = (-q * z).exp();
    first + (1.0 - first) * largest_share(mass_kg, modes)
}

/// Checks that a scene is of the class for which the law was validated; if not, states the reason.
fn class(pose: &Pose) -> Result<Result<(), String>, InvalidInput> {
    let Source::Beam { beam, .. } = &pose.source else {
        return Ok(Err("the law was validated for beams".to_owned()));
    };
    if let Some(more) = beam.beyond_slender().map_err(|fault| fault.within("structure"))? {
        return Ok(Err(format!("the law was validated for beams without {more}")));
    }
    let built = beam.to_beam().map_err(|fault| fault.within("structure"))?;
    let damping = beam.damping_ratio;
    let within = |value: f64, [low, high]: [f64; 2]| (low..=high).contains(&value);
    let ratio = pose.striker.mass_kg / built.mass_kg();
    let reason = if !matches!(pose.scene.contact, Contact::Hertz(_)) {
        "the law was validated for hertz contact".to_owned()
    } else if built.rigid_body_count() > 0 {
        "the law was validated for beams that are held".to_owned()
    } else if !within(ratio, VALIDATED.mass_ratios) {
        format!("a striker of {} times the mass of the beam is outside the validated range of the law", small(ratio))
    } else if !within(damping, VALIDATED.damping_ratios) {
        format!("a damping ratio of {} is outside the validated range of the law", small(damping))
    } else if !within(pose.striker.speed_m_s, VALIDATED.speeds_m_s) {
        format!("a speed of {} m/s is outside the validated range of the law", small(pose.striker.speed_m_s))
    } else {
        return Ok(Ok(()));
    };
    Ok(Err(reason))
}

/// The law, if the tolerance is no tighter than its validated error.
pub(super) fn certified(pose: &mut Pose, cost: &mut Cost) -> Tried {
    match class(pose)? {
        Err(reason) => Ok(Err(reason)),
        Ok(()) if pose.tolerance < VALIDATED.error_95 => {
            Ok(Err(format!("its validated error is {} (95 %)", small(VALIDATED.error_95))))
        }
        Ok(()) => forced(pose, cost),
    }
}

/// The law, because it was requested.
pub(super) fn forced(pose: &mut Pose, cost: &mut Cost) -> Tried {
    if !pose.approaches() {
        return Ok(Err("the striker does not approach".to_owned()));
    }
    let class = class(pose)?;
    let duration_s = pose.wall.duration_s;
    let fastest = FAST.sqrt() / (VALIDATED.c * duration_s);
    let mut count = 32.min(pose.source.most());
    while count < pose.source.most() && pose.first(count, cost)?.last().is_some_and(|mode| mode.omega_rad_s < fastest) {
        count = (2 * count).min(pose.source.most());
    }
    let mass_kg = pose.striker.mass_kg;
    let modes = pose.first(count, cost)?;
    if modes.iter().any(|mode| mode.omega_rad_s == 0.0 && mode.shape != 0.0) {
        return Ok(Err("the structure moves freely as a rigid body, for which the law is not made".to_owned()));
    }
    let restitution = law(VALIDATED.c, VALIDATED.q, mass_kg, duration_s, modes);
    let count = modes.len();
    cost.solves += 1;
    let known = match &class {
        Ok(()) => Known::new(pose.scene, Ok(CLOSED_FORM), Ok(VALIDATED.error_95)),
        Err(why) => Known::nothing(&format!("no part: {why}")),
    };
    let reason = match class {
        Ok(()) => format!(
            "emoc: a net law; of predictions for beams that it was not fitted to, 95 in 100 err by less than {}, and \
             the worst by {}",
            small(VALIDATED.error_95),
            small(VALIDATED.largest_error)
        ),
        Err(why) => format!("emoc: a net law, whose error is not known here: {why}"),
    };
    let answer = Answer {
        restitution: Some(restitution),
        modes: count,
        ..Answer::new(Model::Emoc, pose.tolerance, known, reason)
    };
    Ok(Ok(Choice::from(answer)))
}
