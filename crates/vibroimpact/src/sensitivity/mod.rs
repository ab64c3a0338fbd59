//! Derivatives of an impact with respect to the numbers of its scene.
//!
//! The motion itself is differentiated ([`vibroimpact_sim::modal::Solver::differentiate`] and, for scenes of bodies,
//! [`vibroimpact_sim::assembly::Solver::differentiate`]). The derivatives of modes, masses, loads and law with respect to a field
//! follow from the scene at four neighbouring values of the field. Every number of a scene can therefore be requested, and only one
//! motion has to be solved. The model is chosen once, for the scene itself. Answers in closed form, those of a wall and of the net
//! laws, are differentiated from their values at these points.

mod bodies;
mod closed_form;
mod collect;
mod modes;
mod neighbours;
#[cfg(feature = "files")]
mod picture;
mod refusal;
mod sides;
mod single;
mod table;
mod text;

use std::cell::RefCell;

use serde_json::Value;
use vibroimpact_sim::modal::{Derivatives, NoDerivative, Parameter, Settings, Solution, Start};

use crate::impact::Impact;
use crate::in_scene::in_scene;
use crate::model::{Kept, Model};
use crate::scene::json::quote;
use crate::scene::{InvalidInput, Scene};
use collect::collect;
use modes::{MODES, Modes};
use neighbours::{Around, Neighbours, Posing};
use refusal::Refusal;
use table::Output;

pub use bodies::BodiesSensitivity;
#[cfg(feature = "files")]
pub use picture::figure;
pub use single::Sensitivity;
pub use table::{Field, LeftOut, Miss, OfField, Table};
pub use text::{text, text_of_bodies};

impl Scene {
    /// Differentiates the impact with respect to these fields, each the path of a number that the scene states, or to all numbers
    /// if none is named.
    ///
    /// # Errors
    /// As [`Scene::impact`]; a field that is not a number, that the scene does not state, or that cannot vary continuously; an
    /// impact that does not end with a rebound, or with a grazing contact.
    ///
    /// ```
    /// use vibroimpact::Scene;
    ///
    /// let scene = Scene::from_json(r#"{
    ///     "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.02,
    ///                    "segments": [{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }] },
    ///     "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
    ///     "contact": { "law": "hertz", "stiffness_n_m1_5": 1.8e10 },
    ///     "location_m": 0.3, "modes": 10
    /// }"#)?;
    /// let found = scene.sensitivity(&["striker.mass_kg".to_owned()])?;
    /// let by_mass = found.of("restitution", "striker.mass_kg").unwrap();
    /// assert!(by_mass.uncertainty.unwrap() < 1e-5 * by_mass.value.abs());
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn sensitivity(&self, fields: &[String]) -> Result<Sensitivity, InvalidInput> {
        if self.is_infinite() {
            let allowed = "a structure with modes, because the derivatives are computed along the motion of the modes";
            return Err(InvalidInput::new("structure", "an infinite one", allowed));
        }
        match self.model {
            Model::Auto | Model::Modal => {}
            Model::Rigid | Model::Emoc => return closed_form::sensitivity(self, fields),
            Model::InfiniteBeam => {
                let allowed = "one of auto, modal, rigid, emoc";
                return Err(InvalidInput::new("model", quote(&self.model.as_str().into()), allowed));
            }
        }
        let scene = self.settled()?;
        let tree = scene.tree();
        let kept = RefCell::new(Kept::default());
        let base = scene.impact_beside(&scene, &mut kept.borrow_mut())?;
        let pose = |tree: &Value| Scene::from_value(tree)?.impact_beside(&scene, &mut kept.borrow_mut());
        let sort = |impact: &mut Impact| impact.take_modes_of(&base);
        let around = neighbours::around((&tree, fields), &Posing { pose: &pose, sort: &sort, sides: &sides::of_tree })?;
        differentiate(&scene, &base, &around, tree)
    }
}

