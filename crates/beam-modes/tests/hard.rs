//! Cases that are difficult for codes of the modes of beams, each with its expected result.

use crate::common::{ENDS, defect, segment, thick};
use beam_modes::{Beam, End, Segment};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Frequencies and shapes there agree to this `share`.
fn same(a: &Beam, b: &Beam, count: usize, places: [f64; 2], share: f64, name: &str) {
    let (p, q) = (a.modes(count).unwrap(), b.modes(count).unwrap());
    for (k, (x, y)) in p.omega_rad_s().iter().zip(q.omega_rad_s()).enumerate() {
        assert!((x - y).abs() <= share * x.max(1e-6), "{name}: mode {k}: {x} against {y}");
    }
    let (s, t) = (p.shapes_at(places[0]).unwrap(), q.shapes_at(places[1]).unwrap());
    let size = s.iter().fold(0.0f64, |m, phi| m.max(phi.abs()));
    for (k, (x, y)) in s.iter().zip(&t).enumerate() {
        // Far from the end that determines the sign, it is known only as accurately as the frequency.
        assert!((x.abs() - y.abs()).abs() <= 1e3 * share * size, "{name}: shape {k}: {x} against {y}");
    }
}

/// With a step of equal sections, a step at an end or a step of almost no length, the beam is the uniform one.
#[test]
fn steps_that_change_nothing() {
    let whole = thick(1.0, 1.0);
    let part = |length: f64| thick(length, 1.0);
    for ends in [[End::Pinned, End::Pinned], [End::Clamped, End::Free], [End::Free, End::Free]] {
        let uniform = Beam { segments: vec![whole], ends };
        for (name, segments) in [
            ("a step of equal sections", vec![part(0.3), part(0.7)]),
            ("ten steps of equal sections", (0..10).map(|_| part(0.1)).collect()),
            ("a piece of 1e-6 at the end", vec![part(1e-6), part(1.0 - 1e-6)]),
        ] {
            same(&uniform, &Beam { segments, ends }, 30, [0.37; 2], 1e-10, name);
        }
        // A segment of 1e-7 does not affect the first modes.
        let ring = segment(1e-7, 8.0, 2.0);
        let ringed = Beam { segments: vec![part(0.5 - 1e-7), ring, part(0.5)], ends };
        same(&uniform, &ringed, 10, [0.37; 2], 1e-5, "a ring 1e-7 long");
    }
}

/// Two equal halves joined by a very thin segment: pairs of nearly equal frequencies, and shapes still orthonormal.
#[test]
fn nearly_equal_frequencies() {
    for hair in [1e-2, 1e-3] {
        let beam = Beam {
            segments: vec![thick(1.0, 1.0), segment(0.01, hair, 1e-3), thick(1.0, 1.0)],
            ends: [End::Clamped, End::Clamped],
        };
        let modes = beam.modes(12).unwrap();
        let found = defect(&beam, &modes);
        assert!(found < 1e-11, "{hair:e}: {found:e}");
        assert!(modes.omega_rad_s().windows(2).all(|pair| pair[0] <= pair[1]));
    }
}

/// At supports, at the ends, beside them and on steps: continuous, zero if constrained.
#[test]
fn locations_at_limits() {
    for left in ENDS {
        for right in ENDS {
            let beam = Beam { segments: vec![thick(0.4, 1.0), thick(0.6, 0.5)], ends: [left, right] };
            let modes = beam.modes(20).unwrap();
            let held = |end: End| matches!(end, End::Clamped | End::Pinned);
            for (end, x) in [(left, 0.0), (right, modes.length_m())] {
                let shapes = modes.shapes_at(x).unwrap();
                if held(end) {
                    assert!(shapes.iter().all(|phi| *phi == 0.0), "{left:?} {right:?} at {x}: {shapes:?}");
                } else {
                    assert!(shapes.iter().any(|phi| phi.abs() > 0.1), "{left:?} {right:?} at {x}");
                }
            }
            let (before, on, after) =
                (modes.shapes_at(0.4 - 1e-12), modes.shapes_at(0.4).unwrap(), modes.shapes_at(0.4 + 1e-12));
            for (k, ((a, b), c)) in before.unwrap().iter().zip(&on).zip(&after.unwrap()).enumerate() {
                assert!((a - b).abs() < 1e-9 && (b - c).abs() < 1e-9, "mode {k}: {a} {b} {c}");
            }
            // The static compliance of the truncated modes is never negative, and decreases.
            let whole = beam.static_compliance(0.4).unwrap();
            let terms = modes.omega_rad_s().iter().zip(&on).filter(|(omega, _)| **omega > 0.0);
            let sum: f64 = terms.map(|(omega, phi)| (phi / omega).powi(2)).sum();
            assert!(sum <= whole * (1.0 + 1e-10) && sum > 0.99 * whole, "{left:?} {right:?}: {sum} of {whole}");
            assert_eq!(modes.rigid_body_count(), beam.rigid_body_count());
        }
    }
}

/// From no mode at all to a thousand, on a beam of five steps.
#[test]
fn counts_of_modes() {
    let segments: Vec<Segment> = (1..=5).map(|i| thick(0.2, 0.4 + 0.1 * f64::from(i))).collect();
    let beam = Beam { segments, ends: [End::Clamped, End::Free] };
    let many = beam.modes(1000).unwrap();
    for count in [0, 1, 2, 50] {
        let few = beam.modes(count).unwrap();
        assert_eq!(few.len(), count);
        for (x, y) in few.omega_rad_s().iter().zip(many.omega_rad_s()) {
            assert!((x - y).abs() <= 1e-14 * y, "{count} modes: {x} against {y}");
        }
    }
    assert!(many.omega_rad_s().windows(2).all(|pair| pair[0] < pair[1]));
    // At high frequencies those of a uniform beam are approached: k sum l_i (m_i/EI_i)^(1/4) grows by pi per mode.
    let phase: f64 =
        beam.segments.iter().map(|s| s.length_m * (s.mass_per_length_kg_m / s.flexural_rigidity_n_m2).powf(0.25)).sum();
    let count = phase * (many.omega_rad_s()[999].sqrt() - many.omega_rad_s()[499].sqrt()) / std::f64::consts::PI;
    assert!((count - 500.0).abs() < 1.0, "{count}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 40, rng_seed: RngSeed::Fixed(2019), failure_persistence: None, ..ProptestConfig::default()
    })]

    /// From its other end a beam has the same frequencies, and the same shapes except for their sign.
    #[test]
    fn mirrored(
        parts in proptest::collection::vec((0.1..1.0f64, -1.5..1.5f64, -1.0..1.0f64), 1..5), left in 0..4usize, right in 0..4usize,
        share in 0.0..1.0f64,
    ) {
        let segments: Vec<Segment> =
            parts.iter().map(|&(length, b, c)| segment(length, 10f64.powf(b), 10f64.powf(c))).collect();
        let beam = Beam { segments: segments.clone(), ends: [ENDS[left], ENDS[right]] };
        let other = Beam { segments: segments.into_iter().rev().collect(), ends: [ENDS[right], ENDS[left]] };
        let x = share * beam.length_m();
        let y = (beam.length_m() - x).clamp(0.0, other.modes(1).unwrap().length_m());
        same(&beam, &other, 20, [x, y], 1e-11, "mirrored");
        let (a, b) = (beam.static_compliance(x).unwrap(), other.static_compliance(y).unwrap());
        let largest = beam.static_compliance(0.5 * beam.length_m()).unwrap().max(a);
        prop_assert!((a - b).abs() <= 1e-9 * largest, "{} {}", a, b);
    }
}
