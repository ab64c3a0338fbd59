//! Changes that must not affect the restitution, over random impacts: mirror image, units, direction of time, representation of
//! modes.
//!
//! Two descriptions of one impact must agree within the uncertainties that both solutions state.

use crate::common::random::{
    Impact, config, conservative_law, decades, ordinary_damping, ordinary_impact, ordinary_law, ordinary_striker,
    ordinary_structure,
};
use crate::common::{seen_from, settings};
use beam_modes::{Beam, End, Segment};
use contact_models::{Hertz, HuntCrossley, Hysteretic, KelvinVoigt, Law, LinearSpring, Thornton, Viscous};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use vibroimpact_sim::modal::{Mode, Outcome, Solution, Solver, Start, Striker, Structure};

const TOLERANCE: f64 = 1e-9;

/// Fails unless both ended in the same way and their restitutions differ by no more than the sum of the stated uncertainties.
fn agree(a: &Solution, b: &Solution) -> Result<(), TestCaseError> {
    let (Some(e), Some(f)) = (a.restitution, b.restitution) else {
        return Err(TestCaseError::fail(format!("{:?}, {:?}", a.outcome, b.outcome)));
    };
    let stated = a.restitution_uncertainty.unwrap_or(1.0) + b.restitution_uncertainty.unwrap_or(1.0);
    prop_assert!((e - f).abs() <= stated, "{} against {}: {:e}, stated {:e}", e, f, e - f, stated);
    Ok(())
}

/// The same law in other units of mass, length and time.
fn in_units(law: Law, mass: f64, length: f64, time: f64) -> Law {
    let force = mass * length / (time * time);
    let pressure = force / (length * length);
    match law {
        Law::Hertz(l) => Hertz::new(l.stiffness_n_m1_5 * force / length.powf(1.5)).unwrap().into(),
        Law::Viscous(l) => {
            let stiffness = l.stiffness_n_m1_5 * force / length.powf(1.5);
            Viscous::new(stiffness, l.damping_s_m * time / length).unwrap().into()
        }
        Law::Hysteretic(l) => Law::from(Hysteretic {
            stiffness_n_m1_5: l.stiffness_n_m1_5 * force / length.powf(1.5),
            epsilon_m: l.epsilon_m * length,
            ..l
        }),
        Law::LinearSpring(l) => LinearSpring::new(l.stiffness_n_m * force / length).unwrap().into(),
        Law::KelvinVoigt(l) => {
            KelvinVoigt::new(l.stiffness_n_m * force / length, l.damping_n_s_m * force * time / length).unwrap().into()
        }
        Law::HuntCrossley(l) => {
            let stiffness = l.stiffness_n_m_n * force / length.powf(l.exponent);
            HuntCrossley::new(stiffness, l.exponent, l.damping_s_m * time / length).unwrap().into()
        }
        Law::Thornton(l) => {
            let (modulus, radius) = (l.effective_modulus_pa * pressure, l.effective_radius_m * length);
            Thornton::new(modulus, radius, l.yield_pressure_pa * pressure).unwrap().into()
        }
        other => unreachable!("{} is not among the laws drawn", other.name()),
    }
}

fn stepped() -> impl Strategy<Value = Beam> {
    let end = prop_oneof![Just(End::Clamped), Just(End::Pinned), Just(End::Free), Just(End::Guided)];
    let segment = (0.2..1.0f64, decades(2.0, 3.0), decades(-0.5, 0.5)).prop_map(
        |(length_m, flexural_rigidity_n_m2, mass_per_length_kg_m)| Segment {
            length_m,
            flexural_rigidity_n_m2,
            mass_per_length_kg_m,
        },
    );
    (proptest::collection::vec(segment, 1..4), end.clone(), end)
        .prop_map(|(segments, left, right)| Beam { segments, ends: [left, right] })
}

