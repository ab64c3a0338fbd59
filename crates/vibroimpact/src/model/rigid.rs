//! An immovable location: the restitution of the law at a wall, and a bound on the effect of the structure.
//!
//! A structure at rest takes up the energy `E = sum 1/2 phi_k^2 J_k^2` with `J_k = |int F exp(i omega_k t) dt|` (without
//! damping). For a force with a single maximum `J_k <= 2 F_max/omega_k`. The elastic energy of the contact never exceeds that of
//! the striker, so `F_max` is at most the force at a wall. Twice this `J_k`, to allow for further maxima, gives with the static
//! compliance `G = sum phi_k^2/omega_k^2`, without computing any mode,
//!
//! ```text
//! E / (m v^2 / 2) <= epsilon = 16 G F_wall^2 / (m v^2) (1 + 64 zeta).
//! ```
//!
//! The last factor covers the dissipation of modes with the damping ratio `zeta` during the contact. The contact force only pushes
//! the striker away. After the first separation its speed is therefore at least `sqrt(1 - epsilon) v`, further contacts can only
//! increase it, and `e` lies between `sqrt(1 - epsilon)` and 1. Dissipative laws have no such bound; for them `epsilon` itself
//! has to be a thousand times below the tolerance.

use super::choice::{Choice, Tried};
use super::pose::{Pose, Source};
use super::uncertainty::{CLOSED_FORM, Known};
use super::{Answer, Cost, Model};
use crate::scene::{Contact, InvalidInput};
use crate::text::small;

/// Factor by which `epsilon` has to be below the tolerance for a dissipative law.
const MARGIN: f64 = 1e-3;
/// A rigid-body motion that moves the location by less than this share of the striker's inverse mass does not move it.
const STILL: f64 = 1e-12;

/// Bound on the difference of the restitution from that at a wall; `Err` states why no bound is known.
pub(super) fn bound(pose: &mut Pose, cost: &mut Cost) -> Result<Result<f64, String>, InvalidInput> {
    let rigid_bodies = match &pose.source {
        Source::Beam { beam, .. } => {
            beam.to_system().and_then(|beam| beam.rigid_body_count()).map_err(|fault| fault.within("structure"))?
        }
        Source::Computed { structure, .. } => structure.rigid_body_count()?,
        Source::Listed { modes, .. } => modes.len(),
    };
    let mass = pose.striker.mass_kg;
    let moving = pose.first(rigid_bodies, cost)?.iter().filter(|mode| mode.omega_rad_s == 0.0);
    let share: f64 = moving.map(|mode| mass * mode.shape.powi(2)).sum();
    if share > STILL {
        return Ok(Err("the structure moves freely as a rigid body".to_owned()));
    }
    let still =
        matches!(&pose.source, Source::Listed { modes, whole_m_n: None } if modes.iter().all(|mode| mode.shape == 0.0));
    let Some(whole) = pose.source.whole_m_n().or(still.then_some(0.0)) else {
        return Ok(Err("the static compliance of the structure is not known".to_owned()));
    };
    let damping = match &pose.source {
        Source::Beam { beam, .. } => beam.largest_damping_ratio(),
        Source::Computed { structure, .. } => Some(structure.damping_ratio()),
        Source::Listed { modes, .. } => Some(modes.iter().map(|mode| mode.damping_ratio).fold(0.0, f64::max)),
    };
    let Some(damping) = damping else {
        return Ok(Err("the damping of the structure has no bound over its modes".to_owned()));
    };
    let energy = mass * pose.striker.speed_m_s.powi(2);
    let epsilon = 16.0 * whole.max(0.0) * pose.wall.force_n.powi(2) / energy * (1.0 + 64.0 * damping);
    let elastic =
        matches!(pose.scene.contact, Contact::Hertz(_) | Contact::LinearSpring { .. } | Contact::Power { .. });
    Ok(match epsilon {
        e if e.is_nan() => Err("the contact has no scale".to_owned()),
        e if elastic => Ok(1.0 - (1.0 - e.min(1.0)).sqrt()),
        e => Ok((e / MARGIN).min(1.0)),
    })
}

/// The wall, if the bound proves that it reaches the tolerance.
pub(super) fn certified(pose: &mut Pose, cost: &mut Cost) -> Tried {
    if !pose.approaches() {
        return Ok(Err("the striker does not approach".to_owned()));
    }
    match bound(pose, cost)? {
        Ok(bound) if bound <= pose.tolerance => wall(pose, Some(bound), cost).map(Ok),
        Ok(bound) => {
            Ok(Err(format!("the compliance of the location may change the restitution by up to {}", small(bound))))
        }
        Err(reason) => Ok(Err(reason)),
    }
}

/// The wall, because it was requested.
pub(super) fn forced(pose: &mut Pose, cost: &mut Cost) -> Tried {
    if !pose.approaches() {
        return Ok(Err("the striker does not approach".to_owned()));
    }
    let bound = bound(pose, cost)?.ok();
    wall(pose, bound, cost).map(Ok)
}

fn wall(pose: &Pose, bound: Option<f64>, cost: &mut Cost) -> Result<Choice, InvalidInput> {
    let restitution =
        pose.law.wall_restitution(pose.striker.mass_kg, pose.striker.speed_m_s).map_err(in_scene_of_law)?;
    cost.solves += 1;
    let reason = match bound {
        Some(bound) if bound <= pose.tolerance => {
            format!(
                "rigid: the compliance of the location changes the restitution at a wall by at most {}",
                small(bound)
            )
        }
        Some(bound) => {
            format!(
                "rigid: requested, although the compliance of the location may change the restitution by up to {}",
                small(bound)
            )
        }
        None => "rigid: requested; the effect of the structure is not bounded".to_owned(),
    };
    let known = match bound {
        Some(bound) => Known::new(pose.scene, Ok(CLOSED_FORM), Ok(bound)),
        None => Known::nothing("no part: the effect of the structure is not bounded"),
    };
    let answer = Answer {
        restitution: Some(restitution),
        sub_impact_count: Some(1),
        ..Answer::new(Model::Rigid, pose.tolerance, known, reason)
    };
    Ok(Choice::from(answer))
}

fn in_scene_of_law(fault: InvalidInput) -> InvalidInput {
    match fault.field.first() {
        Some("mass_kg" | "speed_m_s") => fault.within("striker"),
        _ => fault.within("contact"),
    }
}
