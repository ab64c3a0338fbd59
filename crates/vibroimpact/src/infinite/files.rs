//! Tables and picture of an impact on an infinite structure.

use vibroimpact_sim::infinite::{Scale, Solution};

use super::history::{SAMPLES, Units, history};
use super::{Sample, Summary, samples, telling_time};
use crate::export::{Failure, Files};
use crate::pictures::{Peak, force_panel};
use crate::plot::{Axis, Colour, Figure, Panel, Series};

/// Times that span more than this ratio are drawn on a logarithmic axis.
const WIDE: f64 = 30.0;

/// `result.json`, `history.csv`, `contacts.csv` and `impact.svg` in memory; `result` is the text of the first,
/// `until` as for [`history`]. With `scale` the tables are in SI units, otherwise in units of `T`, `F`, `v T` and `v`.
///
/// # Errors
/// Errors of the writers, which an impact cannot cause.
pub fn files(
    result: String,
    solution: &Solution,
    scale: Option<&Scale>,
    until: Option<f64>,
    figure: &Figure,
) -> Result<Files, Failure> {
    let summary = Summary::new(solution, scale);
    let units = Units::new(scale);
    Ok(Files::of(vec![
        ("result.json", result.into_bytes()),
        ("history.csv", history(solution, scale, until).csv()?),
        ("contacts.csv", contacts_csv(&summary, &units)?),
        ("impact.svg", figure.svg()?.into_bytes()),
    ]))
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

/// Displacements, velocity of the striker, and force with the numbered peak of every contact, as in thesis Fig. 2.3; in SI units
/// with `scale`, otherwise in units of the solution. Grey stripes are the times in contact. Time and force have logarithmic axes
/// if later contacts would not be visible otherwise.
///
/// ```
/// use vibroimpact::infinite::picture;
/// use vibroimpact::vibroimpact_sim::infinite::{Settings, Structure, solve};
/// let solution = solve(Structure::Beam, 15.0, &Settings::default())?;
/// assert!(picture("S = 15", &solution, None, None).svg().expect("a picture").contains("time (T)"));
/// # Ok::<(), vibroimpact::vibroimpact_sim::InvalidInput>(())
/// ```
pub fn picture(title: &str, solution: &Solution, scale: Option<&Scale>, until: Option<f64>) -> Figure {
    let samples = samples(solution, until.unwrap_or_else(|| telling_time(solution)), SAMPLES);
    let units = Units::new(scale);
    let [time_unit, force_unit, displacement_unit, speed_unit] = units.names;
    let until = samples.last().map_or(0.0, |sample| sample.time);
    let first = solution.sub_impacts.first().and_then(|contact| contact.end);
    let wide = first.filter(|first| until > WIDE * first);
    let time_axis = || {
        let axis = Axis::new("time").unit(time_unit);
        match wide {
            Some(first) => axis.log().limits(0.03 * units.time * first, units.time * until),
            None => axis.limits(0.0, units.time * until),
        }
    };
    let column = |of: &dyn Fn(&Sample) -> f64| samples.iter().map(of).collect::<Vec<f64>>();
    let time = column(&|sample| units.time * sample.time);
    let starts: Vec<f64> = solution.sub_impacts.iter().map(|c| units.time * c.start).collect();
    let ends: Vec<f64> = solution.sub_impacts.iter().map(|c| units.time * c.end.unwrap_or(until)).collect();
    let panel = |label: &str, unit: &str, height_px: f64| {
        Panel::new(time_axis().unlabelled(), Axis::new(label).unit(unit))
            .height(height_px)
            .with(Series::spans(&starts, &ends))
    };
    let line = |of: &dyn Fn(&Sample) -> f64| Series::line(&time, &column(of));
    let displacement = panel("displacement", displacement_unit, 150.0)
        .with(
            line(&|s| units.displacement * s.state.structure_displacement).label("structure").colour(Colour::Vermilion),
        )
        .with(line(&|s| units.displacement * s.state.striker_displacement).label("striker").colour(Colour::Blue));
    let velocity = panel("velocity", speed_unit, 110.0)
        .with(Series::horizontal_rule(0.0))
        .with(line(&|s| units.speed * s.state.striker_velocity).colour(Colour::Blue));
    let force = column(&|sample| units.force * sample.state.force);
    let peaks: Vec<Peak> = solution
        .sub_impacts
        .iter()
        .zip(&Summary::new(solution, None).contacts)
        .map(|(contact, found)| {
            let end = contact.end.unwrap_or(until);
            let within = samples.iter().filter(|s| (contact.start..=end).contains(&s.time));
            let highest = within.max_by(|a, b| a.state.force.total_cmp(&b.state.force));
            let time = highest.map_or(contact.start, |sample| sample.time);
            Peak { time: units.time * time, force: units.force * found.peak_force }
        })
        .collect();
    Figure::new(title).row([displacement]).row([velocity]).row([force_panel(
        time_axis(),
        force_unit,
        &time,
        &force,
        &peaks,
    )])
}
