//! The possible change of a restitution by the truncated modes, estimated from impacts with other numbers of modes.
//!
//! Two numbers of modes may agree by accident, which is rarer the more impacts are compared. With `d_1` the last change and `d_2`
//! the one before,
//!
//! ```text
//! u = max( 3 d_1, d_2, e_r, d_s ) + d_c,      e_r = 3 D E_r / E max(1, R^(-1/2)).
//! ```
//!
//! Changes that decrease as `1/N` add up to 2.4 times the one by the last step of a factor of 1.4, and to 3 times if they decrease as
//! `N^(-0.83)`. The restitution of a light ball on a Timoshenko beam converges as slowly as that.
//!
//! A force that jumps at first touch gives a mode of the frequency `omega` a speed in proportion to `1/omega`, where a force that grows
//! from zero gives it a higher power. On a structure whose frequencies grow as `N`, the truncated modes change motion and contact as the
//! terms beyond `N` of the Fourier series of a jump do, by about `cos(omega_N tau)/N`, with a time `tau` between a wave and a contact.
//! Such changes nearly vanish where the cosine does, for two or three steps in sequence, while the amplitude of the error still decreases
//! as `1/N`. The largest of the last changes shows this amplitude, so that with such a force
//!
//! ```text
//! u >= max( d_2 N_2, d_3 N_3, d_4 N_4 ) / N_1
//! ```
//!
//! as well, where `N_i` is the larger number of modes of the change `d_i`.
//!
//! `E_r/E` is the share of the energy of approach, that of the striker or of a structure that meets an immovable surface, that the
//! remainder modes have after the impact. They respond to slow forces like
//! the truncated modes; if they vibrate, the force was too fast for them. This share is known from one impact alone, and detects
//! most accidental agreements. A contact much shorter than the period of the last mode, `R(N) < 1` (`guess.rs`), hardly moves the
//! remainder modes; the number of modes within its spectrum is then larger by a factor of up to `R^(-1/2)`. A dashpot, whose force
//! jumps at first touch, takes most of the energy of the remainder modes before the contact ends, and then `D = 10`, otherwise 1.
//! `d_s`, for lists, is the change with a single remainder mode in place of several, because the extrapolation of a list is an
//! assumption. `d_c` is the change if the static compliance, which all numbers of modes share, is larger by its uncertainty; it is
//! zero if the compliance has a closed form.
//!
//! If a list of modes ends before the restitution has converged, its last remainder modes are used beyond their range, and their
//! energy is part of the motion. With the last three changes,
//!
//! ```text
//! u = max( 4 d_1, 4 d_2, 4 d_3, d_s ) + d_c,
//! ```
//!
//! and `e_r` counts only if `d_1` is the largest, or `R < 0.1`: changes that grow, or that occur between numbers of modes which are
//! all far too small, contain no information about their limit. If the shapes still grow at the end of the list, the location is so
//! near an end of the structure that no listed mode has half a wave between the two. The extrapolation, by which all shapes have one
//! mean square, then has an error that all numbers of modes share, and `u` is four times as large.
//!
//! If the restitution of another structure does not converge, the larger of both estimates counts.
//!
//! The same holds for the largest force of each contact, with `e_r` as a share of the largest force of the impact, and with the factor by
//! which a restitution that has converged is made less certain (`settle.rs`).

use contact_models::{ContactLaw, Law, Memory};
use vibroimpact_sim::modal::{Mode, Outcome, Solution, Structure};

use crate::impact::Impact;
use crate::scene::compliance;

/// The uncertainty from truncated modes in terms of the larger of two changes, weighted below, and of the energy of the
/// remainder modes.
const CAUTION: f64 = 3.0;
const OF_ENERGY: f64 = 3.0;
/// `D` for a force that jumps at first touch.
const TAKEN: f64 = 10.0;
/// Weight of changes at the end of a list, where no further number of modes can show whether two agree by accident.
const CAUTION_AT_THE_END: f64 = 4.0;
/// Least growth of the mean square of the shapes from one quarter of a list to the next, if they still grow at its end, and the
/// factor of the estimate.
const GROWTH: f64 = 1.5;
const STILL_GROWING: f64 = 4.0;
/// `R` from which on changes at the end of a list are informative.
const RESOLVED: f64 = 0.1;
/// Weight of the change before the last.
const EARLIER: f64 = 1.0 / 3.0;
/// Number of changes before the last that count if the force jumps at first touch, as what they decrease to in proportion to `1/N`.
const SLOW: usize = 3;

