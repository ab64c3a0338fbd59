//! Derivatives of answers in closed form, from their values at neighbouring points.

use serde_json::Value;

use super::neighbours::{Neighbours, Posing, around, roughness};
use super::sides::of_tree;
use super::single::Sensitivity;
use super::table::{Output, Table};
use crate::emoc::Parameters;
use crate::impact::Impact;
use crate::net;
use crate::scene::{InvalidInput, Scene};

/// The restitution of a wall or of the net law.
pub(super) fn sensitivity(scene: &Scene, fields: &[String]) -> Result<Sensitivity, InvalidInput> {
    let answer = scene.answer()?;
    let tree = scene.tree();
    let none = || InvalidInput::new("scene", "an impact without a restitution", "an impact that ends with a rebound");
    let restitution = |scene: &Scene| scene.answer()?.restitution.ok_or_else(none);
    let value = answer.restitution.ok_or_else(none)?;
    let pose = |tree: &Value| restitution(&Scene::from_value(tree)?);
    let around = around((&tree, fields), &Posing { pose: &pose, sort: &|_| Ok(()), sides: &of_tree })?;
    let mut table = Table::new(around.left_out);
    for near in &around.near {
        table.add(&near.field, near.value, vec![output("restitution", near, value, |at| *at)]);
    }
    Ok(Sensitivity {
        restitution: value,
        restitution_uncertainty: answer.restitution_uncertainty,
        sub_impact_count: 1,
        modes: answer.modes,
        remainder_modes: 0,
        nearest_graze: 1.0,
        nearest_miss: None,
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
        if !table.fields.iter().any(|field| field.path == near.field) {
            continue;
        }
        let output = output("emoc_restitution", near, law(base), law);
        if output.derivative.value.is_finite() {
            table.insert(&near.field, output);
        }
    }
}

/// A function of the problem that is differentiated from its values.
fn output<T>(name: &str, near: &Neighbours<T>, here: f64, of: impl Fn(&T) -> f64) -> Output {
    let error = TIMES * here.abs() * roughness(near.in_order(here, &of), here);
    Output::new(name.to_owned(), here, near.derivative(here, of, error))
}

/// Factor from the error of the values, known from one fourth difference, to that of the uncertainty.
const TIMES: f64 = 4.0;
