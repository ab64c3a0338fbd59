//! The result of a scene of bodies as text for the terminal.

use std::fmt::Write;

use super::steady::SteadyMotion;
use super::summary::{BodyEnergy, Interval, Statistics, Summary};
use super::{AssemblyScene, Posed};
use crate::summary::loss_and_residual;
use crate::text::{counted, quantity, quantity_apart, residual};
use crate::trust::trust_text;

/// Largest number of intervals of contact that are listed; the others are counted.
const LISTED: usize = 20;

/// A scene in a line.
pub fn headline(scene: &AssemblyScene, posed: &Posed) -> String {
    let count = |count: usize, what: &str| match count {
        1 => format!("1 {what}"),
        0 => format!("no {what}s"),
        _ => format!("{count} {what}s"),
    };
    let modes = posed.assembly.bodies.iter().map(|body| body.modes.len()).sum();
    let bodies = counted(scene.bodies.len() as u64, "body", "bodies");
    let mut line = format!("{bodies} with {}, {}", count(modes, "mode"), count(posed.contacts.len(), "contact"));
    if !scene.loads.is_empty() {
        line += &format!(", {}", count(scene.loads.len(), "load"));
    }
    if scene.gravity_m_s2 > 0.0 {
        line += ", gravity";
    }
    if scene.ground_motion.is_some() {
        line += ", moving ground";
    }
    line
}

/// The outcome of the run in words.
pub(super) fn outcome(summary: &Summary) -> String {
    let end = quantity(summary.end_s, "s");
    match (summary.outcome, summary.reason) {
        ("end", _) => format!("end: the requested time was reached, {end}"),
        ("rest", _) => format!("rest at {end}: no contact can open or close any more"),
        (_, Some(reason)) => format!("stopped at {end}: {reason}"),
        (other, None) => format!("{other} at {end}"),
    }
}

/// The time up to which the times of the events are certain, in words.
pub(super) fn reliability(summary: &Summary) -> Option<String> {
    let until = summary.reliable_until_s?;
    Some(match until >= summary.end_s {
        true => format!("{}, the whole run", quantity(until, "s")),
        false => format!("{}, to the tolerance; later events are less certain", quantity(until, "s")),
    })
}

/// The column names of an interval, and the row of an interval.
pub(super) const INTERVAL: [&str; 7] = ["contact", "from", "to", "impulse", "largest force", "approach", "separation"];

pub(super) fn interval_cells(name: &str, interval: &Interval) -> [String; 7] {
    let or_under_way = |value: Option<f64>, unit: &str| value.map_or_else(|| "-".to_owned(), |v| quantity(v, unit));
    // with so many digits that the duration can be seen
    let duration_s = interval.end_s.map_or(interval.start_s, |end_s| end_s - interval.start_s);
    let time = |time_s: f64| quantity_apart(time_s, "s", duration_s);
    [
        name.to_owned(),
        time(interval.start_s),
        interval.end_s.map_or_else(|| "under way".to_owned(), time),
        quantity(interval.impulse_n_s, "N s"),
        quantity(interval.peak_force_n, "N"),
        quantity(interval.approach_speed_m_s, "m/s"),
        or_under_way(interval.separation_speed_m_s, "m/s"),
    ]
}

/// The first intervals of all contacts together, in order of time, with the names of their contacts.
pub(super) fn first_intervals(summary: &Summary, most: usize) -> Vec<(&str, &Interval)> {
    let of = |(name, contact)| -> Vec<(&str, &Interval)> {
        let (name, contact): (&String, &Statistics) = (name, contact);
        contact.intervals.iter().take(most).map(|interval| (name.as_str(), interval)).collect()
    };
    let mut all: Vec<(&str, &Interval)> = summary.contacts.iter().flat_map(of).collect();
    all.sort_by(|a, b| a.1.start_s.total_cmp(&b.1.start_s));
    all.truncate(most);
    all
}

/// Contacts in rows under [`CONTACT`].
pub(super) const CONTACT: [&str; 6] =
    ["contact", "intervals", "time in contact", "largest force", "RMS force", "work rate"];

pub(super) fn contact_rows(summary: &Summary) -> Vec<Vec<String>> {
    let row = |(name, contact): (&String, &Statistics)| {
        vec![
            name.clone(),
            contact.count.to_string(),
            format!("{:.3} %", 100.0 * contact.time_share),
            quantity(contact.largest_force_n, "N"),
            quantity(contact.rms_force_n, "N"),
            quantity(contact.contact_work_rate_w, "W"),
        ]
    };
    summary.contacts.iter().map(row).collect()
}

