//! Assemblies compared with closed forms and with an independent integration of the same equations.

use crate::common::{Intervals, dormand_prince};
use beam_modes::{Beam, End, RectangularSegment, Segment};
use contact_models::{ContactLaw, Hertz, KelvinVoigt, Law, LinearSpring, Memory};
use std::f64::consts::PI;
use vibroimpact_sim::assembly::{
    Assembly, Body, BodyMode, Contact, Force, Interval, Load, Outcome, Point, Run, Settings, Statistics, run,
};

fn solve(assembly: &Assembly<Law>, end_s: f64, tolerance: f64) -> (Run, Vec<(usize, Interval)>) {
    let mut settings = Settings::until(end_s);
    settings.tolerance = tolerance;
    let mut seen = Intervals::default();
    let run = run(assembly, &settings, &mut seen).unwrap();
    seen.0.sort_by(|a, b| a.1.start_s.total_cmp(&b.1.start_s));
    (run, seen.0)
}

fn point(body: usize, shape: &[f64]) -> Point {
    Point::OfBody { body, shape: shape.to_vec() }
}

fn mass(body: usize, mass_kg: f64) -> Point {
    point(body, &[mass_kg.sqrt().recip()])
}

/// Velocities of both sides of every contact at the end, by a Runge-Kutta integration of all modes, for laws with one branch
/// and a force that is not negative.
fn reference(assembly: &Assembly<Law>, end_s: f64, tolerance: f64) -> Vec<[f64; 2]> {
    let first: Vec<usize> = assembly
        .bodies
        .iter()
        .scan(0, |next, body| {
            let first = *next;
            *next += body.modes.len();
            Some(first)
        })
        .collect();
    let modes: Vec<BodyMode> = assembly.bodies.iter().flat_map(|body| body.modes.clone()).collect();
    let n = modes.len();
    let side = |point: &Point, y: &[f64], of: usize| match point {
        Point::Ground => 0.0,
        Point::OfBody { body, shape } => {
            shape.iter().enumerate().map(|(k, phi)| phi * y[of * n + first[*body] + k]).sum::<f64>()
        }
    };
    let slope = |t: f64, y: &[f64], dy: &mut [f64]| {
        for k in 0..n {
            let (omega, zeta) = (modes[k].omega_rad_s, modes[k].damping_ratio);
            dy[k] = y[n + k];
            dy[n + k] = -2.0 * zeta * omega * y[n + k] - omega * omega * y[k];
        }
        for contact in &assembly.contacts {
            let [a, b] = &contact.sides;
            let xi = side(b, y, 0) - side(a, y, 0) - contact.gap_m;
            let rate = side(b, y, 1) - side(a, y, 1);
            let branch = contact.law.touch(&Memory::default(), 1.0);
            let force = if xi > 0.0 { contact.law.force(&branch, xi, rate).force_n.max(0.0) } else { 0.0 };
            for (point, sign) in [(a, 1.0), (b, -1.0)] {
                if let Point::OfBody { body, shape } = point {
                    shape.iter().enumerate().for_each(|(k, phi)| dy[n + first[*body] + k] += sign * phi * force);
                }
            }
        }
        for load in &assembly.loads {
            let force = match &load.force {
                Force::Constant { force_n } => *force_n,
                Force::Harmonic { force_n, omega_rad_s, phase_rad } => force_n * (omega_rad_s * t + phase_rad).sin(),
                Force::Sampled { times_s, forces_n } => {
                    let after = times_s.partition_point(|time| *time <= t);
                    if after == 0 || after == times_s.len() {
                        0.0
                    } else {
                        let part = (t - times_s[after - 1]) / (times_s[after] - times_s[after - 1]);
                        forces_n[after - 1] + part * (forces_n[after] - forces_n[after - 1])
                    }
                }
                _ => 0.0,
            };
            load.shape.iter().enumerate().for_each(|(k, phi)| dy[n + first[load.body] + k] += phi * force);
        }
    };
    let mut y: Vec<f64> = assembly.bodies.iter().flat_map(|body| body.amplitude.clone()).collect();
    y.extend(assembly.bodies.iter().flat_map(|body| body.rate.clone()));
    let scale = |i: usize| if i < n { 1e-4 } else { 1.0 };
    // A step ends where a load ends abruptly.
    let mut stops: Vec<f64> = vec![end_s];
    for load in &assembly.loads {
        if let Force::Sampled { times_s, .. } = &load.force {
            stops.extend(times_s.iter().filter(|time| **time > 0.0 && **time < end_s));
        }
    }
    stops.sort_by(f64::total_cmp);
    let mut from = 0.0;
    for stop in stops {
        if stop > from {
            dormand_prince(slope, scale, &mut y, (from, stop, 1e-7), tolerance);
            from = stop;
        }
    }
    assembly.contacts.iter().map(|contact| contact.sides.each_ref().map(|point| side(point, &y, 1))).collect()
}

