//! What every law promises to an integrator, along random motions.

mod common;

use common::{Motion, laws, motions, release_level, walk};
use contact_models::{Boundary, Branch, ContactLaw, Law, Memory, trace};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: RngSeed::Fixed(31617), ..ProptestConfig::default() })]

    /// Never a pull inside the boundaries, and derivatives that are those of the force.
    #[test]
    fn force_and_derivatives(law in laws(), motion in motions()) {
        for state in walk(&law, &motion).states {
            let (branch, xi, v) = (state.branch, state.compression_m, state.rate_m_s);
            let force = law.force(&branch, xi, v);
            prop_assert!(force.force_n >= -1e-12, "{law:?} {state:?} {force:?}");
            // away from the square root's end, where differences would measure only themselves
            let depth = xi - release_level(&law, &branch);
            if depth < 1e-3 {
                continue;
            }
            let (h, g) = (1e-5 * depth, 1e-5);
            let difference = |a: f64, b: f64, step: f64| (a - b) / (2.0 * step);
            // the whole stencil must lie in the branch, and on one side of its anchor
            let within = |b: &Boundary| {
                b.margin(xi, v) > 2.0 * (b.per_compression.abs() * h + b.per_rate.abs() * g)
            };
            let inside = law.boundaries(&branch).iter().all(within) && (xi - branch.anchor_m).abs() > 2.0 * h;
            if inside {
                let at = |xi: f64, v: f64| law.force(&branch, xi, v).force_n;
                let by_compression = difference(at(xi + h, v), at(xi - h, v), h);
                let by_rate = difference(at(xi, v + g), at(xi, v - g), g);
                let scale = 1e-7 * (1.0 + by_compression.abs() + force.force_n / depth);
                prop_assert!((force.per_compression_n_m - by_compression).abs() < scale, "{law:?} {state:?} {by_compression} {force:?}");
                prop_assert!((force.per_rate_n_s_m - by_rate).abs() < 1e-8 * (1.0 + force.force_n), "{law:?} {state:?}");
                prop_assert!(law.depends_on_rate() || force.per_rate_n_s_m == 0.0);
            }
        }
    }

    /// From one branch to the next the force is continuous, at a release it is zero, and the next
    /// branch is valid where it begins.
    #[test]
    fn crossings(law in laws(), motion in motions()) {
        for crossing in walk(&law, &motion).crossings {
            let jump = (crossing.force_before_n - crossing.force_after_n).abs();
            // rounding of a motion of order 1, through the slopes
            let (xi, v) = (crossing.compression_m, crossing.rate_m_s);
            let spread = |branch: Branch| {
                let slopes = law.force(&branch, xi, v);
                slopes.per_compression_n_m.abs() * (1.0 + xi.abs()) + slopes.per_rate_n_s_m.abs() * (1.0 + v.abs())
            };
            let scale = 1.0 + spread(crossing.branch_before) + crossing.branch_after.map_or(0.0, spread);
            prop_assert!(jump < 1e-13 * scale, "{law:?} {crossing:?}");
            prop_assert!(crossing.margin_after > -1e-12, "{law:?} {crossing:?}");
        }
    }

    /// The force is finite for every finite compression and rate, and continuous across the
    /// boundaries of its branch.
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
        }
        for crossing in &walk.crossings {
            let (branch, xi, v) = (crossing.branch_before, crossing.compression_m, crossing.rate_m_s);
            let here = law.force(&branch, xi, v);
            // steep where much damped, and where a hysteretic branch begins right at zero
            let steepness = here.per_compression_n_m.abs() + here.per_rate_n_s_m.abs();
            let here = here.force_n;
            for (dxi, dv) in [(1e-10, 0.0), (-1e-10, 0.0), (0.0, 1e-10), (0.0, -1e-10)] {
                let near = law.force(&branch, xi + dxi, v + dv).force_n;
                prop_assert!((near - here).abs() < 1e-7 * (1.0 + here + steepness), "{law:?} {crossing:?} {here} {near}");
            }
        }
    }

    /// Whatever is asked of a law from outside gives finite numbers.
    #[test]
    fn any_memory_and_approach(law in laws(), touch in any::<f64>(), internal in any::<f64>(), speed in any::<f64>(),
                               xi in any::<f64>(), v in any::<f64>()) {
        prop_assume!(xi.is_finite() && v.is_finite());
        let branch = law.touch(&Memory { touch_m: touch, internal }, speed);
        let force = law.force(&branch, xi, v);
        let numbers = [force.force_n, force.per_compression_n_m, force.per_rate_n_s_m, law.stored_energy_j(&branch, xi)];
        prop_assert!(numbers.iter().all(|number| number.is_finite()), "{law:?} {branch:?} {force:?}");
    }

    /// Work done on a contact is stored or dissipated, never made. Conservative laws dissipate
    /// nothing; the hysteretic law is only bound over complete contacts.
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

    /// The stored energy is what a slow unloading returns.
    #[test]
    fn stored_energy(law in laws(), motion in motions()) {
        // follow the motion for a while, then let go slowly; rate laws forget their damping
        let slow = 1e-9;
        for state in walk(&law, &motion).states.iter().step_by(37) {
            let returned = common::unload(&law, state, slow);
            let stored = law.stored_energy_j(&state.branch, state.compression_m);
            prop_assert!((returned - stored).abs() < 1e-4 * (stored + 1e-6), "{law:?} {state:?} {returned} {stored}");
        }
    }
}

/// The random motions reach every kind of branch of every law.
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
