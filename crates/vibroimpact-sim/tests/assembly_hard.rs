//! Difficult cases of many bodies and contacts: equivalent descriptions give the same result, and the energy of many modes is
//! balanced.

use crate::common::Intervals;
use beam_modes::{Beam, End, Modes, Rod, RodEnd, RodSegment, Segment, TautString};
use contact_models::{
    Flores, Hertz, HuntCrossley, KelvinVoigt, LankaraniNikravesh, Law, LinearSpring, Thornton, Viscous,
};
use vibroimpact_sim::assembly::{
    Assembly, Body, BodyMode, Contact, Force, Interval, Load, Outcome, Point, Run, Settings, run,
};

fn solve(assembly: &Assembly<Law>, end_s: f64) -> (Run, Vec<(usize, Interval)>) {
    let mut seen = Intervals::default();
    let run = run(assembly, &Settings::until(end_s), &mut seen).unwrap();
    assert_eq!(run.outcome, Outcome::End);
    (run, seen.0)
}

fn on(body: usize, shape: &[f64]) -> Point {
    Point::OfBody { body, shape: shape.to_vec() }
}

fn spring(stiffness_n_m: f64) -> Law {
    LinearSpring::new(stiffness_n_m).unwrap().into()
}

fn undamped(modes: &Modes, damping_ratio: f64) -> Body {
    let mode = |&omega_rad_s: &f64| BodyMode { omega_rad_s, damping_ratio };
    Body::at_rest(modes.omega_rad_s().iter().map(mode).collect())
}

/// The cantilever of Code_Aster's SDNL104, under the force at its tip.
fn cantilever(n: usize) -> Modes {
    let (inertia, area) = (std::f64::consts::PI * 0.2f64.powi(4) / 64.0, std::f64::consts::PI * 0.01);
    let segment = Segment { length_m: 1.0, flexural_rigidity_n_m2: 1e10 * inertia, mass_per_length_kg_m: 1e6 * area };
    Beam { segments: vec![segment], ends: [End::Clamped, End::Free] }.modes(n).unwrap()
}

fn above_stops(n: usize, stops: &[(f64, f64)]) -> Assembly<Law> {
    let modes = cantilever(n);
    let at = |x_m: f64| modes.shapes_at(x_m).unwrap();
    let stop = |&(x_m, stiffness): &(f64, f64)| Contact {
        sides: [on(0, &at(x_m)), Point::Ground],
        gap_m: 1e-4,
        law: spring(stiffness),
    };
    Assembly {
        bodies: vec![undamped(&modes, 0.0)],
        contacts: stops.iter().map(stop).collect(),
        loads: vec![Load { body: 0, shape: at(1.0), force: Force::Constant { force_n: -1000.0 } }],
    }
}

#[test]
fn contacts_a_micrometre_apart_on_one_body_are_one_of_both_stiffnesses() {
    let place = 1.0 - 5e-7;
    let (one, of_one) = solve(&above_stops(20, &[(place, 1e8)]), 0.16);
    let (two, of_two) = solve(&above_stops(20, &[(1.0 - 1e-6, 5e7), (1.0, 5e7)]), 0.16);
    assert_eq!((of_one.len(), of_two.len()), (1, 2));
    for (_, half) in &of_two {
        let (_, whole) = &of_one[0];
        // The beam rotates at its tip, so that they touch one after the other.
        assert!((half.start_s / whole.start_s - 1.0).abs() < 2e-6, "{half:?} {whole:?}");
        assert!((half.end_s.unwrap() / whole.end_s.unwrap() - 1.0).abs() < 2e-6);
        assert!((2.0 * half.impulse_n_s / whole.impulse_n_s - 1.0).abs() < 1e-4);
    }
    assert!(of_two[0].1.start_s != of_two[1].1.start_s);
    for (one, two) in one.rate[0].iter().zip(&two.rate[0]) {
        assert!((one - two).abs() < 1e-4, "{one} {two}");
    }
}

