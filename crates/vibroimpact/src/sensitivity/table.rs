//! Derivatives by output and field.

use std::collections::BTreeMap;

use invalid_input::InvalidInput;
use serde::Serialize;
use vibroimpact_sim::modal::{Derivative, NearMiss};

use crate::scene::told::did_you_mean;
use crate::text::small;

/// A derivative of an output with respect to a field, in the unit of the output over that of the field.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct OfField {
    /// The derivative.
    pub value: f64,
    /// Its uncertainty; null if no digit is certain.
    pub uncertainty: Option<f64>,
}

/// Surfaces that nearly touched, or nearly parted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Miss {
    /// The name of their contact, in a scene of bodies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<String>,
    /// The event that was missed: `touch` or `separation`.
    pub event: &'static str,
    /// When it was nearest (s).
    pub time_s: f64,
    /// The gap then, or the compression above that of separation (m).
    pub distance_m: f64,
}

impl Miss {
    pub(super) fn new(miss: NearMiss, contact: Option<String>) -> Miss {
        let event = if miss.was_closed { "separation" } else { "touch" };
        Miss { contact, event, time_s: miss.time_s, distance_m: miss.distance_m }
    }
}

/// A field with respect to which outputs were differentiated.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Field {
    /// Its path, such as `striker.mass_kg`.
    pub path: String,
    /// Its value in the scene.
    pub value: f64,
    /// `increase` or `decrease`, if the derivatives hold for such a change alone, or `neither`; null if they hold for both. A contact
    /// that touches at the start can only touch later: otherwise its surfaces would overlap at the start. One that touches there without
    /// speed can only touch with one, or later.
    pub holds_for: Option<&'static str>,
}

/// For which changes of a field a contact that touches at the start touches later, or one that touches without speed has one: neither
/// a time nor a speed of approach is ever negative.
fn holds_for(derivatives: &[Output]) -> Option<&'static str> {
    let first = |name: &str| name.ends_with("[0].start_s") || name.ends_with("[0].approach_speed_m_s");
    let at_start = |output: &&Output| output.value == 0.0 && first(&output.name);
    let later = |output: &Output| {
        let Derivative { value, uncertainty } = output.derivative;
        if value.abs() <= uncertainty.unwrap_or(0.0) { 0.0 } else { value.signum() }
    };
    let all: Vec<f64> = derivatives.iter().filter(at_start).map(later).filter(|sign| *sign != 0.0).collect();
    match *all.first()? {
        first if all.iter().any(|sign| *sign != first) => Some("neither"),
        first if first > 0.0 => Some("increase"),
        _ => Some("decrease"),
    }
}

/// Numbers of the scene without derivatives.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LeftOut {
    /// Path of a number or of a list of numbers.
    pub path: String,
    /// The reason why there are no derivatives.
    pub reason: String,
}

/// Fields, and derivatives of outputs with respect to them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table {
    /// The fields, in the requested order.
    pub fields: Vec<Field>,
    /// Numbers of the scene without derivatives, if all of its numbers were requested.
    pub left_out: Vec<LeftOut>,
    /// The outputs of the scene itself.
    pub outputs: BTreeMap<String, f64>,
    /// By output, then by field.
    pub derivatives: BTreeMap<String, BTreeMap<String, OfField>>,
}

impl Table {
    /// Without derivatives so far.
    pub(super) fn new(left_out: Vec<LeftOut>) -> Table {
        Table { fields: Vec::new(), left_out, outputs: BTreeMap::new(), derivatives: BTreeMap::new() }
    }

    /// Adds a field with the derivatives of these outputs, each with its name and its value.
    pub(super) fn add(&mut self, path: &str, value: f64, derivatives: Vec<Output>) {
        self.fields.push(Field { path: path.to_owned(), value, holds_for: holds_for(&derivatives) });
        derivatives.into_iter().for_each(|output| self.insert(path, output));
    }

    /// Adds the derivative of an output with respect to a field of the table.
    pub(super) fn insert(&mut self, path: &str, Output { name, value, derivative }: Output) {
        self.outputs.insert(name.clone(), value);
        let Derivative { value, uncertainty } = derivative;
        self.derivatives.entry(name).or_default().insert(path.to_owned(), OfField { value, uncertainty });
    }

    /// A field without derivatives.
    pub(super) fn leave_out(&mut self, path: &str, reason: String) {
        self.left_out.push(LeftOut { path: path.to_owned(), reason });
    }

    /// The derivative of an output with respect to a field, if it exists.
    pub fn of(&self, output: &str, field: &str) -> Option<OfField> {
        self.derivatives.get(output)?.get(field).copied()
    }

    /// The derivatives of an output.
    pub(super) fn rows(&self, output: &str) -> Result<Rows<'_>, InvalidInput> {
        let by_field = self.derivatives.get(output).ok_or_else(|| {
            let known = || self.derivatives.keys().map(String::as_str);
            let meant = did_you_mean(output, known());
            let known = known().collect::<Vec<_>>().join(", ");
            InvalidInput::new("--of", output, format!("an output of this scene, one of {known}{meant}"))
        })?;
        let mut rows: Vec<Row> = Vec::new();
        for field in &self.fields {
            if let Some(&derivative) = by_field.get(&field.path) {
                rows.push(Row { path: &field.path, value: field.value, derivative });
            }
        }
        rows.sort_by(|a, b| b.by_whole().abs().total_cmp(&a.by_whole().abs()));
        let size = if output.ends_with("restitution") {
            1.0
        } else {
            self.outputs.get(output).map_or(0.0, |value| value.abs())
        };
        let largest = rows.first().map_or(0.0, |row| row.by_whole().abs());
        Ok(Rows { rows, share: share(largest, LINEAR * size) })
    }
}

/// A change of the restitution beyond which its derivatives do not hold, and a relative change of other outputs.
const LINEAR: f64 = 0.1;

/// The largest of 0.01, 0.001 and so on that keeps a change below `most`, if it is `by_whole` for 1. An output that is nearly zero
/// has no size to compare with.
fn share(by_whole: f64, most: f64) -> f64 {
    const LEAST: i32 = -8;
    let mut shares = (LEAST..=-2).rev().map(|power| 10f64.powi(power));
    shares.find(|share| share * by_whole <= most).unwrap_or(0.01)
}

/// An output with its derivative.
pub(super) struct Output {
    pub name: String,
    pub value: f64,
    pub derivative: Derivative,
}

impl Output {
    pub fn new(name: String, value: f64, derivative: Derivative) -> Output {
        Output { name, value, derivative }
    }
}

/// The derivatives of one output, sorted by the effect of a relative change of the field.
pub(super) struct Rows<'a> {
    pub rows: Vec<Row<'a>>,
    /// The relative change of the fields that is shown: 0.01, or less where derivatives would not hold for that.
    pub share: f64,
}

impl Rows<'_> {
    /// The relative change in words.
    pub fn percentage(&self) -> String {
        format!("{} %", small(100.0 * self.share))
    }
}

/// A field with the derivative of an output.
pub(super) struct Row<'a> {
    pub path: &'a str,
    pub value: f64,
    pub derivative: OfField,
}

impl Row<'_> {
    /// Change of the output if the field doubled and the derivative held so far.
    pub fn by_whole(&self) -> f64 {
        self.value * self.derivative.value
    }
}