proptest! {
    #![proptest_config(config(60))]

    #[test]
    fn a_beam_and_its_mirror_image(
        beam in stepped(), share in 0.05..0.95f64, count in 3usize..30, damping in ordinary_damping(),
        striker in ordinary_striker(), law in ordinary_law(),
    ) {
        let x = share * beam.length_m();
        let mirrored = Beam {
            segments: beam.segments.iter().rev().copied().collect(),
            ends: [beam.ends[1], beam.ends[0]],
        };
        let here = Impact { structure: seen_from(&beam, x, count, damping), striker, law };
        let there = Impact { structure: seen_from(&mirrored, beam.length_m() - x, count, damping), striker, law };
        agree(&here.solve(TOLERANCE), &there.solve(TOLERANCE))?;
    }

    /// A dimensionless number does not depend on the units of mass, length and time. With fixed values in other units this is
    /// scaling: bodies `mass` times heavier, `length` times larger, `time` times slower.
    #[test]
    fn other_units_and_similar_impacts(
        impact in ordinary_impact(), mass in decades(-3.0, 3.0), length in decades(-3.0, 3.0), time in decades(-3.0, 3.0),
    ) {
        let modes = impact.structure.modes.iter().map(|mode| Mode {
            omega_rad_s: mode.omega_rad_s / time,
            shape: mode.shape / mass.sqrt(),
            ..*mode
        });
        let other = Impact {
            structure: Structure { modes: modes.collect() },
            striker: Striker {
                mass_kg: impact.striker.mass_kg * mass,
                speed_m_s: impact.striker.speed_m_s * length / time,
            },
            law: in_units(impact.law, mass, length, time),
        };
        agree(&impact.solve(TOLERANCE), &other.solve(TOLERANCE))?;
    }

    /// An impact without losses, run backwards from its end, returns the striker's initial speed.
    #[test]
    fn time_reversed(structure in ordinary_structure(Just(0.0)), striker in ordinary_striker(), law in conservative_law()) {
        let solver = Solver::new(&structure).unwrap();
        // Forward and back at one tolerance: the returned speed.
        let round_trip = |tolerance: f64| {
            let there = solver.solve(&striker, &law, None, &settings(tolerance)).unwrap();
            let rate = there.rate.iter().map(|rate| -rate).collect();
            let start = Start { amplitude: there.amplitude, rate, gap_m: 0.0 };
            let back = Striker { mass_kg: striker.mass_kg, speed_m_s: there.striker_velocity_m_s };
            let again = solver.solve(&back, &law, Some(&start), &settings(tolerance)).unwrap();
            (there.outcome, there.striker_velocity_m_s, again.outcome, again.striker_velocity_m_s)
        };
        let (there, away, back, returned) = round_trip(1e-12);
        prop_assert_eq!((there, back), (Outcome::Rebound, Outcome::Rebound));
        // If the structure moves away faster than the striker, they never touch again, in either direction of time.
        prop_assume!(away > 0.0);
        // The way back amplifies errors of the whole state, which no stated uncertainty covers. The uncertainty of the round
        // trip is estimated from 32 and 8 times the tolerance, and five times the difference if it is amplified.
        let spread = [3.2e-11, 8e-12].map(|tolerance| (round_trip(tolerance).3 - returned).abs());
        let spread = spread[0].max(spread[1]);
        let times = if spread > 1e-12 * striker.speed_m_s { 5.0 } else { 2.5 };
        let allowed = 5e-12 * striker.speed_m_s + times * spread;
        // If an impact amplifies errors by 1e9, the way back has no correct digits, and the estimate, a difference of two
        // numbers, may be wrong.
        prop_assume!(allowed < 1e-3 * striker.speed_m_s);
        let error = (returned - striker.speed_m_s).abs();
        prop_assert!(error <= allowed, "{:e} m/s, allowed {:e}", error, allowed);
    }

    /// A mode is equivalent to two of its frequency that share its `phi^2`.
    #[test]
    fn a_mode_split_in_two(impact in ordinary_impact(), which in any::<prop::sample::Index>(), angle in 0.0..1.57f64) {
        let mut split = impact.clone();
        let mode = &mut split.structure.modes[which.index(impact.structure.modes.len())];
        let twin = Mode { shape: mode.shape * angle.sin(), ..*mode };
        mode.shape *= angle.cos();
        split.structure.modes.push(twin);
        agree(&impact.solve(TOLERANCE), &split.solve(TOLERANCE))?;
    }

    /// Nearly equal frequencies give the same result as equal ones.
    #[test]
    fn a_mode_split_in_two_of_nearly_equal_frequency(
        impact in ordinary_impact(), which in any::<prop::sample::Index>(), apart in decades(-16.0, -13.0),
    ) {
        let mut split = impact.clone();
        let mode = &mut split.structure.modes[which.index(impact.structure.modes.len())];
        mode.shape *= 0.5f64.sqrt();
        let twin = Mode { omega_rad_s: mode.omega_rad_s * (1.0 + apart), ..*mode };
        split.structure.modes.push(twin);
        agree(&impact.solve(TOLERANCE), &split.solve(TOLERANCE))?;
    }

    /// Representation of the modes: their order, the signs of their shapes, and modes with a node at the contact, even if rounding
    /// gives them a shape there. None of these changes a single bit.
    #[test]
    fn equivalent_lists_of_modes(
        impact in ordinary_impact(), signs in any::<u64>(), unexcited in decades(0.0, 9.0), rounded in -1e-15..1e-15,
    ) {
        let mut other = impact.clone();
        for (k, mode) in other.structure.modes.iter_mut().enumerate() {
            if signs >> (k % 64) & 1 == 1 {
                mode.shape = -mode.shape;
            }
        }
        other.structure.modes.reverse();
        let largest = other.structure.modes.iter().map(|mode| mode.shape.abs()).fold(0.0, f64::max);
        other.structure.modes.push(Mode { omega_rad_s: unexcited, damping_ratio: 0.01, shape: rounded * largest });
        let (a, b) = (impact.solve(TOLERANCE), other.solve(TOLERANCE));
        prop_assert_eq!(a.restitution, b.restitution);
        prop_assert_eq!(a.sub_impacts, b.sub_impacts);
        prop_assert_eq!(b.amplitude.last(), Some(&0.0));
    }

    /// A mode that the contact does not excite moves the contact all the same if it moves before the impact. A hundred times its
    /// shape with a hundredth of its motion is the same motion of the contact.
    #[test]
    fn motion_of_a_mode_that_is_not_excited(impact in ordinary_impact(), omega in decades(1.0, 5.0), speed in -0.3..0.3f64) {
        let solve = |factor: f64| {
            let mut structure = impact.structure.clone();
            let count = structure.modes.len();
            let largest = structure.modes.iter().map(|mode| mode.shape.abs()).fold(0.0, f64::max);
            let shape = factor * 1e-14 * largest;
            structure.modes.push(Mode { omega_rad_s: omega, damping_ratio: 0.01, shape });
            let mut start = Start::at_rest(count + 1);
            start.rate[count] = speed * impact.striker.speed_m_s / shape;
            let solver = Solver::new(&structure).unwrap();
            solver.solve(&impact.striker, &impact.law, Some(&start), &settings(TOLERANCE)).unwrap()
        };
        let (not_excited, excited) = (solve(1.0), solve(100.0));
        agree(&not_excited, &excited)?;
        // a contact at other velocities
        let still = impact.solve(TOLERANCE);
        let impulse = |solution: &Solution| solution.sub_impacts.first().map(|first| first.impulse_n_s);
        prop_assert!(speed.abs() < 1e-3 || impulse(&not_excited) != impulse(&still));
    }
}
