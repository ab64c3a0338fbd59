//! What remainder modes bring: the restitution of the thesis's beam with few modes against the converged one.

mod common;
use beam_modes::{Beam, BeamSystem, End, PointMode, Segment, ShearSection, remainder_modes};
use common::{GOLDEN, pinned, settings, solve};
use contact_models::{Body, Hertz, Law};
use std::f64::consts::PI;
use vibroimpact_sim::modal::{Mode, Solver, Striker, Structure};

const DAMPING: f64 = 0.02;

fn restitution(structure: &Structure) -> f64 {
    solve(structure, 1e-10).restitution.unwrap()
}

/// `n` modes of the beam and `count` remainder modes of 3,000 more, damped as the last that is kept.
fn with_remainder(n: usize, count: usize) -> Structure {
    let all = pinned(n + 3000, DAMPING, GOLDEN);
    let tail: Vec<PointMode> =
        all.modes[n..].iter().map(|m| PointMode { omega_rad_s: m.omega_rad_s, shape: m.shape }).collect();
    let rigidity = 2e11 * 0.011323f64.powi(4) / 12.0;
    let whole = (GOLDEN * (1.0 - GOLDEN)).powi(2) / (3.0 * rigidity);
    let rest = whole - all.modes.iter().map(|mode| (mode.shape / mode.omega_rad_s).powi(2)).sum::<f64>();
    let mut structure = pinned(n, DAMPING, GOLDEN);
    let damped = |m: PointMode| Mode { omega_rad_s: m.omega_rad_s, damping_ratio: DAMPING, shape: m.shape };
    structure.modes.extend(remainder_modes(&tail, rest.max(0.0), count).unwrap().into_iter().map(damped));
    structure
}

/// Golden section, 3 cm ball: 64 modes alone are off by 2e-2, two remainder modes for the rest by 1e-5.
#[test]
fn two_remainder_modes_are_worth_a_thousand_modes() {
    let converged = restitution(&with_remainder(256, 3));
    let error = |structure: &Structure| (restitution(structure) - converged).abs();
    let alone = error(&pinned(64, DAMPING, GOLDEN));
    let [one, two, three] = [1, 2, 3].map(|count| error(&with_remainder(64, count)));
    println!("{converged}: {alone:e} {one:e} {two:e} {three:e}");
    assert!(alone > 5e-3, "{alone:e}");
    assert!((3e-5..2e-4).contains(&one), "{one:e}");
    assert!(two < 3e-5 && three < 5e-5, "{two:e} {three:e}");

    let [one, two, three] = [1, 2, 3].map(|count| error(&with_remainder(128, count)));
    println!("{one:e} {two:e} {three:e}");
    assert!(one < 1e-5 && two < 2e-6 && three < 1e-6);
}

/// The same beam by Timoshenko's theory with Cowper's coefficient, `n` modes and four remainder modes.
fn timoshenko(n: usize) -> Structure {
    let (side, modulus, density, nu): (f64, f64, f64, f64) = (0.011323, 2e11, 7800.0, 0.3);
    let cowper = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
    let section = ShearSection {
        shear_rigidity_n: cowper * modulus / (2.0 * (1.0 + nu)) * side.powi(2),
        rotary_inertia_kg_m: density * side.powi(4) / 12.0,
    };
    let segment = Segment::rectangular(1.0, modulus, density, side, side);
    let beam = BeamSystem {
        shear: Some(vec![section]),
        ..BeamSystem::from(Beam { segments: vec![segment], ends: [End::Pinned; 2] })
    };
    let kept = beam.modes(n).unwrap();
    let shapes = kept.shapes_at(GOLDEN).unwrap();
    let known = kept.omega_rad_s().iter().zip(shapes).map(|(&omega_rad_s, shape)| PointMode { omega_rad_s, shape });
    let all = known.chain(beam.remainder(GOLDEN, n, 4).unwrap());
    let damped = |m: PointMode| Mode { omega_rad_s: m.omega_rad_s, damping_ratio: DAMPING, shape: m.shape };
    Structure { modes: all.map(damped).collect() }
}

/// The restitution of a steel ball (m) at 1 m/s, mass and Hertz contact from its material.
fn of_steel(structure: &Structure, radius_m: f64) -> f64 {
    let striker = Striker { mass_kg: 4.0 / 3.0 * PI * radius_m.powi(3) * 7800.0, speed_m_s: 1.0 };
    let ball = Body { youngs_modulus_pa: 2e11, poissons_ratio: 0.3, radius_m };
    let law = Law::Hertz(Hertz::from_bodies(&ball, &Body::flat(2e11, 0.3)).unwrap());
    let solution = Solver::new(structure).unwrap().solve(&striker, &law, None, &settings(1e-9)).unwrap();
    solution.restitution.unwrap()
}

/// Balls of 2, 3 and 5 cm on the beam of chapter 3: 0.222, 0.143, 0.502 by Euler-Bernoulli's theory, 0.210, 0.253, 0.521 by
/// Timoshenko's.
#[test]
fn the_theory_of_the_beam_matters_more_than_its_modes() {
    for (radius_m, slender, thick) in [(0.01, 0.222, 0.210), (0.015, 0.143, 0.253), (0.025, 0.502, 0.521)] {
        let [few, many] = [120, 240].map(|n| of_steel(&timoshenko(n), radius_m));
        let other = of_steel(&with_remainder(128, 2), radius_m);
        println!("{radius_m}: {other} {few} {many}");
        assert!((few - many).abs() < 1e-4, "{few} {many}");
        assert!((many - thick).abs() < 1e-3 && (other - slender).abs() < 1e-3, "{other} {many}");
    }
}
