//! An impact with another number of modes.

use vibroimpact_sim::dropped_rod;
use vibroimpact_sim::modal::Solution;

use super::guess::guess;
use super::pose::Pose;
use super::{Cost, Kept, Model, Modes};
use crate::impact::Impact;
use crate::scene::{InvalidInput, Scene, Structure, modal_only};

/// Solves an impact and adds its cost.
pub(super) fn solve(impact: &Impact, kept: &mut Kept, cost: &mut Cost) -> Result<Solution, InvalidInput> {
    let solution = impact.solve_with(kept)?;
    cost.add(&solution.counts, impact.structure.modes.len());
    Ok(solution)
}

/// The expected number of modes for a tolerance, if it is known.
pub(super) fn needed(
    scene: &Scene,
    tolerance: f64,
    kept: &mut Kept,
    cost: &mut Cost,
) -> Result<Option<usize>, InvalidInput> {
    if modal_only(scene).is_some() {
        return Ok(None);
    }
    let chosen = Scene {
        model: Model::Auto,
        modes: Modes::Auto,
        residual_compliance: Some(true),
        tolerance: Some(tolerance),
        ..scene.clone()
    };
    Ok(Some(guess(&mut Pose::new(&chosen, kept)?, cost)?))
}

/// Whether the structure moves before the impact.
pub(super) fn moves_before(scene: &Scene) -> bool {
    scene.starts_in_motion() || matches!(scene.structure, Structure::DroppedRod(_))
}

/// The impact with this many modes in place of `count`, and remainder modes for the others.
pub(super) fn with_modes(scene: &Scene, count: usize, modes: usize, kept: &mut Kept) -> Result<Impact, InvalidInput> {
    let mut other = scene.clone();
    match &mut other.structure {
        Structure::DroppedRod(rod) => {
            let further = (modes - count).div_ceil(2);
            let with = |stated: usize| (stated + further).min(dropped_rod::MOST_MODES);
            (rod.bending_modes, rod.axial_modes) = (with(rod.bending_modes), with(rod.axial_modes));
        }
        _ => {
            other.modes = Modes::Count(modes);
            other.residual_compliance = Some(true);
        }
    }
    other.impact_of(other.modes.count(), kept)
}
