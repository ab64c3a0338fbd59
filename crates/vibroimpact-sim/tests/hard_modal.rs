//! Cases that are difficult for codes of impacts on modal structures, each with its expected result. Bounds on the errors are
//! at least five times the largest error measured at the tolerance 1e-9, rounded up to a power of ten.

use crate::common::random::{any_law, any_structure, config, decades};
use crate::common::{GOLDEN, ball, hertz, pinned, pinned_with_remainder, seen_from, settings};
use beam_modes::{Beam, End, Segment};
use contact_models::{Felt, Hertz, Hysteretic, KelvinVoigt, LankaraniNikravesh, Law, LinearSpring};
use proptest::prelude::*;
use vibroimpact_sim::StopReason;
use vibroimpact_sim::modal::{Mode, Outcome, Settings, Solution, Solver, Start, Striker, Structure};

/// The expected result of a case.
enum Expect {
    /// This restitution, within the stated uncertainty plus this amount.
    Restitution(f64, f64),
    /// The restitution of another description of the same impact, within the sum of both stated uncertainties.
    Same(Structure),
    /// A rebound whose restitution has this uncertainty.
    Rebound(f64),
    /// No contact that lasts and no energy gained; the limit on steps may be reached first.
    Sound,
}

struct Case {
    name: String,
    structure: Structure,
    striker: Striker,
    law: Law,
    expect: Expect,
}

fn case(name: impl Into<String>, structure: Structure, striker: Striker, law: Law, expect: Expect) -> Case {
    Case { name: name.into(), structure, striker, law, expect }
}

fn run(structure: &Structure, striker: &Striker, law: &Law) -> Solution {
    let settings = Settings { max_steps: 20_000, ..settings(1e-9) };
    Solver::new(structure).unwrap().solve(striker, law, None, &settings).unwrap()
}

/// Energy of striker and modes after the impact, over that before.
fn energy_kept(structure: &Structure, striker: &Striker, solution: &Solution) -> f64 {
    let modes = structure.modes.iter().zip(&solution.amplitude).zip(&solution.rate);
    let modal: f64 = modes.map(|((mode, a), b)| 0.5 * ((mode.omega_rad_s * a).powi(2) + b * b)).sum();
    let kinetic = |speed: f64| 0.5 * striker.mass_kg * speed * speed;
    (kinetic(solution.striker_velocity_m_s) + modal) / kinetic(striker.speed_m_s)
}

fn hold(cases: &[Case]) {
    for Case { name, structure, striker, law, expect } in cases {
        let solution = run(structure, striker, law);
        let stated = solution.restitution_uncertainty.unwrap_or(0.0);
        let e = solution.restitution.unwrap_or(f64::NAN);
        match expect {
            Expect::Restitution(expected, allowance) => {
                assert!((e - expected).abs() <= stated + allowance, "{name}: {e} +- {stated:e}, not {expected}");
                assert!(stated < 1e-7, "{name}: known to {stated:e}");
            }
            Expect::Same(other) => {
                let other = run(other, striker, law);
                let allowed = stated + other.restitution_uncertainty.unwrap();
                let difference = (e - other.restitution.unwrap()).abs();
                assert!(difference <= allowed, "{name}: differs by {difference:e}, stated {allowed:e}");
                assert!(allowed < 1e-7, "{name}: known to {allowed:e}");
            }
            Expect::Rebound(known) => {
                assert_eq!(solution.outcome, Outcome::Rebound, "{name}");
                assert!(stated <= *known, "{name}: known to {stated:e}");
            }
            Expect::Sound => assert_ne!(solution.outcome, Outcome::NoContact, "{name}"),
        }
        let kept = energy_kept(structure, striker, &solution);
        let allowed = 1.0 + 1e-10 * (1.0 + solution.sub_impacts.len() as f64);
        assert!(kept <= allowed, "{name}: energy times {kept}");
        assert!(solution.sub_impacts.windows(2).all(|pair| pair[0].end_s <= pair[1].start_s), "{name}");
    }
}

fn beam(ends: [End; 2]) -> Beam {
    let segment = Segment { length_m: 1.0, flexural_rigidity_n_m2: 274.0, mass_per_length_kg_m: 1.0 };
    Beam { segments: vec![segment], ends }
}

#[test]
fn locations() {
    let mut cases = Vec::new();
    for n in [0, 1, 40, 1000] {
        let name = format!("on the support, N = {n}: a wall");
        cases.push(case(name, pinned(n, 0.02, 0.0), ball(), hertz(), Expect::Restitution(1.0, 0.0)));
    }
    // So close to the support the beam differs from a wall by m sum phi^2 = 1e-8.
    let structure = pinned(40, 0.02, 1e-6);
    let z = ball().mass_kg * structure.modes.iter().map(|mode| mode.shape * mode.shape).sum::<f64>();
    assert!(z < 1e-6);
    cases.push(case("1e-6 of a support", structure, ball(), hertz(), Expect::Restitution(1.0, 2.0 * z)));
    // At midspan every second mode has a node.
    let mut odd = pinned(41, 0.02, 0.5);
    odd.modes = odd.modes.into_iter().step_by(2).collect();
    cases.push(case("on the node of 20 modes", pinned(41, 0.02, 0.5), ball(), hertz(), Expect::Same(odd)));
    let free = beam([End::Clamped, End::Free]);
    cases.push(case("free end", seen_from(&free, 1.0, 40, 0.02), ball(), hertz(), Expect::Rebound(1e-8)));
    let inside = seen_from(&free, 1.0 - 1e-12, 40, 0.02);
    cases.push(case("1e-12 of a free end", seen_from(&free, 1.0, 40, 0.02), ball(), hertz(), Expect::Same(inside)));
    // On a step, and within rounding of it on either side.
    let slim = Segment { length_m: 0.5, flexural_rigidity_n_m2: 34.0, mass_per_length_kg_m: 0.5 };
    let thick = Segment { length_m: 0.5, ..free.segments[0] };
    let stepped = Beam { segments: vec![thick, slim], ends: [End::Clamped, End::Free] };
    for aside in [-1e-13, 1e-13] {
        let beside = seen_from(&stepped, 0.5 + aside, 40, 0.02);
        let on = seen_from(&stepped, 0.5, 40, 0.02);
        cases.push(case(format!("on a step and {aside:e} m aside"), on, ball(), hertz(), Expect::Same(beside)));
    }
    cases.push(case("N = 1000", pinned(1000, 0.02, 0.4), ball(), hertz(), Expect::Rebound(1e-6)));
    hold(&cases);
}

