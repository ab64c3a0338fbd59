//! The energy ledger of assemblies: each part compared with another way to compute it.

use beam_modes::{Beam, End, RectangularSegment, Segment};
use contact_models::{Hertz, Hysteretic, KelvinVoigt, Law, LinearSpring, Viscous};
use gauss_quad::GaussLegendre;
use std::f64::consts::{FRAC_PI_2, PI};
use vibroimpact_sim::assembly::{
    Assembly, Body, BodyMode, Contact, Force, Ledger, Load, Motion, Observer, Point, Run, Settings, run,
};
use vibroimpact_sim::modal;

struct Wants;

impl Observer for Wants {
    fn wants_energy(&self) -> bool {
        true
    }
}

fn settings(end_s: f64, tolerance: f64) -> Settings {
    let mut settings = Settings::until(end_s);
    settings.tolerance = tolerance;
    settings
}

fn solve(assembly: &Assembly<Law>, end_s: f64, tolerance: f64) -> (Run, Ledger) {
    let mut run = run(assembly, &settings(end_s, tolerance), &mut Wants).unwrap();
    let ledger = run.energy.take().unwrap();
    (run, ledger)
}

fn point(body: usize, shape: &[f64]) -> Point {
    Point::OfBody { body, shape: shape.to_vec() }
}

fn mass(body: usize, mass_kg: f64) -> Point {
    point(body, &[mass_kg.sqrt().recip()])
}

/// A clamped-free beam at some locations.
fn cantilever(n: usize, damping_ratio: f64, places: &[f64]) -> (Vec<BodyMode>, Vec<Vec<f64>>) {
    let segment = Segment::from(RectangularSegment {
        length_m: 1.0,
        youngs_modulus_pa: 2e11,
        density_kg_m3: 7800.0,
        width_m: 0.02,
        thickness_m: 0.01,
    });
    let beam = Beam { segments: vec![segment], ends: [End::Clamped, End::Free] };
    let modes = beam.modes(n).unwrap();
    let of = |omega: &f64| BodyMode { omega_rad_s: *omega, damping_ratio };
    let shapes = places.iter().map(|x| modes.shapes_at(*x).unwrap()).collect();
    (modes.omega_rad_s().iter().map(of).collect(), shapes)
}

/// Hertz contact with a wall takes all kinetic energy before the compression turns, also where this is on the panel on which the
/// force begins.
#[test]
fn a_wall_takes_all_energy_by_work_of_compression() {
    for tolerance in [1e-5, 1e-7, 1e-9, 1e-11] {
        for share in [0.3, 0.5, 0.7, 0.9] {
            let law = Hertz::new(1e9 * 2_f64.powf(-2.5 * share)).unwrap().into();
            let contacts = vec![Contact { sides: [mass(0, 0.1), Point::Ground], gap_m: 0.0, law }];
            let bodies = vec![Body::mass(0.1, 1e-3, -1.0)];
            let (found, _) = solve(&Assembly { bodies, contacts, loads: vec![] }, 0.01, tolerance);
            let error = (compression_work(&found) / 0.05 - 1.0).abs();
            assert!(error < 1e-2 * tolerance, "{tolerance:e} {share}: {error:e}");
        }
    }
}

/// A ball on a cantilever, whose tip meets a stop and another cantilever.
fn three_contacts(damping_ratio: f64, loads: impl Fn(&[Vec<f64>]) -> Vec<Load>) -> Assembly<Law> {
    let (modes, shapes) = cantilever(6, damping_ratio, &[0.5, 1.0, 0.8]);
    let contacts = vec![
        Contact { sides: [mass(1, 0.2), point(0, &shapes[0])], gap_m: 0.0, law: Hertz::new(1e8).unwrap().into() },
        Contact {
            sides: [point(0, &shapes[1]), Point::Ground],
            gap_m: 1e-3,
            law: LinearSpring::new(1e5).unwrap().into(),
        },
        Contact {
            sides: [point(2, &shapes[1]), point(0, &shapes[2])],
            gap_m: 5e-4,
            law: LinearSpring::new(2e5).unwrap().into(),
        },
    ];
    let bodies = vec![Body::at_rest(modes.clone()), Body::mass(0.2, 0.0, -1.0), Body::at_rest(modes)];
    Assembly { bodies, contacts, loads: loads(&shapes) }
}

