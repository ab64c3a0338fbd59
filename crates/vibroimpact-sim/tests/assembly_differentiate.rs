//! Derivatives of runs of assemblies compared with differences of runs at a tolerance of 1e-13.

use contact_models::{Flores, Hertz, HuntCrossley, Hysteretic, KelvinVoigt, Law, LinearSpring, Thornton};
use num_complex::Complex64;
use vibroimpact_sim::assembly::{
    Assembly, Body, BodyMode, Contact, Derivative, Derivatives, Differentiated, Force, Interval, Load, NoDerivative,
    Observer, Outcome, Parameter, Point, Run, Settings, Solver, run,
};

/// An assembly and the end of its run as functions of some numbers.
type Pose = fn(&[f64]) -> (Assembly<Law>, f64);

struct Case {
    pose: Pose,
    numbers: Vec<f64>,
}

#[derive(Default)]
struct Intervals(Vec<(usize, Interval)>);

impl Observer for Intervals {
    fn interval(&mut self, contact: usize, interval: &Interval) {
        self.0.push((contact, *interval));
    }
}

const STEPS: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];

impl Case {
    /// The same with one number changed.
    fn with(&self, which: usize, by: f64) -> (Assembly<Law>, f64) {
        let mut numbers = self.numbers.clone();
        numbers[which] += by;
        (self.pose)(&numbers)
    }

    fn size(&self, which: usize) -> f64 {
        self.numbers[which].abs().max(1e-3)
    }

    fn differentiate(&self, tolerance: f64) -> Differentiated {
        let (assembly, end_s) = (self.pose)(&self.numbers);
        let offsets = |which: usize| STEPS.map(|place| place * 1e-5 * self.size(which));
        let near: Vec<[(Assembly<Law>, f64); 4]> =
            (0..self.numbers.len()).map(|which| offsets(which).map(|offset| self.with(which, offset))).collect();
        let mut parameters = Vec::new();
        for (which, near) in near.iter().enumerate() {
            let laws =
                |assembly: &Assembly<Law>| assembly.contacts.iter().map(|contact| contact.law).collect::<Vec<_>>();
            parameters.push(Parameter {
                offsets: offsets(which),
                neighbours: near.each_ref().map(|near| &near.0),
                end_s: near.each_ref().map(|near| near.1),
                changes_laws: laws(&near[0].0) != laws(&assembly),
            });
        }
        let settings = Settings { tolerance, ..Settings::until(end_s) };
        Solver::new(&assembly).unwrap().differentiate(&settings, &parameters).unwrap()
    }

    fn run(&self, which: usize, by: f64) -> (Run, Vec<(usize, Interval)>) {
        let (assembly, end_s) = self.with(which, by);
        let mut intervals = Intervals::default();
        let settings = Settings { tolerance: 1e-13, ..Settings::until(end_s) };
        (run(&assembly, &settings, &mut intervals).unwrap(), intervals.0)
    }

    /// Fourth-order differences of all outputs that have derivatives, with steps that differ by a factor of four.
    fn differences(&self, which: usize) -> Vec<(f64, f64)> {
        let by = |part: f64| {
            let step = part * self.size(which);
            let [a, b, c, d] = STEPS.map(|place| outputs(&self.run(which, place * step)));
            let slope = |i: usize| (8.0 * (c[i] - b[i]) - (d[i] - a[i])) / (12.0 * step);
            (0..a.len()).map(slope).collect::<Vec<f64>>()
        };
        let (fine, coarse) = (by(3e-5), by(1.2e-4));
        fine.iter().zip(&coarse).map(|(fine, coarse)| (*fine, (fine - coarse).abs())).collect()
    }

    /// Compares every derivative with its difference; returns their number, and the number of those within the stated
    /// uncertainty.
    fn check(&self, part: f64) -> (usize, usize) {
        let found = self.differentiate(1e-10);
        let nominal = outputs(&(found.run.clone(), in_time(&found.intervals)));
        let derivatives = all(&found.derivatives);
        let (mut compared, mut covered) = (0, 0);
        for (which, derivatives) in derivatives.iter().enumerate() {
            let own = own_outputs(&found, derivatives);
            let references = self.differences(which);
            assert_eq!(own.len(), references.len());
            for (i, ((name, own), (reference, known))) in own.iter().zip(references).enumerate() {
                // Outputs of a run are accurate to some 1e-13, a peak to nine digits.
                let digits = if name.starts_with("peak") { 1e-9 } else { 1e-13 };
                let rounding = 10.0 * digits * nominal[i].abs() / (3e-5 * self.size(which));
                let error = (own.value - reference).abs();
                let allowed = part * reference.abs() + 3.0 * known + rounding;
                assert!(error <= allowed, "{name} by {which}: {} {reference} ± {known}, {rounding}", own.value);
                compared += 1;
                covered += usize::from(own.uncertainty.is_some_and(|by| error <= by + 3.0 * known + rounding));
            }
        }
        (compared, covered)
    }
}

/// The derivatives with respect to all parameters.
fn all(derivatives: &[Result<Derivatives, NoDerivative>]) -> Vec<Derivatives> {
    derivatives.iter().cloned().collect::<Result<_, _>>().unwrap()
}

