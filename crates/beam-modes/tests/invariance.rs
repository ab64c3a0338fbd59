//! Scaling laws on random stepped beams, and input that must be rejected.

use crate::common::{ENDS, defect, segment};
use beam_modes::{Beam, End, Rod, RodEnd, RodSegment, Segment, fem};
use proptest::prelude::*;

fn any_beam() -> impl Strategy<Value = Beam> {
    let any_segment = (0.05..2.0f64, -3.0..3.0f64, -2.0..2.0f64)
        .prop_map(|(length, rigidity, mass)| segment(length, 10f64.powf(rigidity), 10f64.powf(mass)));
    (proptest::collection::vec(any_segment, 1..6), 0..4usize, 0..4usize)
        .prop_map(|(segments, left, right)| Beam { segments, ends: [ENDS[left], ENDS[right]] })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_beam_has_orthonormal_modes(beam in any_beam()) {
        let modes = beam.modes(30).unwrap();
        prop_assert!(modes.omega_rad_s().windows(2).all(|w| w[0] <= w[1]));
        let found = defect(&beam, &modes);
        prop_assert!(found < 1e-11, "{found:e}");
    }

    /// Lengths times a, rigidities times b, masses times c: omega times sqrt(b/c)/a^2, compliance times a^3/b.
    #[test]
    fn scaling(beam in any_beam(), a in 1e-3..1e3f64, b in 1e-6..1e6f64, c in 1e-6..1e6f64) {
        let scaled = Beam {
            segments: beam.segments.iter()
                .map(|s| segment(a * s.length_m, b * s.flexural_rigidity_n_m2, c * s.mass_per_length_kg_m)).collect(),
            ends: beam.ends,
        };
        let (modes, others) = (beam.modes(20).unwrap(), scaled.modes(20).unwrap());
        let x = 0.37 * beam.length_m();
        for k in 0..20 {
            let expected = modes.omega_rad_s()[k] * (b / c).sqrt() / (a * a);
            prop_assert!((others.omega_rad_s()[k] - expected).abs() <= 1e-11 * expected);
        }
        let expected = beam.static_compliance(x).unwrap() * a.powi(3) / b;
        let ours = scaled.static_compliance((a * x).min(scaled.length_m())).unwrap();
        prop_assert!((ours / expected - 1.0).abs() < 1e-9, "{ours} {expected}");
    }

    /// For any numbers the result is finite or an error, never a panic.
    #[test]
    fn no_input_panics(
        values in proptest::collection::vec((any::<f64>(), any::<f64>(), any::<f64>()), 0..4),
        exponents in proptest::collection::vec((-7.0..4.0f64, -6.0..6.0f64, -6.0..6.0f64), 1..6),
        x in any::<f64>(), left in 0..4usize, right in 0..4usize,
    ) {
        let ends = [ENDS[left], ENDS[right]];
        let wild: Vec<Segment> = values.iter().map(|&(l, r, m)| segment(l, r, m)).collect();
        let extreme: Vec<Segment> = exponents.iter()
            .map(|&(l, r, m)| segment(10f64.powf(l), 10f64.powf(r), 10f64.powf(m))).collect();
        for segments in [wild, extreme] {
            let beam = Beam { segments, ends };
            if let Ok(modes) = beam.modes(12) {
                prop_assert_eq!(modes.len(), 12);
                prop_assert!(modes.omega_rad_s().iter().all(|w| w.is_finite()));
                let shapes = modes.shapes_at(0.5 * modes.length_m()).unwrap();
                prop_assert!(shapes.iter().all(|phi| phi.is_finite()));
                let _ = modes.shape(3, x);
            }
            let _ = beam.static_compliance(x);
            if let Ok(model) = fem::Model::new(&beam, 2) {
                let _ = model.modes();
            }
            let rod = Rod {
                segments: beam.segments.iter().map(|s| RodSegment {
                    length_m: s.length_m,
                    axial_rigidity_n: s.flexural_rigidity_n_m2,
                    mass_per_length_kg_m: s.mass_per_length_kg_m,
                }).collect(),
                ends: [RodEnd::Free, RodEnd::Fixed],
            };
            let _ = rod.modes(12);
        }
    }
}

#[test]
fn bad_input_is_named() {
    let good = segment(1.0, 2.0, 3.0);
    let beam = |segments: Vec<Segment>| Beam { segments, ends: [End::Pinned, End::Pinned] };
    let field = |segments: Vec<Segment>| beam(segments).modes(3).unwrap_err().field;
    assert_eq!(field(vec![]), "segments");
    assert_eq!(field(vec![good, Segment { length_m: -1.0, ..good }]), "segments[1].length_m");
    assert_eq!(field(vec![Segment { length_m: f64::NAN, ..good }]), "segments[0].length_m");
    assert_eq!(field(vec![Segment { mass_per_length_kg_m: 0.0, ..good }]), "segments[0].mass_per_length_kg_m");
    assert_eq!(
        field(vec![Segment { flexural_rigidity_n_m2: f64::INFINITY, ..good }]),
        "segments[0].flexural_rigidity_n_m2"
    );
    assert_eq!(
        field(vec![good, Segment { flexural_rigidity_n_m2: 1e15, ..good }]),
        "segments[1].flexural_rigidity_n_m2"
    );
    let sound = beam(vec![good]);
    assert_eq!(sound.modes(usize::MAX).unwrap_err().field, "count");
    assert!(sound.modes(0).unwrap().is_empty());
    let modes = sound.modes(3).unwrap();
    assert_eq!(modes.shape(3, 0.5).unwrap_err().field, "k");
    for off in [-0.1, 1.1, f64::NAN, f64::INFINITY] {
        assert_eq!(modes.shape(0, off).unwrap_err().field, "x_m");
        assert_eq!(modes.shapes_at(off).unwrap_err().field, "x_m");
        assert_eq!(sound.static_compliance(off).unwrap_err().field, "x_m");
    }
    assert_eq!(fem::Model::new(&sound, 0).unwrap_err().field, "elements_per_segment");
    assert_eq!(fem::Model::new(&sound, usize::MAX).unwrap_err().field, "elements_per_segment");
}
