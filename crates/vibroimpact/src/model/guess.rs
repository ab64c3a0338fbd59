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
//! where `F(xi, xi')` is the law of contact and `v` the speed of impact. `J` is at most `2 v0/(1/m + A)`, what the striker
//! gives up in an elastic impact on a free mass `1/A`, where `A = (2g - 1) c_N omega_N^2` is the inverse mass of the modes up to `N` at
//! the location. It follows from
//! the compliance `c_N` of the truncated modes if shapes have the same mean square and frequencies grow as the power `g` of their
//! number. The share of the striker's energy that the truncated modes have received is then, with the speed of impact `v0`,
//!
//! ```text
//! E(v) = c_N omega_N^2 J(omega_N)^2 / (m v0^2) (2g - 1)/(g (2n + 2) - 1).
//! ```
//!
//! As the contact ends, they receive energy again from the force that vanishes, for which the speed `v1` of a rebound from an
//! immovable location takes the place of `v0`. Until then, what they received first decays within the duration `T` of the contact:
//! by their own damping ratio `zeta`, and by the damping `c = dF/dxi'` of a law that depends on the rate. It acts between the
//! striker and a mode of the mass `1/(c_N omega_N^2)`, and prevents the mode from vibrating if it is strong:
//!
//! ```text
//! E(N) = ( E(v0) e^(-(2 zeta omega_N + r) T) + E(v1) )/2,   r = p/(1 + (p/(2 omega_N))^2),   p = c c_N omega_N^2.
//! ```
//!
//! The force of a spring and dashpot jumps at first touch and vanishes smoothly, so that this decay decides how many modes matter.
//!
//! The guess is the `N` from which on this is less than a share of the tolerance. It is mostly within a factor of ten of the energy
//! that the remainder modes have after a single contact (`cargo xtask study-auto`), and depends on a high power of `N`.

use contact_models::{ContactLaw, Law, Memory};
use vibroimpact_sim::modal::{Mode, Striker};

use super::Cost;
use super::left_out::taken_by_dashpot;
use super::pose::{Pose, Source};
use super::wall::Wall;
use crate::scene::{Beam, BeamTheory, InvalidInput, Waves, compliance};

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

/// A mode that is fast compared with the contact.
struct Fast {
    omega_rad_s: f64,
    damping_ratio: f64,
    /// `A`, of the modes up to this one (1/kg).
    inverse_mass: f64,
}

/// How a contact excites fast modes, and damps them.
struct Excitation {
    striker: Striker,
    law: Law,
    wall: Wall,
    /// `g`.
    growth: f64,
    /// `c` (N s/m), halfway to the largest compression.
    drag_n_s_m: f64,
    /// `v1`.
    separation_speed_m_s: f64,
}

impl Excitation {
    fn new(pose: &Pose, growth: f64) -> Excitation {
        let (striker, law, wall) = (pose.striker, pose.law, pose.wall);
        let branch = law.touch(&Memory::default(), striker.speed_m_s);
        let drag_n_s_m = law.force(&branch, 0.5 * wall.compression_m, 0.0).per_rate_n_s_m;
        // a law that does not depend on the rate loses energy by a stiffer unloading, which excites fast modes as much
        let restitution = match law.wall_restitution(striker.mass_kg, striker.speed_m_s) {
            Ok(restitution) if drag_n_s_m > 0.0 => restitution,
            _ => 1.0,
        };
        let separation_speed_m_s = restitution * striker.speed_m_s;
        Excitation { striker, law, wall, growth, drag_n_s_m, separation_speed_m_s }
    }

    /// `E(N)`.
    fn left_in_others(&self, mode: &Fast) -> f64 {
        let Fast { omega_rad_s, damping_ratio, inverse_mass } = *mode;
        let p = self.drag_n_s_m * inverse_mass / (2.0 * self.growth - 1.0);
        let decay = 2.0 * damping_ratio * omega_rad_s + p / (1.0 + (0.5 * p / omega_rad_s).powi(2));
        let speed = self.striker.speed_m_s;
        let begins = self.received(mode, speed, speed);
        let ends = self.received(mode, self.separation_speed_m_s, 0.0);
        0.5 * (begins * (-decay * self.wall.duration_s).exp() + ends)
    }

    /// `E(v)` for this speed, with the force of the law at this rate of compression.
    fn received(&self, mode: &Fast, speed_m_s: f64, rate_m_s: f64) -> f64 {
        let Fast { omega_rad_s, inverse_mass, .. } = *mode;
        let Striker { mass_kg, speed_m_s: of_impact } = self.striker;
        let branch = self.law.touch(&Memory::default(), of_impact);
        let compression_m = (speed_m_s / omega_rad_s).min(self.wall.compression_m);
        let force = self.law.force(&branch, compression_m, rate_m_s);
        let exponent = compression_m * force.per_compression_n_m / force.force_n;
        let exponent = if exponent.is_finite() { exponent.clamp(EXPONENTS.0, EXPONENTS.1) } else { 1.0 };
        let most = 2.0 / (1.0 / mass_kg + inverse_mass);
        let impulse_over_speed = libm::tgamma(exponent + 1.0) * force.force_n / (omega_rad_s * of_impact);
        let energy = inverse_mass * impulse_over_speed.min(most).powi(2) / mass_kg;
        energy / (self.growth * (2.0 * exponent + 2.0) - 1.0)
    }
}