fn weight() -> Load {
    Load { body: 1, shape: vec![0.2f64.sqrt()], force: Force::Constant { force_n: -9.81 } }
}

/// Loads of one kind, on the ball and on a cantilever.
fn loads(kind: &str, shapes: &[Vec<f64>]) -> Vec<Load> {
    let ball = vec![0.2f64.sqrt().recip()];
    let force = |scale: f64| match kind {
        "constant" => vec![Force::Constant { force_n: -40.0 * scale }],
        "harmonic" => vec![
            Force::Harmonic { force_n: 30.0 * scale, omega_rad_s: 700.0, phase_rad: 0.4 },
            Force::Harmonic { force_n: 10.0 * scale, omega_rad_s: 35.0, phase_rad: -1.0 },
        ],
        _ => {
            let (times_s, forces) = (vec![0.002, 0.004, 0.004, 0.011], [0.0, -80.0, 50.0, 0.0]);
            vec![Force::Sampled { times_s, forces_n: forces.map(|force| force * scale).to_vec() }]
        }
    };
    let on = |body: usize, shape: &[f64], scale: f64| {
        force(scale).into_iter().map(move |force| Load { body, shape: shape.to_vec(), force }).collect::<Vec<_>>()
    };
    [on(0, &shapes[1], 1.0), on(1, &ball, 0.1), on(2, &shapes[0], -0.7)].concat()
}

fn of_kinds(kinds: &[&str], damping_ratio: f64) -> Assembly<Law> {
    three_contacts(damping_ratio, |shapes| {
        kinds.iter().flat_map(|kind| loads(kind, shapes)).chain([weight()]).collect()
    })
}

const KINDS: [&[&str]; 5] = [&[], &["constant"], &["harmonic"], &["sampled"], &["constant", "harmonic", "sampled"]];

/// Work on the contacts while they were compressed (J).
fn compression_work(run: &Run) -> f64 {
    run.contacts.iter().map(|contact| contact.statistics.compression_work_j).sum()
}

#[test]
fn energy_is_conserved_without_damping() {
    for kinds in KINDS {
        let (found, ledger) = solve(&of_kinds(kinds, 0.0), 0.03, 1e-12);
        let floor = 1e-11 * compression_work(&found);
        assert_eq!(ledger.modal_damping_j, 0.0);
        assert!(ledger.contact_loss_j.abs() < floor, "{kinds:?}: {ledger:?}");
        assert!(ledger.unaccounted_j.abs() < floor, "{kinds:?}: {ledger:?}");
    }
}

/// Energy of the motion relative to the straight line on which a sampled load holds each mode (J). This is the propagated
/// energy, and far more than that of the motion if the load changes within a small part of a slow mode's period.
fn carried_energy(assembly: &Assembly<Law>) -> f64 {
    let of = |load: &Load| {
        let Force::Sampled { times_s, forces_n } = &load.force else { return 0.0 };
        let steepest = (1..times_s.len())
            .filter(|&i| times_s[i] > times_s[i - 1])
            .map(|i| ((forces_n[i] - forces_n[i - 1]) / (times_s[i] - times_s[i - 1])).abs())
            .fold(0.0, f64::max);
        let modes = assembly.bodies[load.body].modes.iter().zip(&load.shape);
        let of = |(mode, shape): (&BodyMode, &f64)| {
            let rate = steepest * shape / mode.omega_rad_s.powi(2);
            0.5 * rate * rate * (1.0 + (2.0 * mode.damping_ratio).powi(2))
        };
        modes.filter(|(mode, _)| mode.omega_rad_s > 0.0).map(of).sum()
    };
    assembly.loads.iter().map(of).sum()
}

