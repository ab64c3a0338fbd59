//! Dropped rods compared with counts, masses and wave solutions that are known exactly.

use beam_modes::{Rod, RodEnd, RodSegment, remainder_modes};
use contact_models::{Hertz, LinearSpring};
use std::f64::consts::{FRAC_PI_2, PI};
use vibroimpact_sim::dropped_rod::DroppedRod;
use vibroimpact_sim::modal::{Outcome, Settings, Solution, Solver, Start, Striker, Structure};

fn rod(length_m: f64, inclination_rad: f64) -> DroppedRod {
    DroppedRod {
        length_m,
        diameter_m: 0.0127,
        youngs_modulus_pa: 2.1e11,
        density_kg_m3: 7876.74,
        poissons_ratio: 0.3,
        inclination_rad,
        bending_modes: 40,
        axial_modes: 40,
        damping_ratio: 0.0,
    }
}

fn solve(rod: &DroppedRod, tolerance: f64) -> Solution {
    let drop = rod.drop(1.0).unwrap();
    let settings = Settings { tolerance, ..Settings::default() };
    Solver::new(&drop.structure).unwrap().solve(&drop.surface, &drop.law, Some(&drop.start), &settings).unwrap()
}

#[test]
fn bending_modes_below_the_first_axial_one_are_the_thesiss() {
    for (length, count) in [(0.6, 7), (0.4, 5), (0.3, 4), (0.2, 3), (0.1, 2)] {
        assert_eq!(rod(length, 0.5).bending_modes_below_first_axial().unwrap(), count);
    }
}

#[test]
fn rigid_body_motions_have_the_thesiss_mass() {
    let rod = rod(0.4, 0.6);
    let modes = rod.drop(1.0).unwrap().structure.modes;
    let inverse: f64 = modes[..2].iter().map(|mode| mode.shape.powi(2)).sum();
    assert!((inverse * rod.rigid_body_mass_kg() - 1.0).abs() < 1e-14);
}

#[test]
fn an_upright_rod_rebounds_fully_on_a_soft_contact() {
    // Exact wave solution: the restitution is 1 on a rigid surface without local compliance, and in the rigid limit of a soft
    // contact; in between the wave keeps a little energy. Bending must not be excited at all.
    let upright = rod(0.2, FRAC_PI_2);
    let solution = solve(&upright, 1e-9);
    assert_eq!(solution.outcome, Outcome::Rebound);
    assert!(solution.amplitude[2..42].iter().all(|a| a.abs() < 1e-18));
    let mut previous = 0.0;
    for stiffness in [1e11, 1e9, 1e7, 1e5] {
        let mut drop = upright.drop(1.0).unwrap();
        drop.law = Hertz::new(stiffness).unwrap();
        let settings = Settings { tolerance: 1e-9, ..Settings::default() };
        let solver = Solver::new(&drop.structure).unwrap();
        let e = solver.solve(&drop.surface, &drop.law, Some(&drop.start), &settings).unwrap().restitution.unwrap();
        assert!(e <= 1.0 + 1e-9);
        if stiffness < 1e9 {
            assert!(e >= previous, "{stiffness:e}: {e} after {previous}");
        }
        previous = e;
    }
    assert!(previous > 1.0 - 1e-6, "{previous}");
}

#[test]
fn a_tilted_rod_keeps_vibration_and_gains_no_energy() {
    for degrees in [0.0f64, 20.0, 45.0, 70.0, 89.0] {
        let rod = rod(0.3, degrees.to_radians());
        let drop = rod.drop(1.0).unwrap();
        let solver = Solver::new(&drop.structure).unwrap();
        let settings = Settings { tolerance: 1e-10, ..Settings::default() };
        let (solution, history) = solver.record(&drop.surface, &drop.law, Some(&drop.start), &settings).unwrap();
        assert_eq!(solution.outcome, Outcome::Rebound, "{degrees}");
        assert!(solution.restitution.unwrap().abs() < 1.0, "{degrees}");
        let energy = history.energy_ledger();
        assert!((energy.initial_j - 0.5 * rod.mass_kg()).abs() < 1e-14);
        assert!(energy.residual_j.abs() < 1e-10 * energy.initial_j, "{degrees}: {:e}", energy.residual_j);
    }
}

