//! Sustained contact at large times: Fig. 2.7 and the error of Eq. 2.47.

use super::{Course, Motion, Parameters, in_ratio, solved};
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use serde::Serialize;
use std::f64::consts::PI;
use tasks::Failure;
use vibroimpact::infinite::samples;
use vibroimpact::plot::{Axis, Colour, Figure, Panel, Series};
use vibroimpact::report::significant;
use vibroimpact_sim::infinite::{Structure, attached, displacement_eq_2_47};

/// Relative errors at one time.
#[derive(Serialize)]
struct ErrorRow {
    s: f64,
    time: f64,
    /// Error of the body's displacement by Eq. 2.47.
    error_eq_2_47: f64,
    /// Error of the body's displacement if the body is attached to the beam, whose motion is known exactly.
    error_attached: f64,
    /// Error of the compression that follows from Eq. 2.47.
    error_compression: f64,
}

/// Compression from the force that Eq. 2.47 implies, in the thesis's unit `D` (Eq. 2.4: the force is the second
/// derivative; Eq. 2.5).
fn compression_eq_2_47(s: f64, time: f64) -> f64 {
    let force = 0.25 * time.powf(-1.5) - 3.0 * PI / 32.0 * time.powf(-2.5);
    s.cbrt() * (force.max(0.0) / s.sqrt()).powf(2.0 / 3.0)
}

pub(super) fn run(study: &mut Study, parameters: &Parameters) -> Result<(), Failure> {
    study.section("Sustained contact at large times (Fig. 2.7)");
    let until = if study.quick { 300.0 } else { parameters.our_choice.asymptotic_until };
    let solutions = study.sweep(&parameters.sustained, 1, |motion| solved(motion.s, until))?;
    let mut columns = Vec::new();
    let mut errors = Panel::new(Axis::new("time").unit("T").log(), Axis::new("relative error").log()).height(240.0);
    let mut rows = Vec::new();
    let mut table = Vec::new();
    for (Motion { s, separations, until: shown }, solution) in parameters.sustained.iter().zip(&solutions) {
        let course = Course::new(*s, &samples(solution, *shown, if study.quick { 200 } else { 800 }));
        study.csv(&format!("fig-2-07-s-{s:e}.csv"), &course.rows())?;
        columns.push(panels(*s, *separations, *shown, &course));
        // Fig. 2.3 already states S = 15
        if !parameters.motion.iter().any(|motion| motion.s == *s) {
            let quantity = format!("separations at S = {}", significant(*s, 3));
            let ours = solution.separations() as f64;
            study.state(Statement::printed(quantity, "2.4, Fig. 2.7", &separations.to_string(), ours));
        }
        let start = solution.sub_impacts.last().map_or(1.0, |contact| contact.start).max(1.0);
        let own: Vec<ErrorRow> = in_ratio(1.01 * start, until, 60)
            .into_iter()
            .filter_map(|time| {
                let state = solution.at(time)?;
                let relative = |ours: f64, exact: f64| (ours / exact - 1.0).abs();
                Some(ErrorRow {
                    s: *s,
                    time,
                    error_eq_2_47: relative(displacement_eq_2_47(time), -state.striker_displacement),
                    error_attached: relative(attached(Structure::Beam, time).displacement, -state.striker_displacement),
                    error_compression: relative(compression_eq_2_47(*s, time), s.cbrt() * state.compression),
                })
            })
            .collect();
        let column = |of: fn(&ErrorRow) -> f64| own.iter().map(of).collect::<Vec<f64>>();
        let time = column(|row| row.time);
        let name = significant(*s, 3);
        errors =
            errors.with(Series::line(&time, &column(|row| row.error_eq_2_47)).label(format!("z, S = {name}"))).with(
                Series::line(&time, &column(|row| row.error_compression)).dashed().label(format!("y - z, S = {name}")),
            );
        for (from, to) in [(1.0, 10.0), (10.0, 100.0), (100.0, 1e3), (1e3, 1e4)] {
            let within = || own.iter().filter(|row| row.time >= from && row.time <= to * (1.0 + 1e-9));
            if within().next().is_none() {
                continue;
            }
            let worst = |of: fn(&ErrorRow) -> f64| significant(within().map(of).fold(0.0, f64::max), 2);
            table.push(vec![
                name.clone(),
                format!("{} to {}", significant(from.max(start), 3), significant(to.min(until), 3)),
                worst(|row| row.error_eq_2_47),
                worst(|row| row.error_attached),
                worst(|row| row.error_compression),
            ]);
        }
        let late = own.iter().filter(|row| row.time >= 100.0).map(|row| row.error_eq_2_47).fold(0.0, f64::max);
        study.state(Statement::trend(
            format!("largest relative error of z by Eq. 2.47 in sustained contact from t = 100 on, S = {name}"),
            "2.4, Fig. 2.7",
            "the match is excellent",
            (0.0, 0.01),
            "half a line's width; the formula is one for large times",
            late,
        ));
        let half = own.iter().filter(|row| row.time >= 0.5 * shown).map(|row| row.error_compression);
        study.state(Statement::trend(
            format!(
                "largest relative error of y − z by Eq. 2.47 over the second half of the figure and beyond, S = {name}"
            ),
            "2.4, Fig. 2.7",
            "the match is excellent, for both displacement and separation",
            (0.0, 0.02),
            "a line's width, a fiftieth of a figure's height; before, y − z oscillates",
            half.fold(0.0, f64::max),
        ));
        rows.extend(own);
    }
    study.csv("asymptotic-errors.csv", &rows)?;
    let mut figure = Figure::new("Fig. 2.7  Asymptotic (dashed) and full solution in sustained contact");
    let [left, right] = <[Vec<Panel>; 2]>::try_from(columns).map_err(|_| "two impacts are compared")?;
    for row in left.into_iter().zip(right) {
        figure = figure.row([row.0, row.1]);
    }
    study.figure(
        "fig-2-07",
        &figure,
        "Displacement z, contact force and compression y - z, on the left for S = 15 and on the right for S = 10⁵.",
    )?;
    let figure = Figure::new("Error of the asymptotic solution, Eq. 2.47").row([errors]);
    study.figure(
        "asymptotic-errors",
        &figure,
        "The displacement is accurate as soon as contact is sustained, whatever happened before. The compression is \
         accurate only after its oscillations have decayed.",
    )?;
    study.text(
        "The table has the largest relative errors over ranges of time: of the displacement by Eq. 2.47, of the \
         displacement by the exact motion of a body that is attached to the beam from the first touch on, and of the \
         compression that follows from Eq. 2.47.",
    );
    study.table(&["S", "time", "z, Eq. 2.47", "z, attached", "y - z, Eq. 2.47"], &table);
    Ok(())
}