fn in_time(intervals: &[Vec<Interval>]) -> Vec<(usize, Interval)> {
    intervals.iter().enumerate().flat_map(|(c, own)| own.iter().map(move |interval| (c, *interval))).collect()
}

/// The outputs that have derivatives, contact by contact.
fn outputs((run, intervals): &(Run, Vec<(usize, Interval)>)) -> Vec<f64> {
    let mut found = Vec::new();
    for (c, end) in run.contacts.iter().enumerate() {
        for (_, interval) in intervals.iter().filter(|(of, _)| *of == c) {
            found.extend([interval.start_s, interval.impulse_n_s, interval.peak_force_n, interval.peak_compression_m]);
            found.push(interval.approach_speed_m_s);
            found.extend(interval.end_s.into_iter().chain(interval.separation_speed_m_s));
        }
        found.extend(end.displacement_m.iter().chain(&end.velocity_m_s));
    }
    found
}

fn own_outputs(found: &Differentiated, derivatives: &Derivatives) -> Vec<(&'static str, Derivative)> {
    let mut own = Vec::new();
    assert_eq!(found.intervals.len(), derivatives.contacts.len());
    for contact in &derivatives.contacts {
        for by in &contact.intervals {
            own.extend([("start", by.start_s), ("impulse", by.impulse_n_s), ("peak force", by.peak_force_n)]);
            own.extend([("peak compression", by.peak_compression_m), ("approach", by.approach_speed_m_s)]);
            own.extend(by.end_s.map(|end| ("end", end)));
            own.extend(by.separation_speed_m_s.map(|speed| ("separation", speed)));
        }
        own.extend(contact.displacement_m.map(|by| ("displacement", by)));
        own.extend(contact.velocity_m_s.map(|by| ("velocity", by)));
    }
    own
}

fn point(body: usize, shape: &[f64]) -> Point {
    Point::OfBody { body, shape: shape.to_vec() }
}

fn of_mass(body: usize, mass_kg: f64) -> Point {
    point(body, &[mass_kg.sqrt().recip()])
}

/// A ball dropped on a floor that bounces three times: everything except the contact is known in closed form.
#[test]
fn a_dropped_ball_changes_with_everything() {
    let case = Case {
        pose: |n| {
            let [mass, height, speed, stiffness, gravity, gap, end_s] = n.try_into().unwrap();
            let sides = [of_mass(0, mass), Point::Ground];
            let law = HuntCrossley::new(stiffness, 1.5, 0.05).unwrap().into();
            let shape = vec![mass.sqrt()];
            let weight = Load { body: 0, shape, force: Force::Constant { force_n: -gravity } };
            let contacts = vec![Contact { sides, gap_m: gap, law }];
            (Assembly { bodies: vec![Body::mass(mass, height, speed)], contacts, loads: vec![weight] }, end_s)
        },
        numbers: vec![0.1, 0.01, -0.1, 1e8, 9.81, 1e-3, 0.25],
    };
    let (compared, covered) = case.check(1e-6);
    assert_eq!((compared, covered), (7 * (3 * 7 + 4), 7 * (3 * 7 + 4)));
    // The first touch, at the end of a parabola.
    let derivatives = all(&case.differentiate(1e-10).derivatives);
    let by_height = derivatives[1].contacts[0].intervals[0].start_s.value;
    let speed = (0.1f64 * 0.1 + 2.0 * 9.81 * 0.011).sqrt();
    assert!((by_height - speed.recip()).abs() < 1e-8 / speed, "{by_height}");
}

/// A ball bounces ever lower, and another one, pressed into the floor at the start, leaves it. The forces of such weak and short
/// contacts are known to fewer digits than their impulses, and their derivatives to fewer still.
#[test]
fn derivatives_of_weak_contacts_are_within_their_uncertainty() {
    let pose: Pose = |n| {
        let [mass, height, stiffness, exponent, damping, end_s] = n.try_into().unwrap();
        let law = HuntCrossley::new(stiffness, exponent, damping).unwrap().into();
        let on_floor = |body, gap_m| Contact { sides: [of_mass(body, mass), Point::Ground], gap_m, law };
        let weight = |body| Load { body, shape: vec![mass.sqrt()], force: Force::Constant { force_n: -9.81 } };
        let bodies = vec![Body::mass(mass, height, -0.1), Body::mass(mass, 0.0, 0.1)];
        let contacts = vec![on_floor(0, 0.0), on_floor(1, -1e-4 * height)];
        (Assembly { bodies, contacts, loads: vec![weight(0), weight(1)] }, end_s)
    };
    for (exponent, damping) in [1.5, 2.2, 2.5, 2.9].into_iter().flat_map(|n| [0.25, 0.5, 1.0].map(|by| (n, by))) {
        let case = Case { pose, numbers: vec![0.1, 0.01, 1e8, exponent, damping, 0.15] };
        let [own, fine] = [1e-9, 1e-13].map(|tolerance| {
            let found = case.differentiate(tolerance);
            let of = |by: &Derivatives| own_outputs(&found, by);
            all(&found.derivatives).iter().flat_map(of).collect::<Vec<_>>()
        });
        assert_eq!(own.len(), fine.len());
        for ((name, own), (_, fine)) in own.iter().zip(&fine) {
            let stated = own.uncertainty.unwrap_or(f64::INFINITY) + fine.uncertainty.unwrap_or(f64::INFINITY);
            let error = (own.value - fine.value).abs();
            assert!(
                error <= stated,
                "{name} at {exponent}, {damping}: {} {} {error:e} > {stated:e}",
                own.value,
                fine.value
            );
        }
    }
}

