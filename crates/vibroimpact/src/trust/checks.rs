//! The individual checks.

use std::f64::consts::TAU;

use super::check::Check;
use super::course::{Course, Pulse};
use super::section::Section;
use crate::scene::{Contact, InvalidInput, Scene, Structure};
use crate::text::{quantity, small};

/// The relevant modes take up this share of the energy.
const MATTERS: f64 = 0.99;
const SPECTRUM: [f64; 2] = [0.01, 0.1];
const PRESSURE: [f64; 2] = [1.6, 4.5];
const CONTACT_RADIUS: [f64; 2] = [0.1, 0.3];
const INDENTATION: [f64; 2] = [0.2, 0.5];
const EDGE: [f64; 2] = [1.0, 0.25];
const BALL: [f64; 2] = [5.0, 2.0];
const GRAVITY: [f64; 2] = [0.01, 0.1];
/// Acceleration of gravity (m/s^2).
const GRAVITY_M_S2: f64 = 9.80665;
/// `omega R / c_t` of the lowest mode of a ball that an impact excites.
const OBLONG: f64 = 2.64;

/// Checks of bending waves against the theory of bending.
pub(super) fn waves(course: &Course, section: Option<&Section>) -> Vec<Check> {
    let Some(section) = section.filter(|_| course.moves) else { return Vec::new() };
    let limits = section.limits();
    let mut found = Vec::new();
    if let Some(omega) = course.fastest_rad_s(MATTERS) {
        let half_m = section.half_wavelength_m(omega);
        let says = format!(
            "the fastest relevant mode, at {}, has a half wavelength of {}, {} times the thickness; {} holds from {} on",
            quantity(omega / TAU, "Hz"),
            quantity(half_m, "m"),
            small(half_m / section.thickness_m),
            section.theory(),
            limits[0]
        );
        found.push(Check::new("wavelength", half_m / section.thickness_m, limits, says));
    }
    let omega = section.frequency_rad_s(limits[0]);
    if let Some(share) = course.share_beyond(omega) {
        let says = format!(
            "{} % of the contact force's spectrum lies above {}, the limit of {}",
            small(100.0 * share),
            quantity(omega / TAU, "Hz"),
            section.theory()
        );
        found.push(Check::new("spectrum", share, SPECTRUM, says));
    }
    found
}

/// Checks of contact, ball and gravity.
pub(super) fn contact(scene: &Scene, course: &Course, section: Option<&Section>) -> Result<Vec<Check>, InvalidInput> {
    let mut found = Vec::new();
    let Some(hardest) = course.pulses.first() else { return Ok(found) };
    let radius_m = match &scene.structure {
        Structure::DroppedRod(rod) => Some(0.5 * rod.diameter_m),
        _ => scene.striker.radius_m,
    };
    if let Some(radius_m) = radius_m.filter(|_| scene.contact.is_hertzian()) {
        of_hertz(scene, course, section, radius_m, &mut found);
    }
    found.extend(ball(scene, hardest));
    found.extend(gravity(scene, course));
    Ok(found)
}

/// Hertz's circle of contact, Eq. (2).
fn of_hertz(scene: &Scene, course: &Course, section: Option<&Section>, radius_m: f64, found: &mut Vec<Check>) {
    let force_n = course.pulses.iter().map(|pulse| pulse.peak_force_n).fold(0.0, f64::max);
    let depth_m = course.pulses.iter().map(|pulse| pulse.peak_compression_m).fold(0.0, f64::max);
    let contact_m = (radius_m * depth_m).sqrt();
    if contact_m <= 0.0 {
        return;
    }
    // an elastoplastic law includes yielding
    let elastic = !matches!(scene.contact, Contact::Elastoplastic { .. });
    if let Some(strength_pa) = scene.yield_strength_pa.filter(|_| elastic) {
        let pressure_pa = 1.5 * force_n / (std::f64::consts::PI * contact_m * contact_m);
        let ratio = pressure_pa / strength_pa;
        let says = format!(
            "the greatest pressure is {}, {} times the yield strength; yielding begins at 1.6 times, and is full at 4.5",
            quantity(pressure_pa, "Pa"),
            small(ratio)
        );
        found.push(Check::new("pressure", ratio, PRESSURE, says));
    }
    let on_ball = format!(
        "the contact grows to a radius of {}, {} of the radius of curvature",
        quantity(contact_m, "m"),
        small(contact_m / radius_m)
    );
    found.push(Check::new("contact_radius", contact_m / radius_m, CONTACT_RADIUS, on_ball));
    if let Some(section) = section {
        let share = contact_m / section.thickness_m;
        let says = format!("the radius of contact is {} of the thickness of the structure", small(share));
        found.push(Check::new("indentation", share, INDENTATION, says));
        if let Some(clearance_m) = section.clearance_m {
            let ratio = clearance_m / section.thickness_m;
            let says = format!(
                "the nearest end, edge, support or step is {}, {} thicknesses, away; beyond one thickness the contact sees a \
                 half-space",
                quantity(clearance_m, "m"),
                small(ratio)
            );
            found.push(Check::new("edge", ratio, EDGE, says));
        }
    }
}

/// The ball's own vibration, where it is a solid ball of known material.
fn ball(scene: &Scene, hardest: &Pulse) -> Option<Check> {
    let (radius_m, density) = (scene.striker.radius_m?, scene.striker.density_kg_m3?);
    let [modulus, ratio] = scene.contact.materials()?.of_striker()?;
    let shear_speed = (0.5 * modulus / ((1.0 + ratio) * density)).sqrt();
    let period_s = TAU * radius_m / (OBLONG * shear_speed);
    let periods = hardest.duration_s / period_s;
    let says = format!(
        "the hardest contact lasts {}, {} periods of the ball's slowest vibration",
        quantity(hardest.duration_s, "s"),
        small(periods)
    );
    periods.is_finite().then(|| Check::new("ball", periods, BALL, says))
}

/// The speed that a ball which falls on the structure gains during the interaction.
fn gravity(scene: &Scene, course: &Course) -> Option<Check> {
    let (time_s, speed) = (course.interaction_s?, scene.striker.speed_m_s);
    if scene.falls() {
        return None;
    }
    let share = GRAVITY_M_S2 * time_s / speed;
    let says = format!(
        "in {} a body falls {} and gains {} % of the speed of impact, if it falls on the structure; the restitution \
         leaves gravity out, unless the scene states gravity_m_s2",
        quantity(time_s, "s"),
        quantity(0.5 * GRAVITY_M_S2 * time_s * time_s, "m"),
        small(100.0 * share)
    );
    (speed > 0.0 && share.is_finite()).then(|| Check::new("gravity", share, GRAVITY, says))
}
