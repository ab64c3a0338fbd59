//! Results as text for the terminal.

mod parts;

use std::fmt::Write;

use vibroimpact_sim::modal::{Mode, Striker};

use crate::model::{answer_text, wrapped};
use crate::net::{FitSummary, NetRebound};
use crate::scene::{BeamTheory, Location, Scene, Structure};
use crate::summary::Summary;
pub use parts::{counted, printable, quantity, shorten, significant};
pub(crate) use parts::{
    filled, leaves, plus_minus, quantity_apart, residual, restitution, small, stopped, superscript,
};

/// Shares of the energy below this value are due to rounding, and shown as zero.
const NEGLIGIBLE: f64 = 1e-9;
/// Largest number of contacts that are listed; the others are counted.
const LISTED: usize = 20;

/// A line that states what strikes what.
pub fn headline(scene: &Scene, striker: &Striker) -> String {
    let structure = match &scene.structure {
        Structure::Beam(beam) => {
            let [left, right] = beam.ends.map(|end| format!("{end:?}").to_lowercase());
            let length: f64 = beam.segments.iter().map(|segment| segment.length_m).sum();
            let steps =
                if beam.segments.len() > 1 { format!(" of {} segments", beam.segments.len()) } else { String::new() };
            let theory = match beam.solved_by() {
                Ok(BeamTheory::Timoshenko) => "Timoshenko ",
                _ => "",
            };
            format!("{left}-{right} {theory}beam{steps}, {}", quantity(length, "m"))
        }
        Structure::TautString(string) => {
            format!("string of {} under {}", quantity(string.length_m, "m"), quantity(string.tension_n, "N"))
        }
        Structure::Plate(plate) => {
            let edges = plate.edges.map(|edge| format!("{edge:?}").to_lowercase()).join("-");
            let [length, width] = [plate.length_m, plate.width_m].map(|side| quantity(side, "m"));
            format!("{edges} plate, {length} by {width} by {}", quantity(plate.thickness_m, "m"))
        }
        Structure::Modal(_) | Structure::ModesFile(_) => "structure given by its modes".to_owned(),
        Structure::DroppedRod(rod) => {
            return format!(
                "rod of {}, {} across, dropped at {} on a floor, inclined at {}°; {} contact",
                quantity(rod.length_m, "m"),
                quantity(rod.diameter_m, "m"),
                quantity(scene.striker.speed_m_s, "m/s"),
                rod.inclination_deg,
                scene.contact.law_name()
            );
        }
        Structure::InfiniteBeam(_) => "infinite beam".to_owned(),
        Structure::InfinitePlate(_) => "infinite plate".to_owned(),
    };
    let place = match (scene.location_m, &scene.location) {
        (Some(Location::Along(x)), _) => format!(", at {}", quantity(x, "m")),
        (Some(Location::On([x, y])), _) => format!(", at {}, {}", quantity(x, "m"), quantity(y, "m")),
        (None, Some(name)) => format!(", at {}", shorten(&printable(name))),
        (None, None) => String::new(),
    };
    if striker.mass_kg.is_infinite() {
        return format!("immovable stop before a {structure}{place}; {} contact", scene.contact.law_name());
    }
    let (mass, speed) = (quantity(striker.mass_kg * 1e3, "g"), quantity(striker.speed_m_s, "m/s"));
    let from_m = scene.fall_from(0).map(|start| start.gap_m).filter(|gap_m| *gap_m > 0.0);
    let motion = match from_m {
        Some(from_m) if striker.speed_m_s == 0.0 => format!("dropped from {}", quantity(from_m, "m")),
        Some(from_m) => format!("falling at {speed} from {}", quantity(from_m, "m")),
        None if scene.falls() => format!("falling at {speed}"),
        None => format!("at {speed}"),
    };
    format!("{mass} striker {motion} on a {structure}{place}; {} contact", scene.contact.law_name())
}

/// A line that describes striker and structure, for an infinite structure.
pub fn infinite_headline(scene: &Scene, striker: &Striker) -> String {
    let (mass, speed) = (quantity(striker.mass_kg * 1e3, "g"), quantity(striker.speed_m_s, "m/s"));
    let structure = scene.structure.kind().replace('-', " ");
    format!("{mass} striker at {speed} on an {structure}; {} contact", scene.contact.law_name())
}

