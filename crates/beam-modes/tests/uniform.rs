//! Uniform beams compared with textbook results.

use crate::common::{ENDS, defect, segment, thick};
use beam_modes::{Beam, End};
use std::f64::consts::PI;

fn uniform(ends: [End; 2]) -> Beam {
    Beam { segments: vec![segment(1.0, 1.0, 1.0)], ends }
}

/// `k L` of the first elastic modes: roots of the textbook equations (`cos x cosh x = 1`, ...), to eight decimals.
#[test]
fn textbook_roots() {
    use End::{Clamped, Free, Guided, Pinned};
    let table: [(End, End, usize, [f64; 3]); 10] = [
        (Free, Free, 2, [4.73004074, 7.85320462, 10.99560784]),
        (Free, Guided, 1, [2.36502037, 5.49780392, 8.63937983]),
        (Clamped, Free, 0, [1.87510407, 4.69409113, 7.85475744]),
        (Free, Pinned, 1, [3.92660231, 7.06858275, 10.21017612]),
        (Pinned, Pinned, 0, [PI, 2.0 * PI, 3.0 * PI]),
        (Clamped, Pinned, 0, [3.92660231, 7.06858275, 10.21017612]),
        (Clamped, Clamped, 0, [4.73004074, 7.85320462, 10.99560784]),
        (Clamped, Guided, 0, [2.36502037, 5.49780392, 8.63937983]),
        (Guided, Pinned, 0, [0.5 * PI, 1.5 * PI, 2.5 * PI]),
        (Guided, Guided, 1, [PI, 2.0 * PI, 3.0 * PI]),
    ];
    for (left, right, rigid, roots) in table {
        for ends in [[left, right], [right, left]] {
            let modes = uniform(ends).modes(rigid + 3).unwrap();
            assert_eq!(modes.rigid_body_count(), rigid);
            assert!(modes.omega_rad_s()[..rigid].iter().all(|&omega| omega == 0.0));
            for (omega, root) in modes.omega_rad_s()[rigid..].iter().zip(roots) {
                assert!((omega.sqrt() - root).abs() < 6e-9, "{ends:?}: {} for {root}", omega.sqrt());
            }
        }
    }
}

#[test]
fn pinned_shapes_are_sines() {
    let modes = uniform([End::Pinned, End::Pinned]).modes(200).unwrap();
    for k in 0..200 {
        for x in [0.0, 0.1, 0.37, 0.5, 0.99, 1.0] {
            let angle = PI * (k + 1) as f64 * x;
            let scale = PI * (k + 1) as f64;
            let root2 = 2f64.sqrt();
            assert!((modes.shape(k, x).unwrap() - root2 * angle.sin()).abs() < 4e-13);
            assert!((modes.slope(k, x).unwrap() / scale - root2 * angle.cos()).abs() < 4e-13);
            assert!((modes.curvature(k, x).unwrap() / scale.powi(2) + root2 * angle.sin()).abs() < 4e-13);
        }
    }
}

#[test]
fn tip_of_a_free_end_is_two() {
    // At a free end of a uniform beam of unit mass, |phi| = 2 for every elastic mode.
    for ends in [[End::Clamped, End::Free], [End::Free, End::Free]] {
        let modes = uniform(ends).modes(300).unwrap();
        for k in modes.rigid_body_count()..300 {
            assert!((modes.shape(k, 1.0).unwrap().abs() - 2.0).abs() < 1e-12);
        }
    }
}

/// The closed form of one span and the counted search over many must agree; the rigidities of the pieces differ in the last
/// digit, because equal ones would be merged.
#[test]
fn division_changes_nothing() {
    let almost = 1.0 + 4.0 * f64::EPSILON;
    let cuts: [Vec<f64>; 4] =
        [vec![0.3, 0.7], vec![0.5, 0.5], vec![0.5, 0.001, 0.499], (0..100).map(|_| 0.01).collect()];
    for left in ENDS {
        for right in ENDS {
            let whole = uniform([left, right]).modes(60).unwrap();
            for cut in &cuts {
                let segments: Vec<_> = cut
                    .iter()
                    .enumerate()
                    .map(|(i, &length)| segment(length, if i % 2 == 0 { 1.0 } else { almost }, 1.0))
                    .collect();
                let beam = Beam { segments, ends: [left, right] };
                let modes = beam.modes(60).unwrap();
                for k in 0..60 {
                    let (a, b) = (whole.omega_rad_s()[k], modes.omega_rad_s()[k]);
                    assert!((a - b).abs() <= 2e-14 * a, "{left:?} {right:?} {k}: {a} {b}");
                    for x in [0.0, 0.1, 0.3, 0.5, 0.5005, 0.77] {
                        let difference = whole.shape(k, x).unwrap() - modes.shape(k, x).unwrap();
                        assert!(difference.abs() < 1e-12, "{left:?} {right:?} mode {k} at {x}: {difference:e}");
                    }
                }
            }
        }
    }
}

#[test]
fn equal_neighbours_are_one_span() {
    let whole = Beam { segments: vec![thick(1.0, 0.5)], ends: [End::Clamped, End::Free] };
    let halves = Beam { segments: vec![thick(0.5, 0.5), thick(0.5, 0.5)], ends: whole.ends };
    assert_eq!(whole.modes(50).unwrap().omega_rad_s(), halves.modes(50).unwrap().omega_rad_s());
}

#[test]
fn orthonormal_for_all_ends() {
    for left in ENDS {
        for right in ENDS {
            let beam = uniform([left, right]);
            assert!(defect(&beam, &beam.modes(60).unwrap()) < 1e-13);
        }
    }
}