/// The motion of a mass under a harmonic force, for frequency, phase, height and speed at the start.
fn driven(n: &[f64]) -> (Assembly<Law>, f64) {
    let [omega_rad_s, phase_rad, height, speed, end_s] = n.try_into().unwrap();
    let force = Force::Harmonic { force_n: 20.0, omega_rad_s, phase_rad };
    let loads = vec![Load { body: 0, shape: vec![0.1f64.sqrt().recip()], force }];
    let law = Hertz::new(1e8).unwrap().into();
    let contacts = vec![Contact { sides: [of_mass(0, 0.1), Point::Ground], gap_m: 0.0, law }];
    (Assembly { bodies: vec![Body::mass(0.1, height, speed)], contacts, loads }, end_s)
}

/// After 20,000 periods the neighbouring values of the frequency are out of phase.
#[test]
fn derivatives_by_the_frequency_of_a_load_hold_at_late_times() {
    let (omega, phase, end_s) = (628.0, 0.7f64, 200.0);
    let speed = 20.0 / (0.1 * omega);
    let case = Case { pose: driven, numbers: vec![omega, phase, 1.0, -speed * phase.cos(), end_s] };
    let found = case.differentiate(1e-9);
    let (before, after) = (phase.sin_cos(), (omega * end_s + phase).sin_cos());
    let by_omega = speed * (end_s * after.0 - (before.1 - after.1) / omega);
    let velocities = [by_omega, speed * (after.0 - before.0)];
    for (by, expected) in found.derivatives.iter().zip(velocities) {
        let velocity = by.as_ref().unwrap().contacts[0].velocity_m_s[0];
        assert!((velocity.value - expected).abs() < 1e-8 * expected.abs(), "{velocity:?} {expected}");
    }
}

/// Two loads have the same frequency, or the frequency of one is that of the other at a neighbouring value.
#[test]
fn derivatives_by_one_of_two_frequencies_hold_where_they_meet() {
    let pose: Pose = |n| {
        let [first, second, end_s] = n.try_into().unwrap();
        let (mut assembly, end_s) = driven(&[first, 0.7, 1.0, 0.0, end_s]);
        let mut load = assembly.loads[0].clone();
        load.force = Force::Harmonic { force_n: 20.0, omega_rad_s: second, phase_rad: 0.2 };
        assembly.loads.push(load);
        (assembly, end_s)
    };
    let end_s = 200.0;
    for second in [628.0, 628.0 + 1e-5 * 628.0] {
        let found = Case { pose, numbers: vec![628.0, second, end_s] }.differentiate(1e-9);
        for ((omega, phase), by) in [(628.0, 0.7f64), (second, 0.2)].into_iter().zip(&found.derivatives) {
            let (before, after) = (phase.cos(), (omega * end_s + phase).sin_cos());
            let expected = 20.0 / (0.1 * omega) * (end_s * after.0 - (before - after.1) / omega);
            let velocity = by.as_ref().unwrap().contacts[0].velocity_m_s[0];
            assert!((velocity.value - expected).abs() < 1e-8 * expected.abs(), "{velocity:?} {expected}");
        }
    }
}

/// Just after the start the motion under a load is much smaller than its steady motion.
#[test]
fn derivatives_by_a_harmonic_load_hold_at_early_times() {
    let (omega, phase, speed) = (628.0, 0.7f64, 20.0 / (0.1 * 628.0));
    let case = Case { pose: driven, numbers: vec![omega, phase, 1e-5, -0.5, 1e-3] };
    let found = case.differentiate(1e-9);
    let start = found.derivatives[1].as_ref().unwrap().contacts[0].intervals[0].start_s;
    let angle = omega * found.intervals[0][0].start_s;
    let turned = -2.0 * (0.5 * angle).sin() * (phase + 0.5 * angle).sin();
    let expected = speed / omega * (angle * phase.sin() + turned) / (-0.5 - speed * turned);
    assert!((start.value - expected).abs() < 1e-9 * expected.abs(), "{start:?} {expected}");
}

/// The velocity of a mode that a harmonic load of 1 N moves from rest, in closed form. Complex numbers give its derivatives.
fn velocity_at_resonance([load, natural, zeta, time]: [Complex64; 4]) -> Complex64 {
    let (square, drag) = (natural * natural - load * load, zeta * natural * load * 2.0);
    let size = square * square + drag * drag;
    let (along, across) = (square / size, -drag / size);
    let steady =
        |angle: Complex64| [along * angle.sin() + across * angle.cos(), along * angle.cos() - across * angle.sin()];
    let [start, end] = [steady(Complex64::ZERO), steady(load * time)];
    let (decay, damped) = (zeta * natural, natural * (1.0 - zeta * zeta).sqrt());
    let (from, rate) = (-start[0], -load * start[1]);
    let sine = (rate + decay * from) / damped;
    let turned = [(damped * time).cos(), (damped * time).sin()];
    let free = (damped * sine - decay * from) * turned[0] - (damped * from + decay * sine) * turned[1];
    load * end[1] + (-decay * time).exp() * free
}