/// One column of Fig. 2.7.
fn panels(s: f64, separations: usize, until: f64, course: &Course) -> Vec<Panel> {
    let time = Axis::new("time").unit("T").limits(0.0, until);
    let asymptotic: Vec<f64> =
        course.time.iter().map(|&t| if t > 0.3 { -s.cbrt() * displacement_eq_2_47(t) } else { f64::NAN }).collect();
    let squeezed: Vec<f64> =
        course.time.iter().map(|&t| if t > 1.5 { compression_eq_2_47(s, t) } else { f64::NAN }).collect();
    // in sustained contact the compression is small compared with that of the first contact
    let low = course.compression.last().copied().unwrap_or(1.0);
    let force = course.force.last().copied().unwrap_or(1.0);
    let dashed = |values: &[f64]| Series::line(&course.time, values).colour(Colour::Black).dashed().label("asymptotic");
    vec![
        Panel::new(time.clone(), Axis::new("displacement").unit("D"))
            .title(format!("S = {}, separations: {separations}", significant(s, 3)))
            .height(150.0)
            .with(Series::line(&course.time, &course.beam).colour(Colour::Vermilion).label("y"))
            .with(Series::line(&course.time, &course.body).colour(Colour::Blue).label("z"))
            .with(dashed(&asymptotic)),
        Panel::new(time.clone(), Axis::new("force").unit("F").log().limits(0.2 * force, 10.0))
            .height(150.0)
            .with(Series::line(&course.time, &course.force).colour(Colour::Blue)),
        Panel::new(
            time,
            Axis::new("y - z").unit("D").limits(if separations > 0 { -6.0 * low } else { 0.0 }, 10.0 * low),
        )
        .height(150.0)
        .with(Series::line(&course.time, &course.compression).colour(Colour::Blue))
        .with(dashed(&squeezed)),
    ]
}
