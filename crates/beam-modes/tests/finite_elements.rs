//! The finite-element model converges to the exact modes with order 4.

use crate::common::{ENDS, segment};
use beam_modes::{Beam, End, fem};

fn stepped(ends: [End; 2]) -> Beam {
    Beam { segments: vec![segment(0.5, 1.0, 1.0), segment(0.5, 0.3, 0.5)], ends }
}

#[test]
fn fourth_order_from_above() {
    for left in ENDS {
        for right in ENDS {
            let beam = stepped([left, right]);
            let exact = beam.modes(6).unwrap();
            let errors = [8, 16].map(|elements| {
                let discrete = fem::Model::new(&beam, elements).unwrap().modes().unwrap();
                let error = |k: usize| discrete.omega_rad_s()[k] / exact.omega_rad_s()[k] - 1.0;
                let rigid = exact.rigid_body_count();
                assert!(discrete.omega_rad_s()[..rigid].iter().all(|&omega| omega == 0.0));
                [error(4), error(5)]
            });
            for k in 0..2 {
                let order = (errors[0][k] / errors[1][k]).log2();
                assert!(errors[1][k] > 0.0 && (order - 4.0).abs() < 0.1, "{left:?} {right:?} {k}: {order} {errors:?}");
            }
        }
    }
}

#[test]
fn shapes_converge_with_order_four() {
    let beam = stepped([End::Clamped, End::Pinned]);
    let exact = beam.modes(5).unwrap();
    let errors = [10, 20].map(|elements| {
        let discrete = fem::Model::new(&beam, elements).unwrap().modes().unwrap();
        [0, 1, 2, 3, 4].map(|k| {
            let sign = (exact.shape(k, 0.61).unwrap() * discrete.shape(k, 0.61).unwrap()).signum();
            let error = |x: f64| (exact.shape(k, x).unwrap() - sign * discrete.shape(k, x).unwrap()).abs();
            (0..=1000).map(|i| error(f64::from(i) / 1000.0)).fold(0.0, f64::max)
        })
    });
    for k in 0..5 {
        let order = (errors[0][k] / errors[1][k]).log2();
        assert!((order - 4.0).abs() < 0.2 && errors[1][k] < 3e-4, "mode {k}: order {order}, {errors:?}");
    }
}

/// Thesis appendix A.4: twenty elements, forty degrees of freedom; matrices symmetric, vectors mass-normalised.
#[test]
fn appendix_a4_model() {
    let beam = Beam { segments: vec![segment(1.0, 273.0, 1.0)], ends: [End::Clamped, End::Free] };
    let model = fem::Model::new(&beam, 20).unwrap();
    let n = model.dofs.len();
    assert_eq!((n, model.nodes_m.len()), (40, 21));
    for i in 0..n {
        for j in 0..n {
            assert_eq!(model.stiffness[i * n + j], model.stiffness[j * n + i]);
            assert_eq!(model.mass[i * n + j], model.mass[j * n + i]);
        }
    }
    // The static compliance from all modes of the model is exact at nodes for Hermite elements.
    let modes = model.modes().unwrap();
    for node in [5, 10, 20] {
        let x = model.nodes_m[node];
        let shapes = modes.shapes_at(x).unwrap();
        let sum: f64 = shapes.iter().zip(modes.omega_rad_s()).map(|(phi, w)| (phi / w).powi(2)).sum();
        assert!((sum / beam.static_compliance(x).unwrap() - 1.0).abs() < 1e-8);
    }
}
