//! One striker, one contact: the assembly compared with the solver of single impacts.

use contact_models::{Hertz, KelvinVoigt, Law, LinearSpring, Viscous};
use std::f64::consts::PI;
use vibroimpact_sim::assembly::{Assembly, Body, BodyMode, Contact, Interval, Observer, Point, Settings, run};
use vibroimpact_sim::modal;

#[derive(Default)]
struct Intervals(Vec<Interval>);

impl Observer for Intervals {
    fn interval(&mut self, _: usize, interval: &Interval) {
        self.0.push(*interval);
    }
}

/// The pinned beam of thesis chapter 3 at the golden section.
fn beam(n: usize, damping_ratio: f64) -> Vec<modal::Mode> {
    let (side, length) = (0.011323f64, 1.0);
    let mass = 7800.0 * side * side;
    let rigidity = 2e11 * side.powi(4) / 12.0;
    let mode = |k: usize| {
        let wave = k as f64 * PI / length;
        modal::Mode {
            omega_rad_s: wave * wave * (rigidity / mass).sqrt(),
            damping_ratio,
            shape: (2.0 / mass).sqrt() * (wave * 0.6180339887498949).sin(),
        }
    };
    (1..=n).map(mode).collect()
}

fn assembly<L>(modes: &[modal::Mode], mass_kg: f64, speed_m_s: f64, law: L) -> Assembly<L> {
    let of = |mode: &modal::Mode| BodyMode { omega_rad_s: mode.omega_rad_s, damping_ratio: mode.damping_ratio };
    let structure = Body::at_rest(modes.iter().map(of).collect());
    let ball = Point::OfBody { body: 0, shape: vec![mass_kg.sqrt().recip()] };
    let place = Point::OfBody { body: 1, shape: modes.iter().map(|mode| mode.shape).collect() };
    Assembly {
        bodies: vec![Body::mass(mass_kg, 0.0, -speed_m_s), structure],
        contacts: vec![Contact { sides: [ball, place], gap_m: 0.0, law }],
        loads: vec![],
    }
}

#[test]
fn an_assembly_of_one_contact_is_the_impact() {
    let laws: [Law; 4] = [
        Hertz::new(1.7945e10).unwrap().into(),
        Viscous::with_restitution(1.7945e10, 0.95, 1.0).unwrap().into(),
        KelvinVoigt::new(1e8, 500.0).unwrap().into(),
        LinearSpring::new(1e8).unwrap().into(),
    ];
    for law in laws {
        for n in [5, 40] {
            let modes = beam(n, 0.02);
            let structure = modal::Structure { modes: modes.clone() };
            let solver = modal::Solver::new(&structure).unwrap();
            let striker = modal::Striker { mass_kg: 0.1103, speed_m_s: 1.0 };
            let settings = modal::Settings { estimate_uncertainty: false, ..Default::default() };
            let found = solver.solve(&striker, &law, None, &settings).unwrap();
            let mut seen = Intervals::default();
            let mut wanted = Settings::until(1.5 * found.end_s);
            wanted.tolerance = settings.tolerance;
            let run = run(&assembly(&modes, 0.1103, 1.0, law), &wanted, &mut seen).unwrap();
            assert_eq!(seen.0.len(), found.sub_impacts.len());
            for (one, other) in seen.0.iter().zip(&found.sub_impacts) {
                assert!((one.impulse_n_s - other.impulse_n_s).abs() < 1e-7, "{one:?} {other:?}");
                assert!((one.start_s - other.start_s).abs() < 1e-9);
                assert!((one.end_s.unwrap() - other.end_s).abs() < 1e-9);
                assert!((one.peak_force_n / other.peak_force_n - 1.0).abs() < 1e-4);
            }
            let velocity = run.contacts[0].velocity_m_s[0];
            assert!((velocity - found.striker_velocity_m_s).abs() < 1e-8, "{velocity}");
        }
    }
}
