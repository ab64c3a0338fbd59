//! Axial modes.

use crate::common::orthonormality_defect;
use beam_modes::{Rod, RodEnd, RodSegment};
use std::f64::consts::PI;

const PAIRS: [[RodEnd; 2]; 4] = [
    [RodEnd::Fixed, RodEnd::Fixed],
    [RodEnd::Fixed, RodEnd::Free],
    [RodEnd::Free, RodEnd::Fixed],
    [RodEnd::Free, RodEnd::Free],
];

fn segment(length_m: f64, axial_rigidity_n: f64, mass_per_length_kg_m: f64) -> RodSegment {
    RodSegment { length_m, axial_rigidity_n, mass_per_length_kg_m }
}

#[test]
fn uniform_and_cut() {
    let almost = 1.0 + 4.0 * f64::EPSILON;
    for ends in PAIRS {
        let uniform = Rod { segments: vec![segment(1.0, 1.0, 1.0)], ends };
        let cut =
            Rod { segments: vec![segment(0.3, 1.0, 1.0), segment(0.2, almost, 1.0), segment(0.5, 1.0, 1.0)], ends };
        let (a, b) = (uniform.modes(100).unwrap(), cut.modes(100).unwrap());
        let rigid = a.rigid_body_count();
        for k in 0..100 {
            let shift = if ends[0] == ends[1] { 1.0 } else { 0.5 };
            let exact = (k as f64 + shift - rigid as f64) * PI;
            assert!((a.omega_rad_s()[k] - exact).abs() <= 1e-14 * exact.abs());
            assert!((b.omega_rad_s()[k] - exact).abs() <= 1e-14 * exact.abs());
            for x in [0.0, 0.21, 0.4, 0.9] {
                assert!((a.shape(k, x).unwrap() - b.shape(k, x).unwrap()).abs() < 1e-12);
            }
        }
    }
}

/// Two equal lengths of equal wave speed: `tan^2(k l) = ratio of the impedances` for fixed-free.
#[test]
fn impedance_step() {
    let ratio: f64 = 9.0;
    let rod =
        Rod { segments: vec![segment(1.0, ratio, ratio), segment(1.0, 1.0, 1.0)], ends: [RodEnd::Fixed, RodEnd::Free] };
    let angle = ratio.sqrt().atan();
    let modes = rod.modes(40).unwrap();
    for (k, omega) in modes.omega_rad_s().iter().enumerate() {
        let turns = k.div_ceil(2) as f64 * PI;
        let exact = if k % 2 == 0 { turns + angle } else { turns - angle };
        assert!((omega - exact).abs() < 1e-14 * exact, "{k}: {omega} {exact}");
    }
}

#[test]
fn orthonormal_under_contrast() {
    let chains = [
        vec![segment(0.3, 2.0, 1.0), segment(0.7, 0.5, 0.8)],
        vec![segment(0.5, 1.0, 1.0), segment(0.01, 1e4, 1e4), segment(0.5, 1.0, 1.0)],
        (0..50).map(|i| segment(1.0, 1.0 + 20.0 * f64::from(i % 3), 1.0 + f64::from(i % 7))).collect::<Vec<_>>(),
    ];
    for segments in chains {
        for ends in PAIRS {
            let rod = Rod { segments: segments.clone(), ends };
            let modes = rod.modes(80).unwrap();
            let highest = modes.omega_rad_s()[79];
            let pieces: Vec<_> = segments
                .iter()
                .map(|s| {
                    let k = highest * (s.mass_per_length_kg_m / s.axial_rigidity_n).sqrt();
                    (s.length_m, s.mass_per_length_kg_m, k)
                })
                .collect();
            let found = orthonormality_defect(&pieces, &modes);
            assert!(found < 1e-11, "{ends:?}: {found:e}");
        }
    }
}
