//! The report on one impact.

use std::io;

use super::{Report, literal};
use crate::Impact;
use crate::infinite;
use crate::model::{Answer, parts_in_words};
use crate::plot::Figure;
use crate::scene::{BeamTheory, PlateTheory, Scene, Structure};
use crate::simulate::Resolved;
use crate::summary::Summary;
use crate::text::{leaves, plus_minus, quantity, restitution, significant, stopped};
use crate::trust::Check;

/// Under the picture of an impact.
const PICTURE_CAPTION: &str =
    "Grey stripes are the times in contact; numbers are those of the contacts in the table below.";
/// Largest number of contacts in the table; the others are counted.
const LISTED: usize = 200;

/// The report on an impact on a modal structure: the result with its uncertainty, the model with its reasons (one sentence for
/// each item, in Markdown), figures, contacts, energy, the scene, and how to repeat it.
///
/// # Errors
/// Errors of the figure.
pub fn of_impact(
    headline: &str,
    scene: &Scene,
    modelled: &[String],
    trust: &[Check],
    resolved: &Resolved,
    figure: &Figure,
) -> io::Result<Report> {
    let Resolved { impact, summary, .. } = resolved;
    let mut report = begun(headline, Some(scene));
    report.table(&["result", ""], &result(impact, summary));
    summary.choice.iter().for_each(|answer| uncertain(&mut report, answer));
    report.heading("What was modelled, and why");
    report.list(modelled);
    report.heading("The impact");
    report.figure("impact", figure, PICTURE_CAPTION)?;
    report.heading("Contacts");
    let rows: Vec<Vec<String>> = summary
        .sub_impacts
        .iter()
        .take(LISTED)
        .enumerate()
        .map(|(i, contact)| {
            vec![
                (i + 1).to_string(),
                quantity(contact.start_s, "s"),
                quantity(contact.end_s, "s"),
                quantity(contact.impulse_n_s, "N s"),
                quantity(contact.peak_force_n, "N"),
                plus_minus(contact.peak_force_uncertainty_n, "N"),
                quantity(contact.peak_compression_m, "m"),
            ]
        })
        .collect();
    report.table(&["contact", "from", "to", "impulse", "largest force", "", "largest compression"], &rows);
    more(&mut report, summary.sub_impact_count);
    for why in &summary.peak_forces_not_known {
        report.text(&format!("Largest force, {}.", literal(why)));
    }
    report.heading("Energy");
    report.table(&["where", "energy", "share"], &energy(impact, summary));
    report.text(
        "The last row is the energy before the impact minus all other rows, a measure of the accuracy of the \
        computation.",
    );
    trusted(&mut report, trust);
    ended(&mut report, Some(scene), "vibroimpact simulate scene.json");
    Ok(report)
}

/// The parts of the uncertainty of a restitution.
fn uncertain(report: &mut Report, answer: &Answer) {
    let rows: Vec<Vec<String>> = parts_in_words(answer).into_iter().map(|(name, told)| row(name, told)).collect();
    if !rows.is_empty() {
        report.table(&["part of the uncertainty", ""], &rows);
    }
}

/// Limits of the theories behind a result.
pub(crate) fn trusted(report: &mut Report, trust: &[Check]) {
    if trust.is_empty() {
        return;
    }
    report.heading("How far to trust it");
    let rows: Vec<Vec<String>> = trust
        .iter()
        .map(|check| vec![check.check.replace('_', " "), check.verdict.as_str().to_owned(), check.says.clone()])
        .collect();
    report.table(&["check", "range of the theory", "what shows it"], &rows);
}