fn compare(assembly: &Assembly<Law>, end_s: f64, floor: f64) -> Vec<(usize, Interval)> {
    let (found, intervals) = solve(assembly, end_s, 1e-10);
    assert_eq!(found.outcome, Outcome::End, "{:?}", found.counts);
    let (fine, coarse) = (reference(assembly, end_s, 1e-13), reference(assembly, end_s, 1e-12));
    for (c, contact) in found.contacts.iter().enumerate() {
        for side in 0..2 {
            let known = 3.0 * (fine[c][side] - coarse[c][side]).abs() + floor;
            let error = (contact.velocity_m_s[side] - fine[c][side]).abs();
            assert!(error < known, "contact {c}, side {side}: {error:e}, reference to {known:e}; {:?}", found.counts);
        }
    }
    intervals
}

fn mass_on_a_spring_before_a_stop() -> Assembly<Law> {
    let body = Body {
        modes: vec![BodyMode { omega_rad_s: 10.0, damping_ratio: 0.0 }],
        amplitude: vec![0.0],
        rate: vec![10.0],
    };
    let law = Law::from(LinearSpring::new(1e6).unwrap());
    let stop = Contact { sides: [Point::Ground, mass(0, 100.0)], gap_m: 0.0, law };
    Assembly { bodies: vec![body], contacts: vec![stop], loads: vec![] }
}

#[test]
fn a_mass_on_a_spring_meets_a_stop_at_the_closed_forms_times() {
    // Half periods against the stop and away from it alternate.
    let assembly = mass_on_a_spring_before_a_stop();
    let (found, intervals) = solve(&assembly, 34.6, 1e-12);
    let (pressed, free) = (PI / 10100f64.sqrt(), PI / 10.0);
    assert_eq!(found.contacts[0].statistics.intervals as usize, intervals.len());
    assert_eq!(intervals.len(), 101);
    for (i, (_, interval)) in intervals[..100].iter().enumerate() {
        let start = i as f64 * (pressed + free);
        assert!((interval.start_s - start).abs() < 1e-12 * (1.0 + i as f64), "{i}: {:e}", interval.start_s - start);
        assert!((interval.end_s.unwrap() - start - pressed).abs() < 1e-12 * (1.0 + i as f64), "{i}");
        assert!((interval.peak_force_n / (1e6 / 10100f64.sqrt()) - 1.0).abs() < 1e-9);
    }
}

/// Statistics from a time within an interval of contact on, in closed form.
#[test]
fn statistics_begin_exactly_within_an_interval() {
    let assembly = mass_on_a_spring_before_a_stop();
    let omega = 10100f64.sqrt();
    let (pressed, free) = (PI / omega, PI / 10.0);
    let run_from = |statistics_from_s: f64, end_s: f64| {
        let settings = Settings { tolerance: 1e-12, statistics_from_s, ..Settings::until(end_s) };
        run(&assembly, &settings, &mut ()).unwrap()
    };
    // force and power vanish, or have passed their largest value, at these parts of the fifth contact
    for part in [0.25, 0.75] {
        let from_s = 4.0 * (pressed + free) + part * pressed;
        let found = run_from(from_s, from_s + pressed);
        assert_eq!(found.statistics_from_s, from_s);
        let Statistics { intervals, contact_time_s, impulse_n_s, largest_force_n, squared_force_n2_s, .. } =
            found.contacts[0].statistics;
        let (phase, force) = (part * PI, 1e6 / omega);
        let near = |found: f64, known: f64| assert!((found / known - 1.0).abs() < 1e-9, "{part}: {found} {known}");
        assert_eq!(intervals, 1);
        near(contact_time_s, (1.0 - part) * pressed);
        near(impulse_n_s, force / omega * (1.0 + phase.cos()));
        near(largest_force_n, if part < 0.5 { force } else { force * phase.sin() });
        near(squared_force_n2_s, force * force / omega * 0.5 * (PI - phase + phase.sin() * phase.cos()));
    }
    // in flight the remaining run is unchanged, and a later window has the rest of the intervals
    let whole = run_from(0.0, 3.0).contacts[0].statistics;
    let from_s = 3.0 * (pressed + free) - 0.5 * free;
    let (before, after) = (run_from(0.0, from_s).contacts[0].statistics, run_from(from_s, 3.0).contacts[0].statistics);
    assert_eq!(before.intervals + after.intervals, whole.intervals);
    assert!(
        (before.squared_force_n2_s + after.squared_force_n2_s - whole.squared_force_n2_s).abs()
            < 1e-9 * whole.squared_force_n2_s
    );
}

