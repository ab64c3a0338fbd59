//! Impacts of a ball on a beam in its modes: the library of problems, and every solver on them.

mod definition;
mod diffsol;
mod dop853;
mod drive;
mod flight;
mod own;
mod reference;
mod system;

pub use definition::{Impact, Outcome};
pub use drive::{Flight, Integrator, follow};
pub use reference::{Reference, reference};
pub use system::{Equations, Phase};

use crate::measure::{Effort, Found, Row};
use beam_modes::{Beam, End, RectangularSegment, Segment};
use contact_models::{Body, Hertz, Hysteretic, Law, Viscous};
use std::f64::consts::PI;
use vibroimpact_sim::modal::{Striker, Structure};

const SIDE_M: f64 = 0.011323;
const YOUNGS_MODULUS_PA: f64 = 2e11;
const DENSITY_KG_M3: f64 = 7800.0;
/// (sqrt 5 - 1) / 2, the thesis's second location on the unit beam.
const GOLDEN_M: f64 = 0.618_033_988_749_894_9;
/// Number of modes that the program uses, with two remainder modes, if it chooses their number for the beam of chapter 3 with
/// Hertz contact at the default tolerance.
const CONVERGED: usize = 83;

/// A steel ball of this diameter at 1 m/s, and the Hertz stiffness of its contact.
fn ball(diameter_m: f64) -> Result<(Striker, f64), String> {
    let sphere = Body { youngs_modulus_pa: YOUNGS_MODULUS_PA, poissons_ratio: 0.3, radius_m: 0.5 * diameter_m };
    let hertz = Hertz::from_bodies(&sphere, &Body::flat(YOUNGS_MODULUS_PA, 0.3)).map_err(|e| e.to_string())?;
    let mass_kg = DENSITY_KG_M3 * PI / 6.0 * diameter_m.powi(3);
    Ok((Striker { mass_kg, speed_m_s: 1.0 }, hertz.stiffness_n_m1_5))
}

/// Steel beam of unit length; `thickness` is that of its halves relative to the thesis's side.
fn steel(ends: [End; 2], thickness: &[f64]) -> Beam {
    let length = 1.0 / thickness.len() as f64;
    let segment = |part: &f64| {
        Segment::from(RectangularSegment {
            length_m: length,
            youngs_modulus_pa: YOUNGS_MODULUS_PA,
            density_kg_m3: DENSITY_KG_M3,
            width_m: SIDE_M,
            thickness_m: part * SIDE_M,
        })
    };
    Beam { segments: thickness.iter().map(segment).collect(), ends }
}

/// The first modes of a beam at a location.
fn modes(beam: &Beam, modes: usize, damping_ratio: f64, x_m: f64) -> Result<Structure, String> {
    let seen = beam.modes(modes).and_then(|found| found.seen_from(x_m)).map_err(|e| e.to_string())?;
    Ok(Structure::from_modes(seen, damping_ratio))
}

/// The same with two remainder modes for all others and the same damping, as the program integrates a beam by default.
fn modes_and_remainder(beam: &Beam, kept: usize, damping_ratio: f64, x_m: f64) -> Result<Structure, String> {
    let mut structure = modes(beam, kept, damping_ratio, x_m)?;
    let remainder = beam.remainder(x_m, kept, 2).map_err(|e| e.to_string())?;
    structure.modes.extend(Structure::from_modes(remainder, damping_ratio).modes);
    Ok(structure)
}