/// From no mode to a thousand: the restitution is accurate to many digits at every number, and converges if remainder modes
/// represent the truncated modes.
#[test]
fn numbers_of_modes() {
    let mut cases = Vec::new();
    let mut last: Option<f64> = None;
    for n in [0u16, 1, 2, 3, 5, 10, 30, 100, 300, 1000] {
        let structure = pinned_with_remainder(n.into(), 0.02, 0.3);
        if n >= 30 {
            let e = run(&structure, &ball(), &hertz()).restitution.unwrap();
            let change = last.map_or(f64::INFINITY, |last| (e - last).abs());
            assert!(last.is_none() || change < 30.0 / f64::from(n).powi(2), "N = {n}: {e}, changed by {change:e}");
            last = Some(e);
        }
        cases.push(case(format!("N = {n}"), pinned(n.into(), 0.02, 0.3), ball(), hertz(), Expect::Rebound(1e-6)));
        cases.push(case(format!("N = {n}, remainder"), structure, ball(), hertz(), Expect::Rebound(1e-6)));
    }
    hold(&cases);
}

#[test]
fn twelve_decades() {
    let mut cases = Vec::new();
    for power in -6..=6 {
        let striker = Striker { mass_kg: 10f64.powi(power), ..ball() };
        // A striker a million times heavier than the beam is in contact for many thousands of steps.
        let expect = if power <= 4 { Expect::Rebound(1e-7) } else { Expect::Sound };
        cases.push(case(format!("mass 1e{power} kg"), pinned(40, 0.02, GOLDEN), striker, hertz(), expect));
    }
    for power in 2..=14 {
        let law = Law::from(Hertz::new(10f64.powi(power)).unwrap());
        let name = format!("stiffness 1e{power}");
        // Such stiff bodies distinguish motions of the beam that are very close to each other.
        let known = if power < 14 { 1e-5 } else { 1e-2 };
        cases.push(case(name, pinned(40, 0.02, GOLDEN), ball(), law, Expect::Rebound(known)));
    }
    for power in -6..=3 {
        let striker = Striker { speed_m_s: 10f64.powi(power), ..ball() };
        let name = format!("speed 1e{power} m/s");
        cases.push(case(name, pinned(40, 0.02, GOLDEN), striker, hertz(), Expect::Rebound(1e-5)));
    }
    hold(&cases);
    // With a linear contact the speed is only a factor.
    let law = Law::from(LinearSpring::new(1e6).unwrap());
    let at = |speed_m_s: f64| run(&pinned(40, 0.02, GOLDEN), &Striker { speed_m_s, ..ball() }, &law);
    let unit = at(1.0);
    for power in [-6, -3, 3] {
        let other = at(10f64.powi(power));
        let stated = unit.restitution_uncertainty.unwrap() + other.restitution_uncertainty.unwrap();
        assert!((unit.restitution.unwrap() - other.restitution.unwrap()).abs() <= stated);
        assert_eq!(unit.sub_impacts.len(), other.sub_impacts.len());
    }
}

#[test]
fn damping_and_frequencies() {
    let mut cases = Vec::new();
    for (damping, known) in [(0.0, 1e-6), (1e-12, 1e-6), (0.5, 1e-10), (1.0, 1e-10), (1.0 + 1e-12, 1e-10), (5.0, 1e-10)]
    {
        let structure = pinned(20, damping, GOLDEN);
        cases.push(case(format!("damping ratio {damping}"), structure, ball(), hertz(), Expect::Rebound(known)));
    }
    // Critical damping is not a special case.
    let beside = pinned(20, 1.0 - 1e-12, GOLDEN);
    cases.push(case("critical damping", pinned(20, 1.0, GOLDEN), ball(), hertz(), Expect::Same(beside)));
    // With so much damping the beam does not move.
    cases.push(case("damping ratio 1e6", pinned(20, 1e6, GOLDEN), ball(), hertz(), Expect::Restitution(1.0, 1e-3)));
    for apart in [0.0, 1e-16, 1e-12, 1e-9] {
        let one = Structure { modes: vec![Mode { omega_rad_s: 900.0, damping_ratio: 0.01, shape: 1.5 }] };
        let each = |factor: f64| Mode { omega_rad_s: 900.0 * factor, damping_ratio: 0.01, shape: 0.75 };
        // Four modes of one frequency, with phi^2 = 1.5^2 in total.
        let four = Structure { modes: [1.0 - apart, 1.0, 1.0, 1.0 + apart].map(each).to_vec() };
        cases.push(case(format!("frequencies {apart:e} apart"), four, ball(), hertz(), Expect::Same(one)));
    }
    hold(&cases);
}

