//! A guess of the number of modes before any impact is solved.
//!
//! With remainder modes for all others, the restitution converges in the number `N` of modes, and quickly once mode `N` is fast
//! compared with the contact: with `k` the contact's stiffness and `c_N` the compliance of the truncated modes, once
//!
//! ```text
//! R(N) = omega_N^2 / ( k (1/m + 3 c_N omega_N^2) )
//! ```
//!
//! is large (`3 c_N omega_N^2` is the contribution of the modes up to `N` of a beam to the inverse mass at the location). The
//! guess is the `N` at which `R` equals a power of the tolerance; `cargo xtask study-auto` measures its accuracy.

use vibroimpact_sim::modal::Mode;

use super::Cost;
use super::pose::{Pose, Source};
use crate::scene::{BeamTheory, InvalidInput, Waves, compliance};

/// Factor from one number of modes to the next.
pub(super) const RAISE: f64 = std::f64::consts::SQRT_2;
/// `R` at the guess, `first / tolerance^order`: by Euler-Bernoulli's theory; by Timoshenko's, for which `c_N` decreases only as
/// `1/omega_N`, while remainder modes are as good as for the others; and for all other structures, for which `R` grows no faster
/// than the number of modes. The restitution converges at about twice the number. A guess that is too small costs one step more;
/// with one that is too large every step is too expensive.
const TARGET: [f64; 2] = [0.2, 0.47];
const TARGET_WITH_SHEAR: [f64; 2] = [0.4, 0.3];
const TARGET_OF_OTHERS: [f64; 2] = [0.1, 0.47];
/// Smallest number of modes at the start, in addition to rigid-body motions.
const FEWEST: usize = 4;

/// `R(N)` for this contribution of the modes up to `omega_N` to the inverse mass of the striker. The stiffness is that at the
/// largest compression of the striker with this effective mass.
fn resolution(pose: &Pose, omega_rad_s: f64, added: f64) -> f64 {
    let (wall, striker) = (&pose.wall, &pose.striker);
    let square = omega_rad_s * omega_rad_s;
    let inverse_mass = 1.0 / striker.mass_kg + added;
    // k ~ xi^(n-1) and xi = v / sqrt(k inverse_mass): a power law, in closed form
    let alone = striker.speed_m_s / (wall.stiffness_n_m * inverse_mass).sqrt();
    let softer = (alone / wall.compression_m).powf(2.0 / (wall.exponent + 1.0)).min(1.0);
    square / (wall.stiffness_n_m * softer.powf(wall.exponent - 1.0) * inverse_mass)
}

/// The expected number of modes, before any is computed.
fn expected(pose: &Pose, target: f64) -> Result<usize, InvalidInput> {
    let most = pose.source.most();
    let first = |estimate: &dyn Fn(usize) -> (f64, f64)| {
        let enough = |n: &usize| {
            let (omega, added) = estimate(*n);
            resolution(pose, omega, added) >= target
        };
        (FEWEST + 1..most).find(enough).unwrap_or(most)
    };
    Ok(match &pose.source {
        Source::Beam { beam, location_m, .. } => match Waves::new(beam, *location_m) {
            Ok(Some(waves)) => first(&|n| waves.expected(n)),
            Ok(None) => FEWEST,
            Err(fault) => return Err(fault.within("structure")),
        },
        Source::Computed { structure, .. } => first(&|n| structure.estimate(n).unwrap_or_default()),
        Source::Listed { .. } => most,
    })
}

/// The number of modes at the start, and the one with which the restitution may have converged.
pub(super) fn guess(pose: &mut Pose, cost: &mut Cost) -> Result<(usize, usize), InvalidInput> {
    let found = resolving(pose, 1.0, cost)?;
    Ok((fewer(found), found))
}

/// The number of modes at which `R` is this multiple of that of the guess.
pub(super) fn resolving(pose: &mut Pose, times: f64, cost: &mut Cost) -> Result<usize, InvalidInput> {
    let [first, order] = match pose.scene.structure.bending_theory() {
        Some(BeamTheory::Timoshenko) => TARGET_WITH_SHEAR,
        Some(_) => TARGET,
        None => TARGET_OF_OTHERS,
    };
    let target = times * first * pose.tolerance.powf(-order);
    let most = pose.source.most();
    let whole = pose.source.whole_m_n().unwrap_or(f64::INFINITY);
    let mut computed = (expected(pose, target)? + 2).min(most);
    let found = loop {
        let enough = pose.scene.structure.enough_for_remainder(pose.scene.place(), computed);
        let known = pose.first(enough, cost)?;
        let modes = known[..computed.min(known.len())].to_vec();
        let rigid = modes.iter().filter(|mode| mode.omega_rad_s == 0.0).count();
        let mut answered = compliance(modes.get(..rigid + FEWEST).unwrap_or_default());
        let enough = (rigid + FEWEST..modes.len()).find(|&k| {
            answered += compliance(&modes[k..=k]);
            let omega = modes[k].omega_rad_s;
            resolution(pose, omega, 3.0 * (whole - answered).max(0.0) * omega * omega) >= target
        });
        match enough {
            Some(k) => break k + 1,
            None if computed >= most => break most,
            None => computed = (computed + computed / 4 + 1).min(most),
        }
    };
    // two further steps must be possible, since a single change does not show whether the restitution has converged
    Ok(found.min(most.div_ceil(2)))
}

/// `R` at a number of modes, with these remainder modes.
pub(super) fn resolution_of(
    pose: &mut Pose,
    count: usize,
    remainder: &[Mode],
    cost: &mut Cost,
) -> Result<f64, InvalidInput> {
    let omega = pose.first(count, cost)?.last().map_or(0.0, |mode| mode.omega_rad_s);
    Ok(resolution(pose, omega, 3.0 * compliance(remainder) * omega * omega))
}

/// A number of modes one step above.
pub(super) fn more(count: usize) -> usize {
    ((count as f64 * RAISE).round() as usize).max(count + 1)
}

/// A number of modes one step below.
pub(super) fn fewer(count: usize) -> usize {
    ((count as f64 / RAISE).round() as usize).min(count.saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 times the factor is rounded to 1, and so is 1 over it.
    #[test]
    fn every_step_leads_to_another_number() {
        assert_eq!((more(1), more(5), fewer(1), fewer(7)), (2, 7, 0, 5));
        assert!((0..2000).all(|count| more(count) > count && (count == 0 || fewer(count) < count)));
    }
}