/// Energy to 1e-11 of the work of the load, and a cost that grows no faster than the number of modes.
#[test]
fn three_hundred_modes_account_for_all_energy() {
    let (found, intervals) = solve(&above_stops(300, &[(1.0, 1e8)]), 0.1);
    let energy = found.energy.unwrap();
    assert!(!intervals.is_empty());
    assert!(energy.unaccounted_j.abs() < 1e-11 * energy.load_work_j.abs(), "{energy:?}");
    // The low modes are those of the converged solution with 100 modes.
    let (fewer, others) = solve(&above_stops(100, &[(1.0, 1e8)]), 0.1);
    assert!((others[0].1.start_s / intervals[0].1.start_s - 1.0).abs() < 1e-5);
    assert!((others[0].1.end_s.unwrap() / intervals[0].1.end_s.unwrap() - 1.0).abs() < 1e-4);
    assert!((fewer.rate[0][0] - found.rate[0][0]).abs() < 1e-3 * found.rate[0][0].abs());
}

/// Two cantilevers side by side with a ball between them.
fn ball_between(order: [usize; 3]) -> Assembly<Law> {
    let modes = cantilever(8);
    let shapes = |x_m: f64| modes.shapes_at(x_m).unwrap();
    let ball = Body::mass(40.0, 0.0, -0.05);
    let bodies = [undamped(&modes, 0.01), ball, undamped(&modes, 0.03)];
    let place = |body: usize| order.iter().position(|other| *other == body).unwrap();
    let ball = || on(place(1), &[40f64.sqrt().recip()]);
    let hertz = |k: f64| Law::from(Hertz::new(k).unwrap());
    let contacts = vec![
        Contact { sides: [ball(), on(place(0), &shapes(0.7))], gap_m: 1e-5, law: hertz(1e10) },
        Contact {
            sides: [on(place(2), &shapes(1.0)), ball()],
            gap_m: 2e-5,
            law: Viscous::new(1e10, 0.4).unwrap().into(),
        },
    ];
    let force = Force::Harmonic { force_n: 2e4, omega_rad_s: 90.0, phase_rad: 0.3 };
    let loads = vec![Load { body: place(0), shape: shapes(1.0), force }];
    Assembly { bodies: order.iter().map(|body| bodies[*body].clone()).collect(), contacts, loads }
}

#[test]
fn the_order_of_bodies_and_contacts_does_not_matter() {
    let (one, intervals) = solve(&ball_between([0, 1, 2]), 0.2);
    assert!(intervals.len() > 4, "{}", intervals.len());
    let mut exchanged = ball_between([2, 0, 1]);
    exchanged.contacts.reverse();
    let (other, others) = solve(&exchanged, 0.2);
    assert_eq!(intervals.len(), others.len());
    for ((c, interval), (d, same)) in intervals.iter().zip(&others) {
        assert_eq!(*c, 1 - *d);
        assert!((interval.start_s - same.start_s).abs() < 1e-8, "{interval:?} {same:?}");
        assert!((interval.impulse_n_s - same.impulse_n_s).abs() < 1e-6 * interval.impulse_n_s);
    }
    for (body, place) in [(0, 1), (1, 2), (2, 0)] {
        for (one, other) in one.rate[body].iter().zip(&other.rate[place]) {
            assert!((one - other).abs() < 1e-6, "{one} {other}");
        }
    }
}

fn rod(length_m: f64, ends: [RodEnd; 2], modes: usize) -> Modes {
    let segment = RodSegment { length_m, axial_rigidity_n: 8e7, mass_per_length_kg_m: 3.12 };
    Rod { segments: vec![segment], ends }.modes(modes).unwrap()
}