/// Possible change by the truncated modes, from the sizes of changes and the numbers of modes after them, the latest first; without
/// any it is as large as the quantity may be. `jumps` states whether the force jumps at first touch.
pub(super) fn by_changes(changes: &[(f64, usize)], jumps: bool, scale: f64) -> f64 {
    let Some((&(latest, count), before)) = changes.split_first() else { return scale };
    let earlier = before.first().map_or(0.0, |&(size, _)| EARLIER * size);
    let slow = before.iter().take(if jumps { SLOW } else { 0 });
    let slow = slow.map(|&(size, after)| size * after as f64 / count as f64).fold(0.0, f64::max);
    (CAUTION * latest.max(earlier)).max(slow)
}

/// Factor for a contact that is so short that it hardly moves the remainder modes.
pub(super) fn too_short(resolution: f64) -> f64 {
    if resolution < 1.0 { resolution.max(f64::MIN_POSITIVE).powf(-0.5) } else { 1.0 }
}

/// Whether the force jumps at first touch, which does not depend on the speed of approach.
pub(super) fn jumps(law: &Law) -> bool {
    let speed_m_s = 1.0;
    let branch = law.touch(&Memory::default(), speed_m_s);
    law.force(&branch, 0.0, speed_m_s).force_n > 0.0
}

/// `D`, the factor for a force that jumps at first touch.
pub(super) fn taken_by_dashpot(law: &Law) -> f64 {
    if jumps(law) { TAKEN } else { 1.0 }
}

/// Possible change by the truncated modes at the end of a list of a quantity of this scale, from its changes, the latest first.
pub(super) fn at_the_end(changes: &[f64], scale: f64, energy: f64, resolution: f64) -> f64 {
    let Some((latest, before)) = changes.split_first() else { return scale };
    let before = before.iter().take(2).copied().fold(0.0, f64::max);
    let changed = CAUTION_AT_THE_END * latest.max(before);
    if *latest < before && resolution >= RESOLVED { changed } else { changed.max(scale * energy) }
}

/// Factor of the estimate at the end of a list if the shapes of its modes still grow.
pub(super) fn still_growing(modes: &[Mode]) -> f64 {
    let elastic: Vec<f64> = modes.iter().filter(|mode| mode.omega_rad_s > 0.0).map(|mode| mode.shape.powi(2)).collect();
    let quarter = (elastic.len() / 4).max(1);
    let mut sums = elastic.rchunks(quarter).map(|part| part.iter().sum::<f64>() / part.len() as f64);
    match [sums.next(), sums.next(), sums.next()] {
        [Some(last), Some(before), Some(first)] if last > GROWTH * before && before > GROWTH * first => STILL_GROWING,
        _ => 1.0,
    }
}

/// The estimate from the energy of the remainder modes, the last modes of a structure, after the impact: `e_r` with `R >= 1`.
pub(super) fn energy_of_remainder(impact: &Impact, after: &Solution) -> f64 {
    let Impact { structure, remainder_modes, striker, law, .. } = impact;
    let from = structure.modes.len() - remainder_modes;
    // at an immovable surface the structure itself is the mass that approaches
    let mass_kg =
        if striker.mass_kg.is_finite() { striker.mass_kg } else { structure.mobility_per_kg(striker).recip() };
    // in units of the speed of approach, so that no square overflows or underflows
    let unit = impact.approach_m_s() * mass_kg.sqrt();
    let motion = structure.modes.iter().zip(&after.amplitude).zip(&after.rate).skip(from);
    let energy: f64 =
        motion.map(|((mode, a), rate)| (mode.omega_rad_s * a / unit).powi(2) + (rate / unit).powi(2)).sum();
    // it cannot lift a striker that stays far below the height from which its rebound would count
    let stays = impact.gravity_m_s2 > 0.0 && after.outcome == Outcome::Sustained;
    let lacking = if stays { (-after.highest_flight).max(1.0) } else { 1.0 };
    if energy.is_finite() { OF_ENERGY * energy / lacking * taken_by_dashpot(law) } else { 0.0 }
}

/// The structure with a single mode in place of its remainder modes, with the same first two moments
/// `sum phi^2 / omega^(2j)`.
pub(super) fn with_one_remainder_mode(structure: &Structure, remainder: usize) -> Structure {
    let (kept, tail) = structure.modes.split_at(structure.modes.len() - remainder);
    let moment = |j: i32| tail.iter().map(|mode| mode.shape.powi(2) / mode.omega_rad_s.powi(2 * j)).sum::<f64>();
    let (first, second) = (moment(1), moment(2));
    let omega_rad_s = (first / second).sqrt();
    let mut modes = kept.to_vec();
    if omega_rad_s.is_finite() && omega_rad_s > 0.0 {
        let damping_ratio = tail.last().map_or(0.0, |mode| mode.damping_ratio);
        modes.push(Mode { omega_rad_s, damping_ratio, shape: first.sqrt() * omega_rad_s });
    }
    Structure { modes }
}

