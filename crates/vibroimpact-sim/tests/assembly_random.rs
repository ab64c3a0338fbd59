//! Random assemblies: every run reaches its end, its intervals of contact have a length, and its energy is balanced.

use crate::common::Intervals;
use crate::common::random::{config, decades};
use contact_models::{Hertz, HuntCrossley, KelvinVoigt, Law, LinearSpring};
use proptest::collection::vec;
use proptest::prelude::*;
use vibroimpact_sim::assembly::{Assembly, Body, BodyMode, Contact, Force, Load, Outcome, Point, Settings, run};

const END_S: f64 = 0.05;
/// Points of a body at which contacts and loads may act.
const POINTS: usize = 3;

/// A body, and its shapes at its points.
fn any_body() -> impl Strategy<Value = (Body, Vec<Vec<f64>>)> {
    let damping = || prop_oneof![Just(0.0), decades(-3.0, 0.5)];
    let mode = (prop_oneof![1 => Just(0.0), 6 => decades(1.5, 4.0)], damping(), -0.3..0.3f64);
    let elastic = vec((mode, [-3.0..3.0f64, -3.0..3.0, -3.0..3.0]), 1..6).prop_map(|modes| {
        let of = |(omega_rad_s, damping_ratio): (f64, f64)| BodyMode {
            omega_rad_s,
            damping_ratio: if omega_rad_s == 0.0 { 0.0 } else { damping_ratio },
        };
        let body = Body {
            modes: modes.iter().map(|((omega, damping, _), _)| of((*omega, *damping))).collect(),
            amplitude: vec![0.0; modes.len()],
            rate: modes.iter().map(|((_, _, rate), _)| *rate).collect(),
        };
        (body, (0..POINTS).map(|point| modes.iter().map(|(_, shapes)| shapes[point]).collect()).collect())
    });
    let compact = (decades(-2.0, 0.0), -1.0..1.0f64)
        .prop_map(|(mass_kg, speed)| (Body::mass(mass_kg, 0.0, speed), vec![vec![mass_kg.sqrt().recip()]; POINTS]));
    prop_oneof![1 => compact, 2 => elastic]
}

fn any_law() -> impl Strategy<Value = Law> {
    let stiffness = || decades(5.0, 8.0);
    prop_oneof![
        stiffness().prop_map(|k| Hertz::new(k).unwrap().into()),
        decades(3.0, 6.0).prop_map(|k| LinearSpring::new(k).unwrap().into()),
        (decades(3.0, 6.0), decades(-1.0, 2.0)).prop_map(|(k, c)| KelvinVoigt::new(k, c).unwrap().into()),
        (stiffness(), decades(-2.0, 0.5)).prop_map(|(k, d)| HuntCrossley::new(k, 1.5, d).unwrap().into()),
    ]
}

fn any_force() -> impl Strategy<Value = Force> {
    let newtons = || -30.0..30.0f64;
    prop_oneof![
        newtons().prop_map(|force_n| Force::Constant { force_n }),
        (newtons(), decades(1.5, 3.5), -3.0..3.0f64).prop_map(|(force_n, omega_rad_s, phase_rad)| Force::Harmonic {
            force_n,
            omega_rad_s,
            phase_rad
        }),
        vec((0.0..END_S, newtons()), 2..6).prop_map(|mut samples| {
            samples.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (times_s, forces_n) = samples.into_iter().unzip();
            Force::Sampled { times_s, forces_n }
        }),
    ]
}

/// Up to three bodies, with contacts between them and with the ground that may begin closed, in play or without any.
fn any_assembly() -> impl Strategy<Value = Assembly<Law>> {
    let place = || (any::<prop::sample::Index>(), 0..POINTS);
    let gap = prop_oneof![Just(0.0), decades(-6.0, -2.0)];
    let contact = (place(), prop_oneof![Just(None), place().prop_map(Some)], any::<bool>(), gap, any_law());
    (vec(any_body(), 1..4), vec(contact, 1..5), vec((place(), any_force()), 0..4)).prop_map(
        |(bodies, contacts, loads)| {
            let at = |(body, point): (prop::sample::Index, usize)| {
                let body = body.index(bodies.len());
                (body, bodies[body].1[point].clone())
            };
            let side = |place: Option<(prop::sample::Index, usize)>, other: Option<usize>| {
                let found = place.map(at).filter(|(body, _)| Some(*body) != other);
                found.map_or(Point::Ground, |(body, shape)| Point::OfBody { body, shape })
            };
            let contacts = contacts.into_iter().map(|(first, second, reversed, gap_m, law)| {
                let mut sides = [side(Some(first), None), side(second, Some(at(first).0))];
                if reversed {
                    sides.reverse();
                }
                Contact { sides, gap_m, law }
            });
            let loads = loads.into_iter().map(|(place, force)| {
                let (body, shape) = at(place);
                Load { body, shape, force }
            });
            let (contacts, loads) = (contacts.collect(), loads.collect());
            Assembly { bodies: bodies.into_iter().map(|(body, _)| body).collect(), contacts, loads }
        },
    )
}

proptest! {
    #![proptest_config(config(400))]

    #[test]
    fn every_run_ends_and_balances_its_energy(assembly in any_assembly()) {
        let mut settings = Settings::until(END_S);
        settings.tolerance = 1e-9;
        settings.max_steps = 100_000;
        let mut seen = Intervals::default();
        let run = run(&assembly, &settings, &mut seen);
        // a load at the frequency of an undamped mode is refused
        prop_assume!(run.is_ok());
        let run = run.unwrap();
        prop_assert!(!matches!(run.outcome, Outcome::Stopped(_)), "{:?}", run.outcome);
        for (_, interval) in &seen.0 {
            prop_assert!(interval.end_s.is_none_or(|end_s| end_s > interval.start_s), "{interval:?}");
        }
        let ledger = run.energy.unwrap();
        let at_start: f64 = assembly.bodies.iter().flat_map(|body| &body.rate).map(|rate| 0.5 * rate * rate).sum();
        let compression: f64 = run.contacts.iter().map(|contact| contact.statistics.compression_work_j).sum();
        let work = compression + ledger.load_work_j.abs() + at_start;
        prop_assert!(ledger.unaccounted_j.abs() <= 1e-10 * work + 10.0 * ledger.rounding_j, "{ledger:?}");
    }
}
