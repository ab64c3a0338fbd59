//! Participation of the modes in a uniform acceleration, compared with quadrature, the mass, and statics.

use beam_modes::{
    Attachment, Beam, BeamSystem, Edge, End, Modes, Plate, PlateTheory, Rod, RodEnd, RodSegment, Segment, TautString,
};

fn stepped(ends: [End; 2]) -> Beam {
    let segment = |length_m, flexural_rigidity_n_m2, mass_per_length_kg_m| Segment {
        length_m,
        flexural_rigidity_n_m2,
        mass_per_length_kg_m,
    };
    Beam { segments: vec![segment(0.3, 274.0, 1.0), segment(0.05, 900.0, 2.5), segment(0.65, 34.2, 0.5)], ends }
}

/// `int m phi dx` by Simpson's rule on each segment.
fn by_quadrature(modes: &Modes, k: usize, pieces: &[(f64, f64)]) -> f64 {
    const PANELS: usize = 4000;
    let (mut sum, mut start) = (0.0, 0.0);
    for &(length, mass) in pieces {
        let shape = |i: usize| modes.shape(k, start + length * i as f64 / PANELS as f64).unwrap();
        let weight = |i: usize| if i == 0 || i == PANELS { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
        sum += mass * length / (3 * PANELS) as f64 * (0..=PANELS).map(|i| weight(i) * shape(i)).sum::<f64>();
        start += length;
    }
    sum
}

#[test]
fn participation_is_the_integral_of_mass_times_shape() {
    for ends in [[End::Clamped, End::Free], [End::Pinned, End::Clamped], [End::Free, End::Free]] {
        let beam = stepped(ends);
        let modes = beam.modes(12).unwrap();
        let pieces: Vec<(f64, f64)> = beam.segments.iter().map(|s| (s.length_m, s.mass_per_length_kg_m)).collect();
        for (k, found) in modes.participation_kg0_5().into_iter().enumerate() {
            let expected = by_quadrature(&modes, k, &pieces);
            assert!((found - expected).abs() < 1e-9, "{ends:?} mode {k}: {found} {expected}");
        }
    }
}

#[test]
fn squares_of_the_participations_add_up_to_the_mass() {
    // For a free beam in its rigid-body modes alone.
    let free = stepped([End::Free, End::Free]);
    let participation = free.modes(30).unwrap().participation_kg0_5();
    let rigid: f64 = participation[..2].iter().map(|p| p * p).sum();
    assert!((rigid / free.mass_kg() - 1.0).abs() < 1e-12);
    assert!(participation[2..].iter().all(|p| p.abs() < 1e-10), "{participation:?}");
    // For a constrained beam it converges slowly, as 1/k, because the part close to a clamp moves in high modes only.
    let held = stepped([End::Clamped, End::Free]);
    let sum: f64 = held.modes(400).unwrap().participation_kg0_5().iter().map(|p| p * p).sum();
    let missing = 1.0 - sum / held.mass_kg();
    assert!(missing > 0.0 && missing < 2e-3, "{missing}");
}

#[test]
fn the_modal_deflection_under_the_weight_is_that_of_statics() {
    // Pinned beam under its weight: 5 m g L^4 / (384 EI) at mid-span.
    let segment = Segment { length_m: 2.0, flexural_rigidity_n_m2: 300.0, mass_per_length_kg_m: 1.5 };
    let modes = Beam { segments: vec![segment], ends: [End::Pinned, End::Pinned] }.modes(200).unwrap();
    let shapes = modes.shapes_at(1.0).unwrap();
    let sag = |omega: &[f64], shapes: &[f64], participation: &[f64]| -> f64 {
        (0..omega.len()).map(|k| 9.81 * shapes[k] * participation[k] / (omega[k] * omega[k])).sum()
    };
    let found = sag(modes.omega_rad_s(), &shapes, &modes.participation_kg0_5());
    let expected = 5.0 * 1.5 * 9.81 * 2f64.powi(4) / (384.0 * 300.0);
    assert!((found / expected - 1.0).abs() < 1e-11, "{found} {expected}");
    // Rod suspended at one end: m g L^2 / (2 EA) at the other.
    let segment = RodSegment { length_m: 3.0, axial_rigidity_n: 1e6, mass_per_length_kg_m: 4.0 };
    let modes = Rod { segments: vec![segment], ends: [RodEnd::Fixed, RodEnd::Free] }.modes(2000).unwrap();
    let found = sag(modes.omega_rad_s(), &modes.shapes_at(3.0).unwrap(), &modes.participation_kg0_5());
    assert!((found / (4.0 * 9.81 * 9.0 / 2e6) - 1.0).abs() < 1e-6);
}

/// Modal deflection at a location under the weight, with `g = 9.81`.
fn sag(omega: &[f64], shapes: &[f64], participation: &[f64]) -> f64 {
    (0..omega.len())
        .filter(|&k| omega[k] > 0.0)
        .map(|k| 9.81 * shapes[k] * participation[k] / (omega[k] * omega[k]))
        .sum()
}

#[test]
fn attachments_of_a_beam_have_weight() {
    // Pinned beam with a mass M at mid-span: (5 m L^4/384 + M L^3/48) g/EI.
    let segment = Segment { length_m: 2.0, flexural_rigidity_n_m2: 300.0, mass_per_length_kg_m: 1.5 };
    let beam = Beam { segments: vec![segment], ends: [End::Pinned, End::Pinned] };
    let mass = Attachment { location_m: 1.0, mass_kg: 7.0, rotary_inertia_kg_m2: 0.1, ..Attachment::default() };
    let system = BeamSystem { attachments: vec![mass], ..BeamSystem::from(beam) };
    let modes = system.modes(200).unwrap();
    let found = sag(modes.omega_rad_s(), &modes.shapes_at(1.0).unwrap(), &modes.participation_kg0_5());
    let expected = 9.81 / 300.0 * (5.0 * 1.5 * 16.0 / 384.0 + 7.0 * 8.0 / 48.0);
    assert!((found / expected - 1.0).abs() < 1e-7, "{found} {expected}");
}

#[test]
fn strings_and_plates_deflect_under_their_weight() {
    // String: m g L^2/(8 T) at the middle.
    let string =
        TautString { length_m: 0.6, tension_n: 700.0, mass_per_length_kg_m: 0.006, flexural_rigidity_n_m2: 0.0 };
    let modes = string.modes(400).unwrap();
    let found = sag(modes.omega_rad_s(), &modes.shapes_at(0.3).unwrap(), &modes.participation_kg0_5());
    let expected = 0.006 * 9.81 * 0.36 / (8.0 * 700.0);
    assert!((found / expected - 1.0).abs() < 1e-7, "{found} {expected}");
    // Square plates under q = rho h g: the centre by Timoshenko and Woinowsky-Krieger, tables 8 and 35, in q a^4/D.
    let rigidity = 2e11 * 0.01f64.powi(3) / (12.0 * (1.0 - 0.09));
    for (edges, expected) in [([Edge::Pinned; 4], 0.00406235), ([Edge::Clamped; 4], 0.00126532)] {
        let plate = Plate {
            length_m: 1.0,
            width_m: 1.0,
            thickness_m: 0.01,
            youngs_modulus_pa: 2e11,
            poissons_ratio: 0.3,
            density_kg_m3: 7800.0,
            edges,
            theory: PlateTheory::Kirchhoff,
        };
        let modes = plate.modes(150).unwrap();
        let found = sag(modes.omega_rad_s(), &modes.shapes_at(0.5, 0.5).unwrap(), &modes.participation_kg0_5());
        let coefficient = found * rigidity / (7800.0 * 0.01 * 9.81);
        assert!((coefficient / expected - 1.0).abs() < 2e-4, "{edges:?}: {coefficient} {expected}");
    }
    // The mass of a free plate belongs to its translation alone.
    let free = Plate {
        length_m: 1.0,
        width_m: 0.7,
        thickness_m: 0.01,
        youngs_modulus_pa: 2e11,
        poissons_ratio: 0.3,
        density_kg_m3: 7800.0,
        edges: [Edge::Free; 4],
        theory: PlateTheory::Kirchhoff,
    };
    let participation = free.modes(40).unwrap().participation_kg0_5();
    let rigid: f64 = participation[..3].iter().map(|p| p * p).sum();
    assert!((rigid / (7800.0 * 0.007) - 1.0).abs() < 1e-10, "{rigid}");
    assert!(participation[3..].iter().all(|p| p.abs() < 1e-7), "{participation:?}");
}