/// A run that comes to rest before the statistics begin goes on until they do.
/// Until the ball turns, a wall receives all of its energy, wherever within a panel that is.
#[test]
fn the_work_of_compression_is_the_energy_of_the_ball() {
    for speed in [0.1, 0.17, 0.31, 0.5, 0.83, 1.4, 2.2] {
        let wall = Contact { sides: [mass(0, 0.1), Point::Ground], gap_m: 0.0, law: Hertz::new(1e9).unwrap().into() };
        let ball = Body::mass(0.1, 0.0, -speed);
        let assembly = Assembly { bodies: vec![ball], contacts: vec![wall], loads: Vec::new() };
        let (found, _) = solve(&assembly, 0.01, 1e-9);
        let share = found.contacts[0].statistics.compression_work_j / (0.05 * speed * speed);
        assert!((share - 1.0).abs() < 1e-7, "{speed}: {share}");
    }
}

#[test]
fn statistics_of_a_body_at_rest_are_those_of_its_weight() {
    let law = Law::from(KelvinVoigt::new(1e5, 50.0).unwrap());
    let contact = Contact { sides: [mass(0, 0.1), Point::Ground], gap_m: 0.0, law };
    let weight = Load { body: 0, shape: vec![0.1f64.sqrt()], force: Force::Constant { force_n: -10.0 } };
    let assembly = Assembly { bodies: vec![Body::mass(0.1, 1e-4, 0.0)], contacts: vec![contact], loads: vec![weight] };
    let settings = Settings { statistics_from_s: 2.0, rest_from_s: 2.0, ..Settings::until(5.0) };
    let found = run(&assembly, &settings, &mut ()).unwrap();
    assert_eq!((found.outcome, found.statistics_from_s), (Outcome::Rest, 2.0));
    let Statistics { squared_force_n2_s, contact_time_s, largest_force_n, .. } = found.contacts[0].statistics;
    assert!(found.end_s > 2.0 && (contact_time_s - (found.end_s - 2.0)).abs() < 1e-12, "{found:?}");
    assert!(
        ((squared_force_n2_s / contact_time_s).sqrt() - 1.0).abs() < 1e-6 && (largest_force_n - 1.0).abs() < 1e-6,
        "{found:?}"
    );
}

#[test]
fn a_dropped_ball_bounces_forever_on_an_elastic_floor() {
    let (m, g, height) = (0.1, 9.81, 0.01);
    let law = Law::from(Hertz::new(1e9).unwrap());
    let contact = Contact { sides: [mass(0, m), Point::Ground], gap_m: 0.0, law };
    let weight = Load { body: 0, shape: vec![m.sqrt()], force: Force::Constant { force_n: -g } };
    let ball = Body::mass(m, height, 0.0);
    let assembly = Assembly { bodies: vec![ball], contacts: vec![contact], loads: vec![weight] };
    let (_, intervals) = solve(&assembly, 10.0, 1e-10);
    let fall = (2.0 * height / g).sqrt();
    assert!((intervals[0].1.start_s - fall).abs() < 1e-15);
    let speed = (2.0 * g * height).sqrt();
    for (_, interval) in &intervals[..intervals.len() - 1] {
        assert!((interval.approach_speed_m_s - speed).abs() < 1e-9, "{interval:?}");
        assert!((interval.separation_speed_m_s.unwrap() - speed).abs() < 1e-9);
    }
    compare(&assembly, 0.3, 1e-9);
}

/// A constant force pulls the ball away from the wall that it strikes, so that the motion without contact would turn around too.
/// The force takes as much energy on the way in as it returns on the way out.
#[test]
fn a_ball_that_is_pulled_away_rebounds_as_fast_as_it_came() {
    for k in 0..40 {
        let pull_n = 10f64.powf(-1.0 + 3.0 * f64::from(k) / 39.0);
        let ball = Body::mass(0.0643584, 1.1e-5, -0.178);
        let law = Law::Hertz(Hertz::new(2.757e6).unwrap());
        let contact = Contact { sides: [mass(0, 0.0643584), Point::Ground], gap_m: 0.0, law };
        let load =
            Load { body: 0, shape: vec![0.0643584f64.sqrt().recip()], force: Force::Constant { force_n: pull_n } };
        let assembly = Assembly { bodies: vec![ball], contacts: vec![contact], loads: vec![load] };
        let (run, seen) = solve(&assembly, 0.05, 1e-9);
        let touches = 0.5 * 0.0643584 * 0.178f64.powi(2) > pull_n * 1.1e-5;
        assert_eq!(run.outcome, Outcome::End, "{pull_n} N");
        assert_eq!(seen.len(), usize::from(touches), "{pull_n} N");
        for (_, interval) in seen {
            let [before, after] =
                [Some(interval.approach_speed_m_s), interval.separation_speed_m_s].map(Option::unwrap);
            assert!((after - before).abs() < 1e-8 * 0.178, "{pull_n} N: {before} and {after} m/s");
        }
    }
}

