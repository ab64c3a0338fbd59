//! The table of a sensitivity.

use super::{OfField, Sensitivity};
use crate::scene::InvalidInput;
use std::fmt::Write;

/// A touch slower than this part of the fastest is near a graze.
const NEAR: f64 = 1e-2;

/// The derivatives of one output, those first that matter most. Fields that are zero come last: of these no part can be
/// changed.
///
/// # Errors
/// An output that the impact does not have.
pub fn text(found: &Sensitivity, output: &str) -> Result<String, InvalidInput> {
    let rows = found.rows(output)?;
    let wide = rows.iter().map(|row| row.path.len()).max().unwrap_or(0).max(5);
    let mut text = String::new();
    let contacts = if found.sub_impact_count == 1 { "sub-impact" } else { "sub-impacts" };
    let restitution = crate::text::restitution(found.restitution, found.restitution_uncertainty);
    let _ = writeln!(
        text,
        "restitution {restitution}, {} {contacts}, {} modes and {} remainder modes\n\nderivatives of {output}\n",
        found.sub_impact_count, found.modes, found.remainder_modes
    );
    let _ = writeln!(
        text,
        "  {:wide$}  {:>WIDTH$}  {:>14}  {:>9}  {:>14}",
        "field", "value", "derivative", "±", "by 1 % more"
    );
    for row in &rows {
        let uncertainty = row.derivative.uncertainty.map_or_else(|| "?".to_owned(), |by| format!("{by:.0e}"));
        let by_part = if row.value == 0.0 { "-".to_owned() } else { format!("{:+.3e}", row.by_part()) };
        let _ = writeln!(
            text,
            "  {:wide$}  {:>WIDTH$}  {:>+14.6e}  {uncertainty:>9}  {by_part:>14}",
            row.path,
            short(row.value),
            row.derivative.value
        );
    }
    let _ = writeln!(
        text,
        "\nDerivatives are per SI unit of the field; \"by 1 % more\" is what one per cent more of it changes."
    );
    let largest = rows.iter().map(|row| row.by_part().abs()).fold(0.0, f64::max);
    if output == "restitution" && largest > LINEAR {
        let part = 1e-2 * LINEAR / largest;
        let _ = writeln!(
            text,
            "One per cent is far beyond where the derivatives hold: a change of {} of the first field already changes the\n\
             restitution by {LINEAR}.",
            crate::model::small(part)
        );
    }
    let graze = found.nearest_graze;
    if found.sub_impact_count > 1 {
        let _ = writeln!(
            text,
            "The slowest of the contacts began with {:.2} % of the speed of the fastest.",
            100.0 * graze
        );
    }
    if graze < NEAR {
        text += "This contact nearly grazes: where it is lost the derivatives change abruptly, so that they hold only for \
                 small changes.\n";
    }
    if rows.iter().any(|row| row.derivative.uncertainty.is_none()) {
        text += "No digit is certain where ± is ?: a coarser solution took another course.\n";
    }
    Ok(text)
}

/// Characters of the column of values.
const WIDTH: usize = 12;

/// A value as a scene might state it, as far as the column holds it.
fn short(value: f64) -> String {
    let whole =
        if value != 0.0 && !(1e-4..1e7).contains(&value.abs()) { format!("{value:e}") } else { value.to_string() };
    if whole.len() <= WIDTH { whole } else { format!("{value:.6e}") }
}

/// A change of the restitution beyond which its derivatives do not hold.
const LINEAR: f64 = 0.1;

/// A field with the derivative of an output by it.
pub(super) struct Row<'a> {
    pub path: &'a str,
    pub value: f64,
    pub derivative: OfField,
}

impl Row<'_> {
    /// What one per cent more of the field changes.
    pub fn by_part(&self) -> f64 {
        0.01 * self.value * self.derivative.value
    }
}

impl Sensitivity {
    /// The fields by how much a part of them changes an output.
    pub(super) fn rows(&self, output: &str) -> Result<Vec<Row<'_>>, InvalidInput> {
        let by_field = self.derivatives.get(output).ok_or_else(|| {
            let known = self.derivatives.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
            InvalidInput::new("--of", output, format!("an output of this impact: {known}"))
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