fn differentiate(
    scene: &Scene,
    base: &Impact,
    around: &Around<Impact>,
    tree: Value,
) -> Result<Sensitivity, InvalidInput> {
    let seen = |impact: &Impact| vec![impact.seen()];
    let modes = Modes::new(seen(base), around.near.iter().map(|near| near.map(seen)).collect());
    let draws = modes.draws(|errors| {
        let mut impact = base.clone();
        for (mode, error) in impact.structure.modes.iter_mut().zip(&errors[0]) {
            mode.omega_rad_s += error.omega_rad_s;
            mode.shape += error.shapes[0];
        }
        impact
    });
    let at_rest = Start::at_rest(base.structure.modes.len());
    let mut parameters = Vec::with_capacity(around.near.len() + draws.len());
    for Neighbours { offsets, at, .. } in around.near.iter().chain(&draws) {
        let changes_law = at.iter().any(|impact| impact.law != base.law);
        let neighbours = at.each_ref().map(|impact| impact.posing(&at_rest));
        parameters.push(Parameter { offsets: *offsets, neighbours, changes_law });
    }
    let solver = base.solver()?;
    let Impact { striker, law, start, .. } = base;
    let settings = Settings { tolerance: base.settings.tolerance, ..Settings::default() };
    let found = solver.differentiate(striker, law, start.as_ref(), &settings, &parameters).map_err(in_scene)?;
    let solution = &found.solution;
    let refusal = |why| Refusal::new(why, solution.outcome.as_str(), |_| "the contact".to_owned());
    let restitution = solution.restitution.ok_or_else(|| refusal(NoDerivative::Outcome).error(None))?;
    let of_modes = |field: usize| {
        let of_mode = |k: usize| {
            let mode = &base.structure.modes[k];
            [
                Output::new(format!("omega_rad_s[{k}]"), mode.omega_rad_s, modes.omega_rad_s(field, 0, k)),
                Output::new(format!("shape[{k}]"), mode.shape, modes.shape(field, k)),
            ]
        };
        (0..base.kept_modes().min(MODES)).flat_map(of_mode).collect()
    };
    let outputs = |derivatives: &Derivatives| outputs(solution, restitution, derivatives);
    let mut table = collect(around, &modes, &found.derivatives, outputs, of_modes, refusal)?;
    closed_form::add_emoc(&mut table, scene, base, &around.near);
    Ok(Sensitivity {
        restitution,
        restitution_uncertainty: solution.restitution_uncertainty,
        sub_impact_count: solution.sub_impacts.len(),
        modes: base.kept_modes(),
        remainder_modes: base.remainder_modes,
        nearest_graze: found.nearest_graze,
        nearest_miss: found.nearest_miss.map(|miss| Miss::new(miss, None)),
        table,
        scene: tree,
        version: env!("CARGO_PKG_VERSION"),
    })
}

/// The outputs of an impact by their names in a result.
fn outputs(solution: &Solution, restitution: f64, derivatives: &Derivatives) -> Vec<Output> {
    let mut outputs = vec![
        Output::new("restitution".to_owned(), restitution, derivatives.restitution),
        Output::new("end_s".to_owned(), solution.end_s, derivatives.end_s),
        Output::new("striker_velocity_m_s".to_owned(), solution.striker_velocity_m_s, derivatives.striker_velocity_m_s),
    ];
    for (i, (own, by)) in solution.sub_impacts.iter().zip(&derivatives.sub_impacts).enumerate() {
        for (quantity, value, derivative) in [
            ("start_s", own.start_s, by.start_s),
            ("end_s", own.end_s, by.end_s),
            ("impulse_n_s", own.impulse_n_s, by.impulse_n_s),
            ("peak_force_n", own.peak_force_n, by.peak_force_n),
            ("peak_compression_m", own.peak_compression_m, by.peak_compression_m),
        ] {
            outputs.push(Output::new(format!("sub_impacts[{i}].{quantity}"), value, derivative));
        }
    }
    outputs
}