#[test]
fn damping_loads_and_contacts_account_for_all_energy() {
    for kinds in KINDS {
        for damping_ratio in [0.001, 0.02, 0.3, 1.0, 1.4] {
            let assembly = of_kinds(kinds, damping_ratio);
            let (found, ledger) = solve(&assembly, 0.03, 1e-12);
            let floor = 1e-11 * compression_work(&found) + 8.0 * f64::EPSILON * carried_energy(&assembly);
            assert!(ledger.modal_damping_j > 1e-3, "{kinds:?} {damping_ratio}: {ledger:?}");
            assert!(ledger.unaccounted_j.abs() < floor, "{kinds:?} {damping_ratio}: {floor:e} {ledger:?}");
        }
    }
}

/// Damping, load work and contact work by fine quadrature of the motion.
struct Quadrature<'a> {
    assembly: &'a Assembly<Law>,
    rule: GaussLegendre,
    damping_ratio: f64,
    fastest_rad_s: f64,
    damping_j: f64,
    load_work_j: f64,
    contact_work_j: f64,
}

fn force_at(force: &Force, t: f64) -> f64 {
    match force {
        Force::Constant { force_n } => *force_n,
        Force::Harmonic { force_n, omega_rad_s, phase_rad } => force_n * (omega_rad_s * t + phase_rad).sin(),
        Force::Sampled { times_s, forces_n } => {
            let after = times_s.partition_point(|time| *time <= t);
            if after == 0 || after == times_s.len() {
                return 0.0;
            }
            let part = (t - times_s[after - 1]) / (times_s[after] - times_s[after - 1]);
            forces_n[after - 1] + part * (forces_n[after] - forces_n[after - 1])
        }
        _ => 0.0,
    }
}

impl Observer for Quadrature<'_> {
    fn wants_panels(&self) -> bool {
        true
    }

    fn panel(&mut self, panel: &dyn Motion) {
        let (start, length) = (panel.start_s(), panel.end_s() - panel.start_s());
        let parts = (FRAC_PI_2 * self.fastest_rad_s * length).ceil().max(1.0);
        for part in 0..parts as usize {
            for (x, w) in self.rule.iter() {
                // a force that begins or ends as `t^(3/2)` is a smooth function of this angle
                let angle = FRAC_PI_2 * (part as f64 + 0.5 + 0.5 * x) / parts;
                let time = start + length * angle.sin().powi(2);
                let weight = 0.5 * w * length / parts * FRAC_PI_2 * (2.0 * angle).sin();
                let (_, rate) = panel.modes(time);
                let mut rates = rate.iter();
                for (i, body) in self.assembly.bodies.iter().enumerate() {
                    let rates: Vec<f64> = rates.by_ref().take(body.modes.len()).copied().collect();
                    for (mode, rate) in body.modes.iter().zip(&rates) {
                        self.damping_j += weight * 2.0 * self.damping_ratio * mode.omega_rad_s * rate * rate;
                    }
                    for load in self.assembly.loads.iter().filter(|load| load.body == i) {
                        let speed: f64 = load.shape.iter().zip(&rates).map(|(shape, rate)| shape * rate).sum();
                        self.load_work_j += weight * force_at(&load.force, time) * speed;
                    }
                }
                for contact in 0..self.assembly.contacts.len() {
                    let sample = panel.contact(contact, time);
                    self.contact_work_j += weight * sample.force_n * sample.rate_m_s;
                }
            }
        }
    }
}

