//! Random impacts over many decades: every one ends, with finite numbers, no energy gained, and an honest error bar.

mod common;

use common::{ball, hertz, pinned, settings};
use contact_models::{
    Flores, Hertz, HuntCrossley, Hysteretic, KelvinVoigt, LankaraniNikravesh, Law, LinearSpring, Thornton, Viscous,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use vibroimpact_sim::modal::{Mode, Outcome, Settings, Solver, Striker, Structure};

/// Numbers spread evenly over the decades `10^from .. 10^to`.
fn decades(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from..to).prop_map(|x| 10f64.powf(x))
}

fn law() -> impl Strategy<Value = Law> {
    let stiffness = || decades(2.0, 14.0);
    prop_oneof![
        stiffness().prop_map(|k| Hertz::new(k).unwrap().into()),
        (stiffness(), decades(-4.0, 2.0)).prop_map(|(k, c)| Viscous::new(k, c).unwrap().into()),
        (stiffness(), decades(-10.0, -3.0))
            .prop_map(|(k, epsilon)| Hysteretic::new(k, 1.6, 1.4, 0.4, epsilon).unwrap().into()),
        stiffness().prop_map(|k| LinearSpring::new(k).unwrap().into()),
        (stiffness(), decades(-3.0, 5.0)).prop_map(|(k, c)| KelvinVoigt::new(k, c).unwrap().into()),
        (stiffness(), 1.0..3.0, decades(-3.0, 2.0)).prop_map(|(k, n, d)| HuntCrossley::new(k, n, d).unwrap().into()),
        (stiffness(), 0.01..1.0).prop_map(|(k, e)| LankaraniNikravesh::new(k, e).unwrap().into()),
        (stiffness(), 0.05..1.0).prop_map(|(k, e)| Flores::new(k, e).unwrap().into()),
        (decades(6.0, 12.0), decades(-3.0, 0.0), decades(5.0, 10.0))
            .prop_map(|(modulus, radius, yields)| Thornton::new(modulus, radius, yields).unwrap().into()),
    ]
}

fn structure() -> impl Strategy<Value = Structure> {
    let damping = prop_oneof![Just(0.0), decades(-4.0, 1.0)];
    let compliance = prop_oneof![4 => Just(0.0), 1 => decades(-12.0, -6.0)];
    let rigid = prop_oneof![2 => Just(None), 1 => decades(-2.0, 1.0).prop_map(Some)];
    (0usize..30, decades(0.0, 5.0), 1i32..3, damping, 0.0..1.0f64, compliance, rigid).prop_map(
        |(n, first, power, damping_ratio, place, residual_compliance_m_n, rigid)| {
            let elastic = (1..=n).map(|k| Mode {
                omega_rad_s: first * (k as f64).powi(power),
                damping_ratio,
                shape: 1.4 * (std::f64::consts::PI * k as f64 * place).sin(),
            });
            let rigid = rigid.map(|shape| Mode { omega_rad_s: 0.0, damping_ratio: 0.0, shape });
            Structure { modes: elastic.chain(rigid).collect(), residual_compliance_m_n }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, rng_seed: RngSeed::Fixed(2019), failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn every_impact_ends_with_sound_numbers(
        structure in structure(),
        law in law(),
        mass_kg in decades(-6.0, 4.0),
        speed_m_s in decades(-6.0, 3.0),
    ) {
        let mut solver = Solver::new(&structure).unwrap();
        let settings = Settings { max_steps: 20_000, ..settings(1e-8) };
        let solution = solver.solve(&Striker { mass_kg, speed_m_s }, &law, None, &settings).unwrap();
        prop_assert!(solution.outcome != Outcome::NoContact);
        prop_assert!(!solution.sub_impacts.is_empty());
        for contact in &solution.sub_impacts {
            prop_assert!(contact.end_s >= contact.start_s && contact.end_s.is_finite());
            prop_assert!(contact.impulse_n_s >= -1e-6 * mass_kg * speed_m_s, "{contact:?} of {}", solution.sub_impacts.len());
            prop_assert!(contact.peak_force_n.is_finite() && contact.peak_compression_m.is_finite());
        }
        if let Some(restitution) = solution.restitution {
            prop_assert!((-1.0..=1.0 + 1e-7).contains(&restitution), "{}", restitution);
            prop_assert!(solution.restitution_uncertainty.unwrap() >= 0.0);
        }
        prop_assert!(solution.amplitude.iter().chain(&solution.rate).all(|value| value.is_finite()));
    }
}

#[test]
fn coarse_tolerances_end_too() {
    for tolerance in [1e-4, 1e-3, 1e-2, 0.1] {
        for n in [5, 25, 40, 100] {
            for location in [0.05, 0.4, 0.618] {
                let structure = pinned(n, 0.02, location);
                let settings = Settings { max_steps: 5_000, ..settings(tolerance) };
                let solution = Solver::new(&structure).unwrap().solve(&ball(), &hertz(), None, &settings).unwrap();
                assert_eq!(solution.outcome, Outcome::Rebound, "N = {n}, tolerance {tolerance:e}, b = {location}");
            }
        }
    }
}

#[test]
fn places_without_motion_and_a_thousand_modes_are_ordinary() {
    // on the support nothing moves: a wall
    for n in [0, 1, 40, 1000] {
        let solution = Solver::new(&pinned(n, 0.02, 0.0)).unwrap();
        let mut solver = solution;
        let e = solver.solve(&ball(), &hertz(), None, &settings(1e-9)).unwrap().restitution.unwrap();
        assert!((e - 1.0).abs() < 1e-8);
    }
    // beside the support, and far more modes than the contact can stir
    for (n, b) in [(40, 1e-6), (1000, 0.4)] {
        let solution =
            Solver::new(&pinned(n, 0.02, b)).unwrap().solve(&ball(), &hertz(), None, &settings(1e-7)).unwrap();
        assert_eq!(solution.outcome, Outcome::Rebound);
        assert!(solution.restitution_uncertainty.unwrap() < 1e-4, "{:?}", solution.restitution_uncertainty);
    }
}

#[test]
fn the_error_bar_covers_the_error_on_random_damped_impacts() {
    let mut seed = 0x9e37_79b9_7f4a_7c15u64;
    let mut uniform = || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let (mut within, mut cases) = (0, 0);
    for _ in 0..120 {
        let structure = pinned((5.0 + 60.0 * uniform()) as usize, 0.05 * uniform(), uniform());
        let striker = Striker { mass_kg: 0.01 + 0.5 * uniform(), speed_m_s: 0.1 + 2.0 * uniform() };
        let mut solver = Solver::new(&structure).unwrap();
        let reference = solver.solve(&striker, &hertz(), None, &settings(1e-12)).unwrap().restitution.unwrap();
        let solution = solver.solve(&striker, &hertz(), None, &settings(1e-7)).unwrap();
        let error = (solution.restitution.unwrap() - reference).abs();
        cases += 1;
        within += usize::from(error <= solution.restitution_uncertainty.unwrap());
    }
    assert!(within * 100 >= 99 * cases, "{within} of {cases}");
}
