//! The first bending frequencies of a steel ruler clamped to a table, and where the third mode has its nodes.

use beam_modes::{Beam, End, RectangularSegment, Segment};

fn main() -> Result<(), beam_modes::InvalidInput> {
    let ruler = Segment::from(RectangularSegment {
        length_m: 0.3,
        youngs_modulus_pa: 2e11,
        density_kg_m3: 7800.0,
        width_m: 0.03,
        thickness_m: 0.001,
    });
    let modes = Beam { segments: vec![ruler], ends: [End::Clamped, End::Free] }.modes(5)?;
    for (k, omega) in modes.omega_rad_s().iter().enumerate() {
        println!("mode {}: {:.3} Hz", k + 1, omega / (2.0 * std::f64::consts::PI));
    }
    for i in 1..300 {
        let (left, right) = (1e-3 * f64::from(i), 1e-3 * f64::from(i + 1));
        if modes.shape(2, left)? * modes.shape(2, right)? < 0.0 {
            println!("node of mode 3 between {left:.3} m and {right:.3} m");
        }
    }
    Ok(())
}
