//! One impact on a modal structure.

use vibroimpact_sim::modal::Sample;

use super::{Peak, force_panel};
use crate::Impact;
use crate::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use crate::simulate::Resolved;
use crate::summary::{Contact, Summary};
use crate::text::{quantity, restitution};

/// Equal intervals of the time, in addition to every step in contact.
const INTERVALS: usize = 1000;
/// Most points of the curves of energy.
const ENERGY_POINTS: f64 = 1200.0;
/// Contacts drawn over their own duration.
const OVERLAID: usize = 6;
/// Modes with an energy below this share of the largest are not shown.
const LEAST_MODAL_ENERGY: f64 = 1e-6;

/// Displacements, velocities, force and energies until `until_s`; below, each contact over its own duration, and the final energy
/// of each mode. Grey stripes are the times in contact; numbers are those of the contacts in the summary. The striker's
/// displacement is that of its surface, which begins at its distance from the structure. The velocities are those of the striker,
/// unless it is a stop, and of the structure at the contact.
///
/// ```
/// use vibroimpact::simulate::Simulation;
/// use vibroimpact::{Scene, pictures};
///
/// let scene = Scene::from_json(r#"{
///     "structure": { "kind": "modal", "omega_rad_s": [6.283], "shape_at_location": [1] },
///     "striker": { "mass_kg": 1, "speed_m_s": 1 },
///     "contact": { "law": "linear-spring", "stiffness_n_m": 1000 }
/// }"#)?;
/// let Simulation::Modal(resolved) = scene.simulate()? else { panic!("a structure with modes") };
/// let svg = pictures::impact("A mass on a spring", &resolved, resolved.until_s(None)).svg().expect("a picture");
/// assert!(svg.contains("contact force (N)"));
/// # Ok::<(), vibroimpact::SceneError>(())
/// ```
pub fn impact(title: &str, resolved: &Resolved, until_s: f64) -> Figure {
    let Resolved { impact, summary, history } = resolved;
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
    let [structure, striker] = names(impact);
    let moving = impact.striker.mass_kg.is_finite();
    let displacement = panel("displacement", "m", 130.0)
        .with(Series::line(&time, &column(|s| s.structure_displacement_m)).label(structure).colour(Colour::Vermilion))
        .with(Series::line(&time, &column(Sample::striker_surface_m)).label(striker).colour(Colour::Blue));
    let line = Series::line(&time, &column(|s| s.structure_velocity_m_s)).line_width(0.8);
    let mut velocity = panel("velocity", "m/s", 100.0)
        .with(Series::horizontal_rule(0.0))
        .with(line.label(format!("{structure} at the contact")).colour(Colour::Vermilion));
    if moving {
        let line = Series::line(&time, &column(|s| s.striker_velocity_m_s));
        velocity = velocity.with(line.label(striker).colour(Colour::Blue));
    }
    let peaks: Vec<Peak> = contacts.iter().map(|contact| peak(contact, &samples)).collect();
    let force = force_panel(time_axis().unlabelled(), "N", &time, &column(|s| s.force_n), &peaks);
    let figure = Figure::new(format!("{title}\n{}", result(summary)))
        .row([displacement])
        .row([velocity])
        .row([force])
        .row([shares(resolved, until_s)]);
    match summary.modes {
        0 => figure.row([each_contact(contacts, &samples)]),
        _ => figure.row([each_contact(contacts, &samples), modal_energies(&summary.energy.modes_j)]),
    }
}

