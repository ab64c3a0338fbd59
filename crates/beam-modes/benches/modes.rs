//! Time to compute modes: uniform beams for an impact, a stepped beam with many modes, a taper of many steps, plates by Ritz's
//! method.

use beam_modes::{Beam, BeamSystem, Edge, End, Plate, PlateTheory, Segment, ShearSection};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn segment(length_m: f64, flexural_rigidity_n_m2: f64, mass_per_length_kg_m: f64) -> Segment {
    Segment { length_m, flexural_rigidity_n_m2, mass_per_length_kg_m }
}

fn modes(c: &mut Criterion) {
    let uniform = Beam { segments: vec![segment(1.0, 273.0, 1.0)], ends: [End::Pinned, End::Pinned] };
    let stepped =
        Beam { segments: vec![segment(0.5, 273.0, 1.0), segment(0.5, 34.2, 0.5)], ends: [End::Clamped, End::Free] };
    let taper = Beam {
        segments: (0..80)
            .map(|i| 1.0 - 0.75 * (f64::from(i) + 0.5) / 80.0)
            .map(|h| segment(0.0125, h.powi(3), h))
            .collect(),
        ends: [End::Clamped, End::Free],
    };
    for (name, beam, count) in [
        ("uniform", &uniform, 40),
        ("uniform", &uniform, 200),
        ("stepped", &stepped, 40),
        ("stepped", &stepped, 500),
        ("taper", &taper, 40),
    ] {
        c.bench_function(&format!("{name}, {count} modes"), |b| b.iter(|| black_box(beam).modes(black_box(count))));
    }
    // A beam forty times as long as it is thick.
    let shear = [(1.4e5, 5e-4), (7e4, 2.5e-4)]
        .map(|(shear_rigidity_n, rotary_inertia_kg_m)| ShearSection { shear_rigidity_n, rotary_inertia_kg_m });
    let timoshenko = BeamSystem { shear: Some(shear.to_vec()), ..BeamSystem::from(stepped.clone()) };
    for count in [40, 500] {
        let name = format!("stepped, Timoshenko, {count} modes");
        c.bench_function(&name, |b| b.iter(|| black_box(&timoshenko).modes(black_box(count))));
    }
    let (clamped, free, pinned) = (Edge::Clamped, Edge::Free, Edge::Pinned);
    for (symmetry, edges) in [
        ("without symmetry", [clamped, free, free, pinned]),
        ("one line of symmetry", [clamped, free, free, free]),
        ("two lines of symmetry", [free, free, free, free]),
    ] {
        let plate = Plate {
            length_m: 0.4,
            width_m: 0.3,
            thickness_m: 0.005,
            youngs_modulus_pa: 2e11,
            poissons_ratio: 0.3,
            density_kg_m3: 7800.0,
            edges,
            theory: PlateTheory::Kirchhoff,
        };
        let name = format!("plate {symmetry}, 400 modes");
        c.bench_function(&name, |b| b.iter(|| black_box(&plate).modes(black_box(400))));
    }
    let found = uniform.modes(40).unwrap();
    c.bench_function("40 shapes at one location", |b| b.iter(|| found.shapes_at(black_box(0.4))));
}

criterion_group!(benches, modes);
criterion_main!(benches);