#[test]
fn every_part_agrees_with_fine_quadrature_of_the_motion() {
    for kinds in KINDS {
        let assembly = of_kinds(kinds, 0.02);
        let fastest_rad_s = assembly.bodies[0].modes.iter().map(|mode| mode.omega_rad_s).fold(0.0, f64::max);
        let measure = |damping_ratio: f64| {
            let mut seen = Quadrature {
                assembly: &assembly,
                rule: GaussLegendre::new(12.try_into().unwrap()),
                damping_ratio,
                fastest_rad_s,
                damping_j: 0.0,
                load_work_j: 0.0,
                contact_work_j: 0.0,
            };
            run(&assembly, &settings(0.03, 1e-11), &mut seen).unwrap();
            seen
        };
        let (found, ledger) = solve(&assembly, 0.03, 1e-11);
        let work: f64 = found.contacts.iter().map(|contact| contact.statistics.work_j).sum();
        let seen = measure(0.02);
        let floor = 1e-10 * compression_work(&found);
        assert!((ledger.modal_damping_j - seen.damping_j).abs() < floor, "{kinds:?}: {:e} {ledger:?}", seen.damping_j);
        let load_work_j = seen.load_work_j;
        assert!((ledger.load_work_j - load_work_j).abs() < floor, "{kinds:?}: {load_work_j:e} {ledger:?}");
        // The force of the law, not its polynomial.
        assert!((work - seen.contact_work_j).abs() < 10.0 * floor, "{kinds:?}: {:e} {work:e}", seen.contact_work_j);
        // An error in the seventh digit of a ratio would be detected.
        let wrong = measure(0.02 * (1.0 + 1e-7));
        assert!((ledger.modal_damping_j - wrong.damping_j).abs() > floor, "{kinds:?}");
    }
}

/// Between rigid bodies the quadrature is exact, whatever the tolerance. Springs of very different stiffness, two of which close at
/// the same time, end Newton's method with compressions that lag behind the forces.
#[test]
fn rigid_bodies_between_springs_have_an_exact_balance_at_any_tolerance() {
    let spring = |stiffness: f64| Law::from(LinearSpring::new(stiffness).unwrap());
    let soft = Law::from(Hertz::new(2.716e6).unwrap());
    let contact = |above: bool, gap_m: f64, law: Law| {
        let sides = if above { [Point::Ground, mass(0, 1.14)] } else { [mass(0, 1.14), Point::Ground] };
        Contact { sides, gap_m, law }
    };
    let contacts = vec![
        contact(true, 1.0187e-6, spring(2.3164e8)),
        contact(false, 1.0177e-6, spring(7.2715e7)),
        contact(false, 1.0187e-6, soft),
    ];
    let force = Force::Sampled { times_s: vec![0.0, 0.013, 0.013], forces_n: vec![17.0, -500.0, 0.0] };
    let assembly = Assembly {
        bodies: vec![Body::mass(1.14, 0.0, 0.76)],
        contacts,
        loads: vec![Load { body: 0, shape: vec![1.14f64.sqrt().recip()], force }],
    };
    for tolerance in [1e-3, 1e-4, 1e-6, 1e-9] {
        let (found, ledger) = solve(&assembly, 0.03, tolerance);
        assert!(found.contacts.iter().all(|contact| contact.statistics.intervals > 40), "{tolerance:e}");
        let work = compression_work(&found);
        assert!(ledger.unaccounted_j.abs() < 1e-11 * work, "{tolerance:e}: {work:e} {ledger:?}");
        // springs lose nothing
        assert!(ledger.contact_loss_j.abs() < tolerance * work, "{tolerance:e}: {work:e} {ledger:?}");
    }
}

