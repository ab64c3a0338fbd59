//! Assemblies over long times: rest, reliability, and limiting cases.

use beam_modes::{Beam, End, RectangularSegment, Segment};
use contact_models::{Hertz, KelvinVoigt, Law, LinearSpring, Viscous};
use vibroimpact_sim::assembly::{
    Assembly, Body, BodyMode, Contact, Force, Interval, Load, Observer, Outcome, Point, Reason, Run, Settings, Solver,
    run,
};

struct ByContact(Vec<Vec<Interval>>);

impl Observer for ByContact {
    fn interval(&mut self, contact: usize, interval: &Interval) {
        self.0[contact].push(*interval);
    }
}

fn solve(assembly: &Assembly<Law>, settings: &Settings) -> (Run, Vec<Vec<Interval>>) {
    let mut seen = ByContact(vec![vec![]; assembly.contacts.len()]);
    let run = run(assembly, settings, &mut seen).unwrap();
    (run, seen.0)
}

fn mass(body: usize, mass_kg: f64) -> Point {
    Point::OfBody { body, shape: vec![mass_kg.sqrt().recip()] }
}

fn weight(body: usize, mass_kg: f64) -> Load {
    Load { body, shape: vec![mass_kg.sqrt()], force: Force::Constant { force_n: -9.81 } }
}

/// A ball that falls on the middle of a clamped beam.
fn dropped(law: Law, damping_ratio: f64, n: usize) -> Assembly<Law> {
    let segment = Segment::from(RectangularSegment {
        length_m: 0.5,
        youngs_modulus_pa: 2e11,
        density_kg_m3: 7800.0,
        width_m: 0.03,
        thickness_m: 0.01,
    });
    let beam = Beam { segments: vec![segment], ends: [End::Clamped, End::Clamped] };
    let modes = beam.modes(n).unwrap();
    let of = |omega: &f64| BodyMode { omega_rad_s: *omega, damping_ratio };
    let place = Point::OfBody { body: 1, shape: modes.shapes_at(0.2).unwrap() };
    Assembly {
        bodies: vec![Body::mass(0.05, 2e-3, 0.0), Body::at_rest(modes.omega_rad_s().iter().map(of).collect())],
        contacts: vec![Contact { sides: [mass(0, 0.05), place], gap_m: 0.0, law }],
        loads: vec![weight(0, 0.05)],
    }
}

#[test]
fn a_dropped_ball_comes_to_rest_and_stays_there() {
    let law = Law::from(Viscous::new(1e9, 0.5).unwrap());
    let assembly = dropped(law, 0.02, 10);
    let (found, intervals) = solve(&assembly, &Settings::until(20.0));
    assert_eq!(found.outcome, Outcome::Rest, "{:?}", found.counts);
    assert!(found.end_s < 3.0 && intervals[0].len() > 10, "{} {}", found.end_s, intervals[0].len());
    assert_eq!(intervals[0].last().unwrap().end_s, None);
    // It does stay at rest: a run four times as long finds no further interval.
    let mut on = Settings::until(4.0 * found.end_s);
    on.stop_at_rest = false;
    let (later, all) = solve(&assembly, &on);
    assert_eq!(later.outcome, Outcome::End);
    assert_eq!(all[0].len(), intervals[0].len());
    // At the end, under the weight of the ball.
    assert!((later.contacts[0].force_n / (0.05 * 9.81) - 1.0).abs() < 1e-3, "{}", later.contacts[0].force_n);
}