#[test]
fn newtons_cradle_transfers_the_impact() {
    let law = Law::from(Hertz::new(1e9).unwrap());
    let m = 0.1;
    let bodies = (0..5).map(|i| Body::mass(m, 0.0, if i == 0 { 1.0 } else { 0.0 })).collect();
    let contact = |i: usize| Contact { sides: [mass(i + 1, m), mass(i, m)], gap_m: 0.0, law };
    let cradle = Assembly { bodies, contacts: (0..4).map(contact).collect(), loads: vec![] };
    let intervals = compare(&cradle, 1e-3, 1e-9);
    assert!(intervals[..4].iter().all(|(_, interval)| interval.start_s == 0.0), "{intervals:?}");
    let (found, _) = solve(&cradle, 1e-3, 1e-10);
    let momentum: f64 = found.rate.iter().map(|rate| rate[0] * m.sqrt()).sum();
    let energy: f64 = found.rate.iter().map(|rate| 0.5 * rate[0] * rate[0]).sum();
    assert!((momentum - m).abs() < 1e-14 && (energy - 0.5 * m).abs() < 1e-11, "{momentum} {energy}");
    // Nearly all of the momentum is transferred to the last ball.
    assert!(found.rate[4][0] / m.sqrt() > 0.9 && found.rate[0][0].abs() / m.sqrt() < 0.15);
}

/// Balls in a row that touch at the start; the last of them alone is in motion, or the first, with the contacts in either
/// order. The force of a contact before the wave arrives is below any tolerance: it costs no panels, and it ends no interval.
#[test]
fn contacts_without_force_cost_nothing_and_end_no_interval() {
    let law = Law::from(Hertz::new(1e9).unwrap());
    let masses = [0.1, 0.05, 0.2, 0.1, 0.01];
    let speeds = |mirrored: bool, exchanged: bool, tolerance: f64| -> (Vec<f64>, u64) {
        let (struck, velocity) = if mirrored { (4, -1.0) } else { (0, 1.0) };
        let mass_kg = |i: usize| masses[if mirrored { 4 - i } else { i }];
        let bodies = (0..5).map(|i| Body::mass(mass_kg(i), 0.0, if i == struck { velocity } else { 0.0 })).collect();
        let side = |i: usize| mass(i, mass_kg(i));
        let contact = |i: usize| Contact { sides: [side(i + 1), side(i)], gap_m: 0.0, law };
        let mut contacts: Vec<_> = (0..4).map(contact).collect();
        if exchanged {
            contacts.reverse();
        }
        let (found, intervals) = solve(&Assembly { bodies, contacts, loads: vec![] }, 1e-3, tolerance);
        for c in 0..4 {
            let first = intervals.iter().find(|(contact, _)| *contact == c).unwrap().1;
            assert!(first.start_s == 0.0 && first.end_s.unwrap() > 1e-4, "{mirrored} {tolerance:e}: {first:?}");
        }
        let speed = |i: usize| velocity * found.rate[i][0] / mass_kg(i).sqrt();
        let speeds = (0..5).map(|i| speed(if mirrored { 4 - i } else { i })).collect();
        (speeds, found.counts.newton_iterations)
    };
    let (exact, _) = speeds(false, false, 1e-12);
    for (mirrored, exchanged) in [(false, false), (false, true), (true, false), (true, true)] {
        for tolerance in [1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-9] {
            let (found, iterations) = speeds(mirrored, exchanged, tolerance);
            for (found, exact) in found.iter().zip(&exact) {
                assert!((found - exact).abs() < (0.1 * tolerance).max(1e-12), "{tolerance:e}: {found} {exact}");
            }
            // A panel needs two, and their number grows with the ninth root of the accuracy.
            let panels = 16.0 * tolerance.powf(-1.0 / 9.0);
            assert!((iterations as f64) < 4.0 * panels, "{tolerance:e}: {iterations}");
        }
    }
}

