//! Derivatives by output and field.

use std::collections::BTreeMap;

use invalid_input::InvalidInput;
use serde::Serialize;
use vibroimpact_sim::modal::Derivative;

use super::neighbours::Neighbours;

/// A derivative of an output with respect to a field, in the unit of the output over that of the field.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct OfField {
    /// The derivative.
    pub value: f64,
    /// Its uncertainty; null if no digit is certain.
    pub uncertainty: Option<f64>,
}

/// A field with respect to which outputs were differentiated.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Field {
    /// Its path, such as `striker.mass_kg`.
    pub path: String,
    /// Its value in the scene.
    pub value: f64,
}

/// Fields, and derivatives of outputs with respect to them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table {
    /// The fields, in the requested order.
    pub fields: Vec<Field>,
    /// Numbers of the scene that cannot vary continuously, if all of its numbers were requested.
    pub left_out: Vec<String>,
    /// By output, then by field.
    pub derivatives: BTreeMap<String, BTreeMap<String, OfField>>,
}

impl Table {
    pub(super) fn new<T>(around: &[Neighbours<T>], left_out: Vec<String>) -> Table {
        let field = |at: &Neighbours<T>| Field { path: at.field.clone(), value: at.value };
        Table { fields: around.iter().map(field).collect(), left_out, derivatives: BTreeMap::new() }
    }

    pub(super) fn insert(&mut self, output: &str, field: &str, Derivative { value, uncertainty }: Derivative) {
        let by_field = self.derivatives.entry(output.to_owned()).or_default();
        by_field.insert(field.to_owned(), OfField { value, uncertainty });
    }

    /// The derivative of an output with respect to a field, if it exists.
    pub fn of(&self, output: &str, field: &str) -> Option<OfField> {
        self.derivatives.get(output)?.get(field).copied()
    }

    /// The fields, sorted by the effect of a relative change on an output.
    pub(super) fn rows(&self, output: &str) -> Result<Vec<Row<'_>>, InvalidInput> {
        let by_field = self.derivatives.get(output).ok_or_else(|| {
            let known = self.derivatives.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
            InvalidInput::new("--of", output, format!("an output of this scene: {known}"))
        })?;
        let mut rows: Vec<Row> = Vec::new();
        for field in &self.fields {
            if let Some(&derivative) = by_field.get(&field.path) {
                rows.push(Row { path: &field.path, value: field.value, derivative });
            }
        }
        rows.sort_by(|a, b| b.by_part().abs().total_cmp(&a.by_part().abs()));
        Ok(rows)
    }
}

/// A field with the derivative of an output.
pub(super) struct Row<'a> {
    pub path: &'a str,
    pub value: f64,
    pub derivative: OfField,
}

impl Row<'_> {
    /// Change of the output if the field grows by one per cent.
    pub fn by_part(&self) -> f64 {
        0.01 * self.value * self.derivative.value
    }
}
