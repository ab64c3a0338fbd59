//! Statements about modes over random stepped beams: frequencies do not depend on the way in which they are found, and shapes
//! are orthonormal. The seed is fixed.

use crate::common::{ENDS, defect, segment};
use beam_modes::{Beam, End, Segment, fem};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

/// Number of elastic modes compared.
const MODES: usize = 6;

/// The same sequence of random beams on every machine: two to four segments, any ends.
fn beams(count: usize) -> Vec<Beam> {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[19; 32]);
    let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
    let part = (0.2..1.0f64, -1.0..1.0f64, -0.7..0.7f64);
    let beam = (proptest::collection::vec(part, 2..5), 0..4usize, 0..4usize);
    let mut draw = || beam.new_tree(&mut runner).unwrap().current();
    (0..count)
        .map(|_| {
            let (parts, left, right) = draw();
            let segments: Vec<Segment> =
                parts.iter().map(|&(length, b, c)| segment(length, 10f64.powf(b), 10f64.powf(c))).collect();
            Beam { segments, ends: [ENDS[left], ENDS[right]] }
        })
        .collect()
}

fn discrete(beam: &Beam, elements: usize) -> fem::ModelModes {
    fem::Model::new(beam, elements).unwrap().modes().unwrap()
}

/// Shapes are orthonormal to 1e-11 and agree with finite elements.
#[test]
fn shapes_are_orthonormal_and_those_of_finite_elements() {
    for beam in beams(24) {
        let rigid = beam.rigid_body_count();
        let ours = beam.modes(rigid + MODES).unwrap();
        let found = defect(&beam, &ours);
        assert!(found < 1e-11, "{beam:?}: {found:e}");
        let theirs = discrete(&beam, 20);
        let places: Vec<f64> = (0..=20).map(|i| (f64::from(i) / 20.0 * ours.length_m()).min(ours.length_m())).collect();
        for k in rigid..rigid + MODES {
            let p: Vec<f64> = places.iter().map(|&x| ours.shape(k, x).unwrap()).collect();
            let q: Vec<f64> = places.iter().map(|&x| theirs.shape(k, x).unwrap()).collect();
            let size = p.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
            let sign = p.iter().zip(&q).map(|(a, b)| a * b).sum::<f64>().signum();
            let apart = p.iter().zip(&q).fold(0.0_f64, |m, (a, b)| m.max((a - sign * b).abs()));
            // Close frequencies mix their shapes: the distance to the neighbours counts.
            let omega = ours.omega_rad_s();
            let all = [k.checked_sub(1), Some(k + 1)];
            let gap = all.into_iter().flatten().filter_map(|i| omega.get(i)).map(|w| (w / omega[k] - 1.0).abs());
            let gap = gap.fold(1.0_f64, f64::min);
            assert!(apart < 3e-3 * size / gap, "mode {k} of {beam:?}: {apart:e} of {size}, gap {gap}");
        }
    }
}

/// The list up to 120 modes agrees with that of the mirror image to 1e-13, and a shorter list is the beginning of a longer one.
#[test]
fn frequencies_do_not_depend_on_the_way_they_are_found() {
    for beam in beams(40) {
        let mirrored = Beam {
            segments: beam.segments.iter().rev().copied().collect(),
            ends: {
                let [left, right]: [End; 2] = beam.ends;
                [right, left]
            },
        };
        let (many, few, other) = (beam.modes(120).unwrap(), beam.modes(37).unwrap(), mirrored.modes(120).unwrap());
        for (k, (a, b)) in many.omega_rad_s().iter().zip(other.omega_rad_s()).enumerate() {
            assert!((a - b).abs() <= 1e-13 * a, "mode {k} of {beam:?}: {a} and {b}");
        }
        for (a, b) in few.omega_rad_s().iter().zip(many.omega_rad_s()) {
            assert!((a - b).abs() <= 2e-14 * a, "{beam:?}: {a} and {b}");
        }
    }
}
