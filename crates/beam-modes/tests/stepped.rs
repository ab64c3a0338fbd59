//! Stepped beams compared with published and multiple-precision values, and extreme cases.

use crate::common::{ENDS, defect, rows, segment, thick};
use beam_modes::{Beam, End, RectangularSegment, Segment};
use std::f64::consts::TAU;

#[test]
fn koplow_free_free() {
    let part = |length: f64, thickness: f64| {
        Segment::from(RectangularSegment {
            length_m: length,
            youngs_modulus_pa: 71.7e9,
            density_kg_m3: 2830.0,
            width_m: 0.0254,
            thickness_m: thickness,
        })
    };
    let beam = Beam { segments: vec![part(0.254, 0.01905), part(0.140, 0.00549)], ends: [End::Free, End::Free] };
    let modes = beam.modes(7).unwrap();
    for row in rows(include_str!("data/stepped_free_free_beam_koplow2006.csv")) {
        let (mode, hertz): (usize, f64) = (row[0].parse().unwrap(), row[1].parse().unwrap());
        let ours = modes.omega_rad_s()[mode + 1] / TAU;
        assert!((ours / hertz - 1.0).abs() < 1e-12, "mode {mode}: {ours} Hz, published {hertz}");
    }
}

#[test]
fn mabie_rogers_taper() {
    for row in rows(include_str!("data/tapered_cantilever_mabie_rogers1972.csv")) {
        let (ratio, mode, lambda): (f64, usize, f64) =
            (row[0].parse().unwrap(), row[1].parse().unwrap(), row[2].parse().unwrap());
        // E = rho = h1 = b1 = L = 1.
        let steps = (0..80).map(|i| {
            let to_tip = 1.0 - (f64::from(i) + 0.5) / 80.0;
            Segment::from(RectangularSegment {
                length_m: 1.0 / 80.0,
                youngs_modulus_pa: 1.0,
                density_kg_m3: 1.0,
                width_m: 1.0 + (ratio - 1.0) * to_tip,
                thickness_m: 1.0 + 3.0 * to_tip,
            })
        });
        let beam = Beam { segments: steps.collect(), ends: [End::Clamped, End::Free] };
        let ours = beam.modes(5).unwrap().omega_rad_s()[mode - 1] * 12f64.sqrt();
        assert!((ours / lambda - 1.0).abs() < 5e-4, "ratio {ratio}, mode {mode}: {ours}, published {lambda}");
    }
}

/// Frequencies to 12 digits (13 are asserted), none missed.
#[test]
fn multiple_precision_reference() {
    let cases = [
        ("halves", [End::Clamped, End::Free], vec![segment(0.5, 1.0, 1.0), segment(0.5, 0.2, 0.5)]),
        (
            "thirds",
            [End::Free, End::Pinned],
            vec![segment(0.25, 3.0, 1.0), segment(0.5, 1.0, 0.75), segment(0.125, 40.0, 2.0)],
        ),
        (
            "soft hinge",
            [End::Guided, End::Clamped],
            vec![segment(0.5, 1.0, 1.0), segment(0.001, 1e-6, 0.01), segment(0.4, 1.0, 1.0)],
        ),
    ];
    for (name, ends, segments) in cases {
        let beam = Beam { segments, ends };
        let rigid = beam.rigid_body_count();
        let reference: Vec<f64> = rows(include_str!("data/stepped_beam_reference.csv"))
            .filter(|row| row[0] == name)
            .map(|row| row[2].parse().unwrap())
            .collect();
        let modes = beam.modes(rigid + reference.len()).unwrap();
        for (n, (ours, theirs)) in modes.omega_rad_s()[rigid..].iter().zip(&reference).enumerate() {
            assert!((ours / theirs - 1.0).abs() < 1e-13, "{name} {n}: {ours} for {theirs}");
        }
    }
}

#[test]
fn five_hundred_modes_are_orthonormal() {
    let beam = Beam { segments: vec![segment(0.5, 1.0, 1.0), segment(0.5, 0.2, 0.5)], ends: [End::Clamped, End::Free] };
    let found = defect(&beam, &beam.modes(500).unwrap());
    assert!(found < 1e-12, "{found:e}");
}