#[test]
fn a_contact_loses_what_a_wall_does_not_return() {
    let (mass_kg, speed_m_s) = (0.1, 0.7);
    let laws: [Law; 4] = [
        Hertz::new(1e9).unwrap().into(),
        Viscous::with_restitution(1e9, 0.8, speed_m_s).unwrap().into(),
        KelvinVoigt::new(1e6, 40.0).unwrap().into(),
        Hysteretic { stiffness_n_m1_5: 2.5e8, theta_m: 2.5, beta: 0.5, k_bar: 4.0, epsilon_m: 0.0 }
            .validated()
            .unwrap()
            .into(),
    ];
    for law in laws {
        let restitution = law.wall_restitution(mass_kg, speed_m_s).unwrap();
        let contacts = vec![Contact { sides: [mass(0, mass_kg), Point::Ground], gap_m: 0.0, law }];
        let bodies = vec![Body::mass(mass_kg, 1e-4, -speed_m_s)];
        let (found, ledger) = solve(&Assembly { bodies, contacts, loads: vec![] }, 0.01, 1e-11);
        assert_eq!(found.contacts[0].statistics.intervals, 1);
        let before = 0.5 * mass_kg * speed_m_s * speed_m_s;
        let lost = before * (1.0 - restitution * restitution);
        assert!((ledger.contact_loss_j - lost).abs() < 1e-9 * before, "{law:?}: {lost:e} {ledger:?}");
        assert!(ledger.unaccounted_j.abs() < 1e-11 * before, "{law:?}: {ledger:?}");
        assert!((ledger.bodies_j[0][0] - before).abs() < 1e-15 && ledger.stored_j == [0.0, 0.0]);
    }
}

#[test]
fn an_interference_returns_its_stored_energy() {
    let (stiffness, overlap, mass_kg) = (1e6, 1e-4, 0.3);
    let law = LinearSpring::new(stiffness).unwrap().into();
    let contacts = vec![Contact { sides: [mass(0, mass_kg), mass(1, mass_kg)], gap_m: -overlap, law }];
    let pair = Assembly {
        bodies: vec![Body::mass(mass_kg, 0.0, 0.0), Body::mass(mass_kg, 0.0, 0.0)],
        contacts,
        loads: vec![],
    };
    let stored = 0.5 * stiffness * overlap * overlap;
    // In the middle of the expansion, and long after.
    let quarter = 0.5 * PI / (2.0 * stiffness / mass_kg).sqrt();
    for (end_s, left) in [(0.5 * quarter, 0.5 * stored), (10.0 * quarter, 0.0)] {
        let (_, ledger) = solve(&pair, end_s, 1e-11);
        assert!((ledger.stored_j[0] / stored - 1.0).abs() < 1e-14);
        assert!((ledger.stored_j[1] - left).abs() < 1e-10 * stored, "{ledger:?}");
        assert!((ledger.bodies_j.iter().map(|body| body[1]).sum::<f64>() - (stored - left)).abs() < 1e-10 * stored);
        assert!(ledger.contact_loss_j.abs() < 1e-10 * stored && ledger.unaccounted_j.abs() < 1e-11 * stored);
    }
}

/// The ball of thesis chapter 3 on its pinned beam, at the golden section.
fn chapter_3(n: usize, damping_ratio: f64, law: Law) -> (Assembly<Law>, Vec<modal::Mode>) {
    let (side, length) = (0.011323f64, 1.0);
    let mass_kg = 7800.0 * side * side;
    let rigidity = 2e11 * side.powi(4) / 12.0;
    let mode = |k: usize| {
        let wave = k as f64 * PI / length;
        modal::Mode {
            omega_rad_s: wave * wave * (rigidity / mass_kg).sqrt(),
            damping_ratio,
            shape: (2.0 / mass_kg).sqrt() * (wave * 0.6180339887498949).sin(),
        }
    };
    let modes: Vec<modal::Mode> = (1..=n).map(mode).collect();
    let of = |mode: &modal::Mode| BodyMode { omega_rad_s: mode.omega_rad_s, damping_ratio };
    let beam = Body::at_rest(modes.iter().map(of).collect());
    let place = Point::OfBody { body: 1, shape: modes.iter().map(|mode| mode.shape).collect() };
    let contacts = vec![Contact { sides: [mass(0, 0.1103), place], gap_m: 0.0, law }];
    (Assembly { bodies: vec![Body::mass(0.1103, 0.0, -1.0), beam], contacts, loads: vec![] }, modes)
}

