//! The first contact on an infinite beam by Timoshenko's theory.
//!
//! A point of an infinite beam takes up energy at every frequency. A force `e^(i omega t)` moves it with the mobility
//! `Y(omega)`, and its response to an impulse,
//!
//! ```text
//! w(t) = (2/pi) int_0^inf Re Y(omega) sin(omega t)/omega d omega,                                                 (3)
//! ```
//!
//! is that of a continuum of modes with `phi^2 d omega = (2/pi) Re Y d omega`. From the waves of a Timoshenko beam, with shear
//! rigidity `S`, rotary inertia `J`, `a = J/EI + m/S`, `u = S - J omega^2`, `g = sqrt(|u| S EI/m)/omega`, `l = |u|/g`,
//!
//! ```text
//! Re Y = omega (EI q + g p)/(2 S EI r),   r = |p + iq|^2,  (p + iq)^2 = -a omega^2 + 2il,     u > 0,              (4)
//! Re Y = omega (EI + g)/(2 S EI sqrt(a omega^2 + 2l)),                                        u < 0,
//! ```
//!
//! which is Euler-Bernoulli's `omega/(4 EI k^3)`, `k^4 = m omega^2/EI`, for slow motions, and `1/(2 sqrt(S m))`, an impedance, for
//! fast ones: until about `sqrt(EI m)/S` after the first touch the beam responds like a string with the tension `S`.

use std::f64::consts::{FRAC_2_PI, PI};

use beam_modes::{Segment, ShearSection};
use vibroimpact_sim::infinite::Solution;
use vibroimpact_sim::modal::{Mode, Settings, Solver, Structure};

use super::check::Check;
use crate::infinite::Posed;
use crate::scene::{self, InvalidInput, Scene};
use crate::text::quantity;

/// Change of the speed at which the first contact ends, as a share of the speed of impact.
const EARLY_RESPONSE: [f64; 2] = [0.01, 0.05];
/// Number of modes up to the fastest that a contact excites, at equal steps of the wave number, like those of a finite beam from
/// whose ends waves return after five durations of the contact.
const MODES: usize = 96;
/// Frequency times duration of the fastest motion that a contact excites.
const FASTEST: f64 = 60.0;
/// Number of modes for all faster motion, at equal steps of the period.
const FASTER: usize = 12;
/// Accuracy of the contact.
const TOLERANCE: f64 = 1e-6;

/// `Re Y` of Eq. (4), s/kg.
fn mobility(bending: &Segment, shear: &ShearSection, omega: f64) -> f64 {
    let (rigidity, mass) = (bending.flexural_rigidity_n_m2, bending.mass_per_length_kg_m);
    let (s, j) = (shear.shear_rigidity_n, shear.rotary_inertia_kg_m);
    let square = omega * omega;
    let turned = (j / rigidity + mass / s) * square;
    let u = s - j * square;
    let g = (u.abs() * s * rigidity / mass).sqrt() / omega;
    let l = omega * (u.abs() * mass / (s * rigidity)).sqrt();
    if u > 0.0 {
        let r = turned.hypot(2.0 * l);
        // without the cancellation of `r - turned`
        let q = (0.5 * (r + turned)).sqrt();
        let p = l / q;
        omega * (rigidity * q + g * p) / (2.0 * s * rigidity * r)
    } else {
        omega * (rigidity + g) / (2.0 * s * rigidity * (turned + 2.0 * l).sqrt())
    }
}

/// The continuum of modes of Eq. (3) for a contact of this duration.
fn modes(re_y: impl Fn(f64) -> f64, duration_s: f64) -> Vec<Mode> {
    let mode = |omega_rad_s: f64, width: f64| {
        let shape = (FRAC_2_PI * re_y(omega_rad_s) * width).sqrt();
        Mode { omega_rad_s, damping_ratio: 0.0, shape }
    };
    let fastest = FASTEST / duration_s;
    let step = fastest.sqrt() / MODES as f64;
    let kept = (0..MODES).map(|i| {
        let x = step * (i as f64 + 0.5);
        mode(x * x, 2.0 * x * step)
    });
    let share = 1.0 / FASTER as f64;
    let faster = (0..FASTER).rev().map(|i| {
        let y = share * (i as f64 + 0.5);
        mode(fastest / y, fastest / (y * y) * share)
    });
    kept.chain(faster).collect()
}

/// Speed away from the beam after the first contact, over that of the impact; `None` if the contact does not end.
fn first_rebound_ratio(modes: Vec<Mode>, scene: &Scene) -> Result<Option<f64>, InvalidInput> {
    let Posed { striker, law, .. } = scene.posed_on_infinite()?;
    let settings =
        Settings { tolerance: TOLERANCE, estimate_uncertainty: false, max_sub_impacts: 1, ..Settings::default() };
    // numbers out of the range of the modal solver are not a reason to reject a scene
    let Ok(solver) = Solver::new(&Structure { modes }) else { return Ok(None) };
    let Ok(found) = solver.solve(&striker, &law, None, &settings) else { return Ok(None) };
    let momentum = striker.mass_kg * striker.speed_m_s;
    let ratio = found.sub_impacts.first().map(|contact| contact.impulse_n_s / momentum - 1.0);
    Ok(ratio.filter(|ratio| ratio.is_finite()))
}

