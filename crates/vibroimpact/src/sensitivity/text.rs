//! The table of a sensitivity.

use std::fmt::Write;

use invalid_input::InvalidInput;

use super::bodies::BodiesSensitivity;
use super::single::Sensitivity;
use super::table::{Field, LeftOut, Miss, Rows, Table};
use crate::text::{counted, significant, small};

/// A touch slower than this share of the fastest is near grazing.
const NEAR: f64 = 1e-2;

/// The derivatives of one output, the most important first. Fields that are zero come last, since they have no relative change.
///
/// # Errors
/// An output that the impact does not have.
pub fn text(found: &Sensitivity, output: &str) -> Result<String, InvalidInput> {
    let contacts = counted(found.sub_impact_count as u64, "sub-impact", "sub-impacts");
    let restitution = crate::text::restitution(found.restitution, found.restitution_uncertainty);
    let head = format!(
        "restitution {restitution}, {contacts}, {} modes and {} remainder modes\n\n",
        found.modes, found.remainder_modes
    );
    let rows = found.table.rows(output)?;
    let graze = graze(found.nearest_graze, found.nearest_miss.as_ref(), found.sub_impact_count);
    Ok(head + &table(&found.table, output, &rows) + &graze + unknown(&rows))
}

/// The derivatives of one output of a scene of bodies, in the same form.
///
/// # Errors
/// An output that the run does not have.
pub fn text_of_bodies(found: &BodiesSensitivity, output: &str) -> Result<String, InvalidInput> {
    let (count, outcome) = (found.interval_count, found.outcome);
    let intervals = counted(count as u64, "interval of contact", "intervals of contact");
    let head = format!("{outcome} at {:.6e} s, {intervals}\n\n", found.end_s);
    let rows = found.table.rows(output)?;
    let graze = graze(found.nearest_graze, found.nearest_miss.as_ref(), count);
    Ok(head + &table(&found.table, output, &rows) + &graze + unknown(&rows))
}

fn table(found: &Table, output: &str, rows: &Rows) -> String {
    let wide = rows.rows.iter().map(|row| row.path.len()).max().unwrap_or(0).max(5);
    let by_share = format!("by {} more", rows.percentage());
    let mut text = format!("derivatives of {output}\n\n");
    let _ =
        writeln!(text, "  {:wide$}  {:>WIDTH$}  {:>14}  {:>9}  {by_share:>14}", "field", "value", "derivative", "±");
    for row in &rows.rows {
        let uncertainty = row.derivative.uncertainty.map_or_else(|| "?".to_owned(), |by| format!("{by:.0e}"));
        let by_share = if row.value == 0.0 { "-".to_owned() } else { format!("{:+.3e}", rows.share * row.by_whole()) };
        let _ = writeln!(
            text,
            "  {:wide$}  {:>WIDTH$}  {:>+14.6e}  {uncertainty:>9}  {by_share:>14}",
            row.path,
            short(row.value),
            row.derivative.value
        );
    }
    let _ = writeln!(
        text,
        "\nDerivatives are per SI unit of the field; \"{by_share}\" is the change of the output if the field grows by {}.",
        rows.percentage()
    );
    if rows.share < ONE_PERCENT {
        let _ = writeln!(
            text,
            "For 1 % they predict a change of {}, which is outside the range in which they hold.",
            small(ONE_PERCENT * rows.rows.first().map_or(0.0, |row| row.by_whole().abs()))
        );
    }
    for Field { path, holds_for, .. } in &found.fields {
        let change = match *holds_for {
            None => continue,
            Some("neither") => "no change",
            Some("increase") => "an increase",
            Some(_) => "a decrease",
        };
        let _ = writeln!(
            text,
            "Derivatives by {path} hold for {change} of it: otherwise surfaces that touch at the start would overlap there."
        );
    }
    if !found.left_out.is_empty() {
        let wide = found.left_out.iter().map(|field| field.path.len()).max().unwrap_or(0);
        text += "\nWithout derivatives:\n";
        for LeftOut { path, reason } in &found.left_out {
            let _ = writeln!(text, "  {path:wide$}  {reason}");
        }
        text += "\n";
    }
    text
}

/// How near the nearest graze is.
fn graze(graze: f64, miss: Option<&Miss>, contacts: usize) -> String {
    let mut text = String::new();
    let percentage = 100.0 * graze;
    match miss {
        Some(Miss { contact, event, time_s, distance_m }) => {
            let surfaces =
                contact.as_ref().map_or("the surfaces".to_owned(), |name| format!("the surfaces of contact {name:?}"));
            let (happens, distance) = match *event {
                "touch" => ("touch", "their gap"),
                _ => ("part", "their compression"),
            };
            let (time, by) = (significant(*time_s, 6), small(*distance_m));
            let _ = writeln!(
                text,
                "At {time} s {surfaces} nearly {happens}: {distance} falls to {by} m. This is as near to a graze as a touch with\n\
                 {percentage:.2} % of the speed of the fastest one."
            );
        }
        None if contacts > 1 => {
            let _ =
                writeln!(text, "The slowest of the contacts began with {percentage:.2} % of the speed of the fastest.");
        }
        None => {}
    }
    if graze < NEAR {
        text += "This contact nearly grazes: where it appears or disappears the derivatives change abruptly, so that they hold \
                 only for small changes.\n";
    }
    text
}

/// A note on derivatives that are not known.
fn unknown(rows: &Rows) -> &'static str {
    let unknown = rows.rows.iter().any(|row| row.derivative.uncertainty.is_none());
    if unknown {
        "No digit is certain where ± is ?: a coarser solution has another sequence of contacts.\n"
    } else {
        ""
    }
}

/// The relative change that is shown where the derivatives hold for it.
const ONE_PERCENT: f64 = 0.01;

/// Characters of the column of values.
const WIDTH: usize = 12;

/// A value in the form of a scene, within the width of the column.
fn short(value: f64) -> String {
    let whole =
        if value != 0.0 && !(1e-4..1e7).contains(&value.abs()) { format!("{value:e}") } else { value.to_string() };
    if whole.len() <= WIDTH { whole } else { format!("{value:.6e}") }
}