#[test]
fn rigid_body_modes() {
    // On rigid modes alone two bodies meet: their relative velocity is reversed.
    let rigid = |shapes: &[f64]| Structure {
        modes: shapes.iter().map(|&shape| Mode { omega_rad_s: 0.0, damping_ratio: 0.0, shape }).collect(),
    };
    hold(&[
        case("one rigid mode", rigid(&[1.0]), ball(), hertz(), Expect::Restitution(1.0, 0.0)),
        case("two rigid modes", rigid(&[1.0, 3.0]), ball(), hertz(), Expect::Restitution(1.0, 0.0)),
        case("light rigid body", rigid(&[1e6]), ball(), hertz(), Expect::Restitution(1.0, 0.0)),
    ]);
    // A free-free beam, struck away from its middle: momentum and angular momentum are conserved to the last digits.
    let free = beam([End::Free, End::Free]);
    for (x, damping) in [(0.5, 0.0), (0.7, 0.0), (1.0, 0.02), (0.7, 0.5)] {
        let structure = seen_from(&free, x, 30, damping);
        let solution = run(&structure, &ball(), &hertz());
        assert_eq!(solution.outcome, Outcome::Rebound);
        let given: f64 = solution.sub_impacts.iter().map(|contact| contact.impulse_n_s).sum();
        assert!((ball().mass_kg * (solution.striker_velocity_m_s + 1.0) - given).abs() < 1e-13 * given);
        for (mode, rate) in structure.modes[..2].iter().zip(&solution.rate) {
            assert_eq!(mode.omega_rad_s, 0.0);
            assert!((rate + mode.shape * given).abs() < 1e-12 * given, "x = {x}");
        }
        let kept = energy_kept(&structure, &ball(), &solution);
        if damping == 0.0 {
            assert!((kept - 1.0).abs() < 1e-8, "x = {x}: {kept}");
        } else {
            assert!(kept < 1.0 - 1e-3, "x = {x}: {kept}");
        }
    }
}

/// A stiff light mode makes the compression oscillate within a contact: dozens of small loops of the hysteresis.
#[test]
fn hysteresis_with_tiny_loops() {
    for epsilon_m in [0.0, 1e-12, 1e-8, 1e-4] {
        for shape in [0.01, 0.1, 1.0, 10.0] {
            let structure = Structure {
                modes: vec![
                    Mode { omega_rad_s: 500.0, damping_ratio: 0.0, shape: 1.0 },
                    Mode { omega_rad_s: 3e5, damping_ratio: 0.0, shape },
                ],
            };
            let law = Law::from(
                Hysteretic { stiffness_n_m1_5: 1e9, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m }
                    .validated()
                    .unwrap(),
            );
            let solution = run(&structure, &ball(), &law);
            assert_eq!(solution.outcome, Outcome::Rebound, "{epsilon_m:e} {shape}");
            let kept = energy_kept(&structure, &ball(), &solution);
            assert!(kept < 1.0, "{epsilon_m:e} {shape}: {kept}");
            assert!(solution.restitution_uncertainty.unwrap() < 1e-3, "{epsilon_m:e} {shape}");
        }
    }
}

/// Reversals of a law with branches before remainder modes that are far stiffer than the contact: the rate of compression hardly
/// depends on them, and none of their vibrations counts as a reversal that the exact motion does not have.
#[test]
fn reversals_before_a_stiff_remainder() {
    let law = Hysteretic { stiffness_n_m1_5: 6608692376.459647, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m: 5e-8 };
    let law = Law::from(law.validated().unwrap());
    let striker = Striker { mass_kg: 2.6387535597869674, speed_m_s: 1.5590651578333043 };
    for n in [5, 7] {
        let solver = Solver::new(&pinned_with_remainder(n, 0.047728347855474716, 0.337)).unwrap();
        let at = |tolerance: f64| {
            let solution = solver.solve(&striker, &law, None, &settings(tolerance)).unwrap();
            assert_eq!(solution.outcome, Outcome::Rebound, "N = {n}, tolerance {tolerance:e}");
            assert!(solution.counts.contact_steps < 10_000, "N = {n}, tolerance {tolerance:e}: {:?}", solution.counts);
            (solution.restitution.unwrap(), solution.restitution_uncertainty.unwrap())
        };
        let (reference, _) = at(1e-13);
        for power in 5..=12 {
            let (value, stated) = at(10f64.powi(-power));
            let error = (value - reference).abs();
            assert!(error <= stated, "N = {n}, 1e-{power}: {error:e}, stated {stated:e}");
        }
    }
}

/// A light mode that turns thousands of times within a contact, and moves the surface at half the speed of the ball or more: no step
/// beyond a turn of it can tell whether the surfaces part at once, and each longer one would be rejected.
#[test]
fn the_first_step_follows_a_fast_mode_that_vibrates() {
    let (shape, omega_rad_s) = (0.1, 1e9);
    let mut structure = pinned(20, 0.02, GOLDEN);
    structure.modes.push(Mode { omega_rad_s, damping_ratio: 1e-3, shape });
    let solver = Solver::new(&structure).unwrap();
    let rejected = |speed_m_s: f64, phase: f64| {
        let mut start = Start::at_rest(structure.modes.len());
        let vibrates = speed_m_s / shape;
        (start.rate[20], start.amplitude[20]) = (vibrates * phase.cos(), vibrates * phase.sin() / omega_rad_s);
        let settings = Settings { estimate_uncertainty: false, max_sub_impacts: 1, ..settings(1e-6) };
        solver.solve(&ball(), &hertz(), Some(&start), &settings).unwrap().counts.rejected_steps
    };
    let at_rest = rejected(0.0, 0.0);
    for speed_m_s in [0.5, 0.9] {
        for phase in [0.0, 0.3, -1.5] {
            let moving = rejected(speed_m_s, phase);
            assert!(moving <= at_rest + 4, "{speed_m_s} m/s, phase {phase}: {moving}, at rest {at_rest}");
        }
    }
}