/// Near the resonance of a lightly damped mode neighbouring values may lie on both sides of the peak.
#[test]
fn derivatives_by_a_harmonic_load_hold_at_resonance() {
    let pose: Pose = |n| {
        let [load, natural, zeta, end_s] = n.try_into().unwrap();
        let sides = [Point::OfBody { body: 0, shape: vec![1.0] }, Point::Ground];
        let contacts = vec![Contact { sides, gap_m: 1.0, law: Hertz::new(1e8).unwrap().into() }];
        let force = Force::Harmonic { force_n: 1.0, omega_rad_s: load, phase_rad: 0.0 };
        let loads = vec![Load { body: 0, shape: vec![1.0], force }];
        (Assembly { bodies: vec![Body::at_rest(modes(&[natural], zeta))], contacts, loads }, end_s)
    };
    for (load, zeta) in [(628.0, 1e-3), (628.0, 1e-6), (628.001, 1e-6), (628.01, 1e-4)] {
        let numbers = vec![load, 628.0, zeta, 3.0];
        let found = Case { pose, numbers: numbers.clone() }.differentiate(1e-9);
        for (which, by) in found.derivatives.iter().enumerate().take(3) {
            let step = 1e-30 * numbers[which];
            let at = |i: usize| Complex64::new(numbers[i], if i == which { step } else { 0.0 });
            let expected = velocity_at_resonance([at(0), at(1), at(2), at(3)]).im / step;
            let velocity = by.as_ref().unwrap().contacts[0].velocity_m_s[0];
            let error = (velocity.value - expected).abs();
            assert!(error < 1e-6 * expected.abs(), "{load} {zeta} {which}: {velocity:?} {expected}");
            assert!(error < velocity.uncertainty.unwrap(), "{load} {zeta} {which}: {velocity:?} {expected}");
        }
    }
}

/// A load may have exactly the frequency of an undamped mode of a body that it does not act on, or at a node of which it acts.
#[test]
fn derivatives_exist_if_a_load_has_the_frequency_of_a_mode_that_it_does_not_excite() {
    let pose: Pose = |n| {
        let [natural, speed, force_n, end_s] = n.try_into().unwrap();
        let law = Hertz::new(1e8).unwrap().into();
        let sides = [of_mass(0, 0.1), Point::OfBody { body: 1, shape: vec![1.0, 0.5] }];
        let contacts = vec![Contact { sides, gap_m: 0.0, law }];
        let force = |force_n| Force::Harmonic { force_n, omega_rad_s: 628.0, phase_rad: 0.7 };
        let loads = vec![
            Load { body: 0, shape: vec![0.1f64.sqrt().recip()], force: force(force_n) },
            Load { body: 1, shape: vec![0.0, 1.0], force: force(5.0) },
        ];
        let bodies = vec![Body::mass(0.1, -1e-4, speed), Body::at_rest(modes(&[natural, 1500.0], 0.0))];
        (Assembly { bodies, contacts, loads }, end_s)
    };
    let (compared, covered) = Case { pose, numbers: vec![628.0, 1.0, 5.0, 0.01] }.check(1e-6);
    assert_eq!(compared, covered);
}

fn modes(numbers: &[f64], damping_ratio: f64) -> Vec<BodyMode> {
    numbers.iter().map(|&omega_rad_s| BodyMode { omega_rad_s, damping_ratio }).collect()
}

/// Two elastic bodies and a ball, three contacts with different laws, loads of every kind.
fn everything(n: &[f64]) -> (Assembly<Law>, f64) {
    let [omega, zeta, shape, mass, gap, stiffness, force, hertz, phase, pulse, begin, gravity, end_s] =
        n.try_into().unwrap();
    let shape_of = |first: f64| [first * shape, -0.8 * first, 0.6 * first];
    let one = Body::at_rest(modes(&[omega, 2.3 * omega, 4.1 * omega], zeta));
    let other =
        Body { rate: vec![0.02, 0.0, 0.01], ..Body::at_rest(modes(&[0.7 * omega, 2.9 * omega, 5.3 * omega], 0.01)) };
    let ball = Body::mass(mass, 2e-4, -0.4);
    let (a, b) = (shape_of(2.0), shape_of(1.5));
    let contacts = vec![
        Contact { sides: [of_mass(2, mass), point(0, &a)], gap_m: 0.0, law: Hertz::new(stiffness).unwrap().into() },
        Contact { sides: [point(0, &a), point(1, &b)], gap_m: gap, law: KelvinVoigt::new(1e6, 15.0).unwrap().into() },
        Contact { sides: [point(1, &b), Point::Ground], gap_m: gap, law: LinearSpring::new(2e6).unwrap().into() },
    ];
    let omega_rad_s = std::f64::consts::TAU * hertz;
    let loads = vec![
        Load { body: 0, shape: a.to_vec(), force: Force::Harmonic { force_n: force, omega_rad_s, phase_rad: phase } },
        Load {
            body: 1,
            shape: b.to_vec(),
            force: Force::Sampled { times_s: vec![begin, begin + 2e-3, 0.011], forces_n: vec![0.0, pulse, -3.0] },
        },
        Load { body: 2, shape: vec![mass.sqrt()], force: Force::Constant { force_n: -gravity } },
        Load {
            body: 2,
            shape: vec![mass.sqrt().recip()],
            force: Force::Sampled { times_s: vec![0.0, begin, 0.02], forces_n: vec![0.3, pulse * 0.01, 0.0] },
        },
    ];
    (Assembly { bodies: vec![one, other, ball], contacts, loads }, end_s)
}

