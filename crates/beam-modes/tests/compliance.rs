//! Static compliance compared with closed forms and modal sums.

use crate::common::{ENDS, segment};
use beam_modes::{Beam, End, Rod, RodEnd, RodSegment};

#[test]
fn closed_forms() {
    let (length, rigidity) = (1.7, 23.0);
    let check = |ends: [End; 2], expected: &dyn Fn(f64) -> f64| {
        let beam = Beam { segments: vec![segment(length, rigidity, 0.6)], ends };
        for i in 0..=10 {
            let x = length * f64::from(i) / 10.0;
            let (ours, exact) = (beam.static_compliance(x).unwrap(), expected(x));
            assert!((ours - exact).abs() <= 1e-13 * exact + 1e-18, "{ends:?} {x}: {ours} {exact}");
        }
    };
    let l = length;
    check([End::Pinned, End::Pinned], &|x| (x * (l - x)).powi(2) / (3.0 * rigidity * l));
    check([End::Clamped, End::Free], &|x| x.powi(3) / (3.0 * rigidity));
    check([End::Clamped, End::Clamped], &|x| (x * (l - x)).powi(3) / (3.0 * rigidity * l.powi(3)));
    check([End::Clamped, End::Pinned], &|x| {
        x.powi(3) * (l - x).powi(2) * (4.0 * l - x) / (12.0 * rigidity * l.powi(3))
    });
    // Half of a beam on two supports, under two forces.
    check([End::Pinned, End::Guided], &|x| x * x * (3.0 * l - 2.0 * x) / (3.0 * rigidity));
    // Free-free at an end: the sum of 4 / (k L)^4 over cos cosh = 1, which is 4 / 420.
    let free = Beam { segments: vec![segment(l, rigidity, 0.6)], ends: [End::Free, End::Free] };
    let end = l.powi(3) / (105.0 * rigidity);
    assert!((free.static_compliance(0.0).unwrap() / end - 1.0).abs() < 1e-12);
    assert!((free.static_compliance(l).unwrap() / end - 1.0).abs() < 1e-12);
}

#[test]
fn modal_sums_converge_to_it() {
    for left in ENDS {
        for right in ENDS {
            let beam = Beam { segments: vec![segment(0.4, 2.0, 1.0), segment(0.6, 0.3, 0.5)], ends: [left, right] };
            let modes = beam.modes(400).unwrap();
            let rigid = modes.rigid_body_count();
            for (x, y) in [(0.3, 0.3), (0.2, 0.75), (0.95, 0.95)] {
                let (at_x, at_y) = (modes.shapes_at(x).unwrap(), modes.shapes_at(y).unwrap());
                let sum: f64 = (rigid..400).map(|k| at_x[k] * at_y[k] / modes.omega_rad_s()[k].powi(2)).sum();
                let exact = beam.static_green(x, y).unwrap();
                let scale = (beam.static_compliance(x).unwrap() * beam.static_compliance(y).unwrap()).sqrt();
                // The rest of the sum decreases with the cube of the number of modes.
                assert!((sum - exact).abs() < 1e-5 * scale, "{left:?} {right:?} {x} {y}: {sum} {exact}");
                assert!((exact - beam.static_green(y, x).unwrap()).abs() < 1e-13 * scale);
            }
        }
    }
}

#[test]
fn rods() {
    let segments = vec![
        RodSegment { length_m: 0.4, axial_rigidity_n: 3.0, mass_per_length_kg_m: 1.0 },
        RodSegment { length_m: 0.6, axial_rigidity_n: 1.0, mass_per_length_kg_m: 2.0 },
    ];
    for ends in [
        [RodEnd::Fixed, RodEnd::Free],
        [RodEnd::Free, RodEnd::Fixed],
        [RodEnd::Fixed, RodEnd::Fixed],
        [RodEnd::Free, RodEnd::Free],
    ] {
        let rod = Rod { segments: segments.clone(), ends };
        let sum = |count: usize, x: f64| -> f64 {
            let modes = rod.modes(count).unwrap();
            let rigid = modes.rigid_body_count();
            let shapes = modes.shapes_at(x).unwrap();
            (rigid..count).map(|k| (shapes[k] / modes.omega_rad_s()[k]).powi(2)).sum()
        };
        for x in [0.2, 0.7] {
            let exact = rod.static_compliance(x).unwrap();
            let (coarse, fine) = (exact - sum(1000, x), exact - sum(4000, x));
            // The rest decreases with the number of modes.
            assert!(fine > 0.0 && fine < 1e-3 * exact, "{ends:?} {x}: {fine:e} of {exact}");
            assert!((coarse / fine - 4.0).abs() < 0.1, "{ends:?} {x}: {}", coarse / fine);
        }
    }
}