/// A rod that is pressed against its support, as a whole, and divided into two halves with a stiff contact between them. The
/// free ends of the halves transmit a force only through many modes, so that the error of the halves is about one over the
/// number of modes.
#[test]
fn a_rod_divided_in_two_and_pressed_together_moves_as_the_whole() {
    const END_S: f64 = 5e-3;
    const JOINT_N_M: f64 = 1e11;
    let press = |body: usize, shape: Vec<f64>| {
        let static_n = Force::Sampled { times_s: vec![0.0, 2e-3, 1.0], forces_n: vec![0.0, -1e4, -1e4] };
        let swinging = Force::Harmonic { force_n: -1e3, omega_rad_s: 4000.0, phase_rad: 0.0 };
        [static_n, swinging].map(|force| Load { body, shape: shape.clone(), force }).to_vec()
    };
    let tip = |modes: &Modes, run: &Run, body: usize, x_m: f64| -> f64 {
        modes.shapes_at(x_m).unwrap().iter().zip(&run.amplitude[body]).map(|(phi, a)| phi * a).sum()
    };
    let damped = |modes: &Modes| undamped(modes, 0.0);
    let whole = rod(1.0, [RodEnd::Fixed, RodEnd::Free], 400);
    let loads = press(0, whole.shapes_at(1.0).unwrap());
    let (found, _) = solve(&Assembly { bodies: vec![damped(&whole)], contacts: vec![], loads }, END_S);
    let expected = tip(&whole, &found, 0, 1.0);
    let error = |modes: usize, gap_m: f64| {
        let [left, right] =
            [[RodEnd::Fixed, RodEnd::Free], [RodEnd::Free, RodEnd::Free]].map(|ends| rod(0.5, ends, modes));
        let loads = press(1, right.shapes_at(0.5).unwrap());
        let sides = [on(1, &right.shapes_at(0.0).unwrap()), on(0, &left.shapes_at(0.5).unwrap())];
        let contacts = vec![Contact { sides, gap_m, law: spring(JOINT_N_M) }];
        let (found, intervals) =
            solve(&Assembly { bodies: vec![damped(&left), damped(&right)], contacts, loads }, END_S);
        // Before the wave of the load arrives, the halves move by less than 1e-12 m against each other.
        assert!(intervals.len() < 50, "{}", intervals.len());
        assert!(intervals.iter().all(|(_, interval)| interval.impulse_n_s > 0.0), "{intervals:?}");
        // It does not open once it is pressed.
        assert!(intervals.last().is_some_and(|(_, last)| last.end_s.is_none() && last.start_s < 1e-3));
        tip(&right, &found, 1, 0.5) / expected - 1.0
    };
    // Pressed together slightly from the start, or not at all, so that rounding decides whether they touch.
    for gap_m in [-1e-9, 0.0] {
        let (few, many) = (error(40, gap_m), error(160, gap_m));
        assert!(many.abs() < 5e-3 && many.abs() < 0.5 * few.abs(), "{few} {many}");
    }
}

/// A ball on a ball on a soft floor oscillates below a stop. The contact between the balls hardly yields: the deflection of the
/// floor under the lower ball moves the upper one to the stop.
#[test]
fn a_stack_that_oscillates_into_a_stop_is_not_at_rest() {
    let (g, soft, hard): (f64, f64, f64) = (9.81, 100.0, 2000.0);
    let low = -2.0 * g / soft;
    let high = low - g / hard;
    let (sway, above) = (0.02, 0.012);
    let ball = |body: usize| on(body, &[1.0]);
    let assembly = Assembly {
        bodies: vec![Body::mass(1.0, low - sway, 0.0), Body::mass(1.0, high - sway, 0.0)],
        contacts: vec![
            Contact { sides: [ball(0), Point::Ground], gap_m: 0.0, law: spring(soft) },
            Contact { sides: [ball(1), ball(0)], gap_m: 0.0, law: spring(hard) },
            Contact { sides: [Point::Ground, ball(1)], gap_m: high + above, law: spring(1e4) },
        ],
        loads: (0..2).map(|body| Load { body, shape: vec![1.0], force: Force::Constant { force_n: -g } }).collect(),
    };
    let mut seen = Intervals::default();
    let found = run(&assembly, &Settings::until(1.0), &mut seen).unwrap();
    assert!(seen.0.iter().any(|(contact, _)| *contact == 2), "{:?} at {} s", found.outcome, found.end_s);
    // With a larger gap it never reaches the stop, and that is certain.
    let mut farther = assembly;
    farther.contacts[2].gap_m = high + 0.2;
    let found = run(&farther, &Settings::until(1.0), &mut Intervals::default()).unwrap();
    assert_eq!(found.outcome, Outcome::Rest);
}