#[test]
fn an_orderly_run_is_certain_to_its_end_and_a_chaotic_one_is_not() {
    let settings = Settings::until(0.1);
    let orderly = dropped(Law::from(Viscous::new(1e9, 0.5).unwrap()), 0.05, 3);
    let (found, intervals) = solve(&orderly, &settings);
    let certain =
        Solver::new(&orderly).unwrap().reliable_until(&settings, &intervals, found.end_s, &mut || false).unwrap();
    assert_eq!(certain, Some(found.end_s));
    let chaotic = dropped(Law::from(Hertz::new(1e9).unwrap()), 0.0, 10);
    let mut settings = Settings::until(0.5);
    settings.tolerance = 1e-7;
    let (found, intervals) = solve(&chaotic, &settings);
    let certain =
        Solver::new(&chaotic).unwrap().reliable_until(&settings, &intervals, found.end_s, &mut || false).unwrap();
    let certain = certain.unwrap();
    assert!(certain < found.end_s && certain > 0.02, "{certain}");
    // A second run that is stopped gives no information.
    let stopped = Solver::new(&chaotic).unwrap().reliable_until(&settings, &intervals, found.end_s, &mut || true);
    assert_eq!(stopped.unwrap(), None);
    // Up to this time, a run with a far smaller tolerance agrees.
    settings.tolerance = 1e-12;
    let (_, tight) = solve(&chaotic, &settings);
    for (one, other) in intervals[0].iter().zip(&tight[0]).filter(|(one, _)| one.end_s.is_some_and(|at| at < certain)) {
        assert!((one.start_s - other.start_s).abs() < 32.0 * 1e-7 * one.start_s, "{one:?} {other:?}");
    }
}

#[test]
fn a_ball_that_grazes_touches_and_one_that_does_not_does_not() {
    // Thrown up under a ceiling: the apex is 1e-12 m beyond the ceiling, or below it.
    let (m, g, v) = (0.1, 9.81, 1.0);
    let apex = v * v / (2.0 * g);
    for (beyond, contacts) in [(1e-12, 1), (-1e-12, 0)] {
        let ball = Body::mass(m, 0.0, v);
        let law = Law::from(Hertz::new(1e9).unwrap());
        let contact = Contact { sides: [Point::Ground, mass(0, m)], gap_m: apex - beyond, law };
        let assembly = Assembly { bodies: vec![ball], contacts: vec![contact], loads: vec![weight(0, m)] };
        let (found, intervals) = solve(&assembly, &Settings::until(0.15));
        assert_eq!(intervals[0].len(), contacts, "{beyond}");
        assert_eq!(found.outcome, Outcome::End);
        if let Some(interval) = intervals[0].first() {
            let half = (2.0 * beyond / g).sqrt();
            assert!((interval.start_s - (v / g - half)).abs() < 2e-3 * half, "{interval:?}");
            assert!(interval.peak_compression_m < 1.1 * beyond);
        }
    }
}

#[test]
fn very_different_stiffnesses_can_be_combined() {
    // A chain between two walls, with springs from 1e4 to 1e12 N/m.
    let m = 0.1;
    let bodies = (0..4).map(|i| Body::mass(m, 0.0, if i == 0 { 1.0 } else { 0.0 })).collect();
    let law = |k: f64| Law::from(LinearSpring::new(k).unwrap());
    let stiffness = [1e4, 1e8, 1e12];
    let mut contacts: Vec<Contact<Law>> =
        (0..3).map(|i| Contact { sides: [mass(i + 1, m), mass(i, m)], gap_m: 1e-4, law: law(stiffness[i]) }).collect();
    contacts.push(Contact { sides: [Point::Ground, mass(3, m)], gap_m: 1e-3, law: law(1e6) });
    contacts.push(Contact { sides: [mass(0, m), Point::Ground], gap_m: 1e-3, law: law(1e6) });
    let assembly = Assembly { bodies, contacts, loads: vec![] };
    let mut settings = Settings::until(0.05);
    settings.max_steps = 100_000;
    let (found, intervals) = solve(&assembly, &settings);
    assert_eq!(found.outcome, Outcome::End, "{found:?} {intervals:?}");
    let stored: f64 = found.contacts.iter().map(|contact| contact.stored_j).sum();
    let energy: f64 = found.rate.iter().map(|rate| 0.5 * rate[0] * rate[0]).sum::<f64>() + stored;
    assert!((energy / (0.5 * m) - 1.0).abs() < 1e-10, "{:e}", energy / (0.5 * m) - 1.0);
    assert!(intervals.iter().all(|of| !of.is_empty()), "{:?}", found.counts);
}

