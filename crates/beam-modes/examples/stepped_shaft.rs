//! The first modes of a stepped cantilever, compared with a finite-element model, and the share of the static compliance of
//! each of them.
//!
//! `cargo run --release -p beam-modes --example stepped_shaft`

use beam_modes::{Beam, End, InvalidInput, RectangularSegment, Segment, fem};

fn main() -> Result<(), InvalidInput> {
    let side_m = 0.0113;
    let segment = |length_m, thickness_m| {
        Segment::from(RectangularSegment {
            length_m,
            youngs_modulus_pa: 2e11,
            density_kg_m3: 7800.0,
            width_m: side_m,
            thickness_m,
        })
    };
    let beam =
        Beam { segments: vec![segment(0.5, side_m), segment(0.5, 0.5 * side_m)], ends: [End::Clamped, End::Free] };
    let modes = beam.modes(8)?;
    let check = fem::Model::new(&beam, 40)?.modes()?;
    let elements = check.omega_rad_s();
    let tip_m = modes.length_m();
    let whole = beam.static_compliance(tip_m)?;
    println!("{:>4} {:>14} {:>14} {:>12} {:>12}", "mode", "omega rad/s", "elements", "phi(tip)", "compliance");
    for (k, omega) in modes.omega_rad_s().iter().enumerate() {
        let shape = modes.shape(k, tip_m)?;
        let share = (shape / omega).powi(2) / whole;
        println!("{:>4} {omega:>14.6} {:>14.6} {shape:>12.6} {:>10.4} %", k + 1, elements[k], 100.0 * share);
    }
    println!("static compliance at the tip {whole:.6e} m/N");
    Ok(())
}