/// A contact a thousand times stiffer than a mode behind it that is faster than all others: this mode takes up nearly all of the
/// compression, and an error of the force must not count as a separation.
#[test]
fn a_hard_contact_before_a_soft_fast_mode() {
    let mode = |omega_rad_s: f64, shape: f64| Mode { omega_rad_s, damping_ratio: 0.0, shape };
    let fast = 500.0;
    let structure = Structure {
        modes: vec![
            mode(1.2160361712701584, 0.020805500388699716),
            mode(4.864144685080634, 0.03311089673940061),
            mode(10.944325541431425, 0.03188880940462351),
            mode(19.456578740322534, 0.01763852315498458),
            mode(30.40090428175396, -0.0038179960183024188),
            mode(43.7773021657257, -0.023714669825415827),
            mode(0.0, 0.09908877401009737),
            mode(0.0, 0.5395653781857226),
            mode(fast, fast * 2.110571348277004e-6f64.sqrt()),
        ],
    };
    let striker = Striker { mass_kg: 15479.79545052681, speed_m_s: 0.3617139734325054 };
    let law = Law::from(Hertz::new(295117987073.0457).unwrap());
    let start = Start {
        amplitude: vec![
            0.003983493407974803,
            0.0004100399187616022,
            -0.0007059671983022537,
            0.00029984135404229507,
            0.0006733854191444199,
            0.00019263016194060888,
            -0.8733242510345859,
            0.40994265145827846,
            0.0,
        ],
        rate: vec![
            -0.00025610746671355983,
            0.00246464716124219,
            6.824243804665353e-5,
            -0.006908863566526099,
            0.024731848378234066,
            -0.0014611665859350243,
            0.002421965827045995,
            -1.598387350037492e-5,
            0.0,
        ],
        gap_m: 0.0006696355739981407,
    };
    let solver = Solver::new(&structure).unwrap();
    let at = |tolerance: f64| solver.solve(&striker, &law, Some(&start), &settings(tolerance)).unwrap();
    let reference = at(1e-12);
    for i in 0..=20 {
        let tolerance = 10f64.powf(-4.0 - 0.32 * f64::from(i));
        let solution = at(tolerance);
        assert_eq!(solution.outcome, Outcome::Rebound, "{tolerance:e}");
        assert_eq!(solution.sub_impacts.len(), reference.sub_impacts.len(), "{tolerance:e}");
        let error = (solution.restitution.unwrap() - reference.restitution.unwrap()).abs();
        let stated = solution.restitution_uncertainty.unwrap();
        assert!(error <= stated && stated < 100.0 * tolerance, "{tolerance:e}: {error:e}, stated {stated:e}");
    }
}

/// With as many steps as the impact itself needs, a coarser solution in another unit of time may need more. Nothing is known of the
/// error then.
#[test]
fn no_uncertainty_is_stated_if_a_coarser_solution_stops() {
    let solver = Solver::new(&pinned(40, 0.02, 0.3)).unwrap();
    let mut stopped = 0;
    for i in 0..40 {
        let striker = Striker { mass_kg: 0.01 * 1.1f64.powi(i), speed_m_s: 1.0 };
        let solve = |settings: Settings| solver.solve(&striker, &hertz(), None, &settings).unwrap();
        let alone = solve(Settings { estimate_uncertainty: false, ..settings(1e-4) });
        let limited = solve(Settings { max_steps: alone.counts.steps(), ..settings(1e-4) });
        assert_eq!((limited.outcome, limited.restitution), (alone.outcome, alone.restitution));
        match limited.restitution_uncertainty {
            Some(uncertainty) => assert!(uncertainty < 1.0, "{uncertainty:e}"),
            None => stopped += 1,
        }
    }
    assert!(stopped > 0 && stopped < 40, "{stopped}");
}

/// A heavily damped contact pauses, without force, and resumes, a dozen times. For any ratio of its dyadic steps to the modes
/// (time is scaled, which changes the ratio), none of the short contacts is missed.
#[test]
fn pauses_of_a_damped_contact() {
    let impact = |time: f64, tolerance: f64| {
        let mode = |k: i32| Mode {
            omega_rad_s: 163.3572170466924 * f64::from(k * k) / time,
            damping_ratio: 0.0,
            shape: 1.4 * (f64::from(k) * 0.063468).sin(),
        };
        let structure = Structure { modes: (1..=36).map(mode).collect() };
        let striker = Striker { mass_kg: 0.0033958439615988456, speed_m_s: 1.0 / time };
        let law = Law::from(KelvinVoigt::new(1e5 / (time * time), 316.3016118820335 / time).unwrap());
        let solution = Solver::new(&structure).unwrap().solve(&striker, &law, None, &settings(tolerance)).unwrap();
        solution.restitution.unwrap()
    };
    let reference = impact(1.0, 1e-12);
    for time in [1.0, 1.3, 1.7, 103.44039057817238] {
        for tolerance in [1e-6, 1e-9] {
            let restitution = impact(time, tolerance);
            assert!((restitution - reference).abs() < tolerance, "{time} {tolerance}: {restitution} {reference}");
        }
    }
}

