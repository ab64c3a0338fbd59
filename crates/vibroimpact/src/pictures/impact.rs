//! One impact on a modal structure.

use contact_models::Law;
use vibroimpact_sim::modal::{History, Sample};

use super::{Peak, force_panel};
use crate::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use crate::summary::{Contact, Summary};
use crate::text::{quantity, restitution};

/// Equal intervals of the course, beside every step in contact.
const INTERVALS: usize = 1000;
/// Most points of the energies' course.
const ENERGY_POINTS: f64 = 1200.0;
/// How far past the last separation the picture goes, as a share of the time until then.
const AFTERMATH: f64 = 0.1;
/// Contacts drawn over their own duration.
const OVERLAID: usize = 6;
/// Modes whose energy lies this far below the largest are not worth a decade of the axis.
const LEAST_MODAL_ENERGY: f64 = 1e-6;

/// Where the bodies were, how fast the striker went, the force, where the energy was; below, each contact over its own
/// duration, and the energy left in each mode. Grey stripes are the times in contact; numbers are those of the contacts
/// in the summary.
///
/// ```
/// use vibroimpact::{Scene, pictures, summary::Summary};
///
/// let scene = Scene::from_json(r#"{
///     "structure": { "kind": "modal", "omega_rad_s": [6.283], "shape_at_location": [1] },
///     "striker": { "mass_kg": 1, "speed_m_s": 1 },
///     "contact": { "law": "linear-spring", "stiffness_n_m": 1000 }
/// }"#)?;
/// let (solution, history) = scene.impact()?.record()?;
/// let summary = Summary::new(&solution, history.energy_ledger(), 0.0);
/// let svg = pictures::impact("A mass on a spring", &summary, &history).svg().expect("a picture");
/// assert!(svg.contains("contact force (N)"));
/// # Ok::<(), vibroimpact::SceneError>(())
/// ```
pub fn impact(title: &str, summary: &Summary, history: &History<Law>) -> Figure {
    let until_s = history.duration_s() * (1.0 + AFTERMATH);
    let samples: Vec<Sample> = history.times(until_s, INTERVALS).into_iter().map(|t| history.at(t)).collect();
    let column = |of: fn(&Sample) -> f64| samples.iter().map(of).collect::<Vec<f64>>();
    let time = column(|s| s.time_s);
    let contacts = &summary.sub_impacts;
    let starts: Vec<f64> = contacts.iter().map(|c| c.start_s).collect();
    let ends: Vec<f64> = contacts.iter().map(|c| c.end_s).collect();
    let time_axis = || Axis::new("time").unit("s").limits(0.0, until_s);
    let panel = |label: &str, unit: &str, height_px: f64| {
        Panel::new(time_axis().unlabelled(), Axis::new(label).unit(unit))
            .height(height_px)
            .with(Series::spans(&starts, &ends))
    };
    let displacement = panel("displacement", "m", 130.0)
        .with(Series::line(&time, &column(|s| s.structure_displacement_m)).label("structure").colour(Colour::Vermilion))
        .with(Series::line(&time, &column(|s| s.striker_displacement_m)).label("striker").colour(Colour::Blue));
    let velocity = panel("velocity", "m/s", 100.0)
        .with(Series::horizontal_rule(0.0))
        .with(Series::line(&time, &column(|s| s.striker_velocity_m_s)).colour(Colour::Blue));
    let peaks: Vec<Peak> = contacts.iter().map(|contact| peak(contact, &samples)).collect();
    let force = force_panel(time_axis().unlabelled(), "N", &time, &column(|s| s.force_n), &peaks);
    let figure = Figure::new(format!("{title}\n{}", result(summary)))
        .row([displacement])
        .row([velocity])
        .row([force])
        .row([shares(history, summary, until_s)]);
    match summary.modes {
        0 => figure.row([each_contact(contacts, &samples)]),
        _ => figure.row([each_contact(contacts, &samples), modal_energies(&summary.energy.modes_j)]),
    }
}

/// The result in one line.
fn result(summary: &Summary) -> String {
    let contacts = match summary.sub_impact_count {
        1 => "1 sub-impact".to_owned(),
        count => format!("{count} sub-impacts"),
    };
    let time = quantity(summary.end_s, "s");
    match summary.restitution {
        Some(value) => {
            let value = restitution(value, summary.restitution_uncertainty);
            format!("restitution {value} after {contacts} in {time}")
        }
        None => format!("{}: {contacts} in {time}", summary.outcome),
    }
}

