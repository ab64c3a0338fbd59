//! The properties of every law on which an integrator relies, along random motions.

use crate::common;

use crate::common::{Motion, laws, motions, walk};
use contact_models::{ContactLaw, Force, Hysteretic, Law, Memory, check_contract, check_contract_along, trace};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: RngSeed::Fixed(31617), ..ProptestConfig::default() })]

    /// Every law of the crate passes the test that is meant for your own laws.
    #[test]
    fn required_properties(law in laws(), motion in motions()) {
        let kept = check_contract_along(&law, &motion.times(), |t| motion.at(t));
        prop_assert!(kept.is_ok(), "{law:?} {}", kept.unwrap_err());
    }

    /// The force is finite for every finite compression and rate, and continuous across the boundaries of its branch.
    #[test]
    fn extension(law in laws(), motion in motions(), xi in prop_oneof![-3.0..3.0_f64, any::<f64>()],
                 v in prop_oneof![-9.0..9.0_f64, any::<f64>()]) {
        prop_assume!(xi.is_finite() && v.is_finite());
        let walk = walk(&law, &motion);
        for state in &walk.states {
            let force = law.force(&state.branch, xi, v);
            let energy = law.stored_energy_j(&state.branch, xi);
            let numbers = [force.force_n, force.per_compression_n_m, force.per_rate_n_s_m, energy];
            prop_assert!(numbers.iter().all(|number| number.is_finite()), "{law:?} {state:?} {force:?} {energy}");
            prop_assert!(law.stored_energy_j(&state.branch, state.compression_m) >= 0.0, "{law:?} {state:?}");
            let mut both = [Force::ZERO; 2];
            law.forces(&state.branch, &[state.compression_m, xi], &[-v, v], &mut both);
            prop_assert_eq!(both, [law.force(&state.branch, state.compression_m, -v), force]);
        }
        for crossing in &walk.crossings {
            let (branch, xi, v) = (crossing.branch_before, crossing.compression_m, crossing.rate_m_s);
            let here = law.force(&branch, xi, v);
            // The force is steep if the damping is large, and where a hysteretic branch begins at zero.
            let steepness = here.per_compression_n_m.abs() + here.per_rate_n_s_m.abs();
            let here = here.force_n;
            for (dxi, dv) in [(1e-10, 0.0), (-1e-10, 0.0), (0.0, 1e-10), (0.0, -1e-10)] {
                let near = law.force(&branch, xi + dxi, v + dv).force_n;
                prop_assert!((near - here).abs() < 1e-7 * (1.0 + here + steepness), "{law:?} {crossing:?} {here} {near}");
            }
        }
    }

    /// A law gives finite numbers for any arguments.
    #[test]
    fn any_memory_and_approach(law in laws(), touch in any::<f64>(), internal in any::<f64>(), speed in any::<f64>(),
                               xi in any::<f64>(), v in any::<f64>()) {
        prop_assume!(xi.is_finite() && v.is_finite());
        let branch = law.touch(&Memory { touch_m: touch, internal: [internal].into() }, speed);
        let force = law.force(&branch, xi, v);
        let numbers = [force.force_n, force.per_compression_n_m, force.per_rate_n_s_m, law.stored_energy_j(&branch, xi)];
        prop_assert!(numbers.iter().all(|number| number.is_finite()), "{law:?} {branch:?} {force:?}");
    }

    /// Work done on a contact is stored or dissipated, never created. Conservative laws dissipate nothing; the hysteretic law
    /// is only tested over complete contacts.
    #[test]
    fn energy(law in laws(), motion in motions()) {
        let path = trace(&law, &motion.times(), |t| motion.at(t)).unwrap();
        let tolerance = 1e-8 * path.iter().map(|point| point.work_j.abs()).fold(1e-3, f64::max);
        let mut dissipated = 0.0;
        for point in &path {
            let now = point.work_j - point.stored_energy_j;
            match law {
                Law::Hertz(_) | Law::LinearSpring(_) | Law::Power(_) => prop_assert!(now.abs() < tolerance, "{law:?} {point:?}"),
                Law::Hysteretic(_) => {
                    if point.stored_energy_j == 0.0 {
                        prop_assert!(now > dissipated - tolerance, "{law:?} {point:?} {dissipated}");
                        dissipated = now;
                    }
                }
                _ => {
                    prop_assert!(now > dissipated - tolerance, "{law:?} {point:?} {dissipated}");
                    dissipated = now;
                }
            }
        }
        prop_assert_eq!(path.last().unwrap().stored_energy_j, 0.0);
    }

    /// The stored energy is the energy that a slow unloading returns.
    #[test]
    fn stored_energy(law in laws(), motion in motions()) {
        // Follow the motion for a while, then unload slowly, so that the damping of laws with a rate vanishes.
        let slow = 1e-9;
        for state in walk(&law, &motion).states.iter().step_by(37) {
            let returned = common::unload(&law, state, slow);
            let stored = law.stored_energy_j(&state.branch, state.compression_m);
            prop_assert!((returned - stored).abs() < 1e-4 * (stored + 1e-6), "{law:?} {state:?} {returned} {stored}");
        }
    }
}

