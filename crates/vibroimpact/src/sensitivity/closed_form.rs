//! Answers that have a closed form: by their own values at the neighbours, since nothing in them is integrated.

use serde_json::Value;

use super::Sensitivity;
use super::neighbours::{Neighbours, around};
use super::table::Table;
use crate::emoc::Parameters;
use crate::scene::{InvalidInput, Scene};

/// The restitution of a wall or of the net law.
pub(super) fn sensitivity(scene: &Scene, fields: &[String]) -> Result<Sensitivity, InvalidInput> {
    let answer = scene.answer()?;
    let tree = scene.tree();
    let none = || InvalidInput::new("scene", "an impact without a restitution", "one that ends with a rebound");
    let restitution = |scene: &Scene| scene.answer()?.restitution.ok_or_else(none);
    let value = answer.restitution.ok_or_else(none)?;
    let (around, left_out) = around((&tree, fields), &|tree| restitution(&Scene::from_value(tree)?), &|_| true)?;
    let mut table = Table::new(&around, left_out);
    for near in &around {
        table.insert("restitution", &near.field, near.derivative(value, |at| *at));
    }
    Ok(Sensitivity {
        restitution: value,
        restitution_uncertainty: answer.restitution_uncertainty,
        sub_impact_count: 1,
        modes: answer.modes,
        remainder_modes: 0,
        nearest_graze: 1.0,
        table,
        scene: tree,
        version: env!("CARGO_PKG_VERSION"),
    })
}

/// Adds what the three-parameter law says of the same impact, by the fields with which it is smooth.
pub(super) fn add_emoc(table: &mut Table, scene: &Scene, tree: &Value) {
    let law = |scene: &Scene| scene.emoc(&Parameters::default(), None).map(|rebound| rebound.restitution);
    let Ok(value) = law(scene) else { return };
    for path in table.fields.iter().map(|field| field.path.clone()).collect::<Vec<_>>() {
        let near: Result<Neighbours<f64>, _> =
            Neighbours::of(tree, &path, &|tree| law(&Scene::from_value(tree)?), &|_| true);
        if let Ok(near) = near {
            table.insert("emoc_restitution", &path, near.derivative(value, |at| *at));
        }
    }
}