/// The change of the first contact on an infinite beam by Timoshenko's theory, if the beam has the data of that theory.
pub(super) fn response(scene: &Scene, solution: &Solution, time_unit_s: f64) -> Result<Option<Check>, InvalidInput> {
    let scene::Structure::InfiniteBeam(beam) = &scene.structure else { return Ok(None) };
    let in_structure = |fault: InvalidInput| fault.within("structure");
    let (bending, shear) = (beam.section().map_err(in_structure)?, beam.shear().map_err(in_structure)?);
    let duration_s = solution.sub_impacts.first().and_then(|contact| contact.duration).map(|t| t * time_unit_s);
    let (Some(shear), Some(duration_s), Some(slender)) = (shear, duration_s, solution.first_rebound_ratio()) else {
        return Ok(None);
    };
    let modes = modes(|omega| mobility(&bending, &shear, omega), duration_s);
    let Some(thick) = first_rebound_ratio(modes, scene)? else { return Ok(None) };
    let early_s =
        0.5 * PI * (bending.flexural_rigidity_n_m2 * bending.mass_per_length_kg_m).sqrt() / shear.shear_rigidity_n;
    let change = (thick - slender).abs();
    let says = format!(
        "by Timoshenko's theory the striker leaves the first contact with {thick:.4} of its speed, not {slender:.4}: for the \
         first {} of {} a beam answers with an impedance",
        quantity(early_s, "s"),
        quantity(duration_s, "s")
    );
    Ok(Some(Check::new("early_response", change, EARLY_RESPONSE, says)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use beam_modes::RectangularSegment;
    use vibroimpact_sim::infinite;

    fn scene(radius_m: f64) -> Scene {
        let text = format!(
            r#"{{ "structure": {{ "kind": "infinite-beam", "youngs_modulus_pa": 2e11, "density_kg_m3": 7800,
                               "width_m": 0.02, "thickness_m": 0.02, "poissons_ratio": 0.3 }},
                 "striker": {{ "density_kg_m3": 7800, "radius_m": {radius_m}, "speed_m_s": 1 }},
                 "contact": {{ "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 }} }}"#
        );
        Scene::from_json(&text).unwrap()
    }

    fn bending() -> Segment {
        Segment::from(RectangularSegment {
            length_m: 1.0,
            youngs_modulus_pa: 2e11,
            density_kg_m3: 7800.0,
            width_m: 0.02,
            thickness_m: 0.02,
        })
    }

    fn thick() -> ShearSection {
        ShearSection { shear_rigidity_n: 2.67e7, rotary_inertia_kg_m: 1.04e-4 }
    }

    /// With Euler-Bernoulli's mobility the continuum of modes is the integral equation of the infinite beam.
    #[test]
    fn slender_modes_solve_the_integral_equation() {
        let (rigidity, mass) = (bending().flexural_rigidity_n_m2, bending().mass_per_length_kg_m);
        let slender = |omega: f64| omega / (4.0 * rigidity * (mass * omega * omega / rigidity).powf(0.75));
        for radius_m in [0.012, 0.016, 0.02, 0.024] {
            let scene = scene(radius_m);
            let groups = scene.infinite_impact().unwrap().groups().unwrap();
            let exact = infinite::solve(infinite::Structure::Beam, groups.s, &infinite::Settings::default()).unwrap();
            let duration_s = groups.time_s * exact.sub_impacts[0].duration.unwrap();
            let found = first_rebound_ratio(modes(slender, duration_s), &scene).unwrap().unwrap();
            let ratio = exact.first_rebound_ratio().unwrap();
            assert!((found - ratio).abs() < 1e-4, "{radius_m}: {found} {ratio}");
        }
    }

    #[test]
    fn the_mobility_is_slender_at_first_an_impedance_at_last_and_has_no_jump() {
        let (b, s) = (bending(), thick());
        let (rigidity, mass) = (b.flexural_rigidity_n_m2, b.mass_per_length_kg_m);
        let slow = 1e-3 * (s.shear_rigidity_n / s.rotary_inertia_kg_m).sqrt();
        let slender = slow / (4.0 * rigidity * (mass * slow * slow / rigidity).powf(0.75));
        assert!((mobility(&b, &s, slow) / slender - 1.0).abs() < 1e-2);
        let impedance = 2.0 * (s.shear_rigidity_n * mass).sqrt();
        assert!((mobility(&b, &s, 1e3 * slow / 1e-3) * impedance - 1.0).abs() < 1e-3);
        let cut_off = slow / 1e-3;
        let [below, at, above] = [1.0 - 1e-12, 1.0, 1.0 + 1e-12].map(|share| mobility(&b, &s, share * cut_off));
        assert!(at.is_finite() && (below / above - 1.0).abs() < 1e-4 && (at / above - 1.0).abs() < 1e-4);
    }
}