#[test]
fn a_stiff_contact_far_from_where_the_structure_was_at_rest() {
    // The surface is a million compressions away from its rest position, held there by almost no force: nothing may change.
    let mode = Mode { omega_rad_s: 1e-7, damping_ratio: 0.0, shape: 30.0 };
    let other = Mode { omega_rad_s: 2e-7, damping_ratio: 0.0, shape: 20.0 };
    let structure = Structure { modes: vec![mode, other] };
    let striker = Striker { mass_kg: 2e-3, speed_m_s: 2.0 };
    let laws = [
        (Law::from(Hertz::new(1.7e13).unwrap()), 1e-12),
        (
            Law::from(
                Hysteretic { stiffness_n_m1_5: 4e12, theta_m: 1.5, beta: 1.5, k_bar: 0.4, epsilon_m: 1e-9 }
                    .validated()
                    .unwrap(),
            ),
            1e-10,
        ),
    ];
    for (law, floor) in laws {
        let solve = |amplitude: f64| {
            // The modes oppose each other, so that their static displacements partly cancel.
            let start = Start { amplitude: vec![amplitude, -amplitude], ..Start::at_rest(2) };
            let settings = Settings { max_sub_impacts: 1, ..settings(1e-12) };
            Solver::new(&structure).unwrap().solve(&striker, &law, Some(&start), &settings).unwrap()
        };
        let impulse = |solution: &Solution| solution.sub_impacts[0].impulse_n_s;
        let (near, far) = (solve(0.0), solve(0.03));
        let change = impulse(&far) / impulse(&near) - 1.0;
        assert!(change.abs() < floor, "{law:?}: {change:e}");
        assert!(far.counts.rejected_steps <= near.counts.rejected_steps + 2, "{:?} {:?}", near.counts, far.counts);
    }
}

/// At first touch the structure's fast modes move its surface away again, after a contact of microseconds in an impact of
/// seconds. Its impulse is negligible, but a law that depends on the speed of approach responds to the second touch.
#[test]
fn surfaces_that_separate_immediately() {
    let mode = |k: usize| Mode {
        omega_rad_s: 2640.0 * (k * k) as f64,
        damping_ratio: 0.0024,
        shape: 6.8 * (0.78 * k as f64).sin(),
    };
    let mut modes: Vec<Mode> = (1..=11).map(mode).collect();
    modes.push(Mode { omega_rad_s: 0.0, damping_ratio: 0.0, shape: 0.07 });
    // The seventh mode moves towards the striker, the sixth away from it, both faster than the striker.
    let mut start = Start::at_rest(modes.len());
    start.rate[6] = 1.7e-4;
    start.rate[5] = -1.3e-4;
    let structure = Structure { modes };
    let striker = Striker { mass_kg: 870.0, speed_m_s: 1.9e-4 };
    let law = LankaraniNikravesh { stiffness_n_m1_5: 2055.0, restitution: 0.67, lowest_approach_speed_m_s: 1e-6 };
    let law = Law::from(law);
    let solver = Solver::new(&structure).unwrap();
    let at = |tolerance: f64| solver.solve(&striker, &law, Some(&start), &settings(tolerance)).unwrap();
    let reference = at(1e-11);
    assert!(reference.sub_impacts.len() > 1 && reference.sub_impacts[0].end_s < 1e-4, "{reference:?}");
    for tolerance in [1e-4, 1e-5, 1e-6, 1e-8] {
        let solution = at(tolerance);
        assert_eq!(solution.sub_impacts.len(), reference.sub_impacts.len(), "{tolerance:e}");
        let error = (solution.restitution.unwrap() - reference.restitution.unwrap()).abs();
        assert!(error <= solution.restitution_uncertainty.unwrap(), "{tolerance:e}: {error:e}");
    }
}

/// Compressions beyond the range of the law: no result rather than a wrong one.
#[test]
fn a_compression_beyond_the_law() {
    let structure = Structure::default();
    let striker = Striker { mass_kg: 5e19, speed_m_s: 1e26 };
    let law = Law::from(
        Hysteretic { stiffness_n_m1_5: 1e-10, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m: 1.8e-4 }
            .validated()
            .unwrap(),
    );
    let solution = run(&structure, &striker, &law);
    assert_eq!((solution.outcome, solution.restitution), (Outcome::Stopped(StopReason::LawRange), None));
    assert!(energy_kept(&structure, &striker, &solution) < 1.0 + 1e-9, "{solution:?}");
}

/// A structure that vibrates freely and only just reaches an immovable stop.
#[test]
fn a_stop_at_the_end_of_a_swing() {
    let mode = |omega_rad_s: f64, shape: f64| Mode { omega_rad_s, damping_ratio: 0.0, shape };
    let stop = Striker { mass_kg: f64::INFINITY, speed_m_s: 0.0 };
    let law = Law::from(LinearSpring::new(1e5).unwrap());
    // Both modes have their maximum at the same time: the contact is reached with the accuracy of the sum of the amplitudes.
    let structure = Structure { modes: vec![mode(100.0, 1.0), mode(500.0, 0.5)] };
    let reach = 1e-3 + 0.5 * 1e-4;
    for aside in [1e-3, 1e-6, 1e-9, 1e-12] {
        for (gap, contact) in [(reach * (1.0 - aside), true), (reach * (1.0 + aside), false)] {
            let at_rest_time = 0.5 * std::f64::consts::PI / 100.0;
            // Amplitudes a quarter of the slow period before both are largest.
            let amplitude = vec![1e-3 * (100.0 * at_rest_time).cos(), 1e-4 * (500.0 * at_rest_time).cos()];
            let rate = vec![0.1 * (100.0 * at_rest_time).sin(), 0.05 * (500.0 * at_rest_time).sin()];
            let now = amplitude[0] + 0.5 * amplitude[1];
            let start = Start { amplitude, rate, gap_m: gap - now };
            let solver = Solver::new(&structure).unwrap();
            let limits = Settings { max_sub_impacts: 1, ..settings(1e-9) };
            let solution = solver.solve(&stop, &law, Some(&start), &limits).unwrap();
            assert_eq!(!solution.sub_impacts.is_empty(), contact, "{aside:e} {gap} {:?}", solution.outcome);
            if let [first] = solution.sub_impacts[..] {
                assert!((first.start_s / at_rest_time - 1.0).abs() < aside.sqrt() + 1e-9, "{first:?}");
            } else {
                // This close, rounding decides, and the search may continue to its limit; it invents no contact.
                let undecided = aside < 1e-11 && solution.outcome == Outcome::Stopped(StopReason::Flight);
                assert!(undecided || solution.outcome == Outcome::NoContact, "{aside:e} {gap} {:?}", solution.outcome);
            }
        }
    }
}

