//! The deflection of a beam or a string along its whole length during an impact, for animations.
//!
//! With the mass-normalised shapes `phi_k(x)` and the amplitudes `q_k(t)` of the retained modes,
//!
//! ```text
//! w(x, t) = sum_k phi_k(x) q_k(t)                                                      (1)
//! ```
//!
//! Remainder modes represent the local response of all others at the location of impact. They have no shape elsewhere and
//! are left out, so at that location (1) lacks a part of the displacement, which is small compared with the whole.

use serde::Serialize;

use crate::scene::{InvalidInput, MOST_MODES, Scene, Structure};
use crate::simulate::Resolved;

/// The motion of structure and striker at some times. Displacements are positive away from the structure, towards the side from which
/// the striker comes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Deflection {
    /// Locations along the structure (m).
    pub location_m: Vec<f64>,
    /// Times (s).
    pub time_s: Vec<f64>,
    /// Displacement of the structure (m): for each time one number for each location.
    pub structure_m: Vec<Vec<f64>>,
    /// Displacement of the striker's surface (m), from the surface of the undeformed structure.
    pub striker_m: Vec<f64>,
    /// Contact force at these times (N), between which whole contacts may lie.
    pub force_n: Vec<f64>,
}

impl Resolved {
    /// The deflection at equal intervals of the length and, until `until_s`, at equal intervals of time. `scene` is the one that
    /// was solved, [`crate::simulate::Simulation::scene`]. `None` for a structure that is neither a beam nor a string.
    ///
    /// # Errors
    /// Errors of the scene, which the scene of this result cannot have.
    ///
    /// ```
    /// use vibroimpact::Scene;
    /// use vibroimpact::simulate::Simulation;
    ///
    /// let scene = Scene::from_toml(r#"
    ///     location_m = 0.5
    ///     modes = 20
    ///     structure = { kind = "string", length_m = 1, tension_n = 100, mass_per_length_kg_m = 0.01, damping_ratio = 0.01 }
    ///     striker = { mass_kg = 0.001, speed_m_s = 1 }
    ///     contact = { law = "hertz", stiffness_n_m1_5 = 1e7 }
    /// "#)?;
    /// let Simulation::Modal(found) = scene.simulate()? else { panic!("a string has modes") };
    /// let deflection = found.deflection(&scene, 0.001, [10, 100])?.expect("a string has a length");
    /// // before anything has moved, and pushed in later
    /// assert_eq!(deflection.structure_m[0][5], 0.0);
    /// assert!(deflection.structure_m[50][5] < 0.0);
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn deflection(
        &self,
        scene: &Scene,
        until_s: f64,
        [pieces, intervals]: [usize; 2],
    ) -> Result<Option<Deflection>, InvalidInput> {
        let kept: Vec<f64> =
            self.impact.structure.modes[..self.impact.kept_modes()].iter().map(|mode| mode.omega_rad_s).collect();
        let Some(Shapes { location_m, shapes }) = shapes_along(scene, &kept, pieces.max(1))? else { return Ok(None) };
        let intervals = intervals.max(1);
        let time_s: Vec<f64> = (0..=intervals).map(|i| until_s * i as f64 / intervals as f64).collect();
        let samples: Vec<_> = time_s.iter().map(|time_s| self.history.at(*time_s)).collect();
        let at = |time_s: &f64| -> Vec<f64> {
            let amplitudes = self.history.amplitudes(*time_s);
            // the sum ends before the remainder modes, for which no shape is listed
            shapes.iter().map(|shape| shape.iter().zip(&amplitudes).map(|(phi, q)| phi * q).sum()).collect()
        };
        Ok(Some(Deflection {
            structure_m: time_s.iter().map(at).collect(),
            striker_m: samples.iter().map(|sample| sample.striker_surface_m()).collect(),
            force_n: samples.iter().map(|sample| sample.force_n).collect(),
            location_m,
            time_s,
        }))
    }
}

/// Frequencies whose relative difference is smaller belong to the same mode.
const SAME: f64 = 1e-9;

/// Locations along a structure (m), and the shapes at each.
struct Shapes {
    location_m: Vec<f64>,
    shapes: Vec<Vec<f64>>,
}

/// Modes of a beam or string: frequencies (rad/s), its length (m), and the shapes at any location.
struct Line {
    omega_rad_s: Vec<f64>,
    length_m: f64,
    shapes_at: Box<dyn Fn(f64) -> Result<Vec<f64>, beam_modes::InvalidInput>>,
}

/// Locations along a beam or string, and for each the shapes of the modes with the ascending frequencies `kept`. Modes that the
/// location of impact does not excite may be missing between them.
fn shapes_along(scene: &Scene, kept: &[f64], pieces: usize) -> Result<Option<Shapes>, InvalidInput> {
    let highest = kept.last().copied().unwrap_or(0.0) * (1.0 - SAME);
    let mut count = kept.len();
    loop {
        let Some(Line { omega_rad_s: omega, length_m, shapes_at }) = modes(scene, count)? else { return Ok(None) };
        if omega.last().is_some_and(|last| *last < highest) && count < MOST_MODES {
            count = (2 * count).min(MOST_MODES);
            continue;
        }
        let mut numbers = 0..omega.len();
        let number = |kept: &f64| numbers.find(|&k| omega[k] >= kept * (1.0 - SAME));
        let numbers: Vec<usize> = kept.iter().filter_map(number).collect();
        let location_m: Vec<f64> = (0..=pieces).map(|i| length_m * i as f64 / pieces as f64).collect();
        let at = |x: &f64| -> Result<Vec<f64>, InvalidInput> {
            let all = shapes_at(*x).map_err(in_structure)?;
            Ok(numbers.iter().map(|&k| all[k]).collect())
        };
        let shapes = location_m.iter().map(at).collect::<Result<_, _>>()?;
        return Ok(Some(Shapes { location_m, shapes }));
    }
}

/// The first `count` modes of a beam or string; `None` for other structures.
fn modes(scene: &Scene, count: usize) -> Result<Option<Line>, InvalidInput> {
    Ok(match &scene.structure {
        Structure::Beam(beam) => {
            let system = beam.to_system().map_err(|fault| fault.within("structure"))?;
            let modes = system.modes(count).map_err(in_structure)?;
            Some(Line {
                omega_rad_s: modes.omega_rad_s().to_vec(),
                length_m: modes.length_m(),
                shapes_at: Box::new(move |x| modes.shapes_at(x)),
            })
        }
        Structure::TautString(string) => {
            let modes = string.to_taut_string().modes(count).map_err(in_structure)?;
            Some(Line {
                omega_rad_s: modes.omega_rad_s().to_vec(),
                length_m: string.length_m,
                shapes_at: Box::new(move |x| modes.shapes_at(x)),
            })
        }
        _ => None,
    })
}

fn in_structure(fault: InvalidInput) -> InvalidInput {
    fault.within("structure")
}