/// The result of an impact.
pub fn result(summary: &Summary) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<22}{value}");
    };
    let outcome = match summary.outcome {
        "sustained" => "sustained contact: the bodies stay together; there is no rebound",
        "no contact" => "no contact: the bodies never meet",
        other => other,
    };
    line("outcome", stopped(summary.stopped_by).unwrap_or_else(|| outcome.to_owned()));
    if let Some(value) = summary.restitution {
        line("restitution", restitution(value, summary.restitution_uncertainty));
        line("as modelled", restitution(value, summary.uncertainty.solver));
    }
    let leaves = leaves(summary.outcome);
    match &summary.rod {
        Some(rod) => {
            line(&format!("rod {leaves} at"), format!("{} at its centre", quantity(rod.centre_velocity_m_s, "m/s")));
            line("and turns at", quantity(rod.angular_velocity_rad_s, "rad/s"));
            line(
                &format!("its end {leaves} at"),
                format!("{}, without vibration", quantity(rod.end_velocity_m_s, "m/s")),
            );
        }
        // the final speed of a stop is zero
        None if summary.energy.striker_j == 0.0 && summary.striker_velocity_m_s == 0.0 => {}
        None => line(&format!("striker {leaves} at"), quantity(summary.striker_velocity_m_s, "m/s")),
    }
    if let Some(rise_m) = summary.rise_m.filter(|rise_m| *rise_m > 0.0) {
        line("and rises to", quantity(rise_m, "m"));
    }
    line("sub-impacts", format!("{} in {}", summary.sub_impact_count, quantity(summary.end_s, "s")));
    let remainder = if summary.remainder_modes > 0 {
        let compliance = quantity(summary.residual_compliance_m_n, "m/N");
        format!(", and {} remainder modes for all others ({compliance})", summary.remainder_modes)
    } else {
        String::new()
    };
    line("modes", format!("{}{remainder}", summary.modes));
    if let Some(choice) = &summary.choice {
        text += &answer_text(choice);
    }

    let energy = &summary.energy;
    let share = |part: f64| {
        let share = if energy.initial_j > 0.0 { part / energy.initial_j } else { 0.0 };
        if share.abs() < NEGLIGIBLE {
            return format!("{:>12}", "0 J");
        }
        // the sum removes the sign of a rounded zero
        format!("{:>12}  {:6.2} %", quantity(part, "J"), (1e4 * share).round() / 1e2 + 0.0)
    };
    let [lost_j, unaccounted_j] = energy.loss_and_residual();
    let _ = writeln!(text, "\n  energy, of {} before", quantity(energy.initial_j, "J"));
    for (name, part) in [
        ("striker", energy.striker_j),
        ("structure", energy.structure_j),
        ("modal damping", energy.modal_damping_j),
        ("contact", lost_j),
    ] {
        let _ = writeln!(text, "    {name:<20}{}", share(part));
    }
    let _ = writeln!(text, "    {:<20}{:>12}", "unaccounted", residual(unaccounted_j));

    // late short contacts have times of many digits
    let listed = summary.sub_impacts.iter().take(LISTED);
    let times: Vec<[String; 2]> = listed
        .clone()
        .map(|contact| {
            let duration_s = contact.end_s - contact.start_s;
            [contact.start_s, contact.end_s].map(|time_s| quantity_apart(time_s, "s", duration_s))
        })
        .collect();
    let longest = times.iter().flatten().map(|time| time.chars().count()).max().unwrap_or(0);
    let wide = 14.max(longest + 2);
    if summary.sub_impact_count > 0 {
        let _ = writeln!(
            text,
            "\n  {:>3}{:>wide$}{:>wide$}{:>16}{:>14}{:>12}{:>14}",
            "#", "from", "to", "impulse", "peak force", "", "compression"
        );
    }
    for (i, (contact, [from, to])) in listed.zip(&times).enumerate() {
        let _ = writeln!(
            text,
            "  {:>3}{from:>wide$}{to:>wide$}{:>16}{:>14}{:>12}{:>14}",
            i + 1,
            quantity(contact.impulse_n_s, "N s"),
            quantity(contact.peak_force_n, "N"),
            plus_minus(contact.peak_force_uncertainty_n, "N"),
            quantity(contact.peak_compression_m, "m")
        );
    }
    if summary.sub_impact_count > LISTED {
        let _ =
            writeln!(text, "  ... and {} more (all of them with --json or --out)", summary.sub_impact_count - LISTED);
    }
    for why in &summary.peak_forces_not_known {
        let _ = writeln!(text, "  peak force, {}", wrapped(why, 4));
    }
    text
}