/// The finest tolerance, a dashpot and a load: near the maximum compression the rounding of the overlap, magnified by the
/// slopes of short panels, must not be mistaken for truncation.
/// Between the ground and a held end nothing moves, so that surfaces that meet there neither press nor part.
#[test]
fn surfaces_that_cannot_move_stay_as_they_are() {
    let held = rod(0.6, [RodEnd::Free, RodEnd::Fixed], 15);
    let (free, fixed) = (held.shapes_at(0.0).unwrap(), held.shapes_at(0.6).unwrap());
    assert!(fixed.iter().all(|shape| *shape == 0.0));
    let contacts = |gaps_m: &[f64]| {
        let contact = |sides, gap_m| Contact { sides, gap_m, law: Hertz::new(1e9).unwrap().into() };
        let still = gaps_m.iter().map(|gap_m| contact([Point::Ground, on(0, &fixed)], *gap_m));
        still.chain([contact([on(1, &[1.0]), on(0, &free)], 1e-4)]).collect()
    };
    let solved = |gaps_m: &[f64]| {
        let bodies = vec![undamped(&held, 0.0), Body::mass(1.0, 0.0, -0.5)];
        solve(&Assembly { bodies, contacts: contacts(gaps_m), loads: vec![] }, 0.01)
    };
    let (alone, known) = solved(&[]);
    for gap_m in [0.0, 1e-6] {
        let (found, intervals) = solved(&[gap_m]);
        assert_eq!(found.contacts[0].statistics.intervals, 0);
        assert_eq!(intervals.len(), known.len());
        assert_eq!(found.amplitude, alone.amplitude);
    }
}

/// A run that begins within a contact continues the one from which its start is taken, also where a dashpot would pull: there the
/// force is zero. Laws with memory continue it while they are loaded.
#[test]
fn a_run_that_begins_within_a_contact_continues_it() {
    let (mass_kg, shape) = (0.1, [0.1f64.sqrt().recip()]);
    let plastic = Thornton::new(1e11, 0.01, 5e8).unwrap();
    let cases: [(Law, bool); 4] = [
        (KelvinVoigt::new(1e4, 30.0).unwrap().into(), true),
        (HuntCrossley::new(1e7, 1.5, 1.0).unwrap().into(), true),
        (Hertz::new(1e7).unwrap().into(), true),
        (plastic.into(), false),
    ];
    for (law, forgets) in cases {
        let from = |position_m: f64, speed_m_s: f64, end_s: f64| {
            let contacts = vec![Contact { sides: [on(0, &shape), Point::Ground], gap_m: 0.0, law }];
            let bodies = vec![Body::mass(mass_kg, position_m, speed_m_s)];
            let (run, intervals) = solve(&Assembly { bodies, contacts, loads: vec![] }, end_s);
            assert!(intervals.iter().all(|(_, interval)| interval.impulse_n_s >= 0.0), "{law:?} {intervals:?}");
            ([run.amplitude[0][0] * shape[0], run.rate[0][0] * shape[0]], intervals[0].1)
        };
        let (_, whole) = from(0.0, -1.0, 0.1);
        let (end_s, mut receding) = (2.0 * whole.end_s.unwrap(), 0);
        let ([known_m, known_m_s], _) = from(0.0, -1.0, end_s);
        for i in 1..20 {
            let begin_s = 0.05 * f64::from(i) * whole.end_s.unwrap();
            let ([position_m, speed_m_s], _) = from(0.0, -1.0, begin_s);
            receding += u32::from(speed_m_s > 0.0);
            if speed_m_s > 0.0 && !forgets {
                continue;
            }
            let ([found_m, found_m_s], _) = from(position_m, speed_m_s, end_s - begin_s);
            let error = (found_m - known_m).abs() / known_m.abs() + (found_m_s - known_m_s).abs();
            assert!(error < 1e-6, "{law:?} from {begin_s}: {error:e}");
        }
        assert!(receding > 2, "{law:?}");
    }
}