/// The structure with remainder modes whose static compliance is larger by this amount (m/N).
pub(super) fn with_softer_remainder(structure: &Structure, remainder: usize, by_m_n: f64) -> Structure {
    let mut modes = structure.modes.clone();
    let from = modes.len() - remainder;
    let answered_m_n = compliance(&modes[from..]);
    if answered_m_n > 0.0 {
        let factor = (1.0 + by_m_n / answered_m_n).sqrt();
        modes[from..].iter_mut().for_each(|mode| mode.shape *= factor);
    } else if let Some(last) = modes.last().copied() {
        modes.push(Mode { shape: last.omega_rad_s * by_m_n.sqrt(), ..last });
    }
    Structure { modes }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_of_a_force_that_jumps_decrease_no_faster_than_the_number_of_modes_grows() {
        let changes = [(1.0, 200), (2.0, 140), (9.0, 100), (100.0, 50), (1e5, 20)];
        assert_eq!((by_changes(&[], false, 2.0), by_changes(&changes[..1], true, 2.0)), (2.0, 3.0));
        assert_eq!((by_changes(&changes, false, 2.0), by_changes(&changes[..3], true, 2.0)), (3.0, 4.5));
        assert_eq!(by_changes(&changes, true, 2.0), 25.0);
    }

    #[test]
    fn changes_at_the_end_of_a_list_count_where_they_fall() {
        assert_eq!(at_the_end(&[], 2.0, 0.0, 1.0), 2.0);
        assert_eq!(at_the_end(&[0.1, 0.2, 0.3, 0.9], 1.0, 7.0, 1.0), 1.2);
        assert_eq!(at_the_end(&[0.1, 0.2], 1.0, 7.0, 0.01), 7.0);
        assert_eq!(at_the_end(&[0.2, 0.1], 2.0, 3.5, 1.0), 7.0);
        assert_eq!(at_the_end(&[0.2, 0.1], 1.0, 0.1, 1.0), 0.8);
        assert_eq!((too_short(4.0), too_short(0.25)), (1.0, 2.0));
        assert!([0.0, -1.0].into_iter().all(|r| too_short(r).is_finite()) && too_short(f64::NAN) == 1.0);
    }

    #[test]
    fn shapes_near_an_end_grow_to_the_end_of_the_list() {
        let list = |share: f64| -> Vec<Mode> {
            let shape = |n: usize| (n as f64 * std::f64::consts::PI * share).sin();
            (1..=24).map(|n| Mode { omega_rad_s: (n * n) as f64, damping_ratio: 0.01, shape: shape(n) }).collect()
        };
        assert_eq!(still_growing(&list(0.005)), STILL_GROWING);
        for share in [0.05, 0.11, 0.37, 0.618] {
            assert_eq!(still_growing(&list(share)), 1.0);
        }
        assert_eq!((still_growing(&[]), still_growing(&list(0.005)[..2])), (1.0, 1.0));
    }

    #[test]
    fn a_softer_remainder_has_the_compliance_asked_for() {
        let mode = |omega_rad_s: f64, shape: f64| Mode { omega_rad_s, damping_ratio: 0.01, shape };
        let structure = Structure { modes: vec![mode(100.0, 1.0), mode(300.0, -2.0), mode(900.0, 4.0)] };
        for remainder in [0, 1, 2] {
            let softer = with_softer_remainder(&structure, remainder, 1e-6);
            let more = compliance(&softer.modes) - compliance(&structure.modes);
            assert!((more / 1e-6 - 1.0).abs() < 1e-9, "{remainder}: {more:e}");
        }
        assert!(with_softer_remainder(&Structure::default(), 0, 1e-6).modes.is_empty());
    }

    #[test]
    fn one_mode_in_the_place_of_several_keeps_two_moments() {
        let mode = |omega_rad_s: f64, shape: f64| Mode { omega_rad_s, damping_ratio: 0.01, shape };
        let several = [mode(100.0, 1.0), mode(300.0, -2.0), mode(900.0, 4.0)];
        let structure = Structure { modes: [&[mode(50.0, 3.0)][..], &several].concat() };
        let one = with_one_remainder_mode(&structure, 3);
        assert_eq!((one.modes.len(), one.modes[0]), (2, structure.modes[0]));
        for j in [2, 4] {
            let moment = |modes: &[Mode]| modes.iter().map(|m| m.shape.powi(2) / m.omega_rad_s.powi(j)).sum::<f64>();
            assert!((moment(&one.modes[1..]) / moment(&several) - 1.0).abs() < 1e-12);
        }
    }
}