fn numbers() -> Vec<f64> {
    vec![420.0, 0.03, 1.1, 0.06, 2e-4, 4e8, 6.0, 70.0, 0.4, -29.0, 4e-3, 9.81, 0.016]
}

#[test]
fn bodies_contacts_and_loads_of_every_kind_have_derivatives() {
    let case = Case { pose: everything, numbers: numbers() };
    let found = case.differentiate(1e-10);
    assert_eq!(found.run.outcome, Outcome::End);
    let counts: Vec<usize> = found.intervals.iter().map(Vec::len).collect();
    assert!(counts.iter().all(|count| *count > 0), "{counts:?}");
    let (compared, covered) = case.check(2e-6);
    assert!(covered as f64 >= 0.99 * compared as f64, "{covered} of {compared}");
}

/// Two balls that meet a wall each at the same time.
fn pair(law: Law) -> impl Fn(f64, f64) -> Assembly<Law> {
    move |speed, gap| {
        let wall = |body, gap_m| Contact { sides: [of_mass(body, 0.1), Point::Ground], gap_m, law };
        let ball = Body::mass(0.1, 0.01, -speed);
        Assembly { bodies: vec![ball.clone(), ball], contacts: vec![wall(0, 0.0), wall(1, gap)], loads: Vec::new() }
    }
}

fn by_speed_and_gap(law: Law) -> [Differentiated; 2] {
    let pose = pair(law);
    let assembly = pose(1.0, 0.0);
    let offsets = STEPS.map(|place| 1e-6 * place);
    [offsets.map(|by| pose(1.0 + by, 0.0)), offsets.map(|by| pose(1.0, by))].map(|near| {
        let neighbours = near.each_ref();
        let parameter = Parameter { offsets, neighbours, end_s: [0.02; 4], changes_laws: false };
        Solver::new(&assembly).unwrap().differentiate(&Settings::until(0.02), &[parameter]).unwrap()
    })
}

#[test]
fn contacts_that_touch_together_have_their_own_times() {
    let [speed, gap] = by_speed_and_gap(Hertz::new(1e9).unwrap().into());
    let starts = |found: &Differentiated| {
        let derivatives = found.derivatives[0].as_ref().unwrap();
        derivatives.contacts.iter().map(|contact| contact.intervals[0].start_s.value).collect::<Vec<_>>()
    };
    // It arrives at (0.01 + gap)/speed.
    assert!(starts(&speed).iter().all(|by| (by + 0.01).abs() < 1e-8), "{:?}", starts(&speed));
    assert!(starts(&gap)[0].abs() < 1e-8 && (starts(&gap)[1] - 1.0).abs() < 1e-8, "{:?}", starts(&gap));
    let ends = |found: &Differentiated| {
        let derivatives = found.derivatives[0].as_ref().unwrap();
        [0, 1].map(|c| derivatives.contacts[c].displacement_m[0])
    };
    // A wall that is further away returns the ball later from a more distant point: its displacement decreases
    // by twice as much.
    let [first, second] = ends(&gap);
    assert!(first.value.abs() < 1e-8, "{first:?}");
    // A force that begins at its own time is not a smooth change of one that begins with the panel.
    assert!((second.value + 2.0).abs() < 1e-5f64.min(second.uncertainty.unwrap()), "{second:?}");
}

/// The force of a dashpot jumps at first touch, so that the order of two touches matters immediately.
#[test]
fn forces_that_jump_together_have_a_derivative_only_if_they_stay_together() {
    let [speed, gap] = by_speed_and_gap(KelvinVoigt::new(1e6, 30.0).unwrap().into());
    assert!(speed.derivatives[0].is_ok());
    assert!(matches!(gap.derivatives[0], Err(NoDerivative::Together { contact: 1, .. })), "{:?}", gap.derivatives);
}