/// Locations along the beam between which the number of contacts changes, bisected until one contact only grazes.
#[test]
fn contacts_that_come_and_go() {
    let once = Settings { estimate_uncertainty: false, ..settings(1e-9) };
    let count = |b: f64| {
        let solver = Solver::new(&pinned(25, 0.02, b)).unwrap();
        solver.solve(&ball(), &hertz(), None, &once).unwrap().sub_impacts.len()
    };
    let places: Vec<f64> = (0..=40).map(|i| 0.3 + 0.01 * f64::from(i)).collect();
    let mut found = 0;
    for pair in places.windows(2) {
        let (mut low, mut high) = (pair[0], pair[1]);
        let (few, many) = (count(low), count(high));
        if few == many {
            continue;
        }
        while high - low > 1e-14 {
            let middle = 0.5 * (low + high);
            if count(middle) == few { low = middle } else { high = middle }
        }
        let other = count(high);
        // Beside the grazing contact the numbers are those on either side of it, and nothing else jumps.
        for (b, expected) in [(low - 1e-9, few), (high + 1e-9, other)] {
            let solution = run(&pinned(25, 0.02, b), &ball(), &hertz());
            assert_eq!(solution.sub_impacts.len(), expected, "{b}");
            no_overlap(b);
        }
        let (a, b) = (run(&pinned(25, 0.02, low), &ball(), &hertz()), run(&pinned(25, 0.02, high), &ball(), &hertz()));
        let stated = a.restitution_uncertainty.unwrap() + b.restitution_uncertainty.unwrap();
        let jump = (a.restitution.unwrap() - b.restitution.unwrap()).abs();
        assert!(jump <= stated, "at b = {low}: {few} and {other} contacts, jump {jump:e}, stated {stated:e}");
        // The additional contact on one side is a touch without force, or one contact that was just divided in two.
        assert!(few.abs_diff(other) <= 2, "at b = {low}: {few} and {other}");
        found += 1;
    }
    assert!(found >= 25, "only {found} places");
}

/// Between the contacts the surfaces never overlap: no contact was missed.
fn no_overlap(b: f64) {
    let solver = Solver::new(&pinned(25, 0.02, b)).unwrap();
    let (solution, history) = solver.record(&ball(), &hertz(), None, &settings(1e-9)).unwrap();
    let deepest = solution.sub_impacts.iter().map(|contact| contact.peak_compression_m).fold(0.0, f64::max);
    let flights = solution.sub_impacts.windows(2).map(|pair| (pair[0].end_s, pair[1].start_s));
    let after = (solution.end_s, 3.0 * solution.end_s);
    for (from, to) in flights.chain([after]) {
        for i in 0..=400 {
            let compression = history.at(from + (to - from) * f64::from(i) / 400.0).compression_m;
            assert!(compression <= 1e-12 * deepest.max(1e-5), "b = {b}: overlap of {compression:e} m");
        }
    }
}

proptest! {
    #![proptest_config(config(300))]

    #[test]
    fn every_impact_ends_with_valid_numbers(
        structure in any_structure(),
        law in any_law(),
        mass_kg in decades(-6.0, 4.0),
        speed_m_s in decades(-6.0, 3.0),
    ) {
        let solver = Solver::new(&structure).unwrap();
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
            // a coarser solution may reach the limit on steps
            prop_assert!(solution.restitution_uncertainty.is_none_or(|uncertainty| uncertainty >= 0.0));
        }
        prop_assert!(solution.amplitude.iter().chain(&solution.rate).all(|value| value.is_finite()));
    }
}

