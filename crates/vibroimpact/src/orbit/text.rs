//! Periodic motions as text for the terminal.

use std::fmt::Write;

use vibroimpact_sim::assembly::Special;

use super::summary::{BranchPart, BranchSummary, Found, INTERRUPTED, OrbitSummary, Recurrence};
use crate::text::{counted, quantity};

/// Factor by which nearby motions of a chaotic motion separate in each period, beyond the error of the estimate.
const CHAOTIC: f64 = 1.02;

/// A periodic motion, or the reason why there is none.
pub fn text(found: &Found) -> String {
    if let Some(contact) = &found.remembering_contact {
        return format!("  outcome               not found\n  {}\n", remembering(contact));
    }
    match (&found.orbit, found.nearest_closure) {
        (Some(orbit), _) => orbit_text(orbit),
        (None, Some(closure)) if found.outcome == INTERRUPTED => format!(
            "  outcome               interrupted: the best motion so far repeats itself only to {closure:.1e} of its size.\n"
        ),
        (None, None) if found.outcome == INTERRUPTED => {
            "  outcome               interrupted before the search began: during the transient.\n".to_owned()
        }
        (None, Some(closure)) => {
            let advice = found.recurrence.as_ref().map_or_else(|| ADVICE.to_owned(), advice);
            format!(
                "  outcome               not found: the motion repeats itself only to {closure:.1e} of its size.\n{advice}"
            )
        }
        (None, None) => {
            let reason = found.reason.map_or_else(String::new, |reason| format!(" ({reason})"));
            format!("  outcome               stopped: a run over one period did not reach its end{reason}.\n")
        }
    }
}

/// Why the fixed point of the map is not a periodic motion.
fn remembering(contact: &str) -> String {
    format!(
        "The contact \"{contact}\" keeps an indentation, or it is never open while its law has internal variables. The motion depends on \
         them,\n  and they are not part of the state whose return is sought. A long run (simulate) follows them."
    )
}

const ADVICE: &str = "  A longer transient (--transient) or more periods of the load (--periods) may lead to one.\n";

/// What the motion from the start does instead, and how a periodic motion may be found.
fn advice(recurrence: &Recurrence) -> String {
    let Recurrence { forcing_periods: n, distance, has_converged, separation_per_period } = *recurrence;
    if has_converged {
        return format!(
            "  The motion from the start converges to one that repeats itself after {n} periods of the load: --periods {n}.\n"
        );
    }
    let nature = if separation_per_period > CHAOTIC {
        format!(
            "It is chaotic so far: nearby motions separate by a factor of {separation_per_period:.2} in each period of the load. \
             A motion may be\n  chaotic for long and then converge."
        )
    } else {
        format!(
            "It is not chaotic: nearby motions separate by a factor of only {separation_per_period:.4} in each period of the load. \
             It may be\n  quasi-periodic, or converge slowly."
        )
    };
    let periods = counted(u64::from(n), "period", "periods");
    format!(
        "  The motion from the start has converged to no periodic motion; it is nearest to one after {periods}, to {distance:.1e}.\n  \
         {nature}\n  \
         A longer search (--search), other --periods, or a branch (--over) that begins where a motion is stable may lead to one.\n"
    )
}

fn orbit_text(orbit: &OrbitSummary) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<22}{value}");
    };
    let periods = match orbit.forcing_periods {
        1 => "one period of the load".to_owned(),
        n => format!("{n} periods of the load"),
    };
    line("period", format!("{}, {periods}", quantity(orbit.period_s, "s")));
    line("stability", if orbit.stable { "stable" } else { "unstable" }.to_owned());
    line("contacts a period", orbit.intervals_per_period.to_string());
    line("repeats itself within", format!("{:.1e} of its size", orbit.closure));
    const LISTED: usize = 6;
    let multipliers = orbit.floquet_multipliers.iter().take(LISTED);
    let shown: Vec<String> =
        multipliers.map(|[re, im]| if *im == 0.0 { format!("{re:.6}") } else { format!("{re:.6}{im:+.6}i") }).collect();
    let more = orbit.floquet_multipliers.len().saturating_sub(LISTED);
    let more = if more > 0 { format!(", and {more} smaller") } else { String::new() };
    line("Floquet multipliers", format!("{}{more}", shown.join(", ")));
    text += "\n  contact, side          first harmonic        largest          least\n";
    for point in &orbit.points {
        let name = format!("{}, {}", point.contact, point.side);
        let _ = writeln!(
            text,
            "  {name:<22}{:>15}{:>15}{:>15}",
            quantity(point.displacement_first_harmonic_m, "m"),
            quantity(point.displacement_max_m, "m"),
            quantity(point.displacement_min_m, "m"),
        );
    }
    text
}

impl BranchSummary {
    /// The branches in a few lines: their extent, their stability, and their special points.
    pub fn text(&self) -> String {
        if self.main.orbits.is_empty() {
            let why = match &self.main.remembering_contact {
                Some(contact) => format!("no periodic motion was found at the first value\n  {}", remembering(contact)),
                None if self.main.interrupted => {
                    "interrupted before a periodic motion was found at the first value".to_owned()
                }
                None => {
                    "no periodic motion was found at the first value; a longer --transient may lead to one".to_owned()
                }
            };
            return format!("  {why}\n");
        }
        let mut text = String::new();
        part(&mut text, &self.field, &self.main);
        for side in &self.branches {
            let to = side.ends_at.map_or_else(String::new, |end| format!(" to that at {end:.9}"));
            let _ = writeln!(text, "\n  from the {} at {:.9}{to}", side.begins_with, side.begins_at);
            if side.branch.orbits.is_empty() {
                text += "    no motion was found that begins there\n";
            } else {
                part(&mut text, &self.field, &side.branch);
            }
        }
        let mut kinds = self.main.special_points.iter().filter_map(|point| point.kind.parse().ok());
        if self.branches.is_empty() && kinds.any(Special::begins_a_branch) {
            text += "\n  --branches 1 follows the motions that begin at period doublings and pitchforks\n";
        }
        text
    }
}

/// One branch.
fn part(text: &mut String, field: &str, branch: &BranchPart) {
    let (Some(first), Some(last)) = (branch.orbits.first(), branch.orbits.last()) else { return };
    let stable = branch.orbits.iter().filter(|point| point.orbit.stable).count();
    let end = match (branch.complete, branch.interrupted) {
        (_, true) => "; interrupted there",
        (true, _) => "",
        (false, _) => "; it could not be followed further",
    };
    let _ = writeln!(text, "  {field:<21} from {:.6} to {:.6}{end}", first.value, last.value);
    let periods = counted(u64::from(first.orbit.forcing_periods), "period of the load", "periods of the load");
    let _ = writeln!(text, "  {:<22}{}, {stable} of them stable, of {periods}", "orbits", branch.orbits.len());
    if !branch.special_points.is_empty() {
        *text += "\n  found on the way       value            within\n";
    }
    for point in &branch.special_points {
        let _ = writeln!(text, "  {:<22}{:<17.9}{:.1e}", point.kind, point.value, point.uncertainty);
    }
}