#[test]
fn the_sdnl111_benchmark_is_reproduced() {
    // A free rod and a fixed one, in their own axial modes, with nearly rigid contact between them.
    let segment = RodSegment { length_m: 1.0, axial_rigidity_n: 2e11 * 4e-4, mass_per_length_kg_m: 7800.0 * 4e-4 };
    let modes_each = 400;
    let (mut modes, mut tail, mut rest) = (vec![], vec![], 0.0);
    for ends in [[RodEnd::Free, RodEnd::Free], [RodEnd::Free, RodEnd::Fixed]] {
        let rod = Rod { segments: vec![segment], ends };
        let found = rod.modes(2 * modes_each).unwrap();
        rest += rod.static_compliance(0.0).unwrap();
        for (k, mode) in found.seen_from(0.0).unwrap().into_iter().enumerate() {
            if mode.omega_rad_s > 0.0 {
                rest -= (mode.shape / mode.omega_rad_s).powi(2);
            }
            (if k < modes_each { &mut modes } else { &mut tail }).push(mode);
        }
    }
    modes.extend(remainder_modes(&tail, rest.max(0.0), 4).unwrap());
    let mut start = Start::at_rest(modes.len());
    start.rate[0] = 1.0 / modes[0].shape;
    let first_shapes: Vec<f64> = modes[..modes_each].iter().map(|mode| mode.shape).collect();
    let structure = Structure::from_modes(modes, 0.0);
    let none = Striker { mass_kg: f64::INFINITY, speed_m_s: 0.0 };
    let law = LinearSpring::new(1e12).unwrap();
    let settings = Settings { tolerance: 1e-6, ..Settings::default() };
    let solver = Solver::new(&structure).unwrap();
    let (solution, history) = solver.record(&none, &law, Some(&start), &settings).unwrap();
    for line in include_str!("data/sdnl111_two_rods_axial.csv").lines().skip(1) {
        let (time, exact) = line.split_once(',').unwrap();
        let (time, exact): (f64, f64) = (time.parse().unwrap(), exact.parse().unwrap());
        let amplitudes = history.amplitudes(time);
        let displacement: f64 = -first_shapes.iter().zip(&amplitudes).map(|(shape, a)| shape * a).sum::<f64>();
        assert!((displacement - exact).abs() < 1e-6, "{time}: {displacement:e} against {exact:e}");
    }
    let wave_s = 4.0 * (7800.0f64 / 2e11).sqrt();
    let last = solution.sub_impacts.last().unwrap().end_s;
    assert!((last / wave_s - 1.0).abs() < 0.02, "{last:e} against {wave_s:e}");
    assert!((solution.restitution.unwrap() - 1.0).abs() < 0.01);
}

/// Lying, upright, and as close to either as numbers allow; without elastic modes.
#[test]
fn limiting_cases_of_rods() {
    let usual = rod(0.4, 0.8);
    let rods = [
        ("lying", DroppedRod { inclination_rad: 0.0, ..usual }),
        ("almost lying", DroppedRod { inclination_rad: 1e-12, ..usual }),
        ("upright", DroppedRod { inclination_rad: FRAC_PI_2, ..usual }),
        ("almost upright", DroppedRod { inclination_rad: FRAC_PI_2 - 1e-12, ..usual }),
        ("rigid but for its residual compliance", DroppedRod { bending_modes: 0, axial_modes: 0, ..usual }),
        ("bending alone", DroppedRod { axial_modes: 0, ..usual }),
    ];
    for (name, rod) in rods {
        let solution = solve(&rod, 1e-9);
        assert_eq!(solution.outcome, Outcome::Rebound, "{name}");
        let (e, stated) = (solution.restitution.unwrap(), solution.restitution_uncertainty.unwrap());
        assert!((-1.0..=1.0 + 1e-9).contains(&e) && stated < 1e-3, "{name}: {e} +- {stated:e}");
    }
    // An angle that is a right angle to rounding changes nothing.
    for (angle, aside) in [(0.0, 1e-12), (FRAC_PI_2, -1e-12)] {
        let (a, b) = (solve(&rod(0.4, angle), 1e-9), solve(&rod(0.4, angle + aside), 1e-9));
        let stated = a.restitution_uncertainty.unwrap() + b.restitution_uncertainty.unwrap();
        assert!((a.restitution.unwrap() - b.restitution.unwrap()).abs() <= stated, "at {angle}");
    }
}

#[test]
fn bad_rods_are_refused() {
    let good = rod(0.4, 0.6);
    for (bad, field) in [
        (DroppedRod { length_m: 0.0, ..good }, "length_m"),
        (DroppedRod { diameter_m: f64::NAN, ..good }, "diameter_m"),
        (DroppedRod { inclination_rad: PI, ..good }, "inclination_rad"),
        (DroppedRod { axial_modes: 1_000_000, ..good }, "axial_modes"),
    ] {
        assert_eq!(bad.drop(1.0).unwrap_err().field, field);
    }
    assert_eq!(good.drop(-1.0).unwrap_err().field, "speed_m_s");
}
