//! Computes the modes of a stepped cantilever twenty times, for callgrind. See docs/performance-other.md.
//!
//! Usage: `modes_cost COUNT [timoshenko]`; the default is 500.

use beam_modes::{Beam, BeamSystem, End, Segment, ShearSection};
use std::hint::black_box;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count: usize = std::env::args().nth(1).map_or(Ok(500), |word| word.parse())?;
    let segment = |flexural_rigidity_n_m2, mass_per_length_kg_m| Segment {
        length_m: 0.5,
        flexural_rigidity_n_m2,
        mass_per_length_kg_m,
    };
    let beam = Beam { segments: vec![segment(1.0, 1.0), segment(0.2, 0.5)], ends: [End::Clamped, End::Free] };
    let mut beam = BeamSystem::from(beam);
    if std::env::args().nth(2).is_some_and(|word| word == "timoshenko") {
        let shear = [(400.0, 1e-3), (200.0, 5e-4)]
            .map(|(shear_rigidity_n, rotary_inertia_kg_m)| ShearSection { shear_rigidity_n, rotary_inertia_kg_m });
        beam.shear = Some(shear.to_vec());
    }
    let mut best = f64::INFINITY;
    let mut last = None;
    for _ in 0..20 {
        let clock = Instant::now();
        last = black_box(&beam).modes(count)?.omega_rad_s().last().copied();
        best = best.min(clock.elapsed().as_secs_f64());
    }
    println!("{count} modes, the last at {last:?} rad/s, {:.1} us at best", 1e6 * best);
    Ok(())
}