/// The report on an impact on an infinite beam or plate; without a scene it was stated by `S` alone.
///
/// # Errors
/// Those of the figure.
pub fn of_infinite_impact(
    headline: &str,
    scene: Option<&Scene>,
    trust: &[Check],
    summary: &infinite::Summary,
    figure: &Figure,
) -> io::Result<Report> {
    let mut report = begun(headline, scene);
    let mut rows = vec![row("outcome", stopped(summary.stopped_by).unwrap_or_else(|| summary.outcome.to_owned()))];
    let digits = summary.digits.unwrap_or(0.0);
    if let Some(ratio) = summary.rebound_ratio {
        rows.push(row("rebound ratio", format!("{ratio:.*}", (digits as usize).clamp(1, 12))));
    }
    if let Some(velocity) = summary.physical.as_ref().and_then(|physical| physical.rebound_velocity_m_s) {
        rows.push(row("striker leaves at", quantity(velocity, "m/s")));
    }
    rows.push(row("separations", summary.separations.to_string()));
    rows.push(row(
        "digits that agree",
        format!("{digits:.0} (with a solution of higher resolution, in every contact)"),
    ));
    report.table(&["result", ""], &rows);
    report.heading("What was modelled, and why");
    report.list(&[
        "The structure is infinite, as stated in the scene, so that no wave returns from an end or an edge.".to_owned(),
        match (summary.s, scene) {
            (Some(s), _) => format!("The contact law is hertz. The impact depends on the single parameter S = {s}."),
            (None, Some(scene)) => format!("The contact law is {}.", scene.contact.law_name()),
            (None, None) => "The contact law is not Hertz's.".to_owned(),
        },
        "The contact force follows from a Volterra equation, which is solved to rounding error, contact by contact."
            .to_owned(),
    ]);
    report.heading("The impact");
    report.figure("impact", figure, PICTURE_CAPTION)?;
    report.heading("Contacts");
    let open = |value: Option<String>| value.unwrap_or_else(|| "does not end".to_owned());
    let rows: Vec<Vec<String>> = match &summary.physical {
        Some(physical) => (physical.contacts.iter().map(|contact| {
            vec![
                quantity(contact.start_s, "s"),
                open(contact.end_s.map(|end| quantity(end, "s"))),
                quantity(contact.peak_force_n, "N"),
            ]
        }))
        .collect(),
        None => (summary.contacts.iter().map(|contact| {
            let end = open(contact.end.map(|end| format!("{end:.6e} T")));
            vec![format!("{:.6e} T", contact.start), end, format!("{:.6e} F", contact.peak_force)]
        }))
        .collect(),
    };
    let numbered = |(i, cells): (usize, Vec<String>)| [vec![(i + 1).to_string()], cells].concat();
    let rows: Vec<Vec<String>> = rows.into_iter().take(LISTED).enumerate().map(numbered).collect();
    report.table(&["contact", "from", "to", "largest force"], &rows);
    more(&mut report, summary.contacts.len());
    trusted(&mut report, trust);
    let command = match (scene, summary.s) {
        (None, Some(s)) => format!("vibroimpact infinite-beam --s {s}"),
        _ => "vibroimpact simulate scene.json".to_owned(),
    };
    ended(&mut report, scene, &command);
    Ok(report)
}

/// The report on an answer of a model that does not resolve the motion in time.
///
/// # Errors
/// Those of the figure.
pub fn of_net_impact(
    headline: &str,
    scene: &Scene,
    trust: &[Check],
    answer: &Answer,
    figure: &Figure,
) -> io::Result<Report> {
    let mut report = begun(headline, Some(scene));
    let mut rows = vec![row("outcome", stopped(answer.stopped_by).unwrap_or_else(|| answer.outcome.to_owned()))];
    if let Some(value) = answer.restitution {
        rows.push(row("restitution", format!("**{}**", restitution(value, answer.restitution_uncertainty))));
    }
    report.table(&["result", ""], &rows);
    uncertain(&mut report, answer);
    report.heading("What was modelled, and why");
    report.list(&[
        format!("The model is {}.", literal(&answer.reason)),
        "This model gives the net result alone. The scene with `\"model\": \"modal\"` resolves contacts, motion and \
         energy in time."
            .to_owned(),
    ]);
    report.heading("The impact");
    report.figure("impact", figure, "The restitution, with the range that its uncertainty allows.")?;
    trusted(&mut report, trust);
    ended(&mut report, Some(scene), "vibroimpact simulate scene.json");
    Ok(report)
}

/// Description of the model of a scene with a modal structure, one sentence (Markdown) for each item. `reason` is that of the
/// choice of the model, [`Answer::reason`](crate::model::Answer::reason).
pub fn modelled(scene: &Scene, impact: &Impact, reason: &str) -> Vec<String> {
    let modes = &impact.structure.modes[..impact.kept_modes()];
    let hertz = |omega_rad_s: f64| quantity(omega_rad_s / std::f64::consts::TAU, "Hz");
    let range = match (modes.first(), modes.last()) {
        (Some(first), Some(last)) => {
            let (from, to) = (hertz(first.omega_rad_s), hertz(last.omega_rad_s));
            match modes.len() {
                1 => format!("There is one mode, of {from}."),
                count => format!("There are {count} modes, from {from} to {to}."),
            }
        }
        _ => "There are no modes: the structure does not move.".to_owned(),
    };
    let structure = match &scene.structure {
        Structure::Beam(beam) => format!(
            "The structure is {} beam of {} segment{} with a damping ratio of {} in every mode{}. It is described by its \
             modes, because waves return from its ends.",
            match beam.solved_by() {
                Ok(BeamTheory::Timoshenko) => "a Timoshenko",
                _ => "an Euler-Bernoulli",
            },
            beam.segments.len(),
            if beam.segments.len() == 1 { "" } else { "s" },
            beam.damping_ratio,
            match (beam.damping_ratios.len(), beam.largest_damping_ratio()) {
                (0, Some(_)) => "",
                (_, Some(_)) => " but the first",
                (0, None) => " and Rayleigh damping",
                (_, None) => " but the first, and Rayleigh damping",
            }
        ),
        Structure::TautString(string) => format!(
            "The structure is a string between two pinned ends, described by its modes with a damping ratio of {}.",
            string.damping_ratio
        ),
        Structure::Plate(plate) => format!(
            "The structure is a rectangular plate by {}'s theory, described by its modes with a damping ratio of {}.",
            if plate.theory == PlateTheory::Mindlin { "Mindlin" } else { "Kirchhoff" },
            plate.damping_ratio
        ),
        Structure::DroppedRod(_) => {
            "The structure is the rod, described by its rigid-body motions and its bending and \
                                     axial modes at the end that strikes."
                .to_owned()
        }
        _ => "The structure is described by the modes that the scene states.".to_owned(),
    };
    let residual = match impact.remainder_modes {
        0 => "The truncated modes are neglected.".to_owned(),
        count => format!(
            "{count} remainder modes represent the truncated modes, with their static compliance of {}, so that \
             the result converges in the number of modes.",
            quantity(impact.residual_compliance_m_n(), "m/N")
        ),
    };
    vec![
        format!("The model is {}.", literal(reason)),
        structure,
        range,
        residual,
        format!("{}. The contact law is {}.", striker(scene, impact), scene.contact.law_name()),
        format!(
            "The motion of the modes is exact, and only the contact force is approximated, with a tolerance of {} for the \
             restitution.",
            significant(impact.settings.tolerance, 2)
        ),
    ]
}

