//! The effect of remainder modes: the restitution of the thesis's beam with few modes compared with the converged one.

use crate::common::{GOLDEN, pinned, settings, solve};
use beam_modes::{Beam, BeamSystem, End, PointMode, RectangularSegment, Segment, ShearSection, remainder_modes};
use contact_models::{Body, Hertz, Law};
use std::f64::consts::PI;
use vibroimpact_sim::modal::{Solution, Solver, Striker, Structure};

const DAMPING: f64 = 0.02;

fn restitution(structure: &Structure) -> f64 {
    solve(structure, 1e-10).restitution.unwrap()
}

/// `n` modes of the beam and `count` remainder modes of 3,000 more, with the damping of the last mode that is not truncated.
fn with_remainder(n: usize, count: usize) -> Structure {
    let all = pinned(n + 3000, DAMPING, GOLDEN);
    let tail: Vec<PointMode> =
        all.modes[n..].iter().map(|m| PointMode { omega_rad_s: m.omega_rad_s, shape: m.shape }).collect();
    let rigidity = 2e11 * 0.011323f64.powi(4) / 12.0;
    let whole = (GOLDEN * (1.0 - GOLDEN)).powi(2) / (3.0 * rigidity);
    let rest = whole - all.modes.iter().map(|mode| (mode.shape / mode.omega_rad_s).powi(2)).sum::<f64>();
    let remainder = remainder_modes(&tail, rest.max(0.0), count).unwrap();
    let mut structure = pinned(n, DAMPING, GOLDEN);
    structure.modes.extend(Structure::from_modes(remainder, DAMPING).modes);
    structure
}

/// Golden section, 3 cm ball: the error of 64 modes alone is 2e-2, that with two remainder modes for the rest 1e-5.
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

/// A steel beam of square segments, length and side (m), by Timoshenko's theory: `n` modes at a location and four remainder
/// modes.
fn square(segments: &[(f64, f64)], shear_coefficient: f64, ends: [End; 2], x: f64, n: usize) -> Structure {
    let (modulus, density, nu) = (2e11, 7800.0, 0.3);
    let section = |&(_, side): &(f64, f64)| ShearSection {
        shear_rigidity_n: shear_coefficient * modulus / (2.0 * (1.0 + nu)) * side.powi(2),
        rotary_inertia_kg_m: density * side.powi(4) / 12.0,
    };
    let segment = |&(length, side): &(f64, f64)| {
        Segment::from(RectangularSegment {
            length_m: length,
            youngs_modulus_pa: modulus,
            density_kg_m3: density,
            width_m: side,
            thickness_m: side,
        })
    };
    let beam = BeamSystem {
        shear: Some(segments.iter().map(section).collect()),
        ..BeamSystem::from(Beam { segments: segments.iter().map(segment).collect(), ends })
    };
    let kept = beam.modes(n).unwrap().seen_from(x).unwrap();
    Structure::from_modes(kept.into_iter().chain(beam.remainder(x, n, 4).unwrap()), DAMPING)
}

/// The beam of chapter 3 with Cowper's coefficient.
fn timoshenko(n: usize) -> Structure {
    square(&[(1.0, 0.011323)], 10.0 * 1.3 / (12.0 + 11.0 * 0.3), [End::Pinned; 2], GOLDEN, n)
}

/// The impact of a steel ball (radius in m) at 1 m/s, with mass and Hertz contact from its material.
fn solution(structure: &Structure, radius_m: f64, tolerance: f64) -> Solution {
    let striker = Striker { mass_kg: 4.0 / 3.0 * PI * radius_m.powi(3) * 7800.0, speed_m_s: 1.0 };
    let ball = Body { youngs_modulus_pa: 2e11, poissons_ratio: 0.3, radius_m };
    let law = Law::Hertz(Hertz::from_bodies(&ball, &Body::flat(2e11, 0.3)).unwrap());
    Solver::new(structure).unwrap().solve(&striker, &law, None, &settings(tolerance)).unwrap()
}

fn of_steel(structure: &Structure, radius_m: f64) -> f64 {
    solution(structure, radius_m, 1e-9).restitution.unwrap()
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

/// Beams other than that of chapter 3: the result with 150 modes and four remainder modes is within 1e-4 of that with 600.
#[test]
fn a_hundred_and_fifty_modes_are_enough_for_thick_beams() {
    let kappa = 5.0 * 1.3 / 7.5;
    let (clamped, pinned, free) = (End::Clamped, End::Pinned, End::Free);
    for (segments, ends, x, radius_m) in [
        (&[(0.5, 0.02)][..], [clamped, free], 0.35, 0.01),
        (&[(0.5, 0.0113), (0.5, 0.008)], [clamped, pinned], 0.4, 0.0125),
        (&[(0.3, 0.015)], [free, free], 0.12, 0.01),
        (&[(2.0, 0.01)], [pinned, clamped], 0.7, 0.01),
    ] {
        let with = |n: usize| of_steel(&square(segments, kappa, ends, x, n), radius_m);
        let (few, many) = (with(150), with(600));
        println!("{segments:?}: {many} {:e}", few - many);
        assert!((few - many).abs() < 1e-4, "{segments:?}: {few} {many}");
    }
}

/// With the same number of modes an impact takes as many steps by either theory (one contact by both: the 2 cm ball), and not
/// many more with remainder modes, which are faster waves in a thick beam.
#[test]
fn thick_beams_cost_what_slender_ones_do() {
    let steps = |structure: &Structure| {
        let counts = solution(structure, 0.01, 1e-6).counts;
        (counts.contact_steps + counts.rejected_steps + counts.flight_steps) as f64
    };
    for n in [40, 100, 150, 200] {
        let (thick, slender) = (timoshenko(n), with_remainder(n, 4));
        let alone = |of: &Structure| steps(&Structure { modes: of.modes[..n].to_vec() });
        let ratios = [alone(&thick) / alone(&slender), steps(&thick) / steps(&slender)];
        println!("{n}: {ratios:?}");
        assert!(ratios[0] < 1.1 && ratios[1] < 1.5, "{n}: {ratios:?}");
    }
}