/// A strong dashpot holds one point of a light string that vibrates. The rate of the overlap is then a small difference of the rates of
/// the modes, whose rounding the dashpot turns into a force; shorter panels would not reduce it.
#[test]
fn rounding_at_a_strong_dashpot_does_not_shorten_the_steps() {
    let (length_m, tension_n, mass_per_length_kg_m) = (1.5, 130.0, 1.6e-3);
    let modes =
        TautString { length_m, tension_n, mass_per_length_kg_m, flexural_rigidity_n_m2: 0.0 }.modes(14).unwrap();
    let (held, pushed) = (modes.shapes_at(1.285).unwrap(), modes.shapes_at(0.163).unwrap());
    let mode = |&omega_rad_s: &f64| BodyMode { omega_rad_s, damping_ratio: 0.0 };
    let law: Law = KelvinVoigt::new(2e5, 160.0).unwrap().into();
    let contacts = [[on(0, &held), Point::Ground], [Point::Ground, on(0, &held)]];
    let force = Force::Harmonic { force_n: 20.0, omega_rad_s: 600.0, phase_rad: 0.0 };
    let assembly = Assembly {
        bodies: vec![Body::at_rest(modes.omega_rad_s().iter().map(mode).collect())],
        contacts: contacts.map(|sides| Contact { sides, gap_m: 0.0, law }).into(),
        loads: vec![Load { body: 0, shape: pushed, force }],
    };
    let of = |tolerance: f64| {
        let settings = Settings { tolerance, ..Settings::until(0.02) };
        run(&assembly, &settings, &mut ()).unwrap()
    };
    let (coarse, fine) = (of(1e-9), of(1e-12));
    assert!(coarse.contacts.iter().all(|contact| contact.statistics.intervals > 3), "{:?}", coarse.contacts);
    let error = |part: fn(&Run) -> &Vec<Vec<f64>>| {
        let pairs = || part(&coarse)[0].iter().zip(&part(&fine)[0]);
        pairs().map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / pairs().map(|(a, _)| a.abs()).fold(0.0, f64::max)
    };
    assert!(error(|run| &run.amplitude).max(error(|run| &run.rate)) < 1e-9);
    let steps = [&coarse, &fine].map(|run| run.counts.contact_steps);
    assert!(steps[1] < 4 * steps[0], "{steps:?}");
}

/// Surfaces that begin compressed without a speed of approach have the damping `D` of the lowest approach speed of Flores's law. The
/// ball is pushed out with the speed `v` by `m v' = F_0 (1 - D v)`: after some `m/(F_0 D) = 4e-11 s` it creeps with `1/D`, and the integral
/// of the square of the force is `m F_0/2D`.
#[test]
fn a_ball_that_creeps_out_of_a_strong_dashpot_takes_few_steps() {
    let (mass_kg, stiffness, restitution, overlap_m, lowest) = (0.06f64, 2.6e9, 0.56, 6.3e-5f64, 1e-6);
    let law = Law::from(Flores::new(stiffness, restitution).unwrap());
    let contact = Contact { sides: [on(0, &[mass_kg.sqrt().recip()]), Point::Ground], gap_m: -overlap_m, law };
    let bodies = vec![Body::mass(mass_kg, 0.0, 0.0)];
    let assembly = Assembly { bodies, contacts: vec![contact], loads: vec![] };
    let damping = 1.6 * (1.0 - restitution) / restitution / lowest;
    let squared = 0.5 * mass_kg * stiffness * overlap_m.powf(1.5) / damping;
    for tolerance in [1e-9, 1e-12] {
        let run = run(&assembly, &Settings { tolerance, ..Settings::until(3e-3) }, &mut ()).unwrap();
        assert!(run.counts.steps() < 100 && run.counts.rejected_steps < 20, "{:?}", run.counts);
        let end = &run.contacts[0];
        let speed = end.velocity_m_s[0];
        assert!((speed * damping - 1.0).abs() < 1e-9, "{speed} {damping}");
        let found = end.statistics.squared_force_n2_s;
        assert!((found - squared).abs() < 1e-6 * squared, "{found} {squared}");
    }
}

/// A ball moves away from a vibrating body that it overlaps, and the body presses it later. Lankarani and Nikravesh's law is a strong
/// dashpot then. Its force falls to zero on steps in which the overlap changes by less than 1e-12 of itself.
#[test]
fn rounding_of_the_overlap_does_not_hide_where_the_force_of_a_dashpot_ends() {
    let law = Law::from(LankaraniNikravesh::new(3e7, 0.2).unwrap());
    let mode = BodyMode { omega_rad_s: 2400.0, damping_ratio: 0.0 };
    let vibrating = Body { rate: vec![-0.25], ..Body::at_rest(vec![mode]) };
    let sides = [on(0, &[0.4f64.sqrt().recip()]), on(1, &[-2.0])];
    let assembly = Assembly {
        bodies: vec![Body::mass(0.4, 0.0, 0.5), vibrating],
        contacts: vec![Contact { sides, gap_m: -1.5e-4, law }],
        loads: vec![],
    };
    let of = |tolerance: f64| run(&assembly, &Settings { tolerance, ..Settings::until(4e-3) }, &mut ()).unwrap();
    let [coarse, fine] = [1e-9, 1e-12].map(|tolerance| of(tolerance).contacts[0].statistics.impulse_n_s);
    assert!((coarse - fine).abs() < 1e-9 * fine, "{coarse} {fine}");
}

