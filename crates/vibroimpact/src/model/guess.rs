//! A guess of the number of modes before any impact is solved.
//!
//! With remainder modes for all others, the restitution converges in the number `N` of modes once they take up nearly all of the
//! energy that vibrates after the impact. What the others would take up follows from how the contact begins: a mode of the frequency
//! `omega`, fast compared with the contact, feels the force as long as it grows as a power of time, `F = F_1 (omega t)^n`, and
//! receives the impulse
//!
//! ```text
//! J(omega) = Gamma(n + 1) F_1/omega,      F_1 = F(v/omega, v),
//! ```
//!
//! where `F(xi, xi')` is the law of contact and `v` the speed of impact. `J` is at most what the striker gives up to a mode of the
//! mass `1/(1/m + A)`, where `A = (2g - 1) c_N omega_N^2` is the inverse mass of the modes up to `N` at the location. It follows from
//! the compliance `c_N` of the truncated modes if shapes have the same mean square and frequencies grow as the power `g` of their
//! number. The share of the striker's energy in the truncated modes is then
//!
//! ```text
//! E(N) = c_N omega_N^2 J(omega_N)^2 / (m v^2) (2g - 1)/(g (2n + 2) - 1).
//! ```
//!
//! The guess is the `N` from which on this is less than a share of the tolerance. It is mostly within a factor of ten of the energy
//! that the remainder modes have after a single contact (`cargo xtask study-auto`), and depends on a high power of `N`.

use contact_models::{ContactLaw, Memory};
use vibroimpact_sim::modal::Mode;

use super::Cost;
use super::pose::{Pose, Source};
use crate::scene::{BeamTheory, InvalidInput, Waves, compliance};

/// Factor from one number of modes to the next.
const RAISE: f64 = std::f64::consts::SQRT_2;
/// `E(N)` at the guess as a share of the tolerance, for beams by Euler-Bernoulli's theory (`g = 2`) and for all other structures
/// (`g = 1`). A guess that is too small costs one step more; with one that is too large every step is too expensive.
const SHARE_OF_BEAMS: f64 = 0.05;
const SHARE_OF_OTHERS: f64 = 0.3;
/// Exponents with which a force may grow as the contact begins.
const EXPONENTS: (f64, f64) = (0.0, 10.0);
/// Smallest number of modes at the start, in addition to rigid-body motions.
const FEWEST: usize = 4;
/// Largest number of modes at the start. Where the guess is larger, the contact lasts so long that damping leaves the fast modes less
/// than it assumes.
const MOST: usize = 1000;

/// Frequency of mode `N` relative to the contact,
///
/// ```text
/// R(N) = omega_N^2 / ( k (1/m + 3 c_N omega_N^2) )
/// ```
///
/// for this contribution `3 c_N omega_N^2` of the modes up to `N` of a beam to the inverse mass at the location. The stiffness `k` is
/// that at the largest compression of the striker with this effective mass.
fn resolution(pose: &Pose, omega_rad_s: f64, added: f64) -> f64 {
    let (wall, striker) = (&pose.wall, &pose.striker);
    let square = omega_rad_s * omega_rad_s;
    let inverse_mass = 1.0 / striker.mass_kg + added;
    // k ~ xi^(n-1) and xi = v / sqrt(k inverse_mass): a power law, in closed form
    let alone = striker.speed_m_s / (wall.stiffness_n_m * inverse_mass).sqrt();
    let softer = (alone / wall.compression_m).powf(2.0 / (wall.exponent + 1.0)).min(1.0);
    square / (wall.stiffness_n_m * softer.powf(wall.exponent - 1.0) * inverse_mass)
}

/// `g`, and the share of the tolerance at the guess.
fn growth(pose: &Pose) -> (f64, f64) {
    match pose.scene.structure.bending_theory() {
        Some(BeamTheory::EulerBernoulli) => (2.0, SHARE_OF_BEAMS),
        _ => (1.0, SHARE_OF_OTHERS),
    }
}

/// `E(N)` for this frequency of mode `N` and this inverse mass `A` of the modes up to it.
fn left_in_others(pose: &Pose, omega_rad_s: f64, inverse_mass: f64) -> f64 {
    let (wall, striker, (growth, _)) = (&pose.wall, &pose.striker, growth(pose));
    let (mass, speed) = (striker.mass_kg, striker.speed_m_s);
    let branch = pose.law.touch(&Memory::default(), speed);
    let compression_m = (speed / omega_rad_s).min(wall.compression_m);
    let force = pose.law.force(&branch, compression_m, speed);
    let exponent = compression_m * force.per_compression_n_m / force.force_n;
    let exponent = if exponent.is_finite() { exponent.clamp(EXPONENTS.0, EXPONENTS.1) } else { 1.0 };
    let most = 2.0 / (1.0 / mass + inverse_mass);
    let impulse_over_speed = (libm::tgamma(exponent + 1.0) * force.force_n / (omega_rad_s * speed)).min(most);
    inverse_mass * impulse_over_speed.powi(2) / (mass * (growth * (2.0 * exponent + 2.0) - 1.0))
}

/// The expected number of modes, before any is computed.
fn expected(pose: &Pose, target: f64) -> Result<usize, InvalidInput> {
    let most = pose.source.most();
    let first = |estimate: &dyn Fn(usize) -> (f64, f64)| {
        let enough = |n: &usize| {
            let (omega, added) = estimate(*n);
            left_in_others(pose, omega, added) <= target
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

/// The number of modes with which the restitution may have converged.
pub(super) fn guess(pose: &mut Pose, cost: &mut Cost) -> Result<usize, InvalidInput> {
    let (growth, share) = growth(pose);
    let target = share * pose.tolerance;
    let most = pose.source.most();
    let whole = pose.source.whole_m_n().unwrap_or(f64::INFINITY);
    let mut computed = (expected(pose, target)? + 2).min(most);
    let found = loop {
        let enough = pose.scene.structure.enough_for_remainder(pose.scene.place(), computed);
        let known = pose.first(enough, cost)?;
        let modes = known[..computed.min(known.len())].to_vec();
        let rigid = modes.iter().filter(|mode| mode.omega_rad_s == 0.0).count();
        let mut answered = compliance(modes.get(..rigid + FEWEST).unwrap_or_default());
        // near an end slow modes hardly move the location, and E(N) grows before it decreases
        let last_above = (rigid + FEWEST..modes.len()).filter(|&k| {
            answered += compliance(&modes[k..=k]);
            let omega = modes[k].omega_rad_s;
            let left_out_m_n = (whole - answered).max(0.0);
            left_in_others(pose, omega, (2.0 * growth - 1.0) * left_out_m_n * omega * omega) > target
        });
        match last_above.last() {
            None => break rigid + FEWEST + 1,
            Some(k) if k + 1 < modes.len() => break k + 2,
            Some(_) if computed >= most => break most,
            Some(_) => computed = (computed + computed / 4 + 1).min(most),
        }
    };
    // two further steps must be possible, since a single change does not show whether the restitution has converged
    Ok(found.min(most.div_ceil(2)).min(MOST))
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
