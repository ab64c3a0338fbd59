//! Impacts on infinite structures as text for the terminal.

use std::fmt::Write;

use super::{Summary, TurningPoints};
use crate::text::{quantity, stopped};

/// Largest number of contacts that are listed; the others are counted.
const LISTED: usize = 20;

/// The result of an impact.
pub fn text(summary: &Summary) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<22}{value}");
    };
    if let Some(s) = summary.s {
        line("S", format!("{s}"));
    }
    let outcome = match summary.outcome {
        "sustained" => "sustained contact: the striker never leaves for good",
        other => other,
    };
    line("outcome", stopped(summary.stopped_by).unwrap_or_else(|| outcome.to_owned()));
    line("separations", summary.separations.to_string());
    if let Some(certain) = summary.certain_separations.filter(|certain| *certain < summary.separations) {
        line("of them certain", format!("the first {certain}; later ones are not known"));
    }
    let digits = summary.digits.unwrap_or(0.0);
    let decimals = (digits as usize).clamp(1, 12);
    if let Some(ratio) = summary.first_rebound_ratio {
        // the first contact has full precision
        line("first rebound ratio", format!("{ratio:.*}", decimals.max(10)));
    }
    if let Some(ratio) = summary.rebound_ratio {
        line("rebound ratio", format!("{ratio:.decimals$}"));
    }
    line("digits that agree", format!("{digits:.0} (with a solution of higher resolution, in every contact)"));
    if let Some(physical) = &summary.physical {
        let (time, force) = (quantity(physical.time_unit_s, "s"), quantity(physical.force_unit_n, "N"));
        line("units", format!("T = {time}, F = {force}"));
        if let Some(velocity) = physical.rebound_velocity_m_s {
            line("striker leaves at", quantity(velocity, "m/s"));
        }
    }
    let _ = writeln!(text, "\n  {:>5}{:>18}{:>18}{:>18}{:>14}", "#", "from (T)", "to (T)", "duration (T)", "peak (F)");
    let listed = summary.contacts.len().min(LISTED);
    for (i, contact) in summary.contacts.iter().take(listed).enumerate() {
        let or_open = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.10e}"));
        let _ = writeln!(
            text,
            "  {:>5}{:>18}{:>18}{:>18}{:>14.4e}",
            i + 1,
            format!("{:.10e}", contact.start),
            or_open(contact.end),
            or_open(contact.duration),
            contact.peak_force
        );
    }
    if summary.contacts.len() > listed {
        let more = summary.contacts.len() - listed;
        let _ = writeln!(text, "  ... and {more} more (all of them with --json or --out)");
    }
    text
}

/// A table of turning points.
pub fn turning_points_text(points: &TurningPoints) -> String {
    let mut text = format!(
        "critical S {:.14} ± {:.0e}: one contact up to there, more above\n\n{:>4}{:>26}{:>14}\n",
        points.critical_s, points.critical_s_uncertainty, "n", "S of the turning point", "uncertainty"
    );
    for point in &points.turning_points {
        let _ = writeln!(text, "{:>4}{:>26.14e}{:>14.0e}", point.n, point.s, point.uncertainty);
    }
    text
}