/// Of two loads that jump at once only one is moved, so that the times coincide here and not at the neighbours.
#[test]
fn a_load_that_jumps_beside_another_has_no_derivative_by_its_time() {
    let pose = |later: f64| {
        let pulse = |time_s: f64| Load {
            body: 0,
            shape: vec![0.1f64.sqrt().recip()],
            force: Force::Sampled { times_s: vec![0.0, time_s, time_s], forces_n: vec![1.0, 1.0, 0.0] },
        };
        Assembly { loads: vec![pulse(0.005), pulse(0.005 + later)], ..pair(Hertz::new(1e9).unwrap().into())(1.0, 0.0) }
    };
    let assembly = pose(0.0);
    for places in [STEPS, [1.0, 2.0, 3.0, 4.0]] {
        let offsets = places.map(|place| 1e-6 * place);
        let near = offsets.map(pose);
        let parameter = Parameter { offsets, neighbours: near.each_ref(), end_s: [0.02; 4], changes_laws: false };
        let found = Solver::new(&assembly).unwrap().differentiate(&Settings::until(0.02), &[parameter]).unwrap();
        assert_eq!(found.derivatives[0].as_ref().unwrap_err(), &NoDerivative::Split);
    }
}

#[test]
fn bad_parameters_are_named() {
    let pose = pair(Hertz::new(1e9).unwrap().into());
    let assembly = pose(1.0, 0.0);
    let other = Assembly { contacts: assembly.contacts[..1].to_vec(), ..assembly.clone() };
    let field = |offsets: [f64; 4], of: &Assembly<Law>, end_s: f64| {
        let parameter = Parameter { offsets, neighbours: [of; 4], end_s: [end_s; 4], changes_laws: false };
        Solver::new(&assembly).unwrap().differentiate(&Settings::until(0.02), &[parameter]).unwrap_err().field
    };
    assert_eq!(field([1.0, 1.0, 2.0, 3.0], &assembly, 1.0), "parameters[0].offsets");
    assert_eq!(field([1.0, 2.0, 3.0, 4.0], &assembly, f64::NAN), "parameters[0].end_s");
    assert_eq!(field([1.0, 2.0, 3.0, 4.0], &other, 1.0), "parameters[0].neighbours[0]");
}

/// A ball that falls on two points of the floor at once, `[gap, gap, height, restitution]`: each has its own speed of approach, which
/// the law remembers.
#[test]
fn contacts_that_touch_together_have_their_own_speeds() {
    let pose = |n: &[f64]| {
        let [one, other, height, restitution] = n.try_into().unwrap();
        let law = Flores::new(1e8, restitution).unwrap().into();
        let floor = |gap_m| Contact { sides: [of_mass(0, 0.1), Point::Ground], gap_m, law };
        let weight = Load { body: 0, shape: vec![0.1f64.sqrt()], force: Force::Constant { force_n: -9.81 } };
        let bodies = vec![Body::mass(0.1, height, -0.1)];
        (Assembly { bodies, contacts: vec![floor(one), floor(other)], loads: vec![weight] }, 0.08)
    };
    let case = Case { pose, numbers: vec![1e-4, 1e-4, 1e-3, 0.7] };
    // forces that begin smoothly one after the other cost some digits
    let (compared, covered) = case.check(1e-4);
    assert!(compared > 4 * 14 && covered >= compared - 2, "{covered} of {compared}");
    let derivatives = all(&case.differentiate(1e-10).derivatives);
    let by_gap = [0, 1].map(|c| derivatives[1].contacts[c].intervals[0].approach_speed_m_s.value);
    let speed = (0.1f64 * 0.1 + 2.0 * 9.81 * 1.1e-3).sqrt();
    assert!(by_gap[0].abs() < 1e-6 && (by_gap[1] - 9.81 / speed).abs() < 1e-4, "{by_gap:?}");
}

/// A ball that falls on a floor of Thornton's material, `[modulus, radius, yield pressure, height]`: beyond yield at first, and once
/// more below it.
#[test]
fn an_elastoplastic_contact_changes_with_its_material() {
    for (height, yields) in [(1e-2, true), (1e-5, false)] {
        let pose = |n: &[f64]| {
            let [modulus, radius, pressure, height] = n.try_into().unwrap();
            let law = Thornton::new(modulus, radius, pressure).unwrap();
            let floor = Contact { sides: [of_mass(0, 0.1), Point::Ground], gap_m: 0.0, law: law.into() };
            let weight = Load { body: 0, shape: vec![0.1f64.sqrt()], force: Force::Constant { force_n: -9.81 } };
            let bodies = vec![Body::mass(0.1, height, 0.0)];
            (Assembly { bodies, contacts: vec![floor], loads: vec![weight] }, 10.0 * (height / 9.81).sqrt())
        };
        let case = Case { pose, numbers: vec![1e11, 0.02, 1e9, height] };
        let found = case.differentiate(1e-10);
        let yield_m = Thornton::new(1e11, 0.02, 1e9).unwrap().yield_compression_m();
        assert_eq!(found.intervals[0][0].peak_compression_m > yield_m, yields);
        assert!(found.intervals[0].len() > 2, "{}", found.intervals[0].len());
        let (compared, covered) = case.check(1e-6);
        assert!(covered >= compared - 2, "{covered} of {compared}");
    }
}