/// Share of the largest energy beyond which rounding shows in the digits that are printed.
const VISIBLE_ROUNDING: f64 = 1e-4;

/// Energies in rows: where, and how much.
pub(super) fn energy_rows(summary: &Summary) -> Vec<[String; 2]> {
    let Some(energy) = &summary.energy else { return Vec::new() };
    let at_both_ends = |start_j: f64, end_j: f64| {
        format!("{} at the start, {} at the end", quantity(start_j, "J"), quantity(end_j, "J"))
    };
    let body = |(name, body): (&String, &BodyEnergy)| [name.clone(), at_both_ends(body.start_j, body.end_j)];
    let stored = at_both_ends(energy.contacts_stored_at_start_j, energy.contacts_stored_j);
    let stored = ["stored in contacts".to_owned(), stored];
    let [lost_j, unaccounted_j] = loss_and_residual(energy.contact_loss_j, energy.residual_j, energy.contacts_conserve);
    let parts = [
        ("work of the loads", energy.load_work_j),
        ("lost to modal damping", energy.modal_damping_j),
        ("lost in contacts", lost_j),
    ];
    let part = |(name, value): (&str, f64)| [name.to_owned(), quantity(value, "J")];
    let unaccounted = ["unaccounted".to_owned(), residual(unaccounted_j)];
    let largest =
        energy.bodies.values().flat_map(|body| [body.start_j, body.end_j]).fold(energy.load_work_j.abs(), f64::max);
    let rounding = (energy.rounding_j > VISIBLE_ROUNDING * largest).then(|| {
        let why = "they are differences of larger energies, as where a load nearly meets an undamped frequency";
        ["rounding".to_owned(), format!("up to {:.0e} J in each of these: {why}", energy.rounding_j)]
    });
    energy.bodies.iter().map(body).chain([stored]).chain(parts.map(part)).chain([unaccounted]).chain(rounding).collect()
}

/// The result of a run.
pub fn result(summary: &Summary) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        // writing to a String cannot fail
        let _ = writeln!(text, "  {name:<22}{value}");
    };
    line("outcome", outcome(summary));
    if let Some(reliable) = reliability(summary) {
        line("events certain until", reliable);
    }
    if summary.statistics_from_s > 0.0 {
        line("statistics from", format!("{} on", quantity(summary.statistics_from_s, "s")));
    }
    if let Some(SteadyMotion { periods, intervals }) = summary.steady_motion {
        let intervals = counted(intervals, "interval", "intervals");
        let periods = if periods == 1 { "each period".to_owned() } else { format!("{periods} periods") };
        line("steady motion", format!("{intervals} of contact in {periods} of the load"));
    }
    let counts = &summary.counts;
    line("cost", format!("{} steps in contact, {} in flight", counts.contact_steps, counts.flight_steps));
    text += &columns(&CONTACT, contact_rows(summary).into_iter());
    if summary.energy.is_some() {
        text += "\n  energy\n";
        let rows = energy_rows(summary);
        let width = rows.iter().map(|[name, _]| name.chars().count() + 2).fold(24, usize::max);
        for [name, value] in rows {
            let _ = writeln!(text, "    {name:<width$}{value}");
        }
    }
    let listed = first_intervals(summary, LISTED);
    let all = summary.interval_count();
    if !listed.is_empty() {
        text += &columns(&INTERVAL, listed.iter().map(|(name, interval)| interval_cells(name, interval).to_vec()));
    }
    if all > listed.len() as u64 {
        let _ = writeln!(text, "  ... and {} more (with --json or --out)", all - listed.len() as u64);
    }
    text + &trust_text(&summary.trust)
}

/// A table whose first column is left-aligned and whose other columns are right-aligned.
fn columns(headers: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let headers = headers.iter().map(|name| (*name).to_owned()).collect();
    let rows: Vec<Vec<String>> = std::iter::once(headers).chain(rows).collect();
    let width = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
    let mut text = String::from("\n");
    for row in &rows {
        text += " ";
        for (column, cell) in row.iter().enumerate() {
            let width = width(column).unwrap_or(0);
            let _ = match column {
                0 => write!(text, " {cell:<width$}"),
                _ => write!(text, "   {cell:>width$}"),
            };
        }
        text += "\n";
    }
    text
}
