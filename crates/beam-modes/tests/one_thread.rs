//! Modes are computed in one thread, whatever features of faer a build turns on: the rounding depends on the number of threads.

use beam_modes::{Beam, Edge, End, Plate, PlateTheory, RectangularSegment, fem};

/// faer panics from here on where it is left to choose the number of threads.
#[test]
fn no_call_leaves_the_number_of_threads_open() {
    faer::disable_global_parallelism();
    let plate = Plate {
        length_m: 0.4,
        width_m: 0.3,
        thickness_m: 2e-3,
        youngs_modulus_pa: 2.1e11,
        poissons_ratio: 0.3,
        density_kg_m3: 7850.0,
        edges: [Edge::Clamped, Edge::Free, Edge::Free, Edge::Free],
        theory: PlateTheory::Kirchhoff,
    };
    assert_eq!(plate.modes(20).unwrap().omega_rad_s().len(), 20);
    assert!(plate.static_compliance(0.3, 0.2).unwrap() > 0.0);
    let bar = RectangularSegment {
        youngs_modulus_pa: 2.1e11,
        density_kg_m3: 7850.0,
        length_m: 1.0,
        width_m: 0.01,
        thickness_m: 0.01,
    };
    let beam = Beam { segments: vec![bar.into()], ends: [End::Clamped, End::Free] };
    assert_eq!(fem::Model::new(&beam, 20).unwrap().modes().unwrap().omega_rad_s().len(), 40);
    assert_eq!(beam.remainder(0.7, 5, 4).unwrap().len(), 4);
    assert_eq!(beam.remainder_at(&[0.4, 0.7], 5).unwrap().len(), 2);
}