fn within<'a>(contact: &Contact, samples: &'a [Sample]) -> &'a [Sample] {
    let from = samples.partition_point(|s| s.time_s < contact.start_s);
    let to = samples.partition_point(|s| s.time_s <= contact.end_s);
    samples.get(from..to).unwrap_or_default()
}

fn peak(contact: &Contact, samples: &[Sample]) -> Peak {
    let highest = within(contact, samples).iter().max_by(|a, b| a.force_n.total_cmp(&b.force_n));
    Peak { time: highest.map_or(contact.start_s, |s| s.time_s), force: contact.peak_force_n }
}

/// Where the energy was: striker, structure, and the rest, which the contact stores or has lost together with damping.
fn shares(history: &History<Law>, summary: &Summary, until_s: f64) -> Panel {
    let mut time: Vec<f64> = Vec::new();
    for t in history.times(until_s, 400) {
        if time.last().is_none_or(|last| t - last >= until_s / ENERGY_POINTS) {
            time.push(t);
        }
    }
    let initial_j = summary.energy.initial_j;
    // the structure starts at rest: all energy is the striker's
    let speed_m_s = history.at(0.0).striker_velocity_m_s;
    let percent = |part: f64| (100.0 * part).clamp(0.0, 100.0);
    let striker: Vec<f64> =
        time.iter().map(|&t| percent((history.at(t).striker_velocity_m_s / speed_m_s).powi(2))).collect();
    let both: Vec<f64> = time
        .iter()
        .zip(&striker)
        .map(|(&t, s)| (s + 100.0 * history.modal_energies_j(t).iter().sum::<f64>() / initial_j).clamp(0.0, 100.0))
        .collect();
    let (floor, ceiling) = (vec![0.0; time.len()], vec![100.0; time.len()]);
    let axis = Axis::new("energy").unit("%").limits(0.0, 100.0);
    let band = |low: &[f64], high: &[f64], label: &str, colour| {
        Series::band(&time, low, high).label(label).colour(colour).opacity(0.5)
    };
    Panel::new(Axis::new("time").unit("s").limits(0.0, until_s), axis)
        .height(110.0)
        .with(band(&floor, &striker, "striker", Colour::Blue))
        .with(band(&striker, &both, "structure", Colour::Vermilion))
        .with(band(&both, &ceiling, "in the contact, or lost in it and by damping", Colour::Grey))
}

/// The force of the first contacts, each from its touch on.
fn each_contact(contacts: &[Contact], samples: &[Sample]) -> Panel {
    let heading = match contacts.len() {
        0 | 1 => "The contact".to_owned(),
        n if n <= OVERLAID => "Each contact from its touch on".to_owned(),
        n => format!("The first {OVERLAID} of {n} contacts, from touch on"),
    };
    let axes = Panel::new(Axis::new("time since touch").unit("s"), Axis::new("contact force").unit("N"));
    contacts.iter().take(OVERLAID).enumerate().fold(axes.title(heading).height(130.0), |panel, (i, contact)| {
        let course = within(contact, samples);
        let time: Vec<f64> = course.iter().map(|s| s.time_s - contact.start_s).collect();
        let force: Vec<f64> = course.iter().map(|s| s.force_n).collect();
        let line = Series::line(&time, &force);
        panel.with(if contacts.len() > 1 { line.label((i + 1).to_string()) } else { line })
    })
}

fn modal_energies(energies_j: &[f64]) -> Panel {
    let number: Vec<f64> = (1..=energies_j.len()).map(|k| k as f64).collect();
    let highest = energies_j.iter().copied().fold(0.0, f64::max);
    let axis = Axis::new("energy").unit("J").log();
    let axis = if highest > 0.0 { axis.limits(LEAST_MODAL_ENERGY * highest, 3.0 * highest) } else { axis };
    Panel::new(Axis::new("mode").integers(), axis)
        .title("Left in each mode at the end")
        .height(130.0)
        .with(Series::stem(&number, energies_j, Marker::Dot).colour(Colour::Vermilion).line_width(0.8))
}
