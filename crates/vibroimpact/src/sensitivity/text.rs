//! The table of a sensitivity.

use std::fmt::Write;

use invalid_input::InvalidInput;

use super::bodies::BodiesSensitivity;
use super::single::Sensitivity;
use super::table::{Row, Table};
use crate::text::{counted, small};

/// A touch slower than this share of the fastest is near grazing.
const NEAR: f64 = 1e-2;

/// The derivatives of one output, the most important first. Fields that are zero come last, since they have no relative change.
///
/// # Errors
/// An output that the impact does not have.
pub fn text(found: &Sensitivity, output: &str) -> Result<String, InvalidInput> {
    let rows = found.table.rows(output)?;
    let contacts = counted(found.sub_impact_count as u64, "sub-impact", "sub-impacts");
    let restitution = crate::text::restitution(found.restitution, found.restitution_uncertainty);
    let mut text = format!(
        "restitution {restitution}, {contacts}, {} modes and {} remainder modes\n\n",
        found.modes, found.remainder_modes
    );
    text += &table(&found.table, output)?;
    let largest = rows.iter().map(|row| row.by_part().abs()).fold(0.0, f64::max);
    if output == "restitution" && largest > LINEAR {
        let part = 1e-2 * LINEAR / largest;
        let _ = writeln!(
            text,
            "One per cent is far outside the range of the derivatives: a change of {} of the first field already changes the\n\
             restitution by {LINEAR}.",
            small(part)
        );
    }
    text += &cautions(found.nearest_graze, found.sub_impact_count, &rows);
    Ok(text)
}

/// The derivatives of one output of a scene of bodies, in the same form.
///
/// # Errors
/// An output that the run does not have.
pub fn text_of_bodies(found: &BodiesSensitivity, output: &str) -> Result<String, InvalidInput> {
    let (count, outcome) = (found.interval_count, found.outcome);
    let intervals = counted(count as u64, "interval of contact", "intervals of contact");
    let text = format!("{outcome} at {:.6e} s, {intervals}\n\n", found.end_s);
    let rows = found.table.rows(output)?;
    Ok(text + &table(&found.table, output)? + &cautions(found.nearest_graze, count, &rows))
}

fn table(found: &Table, output: &str) -> Result<String, InvalidInput> {
    let rows = found.rows(output)?;
    let wide = rows.iter().map(|row| row.path.len()).max().unwrap_or(0).max(5);
    let mut text = format!("derivatives of {output}\n\n");
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
    text += "\nDerivatives are per SI unit of the field; \"by 1 % more\" is the change of the output if the field grows by one \
             per cent.\n";
    if !found.left_out.is_empty() {
        let _ = writeln!(text, "Left out, since they cannot vary continuously: {}.", found.left_out.join(", "));
    }
    Ok(text)
}

/// Notes on contacts near grazing, and on derivatives that are not known.
fn cautions(graze: f64, contacts: usize, rows: &[Row]) -> String {
    let mut text = String::new();
    if contacts > 1 {
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
        text += "No digit is certain where ± is ?: a coarser solution has another sequence of contacts.\n";
    }
    text
}

/// Characters of the column of values.
const WIDTH: usize = 12;

/// A value in the form of a scene, within the width of the column.
fn short(value: f64) -> String {
    let whole =
        if value != 0.0 && !(1e-4..1e7).contains(&value.abs()) { format!("{value:e}") } else { value.to_string() };
    if whole.len() <= WIDTH { whole } else { format!("{value:.6e}") }
}

/// A change of the restitution beyond which its derivatives do not hold.
const LINEAR: f64 = 0.1;