#[test]
fn one_impact_has_the_ledger_of_the_solver_of_impacts() {
    let law: Law = Viscous::with_restitution(1.7945e10, 0.95, 1.0).unwrap().into();
    for (n, damping_ratio) in [(5, 0.02), (40, 0.02), (40, 0.6), (40, 1.1)] {
        let (assembly, modes) = chapter_3(n, damping_ratio, law);
        let solver = modal::Solver::new(&modal::Structure { modes }).unwrap();
        let striker = modal::Striker { mass_kg: 0.1103, speed_m_s: 1.0 };
        let wanted = modal::Settings { tolerance: 1e-10, estimate_uncertainty: false, ..Default::default() };
        let (solution, history) = solver.record(&striker, &law, None, &wanted).unwrap();
        let known = history.energy_ledger();
        let (_, ledger) = solve(&assembly, solution.end_s, 1e-10);
        let floor = 1e-12 * known.initial_j;
        assert!((ledger.modal_damping_j - known.modal_damping_j).abs() < floor, "{n} {damping_ratio}: {ledger:?}");
        assert!((ledger.contact_loss_j - known.contact_j).abs() < floor, "{n} {damping_ratio}: {ledger:?}");
        assert!((ledger.bodies_j[0][1] - known.striker_j).abs() < floor);
        assert!((ledger.bodies_j[1][1] - known.modes_j.iter().sum::<f64>()).abs() < floor);
        assert!(ledger.unaccounted_j.abs() < 1e-11 * known.initial_j, "{n} {damping_ratio}: {ledger:?}");
    }
}

#[test]
fn modes_that_oscillate_many_times_in_a_panel_are_accounted_for() {
    // A soft contact on a beam of many modes.
    for damping_ratio in [0.0, 0.005, 0.9] {
        let (assembly, _) = chapter_3(120, damping_ratio, LinearSpring::new(1e5).unwrap().into());
        for tolerance in [1e-2, 1e-4, 1e-6, 1e-9] {
            let (found, ledger) = solve(&assembly, 0.01, tolerance);
            let floor = 1e-13 * ledger.bodies_j[0][0];
            assert!(found.contacts[0].statistics.intervals > 0);
            assert!(ledger.unaccounted_j.abs() < floor, "{damping_ratio} {tolerance:e}: {ledger:?}");
        }
    }
}

/// Contacts that close together on one body, at tolerances that let its modes turn fast on a panel.
#[test]
fn contacts_of_one_body_have_an_exact_balance_at_any_tolerance() {
    for damping_ratio in [0.0, 0.02, 1.4] {
        let (modes, shapes) = cantilever(40, damping_ratio, &[0.7, 1.0, 0.8]);
        let contact = |sides: [Point; 2], stiffness: f64| Contact {
            sides,
            gap_m: 1e-4,
            law: LinearSpring::new(stiffness).unwrap().into(),
        };
        let assembly: Assembly<Law> = Assembly {
            bodies: vec![Body::at_rest(modes.clone()), Body::at_rest(modes)],
            contacts: vec![
                contact([point(0, &shapes[0]), Point::Ground], 1e6),
                contact([point(0, &shapes[1]), Point::Ground], 2e5),
                contact([point(1, &shapes[1]), point(0, &shapes[2])], 3e5),
            ],
            loads: vec![Load { body: 1, shape: shapes[1].clone(), force: Force::Constant { force_n: -40.0 } }],
        };
        for tolerance in [1e-2, 1e-4, 1e-6] {
            let (found, ledger) = solve(&assembly, 0.3, tolerance);
            assert!(found.contacts.iter().all(|contact| contact.statistics.intervals > 0), "{found:?}");
            let floor = 1e-13 * ledger.load_work_j.abs() + ledger.rounding_j;
            assert!(ledger.unaccounted_j.abs() < floor, "{damping_ratio} {tolerance:e}: {ledger:?}");
        }
    }
}