/// A ball leaves a surface that it overlaps, and a load presses it back. Lankarani and Nikravesh's law is a strong dashpot then, which
/// takes up the load within some 1e-9 s. On longer steps its force oscillates, and seems to end again and again.
#[test]
fn a_strong_dashpot_that_is_pressed_again_takes_few_steps_at_any_tolerance() {
    let shape = vec![0.4f64.sqrt().recip()];
    let law = Law::from(LankaraniNikravesh::new(9.4e7, 0.2).unwrap());
    let assembly = Assembly {
        bodies: vec![Body::mass(0.4, 0.0, 0.5)],
        contacts: vec![Contact { sides: [on(0, &shape), Point::Ground], gap_m: -2.6e-4, law }],
        loads: vec![Load { body: 0, shape, force: Force::Constant { force_n: -610.0 } }],
    };
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let run = run(&assembly, &Settings { tolerance, ..Settings::until(4e-3) }, &mut ()).unwrap();
        assert!(run.counts.steps() < 100 && run.counts.events < 10, "{:?}", run.counts);
    }
}

#[test]
fn a_dashpot_under_loads_is_solved_to_the_finest_tolerance() {
    let law = Law::from(KelvinVoigt::new(1e8, 1363.0).unwrap());
    let root = 0.1f64.sqrt();
    let load = |force| Load { body: 0, shape: vec![root], force };
    let solved = |tolerance: f64| {
        let sides = [Point::OfBody { body: 0, shape: vec![root.recip()] }, Point::Ground];
        let weight = load(Force::Constant { force_n: -9.81 });
        let shaking = load(Force::Harmonic { force_n: 11.7, omega_rad_s: 125.66, phase_rad: 0.5 });
        let assembly = Assembly {
            bodies: vec![Body::mass(0.1, 0.0, 0.163)],
            contacts: vec![Contact { sides, gap_m: 0.0, law }],
            loads: vec![weight, shaking],
        };
        run(&assembly, &Settings { tolerance, ..Settings::until(0.1) }, &mut ()).unwrap()
    };
    let [coarse, fine] = [1e-10, 1e-13].map(solved);
    assert_eq!(fine.outcome, Outcome::End);
    assert!(fine.counts.steps() < 200, "{:?}", fine.counts);
    let impulse = |run: &Run| run.contacts[0].statistics.impulse_n_s;
    assert!((impulse(&coarse) - impulse(&fine)).abs() < 1e-10 * impulse(&fine));
}

/// Beside a wall the force of spring and dashpot is zero after `t_1`, where `tan(w t_1) = -2 b w/(w_0^2 - 2 b^2)`, with `b = c/2m`. The
/// spring recovers after the ball for another `c/k`, however short that is.
#[test]
fn a_spring_recovers_from_a_dashpot_of_any_size() {
    let (mass_kg, k) = (0.1, 1e7);
    for c in [1e-30, 1e-20, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, 100.0] {
        let law = Law::from(KelvinVoigt::new(k, c).unwrap());
        let ball = Contact { sides: [on(0, &[f64::sqrt(mass_kg).recip()]), Point::Ground], gap_m: 0.0, law };
        let bodies = vec![Body::mass(mass_kg, 0.01, -4.43)];
        let (_, seen) = solve(&Assembly { bodies, contacts: vec![ball], loads: vec![] }, 0.01);
        let b = 0.5 * c / mass_kg;
        let square = k / mass_kg;
        let turning = (square - b * b).sqrt();
        let pressed = (2.0 * b * turning).atan2(2.0 * b * b - square) / turning;
        let [(_, only)] = seen.as_slice() else { panic!("{c}: {seen:?}") };
        let lasted = only.end_s.unwrap() - only.start_s;
        assert!((lasted - pressed - c / k).abs() < 1e-9 * lasted, "{c}: {lasted} for {pressed}");
    }
}