/// Surfaces that overlap at the start and separate, `[speed, gap]`: the law passes branches that the compression determines.
#[test]
fn a_compressed_start_determines_the_branch() {
    fn posed(law: Law, n: &[f64]) -> (Assembly<Law>, f64) {
        let wall = Contact { sides: [of_mass(0, 0.1), Point::Ground], gap_m: n[1], law };
        (Assembly { bodies: vec![Body::mass(0.1, 0.0, n[0])], contacts: vec![wall], loads: Vec::new() }, 1e-3)
    }
    let elastoplastic: Pose = |n| posed(Thornton::new(1e11, 0.02, 1e9).unwrap().into(), n);
    let hysteretic: Pose = |n| {
        let law = Hysteretic { stiffness_n_m1_5: 1e9, theta_m: 0.5, beta: 0.4, k_bar: 2.0, epsilon_m: 0.0 };
        posed(law.into(), n)
    };
    for pose in [elastoplastic, hysteretic] {
        let (compared, covered) = Case { pose, numbers: vec![0.1, -2e-5] }.check(1e-6);
        assert!(compared > 10 && covered == compared, "{covered} of {compared}");
    }
}

/// A mass on a spring that rests against a stop until a ball strikes it, under a harmonic load on the ball: `[force, frequency,
/// stiffness, damping]`. The stop is touched from the start on, whatever they are.
#[test]
fn surfaces_that_rest_against_each_other_under_loads_touch_at_the_start() {
    let pose = |n: &[f64]| {
        let [force_n, omega_rad_s, spring, damping_ratio] = n.try_into().unwrap();
        let held = Body::at_rest(modes(&[spring, 3.0 * spring], damping_ratio));
        let at = [2.0, -1.5];
        let law = Hertz::new(1e9).unwrap().into();
        let contacts = vec![
            Contact { sides: [point(0, &at), Point::Ground], gap_m: 0.0, law },
            Contact { sides: [of_mass(1, 0.1), point(0, &at)], gap_m: 1e-5, law },
        ];
        let force = Force::Harmonic { force_n, omega_rad_s, phase_rad: 0.3 };
        let loads = vec![
            Load { body: 0, shape: vec![2.0, -1.5], force: force.clone() },
            Load { body: 1, shape: vec![0.1f64.sqrt().recip()], force },
        ];
        (Assembly { bodies: vec![held, Body::mass(0.1, 0.0, -0.5)], contacts, loads }, 3e-3)
    };
    let case = Case { pose, numbers: vec![-3.0, 150.0, 400.0, 0.02] };
    let found = case.differentiate(1e-10);
    assert_eq!(found.intervals[0][0].start_s, 0.0);
    for derivatives in all(&found.derivatives) {
        let first = &derivatives.contacts[0].intervals[0];
        assert_eq!(first.start_s.value, 0.0);
        assert!(first.approach_speed_m_s.value.abs() < 1e-10, "{:?}", first.approach_speed_m_s);
    }
}

/// A row of balls that touch at rest, struck by another: `[mass of the second ball, speed, stiffness]`.
fn cradle(numbers: &[f64]) -> (Assembly<Law>, f64) {
    let [mass, speed, stiffness] = numbers.try_into().unwrap();
    let masses = [0.1, mass, 0.1];
    let between = |left: usize| Contact {
        sides: [of_mass(left + 1, masses[left + 1]), of_mass(left, masses[left])],
        gap_m: 0.0,
        law: Hertz::new(stiffness).unwrap().into(),
    };
    let bodies = vec![Body::mass(0.1, 0.0, speed), Body::mass(mass, 0.0, 0.0), Body::mass(0.1, 0.0, 0.0)];
    (Assembly { bodies, contacts: vec![between(0), between(1)], loads: Vec::new() }, 1e-3)
}

#[test]
fn balls_that_rest_against_each_other_do_not_graze() {
    let case = Case { pose: cradle, numbers: vec![0.13, 1.0, 1e9] };
    assert!(case.differentiate(1e-10).nearest_graze > 0.0);
    let (compared, covered) = case.check(1e-6);
    assert!(compared > 20);
    assert_eq!(covered, compared);
}

/// A ball that begins compressed in a dashpot of `D = 1.6 (1 - e)/e/v_0` creeps out of it with the speed `1/D`: `[restitution, mass]`.
#[test]
fn a_ball_that_creeps_out_of_a_strong_dashpot_has_derivatives() {
    fn pose(numbers: &[f64]) -> (Assembly<Law>, f64) {
        let [restitution, mass] = numbers.try_into().unwrap();
        let law = Flores::new(2.6e9, restitution).unwrap().into();
        let contact = Contact { sides: [of_mass(0, mass), Point::Ground], gap_m: -6.3e-5, law };
        (Assembly { bodies: vec![Body::mass(mass, 0.0, 0.0)], contacts: vec![contact], loads: Vec::new() }, 3e-3)
    }
    let found = Case { pose, numbers: vec![0.56, 0.06] }.differentiate(1e-10);
    let [by_restitution, by_mass] = all(&found.derivatives).try_into().unwrap();
    let (by_restitution, by_mass) = (&by_restitution.contacts[0], &by_mass.contacts[0]);
    let expected = 1e-6 / 1.6 / (1.0f64 - 0.56).powi(2);
    assert!((by_restitution.velocity_m_s[0].value - expected).abs() < 1e-6 * expected, "{by_restitution:?}");
    assert!(by_mass.velocity_m_s[0].value.abs() < 1e-12, "{by_mass:?}");
}

