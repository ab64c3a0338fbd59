//! Net restitution without integration in time: the law of energy minimisation under outward constraints
//! ([`emoc`], thesis chapters 6 to 8) for a scene, and its three parameters from data.
//!
//! Modes of the structure enter only with their shapes at the point of impact. Rigid-body modes are not vibrations. As in Eq. 8.9
//! they are combined with the striker into one effective mass, `1/m_eff = 1/m + sum phi_rigid^2`, so that the restitution is that
//! of the rigid-body motions, as in a resolved impact.

mod data;
mod fit;

pub use data::{Datum, in_table, parse, read};
pub use fit::{FitSummary, Observations, law};

use emoc::{Impact, Parameters, Site};
use serde::Serialize;
use vibroimpact_sim::modal::{Mode, Solver};

use crate::in_scene::in_scene;
use crate::model::Kept;
use crate::scene::require_positive;
use crate::scene::{InvalidInput, Scene, as_json, rigid_mobility, such_that};

/// Number of modes in the law if neither the caller nor the scene states it (thesis 7.2).
const LAW_MODES: usize = 50;

/// The object that `vibroimpact emoc` prints: the restitution and the dimensionless numbers behind it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NetRebound {
    /// Net restitution.
    pub restitution: f64,
    /// Moderated mass ratio `Z` (Eq. 7.3).
    pub z: f64,
    /// Restitution of the contact points (Eq. 7.5).
    pub ebar: f64,
    /// `beta_0` of the outward inequality (Eq. 7.6).
    pub beta0: f64,
    /// `beta_1` of the outward inequality (Eq. 7.7).
    pub beta1: f64,
    /// `basic` or `outward`: which term of the maximum is active.
    pub branch: &'static str,
    /// Number `N` of vibration modes in the law.
    pub modes: usize,
    /// Mass in the law (kg): the striker's, or less if the structure has rigid-body modes.
    pub mass_kg: f64,
    /// Moderated mass ratio coefficient (Eq. 7.4).
    pub mu0: f64,
    /// Modal richness coefficient (Eq. 7.6).
    pub alpha0: f64,
    /// Slow response coefficient (Eq. 7.7).
    pub alpha1: f64,
}

impl Scene {
    /// The net restitution by the three-parameter law, with the first `modes` modes (for `None` the scene's own
    /// number, or 50 if the scene does not state it).
    ///
    /// # Errors
    /// A value out of range in the scene or in the parameters, or more modes than a modal structure lists.
    ///
    /// ```
    /// use vibroimpact::{Scene, emoc::Parameters};
    ///
    /// let scene = Scene::from_json(r#"{
    ///     "structure": { "kind": "modal", "omega_rad_s": [100, 400], "shape_at_location": [1, 1] },
    ///     "striker": { "mass_kg": 1, "speed_m_s": 1 },
    ///     "contact": { "law": "hertz", "stiffness_n_m1_5": 1e10 }
    /// }"#)?;
    /// let rebound = scene.emoc(&Parameters::default(), None)?;
    /// assert_eq!((rebound.z, rebound.branch), (2.0, "outward"));
    /// // ebar = 5/7 at Z = 2; beta_0 = beta_1 = 1/2
    /// assert!((rebound.restitution - 5.0 / 7.0 * 1.0 / 1.5).abs() < 1e-15);
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn emoc(&self, parameters: &Parameters, modes: Option<usize>) -> Result<NetRebound, InvalidInput> {
        if self.start.is_some() {
            return Err(InvalidInput::new("start", "{...}", "left out, because the law is for a structure at rest"));
        }
        let allowed = "left out, because the law leaves gravity out";
        InvalidInput::unless(!self.falls(), "gravity_m_s2", self.gravity_m_s2, allowed)?;
        let modes = match modes {
            Some(count) => self.mode_shapes(count)?,
            None if crate::scene::chooses_modes(self) => self.mode_shapes(LAW_MODES)?,
            None => self.structure.modes(self.place(), self.modes.count())?,
        };
        require_vibration(&modes)?;
        // the law does not use contact, speed and frequencies, but a scene with an error in them is rejected nevertheless
        let resolved = self.impact_of(self.modes.count().or(Some(modes.len())), &mut Kept::default())?;
        Solver::new(&resolved.structure).map_err(in_scene)?;
        let impact = impact_on(&modes, resolved.striker.mass_kg).map_err(|fault| match fault.field.first() {
            Some("mass_kg") => fault.within("striker"),
            _ => fault,
        })?;
        let coefficients = parameters.coefficients(&impact).map_err(as_json)?;
        let rebound = parameters.rebound(&impact)?;
        Ok(NetRebound {
            restitution: rebound.restitution,
            z: impact.z,
            ebar: coefficients.ebar,
            beta0: coefficients.beta0,
            beta1: coefficients.beta1,
            branch: rebound.branch.as_str(),
            modes: vibrating(&modes).len(),
            mass_kg: impact.mass_kg,
            mu0: parameters.mu0,
            alpha0: parameters.alpha0,
            alpha1: parameters.alpha1,
        })
    }
}

/// The law divides by the number of vibration modes.
fn require_vibration(modes: &[Mode]) -> Result<(), InvalidInput> {
    if modes.iter().any(|mode| mode.omega_rad_s > 0.0) {
        return Ok(());
    }
    let allowed = "large enough for at least one mode that vibrates; rigid-body modes do not count";
    Err(InvalidInput::new("modes", modes.len().to_string(), allowed))
}

/// Shapes of the modes that are not rigid-body motions.
fn vibrating(modes: &[Mode]) -> Vec<f64> {
    modes.iter().filter(|mode| mode.omega_rad_s > 0.0).map(|mode| mode.shape).collect()
}

/// The restitution by the law for an impact whose modes are known.
pub(crate) fn restitution(parameters: &Parameters, posed: &crate::Impact) -> Result<f64, InvalidInput> {
    let modes = &posed.structure.modes[..posed.kept_modes()];
    Ok(parameters.rebound(&impact_on(modes, posed.striker.mass_kg)?)?.restitution)
}

/// Input of the law: a striker of mass `mass_kg` on a structure with its shapes at the point of impact.
fn impact_on(modes: &[Mode], mass_kg: f64) -> Result<Impact, InvalidInput> {
    // an immovable floor is the limit in which the rigid-body motions alone have mass
    if mass_kg != f64::INFINITY {
        require_positive("mass_kg", mass_kg)?;
    }
    let rigid = rigid_mobility(modes);
    // without rigid-body modes the mass itself, to the last bit
    let effective_kg = if rigid > 0.0 { 1.0 / (1.0 / mass_kg + rigid) } else { mass_kg };
    Impact::new(effective_kg, &Site::new(&vibrating(modes))?).map_err(|fault| match fault.field.first() {
        Some("z") => InvalidInput::new("mass_kg", mass_kg, such_that("Z = m sum phi_k^2", &fault)),
        _ => fault,
    })
}