/// A ball between two stops without play, pushed by a spring that vibrates, leaves one stop when it meets the other. Rounding decides
/// which comes first, and must not add intervals of contact without length.
#[test]
fn a_ball_between_stops_without_play_leaves_one_when_it_meets_the_other() {
    let mass_kg = 0.2973535134099132;
    let ball = on(1, &[f64::sqrt(mass_kg).recip()]);
    let law = Law::from(HuntCrossley::new(3152202.74518389, 1.5, 0.13318022705371335).unwrap());
    let contact = |sides: [Point; 2], law: Law| Contact { sides, gap_m: 0.0, law };
    let contacts = vec![
        contact([ball.clone(), on(0, &[-1.3450880568394772])], spring(214573.30958653567)),
        contact([ball.clone(), Point::Ground], law),
        contact([Point::Ground, ball], law),
    ];
    let mode = BodyMode { omega_rad_s: 3857.941960127272, damping_ratio: 0.0024210531132110072 };
    let vibrating = Body { modes: vec![mode], amplitude: vec![0.0], rate: vec![0.28817312562604064] };
    let bodies = vec![vibrating, Body::mass(mass_kg, 0.0, 0.1890336219776627)];
    let (_, seen) = solve(&Assembly { bodies, contacts, loads: Vec::new() }, 0.06);
    for (_, interval) in &seen {
        assert!(interval.end_s.is_none_or(|end_s| end_s > interval.start_s), "{interval:?}");
    }
    let [one, other] = [1, 2].map(|c| seen.iter().filter(|(contact, _)| *contact == c).count());
    assert!(one.abs_diff(other) <= 1, "{one} and {other} intervals");
}

/// Two balls between walls and a stop: one ball leaves its wall when it meets the stop opposite, within a rounding error of the time,
/// while it is in contact with the other ball. The last panel before this is 14 orders shorter than the next one.
#[test]
fn a_panel_after_a_very_short_one_begins_with_a_finite_guess() {
    let masses = [0.05351894723824847, 0.05724084681253622];
    let [first, second] = [0, 1].map(|body| on(body, &[f64::sqrt(masses[body]).recip()]));
    let hunt_crossley = |stiffness, damping| Law::from(HuntCrossley::new(stiffness, 1.5, damping).unwrap());
    let kelvin_voigt = Law::from(KelvinVoigt::new(231655.18523418147, 0.9109766405974604).unwrap());
    let contact = |sides: [&Point; 2], gap_m: f64, law: Law| Contact { sides: sides.map(Point::clone), gap_m, law };
    let contacts = vec![
        contact([&first, &second], 0.0, kelvin_voigt),
        contact([&Point::Ground, &second], 0.0, hunt_crossley(6191194.648065048, 0.44600585995818404)),
        contact([&second, &Point::Ground], 0.0, hunt_crossley(23280556.237067, 0.07011042373433377)),
        contact([&Point::Ground, &first], 0.0007262503921717886, hunt_crossley(132343.16163426792, 0.8037597213704044)),
    ];
    let pull = |force| Load { body: 1, shape: vec![f64::sqrt(masses[1]).recip()], force };
    let times_s = vec![0.03572902284799234, 0.06339327848346579, 0.07012468853472767];
    let forces_n = vec![29.01717702227785, -24.497185425943528, -11.0631466000263];
    let loads = vec![pull(Force::Constant { force_n: -2.062665601411833 }), pull(Force::Sampled { times_s, forces_n })];
    let bodies =
        vec![Body::mass(masses[0], 0.0, -0.5003893506308843), Body::mass(masses[1], 0.0, -0.35193406555519724)];
    let (run, _) = solve(&Assembly { bodies, contacts, loads }, 0.14679223057479138);
    assert!(run.counts.contact_steps < 10_000, "{:?}", run.counts);
}