/// During a soft contact the sinusoid of a load turns far on a panel.
#[test]
fn fast_harmonic_loads_have_an_exact_balance_at_any_tolerance() {
    let (modes, shapes) = cantilever(3, 0.01, &[0.7, 1.0]);
    for (force_n, frequency_hz) in [(1.0, 500.0), (1.0, 2000.0), (1e-3, 5000.0)] {
        let (omega_rad_s, phase_rad) = (2.0 * PI * frequency_hz, 0.3);
        let force = Force::Harmonic { force_n, omega_rad_s, phase_rad };
        let spring = |stiffness: f64| Law::from(LinearSpring::new(stiffness).unwrap());
        let assembly = Assembly {
            bodies: vec![Body::mass(0.1, 0.0, -0.5), Body::at_rest(modes.clone())],
            contacts: vec![
                Contact { sides: [mass(0, 0.1), point(1, &shapes[0])], gap_m: 0.0, law: spring(1e3) },
                Contact { sides: [point(1, &shapes[1]), Point::Ground], gap_m: 1e-3, law: spring(2e3) },
            ],
            loads: vec![
                Load { body: 0, shape: vec![0.1f64.sqrt().recip()], force: force.clone() },
                Load { body: 1, shape: shapes[1].clone(), force },
            ],
        };
        for tolerance in [1e-2, 1e-3, 1e-6] {
            let (found, ledger) = solve(&assembly, 0.1, tolerance);
            let work = compression_work(&found);
            let floor = 1e-13 * work + ledger.rounding_j;
            assert!(work > 1e-3 && ledger.unaccounted_j.abs() < floor, "{frequency_hz} {tolerance:e}: {ledger:?}");
        }
    }
}

/// Near an undamped frequency the ledger is a small difference of large numbers. The loss of digits is stated, also if the
/// errors of two parts cancel; the motion has its full accuracy.
#[test]
fn rounding_is_stated_where_a_load_nearly_meets_an_undamped_frequency() {
    let (omega_rad_s, end_s) = (100.0, 1.0);
    for (detuning, damping_ratio) in [(1e-3, 0.0), (1e-5, 0.0), (1e-7, 0.0), (1e-8, 0.0), (1e-7, 1e-9), (1e-8, 1e-9)] {
        let harmonic = Force::Harmonic { force_n: 1.0, omega_rad_s: omega_rad_s * (1.0 + detuning), phase_rad: 0.0 };
        let assembly = Assembly {
            bodies: vec![Body::at_rest(vec![BodyMode { omega_rad_s, damping_ratio }])],
            contacts: vec![Contact {
                sides: [point(0, &[1.0]), Point::Ground],
                gap_m: 1.0,
                law: Law::from(LinearSpring::new(1e4).unwrap()),
            }],
            loads: vec![Load { body: 0, shape: vec![1.0], force: harmonic }],
        };
        let (found, ledger) = solve(&assembly, end_s, 1e-10);
        let [_, energy] = ledger.bodies_j[0];
        // The motion from rest at a frequency so close: `(sin(omega t) - omega t cos(omega t)) / (2 omega^2)`.
        if detuning < 1e-6 {
            let turned = omega_rad_s * end_s;
            let exact = (turned.sin() - turned * turned.cos()) / (2.0 * omega_rad_s * omega_rad_s);
            assert!((found.amplitude[0][0] - exact).abs() < 2.0 * detuning * turned * exact.abs(), "{found:?}");
        }
        // Such a small damping dissipates less than `2 zeta omega t` of twice the energy at the end.
        let damping = 4.0 * damping_ratio * omega_rad_s * end_s * energy;
        assert!(ledger.modal_damping_j.abs() <= damping + ledger.rounding_j, "{detuning}: {ledger:?}");
        let missing = (ledger.load_work_j - energy).abs();
        assert!(missing <= damping + ledger.rounding_j, "{detuning}: {missing:e} {ledger:?}");
        let visible = ledger.rounding_j > 1e-4 * energy;
        assert_eq!(visible, detuning < 1e-6, "{detuning}: {ledger:?}");
    }
}