/// A ball that rests on the ground without force, under a load that is zero: `[load, mass, stiffness]`.
#[test]
fn a_contact_that_rests_without_force_has_no_derivative_by_what_moves_it() {
    fn resting(law: Law, numbers: &[f64]) -> (Assembly<Law>, f64) {
        let [load, mass] = [numbers[0], numbers[1]];
        let contact = Contact { sides: [of_mass(0, mass), Point::Ground], gap_m: 0.0, law };
        let force = Force::Sampled { times_s: vec![2e-4, 1e-3], forces_n: vec![load, load] };
        let loads = vec![Load { body: 0, shape: vec![mass.sqrt().recip()], force }];
        (Assembly { bodies: vec![Body::mass(mass, 0.0, 0.0)], contacts: vec![contact], loads }, 6e-3)
    }
    let numbers = vec![0.0, 0.2, 1e6];
    let linear: Pose = |numbers| resting(KelvinVoigt::new(numbers[2], 50.0).unwrap().into(), numbers);
    let found = Case { pose: linear, numbers: numbers.clone() }.differentiate(1e-10);
    assert!(
        matches!(found.derivatives[0], Err(NoDerivative::Rests { contact: 0, time_s }) if time_s > 0.0),
        "{:?}",
        found.derivatives
    );
    assert!(found.derivatives[1..].iter().all(Result::is_ok), "{:?}", found.derivatives);
    // the force of Hertz's law is zero to first order on both sides
    let hertz: Pose = |numbers| resting(Hertz::new(numbers[2]).unwrap().into(), numbers);
    let found = Case { pose: hertz, numbers }.differentiate(1e-10);
    assert!(found.derivatives.iter().all(Result::is_ok), "{:?}", found.derivatives);
}

/// With another gap between them they may touch later, or press on each other immediately.
#[test]
fn balls_that_touch_without_speed_have_no_derivative_by_their_gap() {
    let (assembly, end_s) = cradle(&[0.1, 1.0, 1e9]);
    let offsets = STEPS.map(|place| 1e-9 * place);
    let near = offsets.map(|gap_m| {
        let mut near = cradle(&[0.1, 1.0, 1e9]).0;
        near.contacts[1].gap_m += gap_m;
        near
    });
    let faster = offsets.map(|by| cradle(&[0.1, 1.0 + by, 1e9]).0);
    let parameters = [&near, &faster].map(|near| Parameter {
        offsets,
        neighbours: near.each_ref(),
        end_s: [end_s; 4],
        changes_laws: false,
    });
    let found = Solver::new(&assembly).unwrap().differentiate(&Settings::until(end_s), &parameters).unwrap();
    assert!(matches!(found.derivatives[0], Err(NoDerivative::Graze { contact: 1, .. })), "{:?}", found.derivatives);
    // the others have them: with Hertz's law all velocities are proportional to the first
    let by_speed = found.derivatives[1].as_ref().unwrap().contacts[0].velocity_m_s[0];
    let velocity = found.run.contacts[0].velocity_m_s[0];
    assert!((by_speed.value - velocity).abs() < 1e-6 * velocity.abs(), "{by_speed:?} {velocity}");
}

/// A ball that falls on dissipative ground from a small height bounces; from a smaller one it stays in contact, and nearly leaves it.
#[test]
fn a_contact_that_nearly_opens_is_a_near_graze() {
    let pose = |height: f64| {
        let weight = Load { body: 0, shape: vec![0.1f64.sqrt()], force: Force::Constant { force_n: -9.81 } };
        let law = Law::from(HuntCrossley::new(1e8, 1.5, 10.0).unwrap());
        let contacts = vec![Contact { sides: [of_mass(0, 0.1), Point::Ground], gap_m: 0.0, law }];
        Assembly { bodies: vec![Body::mass(0.1, height, 0.0)], contacts, loads: vec![weight] }
    };
    let at = |height: f64| {
        let step = 1e-5 * height;
        let offsets = STEPS.map(|place| place * step);
        let near = offsets.map(|by| pose(height + by));
        let parameter = Parameter { offsets, neighbours: near.each_ref(), end_s: [0.02; 4], changes_laws: false };
        let assembly = pose(height);
        Solver::new(&assembly).unwrap().differentiate(&Settings::until(0.02), &[parameter]).unwrap()
    };
    let (mut stays, mut bounces) = (1e-9, 1e-5);
    for _ in 0..40 {
        let middle = 0.5 * (stays + bounces);
        *(if at(middle).intervals[0].len() == 1 { &mut stays } else { &mut bounces }) = middle;
    }
    let [stays, bounces] = [stays, bounces].map(at);
    assert!(bounces.nearest_graze < 1e-3 && bounces.intervals[0].len() > 1, "{}", bounces.nearest_graze);
    let miss = stays.nearest_miss.unwrap();
    assert!(stays.nearest_graze < 1e-3 && miss.was_closed && miss.distance_m < 1e-9, "{miss:?}");
}