/// Names of the two bodies: a dropped rod is the structure, and the floor its striker.
fn names(impact: &Impact) -> [&'static str; 2] {
    if impact.striker.mass_kg.is_finite() { ["structure", "striker"] } else { ["structure", "stop"] }
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

/// Energy of the striker (zero for a stop) and of the structure (J).
fn energies_j(Resolved { history, .. }: &Resolved, time_s: f64) -> [f64; 2] {
    [history.striker_energy_j(time_s), history.modal_energies_j(time_s).iter().sum()]
}

/// Energies of striker and structure, and the rest, which the contact stores or contact and damping have dissipated.
fn shares(resolved: &Resolved, until_s: f64) -> Panel {
    let Resolved { impact, summary, history } = resolved;
    let mut time: Vec<f64> = Vec::new();
    for t in history.times(until_s, 400) {
        if time.last().is_none_or(|last| t - last >= until_s / ENERGY_POINTS) {
            time.push(t);
        }
    }
    let percent = |energy_j: f64| (100.0 * energy_j / summary.energy.initial_j).clamp(0.0, 100.0);
    let energies: Vec<[f64; 2]> = time.iter().map(|&t| energies_j(resolved, t)).collect();
    let striker: Vec<f64> = energies.iter().map(|[striker, _]| percent(*striker)).collect();
    let both: Vec<f64> = energies.iter().map(|[striker, structure]| percent(striker + structure)).collect();
    let (floor, ceiling) = (vec![0.0; time.len()], vec![100.0; time.len()]);
    let axis = Axis::new("energy").unit("%").limits(0.0, 100.0);
    let band = |low: &[f64], high: &[f64], label: &str, colour| {
        Series::band(&time, low, high).label(label).colour(colour).opacity(0.5)
    };
    let panel = Panel::new(Axis::new("time").unit("s").limits(0.0, until_s), axis).height(110.0);
    let panel = if impact.striker.mass_kg.is_finite() {
        panel.with(band(&floor, &striker, "striker", Colour::Blue))
    } else {
        panel
    };
    panel.with(band(&striker, &both, "structure", Colour::Vermilion)).with(band(
        &both,
        &ceiling,
        "in the contact, or dissipated",
        Colour::Grey,
    ))
}

/// The force of the first contacts, each from its beginning.
fn each_contact(contacts: &[Contact], samples: &[Sample]) -> Panel {
    let heading = match contacts.len() {
        0 | 1 => "Force of the contact".to_owned(),
        n if n <= OVERLAID => "Force of each contact".to_owned(),
        n => format!("Force of the first {OVERLAID} of {n} contacts"),
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
        .title("Energy of each mode at the end")
        .height(130.0)
        .with(Series::stem(&number, energies_j, Marker::Dot).colour(Colour::Vermilion).line_width(0.8))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::Simulation;

    /// The drawn energies are those of the energy balance, for every kind of scene.
    #[test]
    fn the_energies_drawn_are_those_of_the_ledger() {
        let beam = |striker: &str, start: &str| {
            format!(
                r#"{{ "structure": {{ "kind": "modal", "omega_rad_s": [100, 700], "shape_at_location": [1, 0.8],
                                     "damping_ratios": [0.02, 0.02] }},
                     "striker": {striker}, "start": {start}, "contact": {{ "law": "hertz", "stiffness_n_m1_5": 1e9 }} }}"#
            )
        };
        let moving = r#"{ "gap_m": 1e-4, "moving_modes": [{ "mode": 1, "velocity_m_s": 0.5 }] }"#;
        for (scene, at_first) in [
            (beam(r#"{ "mass_kg": 0.1, "speed_m_s": 1 }"#, "{}"), [0.05, 0.0]),
            (beam(r#"{ "mass_kg": 0.1, "speed_m_s": 1 }"#, moving), [0.05, 0.125]),
            (beam(r#"{ "mass_kg": 0.1, "speed_m_s": 0 }"#, moving), [0.0, 0.125]),
            (beam(r#"{ "immovable": true, "speed_m_s": 0 }"#, moving), [0.0, 0.125]),
        ] {
            let scene = crate::Scene::from_json(&scene).unwrap();
            let Simulation::Modal(resolved) = scene.simulate().unwrap() else { panic!("a structure with modes") };
            let near = |found: [f64; 2], wanted: [f64; 2]| {
                found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-10)
            };
            let energy = &resolved.summary.energy;
            assert!(near(energies_j(&resolved, 0.0), at_first), "{scene:?}");
            let at_last = energies_j(&resolved, resolved.summary.end_s);
            assert!(near(at_last, [energy.striker_j, energy.structure_j]), "{at_last:?} {energy:?}");
        }
    }
}