/// `g`, and the share of the tolerance at the guess.
fn growth(pose: &Pose) -> (f64, f64) {
    match pose.scene.structure.bending_theory() {
        Some(BeamTheory::EulerBernoulli) => (2.0, SHARE_OF_BEAMS),
        _ => (1.0, SHARE_OF_OTHERS),
    }
}

/// The expected number of modes, before any is computed.
fn expected(pose: &Pose, contact: &Excitation, target: f64) -> Result<usize, InvalidInput> {
    let most = pose.source.most();
    let first = |estimate: &dyn Fn(usize) -> Fast| {
        let enough = |n: &usize| contact.left_in_others(&estimate(*n)) <= target;
        (FEWEST + 1..most).find(enough).unwrap_or(most)
    };
    Ok(match &pose.source {
        Source::Beam { beam, location_m, .. } => match Waves::new(beam, *location_m) {
            Ok(Some(waves)) => first(&|n| mode_of_beam(beam, &waves, n)),
            Ok(None) => FEWEST,
            Err(fault) => return Err(fault.within("structure")),
        },
        Source::Computed { structure, .. } => first(&|n| {
            let (omega_rad_s, inverse_mass) = structure.estimate(n).unwrap_or_default();
            Fast { omega_rad_s, damping_ratio: structure.damping_ratio(), inverse_mass }
        }),
        Source::Listed { .. } => most,
    })
}

/// Mode `n` of a beam, from one, as it is expected on average.
fn mode_of_beam(beam: &Beam, waves: &Waves, n: usize) -> Fast {
    let (omega_rad_s, inverse_mass) = waves.expected(n);
    // the list of damping ratios counts from zero
    Fast { omega_rad_s, damping_ratio: beam.damping_ratio_at(n - 1, omega_rad_s), inverse_mass }
}

/// The number of modes with which the restitution may have converged.
pub(super) fn guess(pose: &mut Pose, cost: &mut Cost) -> Result<usize, InvalidInput> {
    let (growth, share) = growth(pose);
    let target = share * pose.tolerance / taken_by_dashpot(&pose.law);
    let contact = Excitation::new(pose, growth);
    let most = pose.source.most();
    let whole = pose.source.whole_m_n().unwrap_or(f64::INFINITY);
    let mut computed = (expected(pose, &contact, target)? + 2).min(most);
    let found = loop {
        let enough = pose.scene.structure.enough_for_remainder(pose.scene.place(), computed);
        let known = pose.first(enough, cost)?;
        let modes = known[..computed.min(known.len())].to_vec();
        let rigid = modes.iter().filter(|mode| mode.omega_rad_s == 0.0).count();
        let mut answered = compliance(modes.get(..rigid + FEWEST).unwrap_or_default());
        // near an end slow modes hardly move the location, and E(N) grows before it decreases
        let last_above = (rigid + FEWEST..modes.len()).filter(|&k| {
            answered += compliance(&modes[k..=k]);
            let Mode { omega_rad_s, damping_ratio, .. } = modes[k];
            let left_out_m_n = (whole - answered).max(0.0);
            let inverse_mass = (2.0 * growth - 1.0) * left_out_m_n * omega_rad_s * omega_rad_s;
            contact.left_in_others(&Fast { omega_rad_s, damping_ratio, inverse_mass }) > target
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
pub(crate) fn more(count: usize) -> usize {
    ((count as f64 * RAISE).round() as usize).max(count + 1)
}

/// A number of modes one step below.
pub(super) fn fewer(count: usize) -> usize {
    ((count as f64 / RAISE).round() as usize).min(count.saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{End, Segment};

    /// The mean density of modes is exact for a uniform pinned beam.
    #[test]
    fn an_expected_mode_has_the_frequency_and_the_damping_of_that_mode() {
        let segment = Segment {
            length_m: 1.3,
            flexural_rigidity_n_m2: Some(274.0),
            mass_per_length_kg_m: Some(1.1),
            ..Segment::default()
        };
        let beam = Beam {
            segments: vec![segment],
            theory: Some(BeamTheory::EulerBernoulli),
            damping_ratio: 0.3,
            damping_ratios: vec![0.01, 0.02, 0.04, 0.08],
            ..Beam::new([End::Pinned; 2])
        };
        let waves = Waves::new(&beam, 0.4).unwrap().unwrap();
        let modes = beam.modes(6).unwrap().seen_from(0.4).unwrap();
        for (k, mode) in modes.iter().enumerate() {
            let expected = mode_of_beam(&beam, &waves, k + 1);
            assert!((expected.omega_rad_s / mode.omega_rad_s - 1.0).abs() < 1e-9, "{k}");
            assert_eq!(expected.damping_ratio, mode.damping_ratio, "{k}");
        }
    }

    /// 1 times the factor is rounded to 1, and so is 1 over it.
    #[test]
    fn every_step_leads_to_another_number() {
        assert_eq!((more(1), more(5), fewer(1), fewer(7)), (2, 7, 0, 5));
        assert!((0..2000).all(|count| more(count) > count && (count == 0 || fewer(count) < count)));
    }
}