/// A tip between a stop that it presses at the start and one that it only touches there: the order of the two does not matter.
#[test]
fn a_contact_that_only_touches_may_be_listed_before_one_that_presses() {
    let tip = [1.3, -0.5];
    let mode = |omega_rad_s| BodyMode { omega_rad_s, damping_ratio: 0.02 };
    let bodies = vec![Body::at_rest(vec![mode(0.0), mode(3000.0)]), Body::mass(0.2, 0.0, 0.0)];
    let presses = Contact { sides: [on(0, &tip), Point::Ground], gap_m: -1e-5, law: Hertz::new(1e7).unwrap().into() };
    let touches = Contact {
        sides: [on(1, &[0.2f64.sqrt().recip()]), on(0, &tip)],
        gap_m: 0.0,
        law: Hertz::new(5e6).unwrap().into(),
    };
    let by_order = [vec![presses.clone(), touches.clone()], vec![touches, presses]].map(|contacts| {
        let (found, _) = solve(&Assembly { bodies: bodies.clone(), contacts, loads: Vec::new() }, 0.05);
        found.rate
    });
    assert_eq!(by_order[0], by_order[1]);
    assert!(by_order[0][1][0] > 0.0);
}

/// A ball in Hertz contact leaves the ground, and another one meets it shortly before or after: at the time at which a ball arrives that
/// flies freely, however little earlier that is.
#[test]
fn a_contact_closes_on_time_while_another_opens() {
    let alone = |law: Law, gap_m: f64, body: usize| Contact { sides: [on(body, &[1.0]), Point::Ground], gap_m, law };
    let both = |arrives_s: f64| Assembly {
        bodies: vec![Body::mass(1.0, 0.0, -1.0), Body::mass(1.0, 0.0, -1.0)],
        contacts: vec![alone(Hertz::new(1e8).unwrap().into(), 0.0, 0), alone(spring(1e6), arrives_s, 1)],
        loads: vec![],
    };
    let (_, of_one) = solve(&both(1.0), 0.01);
    let leaves_s = of_one[0].1.end_s.unwrap();
    for power in 2..30 {
        for sign in [1.0, -1.0] {
            let arrives_s = leaves_s * (1.0 - sign * 0.5f64.powi(power));
            let (_, intervals) = solve(&both(arrives_s), 0.01);
            for (contact, interval) in intervals {
                let error =
                    if contact == 0 { interval.end_s.unwrap() - leaves_s } else { interval.start_s - arrives_s };
                assert!(error.abs() < 1e-12 * leaves_s, "contact {contact}, {power}, {sign}: {error:e}");
            }
        }
    }
}

/// A load of 1e9 N presses three blocks together that have met at a walking pace. Its impulse is so much larger than the momentum with
/// which they met that the rounding of the forces alone exceeds a tight tolerance, which no shorter panel can change.
#[test]
fn a_load_far_above_the_momentum_of_the_contact_takes_no_more_steps_than_its_forces_need() {
    let force_n = [-9.81, -9.81, -9.81 - 1e9];
    let under = |i: usize| if i == 0 { Point::Ground } else { on(i - 1, &[1.0]) };
    let law: Law = KelvinVoigt::new(1e6, 400.0).unwrap().into();
    let pressed = Assembly {
        bodies: [0.002, 0.004, 0.006].map(|place_m| Body::mass(1.0, place_m, 0.0)).into(),
        contacts: (0..3).map(|i| Contact { sides: [on(i, &[1.0]), under(i)], gap_m: 0.0, law }).collect(),
        loads: (0..3)
            .map(|body| Load { body, shape: vec![1.0], force: Force::Constant { force_n: force_n[body] } })
            .collect(),
    };
    for tolerance in [1e-9, 1e-10, 1e-12] {
        let settings = Settings { tolerance, stop_at_rest: false, ..Settings::until(1.0) };
        let found = run(&pressed, &settings, &mut ()).unwrap();
        let steps = found.counts.steps() + found.counts.rejected_steps;
        assert!(steps < 4_000, "{tolerance:e}: {steps} steps");
        // the blocks have come to rest, and all impulse of the loads has reached the ground; the largest force is that of DOP853
        let ground = &found.contacts[0].statistics;
        let impulse_n_s: f64 = -force_n.iter().sum::<f64>();
        assert!((ground.impulse_n_s / impulse_n_s - 1.0).abs() < 1e-14, "{}", ground.impulse_n_s);
        assert!((ground.largest_force_n / 1.923_897_80e9 - 1.0).abs() < 1e-8, "{}", ground.largest_force_n);
    }
}
