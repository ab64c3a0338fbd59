//! Structures that move against an immovable stop: whether they meet it, separate from it for good, or stay pressed against it.

use crate::common;

use crate::common::random::{cases, decades};
use crate::common::settings;
use beam_modes::{Beam, End, Segment};
use contact_models::{Hertz, Hysteretic, KelvinVoigt, Law, LinearSpring, Thornton, Viscous};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use vibroimpact_sim::StopReason;
use vibroimpact_sim::modal::{Mode, Outcome, Settings, Solution, Solver, Start, Striker, Structure};

const STOP: Striker = Striker { mass_kg: f64::INFINITY, speed_m_s: 0.0 };

fn segment(length_m: f64, youngs_pa: f64, density_kg_m3: f64, width_m: f64, thickness_m: f64) -> Segment {
    let area = width_m * thickness_m;
    let flexural_rigidity_n_m2 = youngs_pa * area * thickness_m * thickness_m / 12.0;
    Segment { length_m, flexural_rigidity_n_m2, mass_per_length_kg_m: density_kg_m3 * area }
}

/// The first mode in motion, at a gap from the stop; its shape at the contact is taken as positive.
fn swing(structure: &mut Structure, amplitude: f64, rate: f64, gap_m: f64) -> Start {
    structure.modes[0].shape = structure.modes[0].shape.abs();
    let mut start = Start::at_rest(structure.modes.len());
    (start.amplitude[0], start.rate[0], start.gap_m) = (amplitude, rate, gap_m);
    start
}

fn run(structure: &Structure, law: &Law, start: &Start, settings: &Settings) -> Solution {
    Solver::new(structure).unwrap().solve(&STOP, law, Some(start), settings).unwrap()
}

/// A structure that vibrates at a distance from a stop and comes to rest without reaching it: a double-double integration with
/// a certified search finds no contact.
#[test]
fn a_damped_vibration_that_never_meets_the_stop() {
    let segments = vec![
        segment(0.5190888196463543, 239502084789.586, 4876.4439580942635, 0.022134036069978515, 0.0065336823462030695),
        segment(0.057180895682550865, 239502084789.586, 4876.4439580942635, 0.013831915788182705, 0.010115847471865448),
    ];
    let beam = Beam { segments, ends: [End::Clamped, End::Free] };
    let mut structure = common::seen_from(&beam, 0.5237707522307051, 4, 0.06942620785490441);
    let law = LinearSpring::new(1331455.0598917613).unwrap().into();
    let start = swing(&mut structure, 0.00021103275385075677, -0.040317806601896516, 9.984521182300136e-05);
    let solution = run(&structure, &law, &start, &settings(1e-9));
    assert_eq!(solution.outcome, Outcome::NoContact);
    assert!(solution.counts.flight_steps < 1_000, "{:?}", solution.counts);
}

fn pressed() -> (Structure, Law, Start) {
    let side =
        segment(2.5833220045058454, 4696056540.349268, 2066.807283870774, 0.029464749313228653, 0.01421777260481008);
    let beam = Beam { segments: vec![side], ends: [End::Clamped, End::Pinned] };
    let mut structure = common::seen_from(&beam, 1.2916610022529227, 82, 0.03265883398378135);
    let law = LinearSpring::new(342350.1910606336).unwrap().into();
    let start = swing(&mut structure, -0.02466458593461805, -0.11053904841146346, 0.009596806696985103);
    (structure, law, start)
}

/// A beam that is deflected away from a stop, springs back and comes to rest against it: its static state is known in closed
/// form.
#[test]
fn a_beam_that_comes_to_rest_against_a_stop() {
    let (structure, law, start) = pressed();
    let solution = run(&structure, &law, &start, &settings(1e-9));
    assert_eq!(solution.outcome, Outcome::Sustained);
    // When it has come to rest, its position is that of statics.
    let until = 40.0;
    let further = Settings { until_s: until, ..settings(1e-9) };
    let (same, history) = Solver::new(&structure).unwrap().record(&STOP, &law, Some(&start), &further).unwrap();
    assert_eq!((same.outcome, same.sub_impacts.len()), (Outcome::Sustained, solution.sub_impacts.len()));
    assert!(history.known_until_s() >= until && same.end_s >= until, "{}", same.end_s);
    let (now, undeformed) = (history.at(until), -start.gap_m - structure.modes[0].shape * start.amplitude[0]);
    let compliance: f64 = structure.modes.iter().map(|mode| (mode.shape / mode.omega_rad_s).powi(2)).sum();
    let compression = undeformed / (1.0 + 342350.1910606336 * compliance);
    assert!(undeformed > 0.0 && (now.compression_m / compression - 1.0).abs() < 1e-6, "{now:?} {compression}");
    assert!(now.structure_velocity_m_s.abs() < 1e-9);
}