/// Every impact of the library (thesis sections 3.3 and 4.2; steps and balls of chapter 4 as in `datasets`).
///
/// # Errors
/// A beam or a law that the crates reject.
pub fn library() -> Result<Vec<Impact>, String> {
    let text = |error: contact_models::InvalidInput| error.to_string();
    let hertz = |k: f64| Hertz::new(k).map(Law::from).map_err(text);
    let viscous = |k: f64| Viscous::new(k, 0.08).map(Law::from).map_err(text);
    // The stiffness of the first loading is that of Hertz.
    let hysteretic = |k: f64| {
        Hysteretic { stiffness_n_m1_5: k / 4.0, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m: 5e-8 }
            .validated()
            .map(Law::from)
            .map_err(text)
    };

    let pinned = steel([End::Pinned, End::Pinned], &[1.0]);
    let cantilever = [End::Clamped, End::Free];
    let chapter3 = modes(&pinned, 40, 0.02, GOLDEN_M)?;
    let converged = modes_and_remainder(&pinned, CONVERGED, 0.02, GOLDEN_M)?;
    let (ball3, k3) = ball(0.03)?;
    let slender = modes(&steel(cantilever, &[1.0]), 40, 0.02, 0.75)?;
    let (large, k_large) = ball(0.053)?;
    let stepped = modes(&steel(cantilever, &[1.0, 0.5]), 40, 0.02, 0.75)?;
    let (middle, k_middle) = ball(0.033)?;
    let impact = |name, about, structure: &Structure, striker, law| Impact {
        name,
        about,
        structure: structure.clone(),
        striker,
        law,
    };
    Ok(vec![
        impact(
            "pinned-hertz",
            "The damped pinned beam of chapter 3, 40 modes, Hertz's contact",
            &chapter3,
            ball3,
            hertz(k3)?,
        ),
        impact(
            "pinned-viscous",
            "The damped pinned beam of chapter 3, 40 modes, viscous contact",
            &chapter3,
            ball3,
            viscous(k3)?,
        ),
        impact(
            "pinned-hysteretic",
            "The damped pinned beam of chapter 3, 40 modes, hysteretic contact",
            &chapter3,
            ball3,
            hysteretic(k3)?,
        ),
        impact(
            "pinned-undamped",
            "The undamped pinned beam of chapter 3, 25 modes, struck at 0.4 of its length, Hertz's contact (it amplifies errors)",
            &modes(&pinned, 25, 0.0, 0.4)?,
            ball3,
            hertz(k3)?,
        ),
        impact(
            "cantilever-hertz",
            "The cantilever of chapter 4, a ball of 53 mm, Hertz's contact",
            &slender,
            large,
            hertz(k_large)?,
        ),
        impact(
            "cantilever-viscous",
            "The cantilever of chapter 4, a ball of 53 mm, viscous contact",
            &slender,
            large,
            viscous(k_large)?,
        ),
        impact(
            "stepped-hertz",
            "The stepped cantilever of chapter 4, a ball of 33 mm, Hertz's contact",
            &stepped,
            middle,
            hertz(k_middle)?,
        ),
        impact(
            "stepped-hysteretic",
            "The stepped cantilever of chapter 4, a ball of 33 mm, hysteretic contact",
            &stepped,
            middle,
            hysteretic(k_middle)?,
        ),
        impact(
            "remainder-hertz",
            "The damped pinned beam of chapter 3, 83 modes and two remainder modes for all others, Hertz's contact",
            &converged,
            ball3,
            hertz(k3)?,
        ),
        impact(
            "remainder-viscous",
            "The damped pinned beam of chapter 3, 83 modes and two remainder modes for all others, viscous contact",
            &converged,
            ball3,
            viscous(k3)?,
        ),
        impact(
            "remainder-hysteretic",
            "The damped pinned beam of chapter 3, 83 modes and two remainder modes for all others, hysteretic contact",
            &converged,
            ball3,
            hysteretic(k3)?,
        ),
    ])
}

/// Every solver on one impact.
///
/// # Errors
/// An impact without a reference.
pub fn rows(impact: &Impact, effort: &Effort) -> Result<Vec<Row>, String> {
    let reference = reference(impact.name)?;
    let judge = |outcome: Outcome, cost: u64| Found { cost, errors: outcome.errors(&reference.outcome) };
    let mut rows = own::rows(impact, effort, judge);
    for flight in [Flight::Integrated, Flight::Exact] {
        rows.extend(dop853::rows(impact, flight, reference.end_s(), effort, judge));
        rows.extend(diffsol::rows(impact, flight, reference.end_s(), effort, judge));
    }
    Ok(rows)
}