#[test]
fn contacts_that_nearly_coincide_are_distinguished() {
    // One ball, two springs one behind the other at a distance of a nanometre, and the same as one spring.
    let m = 0.1;
    let ball = || Body::mass(m, 1e-3, -1.0);
    let law = |k: f64| Law::from(LinearSpring::new(k).unwrap());
    let contact = |gap_m: f64, k: f64| Contact { sides: [mass(0, m), Point::Ground], gap_m: -gap_m, law: law(k) };
    let of = |contacts: Vec<Contact<Law>>| Assembly { bodies: vec![ball()], contacts, loads: vec![] };
    let (_, apart) = solve(&of(vec![contact(0.0, 4e7), contact(1e-9, 6e7)]), &Settings::until(2e-3));
    let (one, _) = solve(&of(vec![contact(0.0, 1e8)]), &Settings::until(2e-3));
    let (two, together) = solve(&of(vec![contact(0.0, 4e7), contact(0.0, 6e7)]), &Settings::until(2e-3));
    assert!((apart[0][0].start_s - apart[1][0].start_s - 1e-9).abs() < 1e-15);
    assert!(together[0][0].start_s == together[1][0].start_s);
    assert!((one.rate[0][0] - two.rate[0][0]).abs() < 1e-10);
}

#[test]
fn loads_that_begin_and_end_within_a_contact_are_followed() {
    let m = 0.1;
    let law = Law::from(LinearSpring::new(1e6).unwrap());
    let contact = Contact { sides: [mass(0, m), Point::Ground], gap_m: 0.0, law };
    let times_s = vec![2e-4, 2e-4, 5e-4, 5e-4];
    let forces_n = vec![0.0, 100.0, 100.0, 0.0];
    let load =
        Load { body: 0, shape: vec![m.sqrt().recip()], force: Force::Sampled { times_s: times_s.clone(), forces_n } };
    let ball = Body::mass(m, 0.0, -1.0);
    let assembly = Assembly { bodies: vec![ball], contacts: vec![contact], loads: vec![load] };
    let (found, _) = solve(&assembly, &Settings::until(8e-4));
    // In contact all the time: an oscillator under a rectangular pulse.
    let omega = (1e6f64 / m).sqrt();
    let step = |t: f64| if t > 0.0 { 100.0 / (m * omega) * (omega * t).sin() } else { 0.0 };
    let exact = -(omega * 8e-4).cos() + step(8e-4 - 2e-4) - step(8e-4 - 5e-4);
    assert!((found.contacts[0].velocity_m_s[0] - exact).abs() < 1e-10, "{exact}");
}

#[test]
fn many_intervals_and_limits() {
    let damped = dropped(Law::from(KelvinVoigt::new(1e7, 1.0).unwrap()), 0.001, 5);
    let mut settings = Settings::until(100.0);
    settings.max_intervals = 7;
    let (found, intervals) = solve(&damped, &settings);
    assert_eq!(found.outcome, Outcome::Stopped(Reason::Intervals));
    assert_eq!(intervals[0].len(), 7);
    settings.max_steps = 50;
    let (found, _) = solve(&damped, &settings);
    assert_eq!(found.outcome, Outcome::Stopped(Reason::Steps));
    assert!(found.end_s > 0.0);
    // Nothing at all.
    let empty: Assembly<Law> = Assembly { bodies: vec![], contacts: vec![], loads: vec![] };
    assert_eq!(solve(&empty, &Settings::until(1.0)).0.outcome, Outcome::End);
}

#[test]
fn a_ball_does_not_fall_through_the_floor_for_any_height_and_end() {
    // Flights of a rigid ball are one power series over the whole run: its rounding must not hide the floor.
    let (m, g) = (0.1, 9.81);
    for i in 0..60 {
        let (height, end_s) = (1e-4 * 1.17f64.powi(i % 20), 0.2 + 0.37 * f64::from(i));
        let contact = Contact { sides: [mass(0, m), Point::Ground], gap_m: 0.0, law: Hertz::new(1e9).unwrap().into() };
        let ball = Body::mass(m, height, 0.0);
        let assembly = Assembly { bodies: vec![ball], contacts: vec![contact], loads: vec![weight(0, m)] };
        let (found, intervals) = solve(&assembly, &Settings::until(end_s));
        let (first, second) = (intervals[0][0].start_s, intervals[0][1].start_s);
        assert!((first - (2.0 * height / g).sqrt()).abs() < 1e-12);
        let expected = ((end_s - first) / (second - first)).floor() as usize + 1;
        assert!(intervals[0].len().abs_diff(expected) <= 1, "{i}: {} {expected}", intervals[0].len());
        assert!(found.contacts[0].displacement_m[0] > -1e-3, "{i}");
    }
}