fn striker(scene: &Scene, impact: &Impact) -> String {
    let speed = |speed_m_s: f64| quantity(speed_m_s, "m/s");
    match &scene.structure {
        Structure::DroppedRod(_) => format!("The rod meets an immovable floor at {}", speed(scene.striker.speed_m_s)),
        _ if impact.striker.mass_kg.is_infinite() => "The structure meets an immovable stop".to_owned(),
        _ => {
            let mass = quantity(impact.striker.mass_kg * 1e3, "g");
            format!("The striker has {mass} and a speed of {}", speed(impact.striker.speed_m_s))
        }
    }
}

fn begun(headline: &str, scene: Option<&Scene>) -> Report {
    let mut report = Report::new(headline);
    if let Some(description) = scene.and_then(|scene| scene.description.as_deref()) {
        report.text(&literal(description));
    }
    report
}

fn row(name: &str, value: String) -> Vec<String> {
    vec![name.to_owned(), value]
}

fn result(impact: &Impact, summary: &Summary) -> Vec<Vec<String>> {
    let mut rows = vec![row("outcome", stopped(summary.stopped_by).unwrap_or_else(|| summary.outcome.to_owned()))];
    if let Some(value) = summary.restitution {
        let value = restitution(value, summary.restitution_uncertainty);
        rows.push(row("restitution", format!("**{value}**")));
    }
    match &summary.rod {
        Some(rod) => {
            rows.push(row("velocity of the rod's centre", quantity(rod.centre_velocity_m_s, "m/s")));
            rows.push(row("angular velocity of the rod", quantity(rod.angular_velocity_rad_s, "rad/s")));
            rows.push(row("velocity of the end that struck, without vibration", quantity(rod.end_velocity_m_s, "m/s")));
        }
        None if impact.striker.mass_kg.is_infinite() => {}
        None => {
            let name = format!("striker {} at", leaves(summary.outcome));
            rows.push(row(&name, quantity(summary.striker_velocity_m_s, "m/s")));
        }
    }
    if let Some(rise_m) = summary.rise_m.filter(|rise_m| *rise_m > 0.0) {
        rows.push(row("height of the rebound", quantity(rise_m, "m")));
    }
    rows.push(row("sub-impacts", format!("{} in {}", summary.sub_impact_count, quantity(summary.end_s, "s"))));
    rows
}

fn energy(impact: &Impact, summary: &Summary) -> Vec<Vec<String>> {
    let energy = &summary.energy;
    let [lost_j, unaccounted_j] = energy.loss_and_residual();
    let parts = [
        ("before the impact", energy.initial_j),
        ("striker", energy.striker_j),
        ("structure", energy.structure_j),
        ("lost to modal damping", energy.modal_damping_j),
        ("lost in the contact", lost_j),
        ("unaccounted", unaccounted_j),
    ];
    let share = |part: f64| if energy.initial_j > 0.0 { 100.0 * part / energy.initial_j } else { 0.0 };
    let cells = |(name, part): (&str, f64)| vec![name.to_owned(), quantity(part, "J"), percent(share(part))];
    // a stop has no energy
    let stop = impact.striker.mass_kg.is_infinite();
    parts.into_iter().filter(|(name, _)| !(stop && *name == "striker")).map(cells).collect()
}

fn percent(share: f64) -> String {
    if share == 0.0 || share.abs() >= 0.01 { format!("{share:.2} %") } else { format!("{share:.0e} %") }
}

fn more(report: &mut Report, count: usize) {
    if count > LISTED {
        report.text(&format!("... and {} more.", count - LISTED));
    }
}

fn ended(report: &mut Report, scene: Option<&Scene>, command: &str) {
    if let Some(scene) = scene {
        report.heading("The scene");
        report.code(&scene.to_json());
    }
    report.heading("How to repeat this");
    let save = if scene.is_some() { "save the scene above as `scene.json` and run" } else { "run" };
    report.text(&format!("With vibroimpact {}, {save}", env!("CARGO_PKG_VERSION")));
    report.code(command);
}