/// Without damping some motion of a structure never decays; the bodies stay together once its energy cannot separate them.
#[test]
fn a_structure_without_damping_is_held_by_its_preload() {
    let (mut structure, ..) = pressed();
    structure.modes.truncate(10);
    for mode in &mut structure.modes {
        mode.damping_ratio = 0.0;
    }
    // Released at the surface of the stop, with one mode in motion; only the contact dissipates energy.
    let law = Law::from(KelvinVoigt::new(3e4, 100.0).unwrap());
    let static_compliance = |mode: &Mode| (mode.shape / mode.omega_rad_s).powi(2);
    let compliance: f64 = structure.modes.iter().map(static_compliance).sum();
    let (mut start, undeformed) = (Start::at_rest(10), 1e-3);
    for (k, mode) in structure.modes.iter().enumerate() {
        start.amplitude[k] = -mode.shape / mode.omega_rad_s.powi(2) * undeformed / compliance;
    }
    start.rate[1] = 0.003;
    let solution = run(&structure, &law, &start, &settings(1e-9));
    assert_eq!(solution.outcome, Outcome::Sustained);
    assert!(solution.counts.contact_steps < 20_000, "{:?}", solution.counts);
}

fn any_law() -> impl Strategy<Value = Law> {
    let stiffness = || decades(4.0, 7.0);
    prop_oneof![
        3 => stiffness().prop_map(|k| Law::from(LinearSpring::new(k).unwrap())),
        2 => decades(6.0, 10.0).prop_map(|k| Law::from(Hertz::new(k).unwrap())),
        1 => (stiffness(), decades(0.0, 2.0)).prop_map(|(k, c)| KelvinVoigt::new(k, c).unwrap().into()),
        1 => (decades(6.0, 10.0), decades(-3.0, 0.0)).prop_map(|(k, c)| Viscous::new(k, c).unwrap().into()),
        1 => decades(6.0, 10.0).prop_map(|k| Hysteretic { stiffness_n_m1_5: k, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m: 1e-7 }.validated().unwrap().into()),
        1 => (decades(9.0, 11.0), decades(8.0, 9.5)).prop_map(|(e, y)| Thornton::new(e, 0.01, y).unwrap().into()),
    ]
}

/// Damped beams in any motion, in front of stops that they press on, meet or pass: each run ends with the true outcome,
/// separate forever or together forever. A stop that the undeformed beam just touches is excluded, because its contacts never
/// end.
#[test]
fn every_damped_motion_before_a_stop_ends() {
    let ends =
        prop::sample::select(vec![[End::Clamped, End::Free], [End::Clamped, End::Pinned], [End::Pinned, End::Pinned]]);
    let strategy = (
        (ends, 1usize..40, decades(-2.5, -0.5), 0.1..0.95f64),
        (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64, prop_oneof![-0.9..-0.02f64, 0.02..1.5f64]),
        any_law(),
    );
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[14; 32]);
    let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
    let mut counts = [0; 3];
    for case in 0..cases(236) {
        let ((ends, n, damping, share), (displaced, moving, second, beyond), law) =
            strategy.new_tree(&mut runner).unwrap().current();
        let beam = Beam { segments: vec![segment(0.8, 2e11, 7800.0, 0.03, 0.005)], ends };
        let structure = common::seen_from(&beam, 0.8 * share, n, damping);
        let mut start = Start::at_rest(n);
        let size = 5e-3;
        let mut swings = 0.0;
        for (k, parts) in [(displaced, moving), (0.1 * second, 0.1 * moving)].into_iter().enumerate().take(n) {
            let Mode { shape, omega_rad_s, .. } = structure.modes[k];
            start.amplitude[k] = size * parts.0;
            start.rate[k] = size * omega_rad_s * parts.1;
            swings += (shape * size).abs() * parts.0.hypot(parts.1);
        }
        // The stop is beyond the undeformed surface, or in front of it: then the structure starts deflected away from it.
        let stop = beyond * swings;
        let now: f64 = structure.modes.iter().zip(&start.amplitude).map(|(mode, a)| mode.shape * a).sum();
        start.gap_m = stop - now;
        if start.gap_m < 0.0 {
            continue;
        }
        let once = Settings { estimate_uncertainty: false, ..settings(1e-8) };
        let solution = run(&structure, &law, &start, &once);
        let what = format!("case {case}: {law:?}, N = {n}, damping {damping}, stop at {stop:e}: {solution:?}");
        match solution.outcome {
            Outcome::NoContact => counts[0] += 1,
            Outcome::Rebound => counts[1] += 1,
            Outcome::Sustained => counts[2] += 1,
            _ => panic!("{what}"),
        }
        // Statics decides which contacts last.
        assert_eq!(solution.outcome == Outcome::Sustained, stop < 0.0, "{what}");
    }
    assert!(counts.iter().all(|count| *count >= 10), "{counts:?}");
}

/// The amplitude of an undamped vibration is below the stop by less than rounding: the search reports that it gave up, and why.
#[test]
fn a_search_without_end_is_named() {
    let mode = |omega_rad_s: f64| Mode { omega_rad_s, damping_ratio: 0.0, shape: 1.0 };
    let structure = Structure { modes: vec![mode(100.0), mode(100.0 * 2f64.sqrt())] };
    let mut start = Start::at_rest(2);
    (start.amplitude, start.gap_m) = (vec![-1e-3, -1e-3], 4e-3 * (1.0 - 1e-9));
    let law = LinearSpring::new(1e5).unwrap().into();
    let few = Settings { max_steps: 2_000, ..settings(1e-9) };
    assert_eq!(run(&structure, &law, &start, &few).outcome, Outcome::Stopped(StopReason::Flight));
}
