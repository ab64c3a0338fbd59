//! Derivatives of an impact with respect to the numbers of its scene.
//!
//! The motion itself is differentiated ([`vibroimpact_sim::modal::Solver::differentiate`] and, for scenes of bodies,
//! [`vibroimpact_sim::assembly::Solver::differentiate`]). The derivatives of modes, masses, loads and law with respect to a field
//! follow from the scene at four neighbouring values of the field. Every number of a scene can therefore be requested, and only one
//! motion has to be solved. The model is chosen once, for the scene itself. Answers in closed form, those of a wall and of the net
//! laws, are differentiated from their values at these points.

mod bodies;
mod closed_form;
mod neighbours;
#[cfg(feature = "files")]
mod picture;
mod refusal;
mod single;
mod table;
mod text;

use serde_json::Value;
use vibroimpact_sim::modal::{Derivative, Derivatives, NoDerivative, Parameter, Settings, Solver, Start};

use crate::impact::Impact;
use crate::in_scene::in_scene;
use crate::model::Model;
use crate::scene::json::quote;
use crate::scene::{InvalidInput, Scene};
use neighbours::Neighbours;
use refusal::refusal;

pub use bodies::BodiesSensitivity;
#[cfg(feature = "files")]
pub use picture::figure;
pub use single::Sensitivity;
pub use table::{Field, OfField, Table};
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
            let allowed = "a structure with modes: derivatives go along the motion of modes";
            return Err(InvalidInput::new("structure", "an infinite one", allowed));
        }
        match self.model {
            Model::Auto | Model::Modal => {}
            Model::Rigid | Model::Emoc => return closed_form::sensitivity(self, fields),
            Model::InfiniteBeam => {
                let allowed = "\"auto\", \"modal\", \"rigid\" or \"emoc\"";
                return Err(InvalidInput::new("model", quote(&self.model.as_str().into()), allowed));
            }
        }
        let scene = self.settled()?;
        let tree = scene.tree();
        let base = scene.impact()?;
        let (around, left_out) =
            neighbours::around((&tree, fields), &|tree| Scene::from_value(tree)?.impact(), &|impact: &mut Impact| {
                impact.take_modes_of(&base)
            })?;
        differentiate(&scene, &base, (&around, left_out), tree)
    }
}

fn differentiate(
    scene: &Scene,
    base: &Impact,
    (around, left_out): (&[Neighbours<Impact>], Vec<String>),
    tree: Value,
) -> Result<Sensitivity, InvalidInput> {
    let at_rest = Start::at_rest(base.structure.modes.len());
    let mut parameters = Vec::with_capacity(around.len() + 1);
    let with_errors = Neighbours::with_errors_of(base);
    for Neighbours { offsets, at, .. } in around.iter().chain([&with_errors]) {
        let changes_law = at.iter().any(|impact| impact.law != base.law);
        let neighbours = at.each_ref().map(|impact| impact.posing(&at_rest));
        parameters.push(Parameter { offsets: *offsets, neighbours, changes_law });
    }
    let solver = Solver::new(&base.structure).map_err(in_scene)?;
    let Impact { striker, law, start, .. } = base;
    let settings = Settings { tolerance: base.settings.tolerance, ..Settings::default() };
    let found = solver.differentiate(striker, law, start.as_ref(), &settings, &parameters).map_err(in_scene)?;
    let solution = &found.solution;
    let refused = |why| refusal(why, solution.outcome.as_str(), |_| "the contact".to_owned());
    let derivatives = found.derivatives.as_ref().map_err(|why| refused(*why))?;
    let restitution = solution.restitution.ok_or_else(|| refused(NoDerivative::Outcome))?;
    let mut table = Table::new(around, left_out);
    let by_errors = derivatives.last().map(outputs).unwrap_or_default();
    for (neighbours, derivatives) in around.iter().zip(derivatives) {
        for ((output, derivative), (_, by_errors)) in outputs(derivatives).into_iter().zip(&by_errors) {
            table.insert(&output, &neighbours.field, neighbours.widened(derivative, *by_errors));
        }
        for (output, derivative) in neighbours.of_modes(base) {
            table.insert(&output, &neighbours.field, derivative);
        }
    }
    closed_form::add_emoc(&mut table, scene, base, around);
    Ok(Sensitivity {
        restitution,
        restitution_uncertainty: solution.restitution_uncertainty,
        sub_impact_count: solution.sub_impacts.len(),
        modes: base.kept_modes(),
        remainder_modes: base.remainder_modes,
        nearest_graze: found.nearest_graze,
        table,
        scene: tree,
        version: env!("CARGO_PKG_VERSION"),
    })
}

/// The outputs of an impact by their names in a result.
fn outputs(derivatives: &Derivatives) -> Vec<(String, Derivative)> {
    let mut outputs = vec![
        ("restitution".to_owned(), derivatives.restitution),
        ("end_s".to_owned(), derivatives.end_s),
        ("striker_velocity_m_s".to_owned(), derivatives.striker_velocity_m_s),
    ];
    for (i, sub_impact) in derivatives.sub_impacts.iter().enumerate() {
        for (quantity, derivative) in [
            ("start_s", sub_impact.start_s),
            ("end_s", sub_impact.end_s),
            ("impulse_n_s", sub_impact.impulse_n_s),
            ("peak_force_n", sub_impact.peak_force_n),
            ("peak_compression_m", sub_impact.peak_compression_m),
        ] {
            outputs.push((format!("sub_impacts[{i}].{quantity}"), derivative));
        }
    }
    outputs
}