/// A table of modes, and the number of converged frequencies if not all are known to have converged.
pub fn modes(modes: &[Mode], converged: Option<usize>) -> String {
    let mut text = format!("{:>6}{:>18}{:>18}{:>26}\n", "mode", "omega (rad/s)", "frequency (Hz)", "shape (kg^-1/2)");
    for (k, mode) in modes.iter().enumerate() {
        let frequency = mode.omega_rad_s / std::f64::consts::TAU;
        // within the width of the column, and with a digit that is not 0
        let shape = match mode.shape {
            shape if shape == 0.0 || (1e-6..1e12).contains(&shape.abs()) => format!("{shape:.8}"),
            shape => format!("{shape:.8e}"),
        };
        let _ = writeln!(text, "{:>6}{:>18.8e}{:>18.8e}{shape:>26}", k + 1, mode.omega_rad_s, frequency);
    }
    if let Some(converged) = converged {
        let (all, share) = (modes.len(), crate::scene::CONVERGED_FREQUENCY);
        let _ = writeln!(
            text,
            "  {converged} of {all} frequencies would change by less than {share:e} with more polynomials."
        );
    }
    text
}

/// A net restitution and the numbers behind it; `stated` is true if the user gave the parameters.
pub fn net_rebound(rebound: &NetRebound, stated: bool) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<14}{value}");
    };
    line("restitution", format!("{:.6}", rebound.restitution));
    let not = if rebound.branch == "outward" { "" } else { "not " };
    line("branch", format!("{} (the outward inequality is {not}active)", rebound.branch));
    line("z", significant(rebound.z, 6));
    line("ebar", significant(rebound.ebar, 6));
    line("beta0", significant(rebound.beta0, 6));
    line("beta1", significant(rebound.beta1, 6));
    line("modes", rebound.modes.to_string());
    line("mass", quantity(rebound.mass_kg * 1e3, "g"));
    let NetRebound { mu0, alpha0, alpha1, .. } = rebound;
    line("parameters", format!("mu0 {mu0}, alpha0 {alpha0}, alpha1 {alpha1}"));
    let origin = if stated {
        "The parameters are those given. The result is as good as their fit to this structure."
    } else {
        "The parameters are the defaults, which were never fitted to this structure: take the result for an order of\n  \
         magnitude. vibroimpact fit finds parameters from measured or computed restitutions."
    };
    let other = "The model emoc of vibroimpact compare is another law, with a stated error and no parameters to fit, and\n  \
                 gives another number.";
    let _ = write!(text, "\n  {origin}\n  {other}\n");
    text
}

/// Parameters fitted to a table.
pub fn fit(fit: &FitSummary) -> String {
    let mut text = String::new();
    for (k, (name, value)) in [("mu0", fit.mu0), ("alpha0", fit.alpha0), ("alpha1", fit.alpha1)].iter().enumerate() {
        let interval = match fit.intervals {
            Some(all) => format!("95 %: {} to {}", significant(all[k][0], 4), significant(all[k][1], 4)),
            None => "interval: these data do not determine one".to_owned(),
        };
        let _ = writeln!(text, "  {name:<12}{:<16}{interval}", significant(*value, 6));
    }
    let _ = writeln!(text, "  {:<12}{:.6}", "rms", fit.rms);
    let _ = writeln!(text, "  {:<12}{:.6}", "max_error", fit.max_error);
    let _ = writeln!(text, "  {:<12}{} impacts, {} modes in the law", "count", fit.count, fit.modes);
    if !fit.undetermined.is_empty() {
        let names = fit.undetermined.join(" and ");
        let _ = writeln!(
            text,
            "  not determined by these data: {names}. The error hardly changes with such a parameter, alone or in a combination. \
             A value below 1e-6 or above 1e6 means only very small or very large."
        );
    } else if !fit.converged {
        text += "  the search ended at its limit; these are the best parameters that it met\n";
    }
    text
}
