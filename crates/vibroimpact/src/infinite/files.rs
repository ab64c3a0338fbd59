//! Tables and picture of an impact on an infinite structure.

use vibroimpact_sim::infinite::{Groups, Solution};

use super::{Sample, Summary, samples, telling_time};
use crate::export::{Failure, Files, json};
use crate::plot::{Axis, Figure, Panel, Series};

/// Samples of each kind in the history.
const SAMPLES: usize = 1000;
/// Times that span more than this ratio are drawn on a logarithmic axis.
const WIDE: f64 = 30.0;

/// `result.json`, `history.csv`, `contacts.csv` and `impact.svg`, ready in memory. With `groups` the tables and the
/// picture are in SI units, otherwise in units of `T`, `F`, `v T` and `v`.
///
/// # Errors
/// None that an impact could cause; those of the writers are passed on.
pub fn files(title: &str, solution: &Solution, groups: Option<&Groups>) -> Result<Files, Failure> {
    let summary = Summary::new(solution, groups);
    let samples = samples(solution, telling_time(solution), SAMPLES);
    let units = Units::new(groups);
    Ok(Files(vec![
        ("result.json", json(&summary)?.into_bytes()),
        ("history.csv", history_csv(&samples, &units)?),
        ("contacts.csv", contacts_csv(&summary, &units)?),
        ("impact.svg", picture(title, solution, &samples, &units).svg()?.into_bytes()),
    ]))
}

/// Factors from the units of the solution, and what the quantities are then measured in.
struct Units {
    time: f64,
    force: f64,
    displacement: f64,
    speed: f64,
    /// Suffixes of the column names of time, force, displacement and speed.
    suffixes: [&'static str; 4],
    /// The same for axes.
    names: [&'static str; 4],
}

impl Units {
    fn new(groups: Option<&Groups>) -> Units {
        match groups {
            Some(groups) => Units {
                time: groups.time_s,
                force: groups.force_n,
                displacement: groups.displacement_m,
                speed: groups.speed_m_s,
                suffixes: ["_s", "_n", "_m", "_m_s"],
                names: ["s", "N", "m", "m/s"],
            },
            None => Units {
                time: 1.0,
                force: 1.0,
                displacement: 1.0,
                speed: 1.0,
                suffixes: [""; 4],
                names: ["T", "F", "v T", "v"],
            },
        }
    }
}

/// As elsewhere in this crate, displacements and velocities are positive away from the structure. (Subtracted from zero,
/// so that zero keeps its sign.)
fn history_csv(samples: &[Sample], units: &Units) -> Result<Vec<u8>, Failure> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let [time, force, displacement, speed] = units.suffixes;
    table.write_record([
        format!("time{time}"),
        format!("structure_displacement{displacement}"),
        format!("striker_displacement{displacement}"),
        format!("structure_velocity{speed}"),
        format!("striker_velocity{speed}"),
        format!("compression{displacement}"),
        format!("force{force}"),
    ])?;
    for Sample { time, state } in samples {
        table.serialize((
            units.time * time,
            0.0 - units.displacement * state.structure_displacement,
            0.0 - units.displacement * state.body_displacement,
            0.0 - units.speed * state.structure_speed,
            0.0 - units.speed * state.body_speed,
            units.displacement * state.compression,
            units.force * state.force,
        ))?;
    }
    Ok(table.into_inner()?)
}

fn contacts_csv(summary: &Summary, units: &Units) -> Result<Vec<u8>, Failure> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let [time, force, _, speed] = units.suffixes;
    table.write_record([
        "number".to_owned(),
        format!("start{time}"),
        format!("end{time}"),
        format!("duration{time}"),
        format!("closing_speed{speed}"),
        format!("peak_force{force}"),
    ])?;
    for (i, contact) in summary.contacts.iter().enumerate() {
        table.serialize((
            i + 1,
            units.time * contact.start,
            contact.end.map(|end| units.time * end),
            contact.duration.map(|duration| units.time * duration),
            units.speed * contact.closing_speed,
            units.force * contact.peak_force,
        ))?;
    }
    Ok(table.into_inner()?)
}

/// Motion and force against time, as in thesis Fig. 2.3; logarithmic axes where later contacts would not show otherwise.
fn picture(title: &str, solution: &Solution, samples: &[Sample], units: &Units) -> Figure {
    let until = samples.last().map_or(0.0, |sample| sample.time);
    let first = solution.contacts.first().and_then(|contact| contact.end);
    let wide = first.is_some_and(|first| until > WIDE * first);
    let axis = |label: &str, name: &str| Axis::new(label).unit(name);
    let peaks = || solution.extrema.iter().filter(|e| !e.minimum).map(|e| solution.s.sqrt() * e.compression.powf(1.5));
    let (low, high) = (0.01 * peaks().fold(f64::INFINITY, f64::min), 2.0 * peaks().fold(0.0, f64::max));
    let (time_axis, force_axis) = match first.filter(|_| wide) {
        Some(first) => (
            axis("time", units.names[0]).log().limits(0.03 * units.time * first, units.time * until),
            axis("contact force", units.names[1]).log().limits(units.force * low, units.force * high),
        ),
        None => (axis("time", units.names[0]), axis("contact force", units.names[1])),
    };
    let column = |of: &dyn Fn(&Sample) -> f64| samples.iter().map(of).collect::<Vec<f64>>();
    let time = column(&|sample| units.time * sample.time);
    let striker = column(&|sample| -units.displacement * sample.state.body_displacement);
    let structure = column(&|sample| -units.displacement * sample.state.structure_displacement);
    let force = column(&|sample| units.force * sample.state.force);
    Figure::new(title)
        .row([Panel::new(time_axis.clone(), axis("displacement", units.names[2]))
            .with(Series::line(&time, &structure).label("structure"))
            .with(Series::line(&time, &striker).label("striker"))])
        .row([Panel::new(time_axis, force_axis).with(Series::line(&time, &force))])
}