/// A clamped-free beam at some locations.
fn cantilever(n: usize, places: &[f64]) -> (Vec<BodyMode>, Vec<Vec<f64>>) {
    let segment = Segment::from(RectangularSegment {
        length_m: 1.0,
        youngs_modulus_pa: 2e11,
        density_kg_m3: 7800.0,
        width_m: 0.02,
        thickness_m: 0.01,
    });
    let beam = Beam { segments: vec![segment], ends: [End::Clamped, End::Free] };
    let modes = beam.modes(n).unwrap();
    let of = |omega: &f64| BodyMode { omega_rad_s: *omega, damping_ratio: 0.01 };
    let shapes = places.iter().map(|x| modes.shapes_at(*x).unwrap()).collect();
    (modes.omega_rad_s().iter().map(of).collect(), shapes)
}

#[test]
fn bodies_contacts_and_loads_of_every_kind_can_be_combined() {
    let (modes, shapes) = cantilever(6, &[0.5, 1.0, 0.8]);
    let ball = Body::mass(0.2, 0.0, -1.0);
    let hertz = Law::from(Hertz::new(1e8).unwrap());
    let spring = Law::from(LinearSpring::new(1e5).unwrap());
    let other = Law::from(LinearSpring::new(2e5).unwrap());
    let contacts = vec![
        Contact { sides: [mass(1, 0.2), point(0, &shapes[0])], gap_m: 0.0, law: hertz },
        Contact { sides: [point(0, &shapes[1]), Point::Ground], gap_m: 1e-3, law: spring },
        Contact { sides: [point(2, &shapes[1]), point(0, &shapes[2])], gap_m: 5e-4, law: other },
    ];
    let loads = vec![
        Load { body: 1, shape: vec![0.2f64.sqrt()], force: Force::Constant { force_n: -9.81 } },
        Load {
            body: 0,
            shape: shapes[1].clone(),
            force: Force::Harmonic { force_n: 30.0, omega_rad_s: 700.0, phase_rad: 0.4 },
        },
        Load {
            body: 2,
            shape: shapes[0].clone(),
            force: Force::Sampled { times_s: vec![0.002, 0.004, 0.004, 0.011], forces_n: vec![0.0, -80.0, 50.0, 0.0] },
        },
        Load { body: 1, shape: vec![0.2f64.sqrt().recip()], force: Force::Constant { force_n: -3.0 } },
    ];
    let bodies = vec![Body::at_rest(modes.clone()), ball, Body::at_rest(modes)];
    let assembly = Assembly { bodies, contacts, loads };
    let intervals = compare(&assembly, 0.03, 2e-8);
    for contact in 0..3 {
        assert!(intervals.iter().any(|(c, _)| *c == contact), "contact {contact} never closes");
    }
}

#[test]
fn code_asters_cantilever_meets_its_stop_as_computed_elsewhere() {
    // SDNL104: a tip force on a cantilever above an elastic stop.
    let (r, length, e, rho) = (0.1f64, 1.0, 1e10, 1e6);
    let segment = Segment {
        length_m: length,
        flexural_rigidity_n_m2: e * PI * r.powi(4) / 4.0,
        mass_per_length_kg_m: rho * PI * r * r,
    };
    let beam = Beam { segments: vec![segment], ends: [End::Clamped, End::Free] };
    let modes = beam.modes(5).unwrap();
    let tip = modes.shapes_at(1.0).unwrap();
    let of = |omega: &f64| BodyMode { omega_rad_s: *omega, damping_ratio: 0.0 };
    let body = Body::at_rest(modes.omega_rad_s().iter().map(of).collect());
    let law = Law::from(LinearSpring::new(1e8).unwrap());
    let contact = Contact { sides: [point(0, &tip), Point::Ground], gap_m: 1e-4, law };
    let load = Load { body: 0, shape: tip, force: Force::Constant { force_n: -1000.0 } };
    let assembly = Assembly { bodies: vec![body], contacts: vec![contact], loads: vec![load] };
    let (_, intervals) = solve(&assembly, 0.16, 1e-10);
    let first = intervals[0].1;
    assert!((first.start_s - 0.036196).abs() < 1e-6 && (first.end_s.unwrap() - 0.092458).abs() < 1e-6);
    let (at, _) = solve(&assembly, 0.1315, 1e-10);
    let (later, _) = solve(&assembly, 0.1566, 1e-10);
    assert!((at.contacts[0].displacement_m[0] + 1.7360e-6).abs() < 1e-9);
    assert!((later.contacts[0].velocity_m_s[0] + 4.44e-3).abs() < 1e-5);
    compare(&assembly, 0.16, 1e-11);
}
