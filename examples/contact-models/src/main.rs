//! A steel ball thrown at a wall by a simple velocity-Verlet loop, with the force from a contact law.

use contact_models::{ContactLaw, Law, Memory, Viscous};

fn main() -> Result<(), contact_models::InvalidInput> {
    let (mass_kg, speed_m_s) = (0.11, 1.0);
    let law = Law::from(Viscous::with_restitution(1.8e10, 0.9, speed_m_s)?);
    let branch = law.touch(&Memory::default(), speed_m_s);
    let (step_s, mut xi_m, mut rate_m_s, mut steps) = (1e-9, 0.0, speed_m_s, 0);
    while xi_m >= 0.0 && steps < 1_000_000 {
        let middle_m_s = rate_m_s - 0.5 * step_s * law.force(&branch, xi_m, rate_m_s).force_n / mass_kg;
        xi_m += step_s * middle_m_s;
        rate_m_s = middle_m_s - 0.5 * step_s * law.force(&branch, xi_m, middle_m_s).force_n / mass_kg;
        steps += 1;
    }
    println!("contact of {:.2} us, rebound at {:.5} m/s", 1e6 * step_s * f64::from(steps), -rate_m_s);
    println!("by quadrature {:.5}", law.wall_restitution(mass_kg, speed_m_s)?);
    Ok(())
}