/// The random motions visit every kind of branch of every law.
#[test]
fn random_motions_reach_every_stage() {
    use contact_models::Stage;
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::deterministic();
    let mut seen = std::collections::BTreeSet::new();
    for _ in 0..300 {
        let law = laws().new_tree(&mut runner).unwrap().current();
        let motion: Motion = motions().new_tree(&mut runner).unwrap().current();
        seen.extend(walk(&law, &motion).states.iter().map(|state| (law.name(), format!("{:?}", state.branch.stage))));
    }
    let expected: Vec<(&str, Vec<Stage>)> = vec![
        ("hertz", vec![Stage::Single]),
        ("linear", vec![Stage::Single]),
        ("power", vec![Stage::Single]),
        ("felt", vec![Stage::Single, Stage::Slack]),
        ("viscous", vec![Stage::Single, Stage::Slack]),
        ("hunt-crossley", vec![Stage::Single, Stage::Slack]),
        ("lankarani-nikravesh", vec![Stage::Single, Stage::Slack]),
        ("flores", vec![Stage::Single, Stage::Slack]),
        ("kelvin-voigt", vec![Stage::Single, Stage::Slack]),
        ("hysteretic", vec![Stage::Loading, Stage::Unloading]),
        ("thornton", vec![Stage::Single, Stage::Loading]),
    ];
    for (name, stages) in expected {
        for stage in stages {
            assert!(seen.contains(&(name, format!("{stage:?}"))), "{name} never reaches {stage:?}");
        }
    }
}

/// The same on the scales of impacts, by the motions of the library.
#[test]
fn laws_have_the_required_properties_on_any_scale() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::deterministic();
    for _ in 0..60 {
        let law = laws().new_tree(&mut runner).unwrap().current();
        for (compression_m, speed_m_s) in [(1.0, 1.0), (1e-5, 1.0), (1e-3, 0.01), (0.1, 30.0)] {
            let kept = check_contract(&law, compression_m, speed_m_s);
            assert!(kept.is_ok(), "{law:?} {compression_m} {speed_m_s}: {}", kept.unwrap_err());
        }
    }
}

/// The widest hysteresis that is allowed leaves a force near zero on unloading, and the internal variable may follow the compression as
/// any power up to a thousand: a long run checks the law, and must not stop.
#[test]
fn hysteretic_laws_at_the_ends_of_their_range_keep_the_contract() {
    let cases = [
        (0.0156, 9.1, 0.0, 3e-8),
        (1.6, 10.6, 1.3e-6, 1e-4),
        (50.0, 53.4, 7.7e-6, 1e-3),
        (90.037, 654.0, 0.0, 1e-7),
        (1.6, 1000.0, 0.0, 1.0),
    ];
    for (theta_m, k_bar, epsilon_m, compression_m) in cases {
        let law = Hysteretic { stiffness_n_m1_5: 1e8, theta_m, beta: 1.0 + theta_m, k_bar, epsilon_m };
        let kept = check_contract(&law.validated().unwrap(), compression_m, 1.0);
        assert!(kept.is_ok(), "{law:?} {}", kept.unwrap_err());
    }
}