/// Extreme contrasts, coincident frequencies (equal spans between heavy blocks), many segments: the shapes are orthonormal, and
/// the modal sum of the static compliance converges to the exact value from below.
#[test]
fn hard_chains() {
    let mut seed = 12345u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / (1u64 << 31) as f64
    };
    let chains: Vec<(&str, Vec<Segment>)> = vec![
        ("short thick band", vec![thick(0.5, 1.0), thick(0.001, 100.0), thick(0.499, 1.0)]),
        ("block between twins", vec![thick(0.5, 1.0), thick(0.3, 100.0), thick(0.5, 1.0)]),
        ("EI 1e12", vec![thick(0.5, 1.0), thick(0.3, 1e4), thick(0.5, 1.0)]),
        ("hinge", vec![thick(0.5, 1.0), thick(0.001, 0.01), thick(0.5, 1.0)]),
        ("thin hinge", vec![thick(0.5, 1.0), thick(0.001, 1e-4), thick(0.5, 1.0)]),
        ("ten equal spans", (0..21).map(|i| thick(1.0, if i % 2 == 0 { 1.0 } else { 50.0 })).collect()),
        ("taper of 200", (0..200).map(|i| thick(1.0, 1.0 - 0.0035 * f64::from(i))).collect()),
        ("random 60", (0..60).map(|_| thick(10f64.powf(2.0 * random()), 10f64.powf(2.0 * random()))).collect()),
    ];
    for (name, segments) in chains {
        for ends in [[End::Clamped, End::Free], [End::Free, End::Free], [End::Guided, End::Guided], [End::Pinned; 2]] {
            let beam = Beam { segments: segments.clone(), ends };
            let modes = beam.modes(50).unwrap();
            assert!(modes.omega_rad_s().windows(2).all(|w| w[0] <= w[1]));
            let found = defect(&beam, &modes);
            assert!(found < 1e-11, "{name} {ends:?}: {found:e}");

            let x_m = 0.37 * beam.length_m();
            let exact = beam.static_compliance(x_m).unwrap();
            let shapes = modes.shapes_at(x_m).unwrap();
            let rigid = modes.rigid_body_count();
            let sum: f64 =
                shapes[rigid..].iter().zip(&modes.omega_rad_s()[rigid..]).map(|(phi, w)| (phi / w).powi(2)).sum();
            let rest = 1.0 - sum / exact;
            assert!(rest > -1e-10 && rest < 2e-2, "{name} {ends:?}: {rest:e}");
        }
    }
}

#[test]
fn mirror_image() {
    let segments = vec![segment(0.3, 2.0, 1.0), segment(0.2, 0.1, 0.4), segment(0.5, 1.0, 1.5)];
    for left in ENDS {
        for right in ENDS {
            let beam = Beam { segments: segments.clone(), ends: [left, right] };
            let mirrored = Beam { segments: segments.iter().rev().copied().collect(), ends: [right, left] };
            let (modes, images) = (beam.modes(60).unwrap(), mirrored.modes(60).unwrap());
            for k in modes.rigid_body_count()..60 {
                let (a, b) = (modes.omega_rad_s()[k], images.omega_rad_s()[k]);
                assert!((a / b - 1.0).abs() < 1e-14);
                for x in [0.05, 0.3, 0.77] {
                    let (p, q) = (modes.shape(k, x).unwrap(), images.shape(k, 1.0 - x).unwrap());
                    assert!((p.abs() - q.abs()).abs() < 1e-12, "{left:?} {right:?} {k} {x}: {p} {q}");
                }
            }
            for x in [0.0, 0.1, 0.45, 0.9, 1.0] {
                let (a, b) = (beam.static_compliance(x).unwrap(), mirrored.static_compliance(1.0 - x).unwrap());
                assert!((a - b).abs() <= 1e-13 * a.max(1e-3), "{left:?} {right:?} {x}: {a} {b}");
            }
        }
    }
}