/// A light ball on the guided end of a slender beam in three modes and two remainder modes, which are far stiffer: steps at
/// loose tolerances must not stall. The reference is the solution at 1e-12.
#[test]
fn few_modes_and_a_stiff_remainder_at_loose_tolerances() {
    let (length, diameter): (f64, f64) = (0.29256227331225043, 0.000420049429993596);
    let area = 0.25 * std::f64::consts::PI * diameter * diameter;
    let flexural_rigidity_n_m2 = 4623804235.435798 * area * diameter * diameter / 16.0;
    let segment = Segment { length_m: length, flexural_rigidity_n_m2, mass_per_length_kg_m: 1166.5507325534022 * area };
    let beam = Beam { segments: vec![segment], ends: [End::Guided, End::Pinned] };
    let damping_ratio = 0.00014785393000310015;
    let kept = beam.modes(3).unwrap().seen_from(0.0).unwrap();
    let structure = Structure::from_modes(kept.into_iter().chain(beam.remainder(0.0, 3, 2).unwrap()), damping_ratio);
    let striker = Striker { mass_kg: 0.0001016356302612917, speed_m_s: 0.5837524201245173 };
    let law = Law::from(Hertz::new(4357452.9971862845).unwrap());
    let solver = Solver::new(&structure).unwrap();
    let reference = solver.solve(&striker, &law, None, &settings(1e-12)).unwrap();
    let expected = reference.restitution.unwrap();
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-9] {
        let solution = solver.solve(&striker, &law, None, &settings(tolerance)).unwrap();
        assert_eq!(solution.outcome, Outcome::Rebound, "{tolerance:e}");
        assert!(solution.counts.contact_steps < 5_000, "{tolerance:e}: {:?}", solution.counts);
        let (error, stated) =
            ((solution.restitution.unwrap() - expected).abs(), solution.restitution_uncertainty.unwrap());
        assert!(error <= stated + 5e-9 && stated < 1.0, "{tolerance:e}: {error:e}, stated {stated:e}");
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

/// The tolerance of a heavy striker allows errors that are large for a structure a millionth as heavy. They must not become energy:
/// every step and every event has to belong to one motion.
#[test]
fn a_structure_far_lighter_than_its_striker_gains_no_energy() {
    for (mass_kg, speed_m_s) in [(4e4, 1e-3), (500.0, 30.0), (100.0, 1000.0)] {
        for (exponent, retardation_time_s) in [(2.1, 1e-5), (2.3, 0.08), (3.4, 9e-6), (4.6, 4e-6)] {
            for modes in [1, 7, 12] {
                let shape = |k: usize| 60.0 * (1.7 * k as f64).sin();
                let mode = |k: usize| Mode { omega_rad_s: 40.0 * k as f64, damping_ratio: 0.0, shape: shape(k) };
                let structure = Structure { modes: (1..=modes).map(mode).collect() };
                let striker = Striker { mass_kg, speed_m_s };
                let law = Law::from(Felt::new(1e8, exponent, retardation_time_s).unwrap());
                let settings = Settings { max_steps: 2_000, ..settings(1e-5) };
                let solution = Solver::new(&structure).unwrap().solve(&striker, &law, None, &settings).unwrap();
                let kept = energy_kept(&structure, &striker, &solution);
                assert!(
                    kept <= 1.0 + settings.tolerance,
                    "{mass_kg} {speed_m_s} {exponent} {modes}: energy times {kept}"
                );
            }
        }
    }
}

/// Such a dashpot stops the striker within 0.1 ns, and what is left is rounding. The contact then begins and ends within it, and must
/// not let the surfaces pass through each other.
#[test]
fn a_contact_within_rounding_gains_no_energy() {
    for mass_kg in [1e-6, 1.7e-6, 3e-6, 1e-5] {
        for damping_n_s_m in [1e4, 3e4, 1e5] {
            for shape in [0.03, 0.17, 0.5] {
                let structure = Structure { modes: vec![Mode { omega_rad_s: 92.0, damping_ratio: 0.036, shape }] };
                let striker = Striker { mass_kg, speed_m_s: 120.0 };
                let law = Law::from(KelvinVoigt::new(8.5e7, damping_n_s_m).unwrap());
                let settings = Settings { max_steps: 20_000, estimate_uncertainty: false, ..settings(1e-8) };
                let solution = Solver::new(&structure).unwrap().solve(&striker, &law, None, &settings).unwrap();
                let kept = energy_kept(&structure, &striker, &solution);
                assert!(kept <= 1.0 + settings.tolerance, "{mass_kg} {damping_n_s_m} {shape}: energy times {kept}");
            }
        }
    }
}

/// Here the law turns the rounding of the rate into a force that is larger than the contact's own. It must not excuse any force.
#[test]
fn rounding_excuses_no_force_that_the_motion_cannot_reach() {
    let structure = Structure {
        modes: vec![Mode { omega_rad_s: 0.007989514912245288, damping_ratio: 0.0, shape: -4.777495193800294e-20 }],
    };
    let striker = Striker { mass_kg: 1.4791034063158794e-24, speed_m_s: 69747149557.20752 };
    let law = Law::from(Felt::new(7.484774670310755e22, 4.270211796182337, 0.000568053492694768).unwrap());
    let start =
        Start { amplitude: vec![209751344255027.72], rate: vec![-2035767348501.8262], gap_m: 325949943.2556024 };
    let settings = Settings { max_steps: 2_000, ..settings(3.555341190904388e-9) };
    let found = Solver::new(&structure).unwrap().solve(&striker, &law, Some(&start), &settings).unwrap();
    let energy = |speed: f64, a: f64, b: f64| {
        0.5 * (striker.mass_kg * speed * speed + (structure.modes[0].omega_rad_s * a).powi(2) + b * b)
    };
    let before = energy(striker.speed_m_s, start.amplitude[0], start.rate[0]);
    let after = energy(found.striker_velocity_m_s, found.amplitude[0], found.rate[0]);
    assert!(after <= before * (1.0 + settings.tolerance), "{before:e} J, {after:e} J");
}

/// A deflected beam is released from rest where it touches a stop: neither has a speed, and no other contact has one.
#[test]
fn a_beam_that_is_released_at_a_stop_presses_it() {
    let modes = pinned(10, 0.01, 0.4).modes;
    let mut start = Start::at_rest(modes.len());
    start.amplitude[0] = -1e-3 / modes[0].shape;
    let structure = Structure { modes };
    let solver = Solver::new(&structure).unwrap();
    let stop = Striker { mass_kg: f64::INFINITY, speed_m_s: 0.0 };
    let law = Hertz::new(1e9).unwrap();
    let solve = |tolerance: f64| solver.solve(&stop, &law, Some(&start), &settings(tolerance)).unwrap();
    let (coarse, fine) = (solve(1e-6), solve(1e-10));
    assert_eq!((coarse.outcome, fine.outcome), (Outcome::Sustained, Outcome::Sustained));
    let [same, peak_n] = [coarse, fine].map(|solution| solution.sub_impacts[0].peak_force_n);
    assert!(peak_n > 1.0 && (same / peak_n - 1.0).abs() < 1e-7, "{same} {peak_n}");
}

/// The same with a speed far below that of the swing: the vibration is the scale of the contact, not this speed.
#[test]
fn a_released_beam_takes_as_many_steps_with_a_tiny_speed() {
    let modes = pinned(10, 0.01, 0.4).modes;
    let mut start = Start::at_rest(modes.len());
    start.amplitude[0] = -1e-3 / modes[0].shape;
    let shape = modes[0].shape;
    let structure = Structure { modes };
    let solver = Solver::new(&structure).unwrap();
    let stop = Striker { mass_kg: f64::INFINITY, speed_m_s: 0.0 };
    let mut steps = |speed_m_s: f64| {
        start.rate[0] = speed_m_s / shape;
        let solution = solver.solve(&stop, &Hertz::new(1e9).unwrap(), Some(&start), &settings(1e-9)).unwrap();
        assert_eq!(solution.outcome, Outcome::Sustained, "{speed_m_s}");
        solution.counts.contact_steps
    };
    let at_rest = steps(0.0);
    for speed_m_s in [1e-12, 1e-9, 1e-6] {
        let found = steps(speed_m_s);
        assert!(found < 2 * at_rest, "{speed_m_s}: {found}, {at_rest} from rest");
    }
}

/// Bodies that move along together, touching or at a distance, and whose speeds differ by rounding alone.
#[test]
fn bodies_of_equal_speed_do_not_touch() {
    let free = beam([End::Free, End::Free]).modes(12).unwrap();
    for place in [0.3, 0.5] {
        let structure = Structure::from_modes(free.seen_from(place).unwrap(), 0.01);
        let solver = Solver::new(&structure).unwrap();
        for (speed_m_s, gap_m) in [(1.0, 0.0), (0.3, 0.0), (-7.7, 0.0), (0.1, 1e-4)] {
            let mut start = Start { gap_m, ..Start::at_rest(structure.modes.len()) };
            start.rate[0] = -speed_m_s / structure.modes[0].shape;
            let striker = Striker { mass_kg: 0.1, speed_m_s };
            let solution = solver.solve(&striker, &Hertz::new(1e9).unwrap(), Some(&start), &settings(1e-9)).unwrap();
            assert_eq!(solution.outcome, Outcome::NoContact, "{place} {speed_m_s} {gap_m}: {solution:?}");
            assert!(solution.counts.flight_steps < 10, "{solution:?}");
        }
    }
}

/// The energies of a motion at 1e-170 m/s are zero in floating point, so that every motion would count as one that has ended.
#[test]
fn speeds_whose_energies_underflow_have_no_restitution() {
    let structure = pinned(10, 0.01, 0.4);
    let solver = Solver::new(&structure).unwrap();
    let law = KelvinVoigt { stiffness_n_m: 2e6, damping_n_s_m: 40.0 };
    let solve = |speed_m_s: f64| solver.solve(&Striker { mass_kg: 0.2, speed_m_s }, &law, None, &settings(1e-9));
    let [slow, usual] = [1e-60, 1.0].map(|speed_m_s| solve(speed_m_s).unwrap());
    assert!((slow.restitution.unwrap() - usual.restitution.unwrap()).abs() < 1e-9, "{slow:?} {usual:?}");
    for speed_m_s in [9e-61, 1e-300, -1e-300, 5e-324] {
        let fault = solve(speed_m_s).map(drop).unwrap_err();
        assert!(fault.field == "speed_m_s" && fault.allowed.contains("1e-60"), "{fault}");
    }
    // a structure of one rigid-body motion that moves as slowly towards a striker at rest
    let rigid = Structure { modes: vec![Mode { omega_rad_s: 0.0, damping_ratio: 0.0, shape: 1.0 }] };
    let start = Start { rate: vec![1e-300], ..Start::at_rest(1) };
    let striker = Striker { mass_kg: 0.2, speed_m_s: 0.0 };
    let solution = Solver::new(&rigid).unwrap().solve(&striker, &law, Some(&start), &settings(1e-9)).unwrap();
    assert_eq!(solution.restitution, None, "{solution:?}");
}

#[test]
fn frequencies_beyond_the_range_of_the_solver_are_rejected() {
    let with = |omega_rad_s: f64| Structure { modes: vec![Mode { omega_rad_s, damping_ratio: 0.0, shape: 1.0 }] };
    assert!([0.0, 1e-30, 1e15].iter().all(|omega| Solver::new(&with(*omega)).is_ok()));
    for omega in [-1.0, 1e-300, 1e-50, 2e15] {
        let fault = Solver::new(&with(omega)).map(drop).unwrap_err();
        assert_eq!(fault.allowed, "0 for a rigid body, or a number from 1e-30 to 1e15 rad/s", "{omega}");
    }
    // an elastic mode as slow as that does not vibrate during the impact
    let solved = |omega: f64| {
        let striker = Striker { mass_kg: 0.1, speed_m_s: 1.0 };
        run(&with(omega), &striker, &Hertz::new(1e9).unwrap().into())
    };
    let [slowest, slow] = [1e-30, 1e-6].map(solved);
    assert!((slowest.restitution.unwrap() - slow.restitution.unwrap()).abs() < 1e-9, "{slowest:?} {slow:?}");
}
