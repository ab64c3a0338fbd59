//! Derivatives of answers in closed form, from their values at neighbouring points.

use super::neighbours::{Neighbours, around};
use super::single::Sensitivity;
use super::table::Table;
use crate::emoc::Parameters;
use crate::impact::Impact;
use crate::net;
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

/// Adds the restitution of the three-parameter law for the same impact, if it applies, from the modes that are known already.
pub(super) fn add_emoc(table: &mut Table, scene: &Scene, base: &Impact, around: &[Neighbours<Impact>]) {
    let parameters = Parameters::default();
    if scene.emoc(&parameters, None).is_err() {
        return;
    }
    let law = |posed: &Impact| net::restitution(&parameters, posed).unwrap_or(f64::NAN);
    for near in around {
        let derivative = near.derivative(law(base), law);
        if derivative.value.is_finite() {
            table.insert("emoc_restitution", &near.field, derivative);
        }
    }
}
